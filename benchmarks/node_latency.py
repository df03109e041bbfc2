"""Time from an input's stamp to its wrench, of the mooring node and of an empty echo node, side by side in one run.

    python -m benchmarks.node_latency [--scene FILE] [--rates 100 200 500] [--seconds 10] [--rounds 3] [--json]

The echo node takes an Odometry and publishes an empty WrenchStamped with its stamp, with the same QoS, and does nothing else. It is there twice:
as anybody writes it, with rclpy.spin (`echo`, the one that the ratios are to), and on the faster events executor that the mooring node uses
(`echo_events`). All are processes of their own; this process drives one after the other, in alternating rounds.
"""
import argparse
import contextlib
import json
import math
import os
import subprocess
import sys
import time

import numpy as np
import rclpy
from geometry_msgs.msg import WrenchStamped
from nav_msgs.msg import Odometry
from rclpy.executors import ExternalShutdownException
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.qos import QoSProfile

from .domains import free_domain

SCENE = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "config", "scenes", "oc4.txt")
ECHOES = ("echo", "echo_events")
NODES = (*ECHOES, "mooring")
DEPTH = 10
DISCOVERY = 120.0       # s, cold compilation included
SETTLING = 0.5          # s at the begin of each round that are not counted
TARGETS = {50: 1.25, 99: 1.5}


def echo(name):
    """The empty node, under this name of ECHOES."""
    rclpy.init()
    node = rclpy.create_node(name)
    publisher = node.create_publisher(WrenchStamped, "~/wrench", QoSProfile(depth=DEPTH))

    def answer(message):
        reply = WrenchStamped()
        reply.header.stamp = message.header.stamp
        publisher.publish(reply)

    node.create_subscription(Odometry, f"{name}/odom", answer, QoSProfile(depth=DEPTH))
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        if name == "echo":
            rclpy.spin(node)
        executor = EventsExecutor()
        executor.add_node(node)
        while rclpy.ok():
            executor.spin_once(timeout_sec=0.2)


class Driver:
    """Sends stamped Odometry at a rate and measures how long the wrench takes."""

    def __init__(self):
        self._node = rclpy.create_node("driver")
        self._executor = EventsExecutor()
        self._executor.add_node(self._node)
        topics = {**{name: f"{name}/odom" for name in ECHOES}, "mooring": "platform/odom"}
        self._publishers = {name: self._node.create_publisher(Odometry, topic, QoSProfile(depth=DEPTH)) for name, topic in topics.items()}
        self._subscriptions = [self._node.create_subscription(WrenchStamped, f"{name}/wrench", self._heard, QoSProfile(depth=DEPTH))
                               for name in NODES]
        self._latencies = []

    def wait(self, processes):
        """Until all nodes listen. Raises RuntimeError when one ends, or none comes."""
        end = time.monotonic() + DISCOVERY
        while not all(publisher.get_subscription_count() for publisher in self._publishers.values()) \
                or not all(subscription.get_publisher_count() for subscription in self._subscriptions):
            if time.monotonic() > end or any(process.poll() is not None for process in processes):
                raise RuntimeError("a node did not come up")
            self._executor.spin_once(timeout_sec=0.1)

    def measure(self, name, rate, seconds):
        """Latencies (ns) and the number of samples without an answer, over one round."""
        publisher, period = self._publishers[name], 1.0 / rate
        count, skipped = round((seconds + SETTLING) * rate), round(SETTLING * rate)
        self._latencies = []
        begin = time.monotonic()
        for k in range(count):
            self._spin_until(begin + k * period)
            if k == skipped:
                self._latencies = []
            publisher.publish(motion(time.time_ns()))
        self._spin_until(time.monotonic() + 0.2)
        return self._latencies, max(count - skipped - len(self._latencies), 0)

    def _spin_until(self, end):
        while (left := end - time.monotonic()) > 0.0:
            self._executor.spin_once(timeout_sec=left)

    def _heard(self, message):
        self._latencies.append(time.time_ns() - (message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec))


def motion(stamp):
    """An Odometry of a slow surge and heave, at this stamp (ns)."""
    message = Odometry()
    message.header.frame_id, message.child_frame_id = "world", "platform"
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 1_000_000_000)
    rate = 2.0 * math.pi / 14.5
    phase = rate * (stamp % (14_500_000_000 * 1000)) * 1e-9
    message.pose.pose.position.x, message.pose.pose.position.z = 4.0 * math.sin(phase), 3.0 * math.cos(phase)
    message.twist.twist.linear.x, message.twist.twist.linear.z = 4.0 * rate * math.cos(phase), -3.0 * rate * math.sin(phase)
    return message


@contextlib.contextmanager
def nodes(scene):
    """The nodes as processes."""
    commands = [*([sys.executable, "-m", "benchmarks.node_latency", "--echo", name] for name in ECHOES),
                [sys.executable, "-m", "mooring_ros.node", "--ros-args", "--log-level", "warn", "-p", f"scene:={scene}"]]
    processes = [subprocess.Popen(command) for command in commands]
    try:
        yield processes
    finally:
        for process in processes:
            process.terminate()
        for process in processes:
            try:
                process.wait(10.0)
            except subprocess.TimeoutExpired:
                process.kill()


def run(scene, rates, seconds, rounds, progress):
    """For each rate: the nodes' percentiles (ms), the ratio of the mooring node's to the echo's, and the answers that never came."""
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    os.environ.setdefault("ROS_DOMAIN_ID", str(free_domain()))
    rows = []
    with nodes(scene) as processes:
        rclpy.init()
        driver = Driver()
        driver.wait(processes)
        for rate in rates:
            latencies, lost = {name: [] for name in NODES}, dict.fromkeys(NODES, 0)
            for _ in range(rounds):
                for name in NODES:
                    progress(f"{rate:g} Hz, {name}")
                    values, missing = driver.measure(name, rate, seconds / rounds)
                    latencies[name] += values
                    lost[name] += missing
            row = {"rate": rate, "lost": lost}
            for percent in TARGETS:
                figures = {name: float(np.percentile(values, percent)) * 1e-6 for name, values in latencies.items()}
                row[f"p{percent}"] = {**figures, "ratio": figures["mooring"] / figures["echo"]}
            rows.append(row)
        rclpy.try_shutdown()
    return rows


def main(arguments=None):
    """Command line; returns the exit status."""
    parser = argparse.ArgumentParser(prog="node_latency", description=__doc__.splitlines()[0])
    parser.add_argument("--scene", default=SCENE)
    parser.add_argument("--rates", type=float, nargs="+", default=[100.0, 200.0, 500.0])
    parser.add_argument("--seconds", type=float, default=12.0, help="for each node and rate")
    parser.add_argument("--rounds", type=int, default=4)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--echo", choices=ECHOES, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.echo:
        echo(options.echo)
        return 0
    show = (lambda words: print(words, file=sys.stderr)) if sys.stderr.isatty() else (lambda words: None)
    try:
        rows = run(options.scene, options.rates, options.seconds, options.rounds, show)
    except RuntimeError as error:
        print(f"node_latency: {error}", file=sys.stderr)
        return 1
    if options.json:
        print(json.dumps(rows))
        return 0
    print("  rate      p50 echo  (events)  mooring  ratio      p99 echo  (events)  mooring  ratio    lost")
    for row in rows:
        cells = "".join(f"{row[p]['echo']:14.3f}{row[p]['echo_events']:10.3f}{row[p]['mooring']:9.3f}{row[p]['ratio']:7.2f}" for p in ("p50", "p99"))
        print(f"{row['rate']:6g}{cells}    {' '.join(str(row['lost'][name]) for name in NODES)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
