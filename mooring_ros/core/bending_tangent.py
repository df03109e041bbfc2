"""Tangent stiffness of bending: the exact second derivatives of its energy, as 3 x 3 blocks (see bending.py).

Of an energy E(c) in the cosine c of unit vectors a and b, with E' = -G, u and v the stretched vectors along a and b (lengths L and M),
P = I - a a', Q = I - b b':
d2E/du2 = (E'' (P b)(P b)' - E' (c P + (P b) a' + a (P b)')) / L^2 and d2E/du dv = (E'' (P b)(Q a)' + E' P Q) / (L M).
"""

from typing import NamedTuple

import numpy as np

from .bending import AIMLESS, OPEN, half_sine_squared, into_line, inverse_stretched, joint_direction
from .cache import kernel, stage


class BendingPattern(NamedTuple):
    """Where the blocks stand: block k is row rows[k], column cols[k] (nodes); blocks of the same place add up. H hinges."""

    rows: np.ndarray  # (b,)
    cols: np.ndarray  # (b,)
    hinge: np.ndarray  # (H,) nodes: 9 blocks each, of nodes i - 1, i, i + 1 row by row; then 4 of each clamp, then (2 M)^2 of each joint


def bending_pattern(bending):
    """Pattern of `bending_blocks`; a clamp's and a joint's nodes are end and next node of each line in turn, row by row."""
    hinge = np.flatnonzero(bending.stiffness)
    groups = [[i - 1, i, i + 1] for i in hinge]
    if bending.stiffness.size:
        groups += [_end_nodes(segment, sign) for segment, sign in zip(bending.clamp_segment, bending.clamp_sign)]
        for first, last in zip(bending.joint_first[:-1], bending.joint_first[1:]):
            pairs = [_end_nodes(bending.member_segment[m], bending.member_sign[m]) for m in range(first, last)]
            groups.append([node for pair in pairs for node in pair])
    rows = [row for nodes in groups for row in nodes for _ in nodes]
    cols = [col for nodes in groups for _ in nodes for col in nodes]
    return BendingPattern(np.array(rows, dtype=np.int64), np.array(cols, dtype=np.int64), hinge)


def _end_nodes(segment, sign):
    return [segment - 1, segment] if sign > 0.0 else [segment, segment - 1]


@stage
def _slopes(bending, s2):
    """dE/dc and d2E/dc2 of a hinge of stiffness 1, with s2 = (1 - c) / 2."""
    a, b, c = bending.measure[0], bending.measure[1], bending.measure[2]
    r = 1.0 + s2 * (a + s2 * (b + s2 * c))
    growth = a + s2 * (2.0 * b + s2 * 3.0 * c)
    y = np.sqrt(max(1.0 - s2, OPEN))
    if 1.0 - s2 > OPEN:
        growth += 0.5 * r / (y * y)
    return -r / y, 0.5 * growth / y


@stage
def _beside(a, b, s2):
    """b less its part along a: (b - a) + 2 s2 a, for unit vectors with sin^2(theta / 2) = s2."""
    return b[0] - a[0] + 2.0 * s2 * a[0], b[1] - a[1] + 2.0 * s2 * a[1], b[2] - a[2] + 2.0 * s2 * a[2]


@stage
def _own(first, second, a, pb, cosine, i, j):
    """Entry i, j of L^2 d2E/du2."""
    identity = 1.0 if i == j else 0.0
    return second * pb[i] * pb[j] - first * (cosine * (identity - a[i] * a[j]) + pb[i] * a[j] + a[i] * pb[j])


@stage
def _mixed(first, second, a, b, pb, qa, cosine, i, j):
    """Entry i, j of L M d2E/du dv."""
    identity = 1.0 if i == j else 0.0
    return second * pb[i] * qa[j] + first * (identity - a[i] * a[j] - b[i] * b[j] + cosine * a[i] * b[j])


@stage
def _hinge_blocks(bending, position, tangent, length, node, data, k):
    before = (tangent[0, node], tangent[1, node], tangent[2, node])
    after = (tangent[0, node + 1], tangent[1, node + 1], tangent[2, node + 1])
    per_before = inverse_stretched(position, tangent, length, node)
    per_after = inverse_stretched(position, tangent, length, node + 1)
    s2 = half_sine_squared(before, after)
    cosine = 1.0 - 2.0 * s2
    first, second = _slopes(bending, s2)
    first, second = first * bending.stiffness[node], second * bending.stiffness[node]
    p, q = _beside(after, before, s2), _beside(before, after, s2)
    for i in range(3):
        for j in range(3):
            aa = per_after * per_after * _own(first, second, after, p, cosine, i, j)
            bb = per_before * per_before * _own(first, second, before, q, cosine, i, j)
            ab = per_after * per_before * _mixed(first, second, after, before, p, q, cosine, i, j)
            ba = per_after * per_before * _mixed(first, second, before, after, q, p, cosine, i, j)
            data[k, i, j] = bb
            data[k + 1, i, j] = ba - bb
            data[k + 2, i, j] = -ba
            data[k + 3, i, j] = ab - bb
            data[k + 4, i, j] = aa + bb - ab - ba
            data[k + 5, i, j] = ba - aa
            data[k + 6, i, j] = -ab
            data[k + 7, i, j] = ab - aa
            data[k + 8, i, j] = aa


