"""Samples of several platforms become one motion."""
import numpy as np
import pytest

from mooring_ros.motion import Adapter, Limits, Sample
from mooring_ros.motion.convention_check import UNDECIDED, WRONG
from mooring_ros.motion.ensemble import WAITING, Checks, Ensemble, OfPlatform
from mooring_ros.motion.gate import JUMP, REORDERED, REPEATED, UNPAIRED
from mooring_ros.node.platforms import AllResets, name_list, refuse

MS = 1_000_000
NAMES = ("body1", "body2", "body3")


def given(number, ms, x=0.0, v=0.0, frame="world", q=(0.0, 0.0, 0.0, 1.0)):
    return OfPlatform(number, Sample(ms * MS, (x, 100.0 * number, 0.0, *q), (v, 0.0, 0.0, 0.0, 0.0, 0.0), frame, NAMES[number]))


@pytest.fixture
def two():
    return Ensemble(NAMES[:2], Adapter())


def test_a_motion_is_complete_when_every_platform_has_given_the_stamp():
    three = Ensemble(NAMES, Adapter())
    assert three.admit(given(2, 5)) is None and three.admit(given(0, 5, x=1.0, v=2.0)) is None
    motion = three.admit(given(1, 5))
    assert motion.stamp == 5 * MS and [pose[:2] for pose in motion.pose] == [(1.0, 0.0), (0.0, 100.0), (0.0, 200.0)]
    assert motion.twist[0][0] == 2.0 and three.last is motion and three.missing == ""
    assert (three.received, three.accepted) == (3, 3) and three.child_frame == NAMES and three.frame == "world"


def test_platforms_may_be_ahead_of_each_other(two):
    for ms in (10, 20, 30):
        assert two.admit(given(0, ms, x=0.001 * ms)) is None
    assert two.missing == "; waits for body2 at 0.010 s"
    assert [two.admit(given(1, ms)).stamp for ms in (10, 20, 30)] == [10 * MS, 20 * MS, 30 * MS]


def test_a_stamp_that_one_platform_has_left_out_is_given_up_and_says_who_was_missing(two):
    two.admit(given(0, 10))
    two.admit(given(0, 20))
    assert two.admit(given(1, 20)).stamp == 20 * MS
    assert two.rejected[UNPAIRED] == 1 and two.cause == "unpaired: body1: sample at 0.010000000 s: nothing of body2 with this stamp"
    assert (two.received, two.accepted) == (3, 2)


def test_what_waits_for_a_silent_platform_is_bounded(two):
    for k in range(WAITING + 5):
        two.admit(given(0, k + 1))
    assert two.rejected[UNPAIRED] == 5 and f"{WAITING} samples wait for body2" in two.cause


def test_a_refused_sample_names_its_platform_and_leaves_no_motion(two):
    for number in (0, 1):
        two.admit(given(number, 10))
    two.admit(given(0, 20))
    assert two.admit(given(1, 20, x=500.0)) is None and two.rejected[JUMP] == 1 and two.cause.startswith("jump: body2: pose is 500 m")
    assert two.admit(given(1, 20)).stamp == 20 * MS       # sent again, and good
    assert two.admit(given(1, 20)) is None and two.rejected[REPEATED] == 1


def test_all_platforms_share_one_world_frame(two):
    two.admit(given(0, 10))
    assert two.admit(given(1, 10, frame="map")) is None and "body2: frame of the pose is 'map', expected 'world'" in two.cause


def test_platforms_that_were_put_elsewhere_are_taken_there_together(two):
    for number in (0, 1):
        two.admit(given(number, 10))
    for k in range(12):
        two.admit(given(0, 20 + k))
        assert two.admit(given(1, 20 + k, x=500.0)) is None
    assert two.relocated
    motion = two.relocate()
    assert motion.stamp == 31 * MS and motion.pose[1][0] == 500.0 and motion.pose[0][0] == 0.0
    assert two.admit(given(0, 32)) is None and two.admit(given(1, 32, x=500.0)).stamp == 32 * MS


def test_time_does_not_go_back_after_one_platform_was_taken_elsewhere(two):
    for number in (0, 1):
        two.admit(given(number, 1000))
    two.last = two.last._replace(stamp=2000 * MS)
    two.admit(given(0, 1500))
    assert two.admit(given(1, 1500)) is None and two.rejected[REORDERED] == 2


