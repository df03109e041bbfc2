"""When each frame of a camera system was taken, from stamps that only say when it arrived.

Frames are taken at a steady rate, but stamps are often those of arrival: frames 4 ms apart come 0.1 ms apart after a pause (bunched), late by
some ms here and there, and some never come. The nominal rate tells the kinds of gap apart as far as that can be known:

- After a pause a frame may be any of those due since the last. The one whose predicted place fits the measured pose best is taken, of about
  equal ones the earliest: a frame labelled too early is put right by the next, one labelled too late leaves no room for the bunch behind it.
- A bunch comes at once. A frame that is behind its due time and not followed within half a period shows that frames were lost.

The phase follows the stamps: by a tenth of a period a frame towards earlier ones, which are nearer the truth, slowly towards later ones.
"""
import math

_EARLIER, _LATER = 0.1, 0.01    # of a period, by which one frame moves the phase
_CLEARLY = 2.0                  # a fit is better when it misses by so much less
_MOST = 50                      # frames due in a pause; in a longer one they are lost, not late


class FrameClock:
    """Times of frames (ns) from their stamps (ns), at a nominal rate (Hz, by the clock of the stamps).

    late, skipped: frames that came more than half a period after the phase says, and frames that never came.
    """

    def __init__(self, rate):
        if not 0.0 < rate < math.inf:
            raise ValueError(f"rate is {rate!r} Hz, expected a positive number")
        self.period = 1e9 / rate
        self.late = self.skipped = 0
        self._time = self._stamp = None
        self._ahead = False

    def propose(self, stamp, miss=None):
        """The time (ns) of a frame with a stamp later than the last, itself later than the last; None when it comes before it is due.

        miss(time) -> m: how far the measured pose lies from where the motion leads at that time; None: not known.
        """
        if self._time is None:
            return stamp
        period, passed = self.period, stamp - self._time
        # Labels that ran ahead (the first stamp was late, or the rate is higher than said) wait for the stamps to come up.
        self._ahead = passed < (0.5 if self._ahead else -0.5) * period
        if self._ahead:
            return None
        most = max(1, round(passed / period))
        lag = round((self._stamp - self._time) / period)
        in_a_bunch = stamp - self._stamp < 0.5 * period
        first = 1 if in_a_bunch else min(max(1, 1 + lag), most)
        frames = self._best(first, most, miss)
        off = passed - frames * period
        return round(self._time + frames * period + min(max(off, -_EARLIER * period), _LATER * period))

    def _best(self, first, most, miss):
        if first == most or most - first > _MOST:
            return most
        if miss is None:
            return first
        misses = [miss(self._time + frames * self.period) for frames in range(first, most + 1)]
        least = min(misses)
        return first + next(k for k, value in enumerate(misses) if value <= _CLEARLY * least)

    def take(self, time, stamp):
        """Go on from a frame whose time was proposed."""
        if self._time is not None:
            self.skipped += max(0, round((time - self._time) / self.period) - 1)
            self.late += stamp - time > 0.5 * self.period
        self._time, self._stamp = time, stamp
