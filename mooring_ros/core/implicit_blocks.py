"""Tangent of the implicit step: stiffness, damping and inertia of every stage in one, S = K + c_v D + c_m M, as 3 x 3 blocks of a Plan.

K = -dF/dx, D = -dF/dv; c_v and c_m are the changes of velocity and acceleration with a place at the step's end. Values are (S, 9), row by row.
"""

import numpy as np

from .bending_tangent import bending_blocks
from .cache import routine, stage
from .hulls import hull_axis
from .platform import dot
from .surface import wet_part
from .implicit_plan import NOWHERE

SHORTEST = 1e-6  # of a tangent's length: nodes without one, or with one that is folded, do not turn
SLOWEST = 1e-12  # m/s


@routine
def clear_blocks(values):
    for k in range(values.shape[0]):
        for j in range(9):
            values[k, j] = 0.0


@routine
def line_blocks(model, state, plan, axial, damper, foreseen, c_v, values):
    """Axial stiffness and internal damping of taut segments; axial (n,) N/m and damper (n,) N s/m: slopes of their tension.

    The tension that turns them is the foreseen one (n,), N: see implicit_tensions.py.
    """
    x, v = state.position, state.velocity
    for s in range(1, model.size + 1):
        tension = foreseen[s]
        if not (tension > 0.0 or state.tension[s] > 0.0):
            continue
        i = s - 1
        q0, q1, q2 = state.tangent[0, s], state.tangent[1, s], state.tangent[2, s]
        length = q0 * (x[0, s] - x[0, i]) + q1 * (x[1, s] - x[1, i]) + q2 * (x[2, s] - x[2, i])
        per_length = 1.0 / max(length, 0.1 * model.length[s])
        turning = tension * per_length
        along = axial[s] + c_v * damper[s] - turning
        u0, u1, u2 = v[0, s] - v[0, i], v[1, s] - v[1, i], v[2, s] - v[2, i]
        rate = q0 * u0 + q1 * u1 + q2 * u2
        swing = damper[s] * per_length  # a rate changes with the direction that it is taken in
        w0, w1, w2 = along * q0 + swing * (u0 - rate * q0), along * q1 + swing * (u1 - rate * q1), along * q2 + swing * (u2 - rate * q2)
        k0, k1, k2 = q0 * w0 + turning, q0 * w1, q0 * w2
        k3, k4, k5 = q1 * w0, q1 * w1 + turning, q1 * w2
        k6, k7, k8 = q2 * w0, q2 * w1, q2 * w2 + turning
        for corner in range(4):
            place = plan.segment_block[s, corner]
            sign = 1.0 if corner < 2 else -1.0
            values[place, 0] += sign * k0
            values[place, 1] += sign * k1
            values[place, 2] += sign * k2
            values[place, 3] += sign * k3
            values[place, 4] += sign * k4
            values[place, 5] += sign * k5
            values[place, 6] += sign * k6
            values[place, 7] += sign * k7
            values[place, 8] += sign * k8


@stage
def _turn_with_segment(state, plan, values, i, s, size, h, per_length):
    """Add how the force on node i goes with the direction of segment s, one of both beside it: h (9,) times (I - q q') / L."""
    q = (state.tangent[0, s], state.tangent[1, s], state.tangent[2, s])
    own, across = plan.node_block[i], plan.segment_block[s, 2 if s > i else 3]
    sign = per_length if s > i else -per_length
    for a in range(3):
        along = h[3 * a] * q[0] + h[3 * a + 1] * q[1] + h[3 * a + 2] * q[2]
        for b in range(3):
            k = sign * (h[3 * a + b] - along * q[b])
            values[own, 3 * a + b] += k
            values[across, 3 * a + b] -= k


