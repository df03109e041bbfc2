"""Nodes apart from each other in and above a bed, with random motion and loads, for tests of contact and friction node by node."""

import numpy as np

from mooring_ros.core.bed import bed_at, bed_under
from mooring_ros.core.ground import contact

STIFFNESS, DAMPING = 2e5, 1e4


class Nodes:
    """n nodes that feel no neighbours; fields as the arguments of `contact`, arrays (3, n + 1) where it reads one node further."""

    def __init__(self, ground, n=400, seed=0, deep=0.02, speed=0.1, load=3e3, extent=100.0, flat=False):
        rng = np.random.default_rng(seed)
        self.ground, self.n = ground, n
        self.position = rng.uniform(-extent, extent, (3, n + 1))
        self.velocity = rng.normal(0.0, speed, (3, n + 1))
        self.load = rng.normal(0.0, load, (3, n))
        self.stiffness, self.damping = STIFFNESS * rng.uniform(0.5, 2.0, n), DAMPING * rng.uniform(0.5, 2.0, n)
        self.normal, self.axial = rng.uniform(100.0, 500.0, (2, n))
        self.slaved = np.zeros(n, dtype=bool)
        self.bed, self.hold = np.zeros((4, n + 1)), np.zeros((3, n + 1))
        self.bed[:, :n] = bed_at(ground, self.position[0, :n], self.position[1, :n])
        self.position[2, :n] = self.bed[0, :n] + rng.uniform(-deep, 0.5 * deep, n)
        # every second segment is null, so that every node has a direction of its own
        direction = rng.normal(0.0, 1.0, (3, n))
        if flat:
            direction -= (direction * self.bed[1:, :n]).sum(axis=0) * self.bed[1:, :n]
        self.direction = direction / np.sqrt((direction**2).sum(axis=0))
        self.grip = np.full((4, n + 1), -1.0)
        self.expected = np.zeros((3, n + 1))

    @property
    def n_hat(self):
        return self.bed[1:, : self.n]

    @property
    def depth(self):
        return (self.bed[0] - self.position[2])[: self.n] * self.bed[3, : self.n]

    def forces(self, step):
        """(3, n) forces of the bed, node by node (their tangents are their own)."""
        n = self.n
        total = np.zeros((3, n))
        bed_under(self.ground, n, self.position, self.bed)
        for parity in (0, 1):
            tangent = np.zeros((3, n + 1))
            chosen = np.arange(parity, n, 2)
            tangent[:, chosen] = self.direction[:, chosen]
            force = np.zeros((3, n + 1))
            force[:, :n] = self.load
            hold = np.zeros((3, n + 1))
            contact(
                self.ground,
                n,
                step,
                self.position,
                self.velocity,
                tangent,
                self.stiffness,
                self.damping,
                self.normal,
                self.axial,
                self.slaved,
                self.bed,
                self.grip,
                self.expected,
                force,
                hold,
            )
            total[:, chosen] = (force[:, :n] - self.load)[:, chosen]
            self.hold[:, chosen] = hold[:, chosen]
        return total

    def accelerations(self, force):
        """M^-1 (load + force), (3, n)."""
        total, t = force + self.load, self.direction
        return total / self.normal + t * (t * total).sum(axis=0) * (1.0 / self.axial - 1.0 / self.normal)

    def along_normal(self, vector):
        return (vector * self.n_hat).sum(axis=0)

    def in_plane(self, vector):
        return vector - self.along_normal(vector) * self.n_hat

    def axial_direction(self):
        along = self.in_plane(self.direction)
        return along / np.sqrt((along**2).sum(axis=0))

    def split(self, vector):
        """(axial (n,), across (3, n)) parts in the bed's plane."""
        e = self.axial_direction()
        axial = (vector * e).sum(axis=0)
        return axial, self.in_plane(vector) - axial * e


def norms(vectors):
    return np.sqrt((vectors**2).sum(axis=0))
