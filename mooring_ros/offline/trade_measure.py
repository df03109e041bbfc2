"""One setting run through the window: its histories, its CPU time, its worst step."""

import time
from dataclasses import dataclass

import numpy as np

from mooring_ros.mooring import Mooring, MooringError

CHUNK = 0.05  # s of CPU time in a call of `run`: Ctrl-C waits no longer
REPEAT = 0.6  # s of CPU time up to which a run is repeated, three times at most: of each part the least time counts
STEP_PASSES = 3  # passes sample by sample, one only where they are long


@dataclass(frozen=True)
class Measured:
    """What a run gave. tension, force (k, lines) N at the samples after the first: of the end segments, and the norm of the end forces."""

    tension: np.ndarray
    force: np.ndarray
    cost: float  # s of CPU time for one simulated second
    worst_step: float  # s of CPU time, of `step` from one sample to the next
    spent: float  # s of CPU time for all of it, without settling and compiling
    refused: str | None = None  # why there is nothing else


def measure(scene, setting, window, limit, timed=True, tick=lambda: None, platforms=None):
    """Measured of a setting on a trade_window.Window; stopped, as refused, where it takes more than `limit` s of CPU time for one pass.

    Compiling is over before the clock starts. Without `timed` there is one pass. tick(): called now and then. platforms: as of `Mooring`.
    """
    began = time.process_time()
    try:
        mooring = Mooring(scene, **setting.arguments(), platforms=platforms)
        taken = [text for text in mooring.warnings if text.startswith("dt =")]
        if taken:
            return _refused(taken[0], began)
        mooring.settle(window.poses[0], time=window.times[0])
        saved = mooring.snapshot()
        mooring.run(window.times[1:2], window.poses[1:2], window.twists[1:2])
        for row in range(2, min(4, len(window.times))):
            mooring.step(window.times[row], window.poses[row], window.twists[row])
        mooring.restore(saved)
        began = time.process_time()
        parts, times, history = _first_pass(mooring, window, limit, tick)
        if history is None:
            return _refused(f"takes more than {limit:.3g} s of CPU time for {window.duration:.4g} s: not finished", began)
        worst = steps = None
        if timed:
            for _ in range(3 if times.sum() < REPEAT / 3 else 1 if times.sum() < REPEAT else 0):
                mooring.restore(saved)
                times = np.minimum(times, _again(mooring, window, parts))
                tick()
            for _ in range(STEP_PASSES if times.sum() < REPEAT else 1):
                mooring.restore(saved)
                pass_steps = _step_times(mooring, window, tick)
                steps = pass_steps if steps is None else np.minimum(steps, pass_steps)
            worst = float(steps.max())
    except (MooringError, ValueError) as error:
        return _refused(str(error), began)
    tension, force = history
    if not (np.isfinite(tension).all() and np.isfinite(force).all()):
        return _refused("gave a tension that is not finite", began)
    return Measured(tension, force, times.sum() / window.duration, worst, time.process_time() - began)


def _refused(why, began):
    return Measured(np.empty((0, 0)), np.empty((0, 0)), np.nan, np.nan, time.process_time() - began, why)


def _first_pass(mooring, window, limit, tick):
    """(slices of samples, their CPU times, (tension, force)); no histories where it takes too long."""
    parts, times, tension, force = [], [], [], []
    row, count = 1, 1
    while row < len(window.times):
        part = slice(row, min(row + count, len(window.times)))
        before = time.process_time()
        history = mooring.run(window.times[part], window.poses[part], window.twists[part])
        took = time.process_time() - before
        parts.append(part)
        times.append(took)
        tension.append(history.fairlead_tension)
        force.append(np.linalg.norm(history.fairlead_end_force, axis=2))
        row = part.stop
        count = max(1, min(int(count * CHUNK / max(took, 1e-6)), 4 * count))
        if sum(times) > limit and row < len(window.times):
            return parts, np.array(times), None
        tick()
    return parts, np.array(times), (np.concatenate(tension), np.concatenate(force))


def _again(mooring, window, parts):
    times = np.empty(len(parts))
    for index, part in enumerate(parts):
        before = time.process_time()
        mooring.run(window.times[part], window.poses[part], window.twists[part])
        times[index] = time.process_time() - before
    return times


def _step_times(mooring, window, tick):
    """(k,) s of CPU time of each `step`."""
    taken = np.empty(len(window.times) - 1)
    heard = time.monotonic()
    for row in range(1, len(window.times)):
        before = time.process_time()
        mooring.step(window.times[row], window.poses[row], window.twists[row])
        taken[row - 1] = time.process_time() - before
        if time.monotonic() - heard > 0.2:
            heard = time.monotonic()
            tick()
    return taken
