"""How fast a run goes."""

import time


class Pace:
    """Simulated and wall time of a run."""

    def __init__(self):
        self.started = time.perf_counter()
        self.first = self.last = self._warm = self._warm_at = None

    def note(self, instant):
        """An answer at this time (s) is out."""
        if self.first is None:
            self.first = instant
        elif self._warm is None:
            self._warm, self._warm_at = instant, time.perf_counter()
        self.last = instant

    @property
    def simulated(self):
        return 0.0 if self.last is None else self.last - self.first

    @property
    def elapsed(self):
        return time.perf_counter() - self.started

    @property
    def speed(self):
        if self._warm is None or self.last == self._warm:
            return self.simulated / self.elapsed
        return (self.last - self._warm) / (time.perf_counter() - self._warm_at)
