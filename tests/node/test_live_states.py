"""The states as they are seen from outside the process."""
import json
import subprocess
import sys

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from mcap.reader import make_reader
from node_peer import SCENE, UPRIGHT, node_and_peer, numbers, stamp_of
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message
from std_msgs.msg import Empty

from mooring_ros.mooring import Mooring
from mooring_ros.node.diagnostics import ERROR, OK, WARN
from mooring_ros.node.states import HOLD, IDLE, RAMP, RUN, SAFE


def static(x):
    mooring = Mooring(SCENE)
    mooring.settle(np.array([x, 0.0, 0.0, *UPRIGHT]))
    return mooring.wrench


def told(status):
    return {pair.key: pair.value for pair in status.values}


def test_an_input_that_stops_is_followed_by_the_ramp_to_the_static_wrench_and_one_that_comes_back_by_the_answers(tmp_path):
    file = tmp_path / "run.mcap"
    with node_and_peer(tmp_path, limits__input_age=1.0, recording__enabled=True, recording__path=str(file)) as (process, peer):
        peer.wait_for_node()
        states, clock = [], peer.node.get_clock()
        peer.node.create_subscription(DiagnosticStatus, "mooring/state", states.append, QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL))
        sent = []
        for k in range(30):
            sent.append(clock.now().nanoseconds)
            peer.send(sent[-1] * 1e-9, 0.05 * k, 1.0)
            peer.spin(0.05)
        peer.wait(lambda: len(peer.wrenches) == 30)
        answer = numbers(peer.wrenches[-1])
        peer.diagnostic("state", lambda level, values, _: level == WARN and values["state"] == HOLD, timeout=10.0)
        target = static(1.45)
        peer.wait(lambda: np.allclose(numbers(peer.wrenches[-1]), target, rtol=1e-5, atol=100.0), what="the static wrench")
        held = peer.wrenches[30:]
        assert len(held) > 5 and {round(stamp_of(m), -4) for m in held} == {round(stamp_of(peer.wrenches[29]), -4)}
        np.testing.assert_allclose(numbers(held[0]), answer, rtol=1e-2)
        for k in range(30):
            peer.send(clock.now().nanoseconds * 1e-9, 1.45)
            peer.spin(0.05)
        peer.diagnostic("state", lambda level, values, _: level == OK and values["state"] == RUN)
        assert [status.message for status in states] == [RAMP, RUN, HOLD, RAMP, RUN]
        assert told(states[2])["cause"].startswith("no good input for 1.") and "RUN -> HOLD, input lost: no good input" in process.log
        assert peer.transition("deactivate")
        peer.wait(lambda: states[-1].message == IDLE)
        process.end()
    with open(file, "rb") as stream:
        entries = [(channel.topic, message) for _, channel, message in make_reader(stream).iter_messages()]
    recorded = [deserialize_message(message.data, DiagnosticStatus) for topic, message in entries if topic == "/mooring/state"]
    assert [status.message for status in recorded] == [RAMP, RUN, HOLD, RAMP, RUN, IDLE]
    arrays = [deserialize_message(message.data, DiagnosticArray) for topic, message in entries if topic == "/diagnostics"]
    assert any("HOLD: no good input" in status.message for array in arrays for status in array.status)
    times = [message.log_time for topic, message in entries if topic == "/mooring/wrench"]
    assert sorted(times) == times and len(times) > 65      # the ramp has times of its own
    replay = [sys.executable, "-m", "mooring_ros.offline", "replay", file, file, "-o", tmp_path / "again.mcap", "--json"]
    identical = json.loads(subprocess.run(replay, capture_output=True, text=True, check=True).stdout)["identical"]
    tensions = sum(topic == "/mooring/line_tensions" for topic, _ in entries)
    assert identical == {"same": tensions, "total": tensions} and tensions >= 50
    assert len([topic for topic, _ in entries if topic == "/mooring/timing"]) >= 3


def test_a_lost_heartbeat_is_a_fault_until_somebody_settles(tmp_path):
    with node_and_peer(tmp_path, limits__heartbeat=1.0, ramp_time=0.5) as (_, peer):
        beats = peer.node.create_publisher(Empty, "mooring/heartbeat", 10)
        peer.wait_for_node()
        peer.wait(lambda: beats.get_subscription_count())
        peer.send(0.0)
        peer.diagnostic("state", lambda level, values, message: values["state"] == IDLE and "no heartbeat yet" in message)
        assert not peer.wrenches
        for k in range(1, 30):
            beats.publish(Empty())
            peer.spin(0.02)
            peer.ask(0.05 * k)
        peer.diagnostic("state", lambda level, values, _: values["state"] == RUN)
        _, values, _ = peer.diagnostic("state", lambda level, values, _: level == ERROR and values["state"] == SAFE)
        assert values["cause"].startswith("no heartbeat for 1.")
        reply = peer.call("mooring/settle")
        assert not reply.success and "heartbeat" in reply.message
        beats.publish(Empty())
        peer.spin(0.02)
        assert peer.call("mooring/settle").success
        beats.publish(Empty())
        peer.diagnostic("state", lambda level, values, _: values["state"] == RAMP)
