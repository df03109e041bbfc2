"""Poses (M, 7) of platforms, x, y, z (m) and quaternion x, y, z, w, and what lies between them: (6 M,), platform by platform."""

import numpy as np

from .platform import rotation_between


def between(pose, other):
    """(6 M,) m and rad about the world axes from poses (M, 7) to others."""
    return np.concatenate([part for a, b in zip(pose, other) for part in (b[:3] - a[:3], rotation_between(a[3:], b[3:]))])


def moved(pose, offset):
    """Poses (M, 7) moved by `offset` (6 M,), m and rad about the world axes."""
    return np.array([_moved(own, by) for own, by in zip(pose, np.reshape(offset, (-1, 6)))])


def _moved(pose, offset):
    angle = norm(offset[3:])
    turn = offset[3:] * (0.5 * np.sinc(0.5 * angle / np.pi))
    c, v, w = np.cos(0.5 * angle), pose[3:6], pose[6]
    quaternion = np.append(c * v + w * turn + np.cross(turn, v), c * w - turn @ v)
    return np.concatenate([pose[:3] + offset[:3], quaternion / norm(quaternion)])


def distance(offset, reach):
    """Of an offset (6 M,) in m and rad: m, a rotation by what it moves at `reach` (m)."""
    moves = offset.reshape(-1, 2, 3)
    return float(np.hypot(norm(moves[:, 0].ravel()), reach * norm(moves[:, 1].ravel())))


def norm(vector):
    return float(np.sqrt(vector @ vector))
