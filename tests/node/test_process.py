"""The node as a process: signals, exit statuses, and what is in its recording."""
import signal
import subprocess
import sys

import pytest
from mcap.reader import make_reader
from node_peer import SCENE, node_and_peer
from rclpy.serialization import serialize_message

from mooring_ros.node.clean_cdr import serialize
from mooring_ros.node.diagnostics import ERROR
from mooring_ros.recording import schedule


@pytest.mark.parametrize("number, times", [(signal.SIGTERM, 1), (signal.SIGINT, 3)], ids=["SIGTERM", "SIGINT thrice"])
def test_a_signal_ends_it_with_status_zero_and_a_closed_recording(tmp_path, number, times):
    file = tmp_path / "run.mcap"
    with node_and_peer(tmp_path, recording__enabled=True, recording__path=str(file)) as (process, peer):
        peer.wait_for_node()
        sent = []
        for k in range(20):
            sent.append(serialize_message(peer.send(1.0 + 0.05 * k, 0.01 * k, 0.2)))
            peer.answer(1.0 + 0.05 * k)
        peer.send(1.0)      # refused, and recorded all the same
        assert peer.call("mooring/lines/line3/release").success
        peer.ask(2.0, 0.2, 0.2)
        peer.spin(0.1)
        heard = [serialize(m) for m in peer.wrenches]
        assert process.end(number, times) == 0
        assert "Traceback" not in (tmp_path / "node.log").read_text(encoding="utf-8")
    with open(file, "rb") as stream:
        reader = make_reader(stream)
        summary = reader.get_summary()
        messages = {}
        for schema, channel, message in reader.iter_messages():
            messages.setdefault((channel.topic, schema.name), []).append(message)
        attachments = list(reader.iter_attachments())
    assert summary.statistics.message_count == sum(map(len, messages.values()))
    inputs = messages["/platform/odom", "nav_msgs/msg/Odometry"]
    assert [m.data for m in inputs[:20]] == sent and len(inputs) == 22
    wrenches = messages["/mooring/wrench", "geometry_msgs/msg/WrenchStamped"]
    assert [m.data for m in wrenches] == heard
    assert [m.publish_time for m in wrenches] == [round((1.0 + 0.05 * k) * 1e9) for k in range(20)] + [2_000_000_000]
    steps = messages["/mooring/steps", schedule.TYPE_NAME]
    kinds = [schedule.decode(memoryview(m.data)[-8 * schedule.LENGTH:].cast("d")).kind for m in steps]
    assert kinds == [schedule.SETTLE] + 19 * [schedule.STEP] + [schedule.RELEASE, schedule.STEP]
    assert attachments[0].data == open(SCENE, "rb").read()
    names = {topic for topic, _ in messages}
    assert {"/mooring/lines", "/mooring/line_tensions", "/mooring/nodes", "/mooring/markers", "/mooring/fairleads/point4/wrench"} <= names


def test_a_missing_scene_is_said_loudly_and_the_node_lives_on(tmp_path):
    with node_and_peer(tmp_path, scene="nowhere/scene.txt") as (process, peer):
        _, values, message = peer.diagnostic("core", lambda level, *_: level == ERROR, timeout=30.0)
        assert message.startswith("nowhere/scene.txt") and values["state"] == "unconfigured"
        assert "FATAL" in process.log and "nowhere/scene.txt" in process.log
        assert peer.set("scene", SCENE).successful
        assert peer.transition("configure") and peer.transition("activate")
        peer.wait_for_node()
        peer.ask(0.0)


@pytest.mark.parametrize("arguments, words", [
    (["-p", "convention:=nwu"], "convention"),
    (["-p", "solver:=leapfrog"], "explicit"),
    (["-p", "fidelity:=line1=quick"], "quick"),
    (["-p", "timing.rate:=-5"], "timing.rate"),
    (["-p", "dt:=abc"], "dt"),
    (["--params-file", "nowhere.yaml"], "nowhere.yaml"),
])
def test_wrong_parameters_end_with_status_two_and_one_line(arguments, words):
    done = subprocess.run([sys.executable, "-m", "mooring_ros.node", "--ros-args", *arguments], capture_output=True, text=True, timeout=60)
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1 and words in done.stderr


def test_unknown_arguments_are_refused():
    done = subprocess.run([sys.executable, "-m", "mooring_ros.node", "scene.txt"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and "scene.txt" in done.stderr and "--help" in done.stderr
