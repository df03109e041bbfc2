"""The mooring as a linear spring about a pose: the stiffness (6 x 6 for one platform), how everything else that is read changes with the pose, and how far that holds.

The second differences of what is read give the error to second order, e = 1/2 d' H d at an offset d. It is measured, too: where the platform
goes somewhere else, one static solution there says what the error is, and scales the estimate from then on.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from .poses import between, distance, moved, norm
from .readings import Readings, new_readings, observe

SHARE = 3e-4  # of the longest line: half of the change of place over which differences are taken
ELSEWHERE = 0.5  # of the distance from the middle: farther than that from where the error was measured, it is measured again
FORGOTTEN = 0.7  # of what the estimate was too low by remains at the next measurement, if that finds less
SLACK = 0.1  # of the mean tension of the fairleads: below, errors of a line's tension are seen against that


class Measure(NamedTuple):
    """What errors are counted in: fairlead tensions (lines,), forces and moments of the wrenches (2 M,), and what one of each is seen against."""

    scale: np.ndarray  # (lines + 2 M,) N, N m

    @staticmethod
    def values(readings):
        """(lines + 6 M,) of one row: fairlead tensions and the wrenches."""
        return np.concatenate([readings.tension[0, :, 1], readings.wrench[0].ravel()])

    def worst(self, errors):
        """Largest share of its scale of errors (lines + 6 M,)."""
        lines = (3 * self.scale.size - errors.size) // 2
        sizes = np.append(np.abs(errors[:lines]), [norm(vector) for vector in errors[lines:].reshape(-1, 3)])
        return float((sizes / self.scale).max())


@dataclass(frozen=True)
class LinearResponse:
    """Values at `pose` (M, 7) and their derivatives, axis first (6 M, ...), by place (m) and rotation vector about the world axes (rad).

    factor: measured over estimated error, where that is more than 1; checked: (M, 7) where it was measured last.
    """

    pose: np.ndarray
    base: Readings
    slope: Readings
    curvature: np.ndarray  # (6 M, 6 M, lines + 6 M) of Measure.values
    measure: Measure
    reach: float  # m: what a rotation moves
    position: np.ndarray  # (3, n) m
    position_slope: np.ndarray  # (6 M, 3, n)
    tension: np.ndarray  # (n,) N, of the segments
    tension_slope: np.ndarray  # (6 M, n)
    factor: float = 1.0
    checked: np.ndarray | None = None

    def offset(self, pose):
        """(6 M,) m and rad from where it was derived."""
        return between(self.pose, pose)

    def far_from_checked(self, pose):
        """Whether `pose` (M, 7) is somewhere else than where the error was measured, seen from the middle."""
        if self.checked is None:
            return True
        return distance(between(self.checked, pose), self.reach) > ELSEWHERE * distance(self.offset(pose), self.reach)

    def readings(self, pose):
        """Readings of one row at `pose` (M, 7), to first order; length rates at rest, tensions below zero where a line would have gone slack."""
        offset = self.offset(pose)
        return Readings(*(base + np.tensordot(offset, slope, 1)[None] for base, slope in zip(self.base, self.slope)))

    def error(self, pose):
        """Estimated error at `pose` (M, 7), as a share (see Measure)."""
        return self.factor * self._second_order(pose)

    def _second_order(self, pose):
        offset = self.offset(pose)
        return self.measure.worst(0.5 * np.tensordot(np.outer(offset, offset), self.curvature, 2))

    def confronted(self, pose, readings):
        """This response with its estimate scaled by the error at `pose` (M, 7) against the true `readings` there, and that error."""
        own = self.readings(pose)
        own.tension[:] = np.maximum(own.tension, 0.0)
        measured = self.measure.worst(Measure.values(readings) - Measure.values(own))
        estimated = self._second_order(pose)
        factor = max(FORGOTTEN * self.factor, measured / estimated if estimated > 0.0 else 1.0, 1.0)
        return replace(self, factor=factor, checked=pose.copy()), measured

    def shape(self, pose, state):
        """Put places and tensions of the nodes at `pose` (M, 7) into `state`."""
        offset = self.offset(pose)
        state.position[:] = self.position + np.tensordot(offset, self.position_slope, 1)
        state.tension[:] = np.maximum(self.tension + np.tensordot(offset, self.tension_slope, 1), 0.0)


def solutions(platforms):
    """Static solutions that a response of so many platforms takes: in the middle, to both sides of each axis, and between axes."""
    count = 6 * platforms
    return 1 + 2 * count + count * (count - 1) // 2


def linearise(model, pose, static_state, stiffness):
    """LinearResponse about `pose` (M, 7) and the State in equilibrium there.

    static_state(pose) gives the State in equilibrium, stiffness(state) that of the wrenches (6 M, 6 M). Takes `solutions(M)` of the statics.
    """
    small = SHARE * (model.segments * model.length[model.first_node + 1]).max()
    reach = max(model.reach.max(), small)
    steps = np.tile([small] * 3 + [small / reach] * 3, len(pose))
    count, axes = steps.size, np.eye(steps.size)

    def read(state):
        readings = new_readings(model, 1)
        observe(model, state, 0, readings)
        return readings

    here = static_state(pose)
    base = read(here)
    middle = Measure.values(base)
    own = stiffness(here)
    lines = model.first_node.size
    slopes, ahead_of, curvature = [], [], np.zeros((count, count, middle.size))
    for axis, step in enumerate(steps):
        ahead, behind = (static_state(moved(pose, sign * step * axes[axis])) for sign in (1.0, -1.0))
        a, b = read(ahead), read(behind)
        pairs = zip((*a, ahead.position[None], ahead.tension[None]), (*b, behind.position[None], behind.tension[None]))
        slopes.append([(x[0] - y[0]) / (2.0 * step) for x, y in pairs])
        ahead_of.append(Measure.values(a))
        curvature[axis, axis] = (Measure.values(a) + Measure.values(b) - 2.0 * middle) / step**2
    for i in range(count):
        for j in range(i):
            both = Measure.values(read(static_state(moved(pose, steps[i] * axes[i] + steps[j] * axes[j]))))
            curvature[i, j] = curvature[j, i] = (both - ahead_of[i] - ahead_of[j] + middle) / (steps[i] * steps[j])
    *readings, position_slope, tension_slope = (np.array(column) for column in zip(*slopes))
    slope = Readings(*readings)._replace(wrench=-own.T.copy().reshape(count, len(pose), 6))
    total = base.tension[0, :, 1].sum()
    tension = np.maximum(base.tension[0, :, 1], SLACK * total / lines)
    scale = np.maximum(np.append(tension, (total, total * reach) * len(pose)), 1e-300)
    response = LinearResponse(
        pose.copy(), base, slope, curvature, Measure(scale), reach, here.position.copy(), position_slope, here.tension.copy(), tension_slope
    )
    return response, here