@routine
def node_blocks(model, state, plan, touched, c_v, c_m, values):
    """Inertia with its added mass, drag, the flat bed, and what turns with the line's direction in drag and inertia.

    What shares its motion with others gets its inertia from these (implicit_parts.py).
    """
    waves = state.swell.shape[1] > 0
    for i in range(model.size):
        if plan.node_block[i] >= values.shape[0] - 1:
            continue
        t0, t1, t2 = state.tangent[0, i] + state.tangent[0, i + 1], state.tangent[1, i] + state.tangent[1, i + 1], state.tangent[2, i] + state.tangent[2, i + 1]
        size = np.sqrt(t0 * t0 + t1 * t1 + t2 * t2)
        per_size = 1.0 / size if size > SHORTEST else 0.0
        t0, t1, t2 = per_size * t0, per_size * t1, per_size * t2
        r0, r1, r2 = state.stream[0, i] - state.velocity[0, i], state.stream[1, i] - state.velocity[1, i], state.stream[2, i] - state.velocity[2, i]
        along = r0 * t0 + r1 * t1 + r2 * t2
        n0, n1, n2 = r0 - along * t0, r1 - along * t1, r2 - along * t2
        speed = np.sqrt(n0 * n0 + n1 * n1 + n2 * n2)
        per_speed = 1.0 / max(speed, SLOWEST)
        axial = state.wet[i] * model.drag_axial[i] * abs(along)
        normal = state.wet[i] * model.drag_normal[i] * speed
        held = 0.0 if state.slaved[i] else c_m
        mass_normal, mass_axial = state.inertia_normal[i], state.inertia_axial[i]
        isotropic = held * mass_normal + c_v * normal
        lengthwise = held * (mass_axial - mass_normal) + c_v * (2.0 * axial - normal)
        crosswise = c_v * normal
        own = plan.node_block[i]
        m0, m1, m2 = per_speed * n0, per_speed * n1, per_speed * n2
        values[own, 0] += isotropic + lengthwise * t0 * t0 + crosswise * m0 * m0
        values[own, 1] += lengthwise * t0 * t1 + crosswise * m0 * m1
        values[own, 2] += lengthwise * t0 * t2 + crosswise * m0 * m2
        values[own, 3] += lengthwise * t1 * t0 + crosswise * m1 * m0
        values[own, 4] += isotropic + lengthwise * t1 * t1 + crosswise * m1 * m1
        values[own, 5] += lengthwise * t1 * t2 + crosswise * m1 * m2
        values[own, 6] += lengthwise * t2 * t0 + crosswise * m2 * m0
        values[own, 7] += lengthwise * t2 * t1 + crosswise * m2 * m1
        values[own, 8] += isotropic + lengthwise * t2 * t2 + crosswise * m2 * m2
        if not model.ground.on:
            depth = model.bed_level - state.position[2, i]
            if touched[i] != 0.0 and model.bed_stiffness[i] * depth > model.bed_damping[i] * state.velocity[2, i]:
                values[own, 8] += model.bed_stiffness[i] + c_v * model.bed_damping[i]
        if per_size == 0.0:
            continue
        # along the tangent forces are f(t) with f' = H: drag, and the surplus of inertia in the water's acceleration less the node's own
        surplus = 0.0 if state.slaved[i] else mass_axial - mass_normal
        a0, a1, a2 = -surplus * state.acceleration[0, i], -surplus * state.acceleration[1, i], -surplus * state.acceleration[2, i]
        if waves:
            more = state.wet[i] * (model.added_axial[i] - model.added_normal[i])
            a0, a1, a2 = a0 + more * state.swell[0, i], a1 + more * state.swell[1, i], a2 + more * state.swell[2, i]
        pushed = a0 * t0 + a1 * t1 + a2 * t2
        both = 2.0 * axial - normal
        w0, w1, w2 = both * n0 + a0 - pushed * t0, both * n1 + a1 - pushed * t1, both * n2 + a2 - pushed * t2
        even, odd = along * (axial - normal) + pushed, -along * normal
        p0, p1, p2 = even * t0, even * t1, even * t2
        h = (
            per_size * (t0 * w0 + even - t0 * p0 + odd * m0 * m0),
            per_size * (t0 * w1 - t0 * p1 + odd * m0 * m1),
            per_size * (t0 * w2 - t0 * p2 + odd * m0 * m2),
            per_size * (t1 * w0 - t1 * p0 + odd * m1 * m0),
            per_size * (t1 * w1 + even - t1 * p1 + odd * m1 * m1),
            per_size * (t1 * w2 - t1 * p2 + odd * m1 * m2),
            per_size * (t2 * w0 - t2 * p0 + odd * m2 * m0),
            per_size * (t2 * w1 - t2 * p1 + odd * m2 * m1),
            per_size * (t2 * w2 + even - t2 * p2 + odd * m2 * m2),
        )
        for side in range(2):
            s = i + side
            if model.live[s] != 0.0:
                _turn_with_segment(state, plan, values, i, s, size, h, model.inverse_length[s])


