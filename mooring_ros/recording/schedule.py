"""The step schedule: what was done to the mooring core, in order, so that it can be done again bit for bit.

One record for each thing done, 15 doubles: kind, t, pose (x, y, z, qx, qy, qz, qw), twist (vx, vy, vz, wx, wy, wz).
A mooring with platforms has pose and twist of each in turn, 2 + 13 doubles for each platform, others have one.
The doubles are exactly those that were passed to `Mooring`. A release carries the line's index in the third
place and zeros after it, a change of a line's unstretched length the index and the length in m; a settle has no twist. Published on `<node>/steps` as std_msgs/Float64MultiArray; the stamp
of the input is the message's log and publish time.
"""
from dataclasses import dataclass

import numpy as np

from mooring_ros.platforms import platform_count

SETTLE, STEP, RELEASE, WIND = 0, 1, 2, 3
KINDS = ('settle', 'step', 'release', 'wind')
MOVES = (SETTLE, STEP)               # the platform; each has an answer
LENGTH = 15                          # of one platform
_OF_PLATFORM, _POSE = 13, 7
TOPIC_SUFFIX = '/steps'
TYPE_NAME = 'std_msgs/msg/Float64MultiArray'


@dataclass(frozen=True)
class Action:
    """One thing done to the core. time: s; pose (7,), twist (6,), or a row for each platform that has a name: world frame, None for what is done to a line; line: index; length: m, unstretched."""

    kind: int
    time: float
    pose: np.ndarray | None = None
    twist: np.ndarray | None = None
    line: int | None = None
    length: float | None = None


def size(platforms):
    """Floats in a record of a mooring with these platforms (names, or None)."""
    return 2 + _OF_PLATFORM * platform_count(platforms)


def encode_settle(time, pose):
    """15 floats for `settle(pose, time)`. pose (7,), or more for (platforms, 7)."""
    return _pack(SETTLE, time, pose, np.zeros((*np.shape(pose)[:-1], 6)))


def encode_step(time, pose, twist):
    """15 floats for `step(time, pose, twist)`. pose (7,), twist (6,), world frame; or more for (platforms, 7) and (platforms, 6)."""
    return _pack(STEP, time, pose, twist)


def encode_release(time, line):
    """15 floats for the release of the line with index `line` at `time`."""
    return [float(RELEASE), float(time), float(line)] + [0.0] * (LENGTH - 3)


def encode_wind(time, line, length):
    """15 floats for the unstretched length `length` (m) given to the line with index `line` at `time`."""
    return [float(WIND), float(time), float(line), float(length)] + [0.0] * (LENGTH - 4)


def _pack(kind, time, pose, twist):
    pose, twist = np.asarray(pose, dtype=float), np.asarray(twist, dtype=float)
    if pose.shape[-1:] != (7,) or pose.ndim > 2 or twist.shape != (*pose.shape[:-1], 6):
        raise ValueError(f'pose has shape {pose.shape} and twist {twist.shape}: expected (7,) and (6,), or a row for each platform')
    return [float(kind), float(time), *np.concatenate([pose, twist], axis=-1).ravel().tolist()]


def decode(data, platforms=None):
    """The Action of 15 numbers, or of more for platforms with names. Raises ValueError when they are no schedule record."""
    data = np.array(data, dtype=float)
    if data.shape != (size(platforms),):
        raise ValueError(f'step schedule record has {data.size} numbers: expected {size(platforms)}')
    if not np.all(np.isfinite(data)):
        raise ValueError('step schedule record has a number that is not finite')
    kind, time = data[0], float(data[1])
    if kind in (RELEASE, WIND):
        line, length = data[2], data[3]
        if line < 0 or line != int(line) or np.any(data[4:]) or (length != 0.0 if kind == RELEASE else length <= 0.0):
            expected = 'an index' if kind == RELEASE else 'an index, a length'
            raise ValueError(f'step schedule: {KINDS[int(kind)]} of line {line:g}: expected {expected} and zeros after it')
        return Action(int(kind), time, line=int(line), length=float(length) if kind == WIND else None)
    if kind not in MOVES:
        raise ValueError(f'step schedule record of kind {kind:g}: expected 0 (settle), 1 (step), 2 (release) or 3 (wind)')
    rows = data[2:].reshape(-1, _OF_PLATFORM)
    pose, twist = rows[:, :_POSE], rows[:, _POSE:]
    return Action(int(kind), time, pose, twist) if platforms else Action(int(kind), time, pose[0], twist[0])
