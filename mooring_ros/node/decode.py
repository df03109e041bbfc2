"""Platform motion straight from the CDR bytes of a message: a tenth of the time that message objects take."""
import struct

from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.serialization import deserialize_message, serialize_message

from mooring_ros.motion import Sample

_LITTLE_ENDIAN = b"\x00\x01"
_HEADER = 4                     # bytes of encapsulation; alignment counts from after them
_STAMP_AND_LENGTH = struct.Struct("<iII")
_LENGTH = struct.Struct("<I")
_POSE = struct.Struct("<7d")
_TWIST = struct.Struct("<6d")
_COVARIANCE = 36 * 8
_LONGEST_NAME = 256             # bytes of a frame's name with its end; it goes out again in every answer


def odometry(data):
    """The Sample in the bytes of a nav_msgs/Odometry. Raises ValueError when they are none."""
    return _guarded(_odometry, data, Odometry)


def pose_stamped(data):
    """The Sample (without a twist) in the bytes of a geometry_msgs/PoseStamped. Raises ValueError when they are none."""
    return _guarded(_pose_stamped, data, PoseStamped)


def twist_stamped(data):
    """Stamp (ns), frame and twist (6,) in the bytes of a geometry_msgs/TwistStamped. Raises ValueError when they are none."""
    return _guarded(_twist_stamped, data, TwistStamped)


def _guarded(decode, data, message_type):
    try:
        if data[:2] != _LITTLE_ENDIAN:
            data = serialize_message(deserialize_message(data, message_type))
        return decode(data)
    except (struct.error, UnicodeDecodeError, rclpy_implementation.RMWError) as error:
        raise ValueError(f"{len(data)} bytes are no {message_type.__name__}: {error}") from error


def _header(data):
    """Stamp in ns, frame_id and where the next field may begin."""
    seconds, nanoseconds, length = _STAMP_AND_LENGTH.unpack_from(data, _HEADER)
    if nanoseconds >= 1_000_000_000:
        raise ValueError(f"stamp has {nanoseconds} nanoseconds, expected less than a second of them")
    begin = _HEADER + _STAMP_AND_LENGTH.size
    return seconds * 1_000_000_000 + nanoseconds, _text(data, begin, length), begin + length


def _text(data, begin, length):
    if length > _LONGEST_NAME:
        raise ValueError(f"a frame's name has {length - 1} bytes, expected {_LONGEST_NAME - 1} at most")
    return data[begin:begin + length - 1].decode()


def _aligned(position, to):
    return position + (_HEADER - position) % to


def _odometry(data):
    stamp, frame, position = _header(data)
    position = _aligned(position, 4)
    length, = _LENGTH.unpack_from(data, position)
    child_frame = _text(data, position + 4, length)
    position = _aligned(position + 4 + length, 8)
    twist = _TWIST.unpack_from(data, position + _POSE.size + _COVARIANCE)
    return Sample(stamp, _POSE.unpack_from(data, position), twist, frame, child_frame)


def _pose_stamped(data):
    stamp, frame, position = _header(data)
    return Sample(stamp, _POSE.unpack_from(data, _aligned(position, 8)), None, frame)


def _twist_stamped(data):
    stamp, frame, position = _header(data)
    return stamp, frame, _TWIST.unpack_from(data, _aligned(position, 8))
