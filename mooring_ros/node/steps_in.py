"""Steps that a source has left out, by the stamps that arrive: what a lockstep exposes on the receiving side.

A stamp that comes twice is the gate's to count; it never becomes a sample.
"""
from collections import deque
from statistics import median_low

_LEARNED_FROM = 11      # differences of stamps before anything is counted
_KEPT = 101


class StepsIn:
    """Counts the steps missing between accepted stamps.

    nominal: s between samples, or 0: the middle one of the last differences, so that a source which changes its step for good is followed.
    lost: steps that never came; gaps: how often some were missing.
    """

    def __init__(self, nominal=0.0):
        self._given = round(1e9 * nominal)
        self._differences = deque(maxlen=_KEPT)
        self._last, self._since = None, 0
        self._learned = 0
        self.lost = self.gaps = 0

    @property
    def nominal(self):
        """ns between samples, 0 while that is not known."""
        return self._given or self._learned

    def add(self, stamp):
        """An accepted sample of this stamp (ns). One that does not go forward begins anew."""
        last, self._last = self._last, stamp
        if last is None or stamp <= last:
            return
        difference = stamp - last
        if self.nominal:
            missing = (difference + self.nominal // 2) // self.nominal - 1
            self.lost += max(missing, 0)
            self.gaps += missing > 0
        self._learn(difference)

    def restart(self):
        """The next stamp follows none: a new motion begins."""
        self._last = None

    def _learn(self, difference):
        self._differences.append(difference)
        self._since += 1
        if len(self._differences) >= _LEARNED_FROM and (self._since >= _LEARNED_FROM or not self._learned):
            self._learned, self._since = median_low(self._differences), 0
