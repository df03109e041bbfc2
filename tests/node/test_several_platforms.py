"""A node with several platforms: topics of each, one step for all, a missing one, recording and replay."""
import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from nav_msgs.msg import Odometry
from node_peer import START, UPRIGHT, NodeProcess, Peer, free_domain, numbers, stamp_of
from scipy.spatial.transform import Rotation
from std_msgs.msg import Float64MultiArray

from mooring_ros.mooring import Mooring
from mooring_ros.motion import Adapter, Sample
from mooring_ros.motion.ensemble import Ensemble, OfPlatform
from mooring_ros.node.output import Output
from mooring_ros.node.session import Session
from mooring_ros.node.states import HOLD, IDLE, RUN
from mooring_ros.node.stiffness import stiffness_out
from mooring_ros.recording import schedule

SCENE = str(Path(__file__).parents[2] / "config" / "scenes" / "oc4_pair.txt")
NAMES = ["body1", "body2"]
PLACES = {"body1": (-500.0, (0.0, 0.0, 1.0, 0.0)), "body2": (500.0, UPRIGHT)}
MS = 1_000_000


def sample(number, stamp, x=0.0, v=0.0):
    place, q = PLACES[NAMES[number]]
    return OfPlatform(number, Sample(stamp, (place + x, 0.0, 0.0, *q), (v, 0.0, 0.0, 0.0, 0.0, 0.0), "", "", "world"))


class Clock:
    now = 0

    def __call__(self):
        return self.now


@pytest.fixture
def session():
    clock = Clock()
    made = Session(Mooring(SCENE, platforms=NAMES), Ensemble(NAMES, Adapter()), Output(totals=2), clock=clock)
    made.set_clock = lambda ms: setattr(clock, "now", ms * MS)
    return made


def test_the_core_steps_once_for_all_and_the_schedule_done_again_gives_the_same_bits(session):
    wrenches = []
    for k in range(10):
        both = [sample(0, k * 50 * MS, 0.01 * k * k, 0.4 * k), sample(1, k * 50 * MS)]
        assert session.take(both[k % 2], None) is None
        assert session.take(both[1 - k % 2], None) == k * 50 * MS
        wrenches.append(session.wrenches[:2].copy())
    assert session.steps == 9 and session.wrenches.shape == (2 + 8, 6)
    session.wind({"line5": 950.0})
    again, records = Mooring(SCENE, platforms=NAMES), [schedule.decode(np.pad(record, (0, 28 - len(record))), NAMES) for _, record in session.actions()]
    for action, wrench in zip(records, wrenches):
        again.settle(action.pose, time=action.time) if action.kind == schedule.SETTLE else again.step(action.time, action.pose, action.twist)
        assert (again.wrench == wrench).all()
    assert records[-1].kind == schedule.WIND and records[-1].length == 950.0


def test_a_missing_platform_holds_the_output_after_the_age_with_its_name_and_comes_back(session):
    session.watch.input_age = 0.2
    for k in range(3):
        session.set_clock(10 * k)
        for number in (0, 1):
            session.take(sample(number, k * 10 * MS), None)
    assert session.state == RUN
    for k in range(3, 40):
        session.set_clock(10 * k)
        assert session.take(sample(0, k * 10 * MS), None) is None
        session.look()
    assert session.state == HOLD and session.states.cause.endswith("limit 0.2 s; waits for body2 at 0.030 s")
    assert session.take(sample(1, 390 * MS), None) == 390 * MS and session.state != HOLD


def test_before_all_have_come_it_waits_and_says_for_whom(session):
    session.take(sample(0, 0), None)
    assert session.state == IDLE and session.gate.missing == "; waits for body2 at 0.000 s"


def test_a_stiffness_that_goes_out_has_each_block_in_the_axes_of_its_two_platforms():
    """Of a scale and body axes: blocks on the diagonal as of one platform, the others turned on either side by their own."""
    stiffness, adapter = np.arange(144.0).reshape(12, 12), Adapter(wrench_frame="body", scale=50.0)
    poses = np.array([[*place, 0.0, 0.0, *q] for place, q in (((1.0,), (0.0, 0.0, 0.6, 0.8)), ((2.0,), (0.6, 0.0, 0.0, 0.8)))])
    out = stiffness_out(stiffness, adapter, poses)
    for i in range(2):
        own = slice(6 * i, 6 * i + 6)
        np.testing.assert_allclose(out[own, own], stiffness_out(stiffness[own, own], adapter, poses[i]), rtol=1e-12)
    turn = [np.kron(np.eye(2), Rotation.from_quat(pose[3:]).as_matrix()) for pose in poses]
    unscaled = stiffness_out(stiffness, Adapter(wrench_frame="body"), poses)
    np.testing.assert_allclose(unscaled[:6, 6:], turn[0].T @ stiffness[:6, 6:] @ turn[1], rtol=1e-9, atol=1e-9)


