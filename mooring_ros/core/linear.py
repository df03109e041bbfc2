"""The mooring as a linear spring about a settled pose: the 6 x 6 stiffness, and how everything else that is read changes with the pose."""

from dataclasses import dataclass

import numpy as np

from .platform import rotation_between
from .readings import Readings, new_readings, observe

SHARE = 1e-4  # of the longest line: half of the change of place over which differences are taken


@dataclass(frozen=True)
class LinearResponse:
    """Values at `pose` (7,) and their derivatives, axis first (6, ...), by place (m) and rotation vector about the world axes (rad)."""

    pose: np.ndarray
    base: Readings
    slope: Readings
    position: np.ndarray  # (3, n) m
    position_slope: np.ndarray  # (6, 3, n)
    tension: np.ndarray  # (n,) N, of the segments
    tension_slope: np.ndarray  # (6, n)

    def offset(self, pose):
        """(6,) m and rad from the settled pose."""
        return np.concatenate([pose[:3] - self.pose[:3], rotation_between(self.pose[3:], pose[3:])])

    def show(self, state, pose, twist, row, readings):
        """Put the linear answer at `pose` (7,), `twist` (6,) into one row of `readings`, and places and tensions of the nodes into `state`."""
        offset = self.offset(pose)
        for values, base, slope in zip(readings, self.base, self.slope):
            values[row] = base[0] + np.tensordot(offset, slope, 1)
        readings.tension[row] = np.maximum(readings.tension[row], 0.0)
        readings.length_rate[row] = np.tensordot(twist, self.slope.length, 1)
        state.position[:] = self.position + np.tensordot(offset, self.position_slope, 1)
        state.tension[:] = np.maximum(self.tension + np.tensordot(offset, self.tension_slope, 1), 0.0)


def linearise(model, pose, static_state, stiffness):
    """LinearResponse about `pose` (7,): `static_state(pose)` gives the State in equilibrium, `stiffness` (6, 6) is that of the wrench."""
    small = SHARE * (model.segments * model.length[model.first_node + 1]).max()
    steps = [small] * 3 + [small / max(model.reach, small)] * 3

    def read(state):
        readings = new_readings(model, 1)
        observe(model, state, 0, readings)
        return readings

    here = static_state(pose)
    slopes = []
    for axis, step in enumerate(steps):
        ahead, behind = (static_state(_moved(pose, axis, sign * step)) for sign in (1.0, -1.0))
        pairs = zip((*read(ahead), ahead.position[None], ahead.tension[None]), (*read(behind), behind.position[None], behind.tension[None]))
        slopes.append([(a[0] - b[0]) / (2.0 * step) for a, b in pairs])
    *readings, position_slope, tension_slope = (np.array(column) for column in zip(*slopes))
    slope = Readings(*readings)._replace(wrench=-stiffness.T.copy())
    return LinearResponse(pose.copy(), read(here), slope, here.position.copy(), position_slope, here.tension.copy(), tension_slope)


def _moved(pose, axis, by):
    moved = pose.copy()
    if axis < 3:
        moved[axis] += by
        return moved
    w = pose[6]
    turn = np.zeros(3)
    turn[axis - 3] = np.sin(0.5 * by)
    c = np.cos(0.5 * by)
    vector = c * pose[3:6] + w * turn + np.cross(turn, pose[3:6])
    moved[3:] = (*vector, c * w - turn @ pose[3:6])
    return moved
