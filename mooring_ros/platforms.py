"""Which coupled bodies are platforms of their own, and the shapes that poses, twists and wrenches have because of it."""

import numpy as np

from .arguments import checked_poses, checked_twists, numbers, shaped
from .scene import COUPLED, COUPLED_PINNED

POSE, TWIST = "x, y, z, qx, qy, qz, qw", "vx, vy, vz, wx, wy, wz"
IDENTITY = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def platform_count(names):
    """How many platforms there are with these names: one where there are none."""
    return len(names or (None,))


class Platforms:
    """The platforms of a scene: one without a name, or named coupled bodies.

    names: None for one platform, with all that is coupled; its poses (7,), twists and wrenches (6,) have no axis for it. Else a tuple of names of
    coupled bodies; poses are (platforms, 7), and so on, in this order, also of a single name. Raises ValueError for names that cannot be platforms,
    and when something coupled would ride on none of them.
    """

    def __init__(self, names, scene):
        self.names = None if names is None else _checked(names, scene)
        self.count = platform_count(self.names)
        self._axis = () if self.names is None else (self.count,)
        self.shape_of_pose, self.shape_of_twist = (*self._axis, 7), (*self._axis, 6)
        self.pose_in_file = self.outside(np.array(_poses_in_file(self.names, scene)))

    def pose(self, values):
        """A checked pose as the core has it, (platforms, 7)."""
        return checked_poses(shaped(values, self.shape_of_pose, "pose", self._said(POSE))).reshape(-1, 7)

    def twist(self, values):
        """A checked twist as the core has it, (platforms, 6)."""
        return checked_twists(shaped(values, self.shape_of_twist, "twist", self._said(TWIST))).reshape(-1, 6)

    def motion(self, times, poses, twists):
        """Poses (k, platforms, 7) and twists (k, platforms, 6) for times (k,); checked for their shapes only."""
        poses, twists = numbers(poses, "poses"), numbers(twists, "twists")
        of_poses, of_twists = (times.size, *self.shape_of_pose), (times.size, *self.shape_of_twist)
        if poses.shape != of_poses or twists.shape != of_twists:
            expected = ", ".join(str(("k", *shape)).replace("'", "") for shape in (self.shape_of_pose, self.shape_of_twist))
            raise ValueError(f"times {times.shape}, poses {poses.shape}, twists {twists.shape}; expected (k,), {expected}")
        return poses.reshape(-1, self.count, 7), twists.reshape(-1, self.count, 6)

    def outside(self, values):
        """Values (..., platforms, width) as users see them: without the axis when there is one platform without a name."""
        return values if self.names is not None else values[..., 0, :]

    def _said(self, columns):
        return columns if self.names is None else f"a row {columns} for each of {', '.join(self.names)}"


def _checked(names, scene):
    """Names as a tuple."""
    coupled = [body.name for body in scene.bodies if body.kind == COUPLED]
    expected = f"expected names of its coupled bodies ({', '.join(coupled) or 'it has none'})"
    if isinstance(names, str) or not all(isinstance(name, str) for name in names):
        raise ValueError(f"platforms is {names!r}; expected a list of names, or None for one platform that carries all that is coupled")
    names = tuple(names)
    if not names or len(set(names)) < len(names):
        raise ValueError(f"platforms is {list(names)!r}; {expected}, each once, or None for one platform")
    for name in names:
        if name not in coupled:
            raise ValueError(f"platforms: the scene has no coupled body {name!r}; {expected}")
    left = [name for name in coupled if name not in names]
    left += [part.name for part in (*scene.points, *scene.rods) if part.kind in (COUPLED, COUPLED_PINNED)]
    if left:
        raise ValueError(f"platforms: {', '.join(left)}: coupled, but to none of {', '.join(names)}; expected every coupled body to be named, "
                         f"and every other coupled point or rod to be attached to one of them (as Body1 is to its points)")  # fmt: skip
    return names


def _poses_in_file(names, scene):
    if names is None:
        return [IDENTITY]
    bodies = {body.name: body for body in scene.bodies}
    return [(*bodies[name].position, *bodies[name].orientation) for name in names]
