"""Whether what the node answered is right: the same samples through a `Mooring` in this process."""
import math

import numpy as np

from mooring_ros import Mooring
from mooring_ros.scene import load_scene

TOLERANCE = 1e-9        # of the largest force or moment of the mooring


class Wrong(AssertionError):
    """The node did what it must not."""


class Judge:
    """Follows one session of the node. good: stamp (ns) -> motion.State of each sample that may be answered."""

    def __init__(self, scene):
        self._scene = load_scene(scene)
        self.checked, self.worst = 0, 0.0
        self.begin()

    def begin(self):
        """A new session: the first answer settles."""
        self._mooring = Mooring(self._scene)
        self.good = {}
        self._settle_at = None
        self._last = None

    def settle(self, stamp):
        """The node was asked to settle where the sample with this stamp is; None: where the next answered one is."""
        self._settle_at, self._last = stamp, None

    def release(self, line):
        """The node let go of a line at the wrench judged last."""
        self._mooring.release(line)

    def check(self, heard):
        """Compare a wrench; raises Wrong. Call it once for each, in order of arrival."""
        if not all(map(math.isfinite, heard.wrench)):
            raise Wrong(f"a wrench that is not finite: {heard.wrench}")
        state = self.good.get(heard.stamp)
        if state is None:
            raise Wrong(f"the stamp {heard.stamp * 1e-9:.9f} s is answered, expected no answer to it")
        if self._last is None:
            at = heard.stamp if self._settle_at is None else self._settle_at
            self._origin = at if at >= 1_000_000_000_000_000_000 else 0
            self._mooring.settle(self.good[at].pose, time=(at - self._origin) * 1e-9)
            self._last, self._settle_at = at, None
        elif heard.stamp <= self._last:
            raise Wrong(f"the stamp {heard.stamp * 1e-9:.9f} s is answered after {self._last * 1e-9:.9f} s, expected later ones alone")
        if heard.stamp > self._last:
            self._mooring.step((heard.stamp - self._origin) * 1e-9, state.pose, state.twist)
            self._last = heard.stamp
        self._compare(heard)

    def _compare(self, heard):
        expected = self._mooring.wrench
        off = np.abs(np.array(heard.wrench) - expected)
        scale = np.repeat([np.abs(expected[:3]).max(), np.abs(expected[3:]).max()], 3)
        self.worst = max(self.worst, float((off / scale).max()))
        if self.worst > TOLERANCE:
            raise Wrong(f"the wrench at {heard.stamp * 1e-9:.9f} s is {np.array(heard.wrench)}, expected {expected}")
        self.checked += 1
