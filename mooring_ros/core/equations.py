"""The linear equations of the statics: stiffness between the unknowns (freedom.py), K = T' K_nodes T and the turning of arms under load.

Where each 3 x 3 block of the nodes goes is found once; an iteration only multiplies blocks by arms where there are any, and adds up. The
unknowns are numbered so that the matrix has a narrow band, as lines have by themselves.
"""

import numpy as np
from scipy import sparse
from scipy.linalg.lapack import dgbsv
from scipy.sparse.csgraph import reverse_cuthill_mckee
from scipy.sparse.linalg import splu

from .freedom import NO_ARM, skews
from .platform import rotate

WIDEST = 60  # half band, unknowns: beyond it a sparse factorisation is quicker
SPIN_TRACE = 1e-12  # of a part's largest stiffness, or of the line's weight at 1 m: above rounding, below anything that holds a part


class Equations:
    """Stiffness between the unknowns of a Freedom, with or without the platforms', assembled from blocks.

    pattern: BendingPattern. weight: N, for the trace of stiffness against spins that nothing resists, as of a rod about its axis.
    """

    def __init__(self, model, freedom, pattern, weight, platform=False):
        self._freedom, self._platform, self._weight = freedom, platform, weight
        n, count = model.mass.size, freedom.count // 3 + 2 * platform * model.reach.size
        following = freedom.with_platform if platform else freedom.following
        turned, nodes = freedom.turned_threes(platform)
        self._turned_nodes, parts = nodes, (turned - freedom.own // 3) // 2
        self._slender_arms = np.where(parts < freedom.parts, parts, freedom.parts)
        clamps = [(c, freedom.turn_of(model.clamps, c)) for c in range(model.clamps.part.size)] if pattern.rows.size else []
        clamps = [(c, three) for c, three in clamps if three is not None and three < count]
        self._clamps = np.array([c for c, _ in clamps], dtype=np.int64)
        self._clamp_parts = np.where(model.clamps.part[self._clamps] >= 0, model.clamps.part[self._clamps], freedom.parts)
        axes = n + np.array([three for _, three in clamps], dtype=np.int64)  # threes themselves count as nodes from n on
        segment, right = model.bending.clamp_segment[self._clamps], model.bending.clamp_sign[self._clamps] > 0.0
        ends = np.stack([np.where(right, segment - 1, segment), np.where(right, segment, segment - 1)], axis=1).ravel()
        middle = np.repeat(np.arange(n), 3)
        beside = np.clip(middle + np.tile([-1, 0, 1], n), 0, n - 1)
        twice = np.repeat(axes, 2)
        rows = np.concatenate([middle, pattern.rows, ends, twice, axes, n + turned])
        cols = np.concatenate([beside, pattern.cols, twice, ends, axes, n + turned])
        self._expand(rows, cols, following, n, count)
        self._order(count)

    def _expand(self, rows, cols, following, n, count):
        """Each block of nodes goes to every pair of threes that these follow: (block, three, three, arm, arm)."""
        node = np.concatenate([following.node, n + np.arange(count)])
        three = np.concatenate([following.three, np.arange(count)])
        arm = np.concatenate([following.arm, np.full(count, NO_ARM)])
        order = np.argsort(node, kind="stable")
        three, arm = three[order], arm[order]
        followed = np.bincount(node, minlength=n + count)
        first = np.cumsum(followed) - followed
        pairs = followed[rows] * followed[cols]
        self._block = np.repeat(np.arange(rows.size), pairs)
        among = np.arange(self._block.size) - np.repeat(np.cumsum(pairs) - pairs, pairs)
        width = followed[cols[self._block]]
        left, right = first[rows[self._block]] + among // width, first[cols[self._block]] + among % width
        self._rows, self._cols = three[left], three[right]
        self._left, self._right = np.flatnonzero(arm[left] != NO_ARM), np.flatnonzero(arm[right] != NO_ARM)
        self._left_arm, self._right_arm = arm[left][self._left], arm[right][self._right]

    def _order(self, count):
        """Where the blocks' numbers stand in the band, or in the columns of a sparse matrix."""
        self._place = np.arange(count)
        if count:
            graph = sparse.csr_matrix((np.ones(self._rows.size), (self._rows, self._cols)), shape=(count, count))
            self._place[reverse_cuthill_mckee(graph, symmetric_mode=True)] = np.arange(count)
        rows, cols, size = self._place[self._rows], self._place[self._cols], 3 * count
        self._band = 3 * int(np.abs(rows - cols).max(initial=0)) + 2
        k = np.arange(3)
        row, col = (3 * rows[:, None, None] + k[:, None]), (3 * cols[:, None, None] + k)
        self._unknown = (3 * self._place[:, None] + k).ravel()
        turns = self._unknown.reshape(-1, 3)[self._freedom.own // 3 + 1 + 2 * np.arange(self._freedom.parts)]
        still = self._unknown.reshape(-1, 3)[np.flatnonzero(~self._freedom.kept)].ravel()
        if self._band <= WIDEST:
            self._height = 3 * self._band + 1
            self._size = size * self._height

            def place(row, col):
                return col * self._height + 2 * self._band + row - col
        else:
            self._filled = np.unique(np.concatenate([(col * size + row).ravel(), still * (size + 1)]))
            self._size = self._filled.size
            self._columns = np.searchsorted(self._filled, np.arange(size + 1) * size)

            def place(row, col):
                return np.searchsorted(self._filled, col * size + row)

        self._at, self._still = place(row, col).ravel(), place(still, still)
        self._turns = place(turns[:, :, None], turns[:, None, :])

    def _values(self, state, blocks, bent, turn, axis):
        """(k, 3, 3) of all blocks."""
        free, all_blocks = self._freedom, [blocks.reshape(-1, 3, 3), bent]
        if self._clamps.size:
            turns = turn[self._clamps].reshape(-1, 3, 3)
            held = axis[self._clamps] + 0.5 * skews(state.clamp_moment[self._clamps])  # turns do not commute: a moment's change is no second derivative
            all_blocks += [turns, turns.transpose(0, 2, 1), held - self._spin_of(state)[self._clamp_parts] @ held]
        if self._turned_nodes.size:
            arms = skews(free.arms(state, self._platform))
            turning = -skews(state.force.T[self._turned_nodes]) @ arms  # d(r x F) = (d theta x r) x F
            all_blocks.append(turning - self._spin_of(state)[self._slender_arms] @ turning)
        values = (np.concatenate(all_blocks) if len(bent) or len(all_blocks) > 2 else all_blocks[0])[self._block]
        if self._turned_nodes.size:
            values[self._left] = arms[self._left_arm] @ values[self._left]
            values[self._right] = values[self._right] @ -arms[self._right_arm]
        return values

    def _spin_of(self, state):
        """(parts + 1, 3, 3): u u' of the axis u about which a slender part spins, else and last null."""
        free = self._freedom
        spins = np.zeros((free.parts + 1, 3, 3))
        for b, axis in zip(free.slender, free.slender_axis):
            u = np.array(rotate(state.parts[b, 3:7], axis))
            spins[b] = np.outer(u, u)
        return spins

    def _held(self, largest, spin):
        """Stiffness (..., 3, 3) of turns that nothing else resists, about a slender part's axis all of it; `largest`: of the part's own."""
        return SPIN_TRACE * np.maximum(largest, self._weight) * np.eye(3) + largest * spin

    def _assemble(self, state, *blocks):
        data = np.bincount(self._at, self._values(state, *blocks).ravel(), self._size)
        if self._turns.size:
            largest = np.abs(data[self._turns]).max(axis=(1, 2), keepdims=True)
            data[self._turns] += self._held(largest, self._spin_of(state)[:-1])
        data[self._still] = 1.0
        return data

    def solve(self, load, state, *blocks):
        """Step (count,) of the unknowns under `load`, or None when the system is singular.

        blocks: those of the nodes with left neighbour, itself, right one (n, 3, 3, 3), and of bending: between nodes (b, 3, 3), between
        nodes and clamps (C, 2, 3, 3), of the clamps' turns (C, 3, 3).
        """
        step = np.zeros(self._unknown.size)
        if not step.size:
            return step
        data = self._assemble(state, *blocks)
        right = np.empty(step.size)
        right[self._unknown] = load
        if self._band <= WIDEST:
            matrix = data.reshape(-1, self._height).T
            *_, answer, failed = dgbsv(self._band, self._band, matrix, right, overwrite_ab=True, overwrite_b=True)
            if failed:
                return None
        else:
            matrix = sparse.csc_matrix((data, self._filled % step.size, self._columns), shape=(step.size, step.size))
            try:
                answer = splu(matrix).solve(right)
            except RuntimeError:  # exactly singular
                return None
        return answer[self._unknown] if np.isfinite(answer).all() else None

    def matrix(self, state, *blocks):
        """The matrix, sparse, unknowns in the order of the Freedom; of what does not move rows and columns are null."""
        k = np.arange(3)
        values = self._values(state, *blocks)
        row, col = np.broadcast_arrays(3 * self._rows[:, None, None] + k[:, None], 3 * self._cols[:, None, None] + k)
        total = sparse.csr_matrix((values.ravel(), (row.ravel(), col.ravel())), shape=(self._unknown.size,) * 2)
        held = sparse.lil_matrix(total.shape)
        for b, spin in enumerate(self._spin_of(state)[:-1]):
            turns = slice(self._freedom.own + 6 * b + 3, self._freedom.own + 6 * b + 6)
            held[turns, turns] = self._held(abs(total[turns, turns]).max(), spin)
        return total + held.tocsr()
