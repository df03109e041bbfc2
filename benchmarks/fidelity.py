"""The fidelities: the linear one over its range and beyond, against the equilibria; and the estimate of a mooring's error, against the true one."""

import time

import numpy as np

from mooring_ros import Mooring
from mooring_ros.accuracy import LEAD, estimate
from mooring_ros.offline.trade_errors import errors_between
from mooring_ros.offline.trade_window import swell

from . import tables
from .moordyn_history import SCENES

TIMES = np.arange(1201) * 0.05
FINER = 6.0  # times the segments of the true solution
LINEAR = (("oc4", 1.0), ("volturnus_s_semi_taut", 1.0), ("oc3_spar", 1.0), ("volturnus_s_chain", 1.0), ("chalmers_33m", 0.05))
ESTIMATED = (
    ("oc4", {}), ("oc4", {"refine": 2.0}), ("oc4", {"fidelity": "quasi_static"}), ("oc4", {"fidelity": "line1=dynamic,linear"}),
    ("volturnus_s_semi_taut", {}), ("volturnus_s_semi_taut", {"fidelity": "linear"}), ("oc3_spar", {}), ("volturnus_s_chain", {}),
)  # fmt: skip


def motion(surge, heave, period, pitch=0.0):
    """Poses (k, 7) and twists (k, 6) at TIMES of a swing that begins at rest."""
    w, s = 2.0 * np.pi / period, np.clip(TIMES / period, 0.0, 1.0)
    ramp, slope = s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s) / period
    value, rate = ramp * np.sin(w * TIMES), slope * np.sin(w * TIMES) + ramp * w * np.cos(w * TIMES)
    poses, twists = np.zeros((TIMES.size, 7)), np.zeros((TIMES.size, 6))
    for axis, size in ((0, surge), (2, heave)):
        poses[:, axis], twists[:, axis] = size * value, size * rate
    poses[:, 4], poses[:, 6], twists[:, 4] = np.sin(0.5 * pitch * value), np.cos(0.5 * pitch * value), pitch * rate
    return poses, twists


def linear_row(name, scale, poses, twists):
    """One scene's row of the table of linear moorings, and whether what they say of their error holds."""
    moorings = {fidelity: Mooring(SCENES / f"{name}.txt", fidelity=fidelity) for fidelity in ("quasi_static", "linear", "dynamic")}
    cost, history = {}, {}
    for fidelity, mooring in moorings.items():
        mooring.settle(poses[0])
        mooring.run(TIMES[1:3], poses[1:3], twists[1:3])
        mooring.settle(poses[0])
        if fidelity != "linear":
            began = time.process_time()
            history[fidelity] = mooring.run(TIMES[1:], poses[1:], twists[1:])
            cost[fidelity] = (time.process_time() - began) / TIMES.size
    linear, exact = moorings["linear"], history["quasi_static"]
    stated, true, spent, solved = [], [], [], []
    for k in range(1, TIMES.size):
        began = time.process_time()
        linear.step(TIMES[k], poses[k], twists[k])
        spent.append(time.process_time() - began)
        stated.append(linear.error_estimate)
        solved.append(linear.last_step["evaluations"])
        tension = exact.fairlead_tension[k - 1]
        off = np.abs(linear.fairlead_tension - tension) / np.maximum(tension, 0.1 * tension.mean())
        force = np.linalg.norm(linear.wrench[:3] - exact.wrench[k - 1, :3]) / tension.sum()
        true.append(max(off.max(), force))
    true, stated, half = np.array(true), np.array(stated), TIMES.size // 2
    row = [
        name, f"{100 * true.max():.2f}", f"{100 * stated.max():.2f}", f"{100 * np.median(true):.2f}", f"{100 * np.median(stated):.2f}",
        linear._linear.derived, sum(solved[half:]), f"{1e3 * np.median(spent):.2f}", f"{1e3 * max(spent):.0f}", f"{1e3 * cost['quasi_static']:.2f}",
    ]  # fmt: skip
    return row, true.max() < 0.03 and np.mean(true <= 2.0 * stated + 1e-3) > 0.98


def true_errors(scene, settings, times, poses, twists):
    """(3,) per cent, against a mesh that is FINER."""
    first = int(np.searchsorted(times, times[0] + LEAD * (times[-1] - times[0])))
    poses, twists = poses.copy(), twists.copy()
    swell(times, poses, twists, times[first] - times[0])
    tensions = []
    for mooring in (Mooring(scene, **settings), Mooring(scene, refine=FINER)):
        mooring.settle(poses[0], time=times[0])
        history = mooring.run(times[1:], poses[1:], twists[1:])
        tensions.append(np.linalg.norm(history.fairlead_end_force, axis=2)[first - 1 :])
    return errors_between(*tensions).parts()


def estimate_row(name, settings, window):
    """One case's row of the table of estimates, and the largest factor between estimate and truth of errors above 0.1 %."""
    scene = SCENES / f"{name}.txt"
    found = estimate(scene, settings, *window)
    true = true_errors(scene, settings, *window)
    estimated = np.array([found.mean, found.dynamic, found.peak])
    factor = (np.maximum(np.maximum(estimated, 0.1), np.maximum(true, 0.1)) / np.minimum(np.maximum(estimated, 0.1), np.maximum(true, 0.1))).max()
    words = ", ".join(f"{key} {value}" for key, value in settings.items()) or "default"
    cells = [f"{a:.2g} / {b:.2g}" for a, b in zip(estimated, true)]
    return [name, words, *cells, f"{factor:.2f}", f"{found.cpu:.2f}"], factor


def run(quick=False):
    """Both tables; prints them."""
    failed, rows = [], []
    for name, scale in LINEAR[:2] if quick else LINEAR:
        row, holds = linear_row(name, scale, *motion(6.0 * scale, 3.0 * scale, 14.5, pitch=0.05))
        rows.append(row)
        if not holds:
            failed.append(f"fidelity: what linear says of its error does not hold for {name}")
    header = ["scene", "error, largest (%)", "stated", "median (%)", "stated", "derived", "statics, second half", "step (ms)", "slowest", "quasi-static step (ms)"]
    linear = tables.table(header, rows)
    print(linear, flush=True)
    poses, twists = motion(4.0, 2.0, 10.0)
    part = slice(300, 901)  # 30 s under way
    window = TIMES[part], poses[part], twists[part]
    rows = []
    for name, settings in ESTIMATED[:3] if quick else ESTIMATED:
        row, factor = estimate_row(name, settings, window)
        rows.append(row)
        if factor > 2.0:
            failed.append(f"fidelity: the estimate for {name} ({row[1]}) is off by a factor of {factor:.2f}, goal 2")
    header = ["scene", "settings", "mean: estimated / true (%)", "dynamic", "peak", "worst factor", "CPU time (s)"]
    accuracy = tables.table(header, rows)
    print(accuracy, flush=True)
    return {"tables": {"linear": linear, "accuracy": accuracy}, "failed": failed}
