"""Free points within the implicit axial solve (axial.py): the lines are eliminated onto the points, which are then solved for together.

A line answers motions of its ends along its end segments with impulses there: a symmetric 2 x 2 matrix of the line. With the points'
inertia they make a sparse positive definite system for the points' changes of velocity, solved by Cholesky's method within its envelope:
points that no line joins, and clusters of points far from each other in the file, cost each other nothing.
"""

import numpy as np

from .cache import stage
from .model import LOOSE

SMALLEST = 1e-150  # of a line's answer at its other end: less is none


@stage
def _free_at(model, state, e):
    """Row of the free point that holds end e, or -1."""
    p = state.end_point[e]
    return model.free_index[p] if p != LOOSE else -1


@stage
def _end_segment(model, e):
    """The segment at end e."""
    line = e // 2
    return model.first_node[line] + (model.segments[line] if e % 2 == 1 else 1)


@stage
def _add_answer(matrix, tangent, answer, f, segment_f, g, segment_g, sign):
    """answer q_f q_g' into the block of the points f and g."""
    for r in range(3):
        for c in range(3):
            row, column = 3 * f + r, 3 * g + c
            if column <= row:
                matrix[row, column] += sign * answer * tangent[r, segment_f] * tangent[c, segment_g]


@stage
def _add_line(model, state, line, matrix, diagonal, before, after, gain, pulls):
    """Answers of one line at its free ends, from eliminations in both directions."""
    f, g = _free_at(model, state, 2 * line), _free_at(model, state, 2 * line + 1)
    if f < 0 and g < 0:
        return
    a, b = _end_segment(model, 2 * line), _end_segment(model, 2 * line + 1)
    pivot, across = diagonal[a], 1.0
    for i in range(a + 1, b + 1):
        across *= after[i - 1] / pivot
        pivot = diagonal[i] - before[i] * after[i - 1] / pivot
        if abs(across) < SMALLEST:
            across = 0.0
    across *= gain[b] * pulls[b] / pivot
    if g >= 0:
        _add_answer(matrix, state.tangent, gain[b] * pulls[b] / pivot, g, b, g, b, 1.0)
    if f >= 0:
        pivot = diagonal[b]
        for i in range(b - 1, a - 1, -1):
            pivot = diagonal[i] - after[i] * before[i + 1] / pivot
        _add_answer(matrix, state.tangent, gain[a] * pulls[a] / pivot, f, a, f, a, 1.0)
    if f >= 0 and g >= 0:
        if f == g:
            _add_answer(matrix, state.tangent, across, f, a, f, b, -1.0)
            _add_answer(matrix, state.tangent, across, f, b, f, a, -1.0)
        elif f > g:
            _add_answer(matrix, state.tangent, across, f, a, g, b, -1.0)
        else:
            _add_answer(matrix, state.tangent, across, g, b, f, a, -1.0)


@stage
def join(model, state, load, matrix, first, diagonal, before, after, gain, pulls):
    """Build the points' system and factorise it: lower triangle of `matrix` (3 F, 3 F), `first` (3 F,) column of each row's envelope."""
    size = 3 * model.free_points.size
    for e in range(0, model.end_node.size, 2):
        f, g = _free_at(model, state, e), _free_at(model, state, e + 1)
        if e == 0:
            for i in range(size):
                first[i] = 3 * (i // 3)
        if f >= 0 and g >= 0:
            for k in range(3):
                row, column = 3 * max(f, g) + k, 3 * min(f, g)
                first[row] = min(first[row], column)
    for i in range(size):
        for j in range(first[i], i + 1):
            matrix[i, j] = 0.0
    for f in range(model.free_points.size):
        m = load[model.free_points[f]]
        i = 3 * f
        matrix[i, i], matrix[i + 1, i + 1], matrix[i + 2, i + 2] = m[3], m[4], m[5]
        matrix[i + 1, i], matrix[i + 2, i], matrix[i + 2, i + 1] = m[6], m[7], m[8]
    for line in range(model.first_node.size):
        _add_line(model, state, line, matrix, diagonal, before, after, gain, pulls)
    for i in range(size):
        for j in range(first[i], i + 1):
            total = matrix[i, j]
            for k in range(max(first[i], first[j]), j):
                total -= matrix[i, k] * matrix[j, k]
            if j < i:
                matrix[i, j] = total * matrix[j, j]
            else:
                matrix[i, i] = 1.0 / np.sqrt(total) if total > 0.0 else 0.0  # nothing moves what has no inertia and no line


@stage
def move_joints(model, state, matrix, first, y, change):
    """Changes of the points' velocities (3 F,), m/s, from the impulses y that the lines have with the points held."""
    size = 3 * model.free_points.size
    q = state.tangent
    for i in range(size):
        change[i] = 0.0
    for e in range(model.end_node.size):
        f = _free_at(model, state, e)
        if f >= 0:
            segment = _end_segment(model, e)
            sign = -1.0 if e % 2 == 1 else 1.0
            for k in range(3):
                change[3 * f + k] += sign * q[k, segment] * y[segment]
    for i in range(size):
        total = change[i]
        for k in range(first[i], i):
            total -= matrix[i, k] * change[k]
        change[i] = total * matrix[i, i]
    for i in range(size - 1, -1, -1):
        change[i] *= matrix[i, i]
        for k in range(first[i], i):
            change[k] -= matrix[i, k] * change[i]


@stage
def follow_joints(model, state, change, gain, sign, source):
    """Add to (sign 1) or take from (-1) the sources of the end segments what the points' changes of velocity do to them."""
    q = state.tangent
    for e in range(model.end_node.size):
        f = _free_at(model, state, e)
        if f >= 0:
            segment = _end_segment(model, e)
            side = sign if e % 2 == 1 else -sign
            rate = q[0, segment] * change[3 * f] + q[1, segment] * change[3 * f + 1] + q[2, segment] * change[3 * f + 2]
            source[segment] += side * gain[segment] * rate


@stage
def give_to_nodes(model, state, change, gain_x, gain_y, gain_z):
    """The points' nodes and the ends that they hold go with them."""
    for f in range(model.free_points.size):
        node = model.point_node[model.free_points[f]]
        gain_x[node], gain_y[node], gain_z[node] = change[3 * f], change[3 * f + 1], change[3 * f + 2]
    for e in range(model.end_node.size):
        f = _free_at(model, state, e)
        if f >= 0:
            node = model.end_node[e]
            gain_x[node], gain_y[node], gain_z[node] = change[3 * f], change[3 * f + 1], change[3 * f + 2]
