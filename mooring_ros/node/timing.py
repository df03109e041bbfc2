"""Timing policies, without a clock of their own: times are integer ns of a steady clock, handed in.

`input`: one step an input message, at the message's stamp. The source sets the pace, which is lockstep; there is nothing to decide.
`timer`: steps at a fixed rate on absolute deadlines, whatever the inputs do: `FixedRate` says which tick is due, `SourceClock`
what the source's clock shows then, so that the last motion can be carried on to that moment.
"""
from collections import deque

NS = 1e9
MODES = ("input", "timer")
WALL_CLOCK = 1_000_000_000_000_000_000     # ns: stamps beyond 2001 are those of a wall clock, earlier ones of a simulation


class FixedRate:
    """Ticks at start + k·period, k = 0, 1, 2, … A late tick does not move the later ones; missed ones are skipped and counted.

    early: share of a period by which the caller may come before a deadline and still means it: timers do, who sleeps until it does not.
    late: ns by which the last tick was; skipped: how many deadlines before it went by without one.
    """

    def __init__(self, rate, early=0.0):
        self.period = round(NS / rate)
        self.missed = self.ticks = self.late = self.skipped = 0
        self._early = round(early * self.period)
        self._start = None
        self._last = None

    def next(self, now):
        """The next deadline (ns)."""
        return now if self._start is None else self._start + (self._last + 1) * self.period

    def due(self, now):
        """Whether a tick that was not taken yet has come; takes it."""
        if self._start is None:
            self._start = now
        tick = (now - self._start + self._early) // self.period
        if self._last is not None:
            if tick <= self._last:
                return False
            self.skipped = tick - self._last - 1
            self.missed += self.skipped
        self._last = tick
        self.ticks += 1
        self.late = max(now - self._start - tick * self.period, 0)
        return True

    def restart(self):
        """The clock has been set back: the deadlines begin anew."""
        self._start = self._last = None


class SourceClock:
    """What the source's clock shows, learned from stamps and their times of arrival.

    The least delay seen tells the offset between the clocks best. It is let grow by `drift`, so that a source whose clock runs slow
    is followed; a source that is ahead is followed at once. The time it gives never runs backwards.
    """

    def __init__(self, drift=2e-4):
        self._drift = drift
        self._offset = self._heard = self._shown = None

    def hear(self, stamp, now):
        """A sample with this stamp (ns) arrived."""
        offset = now - stamp
        if self._offset is not None:
            offset = min(offset, self._offset + round(self._drift * (now - self._heard)))
        self._offset, self._heard = offset, now

    def now(self, now):
        """The source's clock (ns), or None before the first sample."""
        if self._offset is None:
            return None
        shown = now - self._offset
        self._shown = shown if self._shown is None else max(shown, self._shown)
        return self._shown

    def restart(self):
        """Forget all: the source has a new clock."""
        self._offset = self._heard = self._shown = None


class Pace:
    """How much of the core's time goes by for the time that its answers take, and the slowest of them."""

    def __init__(self, keep=1000):
        self._answers = deque(maxlen=keep)
        self.worst = None       # (ns, core time in s, evaluations, parts taken again) of the slowest step
        self.uneven = 0         # answers to steps in which tensions jump however fine they are

    def add(self, core_time, duration, last_step):
        """An answer at core_time (s) took `duration` (ns); last_step: of the mooring."""
        if not self._answers or core_time <= self._answers[-1][0]:
            self._answers.clear()       # a settle: its time is none of a step
            self._answers.append((core_time, 0))
            return
        self._answers.append((core_time, duration))
        self.uneven += last_step["uneven"] > 0
        if self.worst is None or duration > self.worst[0]:
            self.worst = duration, core_time, last_step["evaluations"], last_step["retries"]

    @property
    def real_time_factor(self):
        """Over the last answers; None before there are two."""
        if len(self._answers) < 2:
            return None
        spent = sum(duration for _, duration in self._answers) - self._answers[0][1]
        return 1e9 * (self._answers[-1][0] - self._answers[0][0]) / spent if spent else None
