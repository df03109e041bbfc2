"""A recorded motion at other times, on the curve that the mooring core itself runs along between two samples."""

import numpy as np

from mooring_ros.core.platform import platform_at, start_motion
from mooring_ros.motion import rotation

_SAME_TIME = 1e-9  # s: a recorded sample this near is taken as it is


def resample(times, poses, twists, rate):
    """The motion at rate Hz from its first time on: times (k,), poses (k, 7), twists (k, 6).

    times (n,) s, increasing; poses (n, 7); twists (n, 6), world frame. In between, position and rotation are cubic Hermite
    curves of pose and twist, as in the core; where a recorded sample falls on a new time, it is taken unchanged, its time included.
    Of several platforms poses are (n, platforms, 7), twists (n, platforms, 6), and so are the new ones.
    """
    times, poses, twists = (np.asarray(values, dtype=float) for values in (times, poses, twists))
    if poses.ndim == 3:
        each = [resample(times, poses[:, own], twists[:, own], rate) for own in range(poses.shape[1])]
        return each[0][0], *(np.stack(rows, axis=1) for rows in list(zip(*each))[1:])
    steps = int(np.floor((times[-1] - times[0]) * rate * (1.0 + 1e-12) + 1e-9))
    new_times = times[0] + np.arange(steps + 1) / rate
    new_poses, new_twists = np.empty((steps + 1, 7)), np.empty((steps + 1, 6))
    curve, started = np.zeros((8, 3)), -1
    for row, instant in enumerate(new_times):
        nearest = _nearest(times, instant)
        if abs(times[nearest] - instant) <= _SAME_TIME:
            new_times[row], new_poses[row], new_twists[row] = times[nearest], poses[nearest], twists[nearest]
            continue
        start = min(int(np.searchsorted(times, instant, side="right")) - 1, len(times) - 2)
        duration = times[start + 1] - times[start]
        if start != started:
            start_motion(poses[start], twists[start], poses[start + 1], twists[start + 1], duration, curve)
            started = start
        place, velocity, turn, turning = platform_at(curve, (instant - times[start]) / duration)
        quaternion = np.array(rotation.multiply(rotation.from_rotation_vector(turn), tuple(poses[start, 3:])))
        new_poses[row] = *place, *(quaternion / np.linalg.norm(quaternion))
        new_twists[row] = *velocity, *turning
    return new_times, new_poses, new_twists


def _nearest(times, instant):
    after = min(int(np.searchsorted(times, instant)), len(times) - 1)
    before = max(after - 1, 0)
    return before if abs(times[before] - instant) < abs(times[after] - instant) else after
