"""Rigid parts that move by themselves: free bodies and rods, and rods pinned at one end.

All that rides on a part, the nodes of its rods, its points and the ends of lines there, hands over its forces and inertia; six equations of
motion about the part's origin give its acceleration, (m + A) (a + alpha x r + omega x (omega x r)) = f summed over what rides on it.
"""

import numpy as np

from .cache import routine, stage
from .hulls import add_hulls
from .layout import POINT_COUPLED, POINT_RIDING
from .model import LOOSE
from .platform import cross, dot, exponential_coefficients, rotate
from .points import point_acceleration

LAG_PASSES = 3
SMALLEST_PIVOT = 1e-13  # of what stood there: a rod without thickness has no inertia about its axis


@routine
def carry_parts(model, state):
    """Put the internal points that ride on parts where these carry them; a pinned part hangs on its pin."""
    rigid, parts = model.rigid, state.parts
    for b in range(rigid.mass.size):
        if rigid.pin[b] >= 0:
            node = model.point_node[rigid.pin[b]]
            for k in range(3):
                parts[b, k], parts[b, 7 + k] = state.position[k, node], state.velocity[k, node]
    for i in range(rigid.riding.size):
        p = rigid.riding[i]
        node, b = model.point_node[p], rigid.part[p]
        q = (parts[b, 3], parts[b, 4], parts[b, 5], parts[b, 6])
        arm = rotate(q, (model.point_place[p, 0], model.point_place[p, 1], model.point_place[p, 2]))
        spin = cross((parts[b, 10], parts[b, 11], parts[b, 12]), arm)
        for k in range(3):
            state.position[k, node] = parts[b, k] + arm[k]
            state.velocity[k, node] = parts[b, 7 + k] + spin[k]


@stage
def _add_block(matrix, row, column, m, factor):
    for i in range(3):
        for j in range(3):
            matrix[row + i, column + j] += factor * m[i][j]


@stage
def _times(a, b):
    """Product of two 3 x 3 matrices given as tuples of rows."""
    return (
        (_row(a[0], b, 0), _row(a[0], b, 1), _row(a[0], b, 2)),
        (_row(a[1], b, 0), _row(a[1], b, 1), _row(a[1], b, 2)),
        (_row(a[2], b, 0), _row(a[2], b, 1), _row(a[2], b, 2)),
    )


@stage
def _row(row, b, j):
    return row[0] * b[0][j] + row[1] * b[1][j] + row[2] * b[2][j]


@stage
def skew(v):
    """The matrix of v x, as a tuple of rows."""
    return (0.0, -v[2], v[1]), (v[2], 0.0, -v[0]), (-v[1], v[0], 0.0)


@stage
def rotation_matrix(q):
    """Rows of the matrix of the unit quaternion q."""
    x, y, z = rotate(q, (1.0, 0.0, 0.0)), rotate(q, (0.0, 1.0, 0.0)), rotate(q, (0.0, 0.0, 1.0))
    return (x[0], y[0], z[0]), (x[1], y[1], z[1]), (x[2], y[2], z[2])


@stage
def _turned_matrix(r, m):
    """R m R' of m (3, 3), an array in the part's axes, as a tuple of rows in the world's."""
    inner = ((m[0, 0], m[0, 1], m[0, 2]), (m[1, 0], m[1, 1], m[1, 2]), (m[2, 0], m[2, 1], m[2, 2]))
    return _times(_times(r, inner), ((r[0][0], r[1][0], r[2][0]), (r[0][1], r[1][1], r[2][1]), (r[0][2], r[1][2], r[2][2])))


@stage
def _apply(m, v):
    return dot(m[0], v), dot(m[1], v), dot(m[2], v)


@stage
def _add_load(matrix, arm, force):
    """Add a force (3,) at `arm` (3,) to the right-hand side."""
    moment = cross(arm, force)
    for k in range(3):
        matrix[k, 6] += force[k]
        matrix[3 + k, 6] += moment[k]


@stage
def _add_mass(matrix, m, arm, omega):
    """Add the inertia m, 3 x 3 rows, of what stands at `arm` on a part that spins at `omega`."""
    r = skew(arm)
    mr, rm = _times(m, r), _times(r, m)
    _add_block(matrix, 0, 0, m, 1.0)
    _add_block(matrix, 0, 3, mr, -1.0)
    _add_block(matrix, 3, 0, rm, 1.0)
    _add_block(matrix, 3, 3, _times(r, mr), -1.0)
    centripetal = _apply(m, cross(omega, cross(omega, arm)))
    _add_load(matrix, arm, (-centripetal[0], -centripetal[1], -centripetal[2]))


