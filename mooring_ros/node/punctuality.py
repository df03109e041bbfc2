"""How well the node keeps time: how long its answers take, and how evenly and how late its cycles begin."""
from collections import deque

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus

from mooring_ros.node.histogram import Histogram
from mooring_ros.node.timing import NS

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR
GRADES = {"warn": WARN, "error": ERROR}
# From where on a figure is a warning, and an error; values and most names are those of ros2_control. Mean error and standard deviation of the
# rate (Hz), mean and standard deviation of the time of a step (us).
RATE_ERROR, RATE_SPREAD, STEP_MEAN, STEP_SPREAD = THRESHOLDS = (
    "periodicity.mean_error", "periodicity.standard_deviation", "execution_time.mean", "execution_time.standard_deviation")
DEFAULTS = {RATE_ERROR: (5.0, 10.0), RATE_SPREAD: (5.0, 10.0), STEP_MEAN: (1000.0, 2000.0), STEP_SPREAD: (100.0, 200.0)}
UNITS = {RATE_ERROR: "Hz", RATE_SPREAD: "Hz", STEP_MEAN: "us", STEP_SPREAD: "us"}
KEEP = 1000         # cycles that the figures of the diagnostics are about
_ENOUGH = 20        # so many are needed before anything is judged


class Punctuality:
    """Of one activation. rate: Hz that is promised, 0: none, then nothing is judged, since a lockstep may be as slow as it likes.

    thresholds: name -> (warning, error), 0: never. steps, lateness: Histograms, of how long answers took and how late their cycles began.
    """

    def __init__(self, rate=0.0, thresholds=None):
        self.rate, self.thresholds = rate, dict(thresholds or DEFAULTS)
        self.steps, self.lateness = Histogram(), Histogram()
        self._begins, self._took = deque(maxlen=KEEP), deque(maxlen=KEEP)

    def begin(self, now, late=None, skipped=0):
        """A cycle begins at now (ns); late: ns after its deadline; skipped: deadlines before it that went by, and are as late as they are old.

        Without deadlines, what the interval has above the promised one.
        """
        if late is None and self.rate and self._begins:
            late = max(now - self._begins[-1] - round(NS / self.rate), 0)
        if late is not None:
            self.lateness.add(late)
            for k in range(1, skipped + 1):
                self.lateness.add(late + k * round(NS / self.rate))
        self._begins.append(now)

    def answered(self, took):
        """An answer took so many ns."""
        self.steps.add(took)
        self._took.append(took)

    def report(self):
        """(level, words, name -> value) over the last cycles."""
        values, figures = {}, {}
        if len(self._took) > 1:
            took = 1e-3 * np.array(self._took)
            figures |= {STEP_MEAN: took.mean(), STEP_SPREAD: took.std()}
            for name, share in (("p50", 50.0), ("p99", 99.0), ("max", 100.0)):
                values[f"input to wrench {name} (ms)"] = f"{1e-3 * np.percentile(took, share):.3f}"
            values["longest step (ms)"] = f"{1e-6 * self.steps.most:.3f}"
        intervals = np.diff(np.array(self._begins, dtype=float)) / NS
        if len(intervals) > 1 and intervals.min() > 0.0:
            mean = 1.0 / intervals.mean()
            values["cycles a second"] = f"{mean:.2f}"
            figures |= {RATE_ERROR: abs(mean - self.rate), RATE_SPREAD: (1.0 / intervals).std()}
        if self.lateness.most:
            values |= {"late p99 (ms)": f"{1e-6 * self.lateness.quantile(0.99):.3f}", "late max (ms)": f"{1e-6 * self.lateness.most:.3f}"}
        judged = self.rate > 0.0 and len(self._begins) >= _ENOUGH
        if judged:
            values |= {f"{name} ({UNITS[name]})": f"{value:.4g}" for name, value in figures.items()}
        return *(self._judge(figures) if judged else (OK, "")), values

    def _judge(self, figures):
        level, words = OK, []
        for name, value in figures.items():
            passed = [(grade, limit) for grade, limit in zip((WARN, ERROR), self.thresholds[name]) if limit and value > limit]
            if passed:
                grade, limit = passed[-1]
                level = max(level, grade)
                words.append(f"{name} is {value:.4g} {UNITS[name]}, limit {limit:g}")
        return level, "; ".join(words)
