"""Where the platform will be a little later: what makes up for a delay, and for frames that are lost."""
import math

from mooring_ros.motion import rotation

REST = (0.0,) * 6
# Twists further apart than this (s) say nothing about the acceleration now.
_LONGEST_DIFFERENCE = 5.0


def carry_on(pose, twist, seconds, acceleration=REST):
    """The pose (7,) and twist (6,) reached after some seconds at constant acceleration.

    pose: m and unit quaternion. twist: m/s and rad/s, acceleration (6,): m/s² and rad/s², both in world axes. Exact for a motion
    whose acceleration does not change (in angle: about an axis that does not turn); else off by seconds³/6 times the jerk.
    """
    half = 0.5 * seconds * seconds
    position = tuple(x + seconds * v + half * a for x, v, a in zip(pose[:3], twist[:3], acceleration[:3]))
    turn = rotation.from_rotation_vector([seconds * w + half * a for w, a in zip(twist[3:], acceleration[3:])])
    q = rotation.multiply(turn, pose[3:])
    norm = math.hypot(*q)
    return (*position, *(c / norm for c in q)), tuple(v + seconds * a for v, a in zip(twist, acceleration))


def acceleration_between(time, twist, later, later_twist):
    """Mean acceleration (6,) between twists (6,) at two times (s); none where the second is not later, or too much later to say anything."""
    if not 0.0 < later - time <= _LONGEST_DIFFERENCE:
        return REST
    return tuple((new - old) / (later - time) for new, old in zip(later_twist, twist))


class Predictor:
    """Predicts each sample of a motion by `delay` (s), so that an answer that takes effect so much later is the answer for then.

    The acceleration is that of the caller, who may know it from a filter; else the difference of the last two twists. `delay` may be
    changed at any time. It needs no node: predict before `Mooring.step`, with one Predictor for each platform.
    """

    def __init__(self, delay=0.0):
        if not 0.0 <= delay < math.inf:
            raise ValueError(f"delay is {delay!r} s, expected zero or a positive number")
        self.delay = delay
        self._last = None

    def predict(self, time, pose, twist, acceleration=None):
        """(time + delay, pose (7,), twist (6,)) for a sample at time (s), with its acceleration (6,) if that is known."""
        pose, twist = tuple(pose), tuple(twist)
        if acceleration is None:
            acceleration = acceleration_between(*self._last, time, twist) if self._last else REST
        self._last = time, twist
        if self.delay == 0.0:
            return time, pose, twist
        return time + self.delay, *carry_on(pose, twist, self.delay, acceleration)

    def restart(self):
        """Forget the last sample: the platform has been put elsewhere."""
        self._last = None