@stage
def _clamp_blocks(bending, position, tangent, length, clamp_axis, clamp, data, k, turn, axis):
    d = (clamp_axis[clamp, 0], clamp_axis[clamp, 1], clamp_axis[clamp, 2])
    segment = bending.clamp_segment[clamp]
    t = into_line(tangent, segment, bending.clamp_sign[clamp])
    per_length = inverse_stretched(position, tangent, length, segment)
    s2 = half_sine_squared(d, t)
    cosine = 1.0 - 2.0 * s2
    first, second = _slopes(bending, s2)
    first, second = first * bending.clamp_stiffness[clamp], second * bending.clamp_stiffness[clamp]
    p = _beside(t, d, s2)
    m = (d[1] * t[2] - d[2] * t[1], d[2] * t[0] - d[0] * t[2], d[0] * t[1] - d[1] * t[0])  # change of c by a turn of d
    for i in range(3):
        for j in range(3):
            own = per_length * per_length * _own(first, second, t, p, cosine, i, j)
            data[k, i, j] = own
            data[k + 1, i, j] = -own
            data[k + 2, i, j] = -own
            data[k + 3, i, j] = own
            # column j of -P [d]x: P (e_j x d)
            f, g = (j + 1) % 3, (j + 2) % 3
            swept = -d[g] if i == f else (d[f] if i == g else 0.0)
            swept -= t[i] * (t[g] * d[f] - t[f] * d[g])
            mixed = per_length * (second * p[i] * m[j] + first * swept)
            turn[clamp, 0, i, j] = -mixed
            turn[clamp, 1, i, j] = mixed
            identity = 1.0 if i == j else 0.0
            axis[clamp, i, j] = second * m[i] * m[j] + first * (0.5 * (d[i] * t[j] + t[i] * d[j]) - cosine * identity)


@stage
def _joint_blocks(bending, position, tangent, length, end_point, joint, data, k):
    total, norm, stiff = joint_direction(bending, tangent, end_point, joint)
    norm = max(norm, AIMLESS * stiff, 1e-300)
    d = (total[0] / norm, total[1] / norm, total[2] / norm)
    start, stop = bending.joint_first[joint], bending.joint_first[joint + 1]
    width = 2 * (stop - start)
    for m in range(start, stop):
        for o in range(start, stop):
            both = end_point[bending.member_end[m]] == bending.joint_point[joint] == end_point[bending.member_end[o]]
            a = into_line(tangent, bending.member_segment[m], bending.member_sign[m] * bending.member_side[m])
            b = into_line(tangent, bending.member_segment[o], bending.member_sign[o] * bending.member_side[o])
            per_a = inverse_stretched(position, tangent, length, bending.member_segment[m])
            scale_a = bending.member_stiffness[m] * per_a
            scale_b = bending.member_stiffness[o] * inverse_stretched(position, tangent, length, bending.member_segment[o])
            sa, sb = half_sine_squared(a, d), half_sine_squared(b, d)
            pa, pb = _beside(a, d, sa), _beside(b, d, sb)
            ab = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
            sides = bending.member_side[m] * bending.member_side[o]
            corner = k + 2 * (m - start) * width + 2 * (o - start)
            for i in range(3):
                for j in range(3):
                    identity = 1.0 if i == j else 0.0
                    # P_a (I - d d') P_b
                    across = identity - a[i] * a[j] - b[i] * b[j] + ab * a[i] * b[j] - pa[i] * pb[j]
                    entry = -scale_a * scale_b / norm * across
                    if m == o:
                        entry += scale_a * per_a * _own(-1.0, 0.0, a, pa, 1.0 - 2.0 * sa, i, j)
                    entry = sides * entry if both else 0.0
                    data[corner, i, j] = entry
                    data[corner + 1, i, j] = -entry
                    data[corner + width, i, j] = -entry
                    data[corner + width + 1, i, j] = entry
    return k + width * width


@kernel
def bending_blocks(bending, pattern, position, tangent, length, end_point, clamp_axis, data, turn, axis):
    """Second derivatives of the bending energy (K = -dF/dx): data (b, 3, 3), N/m, in the places of `pattern`.

    For each clamp, by small turns w of its axis (the axis becomes d + w x d + w x (w x d) / 2): turn (C, 2, 3, 3), N, rows of its end node and the next,
    columns of the turn (the other triangle is its transpose); axis (C, 3, 3), N m/rad. A clamp that its line has left has zeros.
    """
    k = 0
    for h in range(pattern.hinge.size):
        _hinge_blocks(bending, position, tangent, length, pattern.hinge[h], data, k)
        k += 9
    if bending.stiffness.size == 0:
        return
    for clamp in range(bending.clamp_end.size):
        if end_point[bending.clamp_end[clamp]] == bending.clamp_point[clamp]:
            _clamp_blocks(bending, position, tangent, length, clamp_axis, clamp, data, k, turn, axis)
        else:
            data[k : k + 4] = 0.0
            turn[clamp] = 0.0
            axis[clamp] = 0.0
        k += 4
    for joint in range(bending.joint_point.size):
        k = _joint_blocks(bending, position, tangent, length, end_point, joint, data, k)
