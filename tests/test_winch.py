"""Unstretched lengths that change while the mooring runs."""

import numpy as np
import pytest
from scenes_in_code import HERE, SCENES, STILL, anchored, line_type

from mooring_ros import Mooring


@pytest.mark.parametrize(("solver", "allowed"), [("explicit", 5e-4), ("implicit", 1e-3)])
def test_a_line_wound_in_slowly_ends_at_the_statics_of_its_new_length(solver, allowed):
    kind = line_type(0.09, 113.0, 7.5e8, -1.0, drag=1.1, added=1.0)
    mooring, target = (Mooring(anchored(kind, (-837.6, 0, -200), (-40.9, 0, -14), 835.35, 20, depth=200.0), solver=solver) for _ in range(2))
    mooring.settle(HERE)
    before = mooring.fairlead_tension[0]
    tension = np.empty(4000)
    for k in range(1, tension.size + 1):
        if k <= 300:
            mooring.set_unstretched_length("line1", 835.35 - 0.01 * k)
        mooring.step(0.1 * k, HERE, STILL)
        tension[k - 1] = mooring.fairlead_tension[0]
    target.set_unstretched_length("line1", 832.35)
    target.settle(HERE)
    assert target.fairlead_tension[0] > 1.05 * before
    assert tension[2000:].mean() == pytest.approx(target.fairlead_tension[0], rel=allowed)  # it swings on, drag being small at small speeds


def test_weight_goes_with_the_length():
    """A hanging line's upper end carries all of it."""
    mooring = Mooring(anchored(line_type(0.1, 100.0, 1e9), (0, 0, -50), (0, 0, 0), 60.0, 10, water_density=0.0))
    mooring.settle(HERE)
    mooring.set_unstretched_length("line1", 55.0)
    mooring.settle(HERE)
    assert -(mooring.fairlead_end_force + mooring.anchor_end_force)[0, 2] == pytest.approx(55.0 * 100.0 * 9.80665, rel=1e-6)


def test_the_same_length_changes_nothing_and_restore_brings_the_old_one_back():
    mooring = Mooring(SCENES / "oc4.txt")
    mooring.settle(HERE)
    saved, tension = mooring.snapshot(), mooring.fairlead_tension
    mooring.set_unstretched_length("line1", mooring.unstretched_length[0])
    np.testing.assert_allclose(mooring.fairlead_tension, tension, rtol=1e-12)
    mooring.set_unstretched_length("line1", 830.0)
    mooring.step(1.0, HERE, STILL)
    mooring.restore(saved)
    assert mooring.unstretched_length[0] == 835.35
    np.testing.assert_array_equal(mooring.fairlead_tension, tension)
    other = Mooring(SCENES / "oc4.txt")
    other.restore(saved)
    for each in (mooring, other):
        each.step(1.0, HERE, STILL)
    np.testing.assert_array_equal(mooring.fairlead_tension, other.fairlead_tension)


@pytest.mark.parametrize(("line", "length"), [("line9", 10.0), ("line1", 0.0), ("line1", -1.0), ("line1", np.nan), ("line1", "long")])
def test_a_line_that_is_not_there_or_a_length_that_is_none_is_refused(line, length):
    mooring = Mooring(SCENES / "oc4.txt")
    mooring.settle(HERE)
    with pytest.raises(ValueError, match="expected"):
        mooring.set_unstretched_length(line, length)
    assert mooring.unstretched_length[0] == 835.35
