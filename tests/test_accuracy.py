"""The estimate of a mooring's error over a window of motion, against the true one."""

import numpy as np
import pytest
from scenes_in_code import HERE, SCENES, STILL, anchored, line_type, surge_heave

from mooring_ros import Mooring
from mooring_ros.accuracy import LEAD, estimate, motion_in
from mooring_ros.offline.trade_errors import errors_between
from mooring_ros.offline.trade_window import swell

TIMES = 100.0 + np.arange(601) * 0.05
SLIGHT = 0.1  # per cent: two errors below are equal


def motion(surge=4.0, heave=2.0, period=10.0):
    """A window of a motion that is under way."""
    poses, twists, rate = np.tile(HERE, (TIMES.size, 1)), np.zeros((TIMES.size, 6)), 2.0 * np.pi / period
    for axis, size, phase in ((0, surge, 1.0), (2, heave, 0.0)):
        poses[:, axis] = size * np.sin(rate * TIMES + phase)
        twists[:, axis] = size * rate * np.cos(rate * TIMES + phase)
    return poses, twists


def true_errors(scene, settings, poses, twists, finer=6.0):
    """(3,) per cent: mean, dynamic and peak, against a mesh that is `finer` times as fine."""
    first = int(np.searchsorted(TIMES, TIMES[0] + LEAD * (TIMES[-1] - TIMES[0])))
    poses, twists = poses.copy(), twists.copy()
    swell(TIMES, poses, twists, TIMES[first] - TIMES[0])
    tensions = []
    for mooring in (Mooring(scene, **settings), Mooring(scene, refine=finer)):
        mooring.settle(poses[0], time=TIMES[0])
        history = mooring.run(TIMES[1:], poses[1:], twists[1:])
        tensions.append(np.linalg.norm(history.fairlead_end_force, axis=2)[first - 1 :])
    return errors_between(*tensions).parts()


@pytest.mark.parametrize(("file", "settings"), [
    ("oc4.txt", {}), ("volturnus_s_semi_taut.txt", {}), ("oc3_spar.txt", {}), ("volturnus_s_chain.txt", {}), ("oc4.txt", {"dt": 0.004, "refine": 2.0}),
    ("oc4.txt", {"fidelity": "quasi_static"}), ("volturnus_s_semi_taut.txt", {"fidelity": "linear"}), ("oc4.txt", {"fidelity": "line1=dynamic,linear"}),
])  # fmt: skip
def test_it_is_within_a_factor_of_two_of_the_true_error(file, settings):
    poses, twists = motion()
    found = estimate(SCENES / file, settings, TIMES, poses, twists)
    assert not found.why and found.begin == pytest.approx(110.0) and found.end == pytest.approx(130.0)
    estimated, true = np.array([found.mean, found.dynamic, found.peak]), true_errors(SCENES / file, settings, poses, twists)
    assert (estimated <= np.maximum(2.0 * true, SLIGHT)).all() and (true <= np.maximum(2.0 * estimated, SLIGHT)).all(), (estimated, true)


def test_a_finer_mesh_has_a_smaller_error():
    poses, twists = motion()
    coarse, fine = (estimate(SCENES / "oc4.txt", {"refine": refine}, TIMES, poses, twists) for refine in (1.0, 4.0))
    assert fine.dynamic < 0.9 * coarse.dynamic and fine.mean < 0.3 * coarse.mean  # nodes that hit the bed converge slowly


def test_lengths_and_released_lines_are_those_of_the_mooring():
    poses, twists = motion()
    lengths = Mooring(SCENES / "oc4.txt").unstretched_length
    as_read = estimate(SCENES / "oc4.txt", {}, TIMES, poses, twists, lengths)
    assert as_read.as_dict() | {"cpu": 0.0} == estimate(SCENES / "oc4.txt", {}, TIMES, poses, twists).as_dict() | {"cpu": 0.0}
    wound = estimate(SCENES / "oc4.txt", {}, TIMES, poses, twists, lengths - [3.0, 0.0, 0.0])
    let_go = estimate(SCENES / "oc4.txt", {}, TIMES, poses, twists, released=("line2",))
    assert all(np.isfinite([found.mean, found.dynamic, found.peak]).all() for found in (as_read, wound, let_go))
    assert len({found.dynamic for found in (as_read, wound, let_go)}) == 3 and not wound.why and not let_go.why


def test_what_cannot_be_solved_says_why():
    poses, twists = motion()
    few = estimate(SCENES / "oc4.txt", {}, TIMES[:5], poses[:5], twists[:5])
    assert few.mean is None and "5 samples, expected" in few.why
    poses[300:, 0] += 1e5
    away = estimate(SCENES / "oc4.txt", {}, TIMES, poses, twists)
    assert away.mean is None and "the step to t = 115" in away.why


def test_a_platform_at_rest_has_an_error_of_the_mean_alone():
    scene = anchored(line_type(0.09, 113.0, 7.5e8, -1.0, drag=1.1, added=1.0), (-837.6, 0, -200), (-40.9, 0, -14), 835.35, 2, depth=200.0)
    poses = np.tile(HERE, (TIMES.size, 1))
    found = estimate(scene, {}, TIMES, poses, np.tile(STILL, (TIMES.size, 1)))
    assert found.orders is None and "half the step" in found.compared  # two segments are too few for a coarser mesh
    assert found.mean > 0.01 and found.peak == pytest.approx(found.mean, rel=0.1)


def test_time_is_taken_in_small_parts():
    poses, twists = motion()
    parts = []
    found = estimate(SCENES / "oc4.txt", {"refine": 4.0}, TIMES, poses, twists, pause=parts.append)
    assert sum(parts) == pytest.approx(found.cpu) and len(parts) > 5 and max(parts) < 0.5 * found.cpu


def test_of_a_window_that_takes_too_long_the_last_part_is_taken():
    poses, twists = motion()
    found = estimate(SCENES / "oc4.txt", {"refine": 4.0}, TIMES, poses, twists, most_cpu=1e-3)
    assert found.begin == pytest.approx(128.0, abs=0.2) and found.end == 130.0 and found.mean > 0.0  # a tenth of 30 s, its first third run-in


def test_a_window_of_two_platforms_is_estimated_as_that_of_the_one_that_they_are():
    """Both floaters of the pair in surge alike: 1e-6 of the estimate on one platform."""
    times = np.arange(0, 121) * 0.1
    poses, twists = surge_heave(times)
    rows = np.column_stack([times, *(np.hstack([poses + [x, 0, 0, 0, 0, 0, 0], twists]) for x in (-500.0, 500.0))])
    rows[:, 1 + 3 : 1 + 7] = 0.0, 0.0, 1.0, 0.0  # body1 is turned by 180 degrees
    names = ["body1", "body2"]
    window = motion_in(rows, names)
    assert window[1].shape == (121, 2, 7) and window[2].shape == (121, 2, 6)
    two = estimate(SCENES / "oc4_pair.txt", {"platforms": names}, *window)
    one = estimate(SCENES / "oc4_pair.txt", {"platforms": None}, *motion_in(np.column_stack([times, poses, twists]), None))
    assert (two.mean, two.dynamic, two.peak) == pytest.approx((one.mean, one.dynamic, one.peak), rel=1e-6) and two.why == one.why == ""
