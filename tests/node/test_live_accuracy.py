"""The live estimate of the accuracy: it comes, it says what it is, it disturbs nothing, and it ends with the node however that ends."""
import os
import signal
import time
from pathlib import Path

import numpy as np
import pytest
from node_peer import SCENE, UPRIGHT, node_and_peer

from mooring_ros.accuracy_worker import BURST, Throttle
from mooring_ros.mooring import Mooring
from mooring_ros.node.accuracy import ROWS, Companion, report
from mooring_ros.node.timing import Pace
from mooring_ros.recording import schedule

RATE = 2.0 * np.pi / 6.0


def children(pid):
    """Ids of the processes that a process has started and that run."""
    return [int(child) for task in Path(f"/proc/{pid}/task").iterdir() for child in (task / "children").read_text().split()]


def runs(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().split()[2] != "Z"
    except OSError:
        return False


def gone(pids, within=60.0):
    end = time.monotonic() + within
    while any(map(runs, pids)) and time.monotonic() < end:
        time.sleep(0.02)
    return not any(map(runs, pids))


def swing(k, step):
    return np.sin(RATE * k * step), RATE * np.cos(RATE * k * step)


def test_a_running_node_says_how_accurate_and_how_fast_it_is_with_the_bits_of_the_facade(tmp_path):
    with node_and_peer(tmp_path, accuracy__window=6.0, accuracy__share=1.0) as (process, peer):
        peer.wait_for_node()
        mooring = Mooring(SCENE)
        _, values, words = peer.diagnostic("accuracy")
        assert words == "not active" and not values
        for k in range(140):
            place, speed = swing(k, 0.05)
            wrench = peer.ask(0.05 * k, place, speed)
            pose = np.array([place, 0, 0, *UPRIGHT])
            mooring.step(k * 50_000_000 * 1e-9, pose, np.array([speed, 0, 0, 0, 0, 0])) if k else mooring.settle(pose)
            np.testing.assert_array_equal(wrench, mooring.wrench)
        (child,) = children(process.process.pid)
        assert os.sched_getscheduler(child) == os.SCHED_IDLE or os.getpriority(os.PRIO_PROCESS, child) == 19
        _, values, words = peer.diagnostic("accuracy", lambda level, values, _: "mean error (%)" in values, timeout=150.0)
        assert 0.0 < float(values["mean error (%)"]) < 5.0 and 0.0 < float(values["dynamic error (%)"]) < 50.0
        assert values["worst line"] in mooring.line_names and "twice the segments (60 to 120) and half the step" in values["compared"]
        assert float(values["to (s)"]) - float(values["from (s)"]) == pytest.approx(4.0, abs=0.2) and float(values["estimate's age (s)"]) < 60.0
        assert float(values["real-time factor"]) > 1.0 and float(values["worst step (ms)"]) > 0.0
        assert any(what in values["step limited by"] for what in ("stability", "accuracy", "pace", "passing"))
        assert process.end(signal.SIGTERM) == 0
        assert gone([child])


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_its_process_ends_with_the_node(tmp_path, number):
    with node_and_peer(tmp_path) as (process, peer):
        peer.wait_for_node()
        peer.ask(0.0)
        started = children(process.process.pid)
        assert len(started) == 1
        process.end(number)
        assert gone(started)


def test_switched_off_there_is_no_process_and_the_rest_is_still_said(tmp_path):
    with node_and_peer(tmp_path, accuracy__enabled=False) as (process, peer):
        peer.wait_for_node()
        for k in range(5):
            peer.ask(0.05 * k)
        assert children(process.process.pid) == []
        _, values, words = peer.diagnostic("accuracy", lambda level, values, _: "worst step (ms)" in values)
        assert words == "estimate switched off" and float(values["worst step (ms)"]) > 0.0


def wait(companion, condition, timeout=120.0):
    end = time.monotonic() + timeout
    while not condition():
        companion.poll(time.monotonic())
        assert time.monotonic() < end
        time.sleep(0.05)


@pytest.fixture
def linear():
    """A linear mooring that has been settled and a companion for it with a window of 6 s."""
    mooring = Mooring(SCENE, fidelity="linear")
    mooring.settle([0, 0, 0, *UPRIGHT])
    companion = Companion(mooring, {"fidelity": "linear"}, share=1.0, window=6.0)
    yield mooring, companion
    companion.close()


def move(companion, count, step=0.05, start=0):
    companion.note([(0, schedule.encode_settle(0.0, [0, 0, 0, *UPRIGHT]))] if not start else [])
    for k in range(start + 1, start + count + 1):
        place, speed = swing(k, step)
        companion.note([(0, schedule.encode_step(k * step, [place, 0, 0, *UPRIGHT], [speed, 0, 0, 0, 0, 0]))])


def test_a_cheaper_fidelity_is_compared_with_the_dynamics(linear):
    mooring, companion = linear
    move(companion, 60)
    companion.poll(0.0)
    assert not companion.busy and "6 s of motion" in companion.waits_for
    move(companion, 80, start=60)
    wait(companion, lambda: companion.latest)
    assert "dynamics" in companion.latest["compared"] and companion.latest["dynamic"] > 5.0
    words, values = report(companion, Pace(), mooring, time.monotonic())
    assert words.startswith("tensions within") and "error of linearising now (%)" in values
    companion.poll(0.0)
    assert not companion.busy  # the same window is not solved twice
    move(companion, 80, start=140)
    companion.poll(0.0)
    assert companion.busy


def test_a_process_that_dies_is_said_and_nothing_waits_for_it(linear):
    mooring, companion = linear
    companion._process.kill()
    move(companion, 140)
    wait(companion, lambda: companion.ended, timeout=10.0)
    words, _ = report(companion, Pace(), mooring, 0.0)
    assert "ended with status -9" in words


def test_fast_samples_are_thinned_and_memory_is_bounded(linear):
    _, companion = linear
    move(companion, 30_000, step=1e-3)
    assert companion._count <= 2 * ROWS
    times = companion._rows[: companion._count, 0]
    assert times[-1] == pytest.approx(30.0, abs=0.01) and times[-1] - times[0] > 6.0 and (np.diff(times) >= 6.0 / ROWS).all()


def test_over_the_long_run_no_more_than_its_share_is_taken():
    now, slept = 0.0, 0.0

    def sleep(seconds):
        nonlocal now, slept
        now, slept = now + seconds, slept + seconds

    throttle = Throttle(0.05, sleep, lambda: now)
    for _ in range(200):
        now += 0.03
        throttle(0.03)
    assert 200 * 0.03 - BURST <= 0.05 * now * 1.001
    assert slept > 0.0


def test_the_pace_counts_steps_alone():
    pace, last = Pace(), {"evaluations": 7, "retries": 2, "uneven": 0}
    assert pace.real_time_factor is None
    pace.add(0.0, 10**12, last)
    for k in range(1, 11):
        pace.add(0.1 * k, (5 if k == 4 else 1) * 10**6, last)
    assert pace.real_time_factor == pytest.approx(1.0 / 14e-3)
    assert pace.worst == (5 * 10**6, pytest.approx(0.4), 7, 2)
    assert pace.uneven == 0
    pace.add(1.1, 10**6, {**last, "uneven": 3})
    assert pace.uneven == 1
    pace.add(0.0, 10**12, last)
    assert pace.real_time_factor is None and pace.worst[0] == 5 * 10**6
