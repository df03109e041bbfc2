"""What the node says about itself: /diagnostics, every change of its state on ~/state, histograms of its times on ~/timing; all recorded."""
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import serialize_message

from std_msgs.msg import Float64MultiArray, MultiArrayDimension

from mooring_ros.node.diagnostics import LEVELS, PREFIX
from mooring_ros.node.histogram import BINS
from mooring_ros.node.messages import FLOAT_ARRAY, floats
from mooring_ros.recording.qos import Qos

DIAGNOSTICS, STATE, TIMING = "/diagnostics", "~/state", "~/timing"
_ARRAY, _STATUS = "diagnostic_msgs/msg/DiagnosticArray", "diagnostic_msgs/msg/DiagnosticStatus"
_DEPTH = 10


class Reports:
    """node: creates the publishers, which live as long as it does. ~/state is latched: who comes late hears where the node stands.

    recorder: RecordingWriter or None, set while there is one. Times of the recording are ns, None for what is before its first input.
    """

    def __init__(self, node):
        self._name = node.get_fully_qualified_name()
        self._diagnostics = node.create_publisher(DiagnosticArray, DIAGNOSTICS, QoSProfile(depth=_DEPTH))
        self._state = node.create_publisher(DiagnosticStatus, STATE, QoSProfile(depth=_DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL))
        self._timing = node.create_publisher(Float64MultiArray, TIMING, QoSProfile(depth=_DEPTH))
        self._recorder = None

    @property
    def recorder(self):
        return self._recorder

    @recorder.setter
    def recorder(self, recorder):
        self._recorder = recorder
        if recorder is not None:
            recorder.declare(DIAGNOSTICS, _ARRAY, Qos(depth=_DEPTH))
            recorder.declare(self._state.topic_name, _STATUS, Qos(depth=_DEPTH, durability="transient_local"))
            recorder.declare(self._timing.topic_name, FLOAT_ARRAY, Qos(depth=_DEPTH))

    def diagnostics(self, message, time):
        """Publish and record a DiagnosticArray. time: ns, on the recording's axis."""
        self._send(self._diagnostics, DIAGNOSTICS, _ARRAY, message, time)

    def transition(self, transition, time):
        """Publish and record a states.Transition. time: ns, on the recording's axis."""
        values = {"state": transition.after, "before": transition.before, "event": transition.event, "cause": transition.cause}
        self._send(self._state, self._state.topic_name, _STATUS, DiagnosticStatus(
            name=PREFIX + "state", hardware_id=self._name, level=LEVELS[transition.after], message=transition.after,
            values=[KeyValue(key=key, value=value) for key, value in values.items()]), time)

    def timing(self, punctuality, time):
        """Publish and record the histograms of a Punctuality, counted since the activation. time: ns, on the recording's axis."""
        message = Float64MultiArray(data=floats([punctuality.steps.counts, punctuality.lateness.counts]))
        message.layout.dim = [MultiArrayDimension(label="time of a step, lateness", size=2, stride=2 * BINS),
                              MultiArrayDimension(label="count up to 10^(k/20) us", size=BINS, stride=BINS)]
        self._send(self._timing, self._timing.topic_name, FLOAT_ARRAY, message, time)

    def _send(self, publisher, topic, type_name, message, time):
        data = serialize_message(message)
        publisher.publish(data)
        if self._recorder is not None and time is not None:
            self._recorder.write(topic, type_name, data, time)
