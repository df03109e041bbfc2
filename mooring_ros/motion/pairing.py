"""Poses and twists that come on two topics, put together by their stamps."""
from mooring_ros.motion.frames import twist_axes

_KEPT = 32


class Pairs:
    """A pose and a twist belong together when their stamps are equal, to the nanosecond; either may come first.

    When a pair is complete, older halves that still wait are given up: their partner was lost, and stamps do not go back. At most 32 halves
    wait on each side; the oldest goes. What is given up is counted in `unpaired`.
    """

    def __init__(self, twist_frame="child"):
        self._twist_frame = twist_frame
        self._poses, self._twists = {}, {}
        self.unpaired = 0

    def pose(self, sample):
        """Take a Sample without a twist; returns the whole Sample when its twist is there, else None."""
        return self._take(sample.stamp, sample, self._poses, self._twists)

    def twist(self, stamp, frame, twist):
        """Take a twist (6,) of this stamp (ns), its header's frame; returns the whole Sample when its pose is there, else None."""
        return self._take(stamp, (frame, twist), self._twists, self._poses)

    def _take(self, stamp, half, here, there):
        self.unpaired += stamp in here
        here[stamp] = half
        if stamp not in there:
            if len(here) > _KEPT:
                del here[next(iter(here))]
                self.unpaired += 1
            return None
        sample, (frame, twist) = self._poses.pop(stamp), self._twists.pop(stamp)
        for side in (self._poses, self._twists):
            for old in [waiting for waiting in side if waiting < stamp]:
                del side[old]
                self.unpaired += 1
        axes = twist_axes(frame, sample.frame, sample.child_frame, self._twist_frame)
        return sample._replace(twist=twist, twist_frame=axes)
