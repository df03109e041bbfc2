"""Messages filled into templates, and their bytes."""
import numpy as np
import pytest
from geometry_msgs.msg import WrenchStamped
from nav_msgs.msg import Odometry
from node_peer import SCENE, UPRIGHT, numbers, stamp_of
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState, PointCloud2
from std_msgs.msg import Float64MultiArray
from visualization_msgs.msg import Marker, MarkerArray

from mooring_ros.mooring import Mooring
from mooring_ros.motion import Adapter
from mooring_ros.node.clean_cdr import serialize
from mooring_ros.node.markers import Markers
from mooring_ros.node.messages import NODE_FIELDS, Messages
from mooring_ros.node.template import Template, placeholder, placeholder_stamp

STAMP = 1_700_000_000_123_456_789


@pytest.fixture(scope="module")
def mooring():
    mooring = Mooring(SCENE)
    mooring.settle(np.array([3.0, 0.0, 0.0, *UPRIGHT]))
    return mooring


@pytest.mark.parametrize("message", [WrenchStamped(), Odometry(child_frame_id="abc"), JointState(name=["a", "bcdef"], effort=[1.0, 2.0]),
                                     MarkerArray(markers=[Marker(ns="lines", text="xy", type=4), Marker()])], ids=lambda m: type(m).__name__)
def test_clean_bytes_are_the_same_message_and_always_the_same_bytes(message):
    data = serialize(message)
    assert deserialize_message(data, type(message)) == message
    assert len(data) <= len(serialize_message(message))
    assert all(serialize(message) == data for _ in range(20))


def test_template_takes_values_of_its_slots_size_only():
    slot = placeholder(3)
    template = Template(Float64MultiArray(data=slot.tolist()), [slot])
    assert deserialize_message(template.fill(0, [1.0, 2.0, 3.0]), Float64MultiArray).data.tolist() == [1.0, 2.0, 3.0]
    with pytest.raises(ValueError):
        template.fill(0, [1.0, 2.0])
    with pytest.raises(ValueError, match="0 times"):
        Template(Float64MultiArray(), [slot])


def test_a_stamp_before_the_epoch_survives():
    message = WrenchStamped()
    message.header.stamp = placeholder_stamp()
    assert stamp_of(deserialize_message(Template(message, []).fill(-5), WrenchStamped)) == -5


def test_messages_hold_what_the_mooring_says(mooring):
    messages = Messages(mooring, Adapter(), "hull", "map")
    wrench = deserialize_message(messages.wrench(STAMP, mooring.wrench), WrenchStamped)
    assert (wrench.header.frame_id, stamp_of(wrench)) == ("hull", STAMP)
    np.testing.assert_array_equal(numbers(wrench), mooring.wrench)
    lines = deserialize_message(messages.lines(STAMP, mooring), JointState)
    assert (lines.name, lines.header.frame_id, stamp_of(lines)) == (mooring.line_names, "map", STAMP)
    np.testing.assert_array_equal(lines.effort, mooring.fairlead_tension)
    cloud = deserialize_message(messages.nodes(STAMP, mooring), PointCloud2)
    assert tuple(field.name for field in cloud.fields) == NODE_FIELDS
    values = np.frombuffer(bytes(cloud.data), "<f4").reshape(-1, len(NODE_FIELDS))
    assert len(values) == cloud.width == sum(len(mooring.node_tension(name)) for name in mooring.line_names)
    for index, name in enumerate(mooring.line_names):
        rows = values[values[:, 5] == index]
        np.testing.assert_allclose(rows[:, :3], mooring.node_positions(name), rtol=1e-6, atol=1e-4)
        np.testing.assert_allclose(rows[:, 3], mooring.node_tension(name), rtol=1e-6)
        np.testing.assert_allclose(rows[:, 4], mooring.node_curvature(name), rtol=1e-6)
        np.testing.assert_array_equal(rows[:, 6], np.arange(len(rows)))


def test_a_model_gets_forces_lengths_and_speeds_at_its_scale(mooring):
    adapter = Adapter(scale=50.0, density_ratio=1.025)
    messages = Messages(mooring, adapter)
    lines = deserialize_message(messages.lines(STAMP, mooring), JointState)
    np.testing.assert_allclose(lines.position, mooring.stretched_length / 50.0)
    np.testing.assert_allclose(lines.effort, mooring.fairlead_tension / (50.0 ** 3 * 1.025))
    tensions = deserialize_message(messages.line_tensions(mooring), Float64MultiArray)
    np.testing.assert_allclose(np.reshape(tensions.data, (-1, 2))[:, 1], lines.effort)


@pytest.mark.parametrize("convention, below", [("enu", -1.0), ("ned", 1.0)])
def test_markers_show_lines_bed_and_anchors_where_they_are(mooring, convention, below):
    adapter = Adapter(convention=convention)
    array = deserialize_message(Markers(mooring, adapter, "map").markers(STAMP, mooring), MarkerArray)
    assert {(m.header.frame_id, stamp_of(m)) for m in array.markers} == {("map", STAMP)}
    lines = [m for m in array.markers if m.ns == "lines"]
    for marker, name in zip(lines, mooring.line_names, strict=True):
        points = [(p.x, p.y, p.z) for p in marker.points]
        np.testing.assert_allclose(points, adapter.points_out(mooring.node_positions(name)))
        assert len(marker.colors) == len(points)
    bed = next(m for m in array.markers if m.ns == "seabed")
    assert bed.pose.position.z == pytest.approx(below * mooring.scene.environment.depth, rel=0.05)
    anchors = next(m for m in array.markers if m.ns == "anchors")
    assert len(anchors.points) == sum(point.kind == "fixed" for point in mooring.scene.points)
