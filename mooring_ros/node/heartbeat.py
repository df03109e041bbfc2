"""The subscription by which somebody else says that it is still there.

std_msgs/Empty: only the arrival counts, by the node's own steady clock, so that no clocks must agree, and anything can send it. One message
waits at most, and any quality of service will do: what is old, or lost, is no sign of life.
"""
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions
from std_msgs.msg import Empty

TOPIC = "~/heartbeat"


class Heartbeat:
    """Calls `beat()` for every message."""

    def __init__(self, node, beat):
        self._node = node
        self._subscription = node.create_subscription(
            Empty, TOPIC, lambda _: beat(), QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT), raw=True,
            qos_overriding_options=QoSOverridingOptions.with_default_policies())

    def destroy(self):
        """End the subscription."""
        self._node.destroy_subscription(self._subscription)
