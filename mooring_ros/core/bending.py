"""Bending forces of hinges, clamps and joints (see hinges.py).

A hinge's energy E(c) depends on the cosine c of the angle between its segments alone, and with G = -dE/dc its force on the node ahead is
(G / L)(q- - c q+): three forces that are normal to the segments, without sum and without moment. All hinges together shear segment j, of
stretched length L, with S_j = (G_{j-1}(q_{j-1} - c_{j-1} q_j) + G_j (q_{j+1} - c_j q_j)) / L_j, +S_j on node j and -S_j on node j - 1.
Differences of tangents stand in place of c: 1 - c loses its digits at small angles.
"""

import numpy as np

from .cache import kernel, stage

OPEN = 0.01  # smallest cos^2(theta/2): a segment folded closer onto the next is met with a spring that does not grow any more
SHORT = 0.1  # share of a segment's unstretched length below which it turns as if it were so long
AIMLESS = 1e-6  # share of a joint's stiffness below which its members do not agree on a direction


@stage
def turning(bending, x):
    """G / K of a hinge with x = sin^2(theta/2): moment / (K sin theta)."""
    a, b, c = bending.measure[0], bending.measure[1], bending.measure[2]
    return (1.0 + x * (a + x * (b + x * c))) / np.sqrt(max(1.0 - x, OPEN))


@stage
def inverse_stretched(position, tangent, length, j):
    """1 / stretched length of segment j, 1/m."""
    stretched = (
        (position[0, j] - position[0, j - 1]) * tangent[0, j]
        + (position[1, j] - position[1, j - 1]) * tangent[1, j]
        + (position[2, j] - position[2, j - 1]) * tangent[2, j]
    )
    return 1.0 / max(stretched, SHORT * length[j])


@stage
def into_line(tangent, segment, sign):
    """Unit vector (3,) from a line's end into the line."""
    return sign * tangent[0, segment], sign * tangent[1, segment], sign * tangent[2, segment]


@stage
def half_sine_squared(a, b):
    """sin^2 of half the angle between unit vectors a and b."""
    x, y, z = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    return min(0.25 * (x * x + y * y + z * z), 1.0)


@stage
def joint_direction(bending, tangent, end_point, j):
    """Direction (3,) in which a joint without mass rests among its members, as sum and length of K_i t_i, and the sum of K_i."""
    x, y, z, total = 0.0, 0.0, 0.0, 0.0
    for m in range(bending.joint_first[j], bending.joint_first[j + 1]):
        if end_point[bending.member_end[m]] == bending.joint_point[j]:
            stiff, segment = bending.member_stiffness[m], bending.member_segment[m]
            weight = stiff * bending.member_sign[m] * bending.member_side[m]
            x += weight * tangent[0, segment]
            y += weight * tangent[1, segment]
            z += weight * tangent[2, segment]
            total += stiff
    return (x, y, z), np.sqrt(x * x + y * y + z * z), total


@stage
def hinge_forces(bending, size, position, tangent, length, work):
    """Fill work[0:3] with the shear of every segment by the hinges at its ends; work[3:5] is used on the way."""
    x, y, z = position[0], position[1], position[2]
    qx, qy, qz = tangent[0], tangent[1], tangent[2]
    sx, sy, sz, force, along = work[0], work[1], work[2], work[3], work[4]
    stiffness, a, b, c = bending.stiffness, bending.measure[0], bending.measure[1], bending.measure[2]
    sx[0], sy[0], sz[0], force[size], along[size] = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(size):
        dx, dy, dz = qx[i + 1] - qx[i], qy[i + 1] - qy[i], qz[i + 1] - qz[i]
        s2 = 0.25 * (dx * dx + dy * dy + dz * dz)
        g = stiffness[i] * (1.0 + s2 * (a + s2 * (b + s2 * c))) / np.sqrt(max(1.0 - s2, OPEN))
        force[i] = g
        along[i] = 2.0 * g * s2
    for i in range(size):
        dx, dy, dz = x[i + 1] - x[i], y[i + 1] - y[i], z[i + 1] - z[i]
        tx, ty, tz = qx[i + 1], qy[i + 1], qz[i + 1]
        scale = 1.0 / max(dx * tx + dy * ty + dz * tz, SHORT * length[i + 1])
        left, right, back = scale * force[i], scale * force[i + 1], scale * (along[i] + along[i + 1])
        sx[i + 1] = left * (qx[i] - tx) + right * (qx[i + 2] - tx) + back * tx
        sy[i + 1] = left * (qy[i] - ty) + right * (qy[i + 2] - ty) + back * ty
        sz[i + 1] = left * (qz[i] - tz) + right * (qz[i + 2] - tz) + back * tz


