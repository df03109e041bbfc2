"""The part of a motion that the trade is measured on.

All of it where that is affordable. Otherwise the stretch around the highest tension whose standard deviation is nearest to that of
the whole, found with the scene's default setting; before it the motion swells from rest at the place where the stretch's run-in begins.
"""

from dataclasses import dataclass, field

import numpy as np

from mooring_ros.core.platform import rotation_between
from mooring_ros.motion import rotation

RUN_IN = 0.1  # of the whole motion: not compared
CYCLES = 5  # of the motion's period: the shortest window
RUN_IN_CYCLES = 3  # before a window that is not the whole motion
RUNS = 150.0  # what a trade takes, in runs of the default setting through its window
PLACES = 40  # of windows that are compared


@dataclass(frozen=True)
class Window:
    """times (k + 1,) s, poses (k + 1, 7), twists (k + 1, 6), or a row for each platform: the first sample is settled at. compared: first of the k answers that is compared."""

    times: np.ndarray = field(repr=False)
    poses: np.ndarray = field(repr=False)
    twists: np.ndarray = field(repr=False)
    compared: int
    whole: bool
    why: str

    @property
    def duration(self):
        return float(self.times[-1] - self.times[0])

    @property
    def interval(self):
        """s between samples, as most of them are."""
        return float(np.median(np.diff(self.times)))


def whole(motion):
    """The whole motion as a Window."""
    times = motion.times
    compared = int(np.searchsorted(times, times[0] + RUN_IN * (times[-1] - times[0]))) - 1
    compared = min(max(compared, 0), len(times) - 2)
    return Window(times, motion.poses, motion.twists, compared, True, f"the whole motion, of which the first {100 * RUN_IN:.0f} % are not compared")


def first_part(window):
    """The first tenth of a window, a hundred samples at least, to tell its cost from."""
    rows = slice(0, min(len(window.times), max(len(window.times) // 10, 100)))
    return Window(window.times[rows], window.poses[rows], window.twists[rows], 0, False, "the beginning")


def choose(motion, cost, tension, effort):
    """The Window for a trade of about `effort` s of CPU time.

    cost: CPU time of the default setting for one simulated second; tension: (k, lines) N of it over the whole motion, None where even
    that is too much: the speed of the motion then stands for it.
    """
    everything = whole(motion)
    affordable = effort / (RUNS * cost)
    period = motion_period(motion)
    length = max(affordable, CYCLES * period)
    run_in = RUN_IN_CYCLES * period
    if not length + run_in < 0.8 * everything.duration:
        return everything
    start, why = _place(motion, tension, length)
    begin = int(np.searchsorted(motion.times, start - run_in))
    first, last = int(np.searchsorted(motion.times, start)), int(np.searchsorted(motion.times, start + length))
    rows = slice(begin, last + 1)
    times, poses, twists = motion.times[rows], motion.poses[rows].copy(), motion.twists[rows].copy()
    if first > begin > 0:
        swell(times, poses, twists, times[first - begin] - times[0])
    return Window(times, poses, twists, max(first - begin - 1, 0), False, why)


def motion_period(motion):
    """Mean period of the motion, s: 2 pi times its standard deviation over that of its speed, in the directions or turns where it is fastest."""
    poses, twists = _each(motion.poses), _each(motion.twists)
    spread, rate = (values[:, :, :3].std(axis=0).ravel() for values in (poses, twists))
    if not rate.max() > 0.0:
        some = poses[:: max(1, len(poses) // 2000)]
        turned = np.array([[rotation_between(first[3:], pose[3:]) for first, pose in zip(poses[0], row)] for row in some])
        spread, rate = turned.std(axis=0).ravel(), twists[:, :, 3:].std(axis=0).ravel()
    axis = int(rate.argmax())
    return float(2.0 * np.pi * spread[axis] / rate[axis]) if rate[axis] > 0.0 else 0.0


def swell(times, poses, twists, duration):
    """Make the motion (in place) grow from rest at its first pose to itself over `duration` (s); poses (k, 7), twists (k, 6), or a row for each platform."""
    s = np.clip((times - times[0]) / duration, 0.0, 1.0)
    share, rate = s**3 * (10.0 + s * (6.0 * s - 15.0)), 30.0 * s**2 * (1.0 - s) ** 2 / duration
    for own_poses, own_twists in zip(_each(poses).swapaxes(0, 1), _each(twists).swapaxes(0, 1)):
        _swell(own_poses, own_twists, np.flatnonzero(s < 1.0), share, rate)


def _swell(poses, twists, rows, share, rate):
    """Of one platform, in place: `share` (k,) of the way from its first pose in `rows`, which grows at `rate` (k,) 1/s."""
    origin = poses[0].copy()
    for row in rows:
        moved = poses[row, :3] - origin[:3]
        turned = np.array(rotation_between(origin[3:], poses[row, 3:]))
        poses[row, :3] = origin[:3] + share[row] * moved
        poses[row, 3:] = rotation.multiply(rotation.from_rotation_vector(share[row] * turned), tuple(origin[3:]))
        twists[row, :3] = share[row] * twists[row, :3] + rate[row] * moved
        twists[row, 3:] = share[row] * twists[row, 3:] + rate[row] * turned


def _each(values):
    """Values (k, platforms, width), a view, of (k, width) or of themselves."""
    return values.reshape(len(values), -1, values.shape[-1])


def _place(motion, tension, length):
    """(start in s, why) of the window around the highest tension of the line that varies most, or around the highest speed."""
    times, instants = motion.times, motion.times[1:]
    what = "tension" if tension is not None else "speed of a platform"
    own = np.linalg.norm(_each(motion.twists)[1:, :, :3], axis=2).max(axis=1) if tension is None else tension[:, int(tension.std(axis=0).argmax())]
    usual = own[instants >= times[0] + RUN_IN * (times[-1] - times[0])].std()
    peak = instants[int(own.argmax())]
    starts = np.linspace(max(times[0], peak - length), min(peak, times[-1] - length), PLACES)
    spreads = np.array([own[(instants >= start) & (instants <= start + length)].std() for start in starts])
    best = int(np.abs(spreads - usual).argmin())
    return float(starts[best]), (
        f"{length:.4g} s around the highest {what}, where its standard deviation is nearest to that of the whole motion "
        f"({100.0 * (spreads[best] / usual - 1.0):+.0f} %)"
    )
