"""One step of the generalised-alpha method: prediction, and Newton's method to the balance of forces at the step's end.

In the form of Arnold and Bruels (2007): forces balance with the accelerations w at the end of every step, whatever inertia depends on, and a
filtered acceleration a carries places and velocities,

    x1 = x0 + h v0 + h^2 ((1/2 - beta) a0 + beta a1),    v1 = v0 + h ((1 - gamma) a0 + gamma a1),
    (1 - alpha_m) a1 + alpha_m a0 = (1 - alpha_f) w1 + alpha_f w0,

with the coefficients of Chung and Hulbert (1993): second order, and waves that the step does not follow are damped by the spectral radius at
infinity. Rotations go by the exponential of h (omega0 + ...), in the same way.
"""

from typing import NamedTuple

import numpy as np

from .cache import routine, stage
from .forces import load_nodes
from .implicit_blocks import bent_blocks, clear_blocks, hand_on, line_blocks, node_blocks, surface_blocks, turn_blocks
from .implicit_gates import catch_nodes, catch_segments
from .implicit_ground import ground_step_blocks
from .implicit_parts import mass_blocks, out_of_balance
from .implicit_tensions import blend, copy_tensions, foresee, mixed_merit
from .implicit_solve import SOLVED, solve_blocks
from .packed import packed
from .points import place_coupled_points
from .rigid import turn_by

MOST_ITERATIONS = 12
SEARCHES = 4  # how often a Newton step is halved at most
WORSE, BOLD = 10.0, 4  # times what was missed that a Newton step may leave: slack and contact come and go, and the one after knows of it; in how many iterations
BETTER = 0.9  # ... in later ones: steps to and fro across the narrow range of speeds in which a node sticks lessen nothing
LOOSE = 1e-2  # of Plan.scale: what may remain in the shortest piece of a step, where the bed's laws have no balance
TOLERANCE = 1e-4  # of Plan.scale: forces out of balance that may remain
NEWTON_DONE, NOT_BALANCED = 0, 1


@packed
class Work(NamedTuple):
    """Work space of implicit steps; nothing in it outlives an interval."""

    values: np.ndarray  # (S, 9): blocks of a Plan
    right: np.ndarray  # (T, 3): forces out of balance, then the Newton step
    balance: np.ndarray  # (T, 3): forces out of balance after it
    left: np.ndarray  # (T, 3): ... with tensions of their own
    axial: np.ndarray  # (n,) N/m: slope of the tension with the segment's length
    damper: np.ndarray  # (n,) N s/m: ... with its rate
    foreseen: np.ndarray  # (n,) N: tensions of their own (implicit_tensions.py), those of the last iteration, after a full step, and by the slope
    last: np.ndarray
    next: np.ndarray
    linear: np.ndarray
    pulled: np.ndarray  # (n,) 1 for segments that have been taut in a step's iterations (implicit_gates.py)
    touched: np.ndarray  # (n,) 1 for nodes that have been in the bed
    bent: np.ndarray  # (b, 3, 3)
    clamp_turn: np.ndarray  # (C, 2, 3, 3)
    clamp_axis: np.ndarray  # (C, 3, 3)
    moved: np.ndarray  # (4, 3, n): position, velocity, acceleration and filtered acceleration of a step's start
    parts: np.ndarray  # (B, 13) of a step's start
    parts_moved: np.ndarray  # (2, B, 6): acceleration and filtered acceleration of the parts, of a step's start
    turned: np.ndarray  # (B, 3): rotation vector since a step's start
    saved: np.ndarray  # (2, 3, n): accelerations of the interval's start
    saved_parts: np.ndarray  # (2, B, 6)
    saved_rate: np.ndarray  # (n,) N/s: State.tension_rate of the interval's start
    settings: np.ndarray  # (12,): State.settings of the interval's start, whether the waves have been looked at further ahead, and calm_step (s)


class Scheme(NamedTuple):
    """Coefficients of the method."""

    alpha_m: float
    alpha_f: float
    beta: float
    gamma: float


def scheme_of(spectral_radius):
    """Scheme with this spectral radius at infinity, 0..1 (Chung and Hulbert 1993)."""
    alpha_m, alpha_f = (2.0 * spectral_radius - 1.0) / (spectral_radius + 1.0), spectral_radius / (spectral_radius + 1.0)
    return Scheme(alpha_m, alpha_f, 0.25 * (1.0 - alpha_m + alpha_f) ** 2, 0.5 - alpha_m + alpha_f)