def test_the_force_limit_holds_for_each_platform():
    output = Output(force=10.0, totals=2)
    wrenches = np.zeros((3, 6))
    wrenches[:, 0] = 5.0, 20.0, 1.0
    output.start(0.0, wrenches)
    np.testing.assert_allclose(output.apply(1.0, wrenches)[:, 0], [2.5, 10.0, 0.5])


def test_in_the_timer_mode_all_are_carried_on(session):
    for k in range(2):
        session.set_clock(50 * k)
        for number in (0, 1):
            session.observe(sample(number, k * 50 * MS, 0.05 * k * number, 1.0 * number), None)
    session.set_clock(70)
    assert session.tick() == 50 * MS
    assert session.mooring.pose[1, 0] == pytest.approx(500.0 + 0.07, abs=1e-9) and session.mooring.pose[0, 0] == pytest.approx(-500.0, abs=1e-9)


class TwoPlatforms(Peer):
    """A simulator of both floaters."""

    def __init__(self, domain, process):
        super().__init__(domain, process)
        self.to = {name: self.node.create_publisher(Odometry, f"platforms/{name}/odom", 50) for name in NAMES}
        self.found = {name: [] for name in NAMES}
        self.stiffness = []
        self.listen(Float64MultiArray, "mooring/stiffness", self.stiffness.append)
        for name in NAMES:
            self.listen(WrenchStamped, f"mooring/platforms/{name}/wrench", self.found[name].append)

    def wait_for_both(self):
        self.wait(lambda: all(p.get_subscription_count() for p in self.to.values()), START, "subscriptions")
        self.wait(lambda: all(self.node.count_publishers(f"mooring/platforms/{name}/wrench") for name in NAMES))
        self.spin(0.3)

    def send_one(self, name, t, x=0.0, v=0.0):
        place, q = PLACES[name]
        message = Odometry(child_frame_id=name)
        self._fill_header(message, t, "world")
        self._fill_pose(message.pose.pose, (place + x, 0.0, 0.0), q)
        self._fill_twist(message.twist.twist, (v if name == "body2" else -v, 0.0, 0.0, 0.0, 0.0, 0.0))     # in its own axes
        self.to[name].publish(message)

    def answers(self, t):
        def found():
            heard = [next((m for m in self.found[name] if stamp_of(m) == round(t * 1e9)), None) for name in NAMES]
            return heard if all(heard) else None
        return self.wait(found, 10.0, f"both wrenches of {t} s")


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder, domain = tmp_path_factory.mktemp("platforms"), free_domain()
    process = NodeProcess(folder, {"scene": SCENE, "platforms": NAMES, "wrench_frame": "body", "limits.input_age": 0.0, "recording.enabled": True,
                                   "recording.path": str(folder / "run.mcap")}, domain)
    peer = TwoPlatforms(domain, process)
    try:
        peer.wait_for_both()
        yield folder, process, peer
    finally:
        process.end()
        peer.close()


