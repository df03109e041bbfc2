"""What `mooring trade` promises, against the truth, on six scenes that were kept aside while it was tuned.

Truth is a run of its own: the whole motion on a finer mesh than the trade's reference with steps half as long, in a process of its own, like every run here.
The front by brute force is a finer grid of meshes and steps about the chosen setting, all of them run through the whole motion.
"""

import multiprocessing
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass

import numpy as np

from mooring_ros.mooring import Mooring, MooringError
from mooring_ros.offline import trade_window
from mooring_ros.offline.motion_file import Motion
from mooring_ros.offline.trade import trade
from mooring_ros.offline.trade_errors import errors_between
from mooring_ros.offline.trade_setting import Meshes, Setting, step_of, steps_in
from mooring_ros.scene import load_scene

from . import tables
from .moordyn_history import SCENES
from .motions import Circle, Sines, poses_and_twists

SECONDS = 40.0  # of CPU time for a trade
FINER = 1.3  # the truth's mesh, of the reference's
ALONG_MESHES = 2.0 ** (np.arange(-8, 1) / 8.0)  # of the chosen mesh, and beside it
ALONG_STEPS = (0.5, 0.67, 1.0, 1.5)  # of the chosen steps
PASSES = 3  # of which the least time counts
CHECKED = 3  # settings of the front whose error and cost are held against the truth, the chosen one with them
ERROR_GOAL, COST_GOAL, FRONT_GOAL = 2.0, 0.25, 1.3


@dataclass(frozen=True)
class Case:
    """A scene kept aside, a motion of it, and the error asked for (per cent)."""

    file: str
    motion: object
    error: float
    rate: float = 20.0  # Hz


CASES = (
    Case("volturnus_s_chain.txt", Sines(4.0, 2.0, 3.0, period=14.0, measured_periods=20.0), 2.0),
    Case("oc3_spar.txt", Sines(4.0, 2.0, 2.0, period=12.0, measured_periods=20.0), 1.0),
    Case("chalmers_33m.txt", Circle(0.2, 3.5, ramp_periods=2.0, measured_periods=8.0), 5.0, 100.0),
    Case("volturnus_s_semi_taut.txt", Sines(3.5, 2.0, 3.0, period=15.0, measured_periods=10.0), 2.0),
    Case("lazy_wave.txt", Sines(4.0, 2.0, 3.0, period=12.0, measured_periods=10.0), 10.0),
    Case("farm_100.txt", Sines(3.0, 2.0, 2.0, period=12.0, measured_periods=6.0), 3.0),
)  # fmt: skip


def sampled(case):
    """The case's motion as `mooring trade` reads it from a file."""
    times = np.arange(int(case.motion.end * case.rate) + 1) / case.rate
    poses, twists = poses_and_twists(*case.motion.displacement(times))
    return Motion(f"of {case.file}", times, poses, twists, np.rint(times * 1e9).astype(np.int64), "computed")


def runs(file, times, poses, twists, settings, passes, longest):
    """[(tension, force, s of CPU time for a simulated second) or None] of settings through a whole motion; for another process.

    A setting is given up (None) where its first pass takes more than `longest` s for a simulated second.
    """
    scene, found = load_scene(SCENES / file), []
    for setting in settings:
        try:
            mooring = Mooring(scene, **setting.arguments())
            mooring.settle(poses[0], time=times[0])
            saved, costs = mooring.snapshot(), []
            mooring.run(times[1:4], poses[1:4], twists[1:4])
            for _ in range(passes):
                mooring.restore(saved)
                began = time.process_time()
                history = mooring.run(times[1:], poses[1:], twists[1:])
                costs.append((time.process_time() - began) / (times[-1] - times[0]))
                if costs[0] > longest:
                    break
            found.append((history.fairlead_tension, np.linalg.norm(history.fairlead_end_force, axis=2), min(costs)))
        except MooringError:
            found.append(None)
    return found


def in_another_process(file, motion, settings, passes=PASSES, longest=np.inf):
    """`runs` in a process that was not there before."""
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        return pool.submit(runs, file, motion.times, motion.poses, motion.twists, settings, passes, longest).result()


def truth(case, motion, reference):
    """(k, lines) N: force at the fairleads of a run that is finer than the trade's own reference, over what is compared."""
    scene, compared = load_scene(SCENES / case.file), trade_window.whole(motion).compared
    refine = FINER * reference.refine
    steps = 2 * steps_in(1.0 / case.rate, Mooring(scene, solver="explicit", refine=refine).step_limit.dt)
    setting = Setting("dynamic", "explicit", step_of(1.0 / case.rate, steps), refine=refine)
    return in_another_process(case.file, motion, [setting], 1)[0][1][compared:], compared


