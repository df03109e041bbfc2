"""The managed node's transitions, asked for over DDS."""
import os
import subprocess

import numpy as np
import pytest
from lifecycle_msgs.srv import ChangeState
from node_peer import SCENE, UPRIGHT, node_and_peer

from mooring_ros.mooring import Mooring
from mooring_ros.node.diagnostics import ERROR


def threads(process):
    return len(os.listdir(f"/proc/{process.process.pid}/task"))


def memory(process):
    """Resident kB."""
    return int(subprocess.check_output(["ps", "-o", "rss=", "-p", str(process.process.pid)]))


def static_wrench(scene, x=0.0):
    mooring = Mooring(scene)
    mooring.settle(np.array([x, 0.0, 0.0, *UPRIGHT]))
    return mooring.wrench


@pytest.fixture(scope="module")
def managed(tmp_path_factory):
    with node_and_peer(tmp_path_factory.mktemp("managed"), autostart=False) as (process, peer):
        yield process, peer


def test_cycles_through_all_states_leave_nothing_behind(managed):
    process, peer = managed
    used = []
    for cycle in range(5):
        assert peer.state() == "unconfigured"
        assert peer.transition("configure") and peer.state() == "inactive"
        assert peer.node.count_subscribers("platform/odom") == 0
        assert peer.transition("activate") and peer.state() == "active"
        peer.wait_for_node()
        np.testing.assert_array_equal(peer.ask(10.0 * cycle), static_wrench(SCENE))
        peer.ask(10.0 * cycle + 0.1)
        assert peer.transition("deactivate") and peer.state() == "inactive"
        assert peer.transition("cleanup")
        peer.wait(lambda: peer.node.count_publishers("mooring/wrench") == 0, what="the outputs to go")
        used.append((threads(process), memory(process)))
    assert used[-1][0] <= used[1][0]
    assert used[-1][1] < used[1][1] + 20_000


def test_a_transition_that_there_is_none_of_is_refused_and_the_node_lives_on(managed):
    process, peer = managed
    assert not peer.transition("activate") and not peer.transition("deactivate") and not peer.transition("cleanup")
    unknown = ChangeState.Request()
    unknown.transition.id = 77
    assert not peer.call("mooring/change_state", ChangeState, unknown).success
    unknown.transition.label = "explode"
    assert not peer.call("mooring/change_state", ChangeState, unknown).success
    assert peer.state() == "unconfigured" and "expected one of configure (1)" in process.log


def test_a_bad_scene_is_a_failed_configure_with_file_and_line_and_another_scene_works(managed, tmp_path):
    process, peer = managed
    bad = tmp_path / "bad.txt"
    text = open(SCENE, encoding="utf-8").read().splitlines()
    row = next(k for k, line in enumerate(text) if "LINE TYPES" in line) + 3
    text[row] = text[row].replace(text[row].split()[1], "abc", 1)
    bad.write_text("\n".join(text), encoding="utf-8")
    assert peer.set("scene", str(bad)).successful
    assert not peer.transition("configure") and peer.state() == "unconfigured"
    place = f"{bad}:{row + 1}: "
    _, _, message = peer.diagnostic("core", lambda level, *_: level == ERROR)
    assert message.startswith(place) and place in process.log

    other = SCENE.replace("oc4", "volturnus_s_chain")
    assert peer.set("scene", other).successful
    assert peer.transition("configure") and peer.transition("activate")
    peer.wait_for_node()
    refused = peer.set("scene", SCENE)
    assert not refused.successful and "fixed while configured" in refused.reason
    np.testing.assert_array_equal(peer.ask(0.0), static_wrench(other))
    assert peer.transition("deactivate") and peer.transition("cleanup")


def test_a_deactivated_node_is_silent_and_starts_anew_when_activated(managed):
    _, peer = managed
    assert peer.set("scene", SCENE).successful
    assert peer.transition("configure") and peer.transition("activate")
    peer.wait_for_node()
    peer.ask(50.0)
    peer.ask(50.5, 0.5, 1.0)
    assert peer.transition("deactivate")
    reply = peer.call("mooring/settle")
    assert not reply.success and "not active" in reply.message
    count = len(peer.wrenches)
    peer.send(51.0)
    peer.spin(0.3)
    assert len(peer.wrenches) == count
    assert peer.transition("activate")
    peer.wait_for_node()
    np.testing.assert_array_equal(peer.ask(20.0, 4.0), static_wrench(SCENE, 4.0))
    assert peer.transition("deactivate") and peer.transition("cleanup")


def test_a_recording_that_cannot_be_made_is_a_failed_configure(managed, tmp_path):
    _, peer = managed
    file = tmp_path / "file"
    file.write_text("")
    assert peer.set("recording.enabled", True).successful and peer.set("recording.path", str(file / "run.mcap")).successful
    assert not peer.transition("configure") and peer.state() == "unconfigured"
    peer.diagnostic("core", lambda level, values, message: level == ERROR and "run.mcap" in message)
    assert peer.set("recording.enabled", False).successful and peer.set("recording.path", "").successful
