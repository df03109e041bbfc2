"""What may move in the statics: unknowns, and how the nodes follow them.

Unknowns are three for every node of its own (inside lines, loose ends, free points with the ends that they hold) and six for every rigid
part (place and turn, world axes; a pinned part only turns); the platform's six follow as the last ones. The nodes' moves are T x to first
order, forces on the unknowns T' f, and the stiffness between them T' K T with the turning of arms under load.
"""

import numpy as np
from scipy import sparse

from .layout import POINT_COUPLED, POINT_FREE, POINT_RIDING
from .model import LOOSE


def skew(v):
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


class Freedom:
    """Unknowns of one model with its ends held as `state.end_point` says.

    count: unknowns, the platform's not included; own: those of nodes of their own.
    """

    def __init__(self, model, state):
        self.model = model
        self.parts = model.rigid.mass.size
        unknown = np.full(model.mass.size, -1)  # of each node, counted in threes
        own = 0
        for start, segments in zip(model.first_node, model.segments):
            unknown[start + 1 : start + segments] = np.arange(own, own + segments - 1)
            own += segments - 1
        for e in np.flatnonzero(state.end_point == LOOSE):
            unknown[model.end_node[e]] = own
            own += 1
        unknown[model.point_node[model.free_points]] = np.arange(own, own + model.free_points.size)
        self.own = 3 * (own + model.free_points.size)
        holder = self._holders(model, state)
        for node, p in holder:
            if model.point_kind[p] == POINT_FREE:
                unknown[node] = unknown[model.point_node[p]]
        self._nodes = np.flatnonzero(unknown >= 0)
        self._unknown = unknown[self._nodes]
        self._riders = [(node, model.rigid.part[p]) for node, p in holder if model.point_kind[p] == POINT_RIDING]
        self._coupled = [node for node, p in holder if model.point_kind[p] == POINT_COUPLED]
        self._pinned = [b for b in range(self.parts) if model.rigid.pin[b] >= 0]
        total = self.own + 6 * self.parts
        self.kept = np.ones(total, dtype=bool)
        for b in self._pinned:
            self.kept[self.own + 6 * b : self.own + 6 * b + 3] = False
        self.count = total
        n = 3 * model.mass.size
        rows = (3 * self._nodes[:, None] + np.arange(3)).ravel()
        columns = (3 * self._unknown[:, None] + np.arange(3)).ravel()
        self._simple = sparse.csr_matrix((np.ones(rows.size), (rows, columns)), shape=(n, total + 6))

    @staticmethod
    def _holders(model, state):
        """(node, internal point) of every node that a point carries: its own and those of the ends it holds."""
        pairs = [(int(node), p) for p, node in enumerate(model.point_node)]
        return pairs + [(int(node), int(p)) for node, p in zip(model.end_node, state.end_point) if p != LOOSE]

    @property
    def rigid(self):
        """Whether anything in the scene moves as a rigid part."""
        return self.parts > 0

    def _coupled_pin(self, b):
        pin = self.model.rigid.pin[b]
        return pin >= 0 and self.model.point_kind[pin] == POINT_COUPLED

    def follow(self, state, platform=False):
        """T (3n, count + 6), sparse, rows node by node: nodes on parts and (with `platform`) on the platform at their present arms."""
        if not (self.parts or platform):
            return self._simple
        entries = [(3 * node, self.own + 6 * b, self._arm_block(state.position[:, node] - state.parts[b, :3])) for node, b in self._riders]
        if platform:
            carried = [(node, state.position[:, node]) for node in self._coupled]
            carried += [(node, state.parts[b, :3]) for node, b in self._riders if self._coupled_pin(b)]
            entries += [(3 * node, self.count, self._arm_block(place - state.pose[:3])) for node, place in carried]
        if not entries:
            return self._simple
        rows = np.concatenate([np.repeat(np.arange(r, r + 3), 6) for r, _, _ in entries])
        columns = np.concatenate([np.tile(np.arange(c, c + 6), 3) for _, c, _ in entries])
        values = np.concatenate([block.ravel() for _, _, block in entries])
        return (self._simple + sparse.csr_matrix((values, (rows, columns)), shape=self._simple.shape)).tocsr()

    @staticmethod
    def _arm_block(arm):
        return np.hstack([np.eye(3), -skew(arm)])

    def turning(self, state, force, platform=False):
        """Sparse (count + 6, count + 6): stiffness of arms that turn under the nodes' `force` (3, n) while it stays, d(r x F) = (d theta x r) x F."""
        arms = [(self.own + 6 * b + 3, node, state.position[:, node] - state.parts[b, :3]) for node, b in self._riders]
        if platform:
            arms += [(self.count + 3, node, state.position[:, node] - state.pose[:3]) for node in self._coupled]
            arms += [(self.count + 3, node, state.parts[b, :3] - state.pose[:3]) for node, b in self._riders if self._coupled_pin(b)]
        total = sparse.lil_matrix((self.count + 6, self.count + 6))
        for at, node, arm in arms:
            total[at : at + 3, at : at + 3] += -skew(force[:, node]) @ skew(arm)
        return total.tocsr()

    def turn_of(self, clamps, c):
        """First of the three unknowns that turn clamp c, or None for one that the ground holds."""
        if clamps.part[c] >= 0:
            return self.own + 6 * clamps.part[c] + 3
        return self.count + 3 if clamps.riding[c] else None

    def forces(self, follow, state, force):
        """(count,) forces on the unknowns from those on the nodes, (3, n), and from the clamps; none on what does not move."""
        load = (follow.T @ force.T.ravel())[: self.count]
        for c in np.flatnonzero(self.model.clamps.part >= 0):
            at = self.turn_of(self.model.clamps, c)
            load[at : at + 3] += state.clamp_moment[c]
        load[~self.kept] = 0.0
        return load

    def sizes(self, state, load):
        """Norms (N) of the forces (count,) on each unknown place or turn; moments over the part's size."""
        norms = np.sqrt((load.reshape(-1, 3) ** 2).sum(axis=1))
        for b in range(self.parts):
            arms = [np.linalg.norm(state.position[:, node] - state.parts[b, :3]) for node, part in self._riders if part == b]
            norms[self.own // 3 + 2 * b + 1] /= max(max(arms, default=0.0), 1e-3)
        return norms

    def put(self, state, start, step, share):
        """Put `state` at `start` (position, parts) moved by `share` of the step (count + 6,)."""
        position, parts = start
        state.position[:] = position
        state.position[:, self._nodes] += share * step[: self.own].reshape(-1, 3)[self._unknown].T
        state.parts[:] = parts
        for b in range(self.parts):
            x = share * step[self.own + 6 * b : self.own + 6 * b + 6]
            state.parts[b, :3] += x[:3]
            state.parts[b, 3:7] = _turned(x[3:], state.parts[b, 3:7])


def _turned(turn, q):
    """Quaternion q turned by a rotation vector (3,), world axes."""
    angle = np.linalg.norm(turn)
    v = 0.5 * np.sinc(0.5 * angle / np.pi) * turn
    w = np.cos(0.5 * angle)
    turned = np.append(w * q[:3] + q[3] * v + np.cross(v, q[:3]), w * q[3] - v @ q[:3])
    return turned / np.linalg.norm(turned)


def block_matrix(rows, columns, blocks, shape):
    """Sparse matrix of 3 x 3 blocks (b, 3, 3) at the nodes `rows` and `columns` (b,); blocks of the same place add up."""
    three = np.arange(3)
    at = np.broadcast_to(3 * rows[:, None, None] + three[:, None], blocks.shape)
    over = np.broadcast_to(3 * columns[:, None, None] + three, blocks.shape)
    return sparse.csr_matrix((blocks.ravel(), (at.ravel(), over.ravel())), shape=shape)
