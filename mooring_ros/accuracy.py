"""How far a mooring's answers are from a converged dynamic one, estimated by solving a window of motion again on a finer mesh with half the step.

The same window is solved with the present settings, with twice the segments and half the step, and with half the segments and twice the step. All
begin at rest, the motion swelling over the first part of the window, which is not compared. The difference to the finer one, and the order by which
the differences shrink, give the error by Richardson's extrapolation; the cheaper fidelities are compared with the finer dynamic solution as they are.
The tension is the norm of the end force at the fairlead, errors are those of `offline.trade_errors`: per cent, the worst line of each.
"""

import math
import time
from dataclasses import asdict, dataclass

import numpy as np

from .mooring import Mooring, MooringError
from .offline.trade_errors import errors_between
from .offline.trade_window import swell

LEAD = 1.0 / 3.0  # of a window: the motion swells, nothing is compared
CHUNK = 0.02  # s of CPU time between two pauses
LEAST_SAMPLES = 30  # of a window
LEAST_ORDER, MOST_ORDER = 1.2, 2.0  # what an observed order counts as
LEAST_SEGMENTS = 4  # of a line, for a coarser mesh that still says something


@dataclass(frozen=True)
class Accuracy:
    """Errors in per cent of mean, dynamic (rms about the mean, over the standard deviation) and peak tension; line: the one with the worst.

    begin, end: of what was compared, s; compared: with what, in words; orders: observed for each of the three, None where there was no coarser mesh;
    cpu: s that it took; why: why there is no estimate, else "".
    """

    mean: float | None
    dynamic: float | None
    peak: float | None
    line: str
    begin: float
    end: float
    compared: str
    orders: tuple | None
    cpu: float
    why: str = ""

    def as_dict(self):
        """For JSON."""
        return asdict(self)


def estimate(scene, settings, times, poses, twists, lengths=None, released=(), pause=lambda cpu: None):
    """Accuracy of `Mooring(scene, **settings)` over a window of motion: times (k,) s, poses (k, 7), twists (k, 6).

    lengths: (lines,) m unstretched, None for the scene's; released: names of lines let go. pause(cpu): called now and then with the s of CPU time
    spent since the last call. A window that cannot be solved gives an Accuracy that says why.
    """
    times, poses, twists = (np.array(rows, dtype=float) for rows in (times, poses, twists))
    first = int(np.searchsorted(times, times[0] + LEAD * (times[-1] - times[0]))) if times.size else 0
    spent = _Spent(pause)

    def without(why, compared=""):
        ends = (float(times[first]), float(times[-1])) if times.size > first else (math.nan, math.nan)
        return Accuracy(None, None, None, "", *ends, compared, None, spent.total, why)

    if times.size < LEAST_SAMPLES or not times.size - first > LEAST_SAMPLES // 3:
        return without(f"{times.size} samples, expected {LEAST_SAMPLES} or more")
    swell(times, poses, twists, times[first] - times[0])

    def tension(**changed):
        mooring = Mooring(scene, **{**settings, **changed})
        return _tension(mooring, times, poses, twists, lengths, released, spent)[first - 1 :]

    compared = ""
    try:
        own = Mooring(scene, **settings)
        cheap = own.fidelity != "dynamic"
        step = None if cheap else own.step_limit.dt
        compared = _words(own, step)
        mine = tension()
        finer = {**_mesh(settings, 2), "fidelity": "dynamic", "solver": own.solver, "dt": None if cheap else 0.5 * step}
        fine = tension(**finer)
        errors = errors_between(mine, fine)
        parts, orders = errors.parts(), None
        if not cheap:
            if min(own.segments) >= LEAST_SEGMENTS:
                coarse = errors_between(tension(**_mesh(settings, 0.5), dt=2.0 * step, solver=own.solver), mine).parts()
                orders = tuple(_order(before, after) for before, after in zip(coarse, parts))
            factors = [2.0**order / (2.0**order - 1.0) for order in orders or (LEAST_ORDER,) * 3]
            parts = parts * np.array(factors)
    except (MooringError, ValueError) as error:
        return without(str(error), compared)
    spent.pause()
    mean, dynamic, peak = (float(part) for part in parts)
    return Accuracy(mean, dynamic, peak, own.line_names[errors.line], float(times[first]), float(times[-1]), compared, orders, spent.total)


def _mesh(settings, factor):
    """Arguments for `factor` times the segments of `settings`."""
    if settings.get("segments"):
        return {"segments": max(1, round(factor * settings["segments"]))}
    return {"refine": factor * settings.get("refine", 1.0)}


def _order(before, after):
    """Order of convergence that two differences show, bounded."""
    if not before > 0.0 or not after > 0.0:
        return MOST_ORDER
    return min(max(math.log2(before / after), LEAST_ORDER), MOST_ORDER)


def _words(own, step):
    if own.fidelity != "dynamic":
        return f"with the dynamics ({own.solver}) on twice the segments"
    return f"with twice the segments ({sum(own.segments)} to {2 * sum(own.segments)}) and half the step ({step:.4g} to {0.5 * step:.4g} s), {own.solver}"


class _Spent:
    """CPU time of this process, with pauses between its parts."""

    def __init__(self, pause):
        self._pause, self.total, self._since = pause, 0.0, time.process_time()

    def pause(self):
        now = time.process_time()
        spent = now - self._since
        self.total += spent
        self._pause(spent)
        self._since = time.process_time()


def _tension(mooring, times, poses, twists, lengths, released, spent):
    """(k - 1, lines) N: norms of the fairlead end forces after the first sample."""
    for name, length in zip(mooring.line_names, () if lengths is None else lengths):
        mooring.set_unstretched_length(name, length)
    mooring.settle(poses[0], time=times[0])
    for name in released:
        mooring.release(name)
    found, row, count = [], 1, 4
    while row < times.size:
        part = slice(row, min(row + count, times.size))
        before = time.process_time()
        history = mooring.run(times[part], poses[part], twists[part])
        took = time.process_time() - before
        found.append(np.linalg.norm(history.fairlead_end_force, axis=2))
        row = part.stop
        count = max(1, min(int(count * CHUNK / max(took, 1e-6)), 4 * count))
        spent.pause()
    return np.concatenate(found)
