"""Lines with bending stiffness laid out as the core does, for the tests of the bending stages."""

import numpy as np

from mooring_ros.core.bending import bend
from mooring_ros.core.bending_readings import bending_energy, curvature
from mooring_ros.core.bending_tangent import bending_blocks, bending_pattern
from mooring_ros.core.hinges import build_bending


class BentLines:
    """Several lines of (segments, length, EI) in one structure of arrays, with clamps (end, axis) and joints [(end, side), ...]."""

    def __init__(self, lines, clamps=(), joints=(), measure="angle"):
        self.first, start = [], 0
        for count, _, _ in lines:
            self.first.append(start)
            start += count + 1
        self.size = start
        n = start + 2
        self.length, self.live = np.ones(n), np.zeros(n, dtype=bool)
        for first, (count, length, _) in zip(self.first, lines):
            self.length[first + 1 : first + count + 1] = length / count
            self.live[first + 1 : first + count + 1] = True
        self.axes = np.array([axis for _, axis in clamps], dtype=float).reshape(-1, 3)
        holders = [(end, point) for point, (end, _) in enumerate(clamps)]
        at_joints = [(len(clamps) + j, list(members)) for j, members in enumerate(joints)]
        described = [(first, count, length / count, rigidity) for first, (count, length, rigidity) in zip(self.first, lines)]
        self.bending = build_bending(described, holders, at_joints, n, measure)
        self.end_point = np.full(2 * len(lines), 99)
        for end, point in holders:
            self.end_point[end] = point
        for point, members in at_joints:
            self.end_point[[end for end, _ in members]] = point
        self.pattern = bending_pattern(self.bending)
        self.position = np.zeros((3, n))
        self.work = np.full((5, n), 7.0)
        self.work[:3] = 0.0

    def tangent(self, position):
        span = np.diff(position, axis=1, prepend=0.0)
        span[:, ~self.live] = 0.0
        return span / np.maximum(np.linalg.norm(span, axis=0), 1e-200)

    def forces(self, position, axes=None):
        """(force (3, n), moment (C, 3))"""
        force, moment = np.zeros_like(position), np.full(self.axes.shape, 7.0)
        axes = self.axes if axes is None else axes
        bend(self.bending, self.size, position, self.tangent(position), self.length, self.end_point, axes, self.work, force, moment)
        return force, moment

    def energy(self, position, axes=None):
        return bending_energy(self.bending, self.size, self.tangent(position), self.end_point, self.axes if axes is None else axes)

    def curvature(self, position):
        out = np.full(position.shape[1], 7.0)
        curvature(self.bending, self.size, self.tangent(position), self.end_point, self.axes, out)
        return out[: self.size]

    def blocks(self, position):
        clamps = len(self.axes)
        data = np.full((self.pattern.rows.size, 3, 3), 7.0)
        turn, axis = np.full((clamps, 2, 3, 3), 7.0), np.full((clamps, 3, 3), 7.0)
        bending_blocks(self.bending, self.pattern, position, self.tangent(position), self.length, self.end_point, self.axes, data, turn, axis)
        return data, turn, axis

    def hessian(self, position):
        """(3 size, 3 size), rows node by node."""
        data, _, _ = self.blocks(position)
        whole = np.zeros((self.size, 3, self.size, 3))
        for row, col, block in zip(self.pattern.rows, self.pattern.cols, data):
            whole[row, :, col, :] += block
        return whole.reshape(3 * self.size, 3 * self.size)


def turned(axis, turn):
    """`axis` (3,) after the rotation vector `turn` (3,), rad."""
    angle = np.linalg.norm(turn)
    if angle == 0.0:
        return np.array(axis)
    e = turn / angle
    return axis * np.cos(angle) + np.cross(e, axis) * np.sin(angle) + e * (e @ axis) * (1.0 - np.cos(angle))


def three_bent_lines(seed, measure="angle", spread=0.25):
    """Two clamped sections of different stiffness and fineness joined by a massless joint, and a third line clamped at both ends, bent at random."""
    rng = np.random.default_rng(seed)
    axes = rng.normal(0.0, 1.0, (4, 3)) * 0.2 + [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    clamps = [(0, axes[0]), (3, axes[1]), (4, axes[2]), (5, axes[3])]
    lines = BentLines([(5, 6.0, 300.0), (7, 4.0, 80.0), (4, 5.0, 200.0)], clamps, [[(1, -1.0), (2, 1.0)]], measure)
    reach = 0.0
    for first, count, length in ((0, 5, 6.0), (6, 7, 4.0), (14, 4, 5.0)):
        lines.position[0, first : first + count + 1] = reach + np.linspace(0.0, 1.05 * length, count + 1)
        reach += 1.05 * length
    lines.position[:, : lines.size] += rng.normal(0.0, spread, (3, lines.size))
    lines.position[:, 6] = lines.position[:, 5]
    return lines
