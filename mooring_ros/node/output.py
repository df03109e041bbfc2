"""What stands between the computed wrench and the platform: ramp-in, hold, and limits on the force and its rate.

The total and the wrenches at the fairleads are treated alike, so that they keep adding up. Line tensions are results, not
commands: they go out as computed.
"""
import math
from collections import Counter

import numpy as np

FORCE, FORCE_RATE = "force", "force_rate"


class Output:
    """Turns the computed wrenches into those that go out.

    force: N, largest norm of the total force; a larger one is scaled down, moments with it. force_rate: N/s, fastest change of the total
    force; a faster one is followed at that rate. ramp_time: s, the cosine ramp after a start or a settle, from what went out before
    (nothing at first). hold_time: s, the ramp into the safe state. Zero switches a limit or ramp off. All may be changed at any time.

    The safe state is the static answer of the last settle: a constant force, about the mooring's mean, holds a floater and adds no energy.
    limited: how often each limit was reached; holding: why the output is held, or "".
    """

    def __init__(self, force=0.0, force_rate=0.0, ramp_time=0.0, hold_time=1.0):
        self.force, self.force_rate, self.ramp_time, self.hold_time = force, force_rate, ramp_time, hold_time
        self.limited = Counter()
        self.holding = ""
        self._sent = self._sent_at = None
        self._base = self._base_at = None
        self._ramp = 0.0
        self._safe = None

    def start(self, time, safe):
        """Begin at time (s) with the static wrenches `safe` (k, 6), row 0 the total; ends a hold."""
        self._safe = np.array(safe)
        self.holding = ""
        self._begin_ramp(time, self.ramp_time)

    def hold(self, time, why):
        """Ramp from what goes out now to the safe state and stay there, until `release` or `start`."""
        if not self.holding:
            self._begin_ramp(time, self.hold_time)
        self.holding = why

    def release(self, time):
        """Ramp back from the safe state to the computed wrenches."""
        if self.holding:
            self.holding = ""
            self._begin_ramp(time, self.hold_time)

    def apply(self, time, wrenches):
        """The wrenches (k, 6) that go out at time (s), for the computed ones, which are handed over: they may be the answer."""
        target = self._safe if self.holding else wrenches
        share = self._ramp_share(time)
        out = target if share >= 1.0 else share * target + (1.0 - share) * self._base
        size = _norm(out[0])
        if self.force and size > self.force:
            out = out * (self.force / size)
            self.limited[FORCE] += 1
        if self.force_rate and self._sent is not None:
            change = out - self._sent
            size, most = _norm(change[0]), self.force_rate * max(time - self._sent_at, 0.0)
            if size > most:
                out = self._sent + (most / size) * change
                self.limited[FORCE_RATE] += 1
        self._sent, self._sent_at = out, time
        return out

    def _begin_ramp(self, time, duration):
        self._ramp, self._base_at = duration, time
        self._base = np.zeros_like(self._safe) if self._sent is None else self._sent

    def _ramp_share(self, time):
        passed = time - self._base_at
        if passed >= self._ramp or self._ramp <= 0.0:
            return 1.0
        return 0.5 - 0.5 * math.cos(math.pi * max(passed, 0.0) / self._ramp)


def _norm(wrench):
    return math.hypot(wrench[0], wrench[1], wrench[2])
