import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from mooring_ros.recording import RecordingError
from mooring_ros.recording.schema import SEPARATOR, schema_text

TYPES = ['nav_msgs/msg/Odometry', 'geometry_msgs/msg/PoseStamped', 'geometry_msgs/msg/TwistStamped', 'geometry_msgs/msg/WrenchStamped',
         'sensor_msgs/msg/JointState', 'sensor_msgs/msg/PointCloud2', 'std_msgs/msg/Float64MultiArray', 'std_msgs/msg/String',
         'std_msgs/msg/Empty', 'visualization_msgs/msg/MarkerArray', 'diagnostic_msgs/msg/DiagnosticArray',
         'rcl_interfaces/msg/ParameterDescriptor', 'shape_msgs/msg/SolidPrimitive']


@pytest.mark.parametrize('name', TYPES)
def test_schema_text_means_the_same_types_as_the_published_definitions(name):
    """The type hash covers names, types, array sizes and bounds of all fields, nested ones included."""
    jazzy = get_typestore(Stores.ROS2_JAZZY)
    if name not in jazzy.types:
        pytest.skip('not in the type store')
    ours = get_typestore(Stores.EMPTY)
    ours.register(get_types_from_msg(schema_text(name), name))
    assert ours.hash_rihs01(name) == jazzy.hash_rihs01(name)


def test_nested_types_are_defined_once_each():
    parts = schema_text('visualization_msgs/msg/MarkerArray').split(SEPARATOR + '\n')[1:]
    names = [part.split('\n')[0] for part in parts]
    assert len(names) == len(set(names))
    assert 'MSG: builtin_interfaces/Time' in names


def test_constants_are_kept():
    assert 'LINE_STRIP=4' in schema_text('visualization_msgs/msg/Marker')
    assert 'byte WARN=1' in schema_text('diagnostic_msgs/msg/DiagnosticStatus')


@pytest.mark.parametrize('name', ['Odometry', 'nav_msgs/Odometry', 'nav_msgs/msg/Nonsense', 'no_such_msgs/msg/A', 'nav_msgs/srv/GetMap'])
def test_unknown_type_names_are_refused(name):
    with pytest.raises(RecordingError, match='expected'):
        schema_text(name)
