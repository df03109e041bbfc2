"""Curvature and energy of what bends (see hinges.py)."""

import numpy as np

from .bending import OPEN, half_sine_squared, into_line, joint_direction
from .cache import kernel, stage


@stage
def _angle(bending, s2):
    """The measure's angle 2 s r(s^2), rad."""
    a, b, c = bending.measure[0], bending.measure[1], bending.measure[2]
    return 2.0 * np.sqrt(s2) * (1.0 + s2 * (a + s2 * (b + s2 * c)))


@stage
def _energy(bending, s2):
    """Energy of a hinge of stiffness 1: the integral of moment over angle, 2 x that of r(u) / sqrt(max(1 - u, OPEN)) from 0 to s2."""
    a, b, c = bending.measure[0], bending.measure[1], bending.measure[2]
    bent = min(s2, 1.0 - OPEN)
    span = bent / (1.0 + np.sqrt(1.0 - bent))  # 1 - cos(theta / 2)
    total = 0.0
    for place, weight in (
        (0.06943184420297371, 0.17392742256872692),
        (0.33000947820757187, 0.32607257743127307),
        (0.66999052179242813, 0.32607257743127307),
        (0.93056815579702629, 0.17392742256872692),
    ):  # Gauss: right for this polynomial
        u = span * place * (2.0 - span * place)
        total += 4.0 * span * weight * (1.0 + u * (a + u * (b + u * c)))
    folded = s2 * (1.0 + s2 * (a / 2.0 + s2 * (b / 3.0 + s2 * c / 4.0))) - bent * (1.0 + bent * (a / 2.0 + bent * (b / 3.0 + bent * c / 4.0)))
    return total + 2.0 / np.sqrt(OPEN) * folded


@kernel
def curvature(bending, size, tangent, end_point, clamp_axis, out):
    """Fill out (n,), 1/m, with the curvature at every node, clamped and joined ends included; zero where a line's end is free to turn."""
    for i in range(size):
        left, right = (tangent[0, i], tangent[1, i], tangent[2, i]), (tangent[0, i + 1], tangent[1, i + 1], tangent[2, i + 1])
        out[i] = 0.0
        if bending.reach[i] > 0.0:
            out[i] = _angle(bending, half_sine_squared(left, right)) / bending.reach[i]
    for k in range(bending.clamp_end.size):
        segment, sign = bending.clamp_segment[k], bending.clamp_sign[k]
        node = segment - 1 if sign > 0.0 else segment
        out[node] = 0.0
        if end_point[bending.clamp_end[k]] == bending.clamp_point[k]:
            axis = (clamp_axis[k, 0], clamp_axis[k, 1], clamp_axis[k, 2])
            out[node] = _angle(bending, half_sine_squared(axis, into_line(tangent, segment, sign))) / bending.reach[node]
    for j in range(bending.joint_point.size):
        total, norm, _ = joint_direction(bending, tangent, end_point, j)
        shrink = 1.0 / max(norm, 1e-300)
        d = (shrink * total[0], shrink * total[1], shrink * total[2])
        for m in range(bending.joint_first[j], bending.joint_first[j + 1]):
            segment, sign = bending.member_segment[m], bending.member_sign[m]
            node = segment - 1 if sign > 0.0 else segment
            out[node] = 0.0
            if end_point[bending.member_end[m]] == bending.joint_point[j] and norm > 0.0:
                t = into_line(tangent, segment, sign * bending.member_side[m])
                out[node] = _angle(bending, half_sine_squared(d, t)) / bending.reach[node]


@kernel
def bending_energy(bending, size, tangent, end_point, clamp_axis):
    """Energy of all hinges, clamps and joints, J."""
    total = 0.0
    if bending.stiffness.size == 0:
        return total
    for i in range(size):
        if bending.stiffness[i] > 0.0:
            left, right = (tangent[0, i], tangent[1, i], tangent[2, i]), (tangent[0, i + 1], tangent[1, i + 1], tangent[2, i + 1])
            total += bending.stiffness[i] * _energy(bending, half_sine_squared(left, right))
    for k in range(bending.clamp_end.size):
        if end_point[bending.clamp_end[k]] == bending.clamp_point[k]:
            axis = (clamp_axis[k, 0], clamp_axis[k, 1], clamp_axis[k, 2])
            t = into_line(tangent, bending.clamp_segment[k], bending.clamp_sign[k])
            total += bending.clamp_stiffness[k] * _energy(bending, half_sine_squared(axis, t))
    for j in range(bending.joint_point.size):
        _, norm, stiff = joint_direction(bending, tangent, end_point, j)
        total += stiff - norm
    return total
