"""The directions that clamped line ends hold on to: fixed ones, and those that the platform or a rigid part turns."""

from typing import NamedTuple

import numpy as np

from .cache import stage
from .layout import NO_PLATFORM
from .packed import packed
from .platform import rotate, turned


@packed
class Clamps(NamedTuple):
    """C clamps, in the order of `Bending`."""

    axis: np.ndarray  # (C, 3) unit vector into the line, in the axes of what turns it
    part: np.ndarray  # (C,) rigid part that turns it, or -1
    platform: np.ndarray  # (C,) platform that does, or -1


def build_clamps(found, platforms):
    """Clamps from `Layout.clamps` and the platforms (P,) of the internal points, -1 for those that are not coupled."""
    return Clamps(
        axis=np.array([axis for _, _, axis, _ in found], dtype=float).reshape(-1, 3),
        part=np.array([part for *_, part in found], dtype=np.int64),
        platform=np.array([platforms[point] if part < 0 else NO_PLATFORM for _, point, _, part in found], dtype=np.int64),
    )


@stage
def turn_clamps_with_platform(model, state, m, quaternion, phi):
    """Axes of the clamps on platform m, turned by `quaternion` and then by the rotation vector `phi` (3,)."""
    clamps = model.clamps
    for c in range(clamps.part.size):
        if clamps.platform[c] == m:
            axis = turned(phi, rotate(quaternion, (clamps.axis[c, 0], clamps.axis[c, 1], clamps.axis[c, 2])))
            for k in range(3):
                state.clamp_axis[c, k] = axis[k]


@stage
def turn_clamps_with_parts(model, state):
    clamps, parts = model.clamps, state.parts
    for c in range(clamps.part.size):
        b = clamps.part[c]
        if b >= 0:
            axis = rotate((parts[b, 3], parts[b, 4], parts[b, 5], parts[b, 6]), (clamps.axis[c, 0], clamps.axis[c, 1], clamps.axis[c, 2]))
            for k in range(3):
                state.clamp_axis[c, k] = axis[k]
