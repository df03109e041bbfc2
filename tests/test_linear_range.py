"""The linear fidelity over its range and beyond: its error, what it says of it, and how it goes on."""

import numpy as np
import pytest
from scenes_in_code import HERE, SCENES, STILL, anchored, line_type, same_bits, surge_heave

from mooring_ros import Mooring, MooringError
from mooring_ros.core.linear_range import KEPT, RANGE

TIMES = np.arange(1, 601) * 0.1


def settled(fidelity, file="oc4.txt"):
    mooring = Mooring(SCENES / file, fidelity=fidelity)
    mooring.settle(HERE)
    return mooring


def followed(file, poses, twists):
    """Stated errors, true errors (in the same measure) and tensions (k, lines) of a linear mooring, and the mooring."""
    exact = settled("quasi_static", file).run(TIMES, poses, twists)
    linear = settled("linear", file)
    stated, true, tension = [], [], []
    for k, time in enumerate(TIMES):
        linear.step(time, poses[k], twists[k])
        stated.append(linear.error_estimate)
        tension.append(linear.fairlead_tension)
        lines, total = exact.fairlead_tension[k], exact.fairlead_tension[k].sum()
        off = np.abs(tension[-1] - lines) / np.maximum(lines, 0.1 * lines.mean())
        true.append(max(off.max(), np.linalg.norm(linear.wrench[:3] - exact.wrench[k, :3]) / total))
    return np.array(stated), np.array(true), np.array(tension), linear


@pytest.mark.parametrize(("file", "scale"), [("oc4.txt", 1.0), ("volturnus_s_semi_taut.txt", 1.0), ("oc3_spar.txt", 1.0), ("chalmers_33m.txt", 0.05)])
def test_beyond_its_range_it_is_derived_anew_and_what_it_says_of_its_error_is_so(file, scale):
    poses, twists = surge_heave(TIMES, 6.0 * scale, 3.0 * scale, 14.5, pitch=0.05)
    stated, true, tension, linear = followed(file, poses, twists)
    assert true.max() < 3.0 * RANGE
    assert stated.max() < 4.0 * RANGE
    assert np.mean(true <= 2.0 * stated + 0.1 * RANGE) > 0.98
    assert np.median(stated) < 3.0 * np.median(true)
    smooth = np.abs(np.diff(tension, axis=0)).max(axis=0)
    exact = settled("quasi_static", file).run(TIMES, poses, twists).fairlead_tension
    assert (smooth < 1.2 * np.abs(np.diff(exact, axis=0)).max(axis=0) + RANGE * tension.mean(axis=0)).all()  # no jump


def test_a_motion_that_comes_again_is_answered_without_any_more_statics():
    poses, twists = surge_heave(TIMES, 6.0, 3.0, 14.5, pitch=0.05)
    linear, solved = settled("linear"), []
    for k, time in enumerate(TIMES):
        linear.step(time, poses[k], twists[k])
        solved.append(linear.last_step["evaluations"])
    assert sum(solved[:300]) > 28 * 2
    assert max(solved) <= 30  # of a step
    assert sum(solved[300:]) < 0.5 * len(solved[300:])


def test_what_is_kept_is_bounded():
    linear = settled("linear")
    for k in range(1, 45):
        linear.step(float(k), HERE + np.array([8.0 * (k % 22), 15.0 * (k // 22), 0, 0, 0, 0, 0]), STILL)
    assert len(linear._linear.kept) <= KEPT
    linear.step(100.0, HERE, STILL)
    exact = settled("quasi_static")
    np.testing.assert_allclose(linear.fairlead_tension, exact.fairlead_tension, rtol=3.0 * RANGE)


def test_one_call_and_many_give_the_same_bits_across_new_ranges():
    poses, twists = surge_heave(TIMES, 8.0, 2.0, 12.0, pitch=0.05)
    whole, single, cut = settled("linear"), settled("linear"), settled("linear")
    whole.run(TIMES[:200], poses[:200], twists[:200])
    for k in range(200):
        single.step(TIMES[k], poses[k], twists[k])
    cut.run(TIMES[:77], poses[:77], twists[:77])
    saved = cut.snapshot()
    cut.run(TIMES[77:150], poses[77:150], twists[77:150])
    cut.restore(saved)
    cut.run(TIMES[77:200], poses[77:200], twists[77:200])
    assert whole._linear.derived > 2
    assert same_bits(whole.snapshot(), single.snapshot()) and same_bits(whole.snapshot(), cut.snapshot())
    assert whole.error_estimate == single.error_estimate == cut.error_estimate


def test_a_platform_put_elsewhere_is_answered_from_there_at_once():
    linear, exact = settled("linear"), settled("quasi_static")
    pose = HERE + np.array([60.0, -30.0, 4.0, 0, 0, 0, 0])
    for one in (linear, exact):
        one.step(1.0, pose, STILL)
    np.testing.assert_allclose(linear.wrench, exact.wrench, rtol=1e-6, atol=1e-6 * np.abs(exact.wrench).max())
    assert linear.error_estimate < 1e-6


def test_where_no_equilibrium_can_be_found_the_step_is_refused_and_undone(monkeypatch):
    linear = settled("linear")
    linear.step(1.0, HERE, STILL)
    saved = linear.snapshot()

    def nothing(*_, **__):
        raise MooringError("the statics did not converge")

    monkeypatch.setattr(linear, "_next_static_state", nothing)
    with pytest.raises(MooringError, match="did not converge"):
        linear.step(2.0, HERE + np.array([40.0, 0, 0, 0, 0, 0, 0]), STILL)
    assert same_bits(saved, linear.snapshot()) and linear._linear is saved.linear
    linear.step(2.0, HERE + np.array([0.1, 0, 0, 0, 0, 0, 0]), STILL)


def test_only_the_linear_fidelity_states_an_error_of_its_own():
    kind = line_type(0.09, 113.0, 7.5e8, -1.0, drag=1.1, added=1.0)
    scene = anchored(kind, (-837.6, 0, -200), (-40.9, 0, -14), 835.35, 20, depth=200.0)
    for fidelity, known in (("dynamic", False), ("quasi_static", False), ("linear", True)):
        mooring = Mooring(scene, fidelity=fidelity)
        mooring.settle(HERE)
        assert (mooring.error_estimate is not None) == known
