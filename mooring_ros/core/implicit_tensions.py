"""Tensions as unknowns of their own in the iterations of a step: a small move of a stiff line makes a large force, a Newton step knows better.

As in the statics (tangent.py): eliminated from the linear equations, they leave these as they are but for the tension that turns segments,
which is the one that the last Newton step foresaw; and progress is measured with them, by forces out of balance and by strains missed.
"""

import numpy as np

from .cache import routine, stage
from .platform import cross, dot

STRAIN_SCALE = 10.0  # a strain of 10 % counts like a force of the line's weight


@stage
def _add_at(state, plan, node, force, sign, right):
    """Add a force (3,) on a node to the threes that it follows."""
    three = plan.node_three[node]
    if three >= 0:
        for k in range(3):
            right[three, k] += sign * force[k]
    elif plan.rider_of[node] >= 0:
        b = plan.rider_part[plan.rider_of[node]]
        moment = cross(_arm(state, node, b), force)
        for k in range(3):
            right[plan.turn_three[b], k] += sign * moment[k]
            if plan.part_moves[b] != 0:
                right[plan.part_three[b], k] += sign * force[k]


@stage
def _arm(state, node, b):
    return state.position[0, node] - state.parts[b, 0], state.position[1, node] - state.parts[b, 1], state.position[2, node] - state.parts[b, 2]


@stage
def _move_of(state, plan, right, node):
    """How a node goes when the threes go by right (T, 3)."""
    three = plan.node_three[node]
    if three >= 0:
        return right[three, 0], right[three, 1], right[three, 2]
    if plan.rider_of[node] >= 0:
        b = plan.rider_part[plan.rider_of[node]]
        turn, place = plan.turn_three[b], plan.part_three[b]
        swept = cross((right[turn, 0], right[turn, 1], right[turn, 2]), _arm(state, node, b))
        return right[place, 0] + swept[0], right[place, 1] + swept[1], right[place, 2] + swept[2]
    return 0.0, 0.0, 0.0


@stage
def _stretch(state, s, k):
    return state.position[k, s] - state.position[k, s - 1]


@routine
def mixed_merit(model, state, plan, axial, damper, foreseen, linear, right, left):
    """Let segments with a foreseen tension (n,) > 0 push as well as pull in right (T, 3), and measure what is missed with these tensions.

    linear (n,) gets the tension of every segment by its slope, axial (n,) N/m and damper (n,) N s/m; left (T, 3) is work.
    """
    for three in range(right.shape[0]):
        for k in range(3):
            left[three, k] = right[three, k]
    missed = 0.0
    for s in range(1, model.size + 1):
        tension, wanted = state.tension[s], foreseen[s]
        linear[s] = tension
        if tension <= 0.0 and wanted <= 0.0 or axial[s] == 0.0:
            continue
        q = (state.tangent[0, s], state.tangent[1, s], state.tangent[2, s])
        if tension <= 0.0:
            length = q[0] * _stretch(state, s, 0) + q[1] * _stretch(state, s, 1) + q[2] * _stretch(state, s, 2)
            linear[s] = min(axial[s] * (length - model.length[s]) + damper[s] * state.strain_rate[s], 0.0)
            push = (linear[s] * q[0], linear[s] * q[1], linear[s] * q[2])
            _add_at(state, plan, s - 1, push, 1.0, right)
            _add_at(state, plan, s, push, -1.0, right)
            _add_at(state, plan, s - 1, push, 1.0, left)
            _add_at(state, plan, s, push, -1.0, left)
        more = wanted - linear[s]
        strain = more / axial[s] * model.inverse_length[s]
        missed += strain * strain
        pull = (more * q[0], more * q[1], more * q[2])
        _add_at(state, plan, s - 1, pull, 1.0, left)
        _add_at(state, plan, s, pull, -1.0, left)
    total = STRAIN_SCALE * STRAIN_SCALE * missed
    for three in range(left.shape[0]):
        r = (left[three, 0], left[three, 1], left[three, 2])
        total += dot(r, r) / plan.scale[three] ** 2
    return np.sqrt(total)


@routine
def foresee(model, state, plan, axial, damper, c_v, pulled, linear, right, tension):
    """Tensions (n,) that the segments will have after the Newton step right (T, 3), to first order; zero for those that go slack or stay so."""
    for s in range(1, model.size + 1):
        if axial[s] == 0.0:
            continue
        a, b = _move_of(state, plan, right, s - 1), _move_of(state, plan, right, s)
        q = (state.tangent[0, s], state.tangent[1, s], state.tangent[2, s])
        go = (b[0] - a[0], b[1] - a[1], b[2] - a[2])
        start, v, rate = linear[s], state.velocity, dot(q, go)
        length = q[0] * _stretch(state, s, 0) + q[1] * _stretch(state, s, 1) + q[2] * _stretch(state, s, 2)
        if start == 0.0:
            start = axial[s] * (length - model.length[s]) + damper[s] * state.strain_rate[s]
        per_length, swing = 1.0 / max(length, 0.1 * model.length[s]), 0.0
        for k in range(3):
            swing += (v[k, s] - v[k, s - 1] - state.strain_rate[s] * q[k]) * go[k]
        pull = start + (axial[s] + c_v * damper[s]) * rate + damper[s] * swing * per_length
        tight = pulled[s] != 0.0 or length + rate > model.length[s]
        tension[s] = max(pull, 0.0) if tight else 0.0
        if tension[s] > 0.0:
            pulled[s] = 1.0  # across, but for the pull that will stop it


@routine
def blend(old, new, share, target):
    for s in range(old.size):
        target[s] = old[s] + share * (new[s] - old[s])


@routine
def copy_tensions(source, target):
    for s in range(source.size):
        target[s] = source[s]
