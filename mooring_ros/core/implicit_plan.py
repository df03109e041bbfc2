"""Where everything of the implicit solver's equations goes: a sparse matrix of 3 x 3 blocks, its elimination found once.

Unknowns are the threes of freedom.py. They are eliminated in an order of least fill, so that lines are condensed onto the free points,
rods and bodies that they end at, whatever the mooring's shape. What rides on a part has no unknowns of its own: blocks of such nodes are
gathered in places of their own and handed on to the part's place and turn, by the nodes' arms.
"""

from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from .bending_tangent import bending_pattern
from .freedom import NO_ARM, Freedom
from .layout import POINT_RIDING
from .model import LOOSE
from .packed import packed

NOWHERE = -1


@packed
class Plan(NamedTuple):
    """T threes in the order of elimination, S places for blocks: those of the matrix with its fill, of riding nodes, and one for the rest."""

    # elimination: pivot k has its diagonal block at base[k] and, of its m-th neighbour, that below at base + 1 + 2 m, that beside at base + 2 + 2 m
    base: np.ndarray  # (T + 1,)
    first_neighbour: np.ndarray  # (T + 1,)
    neighbour: np.ndarray  # (N,) threes eliminated later
    first_update: np.ndarray  # (T + 1,)
    update: np.ndarray  # (U,) where products of each pair of neighbours go, row by row
    places: int  # blocks of the matrix
    riding_places: int  # blocks of riding nodes, after them
    # nodes, (n,)
    node_three: np.ndarray  # three of a node that stands for itself, or NOWHERE
    node_block: np.ndarray  # place of (i, i)
    segment_block: np.ndarray  # (n, 4) of the nodes beside segment i: places of (i - 1, i - 1), (i, i), (i - 1, i), (i, i - 1)
    own_node: np.ndarray  # (O,) nodes with their own equation of motion
    own_three: np.ndarray  # (O,)
    point_three: np.ndarray  # (free points,) in their order
    # rigid parts
    part_block: np.ndarray  # (B, 4): places of (place, place), (place, turn), (turn, place), (turn, turn)
    part_three: np.ndarray  # (B,) of the place; turns stand in turn_three
    turn_three: np.ndarray  # (B,)
    rider: np.ndarray  # (R,) nodes
    rider_part: np.ndarray  # (R,)
    rider_of: np.ndarray  # (n,) index in `rider`, or NOWHERE
    part_moves: np.ndarray  # (B,) 0 for a pinned one, which only turns
    # handing on what riding nodes have gathered, (X,)
    source: np.ndarray
    target: np.ndarray
    left: np.ndarray  # rider whose arm stands on the left, or NOWHERE
    right: np.ndarray
    # bending
    hinge: np.ndarray  # (H,) nodes, those of BendingPattern
    rows: np.ndarray  # (b,) and so on
    cols: np.ndarray
    bent_block: np.ndarray  # (b,)
    clamp_block: np.ndarray  # (C, 4) end node with the turn, next node with the turn, and transposed; NOWHERE for clamps that no part turns
    scale: np.ndarray  # (T,) N: what the out-of-balance force is measured by


class Topology(NamedTuple):
    """A Plan, and how the ends were held when it was made."""

    plan: Plan
    end_point: np.ndarray


