"""The node in lockstep with a peer over DDS: answers, refusals, services. One process; each test has a session of its own."""
import math

import numpy as np
import pytest
from node_peer import SCENE, numbers, node_and_peer, stamp_of
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import PointCloud2
from visualization_msgs.msg import MarkerArray

from mooring_ros.mooring import Mooring
from mooring_ros.node.diagnostics import ERROR, OK, WARN
from mooring_ros.node.parameters import TABLE

HOME = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    with node_and_peer(tmp_path_factory.mktemp("lockstep")) as (process, peer):
        peer.wait_for_node()
        yield process, peer


@pytest.fixture
def peer(running):
    running[1].restart()
    yield running[1]
    for entry in TABLE:
        if not entry.fixed:
            running[1].set(entry.name, entry.default)


def surge(t):
    return 2.0 * math.sin(0.5 * t), math.cos(0.5 * t)


def pose(x):
    return np.array([x, *HOME[1:]])


def twist(v):
    return np.array([v, 0.0, 0.0, 0.0, 0.0, 0.0])


def test_each_input_gets_one_wrench_with_its_stamp(peer):
    times = [100.0 + 0.01 * k for k in range(100)]
    for t in times:
        peer.ask(t, *surge(t))
    peer.spin(0.2)
    assert [stamp_of(m) for m in peer.wrenches] == [round(t * 1e9) for t in times]
    assert {m.header.frame_id for m in peer.wrenches} == {"world"}
    peer.diagnostic("input", lambda level, values, _: level == OK and values["accepted"] == "100" and values["rejected"] == "0")


def test_a_burst_of_inputs_is_answered_one_by_one(peer):
    peer.ask(0.0)
    for k in range(1, 60):
        peer.send(0.01 * k)
    peer.wait(lambda: len(peer.wrenches) == 60, what="60 wrenches")


def test_answers_are_bit_for_bit_those_of_the_facade(peer):
    mooring = Mooring(SCENE)
    mooring.settle(pose(3.0), time=5.0)
    np.testing.assert_array_equal(peer.ask(5.0, 3.0), mooring.wrench)
    for k in range(1, 30):
        t = 0.05 * k
        mooring.step(round((5.0 + t) * 1e9) * 1e-9, pose(3.0 + t * t), twist(2.0 * t))
        np.testing.assert_array_equal(peer.ask(5.0 + t, 3.0 + t * t, 2.0 * t), mooring.wrench)
    peer.wait(lambda: len(peer.lines) == 30 and len(peer.tensions) == 30)
    lines, tensions = peer.lines[-1], peer.tensions[-1]
    assert lines.name == mooring.line_names
    np.testing.assert_array_equal(lines.effort, mooring.fairlead_tension)
    np.testing.assert_array_equal(lines.position, mooring.stretched_length)
    np.testing.assert_array_equal(lines.velocity, mooring.length_rate)
    assert [(d.label, d.size, d.stride) for d in tensions.layout.dim] == [("line", 3, 6), ("end", 2, 2)]
    np.testing.assert_array_equal(np.reshape(tensions.data, (3, 2)), np.column_stack((mooring.anchor_tension, mooring.fairlead_tension)))


def test_fairlead_wrenches_add_up_to_the_total(peer):
    heard = {}
    mooring = Mooring(SCENE)
    subscriptions = [peer.listen(WrenchStamped, f"mooring/fairleads/{name}/wrench", lambda m, name=name: heard.setdefault(name, m))
                     for name in mooring.coupled_names]
    peer.spin(0.3)
    total = peer.ask(1.0, 2.0)
    peer.wait(lambda: len(heard) == len(mooring.coupled_names), what="the fairleads")
    np.testing.assert_allclose(sum(numbers(m)[:3] for m in heard.values()), total[:3], rtol=1e-9, atol=1e-3)
    assert {stamp_of(m) for m in heard.values()} == {1_000_000_000}
    for subscription in subscriptions:
        peer.node.destroy_subscription(subscription)


def test_nodes_and_markers_come_at_the_visual_rate(peer):
    clouds, markers = [], []
    subscriptions = [peer.listen(PointCloud2, "mooring/nodes", clouds.append), peer.listen(MarkerArray, "mooring/markers", markers.append)]
    peer.spin(0.3)
    for k in range(41):
        peer.ask(0.025 * k)
    peer.spin(0.2)
    assert len(clouds) == len(markers) == 11
    mooring = Mooring(SCENE)
    mooring.settle(HOME)
    points = np.frombuffer(bytes(clouds[0].data), dtype=[(field.name, "<f4") for field in clouds[0].fields])
    first = points[points["line"] == 0]
    np.testing.assert_allclose(np.column_stack([first[axis] for axis in "xyz"]), mooring.node_positions("line1"), rtol=1e-6, atol=1e-4)
    np.testing.assert_allclose(first["tension"], mooring.node_tension("line1"), rtol=1e-6)
    assert {m.ns for m in markers[0].markers} == {"lines", "seabed", "anchors"}
    assert all(len(m.points) == len(m.colors) for m in markers[0].markers if m.ns == "lines")
    for subscription in subscriptions:
        peer.node.destroy_subscription(subscription)


def test_steps_that_were_left_out_are_counted_and_told(peer):
    for k in range(40):
        if k not in (20, 30, 31):
            peer.ask(0.01 * k)
    _, values, message = peer.diagnostic("input", lambda level, values, _: level == WARN and values["lost steps"] == "3")
    assert values["gaps"] == "2" and values["nominal step (s)"] == "0.01" and "3 steps were lost" in message


