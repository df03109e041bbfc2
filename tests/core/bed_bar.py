"""A bar of nodes on a bed, driven by the bed's kernels alone: small static and explicit solvers for the tests of contact and friction."""

import numpy as np
from scipy.linalg import solve_banded

from mooring_ros.core.bed import bed_at, bed_under, build_ground
from mooring_ros.core.ground import commit_grip, contact, ground_blocks
from mooring_ros.scene import Environment
from mooring_ros.scene.description import Friction

def ground(law=None, axial=0.0, across=None, drop=1.0, ramp=1e6, **environment):
    """Ground with kinetic coefficients `axial` and `across` (the same unless given), static ones `drop` times as large."""
    across = axial if across is None else across
    friction = None if law is None else Friction(law, drop * axial, drop * across, axial, across, ramp)
    return build_ground(Environment(**{"depth": 100.0, "friction": friction, **environment}))


class Bar:
    """N + 1 nodes from `start` along `heading` (3,) on the bed, w (N/m) heavy against it, the first node held (unless `free`)."""

    def __init__(self, bed_ground, segments, length, stiffness, weight, heading=(1.0, 0.0, 0.0), mass=None, bed_stiffness=2e5, added=(0.0, 0.0), held=True):
        n = segments + 1
        self.ground, self.n, self.segment = bed_ground, n, length / segments
        self.stiffness = stiffness
        heading = np.array(heading, dtype=float)
        self.heading = heading / np.linalg.norm(heading)
        lumped = np.full(n, self.segment)
        lumped[[0, -1]] *= 0.5
        self.weight = np.zeros((3, n))
        self.weight[2] = -weight * lumped
        mass = weight / 9.80665 if mass is None else mass
        self.normal, self.axial = (mass + added[0]) * lumped, (mass + added[1]) * lumped
        self.bed_stiffness = bed_stiffness * lumped
        self.bed_damping = 2.0 * np.sqrt(self.bed_stiffness * mass * lumped)
        self.slaved = np.zeros(n, dtype=bool)
        self.held = np.arange(n) < (1 if held else 0)
        self.position, self.velocity = np.zeros((3, n + 1)), np.zeros((3, n + 1))
        self.position[:, :n] = self.heading[:, None] * np.arange(n) * self.segment
        self.bed, self.grip, self.hold = np.zeros((4, n + 1)), np.full((4, n + 1), -1.0), np.zeros((3, n + 1))
        self.tangent, self.tension = np.zeros((3, n + 1)), np.zeros(n + 1)
        self.force = np.zeros((3, n + 1))
        self.sink()
        self.commit()

    def sink(self):
        """Put the nodes as deep into the bed as their weight presses them."""
        n = self.n
        self.bed[:, :n] = bed_at(self.ground, self.position[0, :n], self.position[1, :n])
        depth = -self.weight[2] * self.bed[3, :n] / self.bed_stiffness
        self.position[2, :n] = self.bed[0, :n] - depth / self.bed[3, :n]

    def stretch(self):
        span = np.diff(self.position[:, : self.n], axis=1)
        length = np.sqrt((span**2).sum(axis=0))
        self.tangent[:, 1 : self.n] = span / length
        self.tension[1 : self.n] = np.maximum(self.stiffness * (length / self.segment - 1.0), 0.0)

    def evaluate(self, load, step=0.0, damping=0.0):
        """Forces with `load` (3,) on the last node; `damping` (N s) within the segments."""
        n = self.n
        self.stretch()
        if damping:
            rate = (self.tangent[:, 1:n] * np.diff(self.velocity[:, :n], axis=1)).sum(axis=0)
            self.tension[1:n] = np.where(self.tension[1:n] > 0.0, np.maximum(self.tension[1:n] + damping * rate / self.segment, 0.0), 0.0)
        pull = self.tension * self.tangent
        self.force[:, :n] = pull[:, 1 : n + 1] - pull[:, :n] + self.weight
        self.force[:, n - 1] += load
        self.others = self.force[:, :n].copy()
        bed_under(self.ground, n, self.position, self.bed)
        contact(
            self.ground,
            n,
            step,
            self.position,
            self.velocity,
            self.tangent,
            self.bed_stiffness,
            self.bed_damping,
            self.normal,
            self.axial,
            self.slaved,
            self.bed,
            self.grip,
            np.zeros((3, n + 1)),
            self.force,
            self.hold,
        )

    def commit(self):
        bed_under(self.ground, self.n, self.position, self.bed)
        self.stretch()
        commit_grip(
            self.ground, self.n, self.position, self.velocity, self.tangent, self.bed_stiffness, self.bed_damping, self.bed, self.grip
        )

    def leap(self, load, step, damping=0.0):
        """One step of semi-implicit Euler, and the memory's."""
        n = self.n
        self.evaluate(load, step, damping)
        t = self.tangent[:, :n] + self.tangent[:, 1 : n + 1]
        square = np.maximum((t * t).sum(axis=0), 1e-12)
        force = self.force[:, :n]
        acceleration = force / self.normal + t * ((t * force).sum(axis=0) / square * (1.0 / self.axial - 1.0 / self.normal))
        self.velocity[:, :n] += step * np.where(self.held, 0.0, acceleration)
        self.position[:, :n] += step * self.velocity[:, :n]
        self.commit()

    # -- statics ------------------------------------------------------------------------------------------------------------------------

    def settle(self, load, tolerance=1e-9, most=200):
        """Newton on the frozen memory; the caller commits. Returns iterations."""
        self.velocity[:] = 0.0
        free = ~self.held
        scale = np.abs(self.weight).sum()
        self.evaluate(load)
        worst = self._worst(free)
        for iteration in range(most):
            if worst <= tolerance * scale:
                return iteration
            move = self._newton(free)
            start, share = self.position.copy(), 1.0
            while True:
                self.position[:, : self.n] = start[:, : self.n] + share * move
                self.evaluate(load)
                new = self._worst(free)
                if new < worst or share < 1e-3:
                    break
                share *= 0.5
            worst = new
        raise AssertionError(f"no equilibrium: {worst} N of {scale} N")

    def _worst(self, free):
        return np.sqrt((self.force[:, : self.n][:, free] ** 2).sum())

    def _newton(self, free):
        n = self.n
        diagonal = np.zeros((n, 3, 3))
        beyond = np.zeros((n, 3, 3))  # with the next node
        for i in range(n - 1):
            q, tension = self.tangent[:, i + 1], self.tension[i + 1]
            along = np.outer(q, q)
            stiff = self.stiffness if tension > 0.0 else 1e-6 * self.stiffness
            block = stiff / self.segment * along + tension / self.segment * (np.eye(3) - along)
            diagonal[i] += block
            diagonal[i + 1] += block
            beyond[i] -= block
        ground_blocks(self.ground, n, self.position, self.tangent, self.bed_stiffness, self.bed, self.grip, diagonal)
        return solve_blocks(diagonal, beyond, self.force[:, :n], free)


def solve_blocks(diagonal, beyond, force, free):
    """Move (3, n) with K move = force of a chain's block tridiagonal K; none of the nodes that are not free."""
    n = len(diagonal)
    banded = np.zeros((11, 3 * n))
    for i in range(n):
        for a in range(3):
            for b in range(3):
                banded[5 + a - b, 3 * i + b] = diagonal[i, a, b] + (1e-9 * abs(diagonal[i]).max() if a == b else 0.0)
                if i + 1 < n:
                    banded[5 + a - b - 3, 3 * i + 3 + b] = beyond[i, a, b]
                    banded[5 + a - b + 3, 3 * i + b] = beyond[i, b, a]
    right = np.where(free, force, 0.0).T.ravel()
    for i in np.flatnonzero(~free):
        for row in range(3 * i, 3 * i + 3):
            for col in range(max(row - 5, 0), min(row + 6, 3 * n)):
                banded[5 + row - col, col] = 1.0 if row == col else 0.0
    return solve_banded((5, 5), banded, right).reshape(n, 3).T
