"""Points: where the ends of lines are held, how they move, and what they feel.

The node of a point and the end nodes of its lines share one motion. Fixed and coupled points are prescribed; a free point moves by the sum
of the forces on all its nodes over the sum of their inertia; riding ones go with their rigid part (rigid.py).
"""

import numpy as np

from .cache import stage
from .clamps import turn_clamps_with_platform
from .ground import along_bed
from .layout import POINT_COUPLED, POINT_FIXED, POINT_FREE, POINT_RIDING
from .model import LOOSE
from .platform import cross, platform_at, rotate, turned
from .tension import TINY


@stage
def _move_coupled_points(model, state, motion, s, with_place, euler_step, staggered):
    for m in range(motion.shape[0]):
        _move_with_platform(model, state, motion[m], m, s, with_place, euler_step, staggered)


@stage
def _move_with_platform(model, state, motion, m, s, with_place, euler_step, staggered):
    place, velocity, phi, omega = platform_at(motion, s)
    pose = state.pose  # of the interval's start
    quaternion = (pose[m, 3], pose[m, 4], pose[m, 5], pose[m, 6])
    turn_clamps_with_platform(model, state, m, quaternion, phi)
    for i in range(model.coupled_first[m], model.coupled_first[m + 1]):
        p = model.coupled_points[i]
        node = model.point_node[p]
        arm = (model.point_place[p, 0], model.point_place[p, 1], model.point_place[p, 2])
        arm = turned(phi, rotate(quaternion, arm))
        spin = cross(omega, arm)
        for k in range(3):
            if node >= model.size:  # beyond the passes: an Euler step has not moved it yet
                state.position[k, node] += euler_step * state.velocity[k, node]
            here, speed = place[k] + arm[k], velocity[k] + spin[k]
            if staggered:
                speed = state.velocity[k, node] + (here - state.position[k, node]) / euler_step
            state.velocity[k, node] = speed
            if with_place:
                state.position[k, node] = here


@stage
def place_coupled_points(model, state, motion, s):
    """Put the nodes of the coupled points where their platforms carry them at s in 0..1 of the interval; motion (M, 8, 3)."""
    _move_coupled_points(model, state, motion, s, True, 0.0, False)


@stage
def speed_coupled_points(model, state, motion, s, euler_step):
    """Give them their velocity only: inside a step they go on by Euler steps (s), as their neighbours do.

    Exact places would stretch the end segments by what an Euler step misses, h^2/2 times the acceleration, and the stiff line answers.
    """
    _move_coupled_points(model, state, motion, s, False, euler_step, False)


@stage
def place_staggered_coupled_points(model, state, motion, s, h):
    """For leapfrog, whose velocities stand half a step back: the place at s, and the mean velocity over the step of h (s) before."""
    _move_coupled_points(model, state, motion, s, True, h, True)


@stage
def carry_ends(model, state):
    """Give the end nodes of the lines the motion of the points that hold them."""
    for e in range(model.end_node.size):
        p = state.end_point[e]
        if p != LOOSE:
            end, node = model.end_node[e], model.point_node[p]
            for k in range(3):
                state.position[k, end] = state.position[k, node]
                state.velocity[k, end] = state.velocity[k, node]


@stage
def add_inertia(model, state, scratch, node, matrix):
    """`matrix` (6,): xx, yy, zz, xy, xz, yz, plus the node's inertia m I + (m_a - m) t t' and what its contact with the bed takes in a step."""
    t = state.tangent
    tx, ty, tz = t[0, node] + t[0, node + 1], t[1, node] + t[1, node + 1], t[2, node] + t[2, node + 1]
    normal, axial = state.inertia_normal[node], state.inertia_axial[node]
    surplus = (axial - normal) / max(tx * tx + ty * ty + tz * tz, TINY)
    push, axial_hold, side, nx, ny, nz, ex, ey, ez = 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0
    if model.ground.on:
        hold, bed = scratch.hold, scratch.bed
        push, axial_hold, side = hold[0, node], hold[1, node], hold[2, node]
        nx, ny, nz = bed[1, node], bed[2, node], bed[3, node]
        ex, ey, ez, _, inverse = along_bed(tx, ty, tz, nx, ny, nz)
        inverse = np.sqrt(inverse * model.ground.directional)
        ex, ey, ez = inverse * ex, inverse * ey, inverse * ez
    elif state.bed_relief[node] < 1.0:
        step = state.settings[1]
        push = step * (model.bed_damping[node] + step * model.bed_stiffness[node])
    push -= side
    axial_hold -= side
    return (
        matrix[0] + normal + side + surplus * tx * tx + push * nx * nx + axial_hold * ex * ex,
        matrix[1] + normal + side + surplus * ty * ty + push * ny * ny + axial_hold * ey * ey,
        matrix[2] + normal + side + surplus * tz * tz + push * nz * nz + axial_hold * ez * ez,
        matrix[3] + surplus * tx * ty + push * nx * ny + axial_hold * ex * ey,
        matrix[4] + surplus * tx * tz + push * nx * nz + axial_hold * ex * ez,
        matrix[5] + surplus * ty * tz + push * ny * nz + axial_hold * ey * ez,
    )


