"""The other inputs, and the timer mode."""
import numpy as np
from node_peer import SCENE, UPRIGHT, node_and_peer, stamp_of

from mooring_ros.mooring import Mooring
from mooring_ros.node.diagnostics import OK, WARN


def pose(x):
    return np.array([x, 0.0, 0.0, *UPRIGHT])


def test_poses_and_twists_are_answered_when_their_stamps_meet(tmp_path):
    with node_and_peer(tmp_path, input="pose_twist", twist_frame="world") as (_, peer):
        peer.wait_for_node("platform/pose")
        peer.wait_for_node("platform/twist")
        mooring = Mooring(SCENE)
        mooring.settle(pose(1.0))
        peer.send_pose(1.0, 1.0)
        peer.spin(0.2)
        assert not peer.wrenches
        peer.send_twist(1.0, 0.5)
        np.testing.assert_array_equal(peer.answer(1.0), mooring.wrench)
        mooring.step(1.0, pose(1.5), np.array([0.5, 0, 0, 0, 0, 0]))
        peer.send_twist(2.0, 0.5)
        peer.send_pose(2.0, 1.5)
        np.testing.assert_array_equal(peer.answer(2.0), mooring.wrench)
        peer.send_pose(2.1, 1.55)
        peer.send_twist(2.2, 0.5)
        peer.send_pose(2.2, 1.6)
        peer.answer(2.2)
        peer.diagnostic("input", lambda level, values, _: level == WARN and values["unpaired"] == "1" and values["accepted"] == "3")


def test_poses_alone_are_differenced(tmp_path):
    with node_and_peer(tmp_path, input="pose") as (_, peer):
        peer.wait_for_node("platform/pose")
        mooring = Mooring(SCENE)
        mooring.settle(pose(0.0))
        for k in range(40):
            peer.send_pose(0.05 * k, 0.02 * k)
            wrench = peer.answer(0.05 * k)
            if k:
                mooring.step(0.05 * k, pose(0.02 * k), np.array([0.4, 0, 0, 0, 0, 0]))
        np.testing.assert_allclose(wrench, mooring.wrench, rtol=1e-6, atol=1.0)


def test_timer_mode_answers_at_its_own_rate_and_holds_when_the_input_stops(tmp_path):
    with node_and_peer(tmp_path, timing__mode="timer", timing__rate=50, limits__input_age=0.5) as (_, peer):
        peer.wait_for_node()
        clock = peer.node.get_clock()
        sent = []
        for _ in range(20):
            sent.append(clock.now().nanoseconds)
            peer.send(sent[-1] * 1e-9, 0.0)
            peer.spin(0.1)
        # 2 s of input at 10 Hz: 50 Hz out, each with the stamp of an input that was sent
        assert 40 <= len(peer.wrenches) <= 130
        assert {stamp_of(m) // 1000 for m in peer.wrenches} <= {stamp // 1000 + d for stamp in sent for d in (-1, 0, 1)}
        peer.diagnostic("timing", lambda _, values, __: values["mode"] == "timer" and int(values["cycles"]) > 40)
        peer.diagnostic("core", lambda level, _, message: level == WARN and "no good input" in message)
        before = len(peer.wrenches)
        peer.spin(0.5)
        assert len(peer.wrenches) > before
        for _ in range(12):
            peer.send(clock.now().nanoseconds * 1e-9, 0.0)
            peer.spin(0.1)
        peer.diagnostic("core", lambda level, *_: level == OK)
