"""The loop of the process: messages and services by the executor, cycles of the timer mode on absolute deadlines.

Timers of rclpy are late by some tenth of a millisecond more than a sleep of one's own, and drift without a real-time priority (docs/live.md): so
the executor gets the time until shortly before a deadline, and the rest of the way is slept.
"""
import time

from mooring_ros.node.timing import NS

POLL = 0.2          # s, how often it looks for a signal
LEAD = 300_000      # ns before a deadline from which on no message is taken up any more


class Loop:
    """executor: with `spin_once(timeout_sec)`. node: with `deadline()` (ns of the clock, None: none) and `cycle()`. clock: ns, steady."""

    def __init__(self, executor, node, clock=time.monotonic_ns, sleep=time.sleep):
        self._executor, self._node, self._clock, self._sleep = executor, node, clock, sleep

    def turn(self):
        """One event, one cycle, or POLL seconds of nothing."""
        deadline = self._node.deadline()
        if deadline is None:
            self._executor.spin_once(timeout_sec=POLL)
            return
        left = deadline - self._clock()
        if left > LEAD:
            self._executor.spin_once(timeout_sec=min((left - LEAD) / NS, POLL))
            return
        if left > 0:
            self._sleep(left / NS)
        self._node.cycle()