@stage
def solve_symmetric(m, f):
    """Solve the symmetric 3 x 3 system with m = xx, yy, zz, xy, xz, yz; zero where the matrix is zero."""
    a = m[1] * m[2] - m[5] * m[5]
    b = m[4] * m[5] - m[3] * m[2]
    c = m[3] * m[5] - m[4] * m[1]
    determinant = m[0] * a + m[3] * b + m[4] * c
    inverse = 1.0 / determinant if determinant > 0.0 else 0.0
    d = m[0] * m[2] - m[4] * m[4]
    e = m[3] * m[4] - m[0] * m[5]
    g = m[0] * m[1] - m[3] * m[3]
    return (
        inverse * (a * f[0] + b * f[1] + c * f[2]),
        inverse * (b * f[0] + d * f[1] + e * f[2]),
        inverse * (c * f[0] + e * f[1] + g * f[2]),
    )


@stage
def _shares_load(model, p):
    return model.point_kind[p] == POINT_FREE or model.point_kind[p] == POINT_RIDING


@stage
def _add_node(model, state, scratch, node, p):
    load = scratch.load
    m = add_inertia(model, state, scratch, node, (load[p, 3], load[p, 4], load[p, 5], load[p, 6], load[p, 7], load[p, 8]))
    for k in range(3):
        load[p, k] += state.force[k, node]
    for k in range(6):
        load[p, 3 + k] = m[k]


@stage
def gather(model, state, scratch):
    """Put forces and inertia of all nodes that move with each free or riding point, its own and those of the ends it holds, into scratch.load."""
    load = scratch.load
    for p in range(model.point_node.size):
        for k in range(9):
            load[p, k] = 0.0
        if _shares_load(model, p) and model.point_node[p] < model.size:
            _add_node(model, state, scratch, model.point_node[p], p)
    for e in range(model.end_node.size):
        p = state.end_point[e]
        if p != LOOSE and _shares_load(model, p):
            _add_node(model, state, scratch, model.end_node[e], p)


@stage
def move_free_points(model, state, load):
    """Accelerations of the free points from their `load`, given to their nodes and those of the ends they hold."""
    acceleration = state.acceleration
    for i in range(model.free_points.size):
        p = model.free_points[i]
        m = load[p]
        a = solve_symmetric((m[3], m[4], m[5], m[6], m[7], m[8]), (m[0], m[1], m[2]))
        for k in range(3):
            acceleration[k, model.point_node[p]] = a[k]
    for e in range(model.end_node.size):
        p = state.end_point[e]
        if p != LOOSE and model.point_kind[p] == POINT_FREE:
            for k in range(3):
                acceleration[k, model.end_node[e]] = acceleration[k, model.point_node[p]]


@stage
def _prescribed(model, p):
    return model.point_kind[p] == POINT_FIXED or model.point_kind[p] == POINT_COUPLED


@stage
def hold_prescribed(model, state):
    """Nothing but the platform moves fixed and coupled points: no acceleration of their nodes and ends in the step."""
    for p in range(model.point_node.size):
        if _prescribed(model, p):
            for k in range(3):
                state.acceleration[k, model.point_node[p]] = 0.0
    for e in range(model.end_node.size):
        p = state.end_point[e]
        if p != LOOSE and _prescribed(model, p):
            for k in range(3):
                state.acceleration[k, model.end_node[e]] = 0.0


@stage
def point_acceleration(model, state, p):
    """Acceleration (m/s^2) of the point p: that of its place on its platform, of its node, or none."""
    node = model.point_node[p]
    if not _prescribed(model, p):
        return state.acceleration[0, node], state.acceleration[1, node], state.acceleration[2, node]
    if model.point_kind[p] == POINT_FIXED:
        return 0.0, 0.0, 0.0
    m = model.point_platform[p]
    a = state.acceleration_of_platform[m]
    arm = (
        state.position[0, node] - state.pose[m, 0],
        state.position[1, node] - state.pose[m, 1],
        state.position[2, node] - state.pose[m, 2],
    )
    omega = (state.twist[m, 3], state.twist[m, 4], state.twist[m, 5])
    inward = cross(omega, cross(omega, arm))
    turn = cross((a[3], a[4], a[5]), arm)
    return a[0] + turn[0] + inward[0], a[1] + turn[1] + inward[1], a[2] + turn[2] + inward[2]
