"""Several platforms whose motion is predicted by the delay: what is left of a force's lateness, and the recording of a running node done again."""
import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from node_peer import START, NodeProcess, Peer, free_domain, stamp_of
from geometry_msgs.msg import WrenchStamped
from nav_msgs.msg import Odometry
from scipy.spatial.transform import Rotation
from std_msgs.msg import Float64MultiArray

from benchmarks.late_platforms import LatePair
from mooring_ros.mooring import Mooring
from mooring_ros.motion import Adapter, Sample
from mooring_ros.motion.ensemble import Ensemble, OfPlatform
from mooring_ros.node.delay import FIELDS, Fastest
from mooring_ros.node.output import Output
from mooring_ros.node.session import Session

SCENE = str(Path(__file__).parents[2] / "config" / "scenes" / "oc4_pair.txt")
NAMES = ["body1", "body2"]
LATE, STEP = 0.14, 0.02     # s at full scale: 20 ms at 1:50
OMEGAS = 0.5, 0.8           # rad/s: surge of the first, sway of the second, both with pitch
HOME = Mooring(SCENE, platforms=NAMES).pose_in_file


def motion(t):
    """Poses (2, 7) and twists (2, 6) in world axes."""
    poses, twists = HOME.copy(), np.zeros((2, 6))
    for own, omega in enumerate(OMEGAS):
        sine, cosine = math.sin(omega * t), omega * math.cos(omega * t)
        poses[own, own] += 3.0 * sine
        poses[own, 3:] = (Rotation.from_rotvec([0.0, 0.05 * sine, 0.0]) * Rotation.from_quat(HOME[own, 3:])).as_quat()
        twists[own, own], twists[own, 4] = 3.0 * cosine, 0.05 * cosine
    return poses, twists


class Clock:
    now = 0

    def __call__(self):
        return self.now


def answers(mode, timer):
    """Wrenches (k, 2, 6) that a session of quasi-static lines, told of a delay, gives at t = STEP k, and by the clock LATE after they were meant."""
    clock = Clock()
    session = Session(Mooring(SCENE, "quasi_static", platforms=NAMES), Ensemble(NAMES, Adapter()), Output(totals=2), clock=clock)
    session.delay.mode, session.delay.seconds = mode, LATE
    found = []
    for k in range(120):
        clock.now, stamp = round(1e9 * STEP * k), round(1e9 * STEP * k)
        for own, (pose, twist) in enumerate(zip(*motion(STEP * k))):
            sample = OfPlatform(own, Sample(stamp, tuple(pose), tuple(twist), "", "", "world"))
            session.observe(sample, None) if timer else session.take(sample, None)
        if timer:
            session.tick()
        found.append(session.wrenches[:2].copy())
    return np.array(found)


def true(late):
    """Wrenches (k, 2, 6) of quasi-static lines, `late` s after the samples."""
    mooring = Mooring(SCENE, "quasi_static", platforms=NAMES)
    found = []
    for k in range(120):
        poses, twists = motion(STEP * k + late)
        mooring.settle(poses) if k == 0 else mooring.step(STEP * k, poses, twists)
        found.append(mooring.wrench.copy())
    return np.array(found)


@pytest.mark.parametrize("timer", [False, True])
def test_prediction_takes_nearly_all_of_the_lateness_from_the_force_on_every_platform(timer):
    wanted = true(LATE)
    without, predicted = (np.abs(answers(mode, timer) - wanted)[40:, :, axes].max(axis=0) for mode in ("off", "given") for axes in [[0, 1, 2, 4]])
    moved = [(0, 0), (1, 1), (0, 3), (1, 3)]     # surge of the first, sway of the second, their pitch moments
    for place in moved:
        assert predicted[place] < 0.01 * without[place], place


