"""The subscription by which lines are wound in and paid out while the node runs."""
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.qos import QoSProfile
from rclpy.qos_overriding_options import QoSOverridingOptions
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

TOPIC, TYPE = "~/unstretched_lengths", "sensor_msgs/msg/JointState"


class Winch:
    """Hands (lengths, words, topic, type name, bytes) of each JointState to `take`: dict of line name -> m, or None and what is wrong."""

    def __init__(self, node, take):
        self._node, self._take = node, take
        self._topic = node.resolve_topic_name(TOPIC)
        self._subscription = node.create_subscription(
            JointState, TOPIC, self._receive, QoSProfile(depth=100), raw=True, qos_overriding_options=QoSOverridingOptions.with_default_policies())

    def destroy(self):
        """End the subscription."""
        self._node.destroy_subscription(self._subscription)

    def _receive(self, data):
        try:
            message = deserialize_message(data, JointState)
        except rclpy_implementation.RMWError as error:
            lengths, words = None, f"{len(data)} bytes are no JointState: {error}"
        else:
            lengths, words = dict(zip(message.name, message.position)), ""
            if not message.name or len(lengths) != len(message.name) or len(message.position) != len(message.name):
                lengths, words = None, f"{len(message.name)} names and {len(message.position)} positions, expected an unstretched length (m) for each line"
        self._take(lengths, words, self._topic, TYPE, data)
