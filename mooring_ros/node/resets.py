"""Resets of a simulation: time that goes back on purpose, told from samples that come in the wrong order."""

REFUSE, SETTLE = POLICIES = ("refuse", "settle")
_BACK = 1_000_000_000   # ns by which no reordered sample is late


class Resets:
    """Recognises a reset.

    policy: `settle` begins anew at the next sample, with its statics; `refuse` counts the samples as reordered until ~/settle. count: resets seen.
    cause: words for the last.
    """

    def __init__(self, policy=REFUSE):
        self.policy, self.count, self.cause = policy, 0, ""
        self._first, self._clock_back, self._open = None, False, False

    @property
    def settles(self):
        """Whether a reset begins a new motion by itself."""
        return self.policy == SETTLE

    def clock_went_back(self):
        """/clock has jumped back: the next sample that is older than the last one follows a reset."""
        self._clock_back = True

    def begin(self, stamp):
        """A motion has begun at this stamp (ns): whatever is older belongs to another one."""
        self._first, self._clock_back, self._open = stamp, False, False

    def seen(self, stamp, last):
        """Whether a sample of this stamp (ns) follows a reset; last: stamp of the last accepted one."""
        if stamp >= last:
            self._open = False
            return False
        if not (self._clock_back or self._first is None or stamp < self._first or last - stamp > _BACK):
            return False
        self.count += not self._open     # one reset, however many of its samples are refused
        self._open = True
        self.cause = f"simulated time went back from {1e-9 * last:.3f} s to {1e-9 * stamp:.3f} s"
        return True
