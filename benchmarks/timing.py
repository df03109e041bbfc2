"""How punctual the node is in its mode timer: steps at 200 and 500 Hz, idle and beside a load, with and without SCHED_FIFO, beside an empty loop.

The empty loop is the node's own (mooring_ros.node.loop, on an rclpy executor), whose cycle does nothing. The two take turns, so that both meet the same
machine. The figures are the node's own histograms (~/timing), whose bins are 12 % wide: a percentile is the upper edge of its bin, the maximum is exact.
"""
import argparse
import contextlib
import gc
import itertools
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState, GetState
from nav_msgs.msg import Odometry
from rclpy.experimental.events_executor import EventsExecutor
from std_msgs.msg import Float64MultiArray

from mooring_ros.node import realtime
from mooring_ros.node.histogram import BINS, quantile
from mooring_ros.node.loop import Loop
from mooring_ros.node.punctuality import Punctuality
from mooring_ros.node.timing import FixedRate

from . import tables
from .domains import free_domain
from .node_latency import motion

ROOT = Path(__file__).parent.parent
SCENE = ROOT / "config" / "scenes" / "oc4.txt"
RATES, ROUNDS, PRIORITY = (200.0, 500.0), 5, 50
INPUT_RATE = 100.0      # Hz, of the motion that the node is given
START = 600.0           # s, cold compilation included, on a busy machine
SHARES = (0.5, 0.99, 0.999)


def add_arguments(parser):
    """Options of `bench timing`."""
    parser.add_argument("--steps", type=int, default=20_000, help="of each run (default: %(default)s, 25 minutes in all; the full form are 1000000, 20 hours)")
    parser.add_argument("--rate", type=float, metavar="HZ", help="one rate only (default: 200 and 500)")
    parser.add_argument("--hog", action="store_true", help="beside a load on every processor only")
    parser.add_argument("--fifo", action="store_true", help="with SCHED_FIFO only")


def run(quick=False, steps=20_000, rate=None, hog=False, fifo=False):
    """All runs, in rounds."""
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    os.environ.setdefault("ROS_DOMAIN_ID", str(free_domain()))
    steps, rounds = (1000, 1) if quick else (steps, ROUNDS)
    rows, failed = [], []
    for hertz, loaded, real_time in itertools.product((rate,) if rate else RATES, (True,) if hog else (False, True), (True,) if fifo else (False, True)):
        found = _case(hertz, loaded, PRIORITY if real_time else 0, steps, rounds)
        rows.append({"rate": hertz, "hog": loaded, "scheduling": found.pop("scheduling"), **found})
        print(json.dumps(rows[-1]), flush=True)
        if hertz <= 200.0 and not loaded and real_time and found["node"]["missed"] > found["empty"]["missed"]:
            failed.append(f"{hertz:g} Hz, idle, SCHED_FIFO: {found['node']['missed']} cycles missed, {found['empty']['missed']} by an empty loop")
    header = ["rate, Hz", "load", "scheduling", "loop", "cycles", "missed", *(f"late {name}, us" for name in ("p50", "p99", "p99.9", "max")),
              *(f"step {name}, us" for name in ("p50", "p99", "p99.9", "max"))]
    body = [[f"{row['rate']:g}", "hogs" if row["hog"] else "none", row["scheduling"], name, row[name]["cycles"], row[name]["missed"], *row[name]["late"],
             *row[name]["step"]] for row in rows for name in ("node", "empty")]
    content = {"timing": tables.table(header, body)}
    print(content["timing"], flush=True)
    return {"rows": rows, "tables": content, "failed": failed}


def _case(rate, loaded, priority, steps, rounds):
    """One row: figures of `node` and `empty`."""
    seconds = steps / rate / rounds
    total = {name: {"counts": np.zeros((2, BINS), dtype=int), "most": [0, 0], "missed": 0} for name in ("node", "empty")}
    with _Driver(rate, priority) as driver, _hogs(loaded):
        for _ in range(rounds):
            for name, measure in (("node", driver.measure), ("empty", lambda seconds: driver.beside(seconds, rate, priority))):
                counts, most, missed = measure(seconds)
                total[name]["counts"] += np.array(counts, dtype=int)
                total[name]["most"] = [max(pair) for pair in zip(total[name]["most"], most)]
                total[name]["missed"] += missed
        scheduling = driver.scheduling
    return {"scheduling": scheduling, **{name: {
        "cycles": int(found["counts"][1].sum()), "missed": found["missed"],
        **{what: [round(1e-3 * quantile(list(found["counts"][k]), share, found["most"][k])) for share in (*SHARES, 1.0)] for k, what in enumerate(("step", "late"))},
    } for name, found in total.items()}}


@contextlib.contextmanager
def _hogs(loaded):
    hogs = [subprocess.Popen([sys.executable, "-S", "-c", "while True: pass"]) for _ in range(os.cpu_count() if loaded else 0)]
    try:
        yield
    finally:
        for process in hogs:
            process.kill()
            process.wait()


