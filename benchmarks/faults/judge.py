"""Whether what the node answered is right: the same samples through a `Mooring` in this process."""
import math

import numpy as np

from mooring_ros import Mooring
from mooring_ros.scene import load_scene

BLEND_TOLERANCE = 1e-6  # of the largest number of the target
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
        self.tolerance = TOLERANCE
        self._settle_at = None
        self._last = None
        self._held, self._base, self.share = False, None, 1.0

    def settle(self, stamp):
        """The node was asked to settle where the sample with this stamp is; None: where the next answered one is."""
        self._settle_at, self._last = stamp, None
        self._blend()

    @property
    def holds(self):
        """Whether wrenches of a hold were heard."""
        return self._held and self._base is not None

    @property
    def blends(self):
        """Whether the output is still on its way back to what is computed."""
        return self._base is not None

    def held(self):
        """From here on the node may take its output to the static wrench at the last good pose, and keep it there."""
        self._held = True

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
        elif self._held and heard.stamp == self._last:
            return self._compare_held(heard)
        elif heard.stamp <= self._last:
            raise Wrong(f"the stamp {heard.stamp * 1e-9:.9f} s is answered after {self._last * 1e-9:.9f} s, expected later ones alone")
        if heard.stamp > self._last:
            self._blend()
            self._mooring.step((heard.stamp - self._origin) * 1e-9, state.pose, state.twist)
            self._last = heard.stamp
        self._compare(heard)

    def _compare(self, heard):
        expected = self._mooring.wrench
        if self._base is not None:
            return self._compare_blend(heard, expected)
        self._sent = np.array(heard.wrench)
        off = np.abs(np.array(heard.wrench) - expected)
        scale = np.repeat([np.abs(expected[:3]).max(), np.abs(expected[3:]).max()], 3)
        share = float((off / scale).max())
        self.worst = max(self.worst, share)
        if share > self.tolerance:
            raise Wrong(f"the wrench at {heard.stamp * 1e-9:.9f} s is {np.array(heard.wrench)}, expected {expected}")
        self.checked += 1

    def _blend(self):
        """What comes after a hold begins from what went out, and is blended over to what is computed."""
        if self._held and self._base is not None:
            self._held, self._base, self.share = False, self._sent, 0.0

    def _compare_held(self, heard):
        """On the way from the wrench before to the static one at the last good pose."""
        if self._base is None:
            self._base, self.share = self._sent, 0.0
            twin = Mooring(self._scene)
            twin.settle(self.good[self._last].pose, time=(self._last - self._origin) * 1e-9)
            self._static = twin.wrench
        self._compare_blend(heard, self._static)

    def _compare_blend(self, heard, target):
        """The wrench lies between the base and its target, and does not go back."""
        way, gone = target - self._base, np.array(heard.wrench) - self._base
        share = float(way @ gone / (way @ way)) if way @ way else 1.0
        off = np.abs(gone - share * way).max() / np.abs(target).max()
        if off > BLEND_TOLERANCE or not -BLEND_TOLERANCE <= share <= 1.0 + BLEND_TOLERANCE:
            raise Wrong(f"the wrench {heard.wrench} at {heard.stamp * 1e-9:.9f} s is not between {self._base} and {target}")
        self.share = share
        self._sent = np.array(heard.wrench)
        self.checked += 1
        if not self._held and share >= 1.0 - BLEND_TOLERANCE:
            self._base = None