def checked(found):
    """The chosen setting and others of the front, spread over it."""
    others = [result for result in found.front if result is not found.chosen and result.errors.worst < 25.0]
    spread = [others[round(i)] for i in np.linspace(0, len(others) - 1, min(CHECKED - 1, len(others)))] if others else []
    return [found.chosen, *spread]


def around(case, scene, chosen):
    """Settings of the chosen one's method, cheaper than it or hardly dearer: the brute force."""
    meshes, interval, own = Meshes(scene), 1.0 / case.rate, chosen.setting
    made = {}
    for share in ALONG_MESHES:
        factor = meshes.nearest(chosen.factor * share)
        where = meshes.arguments(factor)
        default = None if own.solver != "explicit" else steps_in(interval, Mooring(scene, solver="explicit", **where).step_limit.dt)
        for more in ALONG_STEPS:
            steps = max(1, round(chosen.steps * more)) if default is None else max(default, round(default * more))
            dt = None if steps == default else step_of(interval, steps)
            made[factor, steps] = Setting(own.fidelity, own.solver, dt, **where)
    return list(made.values())


def measured(case, quick):
    """The rows of one scene, and what it missed."""
    scene, motion = load_scene(SCENES / case.file), sampled(case)
    found = trade(scene, motion, error=case.error, seconds=SECONDS / (3.0 if quick else 1.0))
    name = case.file.removesuffix(".txt")
    if found.chosen is None:
        return [[name, "–", found.why, *["–"] * 6]], [f"{name}: {found.why}"], {}
    true, compared = truth(case, motion, found.reference)
    looked_at = checked(found)
    rows, missed, kept = [], [], []
    for result, run in zip(looked_at, in_another_process(case.file, motion, [r.setting for r in looked_at])):
        error, cost = errors_between(run[0][compared:], true).worst, run[2]
        of_error, of_cost = result.errors.worst / error, result.cost / cost
        kept.append((error, cost))
        setting = result.setting
        label = f"{'**chosen** ' if result is found.chosen else ''}{setting.method}, {setting.mesh}, {setting.step}"
        rows.append([name, label, f"{result.errors.worst:.3g} %", f"{error:.3g} %", f"{of_error:.2f}", f"{1e3 * result.cost:.3g}", f"{1e3 * cost:.3g}",
                     f"{of_cost:.2f}", ""])
        if not 1.0 / ERROR_GOAL <= of_error <= ERROR_GOAL:
            missed.append(f"{name}, {label}: error predicted as {result.errors.worst:.3g} %, truly {error:.3g} %")
        if abs(of_cost - 1.0) > COST_GOAL:
            missed.append(f"{name}, {label}: cost predicted as {1e3 * result.cost:.3g} ms/s, truly {1e3 * cost:.3g}")
    allowed = max(case.error, kept[0][0])
    grid = around(case, scene, found.chosen)
    grid_runs = zip(grid, in_another_process(case.file, motion, grid, PASSES, 1.1 * kept[0][1]))
    done = [(errors_between(run[0][compared:], true).worst, run[2], setting) for setting, run in grid_runs if run]
    own = next((entry[1] for entry in done if entry[2] == found.chosen.setting), kept[0][1])
    best = min((entry for entry in done if entry[0] <= allowed), key=lambda entry: entry[1], default=(0.0, own, found.chosen.setting))
    ratio = own / best[1]
    rows[0][-1] = f"{ratio:.2f}"
    if ratio > FRONT_GOAL:
        missed.append(f"{name}: the chosen setting costs {ratio:.2f} times the cheapest of {len(done)} ({best[2].mesh} segments, {best[2].step})")
    for row in rows:
        print("  " + "  ".join(row), flush=True)
    facts = {"window": found.window.why, "reference_error": float(found.reference.error.max()), "reference_segments": found.reference.refine,
             "runs": found.runs, "seconds": found.cpu, "grid": len(done)}
    return rows, missed, facts


def run(quick=False):
    """Measure; returns tables, facts and missed goals."""
    rows, missed, facts = [], [], {}
    for case in CASES[:2] if quick else CASES:
        own, failed, fact = measured(case, quick)
        rows, missed, facts[case.file] = rows + own, missed + failed, fact
    header = ["scene", "setting", "error said", "error", "ratio", "CPU said (ms/s)", "CPU (ms/s)", "ratio", "cost over the front's"]
    known = [
        [file.removesuffix(".txt"), fact["window"], f"{fact['reference_error']:.2g} %", f"{fact['reference_segments']} ×",
         fact["runs"], f"{fact['seconds']:.0f} s", fact["grid"]]
        for file, fact in facts.items() if fact
    ]  # fmt: skip
    more = ["scene", "measured on", "reference's own error", "its segments", "runs", "CPU time", "runs of the brute force"]
    return {"tables": {"trade_held_out": tables.table(header, rows) + "\n\n" + tables.table(more, known)}, "facts": facts, "failed": missed}