@routine
def keep_start(model, state, work):
    for k in range(3):
        for i in range(model.mass.size):
            work.moved[0, k, i] = state.position[k, i]
            work.moved[1, k, i] = state.velocity[k, i]
            work.moved[2, k, i] = state.acceleration[k, i]
            work.moved[3, k, i] = state.filtered[k, i]
    for b in range(state.parts.shape[0]):
        for k in range(13):
            work.parts[b, k] = state.parts[b, k]
        for k in range(6):
            work.parts_moved[0, b, k] = state.parts_acceleration[b, k]
            work.parts_moved[1, b, k] = state.parts_filtered[b, k]


@routine
def return_to_start(model, state, work):
    for k in range(3):
        for i in range(model.mass.size):
            state.position[k, i] = work.moved[0, k, i]
            state.velocity[k, i] = work.moved[1, k, i]
            state.acceleration[k, i] = work.moved[2, k, i]
            state.filtered[k, i] = work.moved[3, k, i]
    for b in range(state.parts.shape[0]):
        for k in range(13):
            state.parts[b, k] = work.parts[b, k]
        for k in range(6):
            state.parts_acceleration[b, k] = work.parts_moved[0, b, k]
            state.parts_filtered[b, k] = work.parts_moved[1, b, k]


@routine
def predict(model, state, work, scheme, h):
    """Go to where the accelerations as they are lead to in h (s)."""
    alpha_m, alpha_f, beta, gamma = scheme
    per = 1.0 / (1.0 - alpha_m)
    for k in range(3):
        for i in range(model.mass.size):
            a0 = work.moved[3, k, i]
            a1 = per * (work.moved[2, k, i] - alpha_m * a0)
            state.position[k, i] = work.moved[0, k, i] + h * (work.moved[1, k, i] + h * ((0.5 - beta) * a0 + beta * a1))
            state.velocity[k, i] = work.moved[1, k, i] + h * ((1.0 - gamma) * a0 + gamma * a1)
            state.filtered[k, i] = a1
    for b in range(state.parts.shape[0]):
        for k in range(6):
            a0 = work.parts_moved[1, b, k]
            a1 = per * (work.parts_moved[0, b, k] - alpha_m * a0)
            way = h * (work.parts[b, 7 + k] + h * ((0.5 - beta) * a0 + beta * a1))
            state.parts[b, 7 + k] = work.parts[b, 7 + k] + h * ((1.0 - gamma) * a0 + gamma * a1)
            state.parts_filtered[b, k] = a1
            if k < 3:
                state.parts[b, k] = work.parts[b, k] + way
            else:
                work.turned[b, k - 3] = way
        _turn_from_start(state, work, b)


@stage
def _turn_from_start(state, work, b):
    for k in range(3, 7):
        state.parts[b, k] = work.parts[b, k]
    turn_by(state.parts, b, work.turned[b, 0], work.turned[b, 1], work.turned[b, 2])


@stage
def _move_node(state, right, node, three, share, c_v, c_m, c_a):
    for k in range(3):
        way = share * right[three, k]
        state.position[k, node] += way
        state.velocity[k, node] += c_v * way
        state.acceleration[k, node] += c_m * way
        state.filtered[k, node] += c_a * way


@routine
def apply(model, state, plan, work, share, c_v, c_m, c_a):
    """Move everything by `share` of the Newton step in work.right."""
    right = work.right
    for k in range(plan.own_node.size):
        _move_node(state, right, plan.own_node[k], plan.own_three[k], share, c_v, c_m, c_a)
    for f in range(model.free_points.size):
        _move_node(state, right, model.point_node[model.free_points[f]], plan.point_three[f], share, c_v, c_m, c_a)
    for b in range(state.parts.shape[0]):
        for k in range(6):
            way = share * (right[plan.part_three[b], k] if k < 3 else right[plan.turn_three[b], k - 3])
            state.parts[b, 7 + k] += c_v * way
            state.parts_acceleration[b, k] += c_m * way
            state.parts_filtered[b, k] += c_a * way
            if k < 3:
                state.parts[b, k] += way
            else:
                work.turned[b, k - 3] += way
        _turn_from_start(state, work, b)


