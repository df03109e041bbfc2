"""Implicit steps beside explicit ones a quarter of their default size: how far the tensions are off, what a simulated second costs, and a step."""

import time

import numpy as np

from mooring_ros import Mooring

from . import tables
from .extremes.battery import SCENES
from .extremes.motions import sway

PERIOD, DURATION, SAMPLE = 10.0, 30.0, 0.1  # s
SMALL = {"taut_20m": 0.05, "iswec_c1": 0.05}  # m of surge and heave, of the others:
LARGE = 2.0
NAMES = ("rm3_cable", "oc4", "volturnus_s_semi_taut", "volturnus_s_semi_taut_friction", "volturnus_s_transverse_friction", "lazy_wave", "oc3_spar", "iswec_c1", "taut_20m")
LONG = 0.1  # s, of the steps that are tried besides the default ones
TURNS = 3
HEADER = ["", "step", "deviation", "rms", "peak", "evaluations a step", "steps a second", "CPU, ms/s", "explicit, ms/s", "a step in evaluations of `auto`"]


def timed(mooring, motion):
    """(History, s of CPU time) of a run from the settled state; the best of TURNS."""
    mooring.settle(motion.start)
    start, best = mooring.snapshot(), np.inf
    for _ in range(TURNS + 1):  # the first one may compile
        mooring.restore(start)
        began = time.process_time()
        history = mooring.run(motion.times, motion.poses, motion.twists)
        best = min(best, time.process_time() - began)
    return history, best


def counted(mooring, motion):
    """(evaluations, steps) of the same run."""
    mooring.settle(motion.start)
    evaluations = steps = 0
    for sample in zip(motion.times, motion.poses, motion.twists):
        mooring.step(*sample)
        evaluations, steps = evaluations + mooring.last_step["evaluations"], steps + mooring.last_step["steps"]
    return evaluations, steps


def errors(tension, truth):
    """Largest errors of all lines: of the deviation, rms over the deviation, of the peak."""
    deviation = truth.std(axis=0)
    rms = np.sqrt(((tension - truth) ** 2).mean(axis=0)) / deviation
    return np.abs(tension.std(axis=0) / deviation - 1.0).max(), rms.max(), np.abs(tension.max(axis=0) / truth.max(axis=0) - 1.0).max()


def rows_of(name):
    """Rows of the table of one scene: default steps, then long ones."""
    size = SMALL.get(name, LARGE)
    motion = sway((size, 0.0, size), PERIOD, DURATION, every=SAMPLE)
    path = SCENES / f"{name}.txt"
    explicit = Mooring(path, solver="explicit")
    _, spent = timed(explicit, motion)
    finer = Mooring(path, solver="explicit", dt=explicit.step_limit.dt / 4.0)
    finer.settle(motion.start)
    truth = finer.run(motion.times, motion.poses, motion.twists).fairlead_tension
    evaluation = spent / (DURATION * min(cost / step for _, step, _, cost in explicit._table))  # s, as `auto` counts them
    for dt in (None, LONG):
        mooring = Mooring(path, solver="implicit", dt=dt)
        history, own = timed(mooring, motion)
        evaluations, steps = counted(mooring, motion)
        percent = [f"{100.0 * error:.2f} %" for error in errors(history.fairlead_tension, truth)]
        cost = [f"{evaluations / steps:.2f}", f"{steps / DURATION:.1f}", f"{1e3 * own / DURATION:.2f}", f"{1e3 * spent / DURATION:.2f}"]
        yield [name, f"{1e3 * mooring.step_limit.dt:.0f} ms", *percent, *cost, f"{own / steps / evaluation:.0f}"]


def run(quick=False):
    """Prints the table."""
    rows = [row for name in (NAMES[:2] if quick else NAMES) for row in rows_of(name)]
    content = {"implicit_steps": tables.table(HEADER, rows)}
    print(content["implicit_steps"], flush=True)
    return {"tables": content, "failed": []}
