"""The floater of the coupled decays: a rigid body of the size of the OC4 semisubmersible, at full or at model scale.

Its figures are rounded from A. Robertson et al., NREL/TP-5000-60601 (2014), put together as one rigid body with constant added mass, such that with
config/scenes/oc4.txt the periods are those of that report within some percent; linear damping is chosen, about 1 % of critical. What is measured here is the coupling,
not the platform.
"""

from dataclasses import dataclass

import numpy as np

from mooring_ros.demo.floater import Floater, FloaterProperties, quaternion_rate

SCENE = "config/scenes/oc4.txt"
HOME = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Release:
    """Let go at rest from here, at full scale: index of the motion, how far (m or rad), and half periods that are looked at."""

    axis: int
    size: float
    halves: int

    def pose(self, scale=1.0):
        """(7,) at the length scale 1/scale."""
        pose = HOME.copy()
        if self.axis < 3:
            pose[self.axis] = self.size / scale
        else:
            pose[self.axis], pose[6] = np.sin(0.5 * self.size), np.cos(0.5 * self.size)
        return pose


RELEASES = {
    "surge": Release(0, 8.0, 6),
    "heave": Release(2, 2.0, 10),
    "pitch": Release(4, np.radians(4.0), 8),
    "yaw": Release(5, np.radians(8.0), 6),
}
PERIODS = {"surge": 115.0, "heave": 17.5, "pitch": 26.0, "yaw": 84.0}  # s at full scale, about; for the length of the runs


def duration(name, scale=1.0, halves=None):
    """s that hold the half periods of a release, at the scale's own time."""
    return (0.5 * (halves or RELEASES[name].halves) + 0.8) * PERIODS[name] / np.sqrt(scale)


def properties(scale=1.0):
    """FloaterProperties at the Froude length scale `scale` (full over model)."""
    added = np.diag([8.3e6, 8.3e6, 1.48e7, 7.2e9, 7.2e9, 4.9e9])
    added[0, 4] = added[4, 0] = -9.0e7
    added[1, 3] = added[3, 1] = 9.0e7
    lengths = np.repeat([0.0, 1.0], 3)
    cubed = scale**3
    return FloaterProperties(
        mass=1.407e7 / cubed,
        centre_of_gravity=-9.9 / scale,
        roll_inertia=1.24e10 / scale**5,
        yaw_inertia=1.3e10 / scale**5,
        displacement=13917.0 / cubed,
        heave_stiffness=3.836e6 / scale**2,
        tilt_stiffness=-3.776e8 / scale**4,
        added_mass=added / cubed / scale ** np.add.outer(lengths, lengths),
        quadratic_damping=np.zeros((6, 6)),
        linear_damping=np.array([2.6e4, 2.6e4, 2.1e5, 9e7, 9e7, 2.8e7]) / scale**2.5 / scale ** (2.0 * lengths),
    )


def floater(static_wrench, scale=1.0):
    """A Floater at rest at home under the mooring's wrench (6,) there, both at this scale."""
    made = Floater(properties(scale))
    made.trim(static_wrench)
    return made


def advance(body, pose, twist, step, wrench):
    """Pose (7,) and twist (6,) a step (s) on, by the classical Runge–Kutta scheme; wrench(s) -> (6,) s seconds after the step's start."""

    def rates(pose, twist, s):
        return np.concatenate([twist[:3], quaternion_rate(pose[3:], twist[3:])]), body.acceleration(pose, twist, wrench(s))

    half = 0.5 * step
    p1, a1 = rates(pose, twist, 0.0)
    p2, a2 = rates(pose + half * p1, twist + half * a1, half)
    p3, a3 = rates(pose + half * p2, twist + half * a2, half)
    p4, a4 = rates(pose + step * p3, twist + step * a3, step)
    pose = pose + step / 6.0 * (p1 + 2.0 * p2 + 2.0 * p3 + p4)
    pose[3:] /= np.linalg.norm(pose[3:])
    return pose, twist + step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
