"""Lines that part from what holds them while the mooring moves: at a time, or at a tension.

As in MoorDyn, the lines that a failure names stay together: their ends go over to one free point, which is reserved for it and holds
nothing before. A failure happens once. What has parted already, by another failure or because it was let go of, is left alone.
"""

from typing import NamedTuple

import numpy as np

from .cache import kernel
from .packed import packed


@packed
class Failures(NamedTuple):
    """What may part, (F,); every array has size 0 when nothing may. Ends are counted as in Model: end A and end B of each line in turn."""

    point: np.ndarray  # index of the point that is parted from
    reserved: np.ndarray  # index of the free point that the ends go over to
    time: np.ndarray  # s, inf: at none
    tension: np.ndarray  # N, inf: at none
    first_end: np.ndarray  # (F + 1,) first of each in `ends`
    ends: np.ndarray  # indices of the ends


def build_failures(rows):
    """Failures from a list of (point, reserved point, [ends], time in s, tension in N)."""
    return Failures(
        point=np.array([row[0] for row in rows], dtype=np.int64),
        reserved=np.array([row[1] for row in rows], dtype=np.int64),
        time=np.array([row[3] for row in rows], dtype=float),
        tension=np.array([row[4] for row in rows], dtype=float),
        first_end=np.cumsum([0] + [len(row[2]) for row in rows]).astype(np.int64),
        ends=np.array([end for row in rows for end in row[2]], dtype=np.int64),
    )


def failure_rows(failures, lines, point_of_holder, first_reserved):
    """Rows for `build_failures` from the scene's failures and lines.

    `point_of_holder`: index of the point of each holder (a point's id, or a rod's end); `first_reserved`: index of the point reserved for
    the first failure, the others follow. Of a line with both ends at the holder both part.
    """
    rows = []
    for k, failure in enumerate(failures):
        ends = [
            2 * index + end
            for index, line in enumerate(lines)
            if line.id in failure.lines
            for end, holder in enumerate((line.end_a, line.end_b))
            if holder == failure.holder
        ]
        rows.append((point_of_holder[failure.holder], first_reserved + k, ends, failure.time, failure.tension))
    return rows


@kernel
def part(failures, time, tension, end_point, end_node, position, velocity, point_node, failed):
    """Let go of what must part at `time` (s) with the segments' `tension` (n,), N; returns how many failures there were.

    Changes `end_point` (E,), and gives the reserved point's node the motion of what held the ends: `position`, `velocity` (3, n), m, m/s.
    `failed` (F,): 1 for a failure that has happened.
    """
    count = 0
    for f in range(failures.point.size):
        if failed[f] != 0:
            continue
        held, due = False, time >= failures.time[f]
        for k in range(failures.first_end[f], failures.first_end[f + 1]):
            e = failures.ends[k]
            if end_point[e] == failures.point[f]:
                held = True
                segment = end_node[e] + 1 - e % 2
                due = due or tension[segment] > failures.tension[f]
        if not (held and due):
            continue
        for k in range(failures.first_end[f], failures.first_end[f + 1]):
            e = failures.ends[k]
            if end_point[e] == failures.point[f]:
                end_point[e] = failures.reserved[f]
        old, new = point_node[failures.point[f]], point_node[failures.reserved[f]]
        for i in range(3):
            position[i, new] = position[i, old]
            velocity[i, new] = velocity[i, old]
        failed[f] = 1
        count += 1
    return count
