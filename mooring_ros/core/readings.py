"""What a mooring shows to the outside: tensions, end forces and the wrench on the platform."""

from typing import NamedTuple

import numpy as np

from .cache import kernel, stage
from .model import LOOSE, POINT_COUPLED, POINT_FREE
from .platform import cross
from .tension import TINY


class Readings(NamedTuple):
    """Rows of readings, one a sample; k rows, world frame."""

    wrench: np.ndarray  # (k, 6) on the platform about its reference point, N and N m
    tension: np.ndarray  # (k, lines, 2) of the segments at the anchor and at the fairlead, N
    end_force: np.ndarray  # (k, lines, 2, 3) of the line on what holds its anchor end and its fairlead end, N
    length: np.ndarray  # (k, lines) stretched, m
    length_rate: np.ndarray  # (k, lines), m/s
    coupled_force: np.ndarray  # (k, coupled points, 3) on the platform at each, N


def new_readings(model, rows):
    lines, coupled = model.first_node.size, model.coupled_points.size
    return Readings(
        np.zeros((rows, 6)),
        np.zeros((rows, lines, 2)),
        np.zeros((rows, lines, 2, 3)),
        np.zeros((rows, lines)),
        np.zeros((rows, lines)),
        np.zeros((rows, coupled, 3)),
    )


@stage
def _point_acceleration(model, state, p):
    """Acceleration (m/s^2) of the point p: that of the platform's place, of its node, or none."""
    node = model.point_node[p]
    if model.point_kind[p] == POINT_FREE:
        return state.acceleration[0, node], state.acceleration[1, node], state.acceleration[2, node]
    if model.point_kind[p] != POINT_COUPLED:
        return 0.0, 0.0, 0.0
    a = state.acceleration_of_platform
    arm = (
        state.position[0, node] - state.pose[0],
        state.position[1, node] - state.pose[1],
        state.position[2, node] - state.pose[2],
    )
    omega = (state.twist[3], state.twist[4], state.twist[5])
    inward = cross(omega, cross(omega, arm))
    turn = cross((a[3], a[4], a[5]), arm)
    return a[0] + turn[0] + inward[0], a[1] + turn[1] + inward[1], a[2] + turn[2] + inward[2]


@stage
def _reaction(model, state, node, a):
    """Force (N) of a held node on what holds it: all forces on the node less its inertia at acceleration a (m/s^2)."""
    t = state.tangent
    tx, ty, tz = t[0, node] + t[0, node + 1], t[1, node] + t[1, node + 1], t[2, node] + t[2, node + 1]
    normal = model.mass[node] + state.wet[node] * model.added_normal[node]
    axial = model.mass[node] + state.wet[node] * model.added_axial[node]
    along = (axial - normal) * (tx * a[0] + ty * a[1] + tz * a[2]) / max(tx * tx + ty * ty + tz * tz, TINY)
    return (
        state.force[0, node] - normal * a[0] - along * tx,
        state.force[1, node] - normal * a[1] - along * ty,
        state.force[2, node] - normal * a[2] - along * tz,
    )


@stage
def show(model, state, row, readings):
    """Fill one row of `readings` from the last evaluation."""
    for c in range(model.coupled_points.size):
        p = model.coupled_points[c]
        own = _reaction(model, state, model.point_node[p], _point_acceleration(model, state, p))
        for k in range(3):
            readings.coupled_force[row, c, k] = own[k]
    for line in range(model.first_node.size):
        first, count = model.first_node[line], model.segments[line]
        total, rate = 0.0, 0.0
        q, x = state.tangent, state.position
        for i in range(first, first + count):
            for k in range(3):
                total += q[k, i + 1] * (x[k, i + 1] - x[k, i])
            rate += state.strain_rate[i + 1]
        readings.length[row, line] = total
        readings.length_rate[row, line] = rate
        for side in range(2):  # anchor, fairlead
            end = model.fairlead_end[line] if side == 1 else 1 - model.fairlead_end[line]
            node = first + count if end == 1 else first
            readings.tension[row, line, side] = state.tension[first + count if end == 1 else first + 1]
            p = state.end_point[2 * line + end]
            force = (0.0, 0.0, 0.0)
            if p != LOOSE:
                force = _reaction(model, state, node, _point_acceleration(model, state, p))
            for k in range(3):
                readings.end_force[row, line, side, k] = force[k]
            if p != LOOSE and model.point_kind[p] == POINT_COUPLED:
                for c in range(model.coupled_points.size):
                    if model.coupled_points[c] == p:
                        for k in range(3):
                            readings.coupled_force[row, c, k] += force[k]
    wx, wy, wz, mx, my, mz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for c in range(model.coupled_points.size):
        node = model.point_node[model.coupled_points[c]]
        f = (readings.coupled_force[row, c, 0], readings.coupled_force[row, c, 1], readings.coupled_force[row, c, 2])
        arm = (
            state.position[0, node] - state.pose[0],
            state.position[1, node] - state.pose[1],
            state.position[2, node] - state.pose[2],
        )
        moment = cross(arm, f)
        wx, wy, wz = wx + f[0], wy + f[1], wz + f[2]
        mx, my, mz = mx + moment[0], my + moment[1], mz + moment[2]
    w = readings.wrench
    w[row, 0], w[row, 1], w[row, 2], w[row, 3], w[row, 4], w[row, 5] = wx, wy, wz, mx, my, mz


@kernel
def observe(model, state, row, readings):
    """`show`, to be called from Python."""
    show(model, state, row, readings)
