"""Solution of the implicit solver's linear equations: elimination of 3 x 3 blocks in the order of a Plan.

Inertia over the square of the step stands on the diagonal, so that rows need not be exchanged; a block that cannot be inverted is told.
"""

import numpy as np

from .cache import routine, stage

SOLVED, SINGULAR = 0, 1
FLAT = 1e-14  # of the product of a block's columns: a determinant that is none


@stage
def _invert(values, k):
    """Put the inverse of block k in its place; False when it has none."""
    a, b, c = values[k, 0], values[k, 1], values[k, 2]
    d, e, f = values[k, 3], values[k, 4], values[k, 5]
    g, h, i = values[k, 6], values[k, 7], values[k, 8]
    p, q, r = e * i - f * h, f * g - d * i, d * h - e * g
    determinant = a * p + b * q + c * r
    size = (abs(a) + abs(d) + abs(g)) * (abs(b) + abs(e) + abs(h)) * (abs(c) + abs(f) + abs(i))
    sound = abs(determinant) > FLAT * size and abs(determinant) < np.inf
    per = 1.0 / determinant if sound else 0.0
    values[k, 0], values[k, 1], values[k, 2] = per * p, per * (c * h - b * i), per * (b * f - c * e)
    values[k, 3], values[k, 4], values[k, 5] = per * q, per * (a * i - c * g), per * (c * d - a * f)
    values[k, 6], values[k, 7], values[k, 8] = per * r, per * (b * g - a * h), per * (a * e - b * d)
    return sound


@stage
def _times_in_place(values, k, d):
    """Block k times block d, in the place of k."""
    d0, d1, d2 = values[d, 0], values[d, 1], values[d, 2]
    d3, d4, d5 = values[d, 3], values[d, 4], values[d, 5]
    d6, d7, d8 = values[d, 6], values[d, 7], values[d, 8]
    for row in range(3):
        a, b, c = values[k, 3 * row], values[k, 3 * row + 1], values[k, 3 * row + 2]
        values[k, 3 * row] = a * d0 + b * d3 + c * d6
        values[k, 3 * row + 1] = a * d1 + b * d4 + c * d7
        values[k, 3 * row + 2] = a * d2 + b * d5 + c * d8


@stage
def _take_product(values, target, left, right):
    """Take left times right from target."""
    r0, r1, r2 = values[right, 0], values[right, 1], values[right, 2]
    r3, r4, r5 = values[right, 3], values[right, 4], values[right, 5]
    r6, r7, r8 = values[right, 6], values[right, 7], values[right, 8]
    for row in range(3):
        a, b, c = values[left, 3 * row], values[left, 3 * row + 1], values[left, 3 * row + 2]
        values[target, 3 * row] -= a * r0 + b * r3 + c * r6
        values[target, 3 * row + 1] -= a * r1 + b * r4 + c * r7
        values[target, 3 * row + 2] -= a * r2 + b * r5 + c * r8


@routine
def solve_blocks(plan, values, right):
    """Solve in place: values (S, 9), row by row; right (T, 3). Returns SOLVED or SINGULAR."""
    base, first, neighbour, update = plan.base, plan.first_neighbour, plan.neighbour, plan.update
    count = base.size - 1
    bad, at = 0, 0
    for k in range(count):
        pivot, begin = base[k], first[k]
        bad |= not _invert(values, pivot)
        x, y, z = right[k, 0], right[k, 1], right[k, 2]
        size = first[k + 1] - begin
        for m in range(size):
            below = pivot + 1 + 2 * m
            _times_in_place(values, below, pivot)
            j = neighbour[begin + m]
            right[j, 0] -= values[below, 0] * x + values[below, 1] * y + values[below, 2] * z
            right[j, 1] -= values[below, 3] * x + values[below, 4] * y + values[below, 5] * z
            right[j, 2] -= values[below, 6] * x + values[below, 7] * y + values[below, 8] * z
            for o in range(size):
                _take_product(values, update[at], below, pivot + 2 + 2 * o)
                at += 1
    for k in range(count - 1, -1, -1):
        pivot, begin = base[k], first[k]
        x, y, z = right[k, 0], right[k, 1], right[k, 2]
        for m in range(first[k + 1] - begin):
            beside, j = pivot + 2 + 2 * m, neighbour[begin + m]
            u, v, w = right[j, 0], right[j, 1], right[j, 2]
            x -= values[beside, 0] * u + values[beside, 1] * v + values[beside, 2] * w
            y -= values[beside, 3] * u + values[beside, 4] * v + values[beside, 5] * w
            z -= values[beside, 6] * u + values[beside, 7] * v + values[beside, 8] * w
        right[k, 0] = values[pivot, 0] * x + values[pivot, 1] * y + values[pivot, 2] * z
        right[k, 1] = values[pivot, 3] * x + values[pivot, 4] * y + values[pivot, 5] * z
        right[k, 2] = values[pivot, 6] * x + values[pivot, 7] * y + values[pivot, 8] * z
    return SINGULAR if bad != 0 else SOLVED
