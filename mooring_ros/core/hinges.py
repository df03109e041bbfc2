"""What bends: a hinge at every node between two segments of a line, clamps at its ends, and joints between the ends of several lines.

A hinge of stiffness K whose segments turn by theta against each other has the moment M = 2 K s r(s^2), s = sin(theta / 2): r = 1 is the measure
of Hall, Srinivas and Yu (2020); with three terms M = K theta, to 0.2 % up to 90 degrees and 1 % up to 120.

The bending energy of a line is the integral of M^2 / 2 EI along it. Hinges of stiffness EI/l with 2 EI/l at a clamp, as in the paper, are its
trapezoidal rule, and M^2 has a slope at a clamp: the deflection of a tip load is 1 / 2N^2 too large. The flexibilities (3/8, 7/6, 23/24) l/EI at a
clamp and the next two nodes are that rule with Gregory's end correction of third order: right for every moment that is linear along the
line, and Simpson's rules where a line of two or three segments is clamped on both sides. At pinned and free ends M^2 has no slope.
At joints, where the stiffness or the fineness may change, each section has the same correction at its end.
"""

from typing import NamedTuple

import numpy as np

from ..scene.description import ANGLE
from .packed import packed

GREGORY = (-1.0 / 8.0, 1.0 / 6.0, -1.0 / 24.0)  # correction of the trapezoidal rule's weights from an end inwards
ONE_SEGMENT = 1.0 / 3.0  # weight of a clamp or joint whose line has one segment and is free to turn at its other end: right for a tip load
MEASURES = {True: (1.0 / 6.0, 3.0 / 40.0, 0.08), False: (0.0, 0.0, 0.0)}  # r - 1: of the angle (asin(s) / s), of the paper


@packed
class Bending(NamedTuple):
    """Hinges, clamps and joints. n = all nodes and one more; C clamps; J joints with M members in all. `stiffness` is empty when nothing bends."""

    stiffness: np.ndarray  # (n,) K of the hinge at each node, N m/rad
    reach: np.ndarray  # (n,) unstretched length over which the hinge (or clamp) at each node bends, m: curvature = angle / reach; 0: does not bend
    measure: np.ndarray  # (3,) coefficients of r - 1
    # clamps: a line's end held in a direction, (C,)
    clamp_end: np.ndarray  # index of the line's end
    clamp_point: np.ndarray  # index of the point that it holds on to: no longer clamped when the end has left it
    clamp_segment: np.ndarray  # the line's segment there
    clamp_sign: np.ndarray  # +1.0 where the segment's tangent points into the line (end A), -1.0 at end B
    clamp_stiffness: np.ndarray  # N m/rad
    # joints: ends of lines that keep one direction among them, (J,) and (M,)
    joint_point: np.ndarray  # (J,) index of the point
    joint_first: np.ndarray  # (J + 1,) first member of each, and M
    member_end: np.ndarray  # index of the line's end
    member_segment: np.ndarray
    member_sign: np.ndarray  # as clamp_sign
    member_side: np.ndarray  # +1.0 for lines that leave along the joint's direction, -1.0 against it
    member_stiffness: np.ndarray  # N m/rad


