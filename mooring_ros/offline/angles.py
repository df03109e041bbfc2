"""Roll, pitch and yaw about the fixed axes x, y, z, in that order: R = Rz(yaw) Ry(pitch) Rx(roll)."""

import math

import numpy as np


def quaternion_from_degrees(roll, pitch, yaw):
    """Unit quaternion (4,) x, y, z, w of R = Rz(yaw) Ry(pitch) Rx(roll), angles in degrees."""
    (cr, sr), (cp, sp), (cy, sy) = (_half_angle(angle) for angle in (roll, pitch, yaw))
    return np.array(
        [
            cy * cp * sr - sy * sp * cr,
            cy * sp * cr + sy * cp * sr,
            sy * cp * cr - cy * sp * sr,
            cy * cp * cr + sy * sp * sr,
        ]
    )


def roll_pitch_yaw(quaternions):
    """Fixed-axis roll, pitch, yaw (n, 3) rad of quaternions (n, 4) x, y, z, w."""
    x, y, z, w = (quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)).T
    roll = np.arctan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    pitch = np.arcsin(np.clip(2.0 * (w * y - z * x), -1.0, 1.0))
    yaw = np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    return np.stack([roll, pitch, yaw], axis=1)


def _half_angle(degrees):
    half = math.radians(degrees) / 2.0
    return math.cos(half), math.sin(half)
