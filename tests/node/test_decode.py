"""Motion read from CDR bytes is what the message held, whatever its strings do to the alignment."""
import pytest
from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.serialization import serialize_message

from mooring_ros.node import decode

POSE, TWIST = (1.0, -2.0, 3.0, 0.1, 0.2, 0.3, 0.9), (4.0, 5.0, 6.0, 0.7, 0.8, 0.9)


def set_pose(pose):
    pose.position.x, pose.position.y, pose.position.z = POSE[:3]
    pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w = POSE[3:]


def set_twist(twist):
    twist.linear.x, twist.linear.y, twist.linear.z = TWIST[:3]
    twist.angular.x, twist.angular.y, twist.angular.z = TWIST[3:]


@pytest.mark.parametrize("child", ["", "a", "base_link", "plattform/öl"])
@pytest.mark.parametrize("frame", ["", "w", "wo", "world", "odom123", "odom1234"])
def test_odometry_is_read_for_any_frame_names(frame, child):
    message = Odometry(child_frame_id=child)
    message.header.frame_id = frame
    message.header.stamp.sec, message.header.stamp.nanosec = 1700000000, 999999999
    set_pose(message.pose.pose)
    set_twist(message.twist.twist)
    message.pose.covariance[35] = 1e9
    sample = decode.odometry(serialize_message(message))
    assert sample == (1700000000999999999, POSE, TWIST, frame, child, None)


@pytest.mark.parametrize("frame", ["", "w", "world", "odom1234"])
def test_pose_and_twist_are_read_for_any_frame_name(frame):
    pose, twist = PoseStamped(), TwistStamped()
    for message in (pose, twist):
        message.header.frame_id = frame
        message.header.stamp.sec, message.header.stamp.nanosec = 5, 7
    set_pose(pose.pose)
    set_twist(twist.twist)
    assert decode.pose_stamped(serialize_message(pose))[:4] == (5000000007, POSE, None, frame)
    assert decode.twist_stamped(serialize_message(twist)) == (5000000007, frame, TWIST)


def test_bytes_that_are_cut_off_are_refused():
    with pytest.raises(ValueError, match="no Odometry"):
        decode.odometry(serialize_message(Odometry())[:200])


@pytest.mark.parametrize("data", [b"", b"\x00", b"\x00\x00\x00\x00" + b"\xff" * 50], ids=["none", "one", "big-endian nonsense"])
def test_bytes_of_another_encoding_that_make_no_message_are_refused(data):
    with pytest.raises(ValueError, match="no Odometry"):
        decode.odometry(data)


@pytest.mark.parametrize("decoded, message", [(decode.odometry, Odometry()), (decode.pose_stamped, PoseStamped()), (decode.twist_stamped, TwistStamped())])
def test_a_stamp_with_more_than_a_second_of_nanoseconds_is_refused(decoded, message):
    message.header.stamp.nanosec = 4_000_000_000
    with pytest.raises(ValueError, match="4000000000 nanoseconds"):
        decoded(serialize_message(message))


def test_a_frame_name_that_is_no_name_is_refused():
    message = Odometry(child_frame_id="x" * 100_000)
    with pytest.raises(ValueError, match="100000 bytes, expected 255"):
        decode.odometry(serialize_message(message))