def test_a_delay_takes_half_of_its_angle_from_the_damping_of_every_mode_of_two_floaters_and_prediction_gives_it_back():
    pair = LatePair()
    for mode, omega in enumerate(pair.omegas):
        lost, left = (-pair.damping(mode, LATE, compensate) for compensate in ("off", "given"))
        assert lost == pytest.approx(0.5 * omega * LATE, rel=0.03) and abs(left) < 0.1 * lost


def test_a_prediction_keeps_the_stamps_and_the_core_stands_ahead_of_them():
    clock = Clock()
    session = Session(Mooring(SCENE, "quasi_static", platforms=NAMES), Ensemble(NAMES, Adapter()), Output(totals=2), clock=clock)
    session.delay.mode, session.delay.seconds = "given", LATE
    for k in range(3):
        for own, (pose, twist) in enumerate(zip(*motion(STEP * k))):
            answered = session.take(OfPlatform(own, Sample(round(1e9 * STEP * k), tuple(pose), tuple(twist), "", "", "world")), None)
        assert answered == round(1e9 * STEP * k)
    assert session.mooring.time == pytest.approx(2 * STEP + LATE)


def test_the_frequency_told_is_that_of_the_platform_that_swings_fastest():
    fastest = Fastest(2)
    for k in range(1500):
        fastest.add(STEP * k, tuple(zip(*motion(STEP * k))))
    assert fastest.value == pytest.approx(max(OMEGAS), rel=0.1)


def test_a_node_predicts_all_platforms_tells_it_and_its_recording_replays_bit_for_bit(tmp_path):
    domain = free_domain()
    process = NodeProcess(tmp_path, {"scene": SCENE, "platforms": NAMES, "delay.compensate": "measured", "delay.seconds": LATE, "twist_frame": "world",
                                     "recording.enabled": True, "recording.path": str(tmp_path / "run.mcap")}, domain)
    peer = Peer(domain, process)
    to = {name: peer.node.create_publisher(Odometry, f"platforms/{name}/odom", 50) for name in NAMES}
    wrenches, delays, stamps = {name: [] for name in NAMES}, [], []
    for name in NAMES:
        peer.listen(WrenchStamped, f"mooring/platforms/{name}/wrench", wrenches[name].append)
    peer.listen(Float64MultiArray, "mooring/delay", lambda message: delays.append(dict(zip(FIELDS, message.data))))
    try:
        peer.wait(lambda: all(p.get_subscription_count() for p in to.values()), START, "subscriptions")
        peer.spin(0.3)
        begin = peer.node.get_clock().now().nanoseconds
        while len(stamps) < 150:
            stamps.append(peer.node.get_clock().now().nanoseconds)
            for own, (pose, twist) in enumerate(zip(*motion((stamps[-1] - begin) * 1e-9))):
                message = Odometry(child_frame_id=NAMES[own])
                message.header.frame_id = "world"
                message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamps[-1], 1_000_000_000)
                peer._fill_pose(message.pose.pose, pose[:3].tolist(), pose[3:].tolist())
                peer._fill_twist(message.twist.twist, twist.tolist())
                to[NAMES[own]].publish(message)
            peer.spin(0.02)
        peer.wait(lambda: delays and all(len(heard) >= 145 for heard in wrenches.values()), 20.0, "the answers")
        assert {stamp_of(message) for heard in wrenches.values() for message in heard} <= set(stamps)
        last = delays[-1]
        assert last["predicted (s)"] == pytest.approx(last["mean (s)"] + LATE, rel=0.5)
        assert process.end() == 0
    finally:
        process.end()
        peer.close()
    out = subprocess.run([sys.executable, "-m", "mooring_ros.offline", "replay", SCENE, str(tmp_path / "run.mcap"), "-o", str(tmp_path / "again.mcap"), "--json"],
                         capture_output=True, text=True, timeout=300)
    assert out.returncode == 0, out.stderr
    found = json.loads(out.stdout)
    assert found["identical"]["same"] == found["identical"]["total"] >= 145
