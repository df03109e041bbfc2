"""The subscriptions of an active node: bytes in, Samples out."""
from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.qos import QoSProfile
from rclpy.qos_overriding_options import QoSOverridingOptions

from mooring_ros.motion import Pairs
from mooring_ros.motion.gate import MALFORMED, UNPAIRED
from mooring_ros.node import decode

ODOMETRY, POSE, TWIST = "nav_msgs/msg/Odometry", "geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/TwistStamped"

# Reliable, since in lockstep a lost sample is a simulator that waits for ever; `qos_overrides` parameters change it.
DEPTH = 100


class Inputs:
    """Subscribes to what `input` names.

    gate: counts what never becomes a sample. take: called with (sample, topic, type name, bytes, stamp) for each message; the sample is None
    for one that completes none. topics: name -> type name.
    """

    def __init__(self, node, kind, twist_frame, gate, take):
        self._node, self._gate, self._take = node, gate, take
        self._pairs = Pairs(twist_frame) if kind == "pose_twist" else None
        self.topics = {}
        self._subscriptions = []
        if kind == "odometry":
            self._subscribe(Odometry, "platform/odom", ODOMETRY, self._odometry)
        else:
            self._subscribe(PoseStamped, "platform/pose", POSE, self._pose)
        if kind == "pose_twist":
            self._subscribe(TwistStamped, "platform/twist", TWIST, self._twist)

    def destroy(self):
        """End all subscriptions."""
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions = []

    def _subscribe(self, message_type, topic, type_name, decoded):
        name = self._node.resolve_topic_name(topic)

        def receive(data):
            try:
                sample, stamp = decoded(data)
            except ValueError as error:
                self._gate.reject(MALFORMED, str(error))
                sample, stamp = None, None
            self._take(sample, name, type_name, data, stamp)

        self._subscriptions.append(self._node.create_subscription(
            message_type, topic, receive, QoSProfile(depth=DEPTH), raw=True,
            qos_overriding_options=QoSOverridingOptions.with_default_policies()))
        self.topics[name] = type_name

    def _odometry(self, data):
        sample = decode.odometry(data)
        return sample, sample.stamp

    def _pose(self, data):
        sample = decode.pose_stamped(data)
        if self._pairs is None:
            return sample, sample.stamp
        return self._paired(self._pairs.pose(sample)), sample.stamp

    def _twist(self, data):
        stamp, frame, twist = decode.twist_stamped(data)
        return self._paired(self._pairs.twist(stamp, frame, twist)), stamp

    def _paired(self, sample):
        lost = self._pairs.unpaired - self._gate.rejected[UNPAIRED]
        for _ in range(lost):
            self._gate.reject(UNPAIRED, "pose and twist with different stamps")
        return sample
