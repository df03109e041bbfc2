"""Tangent of the bed's forces where it has a shape or friction: contact along its normal, and both laws of friction in its plane.

Of the forces that `contact` (ground.py) gives for a step of zero. The normal's own turning is left out: it stands to the contact's stiffness
as the depth of the contact to the bed's radius of curvature.
"""

import numpy as np

from .cache import routine, stage
from .friction import LEAST, NO_FRICTION, SATURATED, SMOOTHEST
from .ground import along_bed, in_plane


@stage
def _add_outer(values, place, factor, left, right):
    for a in range(3):
        for b in range(3):
            values[place, 3 * a + b] += factor * left[a] * right[b]


@stage
def _add_plane(values, place, factor, n):
    for a in range(3):
        for b in range(3):
            values[place, 3 * a + b] += factor * ((1.0 if a == b else 0.0) - n[a] * n[b])


@stage
def _saturated_blocks(ground, place, push, pressing, v, e, n, c_v, values):
    """Housner's law of one node: velocity v in the plane, unit vector e of the line along the bed, or null."""
    along = v[0] * e[0] + v[1] * e[1] + v[2] * e[2]
    across = (v[0] - along * e[0], v[1] - along * e[1], v[2] - along * e[2])
    speed = np.sqrt(across[0] ** 2 + across[1] ** 2 + across[2] ** 2)
    if ground.ramp * abs(along) > push:
        _add_outer(values, place, -ground.kinetic_axial * pressing * (1.0 if along > 0.0 else -1.0), e, n)
    else:
        _add_outer(values, place, c_v * ground.static_axial * ground.ramp, e, e)
    resist = c_v * ground.static_across * ground.ramp
    if ground.ramp * speed > push:
        resist = c_v * ground.kinetic_across * push / speed
        d = (across[0] / speed, across[1] / speed, across[2] / speed)
        _add_outer(values, place, -resist, d, d)
        _add_outer(values, place, -ground.kinetic_across * pressing, d, n)
    _add_plane(values, place, resist, n)
    _add_outer(values, place, -resist, e, e)


@stage
def _sticking_blocks(ground, place, push, pressing, f, give, sliding, e, n, values):
    """The return mapping of one node: trial force f in the plane and its slope `give` (N/m)."""
    mu_axial = max(ground.kinetic_axial if sliding else ground.static_axial, SMOOTHEST)
    mu_across = max(ground.kinetic_across if sliding else ground.static_across, SMOOTHEST)
    along = f[0] * e[0] + f[1] * e[1] + f[2] * e[2]
    ga, gt = 1.0 / (mu_axial * push) ** 2, 1.0 / (mu_across * push) ** 2
    t = (f[0] - along * e[0], f[1] - along * e[1], f[2] - along * e[2])
    load = np.sqrt(ga * along * along + gt * (t[0] * t[0] + t[1] * t[1] + t[2] * t[2]))
    if not load > 1.0:
        _add_plane(values, place, give, n)
        return
    share = 1.0 / load
    slope = (ga * along * e[0] + gt * t[0], ga * along * e[1] + gt * t[1], ga * along * e[2] + gt * t[2])
    _add_plane(values, place, share * give, n)
    _add_outer(values, place, -share * share * share * give, f, slope)
    _add_outer(values, place, -share / push * pressing, f, n)


@routine
def ground_step_blocks(model, state, plan, bed, touched, c_v, values):
    """Add the blocks of all nodes that press on the bed; bed (4, n): its level under them (m) and its unit normal."""
    ground, velocity, position = model.ground, state.velocity, state.position
    for i in range(model.size):
        if touched[i] == 0.0:
            continue
        n = (bed[1, i], bed[2, i], bed[3, i])
        depth = (bed[0, i] - position[2, i]) * n[2]
        speed = velocity[0, i] * n[0] + velocity[1, i] * n[1] + velocity[2, i] * n[2]
        push = model.bed_stiffness[i] * depth - model.bed_damping[i] * speed
        if not push > 0.0:
            continue
        place, pressing = plan.node_block[i], model.bed_stiffness[i] + c_v * model.bed_damping[i]
        _add_outer(values, place, pressing, n, n)
        if ground.law == NO_FRICTION or ground.law != SATURATED and not depth > 0.0:
            continue
        t = (state.tangent[0, i] + state.tangent[0, i + 1], state.tangent[1, i] + state.tangent[1, i + 1], state.tangent[2, i] + state.tangent[2, i + 1])
        px, py, pz, _, inverse = along_bed(t[0], t[1], t[2], n[0], n[1], n[2])
        scale = np.sqrt(inverse) * (ground.directional if ground.law == SATURATED else 1.0)
        e = (scale * px, scale * py, scale * pz)
        v = in_plane(velocity[0, i], velocity[1, i], velocity[2, i], n[0], n[1], n[2])
        if ground.law == SATURATED:
            _saturated_blocks(ground, place, push, pressing, v, e, n, c_v, values)
        else:
            spring, damper = ground.stiffness_ratio * model.bed_stiffness[i], ground.damping_ratio * model.bed_damping[i]
            held = spring if state.grip[3, i] >= 0.0 else 0.0
            r = in_plane(position[0, i] - state.grip[0, i], position[1, i] - state.grip[1, i], position[2, i] - state.grip[2, i], n[0], n[1], n[2])
            f = (held * r[0] + damper * v[0], held * r[1] + damper * v[1], held * r[2] + damper * v[2])
            _sticking_blocks(ground, place, max(push, LEAST), pressing, f, held + c_v * damper, state.grip[3, i] > 0.0, e, n, values)