@stage
def _shares_of_ends(left, right, radius):
    """Wet shares of the left and the right half of a segment whose ends are at these depths (m)."""
    mean, surplus = wet_part(max(left, right), min(left, right), radius)
    return (mean - surplus, mean + surplus) if right > left else (mean + surplus, mean - surplus)


@routine
def surface_blocks(model, state, plan, values):
    """Loss of buoyancy as the ends of a segment, or a point, rise through the surface; differences of the wet shares."""
    waves = state.swell.shape[1] > 0
    for s in range(1, model.size + 1):
        i = s - 1
        if model.live[s] == 0.0:
            continue
        deep_left, deep_right = -state.position[2, i], -state.position[2, s]
        if waves:
            deep_left, deep_right = deep_left + state.swell[3, i], deep_right + state.swell[3, s]
        extent = model.diameter[s] * np.sqrt(max(1.0 - state.tangent[2, s] ** 2, 0.0))
        radius, span = 0.5 * extent, abs(deep_left - deep_right)
        if not (max(deep_left, deep_right) > -radius and min(deep_left, deep_right) < radius):
            continue
        small = 1e-6 * (span + extent)
        for column in range(2):
            left, right = deep_left, deep_right
            by = small if column == 0 else 0.0
            more_left, more_right = _shares_of_ends(left - by, right - (small - by), radius)
            less_left, less_right = _shares_of_ends(left + by, right + (small - by), radius)
            at_left = model.buoyancy[i] * model.share_right[i] * (less_left - more_left) / (2.0 * small)
            at_right = model.buoyancy[s] * model.share_left[s] * (less_right - more_right) / (2.0 * small)
            values[plan.segment_block[s, 0 if column == 0 else 2], 8] += at_left
            values[plan.segment_block[s, 3 if column == 0 else 1], 8] += at_right
    for p in range(model.point_node.size):
        node, diameter = model.point_node[p], model.point_diameter[p]
        if diameter > 0.0:
            height = state.position[2, node]
            if waves and node < model.size:
                height -= state.swell[3, node]
            under = min(max(0.5 - height / diameter, 0.0), 1.0)
            values[plan.node_block[node], 8] += model.buoyancy[node] * 6.0 * under * (1.0 - under) / diameter


@stage
def _add(values, place, block, sign):
    for a in range(3):
        for b in range(3):
            values[place, 3 * a + b] += sign * block[a, b]


@routine
def bent_blocks(model, state, plan, bent, turn, axis, values):
    """Bending: hinges, clamps and joints; bent (b, 3, 3), turn (C, 2, 3, 3), axis (C, 3, 3): work of `bending_blocks`."""
    bending_blocks(model.bending, plan, state.position, state.tangent, model.length, state.end_point, state.clamp_axis, bent, turn, axis)
    for k in range(bent.shape[0]):
        _add(values, plan.bent_block[k], bent[k], 1.0)
    for c in range(plan.clamp_block.shape[0]):
        b = model.clamps.part[c]
        if b < 0:
            continue
        for a in range(3):
            for e in range(3):
                for end in range(2):
                    values[plan.clamp_block[c, end], 3 * a + e] += turn[c, end, a, e]
                    values[plan.clamp_block[c, 2 + end], 3 * a + e] += turn[c, end, e, a]
                values[plan.part_block[b, 3], 3 * a + e] += axis[c, a, e]
        m = state.clamp_moment[c]
        own = plan.part_block[b, 3]  # turns do not commute: a moment's change is no second derivative
        values[own, 1] -= 0.5 * m[2]
        values[own, 2] += 0.5 * m[1]
        values[own, 3] += 0.5 * m[2]
        values[own, 5] -= 0.5 * m[0]
        values[own, 6] -= 0.5 * m[1]
        values[own, 7] += 0.5 * m[0]