def test_a_node_answers_each_platform_and_its_recording_replays_bit_for_bit(run):
    folder, process, peer = run
    mooring = Mooring(SCENE, platforms=NAMES)
    mooring.settle(mooring.pose_in_file)
    for k in range(20):
        t, x, v = 0.05 * k, 0.01 * k * k, 0.4 * k
        peer.send_one("body1", t)
        peer.send_one("body2", t, x, v)
        answers = peer.answers(t)
        assert [message.header.frame_id for message in answers] == NAMES
        if k:
            pose, twist = mooring.pose_in_file, np.zeros((2, 6))
            pose[1, 0], twist[1, 0] = 500.0 + x, v
            mooring.step(round(t * 1e9) * 1e-9, pose, twist)
        flip = np.array([-1.0, -1.0, 1.0, -1.0, -1.0, 1.0])   # body1 is turned by 180 degrees
        np.testing.assert_allclose(numbers(answers[0]) * flip, mooring.wrench[0], rtol=1e-12, atol=1e-6)
        np.testing.assert_allclose(numbers(answers[1]), mooring.wrench[1], rtol=1e-12, atol=1e-6)
    peer.wait(lambda: peer.stiffness, 10.0, "the stiffness")
    at_rest = Mooring(SCENE, platforms=NAMES)
    at_rest.settle(at_rest.pose_in_file)
    expected = stiffness_out(at_rest.stiffness(), Adapter(wrench_frame="body"), at_rest.pose)
    np.testing.assert_allclose(np.reshape(peer.stiffness[0].data, (12, 12)), expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())
    assert not peer.wrenches, "there is no ~/wrench of several platforms"
    peer.send_one("body1", 1.0)
    peer.diagnostic("input", lambda level, values, message: "waits for body2 at 1.000 s" in values.get("waits for", ""))
    peer.send_one("body2", 1.0, 4.0, 8.0)
    peer.answers(1.0)
    reply = peer.call("mooring/settle")
    assert reply.success and reply.message == "settled at (-500.000, 0.000, 0.000) and (504.000, 0.000, 0.000) m"
    assert process.end() == 0
    out = subprocess.run([sys.executable, "-m", "mooring_ros.offline", "replay", str(folder / "run.mcap"), str(folder / "run.mcap"), "-o", str(folder / "again.mcap"), "--accuracy",
                          "--csv", str(folder / "again.csv"), "--json"], capture_output=True, text=True, timeout=300)
    assert out.returncode == 0, out.stderr
    found = json.loads(out.stdout)
    assert found["identical"]["total"] == 21 and found["identical"]["same"] == 21 and found["answers"] == 22
    assert "samples, expected 30 or more" in found["accuracy"]["why"]
    header, *rows = (folder / "again.csv").read_text().splitlines()
    assert header.endswith("body1.fx,body1.fy,body1.fz,body1.mx,body1.my,body1.mz,body2.fx,body2.fy,body2.fz,body2.mx,body2.my,body2.mz") and len(rows) == 22
    again = subprocess.run([sys.executable, "-m", "mooring_ros.offline", "replay", SCENE, str(folder / "again.mcap"), "-o", str(folder / "third.mcap"), "--json"],
                           capture_output=True, text=True, timeout=300)
    assert again.returncode == 0 and json.loads(again.stdout)["identical"]["same"] == 22
    by_topic = subprocess.run([sys.executable, "-m", "mooring_ros.offline", "replay", SCENE, str(folder / "run.mcap"), "-o", str(folder / "topic.mcap"),
                               "--topic", "/platforms/body1/odom", "--json"], capture_output=True, text=True, timeout=300)
    assert by_topic.returncode == 0, by_topic.stderr
    assert json.loads(by_topic.stdout)["answers"] == 21 and json.loads(by_topic.stdout)["motion"] == "/platforms/body1/odom; /platforms/body2/odom"


def test_a_node_with_names_that_are_no_coupled_bodies_stays_unconfigured(tmp_path):
    process = NodeProcess(tmp_path, {"scene": SCENE, "platforms": ["body1", "hull"]}, free_domain())
    try:
        process.wait_for("the scene has no coupled body 'hull'; expected names of its coupled bodies (body1, body2)")
    finally:
        process.end()


def test_a_platform_that_falls_silent_is_named_in_the_hold_and_ends_it_when_it_is_back(tmp_path):
    """Poses alone, stamped by the wall clock."""
    domain = free_domain()
    process = NodeProcess(tmp_path, {"scene": SCENE, "platforms": NAMES, "input": "pose", "limits.input_age": 0.5}, domain)
    peer = TwoPlatforms(domain, process)
    to = {name: peer.node.create_publisher(PoseStamped, f"platforms/{name}/pose", 50) for name in NAMES}

    def send(names):
        t = time.time()
        for name in names:
            message, (place, q) = PoseStamped(), PLACES[name]
            peer._fill_header(message, t, "world")
            peer._fill_pose(message.pose, (place, 0.0, 0.0), q)
            to[name].publish(message)
        peer.spin(0.05)

    def sent_until(names, condition):
        def tried():
            send(names)
            status = peer.status.get("mooring: state")
            return status is not None and condition(status.message)
        peer.wait(tried, 20.0, f"a state while {names} send, now {peer.status.get('mooring: state')}")

    try:
        peer.wait(lambda: all(p.get_subscription_count() for p in to.values()), START, "subscriptions")
        sent_until(NAMES, lambda words: words.startswith("RUN"))
        sent_until(NAMES[:1], lambda words: words.startswith("HOLD") and "waits for body2 at" in words)
        sent_until(NAMES, lambda words: words.startswith("RUN"))
    finally:
        process.end()
        peer.close()
