"""Shared by the tests of the recording room: sample messages, a small recording, and readers of other people as referees."""
import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import Point, PoseStamped, TwistStamped, WrenchStamped
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from nav_msgs.msg import Odometry
from rclpy.serialization import serialize_message
from rosbags.highlevel import AnyReader
from sensor_msgs.msg import JointState, PointCloud2, PointField
from std_msgs.msg import Float64MultiArray, MultiArrayDimension, MultiArrayLayout, String
from visualization_msgs.msg import Marker, MarkerArray

from mooring_ros.recording.attached import AttachedScene
from mooring_ros.recording.writer import RecordingWriter


def type_name(message):
    return f'{type(message).__module__.split(".")[0]}/msg/{type(message).__name__}'


@pytest.fixture
def sample_messages():
    """topic -> message, one of each type that the node uses."""
    odometry = Odometry(child_frame_id='platform')
    odometry.pose.pose.position.x = 1.25
    odometry.twist.twist.angular.z = -0.5
    layout = MultiArrayLayout(dim=[MultiArrayDimension(label='line', size=1, stride=2), MultiArrayDimension(label='end', size=2, stride=2)])
    return {
        '/platform/odom': odometry,
        '/platform/pose': PoseStamped(),
        '/platform/twist': TwistStamped(),
        '/mooring/wrench': WrenchStamped(),
        '/mooring/lines': JointState(name=['line1'], position=[850.0], velocity=[0.1], effort=[1e6]),
        '/mooring/line_tensions': Float64MultiArray(layout=layout, data=[1.0, 2.5]),
        '/mooring/nodes': PointCloud2(height=1, width=1, point_step=4, row_step=4, data=b'\0\0\x80?',
                                      fields=[PointField(name='x', datatype=PointField.FLOAT32, count=1)]),
        '/mooring/markers': MarkerArray(markers=[Marker(ns='line', points=[Point(x=1.0)], text='a')]),
        '/diagnostics': DiagnosticArray(status=[DiagnosticStatus(level=DiagnosticStatus.WARN, name='mooring: x',
                                                                 values=[KeyValue(key='a', value='b')])]),
        '/note': String(data='hello'),
    }


@pytest.fixture
def record(sample_messages):
    """record(path, rounds) -> closed RecordingWriter with `rounds` messages on each topic, 1 ms apart."""
    def record_at(path, rounds=20, **options):
        writer = RecordingWriter(path, {'dt': 0.01, 'scene': 'chain.txt', 'limits.jump': [1, 2]}, AttachedScene('chain.txt', 'LINES\n', (('depths.txt', '2 2\n'),)), **options)
        for number in range(rounds):
            for topic, message in sample_messages.items():
                writer.write(topic, type_name(message), serialize_message(message), number * 1_000_000, number * 1_000_000)
        assert writer.close()
        return writer
    return record_at


def read_with_mcap(path):
    """[(topic, log time, decoded message)] by mcap and mcap_ros2."""
    with open(path, 'rb') as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        return [(channel.topic, message.log_time, decoded)
                for _, channel, message, decoded in reader.iter_decoded_messages(log_time_order=False)]


def read_with_rosbags(path):
    """[(topic, log time, decoded message)] by rosbags."""
    with AnyReader([path]) as reader:
        return [(connection.topic, time, reader.deserialize(data, connection.msgtype))
                for connection, time, data in reader.messages()]
