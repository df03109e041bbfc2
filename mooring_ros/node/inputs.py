"""The subscriptions of an active node: bytes in, Samples out."""
from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions

from mooring_ros.motion import Pairs
from mooring_ros.motion.gate import MALFORMED, UNPAIRED
from mooring_ros.node import decode

ODOMETRY, POSE, TWIST = "nav_msgs/msg/Odometry", "geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/TwistStamped"

# Reliable, since in lockstep a lost sample is a simulator that waits for ever; `qos_overrides` parameters change it. A reliable subscription
# hears nothing of a best-effort publisher, which camera systems often are: `Inputs.review` sees that.
# Deep enough to keep what comes while a busy machine lets the node wait for a second or two.
DEPTH = 1000


class Inputs:
    """Subscribes to what `input` names, below `platform`.

    gate: counts what never becomes a sample. take: called with (sample, topic, type name, bytes, stamp) for each message; the sample is None
    for one that completes none. topics: name -> type name. best_effort: names of the topics that are listened to without asking for what was lost.
    """

    def __init__(self, node, kind, twist_frame, gate, take, platform="platform"):
        self._node, self._gate, self._take = node, gate, take
        self._pairs = Pairs(twist_frame) if kind == "pose_twist" else None
        self.topics = {}
        self.best_effort = []
        self._subscriptions, self._ways, self._heard = [], {}, set()
        if kind == "odometry":
            self._subscribe(Odometry, f"{platform}/odom", ODOMETRY, self._odometry)
        else:
            self._subscribe(PoseStamped, f"{platform}/pose", POSE, self._pose)
        if kind == "pose_twist":
            self._subscribe(TwistStamped, f"{platform}/twist", TWIST, self._twist)

    def destroy(self):
        """End all subscriptions."""
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions = []

    def publishers(self):
        """How many publish on the topic that has most; one source is expected."""
        return max(self._node.count_publishers(name) for name in self.topics)

    def review(self):
        """Listen best-effort to a silent topic whose publishers are all so; call it now and then. Returns the names of topics that changed."""
        changed = []
        for name in self.topics.keys() - self._heard - set(self.best_effort):
            publishers = self._node.get_publishers_info_by_topic(name)
            if publishers and all(publisher.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT for publisher in publishers):
                # Beside the reliable one, which is deaf from here on: it may have events under way, which it must not miss its end for.
                self.best_effort.append(name)
                self._listen(name, QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT))
                changed.append(name)
        return changed

    def _subscribe(self, message_type, topic, type_name, decoded):
        name = self._node.resolve_topic_name(topic)
        self._ways[name] = message_type, type_name, decoded
        self.topics[name] = type_name
        self._listen(topic, QoSProfile(depth=DEPTH), qos_overriding_options=QoSOverridingOptions.with_default_policies())

    def _listen(self, topic, qos, **options):
        name = self._node.resolve_topic_name(topic)
        message_type, type_name, decoded = self._ways[name]
        reliable = name not in self.best_effort

        def receive(data):
            if reliable and name in self.best_effort:
                return
            self._heard.add(name)
            try:
                sample, stamp = decoded(data)
            except ValueError as error:
                self._gate.reject(MALFORMED, str(error))
                sample, stamp = None, None
            self._take(sample, name, type_name, data, stamp)

        self._subscriptions.append(self._node.create_subscription(message_type, topic, receive, qos, raw=True, **options))

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
