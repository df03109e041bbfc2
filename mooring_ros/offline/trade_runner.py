"""Runs settings through a window: from the cache where they are there, within the time that is given, with a bar that says how far it is."""

import sys
import time

from .console import ComputationFailed
from .trade_measure import measure

WIDTH = 24  # characters of the bar


class Bar:
    """A line on standard error; silent when that is no terminal."""

    def __init__(self, total, stream=None):
        """total: s of CPU time that are expected at most."""
        self._stream = sys.stderr if stream is None else stream
        self._shown, self._total, self._next, self._what, self._before = self._stream.isatty(), total, 0.0, "", 0.0
        self._began = time.process_time()

    def say(self, what, before):
        """what is being done, after `before` s of work."""
        self._what, self._before, self._began, self._next = what, before, time.process_time(), 0.0
        self.tick()

    def tick(self):
        now = time.monotonic()
        if not self._shown or now < self._next:
            return
        self._next = now + 0.2
        done = self._before + time.process_time() - self._began
        full = round(WIDTH * min(done / self._total, 1.0))
        self._stream.write(f"\r\x1b[Ktrade [{'#' * full}{'.' * (WIDTH - full)}] {done:.0f} of at most {self._total:.0f} s: {self._what}")
        self._stream.flush()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self._shown:
            self._stream.write("\r\x1b[K")
            self._stream.flush()


class Runner:
    """Measured runs of one scene. spent: s of CPU time that they took, now or when they came into the cache, so that a trade
    decides alike when it goes on. platforms: as of `Mooring`."""

    def __init__(self, scene, cache, bar, platforms=None):
        self.scene, self._cache, self._bar, self._platforms = scene, cache, bar, platforms
        self.window = None
        self.spent, self._warm, self._done = 0.0, set(), set()

    def run(self, setting, limit, timed=True, window=None, what="settings"):
        """Measured of a setting; `limit`: s of CPU time for one pass."""
        window = window or self.window
        name = self._cache.name(setting, window, timed)
        found = self._cache.recall(name, again=name in self._done)
        if found is not None and name in self._done:
            return found
        if found is None:
            kind = setting.fidelity, setting.solver
            first = "" if kind in self._warm else " (compiling first)"
            self._bar.say(f"{what}, {setting.method}, {setting.mesh} segments, step {setting.step}{first}", self.spent)
            found = measure(self.scene, setting, window, limit, timed, self._bar.tick, self._platforms)
            self._warm.add(kind)
            self._cache.keep(name, found)
        self.spent += found.spent
        self._done.add(name)
        return found

    @property
    def runs(self):
        """How many there were."""
        return len(self._done)

    def need(self, setting, limit=float("inf"), window=None, what="reference"):
        """As `run`, once, not timed; raises ComputationFailed where it is refused."""
        found = self.run(setting, limit, False, window, what)
        if found.refused:
            run = f"{setting.method}, {setting.mesh} segments, step {setting.step}"
            raise ComputationFailed(f"the {what} ({run}) cannot be computed: {found.refused}")
        return found
