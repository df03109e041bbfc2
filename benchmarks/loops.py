"""How late a cycle begins that waits for its deadline on an rclpy executor: with a timer of rclpy, in `spin_once`, or asleep at the end (mooring_ros.node.loop)."""
import gc
import os
import time

import numpy as np
import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.experimental.events_executor import EventsExecutor

from mooring_ros.node import loop, realtime
from mooring_ros.node.timing import FixedRate

from . import tables
from .domains import free_domain

RATE, PRIORITY = 200.0, 50
SHARES = (50.0, 99.0, 99.9, 100.0)


def run(quick=False):
    """All three, with ordinary scheduling and with SCHED_FIFO."""
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    os.environ.setdefault("ROS_DOMAIN_ID", str(free_domain()))
    cycles, rows = 300 if quick else 3000, []
    rclpy.init()
    node, executor = rclpy.create_node("loops"), EventsExecutor()
    executor.add_node(node)
    gc.collect()
    gc.freeze()
    gc.disable()
    try:
        for priority in (0, PRIORITY):
            granted = realtime.ask(priority, priority > 0)
            for name, wait in (("timer of rclpy", _timer), ("spin_once until the deadline", _spin), ("spin_once, and asleep at the end", _sleep)):
                late = 1e-3 * np.array(wait(node, executor, cycles))
                rows.append([name, granted.scheduling, *(f"{np.percentile(late, share):.0f}" for share in SHARES)])
    finally:
        realtime.give_back()
        gc.enable()
        gc.unfreeze()
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
    table = tables.table(["how it waits", "scheduling", *(f"late {name}, us" for name in ("p50", "p99", "p99.9", "max"))], rows)
    print(table, flush=True)
    return {"rows": rows, "tables": {"loops": table}, "failed": []}


class _Cycles:
    """What loop.Loop asks a node; notes how late (ns) its cycles are."""

    def __init__(self):
        self.rate, self.late = FixedRate(RATE), []

    def deadline(self):
        return self.rate.next(time.monotonic_ns())

    def cycle(self):
        if self.rate.due(time.monotonic_ns()):
            self.late.append(self.rate.late)


def _timer(node, executor, cycles):
    begins = []
    timer = node.create_timer(1.0 / RATE, lambda: begins.append(time.monotonic_ns()), clock=Clock(clock_type=ClockType.STEADY_TIME))
    while len(begins) < cycles:
        executor.spin_once(timeout_sec=0.2)
    node.destroy_timer(timer)
    turn = 2.0 * np.pi * RATE * 1e-9
    phase = np.unwrap(turn * ((np.array(begins) - begins[0]) % round(1e9 / RATE)))
    return (phase - phase.min()) / turn     # it tells nobody its deadlines: after the one that it was closest to


def _spin(_, executor, cycles):
    counted = _Cycles()
    while len(counted.late) < cycles:
        left = counted.deadline() - time.monotonic_ns()
        if left > 0:
            executor.spin_once(timeout_sec=left * 1e-9)
        counted.cycle()
    return counted.late


def _sleep(_, executor, cycles):
    counted = _Cycles()
    turns = loop.Loop(executor, counted)
    while len(counted.late) < cycles:
        turns.turn()
    return counted.late