@stage
def clamp_forces(bending, position, tangent, length, end_point, clamp_axis, work, clamp_moment):
    """Add the clamps' shear to work[0:3], and fill `clamp_moment`."""
    for k in range(bending.clamp_end.size):
        for a in range(3):
            clamp_moment[k, a] = 0.0
        if end_point[bending.clamp_end[k]] != bending.clamp_point[k]:
            continue
        segment, sign = bending.clamp_segment[k], bending.clamp_sign[k]
        d = (clamp_axis[k, 0], clamp_axis[k, 1], clamp_axis[k, 2])
        t = into_line(tangent, segment, sign)
        s2 = half_sine_squared(d, t)
        g = bending.clamp_stiffness[k] * turning(bending, s2)
        scale = sign * g * inverse_stretched(position, tangent, length, segment)
        for a in range(3):
            work[a, segment] += scale * (d[a] - t[a] + 2.0 * s2 * t[a])
            b, c = (a + 1) % 3, (a + 2) % 3
            clamp_moment[k, a] = g * (d[b] * t[c] - d[c] * t[b])


@stage
def joint_forces(bending, position, tangent, length, end_point, work):
    """Add the joints' shear to work[0:3]: E = sum K_i - |sum K_i t_i|, that of 2 sin(theta/2) for two equal members."""
    for j in range(bending.joint_point.size):
        total_vector, norm, total = joint_direction(bending, tangent, end_point, j)
        shrink = 1.0 / max(norm, AIMLESS * total, 1e-300)
        d = (shrink * total_vector[0], shrink * total_vector[1], shrink * total_vector[2])
        for m in range(bending.joint_first[j], bending.joint_first[j + 1]):
            if end_point[bending.member_end[m]] != bending.joint_point[j]:
                continue
            segment, sign = bending.member_segment[m], bending.member_sign[m]
            t = into_line(tangent, segment, sign * bending.member_side[m])
            s2 = half_sine_squared(d, t)
            scale = sign * bending.member_side[m] * bending.member_stiffness[m] * inverse_stretched(position, tangent, length, segment)
            for a in range(3):
                work[a, segment] += scale * (d[a] - t[a] + 2.0 * s2 * t[a])


@stage
def bending_forces(bending, size, position, tangent, length, end_point, clamp_axis, work, force, clamp_moment):
    """Add all bending forces to `force` (3, n), N; nothing when no line has a bending stiffness.

    position (3, n), m; tangent (3, n) unit vectors and length (n,) unstretched, m, of the segments; end_point (E,) what holds each line's end;
    clamp_axis (C, 3): unit vectors from the clamps into their lines, world frame; work (5, n);
    clamp_moment (C, 3): filled with the moment on what holds each clamp, N m, world frame.
    """
    if bending.stiffness.size == 0:
        return
    hinge_forces(bending, size, position, tangent, length, work)
    clamp_forces(bending, position, tangent, length, end_point, clamp_axis, work, clamp_moment)
    joint_forces(bending, position, tangent, length, end_point, work)
    fx, fy, fz = force[0], force[1], force[2]
    sx, sy, sz = work[0], work[1], work[2]
    for i in range(size):
        fx[i] += sx[i] - sx[i + 1]
        fy[i] += sy[i] - sy[i + 1]
        fz[i] += sz[i] - sz[i + 1]


@kernel
def bend(bending, size, position, tangent, length, end_point, clamp_axis, work, force, clamp_moment):
    """`bending_forces`, compiled on its own."""
    bending_forces(bending, size, position, tangent, length, end_point, clamp_axis, work, force, clamp_moment)