@stage
def _add_body(model, state, b, r, omega, matrix):
    """Mass, and what lumps of added mass have too much, of part b whose axes stand at r (rows)."""
    rigid = model.rigid
    mass = rigid.mass[b]
    centre = _apply(r, (rigid.centre[b, 0], rigid.centre[b, 1], rigid.centre[b, 2]))
    inertia = _turned_matrix(r, rigid.inertia[b])
    c = skew(centre)
    for k in range(3):
        matrix[k, k] += mass
    _add_block(matrix, 0, 3, c, -mass)
    _add_block(matrix, 3, 0, c, mass)
    _add_block(matrix, 3, 3, inertia, 1.0)
    inward = cross(omega, cross(omega, centre))
    gyro = cross(omega, _apply(inertia, omega))
    for k in range(3):
        matrix[k, 6] -= mass * inward[k]
        matrix[3 + k, 6] -= gyro[k]
    wet, counted = 0.0, 0.0
    for i in range(rigid.riding.size):
        p = rigid.riding[i]
        node = model.point_node[p]
        if rigid.part[p] == b and node < model.size:
            share = model.share_left[node] + model.share_right[node]
            wet, counted = wet + share * state.wet[node], counted + share
    if counted > 0.0:
        _add_block(matrix, 3, 3, _turned_matrix(r, rigid.added_surplus[b]), -wet / counted)


@stage
def _solve(matrix, first):
    """Solve rows and columns first..5 of the symmetric positive matrix (6, 8) in place; the answer stands in column 6."""
    for i in range(first, 6):
        matrix[i, 7] = SMALLEST_PIVOT * matrix[i, i] + 1e-300
    for i in range(first, 6):
        pivot = 1.0 / max(matrix[i, i], matrix[i, 7])
        for j in range(i + 1, 6):
            factor = matrix[j, i] * pivot
            for k in range(i + 1, 7):
                matrix[j, k] -= factor * matrix[i, k]
    for i in range(5, first - 1, -1):
        total = matrix[i, 6]
        for j in range(i + 1, 6):
            total -= matrix[i, j] * matrix[j, 6]
        matrix[i, 6] = total / max(matrix[i, i], matrix[i, 7])


@stage
def part_equations(model, state, load, b, quaternion, r, omega, matrix):
    """Equations of motion of part b about its origin into `matrix` (6, 7+), inertia and right-hand side; `load` (P, 9) from `points.gather`."""
    rigid = model.rigid
    for i in range(6):
        for j in range(7):
            matrix[i, j] = 0.0
    _add_body(model, state, b, r, omega, matrix)
    add_hulls(model, state, b, quaternion, omega, rigid.mass[b], matrix)
    for i in range(rigid.riding.size):
        p = rigid.riding[i]
        if rigid.part[p] == b:
            arm = _arm(model, state, b, p)
            m = load[p]
            _add_load(matrix, arm, (m[0], m[1], m[2]))
            _add_mass(matrix, ((m[3], m[6], m[7]), (m[6], m[4], m[8]), (m[7], m[8], m[5])), arm, omega)
    for c in range(model.clamps.part.size):
        if model.clamps.part[c] == b:
            for k in range(3):
                matrix[3 + k, 6] += state.clamp_moment[c, k]


@routine
def move_parts(model, state, scratch):
    """Accelerations of the parts from what `points.gather` has put into scratch.load, given to all that rides on them.

    Where velocities stand back from places by the time settings[8], as leapfrog's do, what depends on the spin is taken with that of the
    present: from the late one alone a spinning body would gain energy in every step.
    """
    rigid, parts, matrix, load = model.rigid, state.parts, scratch.matrix, scratch.load
    for b in range(rigid.mass.size):
        quaternion = (parts[b, 3], parts[b, 4], parts[b, 5], parts[b, 6])
        r = rotation_matrix(quaternion)
        lag, omega = state.settings[8], (parts[b, 10], parts[b, 11], parts[b, 12])
        for _ in range(1 if lag == 0.0 else LAG_PASSES):
            part_equations(model, state, load, b, quaternion, r, omega, matrix)
            if rigid.pin[b] >= 0:
                _turn_about_pin(model, state, b, matrix)
            else:
                _solve(matrix, 0)
                for k in range(6):
                    state.parts_acceleration[b, k] = matrix[k, 6]
            a = state.parts_acceleration[b]
            omega = (parts[b, 10] + lag * a[3], parts[b, 11] + lag * a[4], parts[b, 12] + lag * a[5])
    accelerate_riders(model, state)