@routine
def load_at_end(model, state, scratch, work):
    """All forces, by the plain laws."""
    load_nodes(model, state, scratch, 0.0, 0.0, state.settings[2] != 0.0, True)
    catch_segments(model, state, work.pulled)
    catch_nodes(model, state, scratch.bed, work.touched)


@stage
def start_step(model, state, work):
    """Slopes of the tensions, tensions as they are, and no gate open."""
    for i in range(work.pulled.size):
        work.axial[i] = model.stiffness[i] * model.inverse_length[i]
        work.damper[i] = model.damping[i]
        work.foreseen[i] = state.tension[i]
        work.pulled[i] = 0.0
        work.touched[i] = 0.0


@routine
def tangent(model, state, scratch, plan, work, c_v, c_m):
    """Fill work.values."""
    values = work.values
    clear_blocks(values)
    line_blocks(model, state, plan, work.axial, work.damper, work.foreseen, c_v, values)
    node_blocks(model, state, plan, work.touched, c_v, c_m, values)
    if model.ground.on:
        ground_step_blocks(model, state, plan, scratch.bed, work.touched, c_v, values)
    if state.settings[2] != 0.0:
        surface_blocks(model, state, plan, values)
    if model.bending.stiffness.size > 0:
        bent_blocks(model, state, plan, work.bent, work.clamp_turn, work.clamp_axis, values)
    if model.rigid.mass.size > 0:
        turn_blocks(model, state, plan, c_v, values)
    if plan.source.size > 0:
        hand_on(state, plan, values)
    if model.free_points.size + model.rigid.mass.size > 0:
        mass_blocks(model, state, scratch, plan, c_m, values)


@routine
def balance_step(model, state, scratch, plan, work, scheme, h, end, tolerance):
    """Take a step of h (s) to `end`, 0..1 of the interval, from what `keep_start` has kept.

    tolerance: of Plan.scale, what may remain out of balance after the last iteration. Returns (NEWTON_DONE or NOT_BALANCED, iterations, evaluations). At most MOST_ITERATIONS times 1 + SEARCHES evaluations.
    """
    alpha_m, alpha_f, beta, gamma = scheme
    c_v, c_a = gamma / (beta * h), 1.0 / (beta * h * h)
    c_m = c_a * (1.0 - alpha_m) / (1.0 - alpha_f)
    start_step(model, state, work)
    predict(model, state, work, scheme, h)
    place_coupled_points(model, state, scratch.motion, end)
    load_at_end(model, state, scratch, work)
    largest = out_of_balance(model, state, scratch, plan, work.right)
    merit = mixed_merit(model, state, plan, work.axial, work.damper, work.foreseen, work.linear, work.right, work.left)
    evaluations = 1
    for iteration in range(MOST_ITERATIONS):
        if largest <= TOLERANCE and iteration > 0:  # the first one is always worth it: errors of many small steps would gather
            return NEWTON_DONE, iteration, evaluations
        if not (largest < np.inf and merit < np.inf):
            return NOT_BALANCED, iteration, evaluations
        before = largest
        tangent(model, state, scratch, plan, work, c_v, c_m)
        if solve_blocks(plan, work.values, work.right) != SOLVED:
            return NOT_BALANCED, iteration, evaluations
        foresee(model, state, plan, work.axial, work.damper, c_v, work.pulled, work.linear, work.right, work.next)
        copy_tensions(work.foreseen, work.last)
        share = 1.0
        apply(model, state, plan, work, 1.0, c_v, c_m, c_a)
        for search in range(SEARCHES + 1):
            blend(work.last, work.next, share, work.foreseen)
            load_at_end(model, state, scratch, work)
            largest = out_of_balance(model, state, scratch, plan, work.balance)
            new = mixed_merit(model, state, plan, work.axial, work.damper, work.foreseen, work.linear, work.balance, work.left)
            evaluations += 1
            if largest <= TOLERANCE or new <= (WORSE if iteration < BOLD else BETTER) * max(merit, before) or search == SEARCHES:
                break
            share *= 0.5
            apply(model, state, plan, work, -share, c_v, c_m, c_a)
        merit = new
        for three in range(work.right.shape[0]):
            for k in range(3):
                work.right[three, k] = work.balance[three, k]
    return (NEWTON_DONE if largest <= tolerance else NOT_BALANCED), MOST_ITERATIONS, evaluations
