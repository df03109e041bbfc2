"""The ROS side of `mooring status`. It listens as best effort, so that the node never waits for it."""

import os
import time

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import JointState


class Listener:
    """Fills a status_view.View while it spins; a context."""

    def __init__(self, view):
        self._view, self._subscribed = view, False

    def __enter__(self):
        self._context = rclpy.Context()
        rclpy.init(context=self._context, signal_handler_options=SignalHandlerOptions.NO)
        self._node = rclpy.create_node(f"mooring_status_{os.getpid()}", context=self._context, enable_rosout=False, start_parameter_services=False)
        self._executor = EventsExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._listen(DiagnosticArray, "/diagnostics", self._statuses)
        return self

    def __exit__(self, *_):
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()

    def spin(self, seconds, until=lambda: False):
        """Listen for so long, or until until() is true; returns its last result."""
        end = time.monotonic() + seconds
        while not (done := until()) and (left := end - time.monotonic()) > 0.0:
            self._executor.spin_once(timeout_sec=min(left, 0.1))
        return done

    def _listen(self, message_type, topic, callback):
        self._node.create_subscription(message_type, topic, callback, QoSProfile(depth=50, reliability=ReliabilityPolicy.BEST_EFFORT))

    def _statuses(self, message):
        self._view.take_statuses(time.monotonic(), [
            (status.name, int.from_bytes(status.level, "little"), status.message, status.hardware_id,
             {pair.key: pair.value for pair in status.values})
            for status in message.status])
        if self._view.node and not self._subscribed:
            self._subscribed = True
            for topic in self._wrench_topics():
                self._listen(WrenchStamped, topic, lambda message, topic=topic: self._wrench(topic, message))
            self._listen(JointState, f"{self._view.node}/lines", self._lines)

    def _wrench_topics(self):
        """~/wrench, or ~/platforms/NAME/wrench where the node has several."""
        begin = f"{self._view.node}/platforms/"
        return [name for name, _ in self._node.get_topic_names_and_types() if name.startswith(begin)] or [f"{self._view.node}/wrench"]

    def _wrench(self, topic, message):
        force, torque, header = message.wrench.force, message.wrench.torque, message.header
        self._view.take_wrench(time.monotonic(), header.stamp.sec + 1e-9 * header.stamp.nanosec, header.frame_id,
                               (force.x, force.y, force.z), (torque.x, torque.y, torque.z), topic.split("/")[-2] if "/platforms/" in topic else "")

    def _lines(self, message):
        self._view.take_lines(time.monotonic(), message.name, message.position, message.velocity, message.effort)