def test_after_a_reset_the_motion_begins_when_all_have_gone_back():
    two = Ensemble(NAMES[:2], Adapter(), resets=AllResets("settle", 2))
    for ms in (5000, 5010):
        for number in (0, 1):
            two.admit(given(number, ms))
    two.resets.clock_went_back()
    assert two.admit(given(0, 0)) is None and two.admit(given(1, 0)).stamp == 0
    assert two.restarts == 2 and two.resets.count == 1 and "from 5.010 s to 0.000 s" in two.resets.cause


def test_limits_are_shared_and_may_change(two):
    two.limits.jump = 0.0
    assert all(gate.limits is two.limits for gate in two.gates) and isinstance(two.limits, Limits)


def test_motions_of_all_are_carried_on_one_by_one(two):
    two.admit(given(0, 10, x=1.0, v=2.0))
    motion = two.admit(given(1, 10, v=-1.0))
    poses, twists = motion.ahead(0.5)
    assert [pose[0] for pose in poses] == [2.0, -0.5] and [twist[0] for twist in twists] == [2.0, -1.0] and motion.each == tuple(zip(motion.pose, motion.twist))


def test_a_twist_in_the_wrong_axes_is_found_out_and_told_with_its_platform():
    """body2 is turned by 90 degrees and moves ahead, its twist in world axes said to be its own."""
    two = Ensemble(NAMES[:2], Adapter())
    check, root = Checks(two), 0.5**0.5
    for k in range(1, 61):
        two.admit(given(0, 50 * k))
        motion = two.admit(given(1, 50 * k, x=0.05 * k, v=1.0, q=(0.0, 0.0, root, root)))
        check.look_at(motion, None)
    assert check.verdict.kind == WRONG and check.verdict.text.startswith("body2: ") and check.finished and check.moved
    assert check.anew().verdict.kind != WRONG


def test_a_platform_that_lies_still_is_no_reason_to_look_at_the_twists():
    """body1 moves as its twist says, body2 rests: nothing to tell. Then body1's twist fits nothing, and is what is told."""
    for factor, undecided in ((1.0, False), (-1.0, True)):
        two = Ensemble(NAMES[:2], Adapter())
        check = Checks(two)
        for k in range(1, 61):
            two.admit(given(0, 50 * k, x=0.05 * k, v=factor))
            check.look_at(two.admit(given(1, 50 * k)), None)
        assert check.verdict.kind == UNDECIDED and check.moved == undecided
        assert check.verdict.text.startswith("body1: " if undecided else "body2: ")


def test_names_and_parameters_that_do_not_go_together_are_refused():
    for wrong in ("body1", ["a/b"], [1], [""]):
        with pytest.raises(ValueError, match="expected names of coupled bodies"):
            name_list(wrong)
    name_list([])
    with pytest.raises(ValueError, match="expected none with several platforms"):
        refuse({"platforms": ["body1"], "platform_frame": "hull"})
    refuse({"platforms": [], "platform_frame": "hull"})


@pytest.mark.parametrize("seed", range(30))
def test_whatever_is_lost_and_however_streams_interleave_the_stamps_that_all_have_given_come_out_in_order(seed):
    """Random drops and lags below WAITING; what is given up and what is answered is all that came, but for what still waits."""
    random = np.random.default_rng(seed)
    count = int(random.integers(2, 4))
    streams = [[ms for ms in range(1, 200) if random.random() < 0.8] for _ in range(count)]
    every = Ensemble(NAMES[:count], Adapter())
    sent, found = [0] * count, []
    while any(sent[number] < len(streams[number]) for number in range(count)):
        slowest = min(sent)
        number = int(random.choice([n for n in range(count) if sent[n] < len(streams[n]) and sent[n] - slowest < 40 or sent[n] == slowest and sent[n] < len(streams[n])]
                                   or [n for n in range(count) if sent[n] < len(streams[n])]))
        motion = every.admit(given(number, streams[number][sent[number]]))
        sent[number] += 1
        if motion is not None:
            found.append(motion.stamp // MS)
    assert found == sorted(set.intersection(*map(set, streams)))
    waiting = sum(len(queue) for queue in every._waiting)
    assert every.received == sum(map(len, streams)) == count * len(found) + every.rejected[UNPAIRED] + waiting
