"""Rigid motion of the platform between two samples: a cubic Hermite curve in position and in rotation.

The rotation runs along R(t) = exp(phi(t)) R_0 with a cubic Hermite phi from 0 to the rotation vector between the samples, whose end slopes
are the angular velocities carried through the inverse of the exponential's tangent map; a constant angular velocity gives slerp exactly.
Quaternions are x, y, z, w; all vectors are in the world frame. Small vectors are tuples, which the compiler keeps in registers.
"""

import numpy as np

from .cache import formula

SMALL_ANGLE = 0.3  # rad: below, series replace sines (error below 1e-16)


@formula
def exponential_coefficients(s):
    """(sin a / a, (1 - cos a) / a^2, (a - sin a) / a^3) for s = a^2."""
    if s < SMALL_ANGLE * SMALL_ANGLE:
        first = 1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0 * (1.0 - s / 110.0))))
        second = 0.5 * (1.0 - s / 12.0 * (1.0 - s / 30.0 * (1.0 - s / 56.0 * (1.0 - s / 90.0 * (1.0 - s / 132.0)))))
        third = (1.0 - s / 20.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0 * (1.0 - s / 110.0 * (1.0 - s / 156.0))))) / 6.0
    else:
        a = np.sqrt(s)
        first = np.sin(a) / a
        second = (1.0 - np.cos(a)) / s
        third = (a - np.sin(a)) / (s * a)
    return first, second, third


@formula
def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@formula
def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@formula
def rotate(q, a):
    """The vector a turned by the unit quaternion q."""
    v = (q[0], q[1], q[2])
    t = cross(v, a)
    t = (2.0 * t[0], 2.0 * t[1], 2.0 * t[2])
    c = cross(v, t)
    return a[0] + q[3] * t[0] + c[0], a[1] + q[3] * t[1] + c[1], a[2] + q[3] * t[2] + c[2]


@formula
def rotation_between(q0, q1):
    """Rotation vector of the shorter turn from q0 to q1, in the world frame: q1 = exp(phi) q0."""
    a = (q0[0], q0[1], q0[2])
    b = (q1[0], q1[1], q1[2])
    c = cross(a, b)
    x = q0[3] * b[0] - q1[3] * a[0] + c[0]
    y = q0[3] * b[1] - q1[3] * a[1] + c[1]
    z = q0[3] * b[2] - q1[3] * a[2] + c[2]
    w = q0[3] * q1[3] + dot(a, b)
    sine = np.sqrt(x * x + y * y + z * z)
    scale = 2.0 * np.arctan2(sine, abs(w)) / sine if sine > 1e-12 else 2.0
    if w < 0.0:
        scale = -scale
    return scale * x, scale * y, scale * z


@formula
def inverse_tangent_map(phi, omega):
    """phi' from the angular velocity: omega - phi x omega / 2 + c phi x (phi x omega), c = (1 - (a/2) cot(a/2)) / a^2."""
    square = dot(phi, phi)
    if square < 1e-4:
        c = (1.0 + square / 60.0) / 12.0
    else:
        first, second, _ = exponential_coefficients(square)
        c = (1.0 - 0.5 * first / second) / square
    once = cross(phi, omega)
    twice = cross(phi, once)
    return (
        omega[0] - 0.5 * once[0] + c * twice[0],
        omega[1] - 0.5 * once[1] + c * twice[1],
        omega[2] - 0.5 * once[2] + c * twice[2],
    )


@formula
def start_motion(pose0, twist0, pose1, twist1, duration, motion):
    """Fill motion (8, 3) for `platform_at`: rows p0, v0 h, p1, v1 h, phi1, phi0' h, phi1' h, (h, 0, 0), with h the duration (s)."""
    phi = rotation_between(pose0[3:], pose1[3:])
    slope = inverse_tangent_map(phi, (twist1[3], twist1[4], twist1[5]))
    for i in range(3):
        motion[0, i] = pose0[i]
        motion[1, i] = twist0[i] * duration
        motion[2, i] = pose1[i]
        motion[3, i] = twist1[i] * duration
        motion[4, i] = phi[i]
        motion[5, i] = twist0[3 + i] * duration
        motion[6, i] = slope[i] * duration
    motion[7, 0] = duration


@formula
def platform_at(motion, s):
    """(place, velocity, rotation vector since the start, angular velocity) at s in 0..1 of the interval."""
    r = 1.0 - s
    h00, h10, h01, h11 = (1.0 + 2.0 * s) * r * r, s * r * r, s * s * (3.0 - 2.0 * s), -s * s * r
    per_second = 1.0 / motion[7, 0]
    d00, d10, d11 = -6.0 * s * r * per_second, r * (1.0 - 3.0 * s) * per_second, s * (3.0 * s - 2.0) * per_second
    place = (
        h00 * motion[0, 0] + h10 * motion[1, 0] + h01 * motion[2, 0] + h11 * motion[3, 0],
        h00 * motion[0, 1] + h10 * motion[1, 1] + h01 * motion[2, 1] + h11 * motion[3, 1],
        h00 * motion[0, 2] + h10 * motion[1, 2] + h01 * motion[2, 2] + h11 * motion[3, 2],
    )
    velocity = (
        d00 * (motion[0, 0] - motion[2, 0]) + d10 * motion[1, 0] + d11 * motion[3, 0],
        d00 * (motion[0, 1] - motion[2, 1]) + d10 * motion[1, 1] + d11 * motion[3, 1],
        d00 * (motion[0, 2] - motion[2, 2]) + d10 * motion[1, 2] + d11 * motion[3, 2],
    )
    phi = (
        h01 * motion[4, 0] + h10 * motion[5, 0] + h11 * motion[6, 0],
        h01 * motion[4, 1] + h10 * motion[5, 1] + h11 * motion[6, 1],
        h01 * motion[4, 2] + h10 * motion[5, 2] + h11 * motion[6, 2],
    )
    rate = (
        d10 * motion[5, 0] - d00 * motion[4, 0] + d11 * motion[6, 0],
        d10 * motion[5, 1] - d00 * motion[4, 1] + d11 * motion[6, 1],
        d10 * motion[5, 2] - d00 * motion[4, 2] + d11 * motion[6, 2],
    )
    _, second, third = exponential_coefficients(dot(phi, phi))
    once = cross(phi, rate)
    twice = cross(phi, once)
    omega = (
        rate[0] + second * once[0] + third * twice[0],
        rate[1] + second * once[1] + third * twice[1],
        rate[2] + second * once[2] + third * twice[2],
    )
    return place, velocity, phi, omega


@formula
def turned(phi, a):
    """exp(phi) a."""
    first, second, _ = exponential_coefficients(dot(phi, phi))
    once = cross(phi, a)
    twice = cross(phi, once)
    return (
        a[0] + first * once[0] + second * twice[0],
        a[1] + first * once[1] + second * twice[1],
        a[2] + first * once[2] + second * twice[2],
    )