def build_bending(lines, clamps, joints, n, measure=ANGLE):
    """Bending of `lines`, a list of (first_node, segments, segment_length, EI) in the order of the line ends (e = 2 line + side).

    clamps: list of (end, point); joints: list of (point, [(end, +1 or -1 as in member_side), ...]); n: size of the node arrays;
    measure: "angle" (with corrected ends) or "paper".
    """
    corrected = measure == ANGLE
    bent = {end for end, _ in clamps} | {end for _, members in joints for end, _ in members}
    stiffness, reach = np.zeros(n), np.zeros(n)
    for k, (first, count, length, rigidity) in enumerate(lines):
        ends = (2 * k, 2 * k + 1)
        weights = _weights(count, [end in bent for end in ends]) if corrected else _trapezoid(count)
        nodes = slice(first, first + count + 1)
        reach[nodes] = length * weights
        stiffness[nodes] = rigidity / (length * weights)
        for end, end_node in zip(ends, (first, first + count)):
            stiffness[end_node] = 0.0  # of hinges alone: ends bend by their clamp or joint
            if end not in bent:
                reach[end_node] = 0.0
    ends = [end for end, _ in clamps]
    members = [member for _, of_joint in joints for member in of_joint]
    return Bending(
        stiffness=stiffness if any(rigidity > 0.0 for *_, rigidity in lines) else np.zeros(0),
        reach=reach,
        measure=np.array(MEASURES[corrected]),
        clamp_end=_indices(ends),
        clamp_point=_indices([point for _, point in clamps]),
        clamp_segment=_indices([_end_segment(lines, end) for end in ends]),
        clamp_sign=np.array([1.0 - 2.0 * (end % 2) for end in ends]),
        clamp_stiffness=np.array([_end_stiffness(lines, end, reach) for end in ends]),
        joint_point=_indices([point for point, _ in joints]),
        joint_first=_indices(np.cumsum([0] + [len(of_joint) for _, of_joint in joints])),
        member_end=_indices([end for end, _ in members]),
        member_segment=_indices([_end_segment(lines, end) for end, _ in members]),
        member_sign=np.array([1.0 - 2.0 * (end % 2) for end, _ in members]),
        member_side=np.array([float(side) for _, side in members]),
        member_stiffness=np.array([_end_stiffness(lines, end, reach) for end, _ in members]),
    )


def _trapezoid(count):
    """Share of a segment's length that bends at each of a line's nodes, (count + 1,)."""
    weights = np.ones(count + 1)
    weights[[0, -1]] = 0.5
    return weights


def _weights(count, bent):
    """The same with Gregory's correction at the ends that are `bent` (end A, end B): clamped or joined to others."""
    if count == 1:  # bent at both ends no weights suit both of its modes
        return _trapezoid(count) if all(bent) else np.full(2, ONE_SEGMENT)
    weights = _trapezoid(count)
    for k, correction in enumerate(GREGORY):
        weights[k] += correction * bent[0]
        weights[count - k] += correction * bent[1]
    return weights


def _indices(values):
    return np.array(values, dtype=np.int64)


def _end_segment(lines, end):
    first, count, _, _ = lines[end // 2]
    return first + count if end % 2 else first + 1


def _end_stiffness(lines, end, reach):
    first, count, _, rigidity = lines[end // 2]
    return rigidity / reach[first + count if end % 2 else first]


def stiffness_rows(bending, length):
    """(n,) N/m: for each node a bound of the sum over its row of |d force / d position| by bending, of lines that are straight.

    Divided by the node's mass it bounds the square of its highest frequency: 16 EI / (m l^3) inside a uniform line. length (n,): of the segments, m.
    """
    rows = np.zeros(bending.reach.size)
    k = bending.stiffness
    for i in np.flatnonzero(k):
        left, right = 1.0 / length[i], 1.0 / length[i + 1]
        both = left + right
        rows[i - 1] += 2.0 * k[i] * left * both
        rows[i] += 2.0 * k[i] * both * both
        rows[i + 1] += 2.0 * k[i] * right * both
    for segment, stiff in zip(bending.clamp_segment, bending.clamp_stiffness):
        rows[segment - 1 : segment + 1] += 2.0 * stiff / length[segment] ** 2
    for j in range(bending.joint_point.size):
        members = slice(bending.joint_first[j], bending.joint_first[j + 1])
        segments, stiff = bending.member_segment[members], bending.member_stiffness[members]
        turning = stiff / length[segments]
        total = max(stiff.sum(), 1e-300)
        for m, segment in enumerate(segments):
            others = np.delete(turning, m).sum()
            row = 2.0 * turning[m] * ((1.0 - stiff[m] / total) / length[segment] + others / total)
            rows[segment - 1 : segment + 1] += row
    return rows
