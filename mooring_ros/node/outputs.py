"""The publishers of a configured node. The wrench goes out first; everything else follows when it is on its way."""
from geometry_msgs.msg import WrenchStamped
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import JointState, PointCloud2
from std_msgs.msg import Float64MultiArray
from visualization_msgs.msg import MarkerArray

from mooring_ros.node import messages
from mooring_ros.node.full_scale import FullScale
from mooring_ros.node.delay import TOPIC as DELAY_TOPIC
from mooring_ros.node.delay import message as delay_message
from mooring_ros.node.markers import MARKER_ARRAY, Markers
from mooring_ros.node.stiffness import Stiffness
from mooring_ros.node.template import Template, placeholder
from mooring_ros.recording import schedule
from mooring_ros.recording.qos import Qos

_DEPTH = 50
_ANSWERS = 1000     # as many as the inputs that may wait: their answers come in one burst
_TYPES = {messages.WRENCH: WrenchStamped, messages.JOINT_STATE: JointState, messages.FLOAT_ARRAY: Float64MultiArray}
_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Outputs:
    """Serializes each answer once; the same bytes are published and recorded.

    node: creates the publishers. mooring: for names and shapes. adapter: see motion.Adapter. recorder: RecordingWriter or None.
    visual_rate: Hz in the time of the input, may be changed; 0 is never. full_scale: whether ~/full_scale/… is published beside the rest.
    """

    def __init__(self, node, mooring, adapter, recorder, visual_rate, full_scale=False):
        self._node, self._mooring, self._adapter, self._recorder = node, mooring, adapter, recorder
        self.visual_rate = visual_rate
        self._shown = None
        self._publishers = {}
        self._totals = [self._publisher(WrenchStamped, messages.WRENCH, topic, QoSProfile(depth=_ANSWERS))
                        for topic in messages.total_topics("~", mooring.platforms)]
        self._fairleads = [self._publisher(WrenchStamped, messages.WRENCH, messages.fairlead_topic("~", name))
                           for name in mooring.coupled_names]
        self._lines = self._publisher(JointState, messages.JOINT_STATE, "~/lines")
        self._line_tensions = self._publisher(Float64MultiArray, messages.FLOAT_ARRAY, "~/line_tensions")
        self._nodes = self._publisher(PointCloud2, messages.POINT_CLOUD, "~/nodes")
        self._markers = self._publisher(MarkerArray, MARKER_ARRAY, "~/markers")
        self.stiffness = Stiffness(mooring, adapter, 0.0)
        self._stiffness = self._publisher(Float64MultiArray, messages.FLOAT_ARRAY, "~/stiffness", _LATCHED)
        self._delay = self._publisher(Float64MultiArray, messages.FLOAT_ARRAY, DELAY_TOPIC)
        self._full_scale = FullScale(mooring, adapter) if full_scale else None
        topics = self._full_scale.topics.items() if full_scale else ()
        self._full = {name: self._publisher(_TYPES[type_name], type_name, f"~/{name}") for name, type_name in topics}
        slot = placeholder(schedule.size(mooring.platforms))
        self._schedule = Template(Float64MultiArray(data=messages.floats(slot)), [slot])
        self._steps_topic = node.get_fully_qualified_name() + schedule.TOPIC_SUFFIX
        self._declare(self._steps_topic, schedule.TYPE_NAME)
        self._messages = self._marker_messages = self._frames = None

    def use_frames(self, world_frame, platform_frame):
        """Name the frames in the headers, platform_frame a tuple for several platforms; called again when they are known from the input."""
        if (world_frame, platform_frame) == self._frames:
            return
        self._frames = world_frame, platform_frame
        world = world_frame or "world"
        own = [platform_frame or "platform"] if isinstance(platform_frame, str) else [
            frame or name for frame, name in zip(platform_frame, self._mooring.platforms)]
        wrench_frame = [world] * len(own) if self._adapter.wrench_frame == "world" else own
        self._messages = messages.Messages(self._mooring, self._adapter, wrench_frame, world)
        self._marker_messages = Markers(self._mooring, self._adapter, world)
        if self._full_scale is not None:
            self._full_scale = FullScale(self._mooring, self._adapter, wrench_frame, world)

    def answer(self, stamp, session):
        """Publish the total wrenches; returns what `follow` needs to go on."""
        wrenches = self._messages.wrenches(session.wrenches, self._mooring.pose)
        totals = []
        for row, publisher in enumerate(self._totals):
            totals.append(self._messages.wrench(stamp, wrenches[row], row))
            publisher.publish(totals[-1])
        return wrenches, totals

    def follow(self, stamp, answered):
        """Publish the rest of the answer, and record all of it."""
        self._follow_wrenches(stamp, answered, stamp)
        self._send(self._lines, self._messages.lines(stamp, self._mooring), stamp)
        self._send(self._line_tensions, self._messages.line_tensions(self._mooring), stamp)
        if self._full_scale is not None:
            for name, _, data in (*self._full_scale.wrenches(stamp, answered[0]), *self._full_scale.lines(stamp, self._mooring)):
                self._send(self._full[name], data, stamp)
        if self._due(stamp):
            if self._wanted(self._nodes):
                self._send(self._nodes, self._messages.nodes(stamp, self._mooring), stamp)
            if self._wanted(self._markers):
                self._send(self._markers, self._marker_messages.markers(stamp, self._mooring), stamp)

    def follow_stiffness(self, stamp, settles):
        """Publish the stiffness where it is due, after the answer at stamp (ns). settles: how many there have been."""
        wanted = self._stiffness.get_subscription_count() > 0
        data = self.stiffness.message(stamp, settles, wanted)
        if data is not None:
            self._send(self._stiffness, data, stamp)

    def repeat(self, stamp, answered, time):
        """Publish the wrenches at the coupled points where the core stands still, and record them and the total at time (ns)."""
        self._follow_wrenches(stamp, answered, time)
        if self._full_scale is not None:
            for name, _, data in self._full_scale.wrenches(stamp, answered[0]):
                self._send(self._full[name], data, time)

    def tell_delay(self, numbers, time):
        """Publish numbers of delay.FIELDS, and record them at time (ns)."""
        self._send(self._delay, delay_message(numbers), time)

    def _follow_wrenches(self, stamp, answered, time):
        wrenches, totals = answered
        if self._recorder is not None:
            for publisher, data in zip(self._totals, totals):
                self._record(publisher, data, time)
        for row, publisher in enumerate(self._fairleads, len(totals)):
            self._send(publisher, self._messages.wrench(stamp, wrenches[row], row), time)

    def record_input(self, topic, type_name, data, log_time, publish_time):
        """Record a message as it was received. Times: ns."""
        if self._recorder is not None:
            self._recorder.write(topic, type_name, data, log_time, publish_time)

    def record_actions(self, actions):
        """Record what was done to the core: (stamp, schedule record) each."""
        if self._recorder is not None:
            for stamp, record in actions:
                self._recorder.write(self._steps_topic, schedule.TYPE_NAME, self._schedule.fill(0, record), stamp, stamp)

    def destroy(self):
        """Take all publishers down."""
        for publisher in self._publishers:
            self._node.destroy_publisher(publisher)
        self._publishers = {}

    def _publisher(self, message_type, type_name, topic, qos=QoSProfile(depth=_DEPTH)):
        publisher = self._node.create_publisher(message_type, topic, qos,
                                                qos_overriding_options=QoSOverridingOptions.with_default_policies())
        self._publishers[publisher] = publisher.topic_name, type_name
        self._declare(publisher.topic_name, type_name, Qos(depth=1, durability="transient_local") if qos is _LATCHED else Qos())
        return publisher

    def _declare(self, topic, type_name, qos=Qos()):
        if self._recorder is not None:
            self._recorder.declare(topic, type_name, qos)

    def _send(self, publisher, data, stamp):
        publisher.publish(data)
        if self._recorder is not None:
            self._record(publisher, data, stamp)

    def _record(self, publisher, data, stamp):
        topic, type_name = self._publishers[publisher]
        self._recorder.write(topic, type_name, data, stamp, stamp)

    def _due(self, stamp):
        if not self.visual_rate:
            return False
        # A little less than the period, so that rounding of the stamps does not skip every other one.
        if self._shown is not None and 0 <= stamp - self._shown < 0.999e9 / self.visual_rate:
            return False
        self._shown = stamp
        return True

    def _wanted(self, publisher):
        return self._recorder is not None or publisher.get_subscription_count() > 0
