"""The one adapter between what a motion source sends and the inside convention.

Inside: world ENU, z up, SI units at full scale; pose is x, y, z and the unit quaternion x, y, z, w that turns platform axes
(x forward, y left, z up) into world axes; twist is the velocity of the reference point and the angular velocity, both in
world axes. Outside it may be NED and forward-right-down, a twist in platform axes, and a model at the length scale 1/λ.
"""
import math
from dataclasses import dataclass

import numpy as np

from mooring_ros.motion import rotation

TWIST_FRAMES = ("child", "world")
CONVENTIONS = ("enu", "ned")
WRENCH_FRAMES = ("world", "body")
FULL_SCALE = "full scale"

# Turns NED axes into ENU axes; it is its own inverse, as is the half turn about x between forward-right-down and forward-left-up.
_NED_TO_ENU = (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)
_HALF_TURN_ABOUT_X = (1.0, 0.0, 0.0, 0.0)


def _world_to_enu(v, convention):
    return v if convention == "enu" else (v[1], v[0], -v[2])


def _body_to_flu(v, convention):
    return v if convention == "enu" else (v[0], -v[1], -v[2])


@dataclass(frozen=True)
class Adapter:
    """How one source gives its motion and wants its forces.

    twist_frame: axes of the given twist, ``child`` (the platform's, as nav_msgs/Odometry says) or ``world``.
    convention: ``enu`` (world ENU, platform forward-left-up) or ``ned`` (world NED, platform forward-right-down).
    wrench_frame: axes of the wrenches handed back, ``world`` or ``body``.
    scale: Froude length scale λ, full scale over model scale. density_ratio: water density at full scale over that at model scale.
    """

    twist_frame: str = "child"
    convention: str = "enu"
    wrench_frame: str = "world"
    scale: float = 1.0
    density_ratio: float = 1.0

    def __post_init__(self):
        for name, value, allowed in (("twist_frame", self.twist_frame, TWIST_FRAMES),
                                     ("convention", self.convention, CONVENTIONS),
                                     ("wrench_frame", self.wrench_frame, WRENCH_FRAMES)):
            if value not in allowed:
                raise ValueError(f"{name} is {value!r}, expected one of {', '.join(allowed)}")
        for name, value in (("scale", self.scale), ("density_ratio", self.density_ratio)):
            if not (math.isfinite(value) and value > 0.0):
                raise ValueError(f"{name} is {value!r}, expected a positive number")

    @property
    def _as_inside(self):
        return self.wrench_frame == "world" and self.convention == "enu" and self.scale == 1.0 and self.density_ratio == 1.0

    # --- inwards ---

    @property
    def time_factor(self):
        """Seconds inside for one second of the source's clock."""
        return math.sqrt(self.scale)

    def pose_in(self, pose):
        """The given pose (7,), m at the source's scale, as a tuple in the inside convention."""
        position = _world_to_enu(pose[:3], self.convention)
        q = tuple(pose[3:7])
        if self.convention == "ned":
            q = rotation.multiply(_NED_TO_ENU, rotation.multiply(q, _HALF_TURN_ABOUT_X))
        scale = self.scale
        if scale != 1.0:
            position = (scale * position[0], scale * position[1], scale * position[2])
        return (*position, *q)

    def twist_in(self, twist, q, twist_frame=None, convention=None):
        """The given twist (6,), at the source's scale, as a tuple in the inside convention; q is the inside quaternion.

        twist_frame and convention stand in for the adapter's own: the start-up check tries the alternatives with them.
        """
        convention = convention or self.convention
        velocity, turning = tuple(twist[:3]), tuple(twist[3:6])
        if (twist_frame or self.twist_frame) == "child":
            velocity = rotation.rotate(q, _body_to_flu(velocity, convention))
            turning = rotation.rotate(q, _body_to_flu(turning, convention))
        else:
            velocity, turning = _world_to_enu(velocity, convention), _world_to_enu(turning, convention)
        if self.scale != 1.0:
            root = math.sqrt(self.scale)
            velocity = tuple(root * v for v in velocity)
            turning = tuple(w / root for w in turning)
        return (*velocity, *turning)

    # --- outwards ---

    @property
    def force_factor(self):
        """Force handed back for one newton inside."""
        return 1.0 / (self.scale ** 3 * self.density_ratio)

    @property
    def moment_factor(self):
        """Moment handed back for one newton metre inside."""
        return self.force_factor / self.scale

    @property
    def length_factor(self):
        """Length handed back for one metre inside."""
        return 1.0 / self.scale

    @property
    def speed_factor(self):
        """Speed handed back for one metre a second inside."""
        return 1.0 / math.sqrt(self.scale)

    def wrenches_out(self, wrenches, pose):
        """Wrenches (k, 6) in N and N·m, inside world axes, as the source wants them: axes, convention and scale. Pose is inside.

        The array itself where nothing is to be done.
        """
        out = np.asarray(wrenches, dtype=float)
        if self._as_inside:
            return out
        out = out.copy()
        if self.wrench_frame == "body":
            turn = np.array(rotation.matrix(pose[3:7]))
            out[:, :3] = out[:, :3] @ turn
            out[:, 3:] = out[:, 3:] @ turn
            if self.convention == "ned":
                out[:, [1, 2, 4, 5]] *= -1.0
        elif self.convention == "ned":
            out = out[:, [1, 0, 2, 4, 3, 5]]
            out[:, [2, 5]] *= -1.0
        if self.scale != 1.0 or self.density_ratio != 1.0:
            out[:, :3] *= self.force_factor
            out[:, 3:] *= self.moment_factor
        return out

    def points_out(self, points):
        """Positions (k, 3) in m, inside, as positions in the source's world frame and scale."""
        out = np.asarray(points, dtype=float)
        if self.convention == "ned":
            out = out[:, [1, 0, 2]] * (1.0, 1.0, -1.0)
        return out if self.scale == 1.0 else out * self.length_factor


def twist_axes(twist_frame_id, pose_frame_id, platform_frame, default):
    """Axes of a TwistStamped, ``child`` or ``world``: its own header says, where it says anything; else the default.

    The twist is in world axes when its frame is the pose's, in platform axes when it is the platform's frame.
    """
    if twist_frame_id and twist_frame_id == pose_frame_id:
        return "world"
    if twist_frame_id and twist_frame_id == platform_frame:
        return "child"
    return default


def scale_in_words(scale, density_ratio):
    """At which scale motion goes in and forces come out."""
    if scale == 1.0 and density_ratio == 1.0:
        return FULL_SCALE
    return f"model scale 1:{scale:.10g}, density of the water at full scale over that of the model {density_ratio:.10g}"
