"""Messages of a fixed shape, serialized once and then filled in: publishing costs a copy and a few stores."""
import struct

import numpy as np
from builtin_interfaces.msg import Time

from mooring_ros.node.clean_cdr import serialize

_STAMP = struct.Struct("<iI")
# A stamp that no real message has: where it stands in the bytes, the real one goes.
_PLACEHOLDER = Time(sec=-1_234_567_891, nanosec=987_654_321)
_PLACEHOLDER_BYTES = _STAMP.pack(_PLACEHOLDER.sec, _PLACEHOLDER.nanosec)


def placeholder_stamp():
    """The stamp to put into every header of a message that becomes a template."""
    return _PLACEHOLDER


def placeholder(count, dtype="<f8"):
    """Numbers to put where `count` values will be filled in later: no two calls give the same."""
    placeholder.calls += 1
    return np.random.default_rng(placeholder.calls).random(count).astype(dtype)


placeholder.calls = 0


class Template:
    """The bytes of a message with slots for its stamps and for runs of numbers.

    message: with `placeholder_stamp()` in its headers. slots: arrays from `placeholder` that were put into the message, in the
    order in which `fill` takes their values. Raises ValueError when a slot is not there exactly once.
    """

    def __init__(self, message, slots):
        self._bytes = serialize(message)
        self._stamps = list(_find(self._bytes, _PLACEHOLDER_BYTES))
        self._slots = []
        for slot in slots:
            found = list(_find(self._bytes, slot.tobytes())) if slot.size else [0]
            if len(found) != 1:
                raise ValueError(f"{type(message).__name__} holds a placeholder {len(found)} times, expected once")
            self._slots.append((found[0], slot.size * slot.itemsize, slot.dtype))

    def fill(self, stamp, *values):
        """The bytes of the message with this stamp (ns) and these arrays, one for each slot, of the slot's size."""
        data = bytearray(self._bytes)
        for begin in self._stamps:
            _STAMP.pack_into(data, begin, *divmod(stamp, 1_000_000_000))
        for (begin, size, dtype), value in zip(self._slots, values, strict=True):
            filling = np.asarray(value, dtype).tobytes()
            if len(filling) != size:
                raise ValueError(f"{len(filling)} bytes for a slot of {size}")
            data[begin:begin + size] = filling
        return bytes(data)


def _find(data, part):
    begin = data.find(part)
    while begin >= 0:
        yield begin
        begin = data.find(part, begin + 1)
