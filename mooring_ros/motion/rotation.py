"""Unit quaternions (x, y, z, w) of single samples, as plain floats: at these sizes array calls cost more than the sums.

A quaternion turns platform axes into world axes. Rotation vectors are in rad, along world axes.
"""
import math

IDENTITY = (0.0, 0.0, 0.0, 1.0)


def multiply(a, b):
    """The rotation b followed by the rotation a."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz)


def conjugate(q):
    """The inverse rotation."""
    return (-q[0], -q[1], -q[2], q[3])


def rotate(q, v):
    """The vector v (3,), given in platform axes, in world axes."""
    x, y, z, w = q
    a, b, c = v
    tx, ty, tz = 2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)
    return (a + w * tx + y * tz - z * ty,
            b + w * ty + z * tx - x * tz,
            c + w * tz + x * ty - y * tx)


def matrix(q):
    """The rotation as three rows: world = matrix · platform."""
    x, y, z, w = q
    return ((1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)),
            (2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)),
            (2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)))


def rotation_vector(q):
    """The rotation vector of q (rad), of length at most pi."""
    x, y, z, w = q
    if w < 0.0:
        x, y, z, w = -x, -y, -z, -w
    sine = math.sqrt(x * x + y * y + z * z)
    factor = 2.0 * math.atan2(sine, w) / sine if sine > 1e-12 else 2.0
    return (factor * x, factor * y, factor * z)


def from_rotation_vector(v):
    """The quaternion that turns by the rotation vector v (rad)."""
    angle = math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    factor = math.sin(0.5 * angle) / angle if angle > 1e-12 else 0.5
    return (factor * v[0], factor * v[1], factor * v[2], math.cos(0.5 * angle))


def turn_between(q_from, q_to):
    """The rotation vector (rad, world axes) that takes q_from into q_to."""
    return rotation_vector(multiply(q_to, conjugate(q_from)))
