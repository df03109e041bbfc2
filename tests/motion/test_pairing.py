"""Poses and twists of two topics meet by stamp."""
from mooring_ros.motion import Pairs, Sample

POSE, TWIST = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0), (1.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def pose(stamp, frame="map"):
    return Sample(stamp, POSE, None, frame)


def test_halves_meet_in_either_order():
    pairs = Pairs("world")
    assert pairs.pose(pose(1)) is None
    assert pairs.twist(1, "", TWIST) == Sample(1, POSE, TWIST, "map", "", "world")
    assert pairs.twist(2, "", TWIST) is None
    assert pairs.pose(pose(2)).twist == TWIST
    assert pairs.unpaired == 0


def test_stamps_that_differ_do_not_meet():
    pairs = Pairs()
    assert pairs.pose(pose(1)) is None and pairs.twist(2, "", TWIST) is None


def test_older_halves_are_given_up_when_a_pair_is_complete():
    pairs = Pairs()
    for stamp in (1, 2, 3):
        pairs.pose(pose(stamp))
    assert pairs.twist(3, "", TWIST).stamp == 3
    assert pairs.unpaired == 2
    assert pairs.twist(1, "", TWIST) is None


def test_one_side_alone_does_not_pile_up():
    pairs = Pairs()
    for stamp in range(100):
        pairs.twist(stamp, "", TWIST)
    assert pairs.unpaired == 68
    assert pairs.pose(pose(99)) is not None and pairs.unpaired == 99


def test_a_twist_in_the_frame_of_its_pose_is_a_world_twist():
    pairs = Pairs("child")
    pairs.pose(pose(1))
    assert pairs.twist(1, "map", TWIST).twist_frame == "world"
    pairs.pose(pose(2))
    assert pairs.twist(2, "base_link", TWIST).twist_frame == "child"