@stage
def _arm(model, state, b, p):
    node = model.point_node[p]
    return (
        state.position[0, node] - state.parts[b, 0],
        state.position[1, node] - state.parts[b, 1],
        state.position[2, node] - state.parts[b, 2],
    )


@stage
def _turn_about_pin(model, state, b, matrix):
    """Only turns are free; what the pin's own acceleration and the turning leave over is what the part does to its pin."""
    reaction, answer = state.parts_reaction, state.parts_acceleration
    pin = model.rigid.pin[b]
    a = (0.0, 0.0, 0.0)
    if model.point_kind[pin] == POINT_COUPLED:
        a = point_acceleration(model, state, pin)
    for k in range(3):
        answer[b, k] = a[k]
        reaction[b, k] = matrix[k, 6] - dot((matrix[k, 0], matrix[k, 1], matrix[k, 2]), a)
        matrix[3 + k, 6] -= dot((matrix[3 + k, 0], matrix[3 + k, 1], matrix[3 + k, 2]), a)
    _solve(matrix, 3)
    for k in range(3):
        answer[b, 3 + k] = matrix[3 + k, 6]
        for j in range(3):
            reaction[b, k] -= matrix[k, 3 + j] * matrix[3 + j, 6]


@stage
def accelerate_riders(model, state):
    rigid, acceleration = model.rigid, state.acceleration
    for i in range(rigid.riding.size):
        p = rigid.riding[i]
        b, node = rigid.part[p], model.point_node[p]
        arm = _arm(model, state, b, p)
        omega = (state.parts[b, 10], state.parts[b, 11], state.parts[b, 12])
        a = state.parts_acceleration[b]
        turn, inward = cross((a[3], a[4], a[5]), arm), cross(omega, cross(omega, arm))
        for k in range(3):
            acceleration[k, node] = a[k] + turn[k] + inward[k]
    for e in range(model.end_node.size):
        p = state.end_point[e]
        if p != LOOSE and model.point_kind[p] == POINT_RIDING:
            for k in range(3):
                acceleration[k, model.end_node[e]] = acceleration[k, model.point_node[p]]


@stage
def turn_by(parts, b, x, y, z):
    """Turn part b by the rotation vector (x, y, z), world axes."""
    half = (0.5 * x, 0.5 * y, 0.5 * z)
    square = dot(half, half)
    first, second, _ = exponential_coefficients(square)
    u, w = (first * half[0], first * half[1], first * half[2]), 1.0 - second * square
    v = (parts[b, 3], parts[b, 4], parts[b, 5])
    c = cross(u, v)
    s = parts[b, 6]
    for k in range(3):
        parts[b, 3 + k] = w * v[k] + s * u[k] + c[k]
    parts[b, 6] = w * s - dot(u, v)
    _normalise(parts, b)


@stage
def _normalise(parts, b):
    norm = np.sqrt(parts[b, 3] ** 2 + parts[b, 4] ** 2 + parts[b, 5] ** 2 + parts[b, 6] ** 2)
    for k in range(4):
        parts[b, 3 + k] /= norm


@routine
def euler_parts(parts, a, h, staggered):
    """An Euler step of h (s) of all parts (B, 13) with accelerations a (B, 6); `staggered`: with the new velocities, as leapfrog does."""
    for b in range(parts.shape[0]):
        if staggered:
            for k in range(6):
                parts[b, 7 + k] += h * a[b, k]
        for k in range(3):
            parts[b, k] += h * parts[b, 7 + k]
        turn_by(parts, b, h * parts[b, 10], h * parts[b, 11], h * parts[b, 12])
        if not staggered:
            for k in range(6):
                parts[b, 7 + k] += h * a[b, k]


@routine
def mix_parts(parts, start, old):
    """The mean of the parts (B, 13) now and at `start`, which has the weight `old`."""
    for b in range(parts.shape[0]):
        same = 0.0
        for k in range(3, 7):
            same += parts[b, k] * start[b, k]
        for k in range(13):
            past = -start[b, k] if 3 <= k < 7 and same < 0.0 else start[b, k]
            parts[b, k] = old * past + (1.0 - old) * parts[b, k]
        _normalise(parts, b)


@routine
def copy_parts(source, target):
    for b in range(source.shape[0]):
        for k in range(13):
            target[b, k] = source[b, k]
