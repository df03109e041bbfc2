"""How far a mooring's answers are from a converged dynamic one, estimated by solving a window of motion again on a finer mesh with half the step.

The same window is solved with the present settings, with twice the segments and half the step, and with half the segments and twice the step. All
begin at rest, the motion swelling over the first part of the window, which is not compared. Richardson's extrapolation carries the finer history on
to where the three lead, as far as their differences go the same way: where nodes hit the bed they do not, and the finer history is the best there
is. The cheaper fidelities are compared with the finer dynamic solution as it is. The tension is the norm of the end force at the fairlead, errors are those of `offline.trade_errors`: per cent, the worst line of each.
"""

import math
import time
from dataclasses import asdict, dataclass

import numpy as np

from .mooring import Mooring, MooringError
from .offline.trade_errors import errors_between
from .offline.trade_window import swell
from .scene.grouping import times_segments

LEAD = 1.0 / 3.0  # of a window: the motion swells, nothing is compared
CHUNK = 0.02  # s of CPU time between two pauses
LEAST_SAMPLES = 30  # of a window
LEAST_ORDER, MOST_ORDER = 1.0, 2.0  # what an observed order counts as, and what it is where there is no coarser mesh
RUNS = 5.5  # what an estimate takes, in runs of the present settings: half and twice the mesh, each with the step that goes with it
LEAST_SHARE = 0.1  # of a window that takes too long
LEAST_SEGMENTS = 4  # of a line, for a coarser mesh that still says something


@dataclass(frozen=True)
class Accuracy:
    """Errors in per cent of mean, dynamic (rms about the mean, over the standard deviation) and peak tension; line: the one with the worst.

    begin, end: of what was compared, s; compared: with what, in words; orders: observed in the mean and about it, None where there was no coarser mesh;
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


def estimate(scene, settings, times, poses, twists, lengths=None, released=(), pause=lambda cpu: None, most_cpu=math.inf):
    """Accuracy of `Mooring(scene, **settings)` over a window of motion: times (k,) s, poses (k, 7), twists (k, 6), or (k, platforms, 7) and so on.

    lengths: (lines,) m unstretched, None for the scene's; released: names of lines let go. pause(cpu): called now and then with the s of CPU time
    spent since the last call; most_cpu: s that it may take, about: of a window that would take longer the last part is taken, a tenth at least. A window that cannot be solved gives an Accuracy that says why.
    """
    motion = times, poses, twists
    times, poses, twists = (np.array(rows, dtype=float, order="C") for rows in motion)
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
        share = most_cpu / max(RUNS * spent.total, 1e-9)
        if share < 1.0:
            rows = slice(int((1.0 - max(share, LEAST_SHARE)) * times.size), None)
            return estimate(scene, settings, *(values[rows] for values in motion), lengths, released, pause)
        finer = {**_mesh(settings, 2), "fidelity": "dynamic", "solver": own.solver, "dt": None if cheap else 0.5 * step}
        fine = tension(**finer)
        coarse = None
        if not cheap and min(own.segments) >= LEAST_SEGMENTS:
            coarse = tension(**_mesh(settings, 0.5), dt=2.0 * step, solver=own.solver)
    except (MooringError, ValueError) as error:
        return without(str(error), compared)
    spent.pause()
    true, orders = (fine, None) if cheap else _carried_on(coarse, mine, fine)
    errors = errors_between(mine, true)
    mean, dynamic, peak = errors.parts().tolist()
    return Accuracy(mean, dynamic, peak, own.line_names[errors.line], float(times[first]), float(times[-1]), compared, orders, spent.total)


def motion_in(rows, platforms):
    """times (k,), poses and twists of rows (k, 1 + 13 for each platform): time, and pose and twist of each in turn. platforms: names, or None for one."""
    each = rows[:, 1:].reshape(len(rows), -1, 13)
    poses, twists = each[..., :7], each[..., 7:]
    return (rows[:, 0], poses, twists) if platforms else (rows[:, 0], poses[:, 0], twists[:, 0])


def _mesh(settings, factor):
    """Arguments for `factor` times the segments of `settings`."""
    if settings.get("segments"):
        return {"segments": times_segments(factor, settings["segments"])}
    return {"refine": factor * settings.get("refine", 1.0)}


def _carried_on(coarse, own, fine):
    """Histories (k, lines) that three on meshes twice as fine each lead to, and the orders in the mean and about it of the line that is worst.

    Mean and fluctuation by themselves; coarse: None where there is none.
    """
    first, last = (None if coarse is None else own - coarse), fine - own
    total, orders = fine.copy(), []
    for part in (lambda history: history.mean(axis=0, keepdims=True), lambda history: history - history.mean(axis=0)):
        change = part(last)
        order, alike = np.full(own.shape[1], MOST_ORDER), np.ones(own.shape[1])
        if first is not None:
            before = part(first)
            sizes = [np.maximum(np.sqrt((each**2).sum(axis=0)), 1e-100) for each in (before, change)]
            order = np.clip(np.log2(sizes[0] / sizes[1]), LEAST_ORDER, MOST_ORDER)
            alike = np.maximum((before * change).sum(axis=0) / (sizes[0] * sizes[1]), 0.0)
        total += alike * change / (2.0**order - 1.0)
        orders.append(float(order[np.abs(change).max(axis=0).argmax()]))
    return total, None if first is None else tuple(orders)


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
