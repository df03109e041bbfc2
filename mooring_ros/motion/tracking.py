"""Motion from poses alone, as they come: a Kalman filter for measured poses, which are noisy.

A platform's jerk is taken as white noise, the measured pose as true plus white noise of the same size in every frame; position and
rotation vector are filtered alike, each axis by itself. For frames of equal spacing the filter settles to a Butterworth observer of third
order: gains 2 w, 2 w², w³ on pose, twist and acceleration, with w = 2 pi times the bandwidth (Kalman and Bucy 1961 for a triple integrator). So one
number says all, and the noise itself need not be known. Unlike a fit through a window it weighs each frame by the time that passed before
it: frames that are missing need no rule of their own. What it does to a motion, noise and lag, is in docs/motion_capture.md.
"""
import math
from typing import NamedTuple

from mooring_ros.motion import rotation
from mooring_ros.motion.prediction import REST, carry_on

# Of the first pose: how unsure its twist and acceleration are, in the noise of one pose times w and w².
_UNSURE = 100.0
# After a pause of so many periods of the bandwidth nothing is left to carry on: twist and acceleration are found anew.
_FORGET = 2.0


class Estimate(NamedTuple):
    """Where a platform is, by a filter or a difference of poses. covariance: of one axis, in the noise of one measured pose, ((3,) × 3)."""

    time: float             # s
    pose: tuple             # (7,)
    twist: tuple            # (6,) world axes
    acceleration: tuple     # (6,) world axes
    covariance: tuple = ()


class PoseFilter:
    """Pose, twist and acceleration from measured poses, at the newest of them.

    period: s between two frames, nominally. bandwidth: Hz; what moves slower is followed, what is faster is noise. Both by the clock of the
    times handed in. `propose` says what a pose would give, `take` goes there; a pose that is only proposed leaves no trace.
    """

    def __init__(self, period, bandwidth):
        if not (0.0 < period < math.inf and 0.0 < bandwidth < 0.5 / period):
            raise ValueError(f"period {period!r} s and bandwidth {bandwidth!r} Hz: expected positive numbers, the bandwidth below half the rate")
        self.bandwidth = bandwidth
        self._omega = 2.0 * math.pi * bandwidth
        self._jerk = period * self._omega ** 6
        self._longest = _FORGET / bandwidth
        unsure, more = (_UNSURE * self._omega) ** 2, (_UNSURE * self._omega ** 2) ** 2
        self._unsure = (1.0, 0.0, 0.0), (0.0, unsure, 0.0), (0.0, 0.0, more)
        self._last = None

    def propose(self, time, pose):
        """The Estimate for a pose (7,) measured at a time (s) later than the last. The first one is at rest."""
        last = self._last
        if last is None:
            return Estimate(time, tuple(pose), REST, REST, self._unsure)
        dt = time - last.time
        if dt > self._longest:
            last = Estimate(last.time, last.pose, REST, REST, self._unsure)
        led, twist = carry_on(last.pose, last.twist, dt, last.acceleration)
        off = [b - a for a, b in zip(led[:3], pose[:3])]
        off += rotation.turn_between(led[3:], pose[3:])
        covariance = _led(last.covariance, dt, self._jerk)
        total = covariance[0][0] + 1.0
        gain = [row[0] / total for row in covariance]
        turn = rotation.from_rotation_vector([gain[0] * c for c in off[3:]])
        q = rotation.multiply(turn, led[3:])
        norm = math.hypot(*q)
        return Estimate(time, (*(x + gain[0] * c for x, c in zip(led[:3], off[:3])), *(c / norm for c in q)),
                        tuple(v + gain[1] * c for v, c in zip(twist, off)), tuple(a + gain[2] * c for a, c in zip(last.acceleration, off)),
                        tuple(tuple(covariance[i][j] - gain[i] * covariance[0][j] for j in range(3)) for i in range(3)))

    def take(self, estimate):
        """Go on from an Estimate that was proposed."""
        self._last = estimate


def _led(p, t, jerk):
    """A covariance (3 × 3) carried on by t (s) under white jerk of this density: F P Fᵀ + Q of the triple integrator."""
    h = 0.5 * t * t
    rows = ([p[0][j] + t * p[1][j] + h * p[2][j] for j in range(3)], [p[1][j] + t * p[2][j] for j in range(3)], p[2])
    led = [[row[0] + t * row[1] + h * row[2], row[1] + t * row[2], row[2]] for row in rows]
    noise = ((t ** 5 / 20.0, t ** 4 / 8.0, t ** 3 / 6.0), (t ** 4 / 8.0, t ** 3 / 3.0, h), (t ** 3 / 6.0, h, t))
    return [[led[i][j] + jerk * noise[i][j] for j in range(3)] for i in range(3)]
