"""Messages of recordings, which may come from anywhere."""

from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.serialization import deserialize_message


def decoded(entry, message_type, path="the recording"):
    """The message in an entry of the recording at path. Raises ValueError when its bytes are none of that type."""
    try:
        return deserialize_message(entry.data, message_type)
    except rclpy_implementation.RMWError as error:
        raise ValueError(f"{path}: topic {entry.topic}: {len(entry.data)} bytes are no {message_type.__name__}") from error
