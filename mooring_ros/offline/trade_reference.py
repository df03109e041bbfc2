"""The reference of a trade: the explicit dynamics on meshes and with steps refined until their differences say that it is converged.

Its tension is the norm of the end force, which converges with the second order of the mesh; the tension of the end segment stands half a
segment beside it, and comes to it with the first.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from mooring_ros.mooring import Mooring

from .console import ComputationFailed
from .trade_errors import Errors, errors_between
from .trade_setting import Setting, step_of, steps_in

WELL_BELOW = 0.1  # of the error asked for: where refining ends
FIRST = 2  # of the file's segments: the reference is no coarser
MOST_ORDER, LEAST_ORDER = 2.0, 1.0  # what an observed order counts as, at most and at least
PATIENCE = 2  # refinements in a row that only make it worse
PARTS = ("mean", "dynamic", "peak")


@dataclass(frozen=True)
class Level:
    """One run of the reference: `refine` times the file's segments, steps in a sample, what it was, and how far the coarser one was from it."""

    refine: int
    steps: int
    setting: Setting
    cost: float
    space: Errors | None  # of the run with half the segments, against this
    time: Errors | None  # of the run with half the steps, against this


@dataclass(frozen=True)
class Reference:
    """tension (k, lines) N; error (3,) per cent: what is left in mean, dynamic and peak; orders: observed in space and time, None where there
    are not three runs to observe it in; refine: of the file's segments; steps: in a sample; levels: all runs; converged: error
    below `target`; why: in words, why refining ended."""

    tension: np.ndarray
    error: np.ndarray
    space_error: np.ndarray
    time_error: np.ndarray
    space_order: np.ndarray
    time_order: np.ndarray
    refine: int
    steps: int
    setting: Setting
    levels: list = ()
    target: float = math.nan
    converged: bool = False
    why: str = ""

    def as_dict(self):
        """For --json."""
        return {
            "segments_factor": self.refine, "setting": self.setting.arguments(), "steps_per_sample": self.steps,
            "error": dict(zip(PARTS, self.error.tolist())), "error_space": dict(zip(PARTS, self.space_error.tolist())),
            "error_time": dict(zip(PARTS, self.time_error.tolist())), "order_space": dict(zip(PARTS, self.space_order)),
            "order_time": dict(zip(PARTS, self.time_order)), "target": self.target, "converged": self.converged, "why": self.why,
            "levels": [
                {"segments_factor": level.refine, "steps_per_sample": level.steps, "cost": level.cost,
                 "space_difference": level.space and dict(zip(PARTS, level.space.parts().tolist())),
                 "time_difference": level.time and dict(zip(PARTS, level.time.parts().tolist()))}
                for level in self.levels
            ],
        }


class Refinement:
    """Runs of the reference by (doublings of the mesh, doublings of the steps)."""

    def __init__(self, scene, window, run):
        """run(setting) -> Measured, untimed; raises ComputationFailed where it is refused."""
        self._scene, self._window, self._run = scene, window, run
        self._done = {}

    def level(self, k, m):
        """The run on 2^k times the file's segments with 2^m times the steps of the default there."""
        if (k, m) not in self._done:
            refine = float(2**k)
            limit = Mooring(self._scene, solver="explicit", refine=refine).step_limit.dt
            steps = steps_in(self._window.interval, limit) * 2**m
            setting = Setting("dynamic", "explicit", None if m == 0 else step_of(self._window.interval, steps), refine=refine)
            self._done[k, m] = steps, setting, self._run(setting)
        return self._done[k, m]

    def tension(self, k, m):
        """(k, lines) N over the part of the window that is compared."""
        return self.level(k, m)[2].force[self._window.compared :]

    def cost(self, k, m):
        """s of CPU time that the run took, or would take: by the costs of those that are there."""
        if (k, m) in self._done:
            return 0.0
        known = max((key for key in self._done), key=lambda key: (key[0], key[1]))
        growth = 4.0
        if (known[0] - 1, known[1]) in self._done:
            growth = self._done[known][2].cost / self._done[known[0] - 1, known[1]][2].cost
        return self._done[known][2].cost * self._window.duration * growth ** (k - known[0]) * 2.0 ** (m - known[1])

    def difference(self, coarse, fine):
        """Errors of one run against another, None where one is not there."""
        if coarse not in self._done or fine not in self._done:
            return None
        return errors_between(self.tension(*coarse), self.tension(*fine))

    def levels(self):
        """All runs as Levels, coarsest mesh first."""
        made = []
        for k, m in sorted(self._done):
            steps, setting, measured = self._done[k, m]
            made.append(Level(2**k, steps, setting, measured.cost, self.difference((k - 1, m), (k, m)), self.difference((k, m - 1), (k, m))))
        return made


def converged_reference(scene, window, run, target, time_left):
    """Reference whose own error is below `target` (per cent), or the best that `time_left` () s of CPU time, asked again and again, allow."""
    runs = Refinement(scene, window, run)
    k, m = FIRST.bit_length() - 1, 0
    for place in ((0, 0), (0, 1), (0, 2), (k, m)):
        runs.level(*place)
    best, worse = None, 0
    while True:
        found = _estimate(runs, k, m)
        worse = 0 if best is None or found.error.max() < best.error.max() else worse + 1
        best = found if worse == 0 else best
        if best.error.max() <= target:
            why = "its own error is below a tenth of what is asked for"
            break
        if worse == PATIENCE:
            why = f"finer runs (to {2**k} times the file's segments) differ more, not less"
            break
        finer = (k + 1, m) if found.space_error.max() >= found.time_error.max() else (k, m + 1)
        expected = runs.cost(*finer) + (runs.cost(0, finer[1] + 2) if finer[1] > m else 0.0)
        if expected > time_left():
            why = f"the next refinement would take {expected:.3g} s of CPU time, of {max(time_left(), 0.0):.3g} s that are left for it"
            break
        k, m = finer
        try:
            for place in ((0, m + 2), *((j, m) for j in range(max(k - 2, 0), k + 1))):
                runs.level(*place)
        except ComputationFailed as failure:
            why = str(failure)
            break
    return replace(best, levels=runs.levels(), target=target, converged=bool(best.error.max() <= target), why=why)


def _estimate(runs, k, m):
    """The run (k, m) as a Reference, with what its neighbours say of its error."""
    space, space_order = _left(runs, [(j, m) for j in range(k + 1)])
    steps, time_order = _left(runs, [(0, j) for j in range(m + 3)])
    # measured on the file's mesh, where it costs little, with other steps than the reference's
    steps *= (runs.level(0, m + 2)[0] / runs.level(k, m)[0]) ** np.array([_counted(order) for order in time_order])
    count, setting, _ = runs.level(k, m)
    return Reference(runs.tension(k, m), space + steps, space, steps, space_order, time_order, 2**k, count, setting)


def _left(runs, places):
    """((3,) error of the last place, (3,) observed orders or None): Richardson's estimate from the differences of neighbours."""
    last = runs.difference(*places[-2:])
    before = runs.difference(*places[-3:-1]) if len(places) > 2 else None
    if last is None:
        return np.zeros(3), [None] * 3
    left, orders = [], []
    for index, difference in enumerate(last.parts()):
        order = None
        if before is not None and difference > 0.0 and before.parts()[index] > 0.0:
            order = math.log2(before.parts()[index] / difference)
        left.append(difference / (2.0 ** _counted(order) - 1.0))
        orders.append(order)
    return np.array(left), orders


def _counted(order):
    return LEAST_ORDER if order is None else min(max(order, LEAST_ORDER), MOST_ORDER)
