"""Serialization with equal bytes for equal messages.

CDR leaves gaps before fields that are aligned, and rclpy leaves in them whatever was in memory; here they are zero. After a message with
empty sequences it leaves a few bytes too many; here they are cut off.
"""
from rclpy.serialization import deserialize_message, serialize_message

_HEADER = 4     # bytes of encapsulation; alignment counts from after them
_SIZES = {"boolean": 1, "octet": 1, "char": 1, "int8": 1, "uint8": 1, "int16": 2, "uint16": 2, "int32": 4, "uint32": 4, "float": 4,
          "int64": 8, "uint64": 8, "double": 8}


def serialize(message):
    """The CDR bytes of a message. Raises ValueError for one whose layout is not understood."""
    data = serialize_message(message)
    walk = _Walk(data)
    walk.message(message)
    clean = bytes(walk.clean[:walk.end])
    if deserialize_message(clean, type(message)) != deserialize_message(data, type(message)):
        raise ValueError(f"the layout of {type(message).__name__} is not understood")
    return clean


class _Walk:
    """Goes through the fields of a message and copies their bytes."""

    def __init__(self, data):
        self.clean = bytearray(len(data))
        self.clean[:_HEADER] = data[:_HEADER]
        self.end = _HEADER
        self._data = data

    def message(self, message):
        for name, kind in message.get_fields_and_field_types().items():
            self._field(getattr(message, name), kind)

    def _field(self, value, kind):
        if kind.startswith("sequence<"):
            self._take(4, 4)
            self._items(value, kind[len("sequence<"):-1].split(",")[0])
        elif kind.endswith("]"):
            self._items(value, kind[:kind.index("[")])
        elif kind.startswith("string"):
            self._take(4, 4)
            self._take(len(value.encode()) + 1, 1)
        elif kind in _SIZES:
            self._take(_SIZES[kind], _SIZES[kind])
        else:
            self.message(value)

    def _items(self, values, kind):
        if kind not in _SIZES:
            for value in values:
                self._field(value, kind)
        elif len(values):
            self._take(_SIZES[kind] * len(values), _SIZES[kind])

    def _take(self, size, alignment):
        begin = self.end + (_HEADER - self.end) % alignment
        self.end = begin + size
        self.clean[begin:self.end] = self._data[begin:self.end]
