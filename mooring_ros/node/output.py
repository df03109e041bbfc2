"""What stands between the wrench that is wanted and the platform: ramps, and limits on the force and its rate.

The total and the wrenches at the fairleads are treated alike, so that they keep adding up. Line tensions are results, not
commands: they go out as computed.
"""
import math
from collections import Counter

import numpy as np

FORCE, FORCE_RATE = "force", "force_rate"
RAMP_FROM = ZERO, STATIC = "zero", "static"


class Output:
    """Turns the wrenches that are wanted into those that go out.

    force: N, largest norm of the total force; a larger one is scaled down, moments with it. force_rate: N/s, fastest change of the total
    force; a faster one is followed at that rate. ramp_time: s, the cosine ramp after a start or a settle, from what went out before; at
    first, for ramp and rate, that is what ramp_from says: nothing (zero), or the static answer. hold_time: s, the ramp into and out of the static answer.
    totals: of how many platforms; the limits hold for each, and one factor for all, as lines hand on what they feel.
    Zero switches a limit or ramp off. All may be changed at any time. limited: how often each limit was reached;
    duration: s, of the ramp that goes on or was the last.
    """

    def __init__(self, force=0.0, force_rate=0.0, ramp_time=0.0, hold_time=1.0, ramp_from=ZERO, totals=1):
        self.force, self.force_rate, self.ramp_time, self.hold_time, self.ramp_from = force, force_rate, ramp_time, hold_time, ramp_from
        self.totals = totals
        self.limited = Counter()
        self._sent = self._sent_at = None
        self._base = self._base_at = None
        self.duration = 0.0

    def start(self, time, static, held=False):
        """Begin at time (s) with the static wrenches (k, 6), the totals first; or begin again, after a hold where held."""
        duration = self.hold_time if held else self.ramp_time
        if self._sent is None:
            duration = self.ramp_time
            self._sent, self._sent_at = np.zeros_like(static) if self.ramp_from == ZERO else np.array(static), time
        self._begin_ramp(time, duration)

    def turn(self, time):
        """Ramp over hold_time from what goes out now to what is wanted from now on."""
        self._begin_ramp(time, self.hold_time)

    def ramping(self, time):
        """Whether a ramp goes on at time (s)."""
        return self._share(time) < 1.0

    def apply(self, time, wanted):
        """The wrenches (k, 6) that go out at time (s), for the wanted ones, which are handed over: they may be the answer."""
        share = self._share(time)
        out = wanted if share >= 1.0 else share * wanted + (1.0 - share) * self._base
        size = self._largest(out)
        if self.force and size > self.force:
            out = out * (self.force / size)
            self.limited[FORCE] += 1
        if self.force_rate:
            change = out - self._sent
            size, most = self._largest(change), self.force_rate * max(time - self._sent_at, 0.0)
            if size > most:
                out = self._sent + (most / size) * change
                self.limited[FORCE_RATE] += 1
        self._sent, self._sent_at = out, time
        return out

    def _largest(self, wrenches):
        """Norm of the largest force on a platform."""
        return max(_norm(wrench) for wrench in wrenches[: self.totals])

    def _begin_ramp(self, time, duration):
        self._sent_at = min(self._sent_at, time)    # the source's clock may have been set back
        self.duration, self._base_at, self._base = duration, time, self._sent

    def _share(self, time):
        passed = time - self._base_at
        if passed >= self.duration or self.duration <= 0.0:
            return 1.0
        return 0.5 - 0.5 * math.cos(math.pi * max(passed, 0.0) / self.duration)


def _norm(wrench):
    return math.hypot(wrench[0], wrench[1], wrench[2])