class _Driver:
    """The node as a process, and what sends it motion and hears its figures."""

    def __init__(self, rate, priority):
        parameters = {"scene": SCENE, "timing.mode": "timer", "timing.rate": rate, "realtime.priority": priority, "realtime.lock_memory": priority > 0}
        arguments = [part for name, value in parameters.items() for part in ("-p", f"{name}:={str(value).lower() if isinstance(value, bool) else value}")]
        self._process = subprocess.Popen([sys.executable, "-m", "mooring_ros.node", "--ros-args", "--log-level", "warn", *arguments], cwd=ROOT)
        self._context = rclpy.Context()
        self._context.init()
        self._node = rclpy.create_node("driver", context=self._context)
        self._executor = EventsExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._odometry = self._node.create_publisher(Odometry, "platform/odom", 10)
        self._node.create_subscription(Float64MultiArray, "mooring/timing", self._hear_timing, 10)
        self._node.create_subscription(DiagnosticArray, "/diagnostics", self._hear_diagnostics, 10)
        self._change = self._node.create_client(ChangeState, "mooring/change_state")
        self._state = self._node.create_client(GetState, "mooring/get_state")
        self._counts, self._values, self.scheduling = None, {}, "normal"

    def __enter__(self):
        end = time.monotonic() + START
        try:
            while not (self._change.service_is_ready() and self._state.service_is_ready() and self._label() == "active"):
                if time.monotonic() > end or self._process.poll() is not None:
                    raise RuntimeError("the node did not come up")
                self._executor.spin_once(timeout_sec=0.1)
            self._transition(Transition.TRANSITION_DEACTIVATE)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        self._process.terminate()
        self._process.wait(20.0)
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()

    def measure(self, seconds):
        """One activation of the node: (counts of steps and lateness, the largest of each in ns, cycles missed)."""
        self._transition(Transition.TRANSITION_ACTIVATE)
        self._send(seconds)
        self._counts, self._values = None, {}
        self._transition(Transition.TRANSITION_DEACTIVATE)
        self._wait(lambda: self._counts is not None and "cycles" in self._values)
        self.scheduling = self._values.get("scheduling", "normal")
        most = [round(1e6 * float(self._values.get(f"{name} (ms)", 0.0))) for name in ("longest step", "late max")]
        return self._counts, most, int(self._values["missed"])

    def beside(self, seconds, rate, priority):
        """The empty loop for as long, while the motion goes on being sent."""
        process = subprocess.Popen([sys.executable, "-m", "benchmarks.timing", "--empty", str(rate), str(seconds), str(priority)], cwd=ROOT,
                                   stdout=subprocess.PIPE, text=True)
        self._send(seconds)
        return json.loads(process.communicate()[0])

    def _send(self, seconds):
        begin, period = time.monotonic(), 1.0 / INPUT_RATE
        for k in range(round(seconds * INPUT_RATE)):
            while (left := begin + k * period - time.monotonic()) > 0.0:
                self._executor.spin_once(timeout_sec=left)
            self._odometry.publish(motion(time.time_ns()))

    def _transition(self, number):
        request = ChangeState.Request()
        request.transition.id = number
        future = self._change.call_async(request)
        self._wait(future.done)
        if not future.result().success:
            raise RuntimeError("the node refused a transition")

    def _label(self):
        future, end = self._state.call_async(GetState.Request()), time.monotonic() + 1.0
        while not future.done() and time.monotonic() < end:
            self._executor.spin_once(timeout_sec=0.1)
        return future.result().current_state.label if future.done() else ""

    def _wait(self, condition):
        end = time.monotonic() + 30.0
        while not condition():
            if time.monotonic() > end:
                raise RuntimeError("the node does not answer")
            self._executor.spin_once(timeout_sec=0.05)

    def _hear_timing(self, message):
        self._counts = np.reshape(message.data, (2, BINS))

    def _hear_diagnostics(self, message):
        for status in message.status:
            if status.name == "mooring: timing":
                self._values = {pair.key: pair.value for pair in status.values}


class _Empty:
    """A node for the loop whose cycle does nothing."""

    def __init__(self, rate):
        self.rate, self.punctuality = FixedRate(rate), Punctuality(rate)

    def deadline(self):
        """As of MooringNode."""
        return self.rate.next(time.monotonic_ns())

    def cycle(self):
        """As of MooringNode."""
        begin = time.monotonic_ns()
        if self.rate.due(begin):
            self.punctuality.begin(begin, self.rate.late, self.rate.skipped)
            self.punctuality.answered(time.monotonic_ns() - begin)


def empty(rate, seconds, priority):
    """The empty loop, as a process of its own; prints what `_Driver.measure` returns."""
    rclpy.init()
    node, executor = rclpy.create_node("empty"), EventsExecutor()
    executor.add_node(node)
    cycles = _Empty(rate)
    loop = Loop(executor, cycles)
    gc.collect()
    gc.freeze()
    gc.disable()
    if priority:
        realtime.ask(priority, True)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        loop.turn()
    realtime.give_back()
    found = cycles.punctuality
    print(json.dumps([[found.steps.counts, found.lateness.counts], [found.steps.most, found.lateness.most], cycles.rate.missed]))
    executor.shutdown()
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--empty", type=float, nargs=3, required=True, metavar=("RATE", "SECONDS", "PRIORITY"))
    rate, seconds, priority = parser.parse_args().empty
    empty(rate, seconds, round(priority))
