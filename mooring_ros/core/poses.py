"""Poses (7,), x, y, z (m) and quaternion x, y, z, w, and what lies between them."""

import numpy as np

from .platform import rotation_between


def between(pose, other):
    """(6,) m and rad about the world axes from one pose to another."""
    return np.concatenate([other[:3] - pose[:3], rotation_between(pose[3:], other[3:])])


def moved(pose, offset):
    """`pose` moved by `offset` (6,), m and rad about the world axes."""
    offset = np.asarray(offset, dtype=float)
    angle = norm(offset[3:])
    turn = offset[3:] * (0.5 * np.sinc(0.5 * angle / np.pi))
    c, v, w = np.cos(0.5 * angle), pose[3:6], pose[6]
    quaternion = np.append(c * v + w * turn + np.cross(turn, v), c * w - turn @ v)
    return np.concatenate([pose[:3] + offset[:3], quaternion / norm(quaternion)])


def distance(offset, reach):
    """Of an offset (6,) in m and rad: m, a rotation by what it moves at `reach` (m)."""
    return float(np.hypot(norm(offset[:3]), reach * norm(offset[3:])))


def norm(vector):
    return float(np.sqrt(vector @ vector))
