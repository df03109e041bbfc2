"""What a simulator makes of the answers so far: the mooring's wrench some time after the last of them.

A step from t_n to t_{n+1} needs the wrench on the way, but the mooring has answered for t_n. Held over the step, that wrench is late
by h/2 on the average, which feeds the motion: a share ω h / 4 of critical damping is lost where the mooring gives all stiffness, and the error falls
with h. The others here are of second order, taken at the middle of the step. Figures: docs/coupling.md.
"""

import numpy as np

from mooring_ros.motion import rotation


class Held:
    """The last wrench (6,) itself. First order in the step."""

    needs_stiffness = False

    def __init__(self):
        self._wrench = None

    def take(self, time, pose, twist, wrench, stiffness=None):
        """Note an answer: time (s), pose (7,) and twist (6,) that were sent, wrench (6,); all in world axes. stiffness (6, 6), or None.

        Of several platforms (platforms, 7), (platforms, 6) and (6 platforms, 6 platforms).
        """
        self._wrench = np.array(wrench, float)

    def ahead(self, seconds):
        """The wrench (6,) so long after the last answer."""
        return self._wrench.copy()


class Extrapolated(Held):
    """A straight line through the last two answers; at h/2 this is 3/2 of the last less 1/2 of the one before (Adams–Bashforth)."""

    def __init__(self):
        super().__init__()
        self._time, self._rate = None, 0.0

    def take(self, time, pose, twist, wrench, stiffness=None):
        before, since = self._wrench, self._time
        super().take(time, pose, twist, wrench)
        self._rate = 0.0 if since is None else (self._wrench - before) / (time - since)
        self._time = time

    def ahead(self, seconds):
        return self._wrench + seconds * self._rate


class StiffnessPredicted(Held):
    """The spring part −K·(motion) from the platform's own twist, and a straight line through the last two for the rest.

    For a linear spring this is the leapfrog, which keeps the energy up to ω h = 2; a straight line alone gains energy long before.
    """

    needs_stiffness = True

    def __init__(self):
        super().__init__()
        self._last = None
        self._rate = 0.0

    def take(self, time, pose, twist, wrench, stiffness=None):
        super().take(time, pose, twist, wrench)
        pose, twist, stiffness = np.array(pose, float), np.array(twist, float), np.array(stiffness, float)
        rest = np.zeros(twist.size)
        if self._last is not None:
            then, place, before = self._last
            rest = ((self._wrench - before).ravel() + stiffness @ _move(place, pose)) / (time - then)
        self._last = time, pose, self._wrench
        self._rate = (rest - stiffness @ twist.ravel()).reshape(twist.shape)

    def ahead(self, seconds):
        return self._wrench + seconds * self._rate


def _move(before, after):
    """(6 platforms,): displacements and rotation vectors between poses."""
    pairs = zip(before.reshape(-1, 7), after.reshape(-1, 7))
    return np.concatenate([[*(new[:3] - old[:3]), *rotation.turn_between(old[3:], new[3:])] for old, new in pairs])


SCHEMES = {"held": Held, "extrapolated": Extrapolated, "stiffness": StiffnessPredicted}
