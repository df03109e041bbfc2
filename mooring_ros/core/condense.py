"""Elimination of each line's interior nodes onto its two ends.

With the blocks of `tangent.py` the interior rows of a line read below x_{i-1} + diagonal x_i + above x_{i+1} = load_i. They are
eliminated from end A towards end B as x_i = g_i - c_i x_{i+1} - a_i x_A.
"""

from .cache import kernel, stage


@stage
def _inverse(m, out):
    """out = inverse of the 3 x 3 matrix m; False when it is singular."""
    c00 = m[1, 1] * m[2, 2] - m[1, 2] * m[2, 1]
    c01 = m[1, 2] * m[2, 0] - m[1, 0] * m[2, 2]
    c02 = m[1, 0] * m[2, 1] - m[1, 1] * m[2, 0]
    determinant = m[0, 0] * c00 + m[0, 1] * c01 + m[0, 2] * c02
    if not abs(determinant) > 0.0:
        return False
    r = 1.0 / determinant
    out[0, 0] = c00 * r
    out[1, 0] = c01 * r
    out[2, 0] = c02 * r
    out[0, 1] = (m[0, 2] * m[2, 1] - m[0, 1] * m[2, 2]) * r
    out[1, 1] = (m[0, 0] * m[2, 2] - m[0, 2] * m[2, 0]) * r
    out[2, 1] = (m[0, 1] * m[2, 0] - m[0, 0] * m[2, 1]) * r
    out[0, 2] = (m[0, 1] * m[1, 2] - m[0, 2] * m[1, 1]) * r
    out[1, 2] = (m[0, 2] * m[1, 0] - m[0, 0] * m[1, 2]) * r
    out[2, 2] = (m[0, 0] * m[1, 1] - m[0, 1] * m[1, 0]) * r
    return True


@stage
def _copy(m, out):
    for i in range(3):
        for j in range(3):
            out[i, j] = m[i, j]


@stage
def _multiply(a, b, sign, out):
    """out += sign a b, 3 x 3."""
    for i in range(3):
        for j in range(3):
            out[i, j] += sign * (a[i, 0] * b[0, j] + a[i, 1] * b[1, j] + a[i, 2] * b[2, j])


@stage
def _apply(a, x, sign, out):
    """out += sign a x, 3 x 3 times 3."""
    for i in range(3):
        out[i] += sign * (a[i, 0] * x[0] + a[i, 1] * x[1] + a[i, 2] * x[2])


@kernel
def condense_lines(model, diagonal, above, below, load, c, a, g, ends, end_load, work):
    """Condense every line: ends (lines, 2, 2, 3, 3) is the stiffness between its ends A, B; end_load (lines, 2, 3) the loads on them.

    load (3, n): out-of-balance forces. c, a (n, 3, 3) and g (n, 3) keep the elimination for `spread`. work: (6, 3, 3).
    Returns False when a block is singular.
    """
    pivot, inverse, p, q, t = work[0], work[1], work[2], work[3], work[4]
    first_load = work[5, 0]
    for line in range(model.first_node.size):
        start, count = model.first_node[line], model.segments[line]
        stop = start + count
        ends[line] = 0.0
        _copy(diagonal[start], ends[line, 0, 0])
        _copy(diagonal[stop], ends[line, 1, 1])
        for k in range(3):
            end_load[line, 0, k] = load[k, start]
            end_load[line, 1, k] = load[k, stop]
        if count == 1:
            _copy(above[start], ends[line, 0, 1])
            _copy(below[stop], ends[line, 1, 0])
            continue
        for i in range(start + 1, stop):
            _copy(diagonal[i], pivot)
            for k in range(3):
                g[i, k] = load[k, i]
            t[:] = 0.0
            if i == start + 1:
                _copy(below[i], t)
            else:
                _multiply(below[i], c[i - 1], -1.0, pivot)
                _multiply(below[i], a[i - 1], -1.0, t)
                _apply(below[i], g[i - 1], -1.0, g[i])
            if not _inverse(pivot, inverse):
                return False
            a[i] = 0.0
            _multiply(inverse, t, 1.0, a[i])
            c[i] = 0.0
            _multiply(inverse, above[i], 1.0, c[i])
            for k in range(3):
                first_load[k] = g[i, k]
                g[i, k] = 0.0
            _apply(inverse, first_load, 1.0, g[i])
        last = stop - 1
        _multiply(below[stop], c[last], -1.0, ends[line, 1, 1])
        _multiply(below[stop], a[last], -1.0, ends[line, 1, 0])
        _apply(below[stop], g[last], -1.0, end_load[line, 1])
        # the first interior node in terms of the ends: x_1 = G - p x_B - q x_A
        _copy(c[start + 1], p)
        _copy(a[start + 1], q)
        for k in range(3):
            first_load[k] = g[start + 1, k]
        for i in range(start + 2, stop):
            _apply(p, g[i], -1.0, first_load)
            _multiply(p, a[i], -1.0, q)
            t[:] = 0.0
            _multiply(p, c[i], -1.0, t)
            _copy(t, p)
        _multiply(above[start], q, -1.0, ends[line, 0, 0])
        _multiply(above[start], p, -1.0, ends[line, 0, 1])
        _apply(above[start], first_load, -1.0, end_load[line, 0])
    return True


@kernel
def spread(model, c, a, g, end_move, move):
    """Moves of all line nodes, move (3, n), from those of the ends, end_move (E, 3)."""
    for line in range(model.first_node.size):
        start, count = model.first_node[line], model.segments[line]
        stop = start + count
        for k in range(3):
            move[k, start] = end_move[2 * line, k]
            move[k, stop] = end_move[2 * line + 1, k]
        for i in range(stop - 1, start, -1):
            for k in range(3):
                total = g[i, k]
                for m in range(3):
                    total -= c[i, k, m] * move[m, i + 1] + a[i, k, m] * end_move[2 * line, m]
                move[k, i] = total
