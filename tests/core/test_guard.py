"""A step that would blow up is taken again smaller, or refused with everything as it was."""

import numpy as np
import pytest
from scenes_in_code import HERE, SCENES, same_bits, surge_heave

from mooring_ros import Mooring, MooringError
from mooring_ros.core.schemes import LEAPFROG

TIMES = np.arange(1, 81) * 0.1
POSES, TWISTS = surge_heave(TIMES)


def spoilt(factor):
    """A mooring that believes its stable steps of plain leapfrog to be `factor` times longer, settled, after a second that was sound."""
    mooring = Mooring(SCENES / "oc4.txt")
    mooring._table = mooring._table[mooring._table[:, 0] == LEAPFROG]
    mooring.settle(HERE)
    mooring.run(TIMES[:10], POSES[:10], TWISTS[:10])
    mooring._table[:, 1] *= factor
    return mooring


def sound():
    mooring = Mooring(SCENES / "oc4.txt")
    mooring.settle(HERE)
    return mooring.run(TIMES, POSES, TWISTS).fairlead_tension


@pytest.mark.parametrize("factor", [2.0, 4.0, 5.0, 8.0, 10.0, 12.0, 24.0, 64.0])
def test_runaway_steps_are_taken_again_smaller_or_refused(factor):
    """Steps of several times the limit: 6 % of the dynamic deviation from sound ones, because each was taken again; with ten times and more
    10 %, or MooringError."""
    mooring = spoilt(factor)
    try:
        got = mooring.run(TIMES[10:], POSES[10:], TWISTS[10:]).fairlead_tension
    except MooringError:
        assert factor >= 10.0
        return
    want = sound()[10:]
    assert np.sqrt(np.mean((got - want) ** 2)) < (0.06 if factor < 10.0 else 0.1) * want.std()


def test_retries_are_reported():
    mooring = spoilt(10.0)
    for k in range(10, 20):
        mooring.step(TIMES[k], POSES[k], TWISTS[k])
        if mooring.last_step["retries"]:
            return
    raise AssertionError("no step was taken again")


def test_hopeless_step_is_refused_and_leaves_every_bit_as_it_was():
    mooring = spoilt(1e6)
    before = mooring.snapshot()
    with pytest.raises(MooringError, match="ran away|stretches a line"):
        for k in range(10, 80):
            before = mooring.snapshot()
            mooring.step(TIMES[k], POSES[k], TWISTS[k])
    assert same_bits(before, mooring.snapshot())


def test_after_a_refusal_it_goes_on_as_if_nothing_had_been_asked():
    """A refused second leaves no trace: sound steps from there have the bits of a mooring that was never spoilt."""
    other = Mooring(SCENES / "oc4.txt")
    other.settle(HERE)
    other._table = other._table[other._table[:, 0] == LEAPFROG]
    other.run(TIMES[:10], POSES[:10], TWISTS[:10])
    mooring = spoilt(1.0)
    table = mooring._table.copy()
    mooring._table[:, 1] *= 1e6
    far = HERE.copy()
    far[:3] = [200.0, 0.0, 50.0]
    with pytest.raises(MooringError):
        mooring.step(TIMES[9] + 300.0, far, np.zeros(6))
    mooring._table[:] = table
    for one in (mooring, other):
        one.run(TIMES[10:], POSES[10:], TWISTS[10:])
    assert same_bits(mooring.snapshot(), other.snapshot())


def test_run_that_is_refused_hands_over_what_was_done():
    """MooringError of run() carries the samples before it, and the mooring stands at the last of them."""
    mooring = spoilt(1.0)
    poses = POSES[10:40].copy()
    mooring._table[:, 1] *= 1e6
    poses[20:, 0] += 500.0
    with pytest.raises(MooringError) as caught:
        mooring.run(TIMES[10:40], poses, TWISTS[10:40])
    history = caught.value.history
    assert history.time.size == history.wrench.shape[0] <= 21
    assert mooring.time == (history.time[-1] if history.time.size else TIMES[9])
    assert np.isfinite(history.fairlead_tension).all()
