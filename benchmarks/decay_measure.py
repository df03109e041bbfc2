"""Period and damping of a decay."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mooring_ros.motion import rotation


@dataclass(frozen=True)
class Decay:
    """period: s. damping: share of critical, over all half periods."""

    period: float
    damping: float

    def against(self, other):
        """(share by which the period is longer, share of critical by which the damping is more) than another's."""
        return self.period / other.period - 1.0, self.damping - other.damping


def coordinate(poses, axis):
    """One motion (n,) of poses (n, 7): m, or the rotation vector's component in rad."""
    if axis < 3:
        return poses[:, axis]
    return np.array([rotation.rotation_vector(tuple(pose[3:]))[axis - 3] for pose in poses])


def measure(times, poses, twists, axis, halves):
    """The Decay over so many half periods after the release at rest.

    times (n,), poses (n, 7), twists (n, 6). The extremes are where the velocity passes zero, between samples by cubic Hermite curves; ranges from
    one extreme to the next know no offset.
    """
    place = CubicHermiteSpline(times, coordinate(poses, axis), twists[:, axis])
    turns = place.derivative().roots(extrapolate=False)
    spacing = 0.2 * np.median(np.diff(turns[turns > 0.0])) if turns.size > 2 else 0.0
    extremes = [times[0]]
    for turn in turns:
        if turn > extremes[-1] + spacing:
            extremes.append(turn)
    if len(extremes) < halves + 2:
        raise ValueError(f"{len(extremes)} extremes in {times[-1]:.1f} s, expected {halves + 2}")
    extremes = np.array(extremes[: halves + 2])
    ranges = np.abs(np.diff(place(extremes)))
    decrement = np.log(ranges[0] / ranges[-1]) / halves / np.pi
    return Decay(2.0 * (extremes[-1] - extremes[1]) / halves, decrement / np.hypot(1.0, decrement))
