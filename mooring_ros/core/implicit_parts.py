"""What is out of balance at the end of an implicit step: forces less inertia times acceleration, of nodes, free points and rigid parts."""

import numpy as np

from .cache import routine, stage
from .layout import POINT_COUPLED, POINT_FREE
from .model import LOOSE
from .platform import dot
from .points import gather, point_acceleration
from .rigid import accelerate_riders, part_equations, rotation_matrix
from .tension import TINY

PINNED_SPIN = 1e-12  # of a part's largest inertia: about an axis that nothing else resists


@stage
def _pin_acceleration(model, state, b):
    pin = model.rigid.pin[b]
    if pin >= 0:
        a = (0.0, 0.0, 0.0)
        if model.point_kind[pin] == POINT_COUPLED:
            a = point_acceleration(model, state, pin)
        for k in range(3):
            state.parts_acceleration[b, k] = a[k]


@stage
def _equations(model, state, scratch, b):
    quaternion = (state.parts[b, 3], state.parts[b, 4], state.parts[b, 5], state.parts[b, 6])
    omega = (state.parts[b, 10], state.parts[b, 11], state.parts[b, 12])
    part_equations(model, state, scratch.load, b, quaternion, rotation_matrix(quaternion), omega, scratch.matrix)


@stage
def _own_residual(state, plan, k, right):
    i, three = plan.own_node[k], plan.own_three[k]
    t0, t1, t2 = state.tangent[0, i] + state.tangent[0, i + 1], state.tangent[1, i] + state.tangent[1, i + 1], state.tangent[2, i] + state.tangent[2, i + 1]
    a0, a1, a2 = state.acceleration[0, i], state.acceleration[1, i], state.acceleration[2, i]
    normal = state.inertia_normal[i]
    surplus = (state.inertia_axial[i] - normal) * (t0 * a0 + t1 * a1 + t2 * a2) / max(t0 * t0 + t1 * t1 + t2 * t2, TINY)
    right[three, 0] = state.force[0, i] - normal * a0 - surplus * t0
    right[three, 1] = state.force[1, i] - normal * a1 - surplus * t1
    right[three, 2] = state.force[2, i] - normal * a2 - surplus * t2


@routine
def out_of_balance(model, state, scratch, plan, right):
    """Fill right (T, 3), N and N m; returns its largest norm over `plan.scale`."""
    for k in range(plan.own_node.size):
        _own_residual(state, plan, k, right)
    if model.free_points.size + model.rigid.mass.size > 0:
        gather(model, state, scratch)
    for f in range(model.free_points.size):
        p, three = model.free_points[f], plan.point_three[f]
        node, load = model.point_node[p], scratch.load
        a = (state.acceleration[0, node], state.acceleration[1, node], state.acceleration[2, node])
        m = (load[p, 3], load[p, 4], load[p, 5], load[p, 6], load[p, 7], load[p, 8])
        right[three, 0] = load[p, 0] - m[0] * a[0] - m[3] * a[1] - m[4] * a[2]
        right[three, 1] = load[p, 1] - m[3] * a[0] - m[1] * a[1] - m[5] * a[2]
        right[three, 2] = load[p, 2] - m[4] * a[0] - m[5] * a[1] - m[2] * a[2]
    for b in range(model.rigid.mass.size):
        _pin_acceleration(model, state, b)
        _equations(model, state, scratch, b)
        place, turn, pinned = plan.part_three[b], plan.turn_three[b], model.rigid.pin[b] >= 0
        for k in range(3):
            straight, turning = scratch.matrix[k, 6], scratch.matrix[3 + k, 6]
            for j in range(6):
                straight -= scratch.matrix[k, j] * state.parts_acceleration[b, j]
                turning -= scratch.matrix[3 + k, j] * state.parts_acceleration[b, j]
            right[place, k] = 0.0 if pinned else straight
            right[turn, k] = turning
            if pinned:
                state.parts_reaction[b, k] = straight
    largest, total = 0.0, 0.0
    for three in range(plan.scale.size):
        r = (right[three, 0], right[three, 1], right[three, 2])
        square = dot(r, r) / plan.scale[three] ** 2
        total += square
        largest = max(largest, square)
    return np.sqrt(largest) if total < np.inf else np.inf


@routine
def mass_blocks(model, state, scratch, plan, c_m, values):
    """Inertia of free points and rigid parts, from what `out_of_balance` has gathered."""
    for f in range(model.free_points.size):
        p, node = model.free_points[f], model.point_node[model.free_points[f]]
        place, m = plan.node_block[node], scratch.load[p]
        idle = 1.0 if m[3] + m[4] + m[5] == 0.0 else 0.0  # one that holds nothing stays where it is
        values[place, 0] += c_m * m[3] + idle
        values[place, 1] += c_m * m[6]
        values[place, 2] += c_m * m[7]
        values[place, 3] += c_m * m[6]
        values[place, 4] += c_m * m[4] + idle
        values[place, 5] += c_m * m[8]
        values[place, 6] += c_m * m[7]
        values[place, 7] += c_m * m[8]
        values[place, 8] += c_m * m[5] + idle
    for b in range(model.rigid.mass.size):
        _equations(model, state, scratch, b)
        matrix, pinned, largest = scratch.matrix, model.rigid.pin[b] >= 0, 0.0
        for k in range(3):
            largest = max(largest, abs(matrix[3 + k, 3 + k]))
        for corner in range(4):
            row, col, place = 3 * (corner // 2), 3 * (corner % 2), plan.part_block[b, corner]
            for i in range(3):
                for j in range(3):
                    trace = PINNED_SPIN * largest if corner == 3 and i == j else 0.0
                    if pinned and corner < 3:
                        values[place, 3 * i + j] = 1.0 if corner == 0 and i == j else 0.0
                    else:
                        values[place, 3 * i + j] += c_m * (matrix[row + i, col + j] + trace)


@routine
def share_accelerations(model, state):
    """Give the nodes of what rides on parts, and the ends that free points hold, their acceleration."""
    acceleration = state.acceleration
    for e in range(model.end_node.size):
        p = state.end_point[e]
        if p != LOOSE and model.point_kind[p] == POINT_FREE:
            for k in range(3):
                acceleration[k, model.end_node[e]] = acceleration[k, model.point_node[p]]
    if model.rigid.mass.size > 0:
        accelerate_riders(model, state)
