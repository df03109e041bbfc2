"""A fleet of moorings with several platforms each does what they would do by themselves, bit for bit."""

import numpy as np
import pytest
from scenes_in_code import SCENES
from test_fleet import TIMES, state_bits
from test_platforms import NAMES, PAIR, PARTS
from test_platforms_cut import motion

from mooring_ros import Fleet, Mooring, MooringError
from mooring_ros.scene import load_scene, parse_scene

SCENE = load_scene(PAIR)


def motions(moorings):
    """Poses (k, count, 2, 7) and twists (k, count, 2, 6), each from where the file has put its platforms."""
    ways = [motion(mooring.pose_in_file) for mooring in moorings]
    poses, twists = (np.stack(values, axis=1) for values in zip(*ways))
    for m in range(len(moorings)):
        poses[:, m, :, 2] += 0.1 * m  # each in a place of its own
    return poses, twists


@pytest.mark.parametrize("threads", [1, 2])
def test_a_fleet_has_the_bits_of_single_moorings_in_steps_and_in_runs(threads):
    parts = parse_scene(PARTS, "parts.txt", {})
    scenes = [SCENE, parts, SCENE]
    fleet = Fleet(scenes, threads=threads, platforms=NAMES)
    assert fleet[0]._model is fleet[2]._model
    poses, twists = motions(fleet.moorings)
    fleet.settle(poses[0])
    for j in range(10):
        fleet.step(TIMES[j], poses[j], twists[j])
    history = fleet.run(TIMES[10:20], poses[10:20], twists[10:20])
    assert history.wrench.shape == (10, 3, 2, 6) and fleet.wrenches.shape == (3, 2, 6)
    for m, own in enumerate(scenes):
        single = Mooring(own, platforms=NAMES)
        single.settle(poses[0, m])
        alone = single.run(TIMES[:20], poses[:20, m].copy(), twists[:20, m].copy())
        assert state_bits(single) == state_bits(fleet[m])
        assert (history.wrench[:, m] == alone.wrench[10:]).all() and (fleet.wrenches[m] == single.wrench).all()
        lines = slice(history.first_line[m], history.first_line[m + 1])
        assert (history.fairlead_tension[:, lines] == alone.fairlead_tension[10:]).all()


def test_one_pose_for_all_settles_them_once_and_names_have_an_axis_also_where_there_is_one():
    fleet = Fleet([SCENE] * 2, platforms=NAMES)
    fleet.settle(fleet[0].pose_in_file)
    single = Mooring(SCENE, platforms=NAMES)
    single.settle(single.pose_in_file)
    assert (fleet.wrenches == single.wrench).all()
    with pytest.raises(ValueError, match=r"poses has shape \(2, 7\); expected \(2, 2, 7\): a row for each mooring, and in it one for each platform"):
        fleet.step(0.1, single.pose_in_file, np.zeros((2, 2, 6)))
    alone = Fleet([Mooring(SCENES / "chalmers_33m.txt")])
    alone.settle(np.array([0.0, 0, 0, 0, 0, 0, 1]))
    assert alone.wrenches.shape == (1, 6)


def test_moorings_that_are_not_stepped_by_the_kernel_go_along():
    kinds = [{}, {"fidelity": "quasi_static"}, {"fidelity": {"line1": "linear", "default": "dynamic"}}, {"solver": "implicit", "dt": 0.05}]
    fleet = Fleet([Mooring(SCENE, platforms=NAMES, **kind) for kind in kinds])
    poses, twists = motions(fleet.moorings)
    fleet.settle(poses[0])
    history = fleet.run(TIMES[:4], poses[:4], twists[:4])
    for m, kind in enumerate(kinds):
        single = Mooring(SCENE, platforms=NAMES, **kind)
        single.settle(poses[0, m])
        for j in range(4):
            single.step(TIMES[j], poses[j, m], twists[j, m])
            assert (history.wrench[j, m] == single.wrench).all()
        assert (fleet.wrenches[m] == single.wrench).all()


def test_a_mooring_that_fails_stays_and_is_named_and_the_others_go_on():
    fleet = Fleet([SCENE] * 3, platforms=NAMES)
    poses, twists = motions(fleet.moorings)
    fleet.settle(poses[0])
    poses[5:, 1, 1, 0] += 5e4
    with pytest.raises(MooringError, match="1 of 3 moorings could not be advanced. Mooring 1: the step to t = 0.6 s") as raised:
        fleet.run(TIMES[:10], poses[:10], twists[:10])
    assert len(raised.value.history.time) == 5 and raised.value.history.wrench.shape == (5, 3, 2, 6)
    assert [mooring.time for mooring in fleet.moorings] == [TIMES[9], TIMES[4], TIMES[9]]


@pytest.mark.parametrize("others, said", [([None], "member 0 has platforms body1, body2, member 1 one platform without a name"), ([NAMES, ["body2"]], "member 2 platforms body2")])
def test_unlike_numbers_of_platforms_are_refused_with_the_members_that_have_them(others, said):
    one = parse_scene(PAIR.read_text().replace("1    Coupled    -500.0", "1    Fixed      -500.0"), "one.txt", {})
    members = [Mooring(SCENE, platforms=NAMES), *(Mooring(SCENE if names != ["body2"] else one, platforms=names) for names in others)]
    with pytest.raises(ValueError, match=said):
        Fleet(members)