def make_topology(model, state, force_scale):
    """Topology of `model` with its ends held as `state.end_point` says; force_scale: (n,) N of the nodes."""
    free = Freedom(model, state)
    following = free.following
    count, n = free.count // 3, model.mass.size
    alone = (following.arm == NO_ARM) & (following.three < free.own // 3)
    node_three = np.full(n, NOWHERE)
    node_three[following.node[alone]] = following.three[alone]
    turn, rider = free.turned_threes()
    part = (turn - free.own // 3) // 2
    virtual = np.full(n, NOWHERE)
    virtual[rider] = count + np.arange(rider.size)
    label = np.where(node_three >= 0, node_three, virtual)

    places = _Places(count, label, rider, part, turn, free)
    nodes = np.arange(n)
    node_pairs = places.ask(nodes, nodes)
    live = np.flatnonzero(model.live > 0.0)
    segment_pairs = np.full((n, 4), NOWHERE)
    for column, (row, col) in enumerate(((live - 1, live - 1), (live, live), (live - 1, live), (live, live - 1))):
        segment_pairs[live, column] = places.ask(row, col)
    pattern = bending_pattern(model.bending)
    bent_pairs = places.ask(pattern.rows, pattern.cols)
    clamp_pairs = np.full((model.clamps.part.size, 4), NOWHERE)
    if pattern.rows.size:
        for c in np.flatnonzero(model.clamps.part >= 0):
            segment, sign = model.bending.clamp_segment[c], model.bending.clamp_sign[c]
            pair = label[[segment - 1, segment]] if sign > 0.0 else label[[segment, segment - 1]]
            about = np.full(2, free.turn_of(model.clamps, c))
            clamp_pairs[c] = np.concatenate([places.ask_labels(pair, about), places.ask_labels(about, pair)])
    where = free.own // 3 + 2 * np.arange(free.parts)
    part_pairs = np.stack([places.ask_labels(where + a, where + b) for a, b in ((0, 0), (0, 1), (1, 0), (1, 1))], axis=1)

    found = places.settle()
    order = found["order"]
    slaved = state.slaved.astype(bool)
    own = np.flatnonzero((node_three >= 0) & ~slaved)
    scale = np.zeros(count)
    np.maximum.at(scale, node_three[node_three >= 0], force_scale[node_three >= 0])
    reach = np.full(free.parts, 1e-3)
    np.maximum.at(reach, part, np.linalg.norm(model.point_place[_points_of(model, state, rider)], axis=1))
    heaviest = np.full(free.parts, 0.0)
    np.maximum.at(heaviest, part, force_scale[rider])
    scale[where], scale[where + 1] = heaviest, heaviest * reach
    scale = np.maximum(scale, 1e-6 * max(scale.max(initial=0.0), 1e-6))
    ordered_scale = np.empty(count)
    ordered_scale[order] = scale

    def ordered(threes):
        return np.where(threes >= 0, order[np.maximum(threes, 0)], NOWHERE) if count else threes

    place = found["place"]
    plan = Plan(
        base=found["base"],
        first_neighbour=found["first_neighbour"],
        neighbour=found["neighbour"],
        first_update=found["first_update"],
        update=found["update"],
        places=found["places"],
        riding_places=found["riding_places"],
        node_three=ordered(node_three),
        node_block=place(node_pairs),
        segment_block=np.ascontiguousarray(place(segment_pairs)),
        own_node=own,
        own_three=ordered(node_three[own]),
        point_three=ordered(node_three[model.point_node[model.free_points]]),
        part_block=np.ascontiguousarray(place(part_pairs).reshape(-1, 4)),
        part_three=ordered(where),
        turn_three=ordered(where + 1),
        rider=rider,
        rider_part=part,
        rider_of=np.where(virtual >= 0, virtual - count, NOWHERE),
        part_moves=(model.rigid.pin < 0).astype(np.int64),
        source=found["source"],
        target=found["target"],
        left=found["left"],
        right=found["right"],
        hinge=pattern.hinge,
        rows=pattern.rows,
        cols=pattern.cols,
        bent_block=place(bent_pairs),
        clamp_block=np.ascontiguousarray(place(clamp_pairs).reshape(-1, 4)),
        scale=ordered_scale,
    )
    return Topology(plan, state.end_point.copy())


def _points_of(model, state, nodes):
    """Points that carry `nodes`, each its own or that of the end it is."""
    held = np.flatnonzero(state.end_point != LOOSE)
    riding = held[model.point_kind[state.end_point[held]] == POINT_RIDING]
    point = dict(zip(model.point_node, range(model.point_node.size))) | dict(zip(model.end_node[riding], state.end_point[riding]))
    return np.array([point[node] for node in nodes], dtype=np.int64)


class _Places:
    """Collects pairs of nodes, or of labels (threes, then riders), whose blocks are needed; `settle` gives each a place."""

    def __init__(self, count, label, rider, part, turn, free):
        self.count, self.label = count, label
        self._width = count + rider.size
        self._pairs = []
        self._asked = 0
        pinned = set(free.own // 3 + 2 * int(b) for b in np.flatnonzero(free.model.rigid.pin >= 0))
        self._follows = [
            [(three, arm) for three, arm in ((int(t) - 1, NOWHERE), (int(t), r)) if three not in pinned] for r, t in enumerate(turn)
        ]

    def ask(self, rows, cols):
        """Numbers (k,) of the pairs of nodes, NOWHERE for those with one that does not move."""
        return self.ask_labels(self.label[rows], self.label[cols])

    def ask_labels(self, rows, cols):
        rows, cols = np.asarray(rows), np.asarray(cols)
        moving = (rows >= 0) & (cols >= 0)
        numbers = np.full(rows.shape, NOWHERE)
        numbers[moving] = self._asked + np.arange(moving.sum())
        self._asked += int(moving.sum())
        self._pairs.append((rows * self._width + cols)[moving])
        return numbers

    def settle(self):
        keys = np.concatenate(self._pairs) if self._pairs else np.zeros(0, dtype=np.int64)
        unique, inverse = np.unique(keys, return_inverse=True)
        rows, cols = unique // max(self._width, 1), unique % max(self._width, 1)
        real = (rows < self.count) & (cols < self.count)
        riding = np.flatnonzero(~real)
        handed = []  # (riding pair, row, col, left, right)
        for number, k in enumerate(riding):
            for row, left in self._followed(int(rows[k])):
                for col, right in self._followed(int(cols[k])):
                    handed.append((number, row, col, left, right))
        handed = np.array(handed, dtype=np.int64).reshape(-1, 5)
        all_rows = np.concatenate([rows[real], handed[:, 1], np.arange(self.count)])
        all_cols = np.concatenate([cols[real], handed[:, 2], np.arange(self.count)])
        order = _least_fill(self.count, all_rows, all_cols)
        found = _eliminate(self.count, order[all_rows] if self.count else all_rows, order[all_cols] if self.count else all_cols)
        places, at = found["places"], found.pop("at")
        spare = places + riding.size
        by_pair = np.empty(unique.size, dtype=np.int64)
        by_pair[real] = at(order[rows[real]], order[cols[real]]) if real.any() else 0
        by_pair[riding] = places + np.arange(riding.size)
        by_number = np.append(by_pair[inverse], spare) if keys.size else np.array([spare])

        def place(numbers):
            return by_number[np.where(np.asarray(numbers) >= 0, numbers, -1)].astype(np.int64)

        target = at(order[handed[:, 1]], order[handed[:, 2]]) if handed.size else np.zeros(0, dtype=np.int64)
        found.update(
            order=order,
            place=place,
            riding_places=int(riding.size),
            source=places + handed[:, 0],
            target=target,
            left=np.ascontiguousarray(handed[:, 3]),
            right=np.ascontiguousarray(handed[:, 4]),
        )
        return found

    def _followed(self, label):
        return self._follows[label - self.count] if label >= self.count else [(label, NOWHERE)]


def _least_fill(count, rows, cols):
    """Position (count,) of each three in an order of elimination with little fill."""
    if not count:
        return np.zeros(0, dtype=np.int64)
    graph = sparse.csc_matrix((np.ones(rows.size), (rows, cols)), shape=(count, count))
    graph = graph + graph.T
    graph.data[:] = -1.0
    graph.setdiag(np.diff(graph.indptr) + 1.0)
    factors = splu(sparse.csc_matrix(graph), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return factors.perm_c.astype(np.int64)


def _eliminate(count, rows, cols):
    """Blocks with their fill when threes are eliminated by number; a dict of the fields of Plan, and `at` (rows, cols) -> places."""
    later = [set() for _ in range(count)]
    for row, col in set(zip(rows.tolist(), cols.tolist())):
        if row != col:
            later[min(row, col)].add(max(row, col))
    neighbours = []
    for k in range(count):
        after = sorted(later[k])
        neighbours.append(after)
        if after:
            later[after[0]].update(after[1:])  # the rest of the fill follows when that one is eliminated
    sizes = np.array([len(after) for after in neighbours], dtype=np.int64)
    base = np.concatenate([[0], np.cumsum(1 + 2 * sizes)]).astype(np.int64)
    index = {(k, j): m for k, after in enumerate(neighbours) for m, j in enumerate(after)}

    def one(row, col):
        if row == col:
            return base[row]
        first, second = min(row, col), max(row, col)
        return base[first] + 1 + 2 * index[first, second] + (row < col)

    update = [one(i, j) for after in neighbours for i in after for j in after]
    return {
        "base": base,
        "first_neighbour": np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64),
        "neighbour": np.array([j for after in neighbours for j in after], dtype=np.int64),
        "first_update": np.concatenate([[0], np.cumsum(sizes**2)]).astype(np.int64),
        "update": np.array(update, dtype=np.int64),
        "places": int(base[-1]),
        "at": lambda rows, cols: np.array([one(row, col) for row, col in zip(rows.tolist(), cols.tolist())], dtype=np.int64),
    }
