"""The node process under /clock, coupled with the helper: pause, reset, jumps. One process each policy."""
import time

import numpy as np
import pytest
from rosgraph_msgs.msg import Clock
from node_peer import SCENE, node_and_peer

from mooring_ros.coupling import Coupling, LinkError
from mooring_ros.mooring import Mooring
from mooring_ros.node.diagnostics import ERROR, OK

HOME = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
STEP = 0.05


def surge(mooring, seconds):
    """Couple along a slow surge from where the simulation stands; the last wrench."""
    end, start = mooring.time + seconds, mooring.time
    while mooring.time < end - 0.5 * STEP:
        t = mooring.time + STEP - start
        mooring.exchange(HOME + [1.0 - np.cos(0.3 * t), 0, 0, 0, 0, 0, 0], [0.3 * np.sin(0.3 * t), 0, 0, 0, 0, 0])
    return mooring.wrench


@pytest.fixture
def coupled(tmp_path, monkeypatch):
    """start(**parameters) -> (Coupling, Peer) of a new node process with use_sim_time."""
    closing = []

    def start(**parameters):
        running = node_and_peer(tmp_path, use_sim_time=True, **parameters)
        process, peer = running.__enter__()
        closing.append(lambda: running.__exit__(None, None, None))
        peer.wait_for_node()
        peer.node.destroy_publisher(peer._odometry)     # two would be a warning
        monkeypatch.setenv("ROS_DOMAIN_ID", str(peer.node.context.get_domain_id()))
        mooring = Coupling(STEP, clock=True, patience=5.0)
        closing.append(mooring.close)
        return mooring, peer

    yield start
    for close in reversed(closing):
        close()


def test_a_pause_is_no_fault_and_changes_no_bit(coupled):
    mooring, peer = coupled(limits__input_age=0.2)
    mooring.begin(HOME)
    surge(mooring, 2.0)
    time.sleep(2.5)     # ten times the age that is allowed, while simulated time stands still
    peer.spin(0.1)
    assert peer.diagnostic("core", lambda level, *_: level == OK) and peer.diagnostic("input", lambda level, *_: level == OK)
    last = surge(mooring, 2.0)
    assert mooring.counts.lost == mooring.counts.late == mooring.counts.doubled == 0
    assert peer.diagnostic("input", lambda _, values, __: values["rejected"] == "0" and values["lost steps"] == "0")
    assert np.isfinite(last).all()


def test_a_reset_settles_anew_where_the_policy_says_so(coupled):
    mooring, peer = coupled(on_reset="settle")
    mooring.begin(HOME)
    first = surge(mooring, 1.0)
    again = mooring.reset(HOME)
    fresh = Mooring(SCENE)
    fresh.settle(HOME)
    np.testing.assert_array_equal(again, fresh.wrench)
    assert mooring.time == pytest.approx(1.0)
    np.testing.assert_array_equal(surge(mooring, 1.0), first)
    peer.diagnostic("input", lambda _, values, words: values["resets"] == "1" and values["rejected"] == "0" and "went back" in words)


def test_refused_a_reset_is_said_with_its_remedy_and_settle_is_the_way_out(coupled):
    mooring, peer = coupled()
    mooring.begin(HOME)
    surge(mooring, 1.0)
    mooring.patience = 1.5
    with pytest.raises(LinkError, match="on_reset: settle"):
        mooring.reset(HOME)
    peer.diagnostic("input", lambda level, values, words: level == ERROR and values["reordered"] != "0" and "~/settle" in words)
    assert peer.call("mooring/settle").success
    mooring.patience = 5.0
    assert np.isfinite(mooring.reset(HOME + [1.0, 0, 0, 0, 0, 0, 0])).all()


def test_a_jump_forward_is_refused(coupled):
    mooring, peer = coupled()
    mooring.begin(HOME)
    surge(mooring, 0.5)
    mooring.patience = 0.5
    for k in range(2):
        mooring.exchange(HOME, np.zeros(6), at=3600.0 + STEP * k)
    assert mooring.counts.lost == 2
    peer.diagnostic("input", lambda level, values, words: level != OK and values["jump"] == "2" and "jump" in words)


def test_the_mode_timer_stands_still_with_the_clock(tmp_path):
    with node_and_peer(tmp_path, use_sim_time=True, timing__mode="timer", timing__rate=50.0) as (_, peer):
        peer.wait_for_node()
        clock = peer.node.create_publisher(Clock, "/clock", 10)
        peer.wait(clock.get_subscription_count, what="the node on /clock")
        for k in range(60):     # at half the speed of a wall clock, once it has settled
            message = Clock()
            message.clock.sec, message.clock.nanosec = 1, 10_000_000 * k
            clock.publish(message)
            peer.send(1.0 + 0.01 * k)
            if k == 0:
                peer.wait(lambda: peer.wrenches, what="the settle")
            peer.spin(0.02)
        peer.spin(0.3)
        heard = len(peer.wrenches)
        assert 5 < heard < 45      # 30 periods of simulated time, not the 75 of the wall clock's
        peer.spin(1.0)
        assert len(peer.wrenches) <= heard + 1
        peer.diagnostic("core", lambda level, *_: level == OK)
