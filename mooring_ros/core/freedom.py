"""What may move in the statics: unknowns, and how the nodes follow them.

Unknowns come in threes: the place of every node of its own (inside lines, loose ends, free points with the ends that they hold), then place
and turn (world axes) of every rigid part (a pinned part only turns); those of the platforms are the last. A node follows a place
as it is and a turn by its arm; a list of (node, three, arm or none) says all of it.
"""

from typing import NamedTuple

import numpy as np

from .layout import POINT_COUPLED, POINT_FREE, POINT_RIDING
from .model import LOOSE

NO_ARM = -1
ALIGNED = 1e-9  # of the longest arm


def skews(v):
    """(k, 3, 3) of v (k, 3)."""
    m = np.zeros((len(v), 3, 3))
    m[:, 0, 1], m[:, 0, 2], m[:, 1, 2] = -v[:, 2], v[:, 1], -v[:, 0]
    return m - m.transpose(0, 2, 1)


class Following(NamedTuple):
    """Row by row: `node` follows the unknowns `three`, by `arm` (index, NO_ARM for a place)."""

    node: np.ndarray
    three: np.ndarray
    arm: np.ndarray


class Freedom:
    """Unknowns of one model with its ends held as `state.end_point` says.

    count: unknowns, the platforms' not included; own: those of nodes of their own. kept (count // 3,): whether a three moves at all.
    slender: parts that nothing could tell to spin, all that rides on them in one line; slender_axis (k, 3): along it, the part's axes.
    following: a Following without the platforms; with_platform: and with them, two threes each at the end.
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
        own += model.free_points.size
        self.own, self.count = 3 * own, 3 * own + 6 * self.parts
        node, point = self._holders(model, state)
        kind = model.point_kind[point]
        free = kind == POINT_FREE
        unknown[node[free]] = unknown[model.point_node[point[free]]]
        rides = kind == POINT_RIDING
        self._rider, self._rider_part = node[rides], model.rigid.part[point[rides]]
        self._coupled, on = node[kind == POINT_COUPLED], model.point_platform[point[kind == POINT_COUPLED]]
        pinned = model.rigid.pin >= 0
        self._pinned = np.flatnonzero(pinned)
        on_platform = pinned & (model.point_kind[model.rigid.pin] == POINT_COUPLED)
        self._hung = np.flatnonzero(on_platform[self._rider_part])  # riders on parts that hang on a platform
        self._carrier = np.concatenate([on, model.point_platform[model.rigid.pin[self._rider_part[self._hung]]]])
        self.kept = np.ones(self.count // 3, dtype=bool)
        self.kept[own + 2 * self._pinned] = False
        self._list(unknown, own, pinned)
        axes = {b: self._only_axis(b) for b in range(self.parts)}
        self.slender = np.array([b for b, axis in axes.items() if axis is not None], dtype=np.int64)
        self.slender_axis = np.array([axes[b] for b in self.slender]).reshape(-1, 3)

    def _only_axis(self, b):
        """Unit vector (3,) along which all that rides on part b stands, clamps too, or None."""
        model = self.model
        arms = model.point_place[model.rigid.riding[model.rigid.part[model.rigid.riding] == b]]
        sizes = np.linalg.norm(arms, axis=1)
        if not sizes.max(initial=0.0) > 0.0:
            return None
        axis = arms[sizes.argmax()] / sizes.max()
        lines = np.concatenate([arms / sizes.max(), model.clamps.axis[model.clamps.part == b]])
        return axis if np.abs(np.cross(lines, axis)).max() < ALIGNED else None

    @staticmethod
    def _holders(model, state):
        """Nodes that points carry, their own and those of the ends that they hold, and the points."""
        held = np.flatnonzero(state.end_point != LOOSE)
        node = np.concatenate([model.point_node, model.end_node[held]])
        return node, np.concatenate([np.arange(model.point_node.size), state.end_point[held]])

    def _list(self, unknown, own, pinned):
        own_nodes = np.flatnonzero(unknown >= 0)
        self._nodes, self._unknown = own_nodes, unknown[own_nodes]
        place = own + 2 * self._rider_part
        loose, riders = ~pinned[self._rider_part], np.arange(self._rider.size)
        rows = [(own_nodes, self._unknown, NO_ARM), (self._rider[loose], place[loose], NO_ARM), (self._rider, place + 1, riders)]
        self.following = _following(rows)
        carried = np.concatenate([self._coupled, self._rider[self._hung]])
        arms = self._rider.size + np.arange(carried.size)
        platform = self.count // 3 + 2 * self._carrier
        self.with_platform = _following(rows + [(carried, platform, NO_ARM), (carried, platform + 1, arms)])
        self._by_arm = np.flatnonzero(self.following.arm != NO_ARM)
        self._columns = _in_threes(self.following.three)
        self._rows = _in_threes(self.following.node)

    def arms(self, state, platform=False):
        """(arms, 3) m, of the riders and, with `platform`, of what platforms carry."""
        riders = state.position.T[self._rider] - state.parts[self._rider_part, :3]
        if not platform:
            return riders
        pins = state.parts[self._rider_part[self._hung], :3]
        carried = np.concatenate([state.position.T[self._coupled], pins])
        return np.concatenate([riders, carried - state.pose[self._carrier, :3]])

    def turned_threes(self, platform=False):
        """What the arms turn with: (three, node) of each, as `arms` has them."""
        three, node = self.own // 3 + 2 * self._rider_part + 1, self._rider
        if not platform:
            return three, node
        carried = np.concatenate([self._coupled, self._rider[self._hung]])
        return np.concatenate([three, self.count // 3 + 2 * self._carrier + 1]), np.concatenate([node, carried])

    def turn_of(self, clamps, c):
        """The three that turns clamp c, or None for one that the ground holds."""
        if clamps.part[c] >= 0:
            return self.own // 3 + 2 * clamps.part[c] + 1
        return self.count // 3 + 2 * clamps.platform[c] + 1 if clamps.platform[c] >= 0 else None

    def forces(self, state, force):
        """(count,) forces on the unknowns from those on the nodes, (3, n), and from the clamps; none on what does not move."""
        pull = force.T[self.following.node]
        if self._by_arm.size:
            pull[self._by_arm] = np.cross(self.arms(state), pull[self._by_arm])
        load = np.bincount(self._columns, pull.ravel(), self.count)
        for c in np.flatnonzero(self.model.clamps.part >= 0):
            at = 3 * self.turn_of(self.model.clamps, c)
            load[at : at + 3] += state.clamp_moment[c]
        return load

    def moves(self, state, step, move):
        """Put into `move` (3, n) how the nodes go when the unknowns go by `step` (count,), to first order."""
        go = step.reshape(-1, 3)[self.following.three]
        if self._by_arm.size:
            go[self._by_arm] = np.cross(go[self._by_arm], self.arms(state))
        move[:] = np.bincount(self._rows, go.ravel(), move.size).reshape(-1, 3).T

    def sizes(self, state, load):
        """Norms (N) of the forces (count,) on each unknown place or turn; moments over the part's size."""
        norms = np.sqrt((load.reshape(-1, 3) ** 2).sum(axis=1))
        if self.parts:
            reach = np.full(self.parts, 1e-3)
            np.maximum.at(reach, self._rider_part, np.sqrt((self.arms(state) ** 2).sum(axis=1)))
            norms[self.own // 3 + 1 :: 2] /= reach
        return norms

    def put(self, state, start, step, share):
        """Put `state` at `start` (position, parts) moved by `share` of the step (count,)."""
        position, parts = start
        state.position[:] = position
        state.position[:, self._nodes] += share * step[: self.own].reshape(-1, 3)[self._unknown].T
        state.parts[:] = parts
        for b in range(self.parts):
            x = share * step[self.own + 6 * b : self.own + 6 * b + 6]
            state.parts[b, :3] += x[:3]
            state.parts[b, 3:7] = _turned(x[3:], state.parts[b, 3:7])


def _following(rows):
    node = np.concatenate([nodes for nodes, _, _ in rows])
    three = np.concatenate([np.broadcast_to(threes, nodes.shape) for nodes, threes, _ in rows])
    arm = np.concatenate([np.broadcast_to(arms, nodes.shape) for nodes, _, arms in rows])
    return Following(node, three, arm)


def _in_threes(index):
    return (3 * index[:, None] + np.arange(3)).ravel()


def _turned(turn, q):
    """Quaternion q turned by a rotation vector (3,), world axes."""
    angle = np.linalg.norm(turn)
    v = 0.5 * np.sinc(0.5 * angle / np.pi) * turn
    w = np.cos(0.5 * angle)
    turned = np.append(w * q[:3] + q[3] * v + np.cross(v, q[:3]), w * q[3] - v @ q[:3])
    return turned / np.linalg.norm(turned)