@routine
def turn_blocks(model, state, plan, c_v, values):
    """Turning of the arms under load, d(r x F) = (d theta x r) x F, and drag on the hulls of free bodies."""
    for r in range(plan.rider.size):
        node, b = plan.rider[r], plan.rider_part[r]
        f = (state.force[0, node], state.force[1, node], state.force[2, node])
        x = _arm(state, node, b)
        reach = dot(f, x)
        for a in range(3):
            for e in range(3):
                values[plan.part_block[b, 3], 3 * a + e] -= x[a] * f[e] - (reach if a == e else 0.0)  # -[F][r] = (F.r) I - r F'
    for h in range(model.hulls.point.size):
        b = model.hulls.part[h]
        if b < 0:
            continue
        node = model.point_node[model.hulls.point[h]]
        quaternion = (state.parts[b, 3], state.parts[b, 4], state.parts[b, 5], state.parts[b, 6])
        for k in range(3):
            e = hull_axis(model.hulls, h, quaternion, k)
            speed = 0.0
            for j in range(3):
                speed += e[j] * (state.stream[j, node] - state.velocity[j, node])
            spin = dot(e, (state.parts[b, 10], state.parts[b, 11], state.parts[b, 12]))
            push = 2.0 * c_v * state.wet[node] * model.hulls.drag[h, k] * abs(speed)
            twist = 2.0 * c_v * state.wet[node] * model.hulls.drag[h, 3 + k] * abs(spin)
            for a in range(3):
                for g in range(3):
                    values[plan.node_block[node], 3 * a + g] += push * e[a] * e[g]
                    values[plan.part_block[b, 3], 3 * a + g] += twist * e[a] * e[g]


@stage
def _arm(state, node, b):
    return state.position[0, node] - state.parts[b, 0], state.position[1, node] - state.parts[b, 1], state.position[2, node] - state.parts[b, 2]


@stage
def _crossed(v, block):
    """[v] times the block (9,), a tuple of rows one after another."""
    return (
        v[1] * block[6] - v[2] * block[3],
        v[1] * block[7] - v[2] * block[4],
        v[1] * block[8] - v[2] * block[5],
        v[2] * block[0] - v[0] * block[6],
        v[2] * block[1] - v[0] * block[7],
        v[2] * block[2] - v[0] * block[8],
        v[0] * block[3] - v[1] * block[0],
        v[0] * block[4] - v[1] * block[1],
        v[0] * block[5] - v[1] * block[2],
    )


@stage
def _transposed(block):
    return block[0], block[3], block[6], block[1], block[4], block[7], block[2], block[5], block[8]


@stage
def _uncrossed(block, v):
    """The block (9,) times -[v]: of a turn at the arm v."""
    return _transposed(_crossed(v, _transposed(block)))


@routine
def hand_on(state, plan, values):
    """Give what riding nodes have gathered to their parts' places and turns."""
    for k in range(plan.source.size):
        s = plan.source[k]
        block = (
            values[s, 0], values[s, 1], values[s, 2], values[s, 3], values[s, 4], values[s, 5], values[s, 6], values[s, 7], values[s, 8]
        )  # fmt: skip
        left, right = plan.left[k], plan.right[k]
        if left != NOWHERE:
            block = _crossed(_arm(state, plan.rider[left], plan.rider_part[left]), block)
        if right != NOWHERE:
            block = _uncrossed(block, _arm(state, plan.rider[right], plan.rider_part[right]))
        target = plan.target[k]
        for j in range(9):
            values[target, j] += block[j]
