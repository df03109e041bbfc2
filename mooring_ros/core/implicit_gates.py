"""Laws that jump, made whole for the iterations of a step.

Dampers act on taut segments and in the bed only: where a segment becomes taut, or a node comes down, its force jumps from nothing to the
damper's. No step ends in the middle of a jump, so Newton's method would go back and forth. But a segment or node that has been across in an
iteration will be stopped within this step: from then on its law holds on both sides, spring and damper together never pushing a line or
pulling at the bed. So it is caught by the damper, at most rate * (damping / stiffness) before it arrives.
"""

import numpy as np

from .cache import routine, stage
from .friction import SATURATED, saturated_part
from .ground import along_bed, in_plane


@routine
def catch_segments(model, state, pulled):
    """Add the pull (N) of segments that have been taut and are slack by the plain law; pulled (n,): which have."""
    x, q = state.position, state.tangent
    for s in range(1, model.size + 1):
        if state.tension[s] > 0.0:
            pulled[s] = 1.0
        elif model.stiffness[s] > 0.0:
            i = s - 1
            length = q[0, s] * (x[0, s] - x[0, i]) + q[1, s] * (x[1, s] - x[1, i]) + q[2, s] * (x[2, s] - x[2, i])
            strain = length * model.inverse_length[s] - 1.0
            if strain > 0.0:
                pulled[s] = 1.0
            elif pulled[s] != 0.0:
                pull = max(model.stiffness[s] * strain + model.damping[s] * state.strain_rate[s], 0.0)
                state.tension[s] = pull
                for k in range(3):
                    state.force[k, i] += pull * q[k, s]
                    state.force[k, s] -= pull * q[k, s]


@routine
def catch_nodes(model, state, bed, touched):
    """Add the push (N) of the bed, level and normal (4, n) or flat, on nodes that have been in it and are above; touched (n,): which have."""
    for i in range(model.size):
        n = (bed[1, i], bed[2, i], bed[3, i]) if model.ground.on else (0.0, 0.0, 1.0)
        depth = ((bed[0, i] if model.ground.on else model.bed_level) - state.position[2, i]) * n[2]
        if depth > 0.0:
            touched[i] = 1.0
        elif touched[i] != 0.0:
            v = state.velocity
            speed = v[0, i] * n[0] + v[1, i] * n[1] + v[2, i] * n[2]
            push = max(model.bed_stiffness[i] * depth - model.bed_damping[i] * speed, 0.0)
            drag = (0.0, 0.0, 0.0)
            if push > 0.0 and model.ground.law == SATURATED:
                drag = saturated_friction(model.ground, state, i, push, n)
            for k in range(3):
                state.force[k, i] += push * n[k] - drag[k]


@stage
def saturated_friction(ground, state, i, push, n):
    """Housner's friction (N) against the motion of node i that presses on the bed, normal n (3,), with `push` (N): the plain law."""
    t, v = state.tangent, state.velocity
    px, py, pz, square, inverse = along_bed(t[0, i] + t[0, i + 1], t[1, i] + t[1, i + 1], t[2, i] + t[2, i + 1], n[0], n[1], n[2])
    dx, dy, dz = in_plane(v[0, i], v[1, i], v[2, i], n[0], n[1], n[2])
    along = ground.directional * inverse * (dx * px + dy * py + dz * pz)
    dx, dy, dz = dx - along * px, dy - along * py, dz - along * pz
    speed, drift = abs(along) * np.sqrt(square), np.sqrt(dx * dx + dy * dy + dz * dz)
    axial = along * saturated_part(speed, speed, push, ground.static_axial, ground.kinetic_axial, ground.ramp, 0.0)
    side = saturated_part(drift, drift, push, ground.static_across, ground.kinetic_across, ground.ramp, 0.0)
    return axial * px + side * dx, axial * py + side * dy, axial * pz + side * dz


@routine
def forget_landings(model, state, bed, touched, start, h):
    """Take from the accelerations of nodes that have come down in a step of h (s) what has stopped them; start (3, n): places at its start, m.

    It was a blow, over within the step. Carried on by the filtered acceleration it would throw them up again, at 0.8 of the speed they came with.
    """
    for i in range(model.size):
        if touched[i] == 0.0 or state.slaved[i]:
            continue
        n = (bed[1, i], bed[2, i], bed[3, i]) if model.ground.on else (0.0, 0.0, 1.0)
        level = bed[0, i] if model.ground.on else model.bed_level
        if start[2, i] <= level:
            continue
        rate = h * (model.bed_damping[i] + h * model.bed_stiffness[i]) / state.inertia_normal[i]
        gone = rate * rate / (1.0 + rate * rate)
        for accelerations in (state.acceleration, state.filtered):
            along = accelerations[0, i] * n[0] + accelerations[1, i] * n[1] + accelerations[2, i] * n[2]
            for k in range(3):
                accelerations[k, i] -= gone * along * n[k]
