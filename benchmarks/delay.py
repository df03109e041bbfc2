"""The delay of a running node as its peer sees it, by how far the force lags the motion; with the motion predicted and not.

The lines are quasi-static, so the force has no lag of its own: where its first harmonic lags the surge, it is late. By clocks of the wall, in
processes of their own.
"""

import math
import time

import numpy as np
import rclpy
from geometry_msgs.msg import WrenchStamped
from nav_msgs.msg import Odometry
from rclpy.experimental.events_executor import EventsExecutor
from std_msgs.msg import Float64MultiArray

from . import tables
from .decay_runs import START, mooring_node

DOMAIN, SCALE, RATE = 85, 50.0, 100.0
OMEGA, AMPLITUDE = 2.0 * math.pi, 0.04  # rad/s, m at model scale
SETTLING = 2.0  # s that are not counted: the prediction grows by at most 0.1 s a second
LATE = 0.02  # s by which the peer sends its samples late, with the stamps of when they were true
USUAL = 0.9  # share of the answers that count, the quickest: on a busy machine some come in bursts, half a second late
CASES = {
    "no prediction": {},
    "the 20 ms given": {"delay.compensate": "given", "delay.seconds": LATE},
    "measured": {"delay.compensate": "measured"},
}


class Peer:
    """Sends a surge as it was LATE ago and hears the force."""

    def __init__(self):
        self._context = rclpy.Context()
        self._context.init(domain_id=DOMAIN)
        self._node = rclpy.create_node("peer", context=self._context)
        self._executor = EventsExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._publisher = self._node.create_publisher(Odometry, "platform/odom", 10)
        self._node.create_subscription(WrenchStamped, "mooring/wrench", self._hear, 10)
        self._node.create_subscription(Float64MultiArray, "mooring/delay", lambda message: self._told.append(message.data[0]), 10)
        self._heard, self._told = [], []

    def close(self):
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()

    def run(self, process, seconds):
        """Delay of the force (s) behind the motion, and the mean that the node tells."""
        end = time.monotonic() + START
        while not self._node.count_subscribers("platform/odom") or not self._node.count_publishers("mooring/wrench"):
            if time.monotonic() > end or process.poll() is not None:
                raise RuntimeError("the node did not come up")
            self._executor.spin_once(timeout_sec=0.1)
        begin = due = time.time_ns()
        while due < begin + seconds * 1e9:
            due += round(1e9 / RATE)
            while (left := due - time.time_ns()) > 0:
                self._executor.spin_once(timeout_sec=1e-9 * left)
            self._send(time.time_ns() - round(LATE * 1e9))
        return self._lag(begin + SETTLING * 1e9), self._told[-1]

    def _send(self, stamp):
        message, t = Odometry(child_frame_id="platform"), 1e-9 * (stamp % 1_000_000_000_000)
        message.header.frame_id = "world"
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 1_000_000_000)
        message.pose.pose.position.x, message.pose.pose.orientation.w = AMPLITUDE * math.sin(OMEGA * t), 1.0
        message.twist.twist.linear.x = AMPLITUDE * OMEGA * math.cos(OMEGA * t)
        self._publisher.publish(message)

    def _hear(self, message):
        now, stamp = time.time_ns(), message.header.stamp
        self._heard.append((now, now - stamp.sec * 1_000_000_000 - stamp.nanosec, message.wrench.force.x))

    def _lag(self, begin):
        heard = [(t % 1_000_000_000_000, age, force) for t, age, force in self._heard if t > begin]
        usual = np.percentile([age for _, age, _ in heard], 100.0 * USUAL)
        times = np.array([t for t, age, _ in heard if age <= usual]) * 1e-9
        forces = np.array([force for _, age, force in heard if age <= usual])
        harmonics = [f(k * OMEGA * times) for k in (1, 2) for f in (np.sin, np.cos)]
        sine, cosine = np.linalg.lstsq(np.column_stack([*harmonics, np.ones_like(times)]), forces, rcond=None)[0][:2]
        return math.atan2(cosine, -sine) / OMEGA  # the force is against the surge


def run(quick=False):
    """Prints the table."""
    rows, found = [], {}
    for mode in ("input", "timer"):
        for name, parameters in list(CASES.items())[:: 2 if quick else 1]:
            with mooring_node(SCALE, domain=DOMAIN, fidelity="quasi_static", **parameters, **{"timing.mode": mode, "timing.rate": RATE}) as process:
                peer = Peer()
                try:
                    lag, told = peer.run(process, 6.0 if quick else 12.0)
                finally:
                    peer.close()
            rows.append([f"mode {mode}, {name}", f"{1e3 * told:.2f}", f"{1e3 * lag:+.2f}"])
            found[f"{mode}, {name}"] = {"told": told, "lag": lag}
    content = {"delay": tables.table(["100 Hz, samples sent 20 ms late", "told by the node, mean (ms)", "lag of the force (ms)"], rows)}
    print(content["delay"], flush=True)
    failed = [f"delay: the force lags by {1e3 * found[case]['lag']:.1f} ms in the mode {case}, goal 10 % of {1e3 * LATE:g} ms"
              for case in found if case == "input, measured" and abs(found[case]["lag"]) > 0.1 * LATE]
    return {"cases": found, "tables": content, "failed": failed}
