"""What a step can cost at most: docs/extremes.md states it."""

import numpy as np
import pytest
from scenes_in_code import HERE, SCENES, surge_heave

from mooring_ros import Mooring, MooringError
from mooring_ros.core import explicit
from mooring_ros.core.schemes import AXIAL

# times the evaluations of an interval without any trouble: MOST_REFINED at once for a hasty platform, and twice that in each try, never more than FINEST
MOST = sum(min(explicit.MOST_REFINED * 2.0**tries, explicit.FINEST) for tries in range(7))


def plain_evaluations(mooring, duration):
    """Evaluations of an interval (s) whose every chunk goes through at the first try with the largest steps of the schemes whose limits are fixed."""
    table = mooring._table
    chunks = np.ceil(duration / min(explicit.CHUNK * table[:, 1].max(), mooring._model.sea.refresh))
    return chunks * min(np.ceil(duration / chunks / dt - 1e-9).clip(1.0) * cost for scheme, dt, _, cost in table if scheme != AXIAL)


@pytest.mark.parametrize("factor", [1.0, 3.0, 10.0, 30.0, 100.0, 1000.0])
@pytest.mark.parametrize("every", [0.01, 0.1, 3.0])
def test_no_interval_takes_more_evaluations_than_the_bound(factor, every):
    """Steps that pretend to be stable when they are `factor` times too long, on a platform that is thrown about."""
    mooring = Mooring(SCENES / "oc4.txt")
    mooring.settle(HERE)
    mooring._table[:, 1] *= factor
    times = np.arange(1, 21) * every
    poses, twists = surge_heave(times, 8.0, 6.0, 5.0)
    for t, pose, twist in zip(times, poses, twists):
        before = mooring.time
        try:
            mooring.step(t, pose, twist)
        except MooringError:
            break
        assert mooring.last_step["evaluations"] <= MOST * plain_evaluations(mooring, t - before) + 1e-9


def test_an_interval_that_would_take_minutes_is_refused():
    mooring = Mooring(SCENES / "oc4.txt")
    mooring.settle(HERE)
    with pytest.raises(MooringError, match="needs more than 1e\\+07 steps.*expected shorter intervals"):
        mooring.step(1.1 * explicit.MOST_STEPS * mooring.step_limit.dt, HERE, np.zeros(6))
