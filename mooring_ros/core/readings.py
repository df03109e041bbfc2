"""What a mooring shows to the outside: tensions, end forces and the wrench on the platform."""

from typing import NamedTuple

import numpy as np

from .cache import kernel, stage
from .hulls import coupled_hull_load
from .layout import POINT_COUPLED
from .model import LOOSE
from .packed import entry, packed
from .platform import cross, dot, rotate
from .points import point_acceleration
from .tension import TINY


@packed
class Readings(NamedTuple):
    """Rows of readings, one a sample; k rows, world frame."""

    wrench: np.ndarray  # (k, M, 6) on each platform about its reference point, N and N m
    tension: np.ndarray  # (k, lines, 2) of the segments at the anchor and at the fairlead, N
    end_force: np.ndarray  # (k, lines, 2, 3) of the line on what holds its anchor end and its fairlead end, N
    length: np.ndarray  # (k, lines) stretched, m
    length_rate: np.ndarray  # (k, lines), m/s
    coupled: np.ndarray  # (k, outputs, 6) on the platform at each coupled point, rod and body, N and N m
    uneven: np.ndarray  # (k,) parts of the interval in which tensions jump from step to step, however fine the steps


def new_readings(model, rows):
    lines, outputs = model.first_node.size, model.output_point.size
    return Readings(
        np.zeros((rows, model.reach.size, 6)),
        np.zeros((rows, lines, 2)),
        np.zeros((rows, lines, 2, 3)),
        np.zeros((rows, lines)),
        np.zeros((rows, lines)),
        np.zeros((rows, outputs, 6)),
        np.zeros(rows),
    )


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
def _add_to_output(model, state, row, readings, p, node, force):
    """Add a force (3,) at `node` to what its point p hands to the platform."""
    o = model.output_of[p]
    at = model.point_node[model.output_point[o]]
    x = state.position
    moment = cross((x[0, node] - x[0, at], x[1, node] - x[1, at], x[2, node] - x[2, at]), force)
    for k in range(3):
        readings.coupled[row, o, k] += force[k]
        readings.coupled[row, o, 3 + k] += moment[k]


@stage
def _show_line(model, state, row, readings, line):
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
            force = _reaction(model, state, node, point_acceleration(model, state, p))
        for k in range(3):
            readings.end_force[row, line, side, k] = force[k]
        if p != LOOSE and model.point_kind[p] == POINT_COUPLED:
            _add_to_output(model, state, row, readings, p, node, force)


@stage
def _wet_share(model, state, o):
    """Wet share of what an output's lumps stand for."""
    wet, counted = 0.0, 0.0
    for i in range(model.coupled_points.size):
        p = model.coupled_points[i]
        node = model.point_node[p]
        if model.output_of[p] == o and node < model.size:
            share = model.share_left[node] + model.share_right[node]
            wet, counted = wet + share * state.wet[node], counted + share
    return wet / max(counted, 1.0)


@stage
def _slow_turning(model, o, wet, spin):
    """(inertia - wet surplus) spin of output o, platform's axes."""
    j, s = model.output_inertia[o], model.output_surplus[o]
    x = dot(j[0], spin) - wet * dot(s[0], spin)
    y = dot(j[1], spin) - wet * dot(s[1], spin)
    z = dot(j[2], spin) - wet * dot(s[2], spin)
    return x, y, z


@stage
def _show_bodies(model, state, row, readings):
    """What the turning of coupled bodies takes, and what clamps and pinned parts hand to the platform."""
    pose, twist, a = state.pose, state.twist, state.acceleration_of_platform
    for o in range(model.output_point.size):
        m = model.point_platform[model.output_point[o]]
        q = (pose[m, 3], pose[m, 4], pose[m, 5], pose[m, 6])
        back = (-q[0], -q[1], -q[2], q[3])
        omega, alpha = (twist[m, 3], twist[m, 4], twist[m, 5]), (a[m, 3], a[m, 4], a[m, 5])
        wet = _wet_share(model, state, o)
        spun, slow = rotate(back, alpha), rotate(back, omega)
        turning = rotate(q, _slow_turning(model, o, wet, spun))
        gyro = cross(omega, rotate(q, _slow_turning(model, o, wet, slow)))
        for k in range(3):
            readings.coupled[row, o, 3 + k] -= turning[k] + gyro[k]
    for h in range(model.hulls.point.size):
        o = model.hulls.output[h]
        if o >= 0:
            p = model.hulls.point[h]
            force, moment = coupled_hull_load(model, state, h, point_acceleration(model, state, p))
            _add_to_output(model, state, row, readings, p, model.point_node[p], force)
            for k in range(3):
                readings.coupled[row, o, 3 + k] += moment[k]
    for c in range(model.clamps.part.size):
        if model.clamps.platform[c] >= 0:
            o = model.output_of[model.bending.clamp_point[c]]
            for k in range(3):
                readings.coupled[row, o, 3 + k] += state.clamp_moment[c, k]
    for b in range(model.rigid.mass.size):
        p = model.rigid.pin[b]
        if p >= 0 and model.point_kind[p] == POINT_COUPLED:
            r = state.parts_reaction[b]
            _add_to_output(model, state, row, readings, p, model.point_node[p], (r[0], r[1], r[2]))


@kernel
def show(model, state, row, readings):
    """Fill one row of `readings` from the last evaluation."""
    coupled = readings.coupled
    for o in range(model.output_point.size):
        for k in range(6):
            coupled[row, o, k] = 0.0
    for c in range(model.coupled_points.size):
        p = model.coupled_points[c]
        node = model.point_node[p]
        _add_to_output(model, state, row, readings, p, node, _reaction(model, state, node, point_acceleration(model, state, p)))
    for line in range(model.first_node.size):
        _show_line(model, state, row, readings, line)
    _show_bodies(model, state, row, readings)
    w = readings.wrench
    for m in range(w.shape[1]):
        for k in range(6):
            w[row, m, k] = 0.0
    for o in range(model.output_point.size):
        p = model.output_point[o]
        node, m = model.point_node[p], model.point_platform[p]
        f = (coupled[row, o, 0], coupled[row, o, 1], coupled[row, o, 2])
        arm = (
            state.position[0, node] - state.pose[m, 0],
            state.position[1, node] - state.pose[m, 1],
            state.position[2, node] - state.pose[m, 2],
        )
        moment = cross(arm, f)
        for k in range(3):
            w[row, m, k] += f[k]
            w[row, m, 3 + k] = w[row, m, 3 + k] + moment[k] + coupled[row, o, 3 + k]


observe = entry(show)
