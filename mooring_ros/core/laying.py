"""Where lines lie before anything pulls at them: what `stick` remembers when statics begin.

Statics with friction depend on how the lines came to lie. Here each is laid straight, without tension, from its anchor towards what holds
its other end, so that pulling it tight mobilises friction towards the anchor from the pulled end on.
"""

from collections import deque
from itertools import combinations
from typing import NamedTuple

import numpy as np

from .bed import bed_level
from .ground import NO_CONTACT, SLIDING
from .layout import POINT_COUPLED, POINT_FIXED
from .model import LOOSE

SAMPLES = 4  # of the bed's profile for each segment


class _Edge(NamedTuple):
    """A line as a way from one point to the other, or a link without nodes."""

    key: int
    points: tuple  # ids of the points at both ends, LOOSE where nothing holds
    ends: tuple  # (3,) places of the ends, m
    nodes: np.ndarray  # from the first end to the second
    arc: np.ndarray  # (nodes,), m from the first end
    length: float  # m


def lay(ground, model, end_point, position, grip):
    """Set grip (4, n) to the as-laid places of all nodes of lines that begin at an anchor; to no contact for all others.

    `end_point` (E,) says what holds the lines' ends, `position` (3, n) where the points stand. A node lies at its unstretched length along
    the bed's profile. Lines that follow each other through free points and rigid parts lie in a row; what lies between two anchors is laid
    from both to its middle. Nodes count as sliding: pulled tight, a line keeps the friction that it slid with.
    """
    grip[3] = NO_CONTACT
    edges = _edges(model, end_point, position)
    at = {}
    for edge in edges:
        for point in edge.points:
            at.setdefault(point, []).append(edge)
    at.pop(LOOSE, None)
    place = {p: position[:, node] for p, node in enumerate(model.point_node)}
    done = set()
    waiting = deque((p, place[p]) for p in sorted(at) if model.point_kind[p] == POINT_FIXED)
    while waiting:
        point, start = waiting.popleft()
        for edge in at[point]:
            if edge.key not in done:
                row = _row_from(edge, point, at, done, model)
                done.update(step.key for step, _ in row)
                waiting.extend(_lay_row(ground, model, row, start, place, grip))


def move_to_laid(model, bed, position, grip):
    """Move nodes that touch the bed to where they were laid, as deep as they are, and what hangs between them along with them.

    A start for statics with friction: where lines lie without it may be far from there, downhill. `bed` is that of the positions.
    """
    moves = grip[:3] - position
    moves[2] += position[2] - bed[0]
    lies = (grip[3] != NO_CONTACT) & (position[2] < bed[0])
    for first, count in zip(model.first_node, model.segments):
        nodes = np.arange(first, first + count + 1)
        known = lies[nodes]
        moves[:, nodes[~known]] = 0.0
        known[[0, -1]] = True
        for k in range(3):
            position[k, nodes] += np.interp(nodes, nodes[known], moves[k, nodes[known]])
    for node in model.point_node[model.free_points]:
        if lies[node]:
            position[:, node] += moves[:, node]


def _edges(model, end_point, position):
    """Lines, and links between the points of a rigid part that hold lines or the part itself."""
    edges = []
    for line, (first, count) in enumerate(zip(model.first_node, model.segments)):
        nodes = np.arange(first, first + count + 1)
        arc = np.concatenate([[0.0], np.cumsum(model.length[first + 1 : first + count + 1])])
        points = (int(end_point[2 * line]), int(end_point[2 * line + 1]))
        edges.append(_Edge(len(edges), points, (position[:, nodes[0]], position[:, nodes[-1]]), nodes, arc, arc[-1]))
    part, place = model.rigid.part.copy(), model.point_place.copy()
    for index, pin in enumerate(model.rigid.pin):
        if pin >= 0:
            part[pin], place[pin] = index, 0.0
    for pair in combinations(np.unique(end_point[end_point != LOOSE]).tolist() + [int(p) for p in model.rigid.pin if p >= 0], 2):
        if pair[0] != pair[1] and part[pair[0]] == part[pair[1]] >= 0:
            ends = tuple(position[:, model.point_node[p]] for p in pair)
            length = float(np.linalg.norm(place[pair[1]] - place[pair[0]]))
            edges.append(_Edge(len(edges), pair, ends, np.zeros(0, dtype=np.int64), np.zeros(0), length))
    return edges


def _held(model, point):
    return point == LOOSE or model.point_kind[point] in (POINT_FIXED, POINT_COUPLED)


def _row_from(edge, point, at, done, model):
    """The shortest way from `point` along `edge` through free points and parts to one that is held: list of (edge, which end comes first)."""
    waiting, seen, row = deque([[(edge, edge.points.index(point))]]), {point}, []
    while waiting:
        row = waiting.popleft()
        last, first = row[-1]
        far = last.points[1 - first]
        if _held(model, far):
            return row
        if far not in seen:
            seen.add(far)
            waiting.extend(row + [(next_, next_.points.index(far))] for next_ in at[far] if next_.key not in done and next_.key != last.key)
    return row


def _lay_row(ground, model, row, start, place, grip):
    """Lay lines in a row from `start` (3,) on; returns (point, where it lies) of the free points on the way."""
    last, first = row[-1]
    far = last.points[1 - first]
    target = place[far] if far != LOOSE else last.ends[1 - first]
    total = sum(edge.length for edge, _ in row)
    along = _profile(ground, start, target, total, row)
    if along is None:
        return []
    back = None
    if far != LOOSE and model.point_kind[far] == POINT_FIXED:
        back = _profile(ground, target, start, total, row)
    passed, points = 0.0, []
    for edge, first in row:
        arc = passed + (edge.arc if first == 0 else edge.length - edge.arc)
        _lie(along, arc, edge.nodes, grip)
        if back is not None:
            beyond = arc > 0.5 * total
            _lie(back, total - arc[beyond], edge.nodes[beyond], grip)
        passed += edge.length
        point = edge.points[1 - first]
        if not _held(model, point):
            node, arc = np.array([model.point_node[point]]), np.array([passed])
            if back is not None and passed > 0.5 * total:
                _lie(back, total - arc, node, grip)
            else:
                _lie(along, arc, node, grip)
            points.append((point, grip[:3, node[0]].copy()))
    return points


class _Profile(NamedTuple):
    """The bed along a heading: the way on it (m) and places (3, samples); `height` (m) is the start's above it."""

    way: np.ndarray
    places: np.ndarray
    height: float


def _profile(ground, start, target, length, row):
    heading = np.asarray(target)[:2] - start[:2]
    distance = np.hypot(*heading)
    if not distance > 0.0:
        return None  # straight above: no direction to lie in
    samples = 1 + SAMPLES * sum(max(edge.nodes.size, 1) for edge, _ in row)
    plan = np.linspace(0.0, length, samples)
    x, y = (start[k] + plan * heading[k] / distance for k in (0, 1))
    z = bed_level(ground, x, y)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(plan), np.diff(z)))])
    return _Profile(way, np.array([x, y, z]), max(start[2] - z[0], 0.0))


def _lie(profile, arc, nodes, grip):
    """A line from above the bed hangs down to it first."""
    on_bed = arc >= profile.height
    way = np.sqrt(np.maximum(arc**2 - profile.height**2, 0.0))
    for k in range(3):
        grip[k, nodes] = np.interp(way, profile.way, profile.places[k])
    grip[3, nodes] = np.where(on_bed, SLIDING, NO_CONTACT)