BAD = {
    "non_finite": dict(t=1.01, x=math.nan),
    "quaternion": dict(t=1.01, q=(0.0, 0.0, 0.0, 0.0)),
    "repeated": dict(t=1.0),
    "reordered": dict(t=0.5),
    "jump": dict(t=1.01, x=300.0),
    "frame": dict(t=1.01, frame="somewhere_else"),
}


@pytest.mark.parametrize("reason", BAD)
def test_bad_input_is_counted_and_gets_no_wrench(peer, reason):
    peer.ask(0.9)
    peer.ask(1.0)
    peer.send(**BAD[reason])
    _, _, message = peer.diagnostic("input", lambda level, values, _: level != OK and values[reason] == "1" and values["rejected"] == "1")
    assert reason in message
    assert len(peer.wrenches) == 2
    assert np.isfinite(peer.ask(1.02)).all()


def test_old_input_is_refused_by_the_nodes_clock(peer):
    assert peer.set("limits.input_age", 0.5).successful
    now = peer.node.get_clock().now().nanoseconds * 1e-9
    peer.send(now - 5.0)
    peer.diagnostic("input", lambda level, values, _: level == ERROR and values["stale"] == "1")
    peer.ask(peer.node.get_clock().now().nanoseconds * 1e-9)


def test_a_new_place_is_taken_by_settle_only(peer):
    peer.ask(0.0)
    for k in range(1, 13):
        peer.send(0.01 * k, x=20.0)
    peer.diagnostic("input", lambda _, values, message: values["jump"] == "12" and "~/settle" in message)
    assert len(peer.wrenches) == 1
    reply = peer.call("mooring/settle")
    assert reply.success and "new place" in reply.message
    mooring = Mooring(SCENE)
    mooring.settle(pose(20.0))
    np.testing.assert_allclose(peer.ask(0.13, x=20.0), mooring.wrench, rtol=1e-3, atol=1e3)


def test_settle_without_input_says_so(peer):
    reply = peer.call("mooring/settle")
    assert not reply.success and "no valid input" in reply.message


def test_hold_ramps_to_the_static_wrench_at_the_last_pose_until_settle(peer):
    static = peer.ask(0.0)
    moved = peer.ask(1.0, 1.5, 2.0)
    assert abs(moved[0] - static[0]) > 1e3
    assert peer.call("mooring/hold").success
    peer.diagnostic("core", lambda level, _, message: level == WARN and "held" in message)
    mooring = Mooring(SCENE)
    mooring.settle(pose(1.5))
    for k in range(5):
        peer.ask(1.5 + k, 2.5 + 2.0 * k, 2.0)
    np.testing.assert_allclose(peer.ask(6.5, 12.5, 2.0), mooring.wrench, rtol=1e-6, atol=1.0)
    assert peer.call("mooring/settle").success
    peer.ask(6.6, 12.7, 2.0)
    assert abs(peer.ask(8.0, 15.5, 2.0)[0] - static[0]) > 1e3


def test_a_released_line_pulls_no_more(peer):
    peer.ask(0.0)
    before = peer.wait(lambda: peer.lines and peer.lines[-1].effort[1])
    assert peer.call("mooring/lines/line2/release").success
    for k in range(1, 100):
        peer.ask(0.02 * k)
    peer.wait(lambda: len(peer.lines) == 100)
    assert peer.lines[-1].effort[1] < 0.1 * before
    assert peer.lines[-1].effort[0] > 0.5 * before


def test_a_wrench_over_the_limit_is_scaled_down_and_an_error(peer):
    assert peer.set("limits.force", 1000.0).successful
    wrench = peer.ask(0.0, 10.0)
    assert np.linalg.norm(wrench[:3]) == pytest.approx(1000.0)
    peer.diagnostic("core", lambda level, values, _: level == ERROR and values["force limit reached"] == "1")


def test_a_twist_in_world_axes_is_found_out_when_child_was_said(peer):
    half = 0.25 * math.pi
    q = (0.0, 0.0, math.sin(half), math.cos(half))      # heading 90 degrees
    for k in range(80):
        t = 0.05 * k
        x, v = surge(t)
        peer.send(t, x, v, q=q)
    _, _, message = peer.diagnostic("input", lambda level, values, _: level == ERROR and values["received"] == "80")
    assert "twist_frame world" in message
    assert len(peer.wrenches) < 80
    peer.diagnostic("core", lambda level, *_: level == ERROR)


def test_a_step_that_cannot_be_done_gives_no_input_a_wrench_until_settled_again(peer):
    for name in ("jump", "jump_speed", "jump_angle", "jump_rate", "gap"):
        assert peer.set(f"limits.{name}", 0.0).successful
    static = peer.ask(0.0)
    peer.send(0.001, x=1e300)
    _, _, message = peer.diagnostic("core", lambda level, *_: level == ERROR)
    assert "~/settle" in message
    peer.send(0.01)
    peer.send(0.02)
    peer.spin(1.3)
    assert {stamp_of(m) for m in peer.wrenches} == {0}
    np.testing.assert_allclose(numbers(peer.wrenches[-1]), static, rtol=1e-6, atol=1.0)
    assert peer.call("mooring/settle").success
    assert np.isfinite(peer.ask(0.03)).all()
