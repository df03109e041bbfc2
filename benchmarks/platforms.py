"""Two floaters that share a chain, each with a motion of its own, beside MoorDyn with two coupled bodies; and what a second platform costs."""

import tempfile
import time
from pathlib import Path

import moordyn
import numpy as np

from mooring_ros import Mooring
from mooring_ros.core.poses import moved
from mooring_ros.scene import load_scene

from . import platform_row, tables
from .moordyn_peer import silence

SCENE = Path(__file__).parent.parent / "config" / "scenes" / "oc4_pair.txt"
NAMES = ["body1", "body2"]
STEP = 0.0025  # s, of MoorDyn's RK4
SAMPLE = 0.05  # s, between the platforms' samples
RAMP, END = 20.0, 80.0  # s; compared from twice the ramp on
GOAL = 1.0  # %: rms of the difference over the standard deviation
COST = "CPU for one simulated second (µs)"


def motions(times):
    """Offsets and rates (k, 2, 6), m and rad about the world axes: surge and heave of both, out of step, and pitch of the second."""
    ramp = np.clip(times / RAMP, 0.0, 1.0)
    share, slope = ramp * ramp * (3.0 - 2.0 * ramp), 6.0 * ramp * (1.0 - ramp) / RAMP
    offsets, rates = np.zeros((2, times.size, 2, 6))
    for body, axis, size, period in ((0, 0, 3.0, 14.5), (0, 2, 1.5, 9.0), (1, 0, -4.0, 11.0), (1, 1, 2.0, 17.0), (1, 2, 1.0, 8.0), (1, 4, 0.06, 12.0)):
        w = 2.0 * np.pi / period
        offsets[:, body, axis] = size * share * np.sin(w * times)
        rates[:, body, axis] = size * (share * w * np.cos(w * times) + slope * np.sin(w * times))
    return offsets, rates


def of_ours(dt=None):
    """Times (k,), tensions (k, lines) at fairleads, and wrenches (k, 2, 6); dt: largest step (s)."""
    mooring = Mooring(SCENE, platforms=NAMES, dt=dt)
    start = mooring.pose_in_file
    times = np.arange(1, round(END / SAMPLE) + 1) * SAMPLE
    offsets, rates = motions(times)
    mooring.settle(start)
    history = mooring.run(times, np.array([moved(start, offset.ravel()) for offset in offsets]), rates)
    return times, history.fairlead_tension, history.wrench


def of_moordyn():
    """The same of MoorDyn. Its bodies are given by place and angles, here about one axis at most, and go as x + v t within a call."""
    scene = load_scene(SCENE)
    own = ("dtM", STEP), ("tScheme", "RK4"), ("writeLog", 0), ("disableOutput", 1), ("disableOutTime", 1), ("threshIC", 1e-5), ("TmaxIC", 200)
    end = "--- need this line"
    text = scene.text.replace(end, "".join(f"{value} {name}\n" for name, value in own) + end)
    start = np.array([[*body.position, 0.0, 0.0, np.pi if body.id == 1 else 0.0] for body in scene.bodies])
    times = np.arange(round(END / STEP) + 1) * STEP
    at = start + motions(times)[0]
    every, seen, tension, wrench = round(SAMPLE / STEP), [], [], []
    with tempfile.TemporaryDirectory() as folder, silence():
        deck = Path(folder, "pair.txt")
        deck.write_text(text)
        system = moordyn.Create(str(deck))
        moordyn.SetVerbosity(system, moordyn.LEVEL_NONE)
        moordyn.Init(system, start.ravel().tolist(), [0.0] * 12)
        lines = [moordyn.GetLine(system, line.id) for line in scene.lines]
        for k, now in enumerate(times[:-1]):
            force = moordyn.Step(system, at[k].ravel().tolist(), ((at[k + 1] - at[k]) / STEP).ravel().tolist(), float(now), STEP)
            if (k + 1) % every == 0:
                seen.append(times[k + 1])
                tension.append([moordyn.GetLineFairTen(line) for line in lines])
                wrench.append(force)
        moordyn.Close(system)
    return np.array(seen), np.array(tension), np.array(wrench).reshape(-1, 2, 6)


def apart(found, known):
    """Columns' rms difference over the standard deviation of the largest of their kind, in %, and that of their means over it."""
    off, scale = found - known, 0.01 * known.std(axis=0).max()
    return off.std(axis=0) / scale, np.abs(off.mean(axis=0)) / scale


def compared():
    """(what, ours, MoorDyn's (k, columns)) after the start."""
    (times, tension, wrench), (seen, known, forces) = of_ours(), of_moordyn()
    np.testing.assert_allclose(times, seen)
    late = times > 2.0 * RAMP
    for k in range(known.shape[1]):
        yield f"tension of line {k + 1}", tension[late, k : k + 1], known[late, k : k + 1]
    for what, columns in (("force", slice(0, 3)), ("moment", slice(3, 6))):
        for k, name in enumerate(NAMES):
            yield f"{what} on {name}", wrench[late, k, columns], forces[late, k, columns]


def cost(platforms):
    """CPU time (s) for one simulated second, both floaters moving alike."""
    mooring = Mooring(SCENE, platforms=platforms)
    times = np.arange(1, 601) * SAMPLE
    offsets, rates = np.zeros((2, 600, 6))
    offsets[:, 0], rates[:, 0] = np.sin(0.5 * times), 0.5 * np.cos(0.5 * times)
    start = mooring.pose_in_file
    if platforms is None:
        poses, twists = np.array([moved(start[None], offset)[0] for offset in offsets]), rates
    else:
        poses, twists = np.array([moved(start, np.tile(offset, 2)) for offset in offsets]), np.repeat(rates[:, None], 2, axis=1)
    mooring.settle(start)
    saved, least = mooring.snapshot(), np.inf
    for _ in range(20):
        mooring.restore(saved)
        began = time.process_time()
        mooring.run(times, poses, twists)
        least = min(least, time.process_time() - began)
    return least / times[-1]


def of_rows(counts):
    """Rows of the table: floaters, lines, CPU time, and how many times faster than real time."""
    for count in counts:
        lines, cpu = platform_row.cost(count, SCENE)
        yield [count, lines, f"{1e6 * cpu:.0f}", f"{1e6 * cpu / lines:.0f}", f"{1.0 / cpu:.0f}"]


def run(quick=False):
    """Prints the tables."""
    rows, failed = [], []
    for what, ours, theirs in compared():
        changing, mean = apart(ours, theirs)
        scale = 1e-3 * theirs.std(axis=0).max()
        rows.append([what, f"{scale:.1f}", f"{changing.max():.2f}", f"{mean.max():.2f}"])
        if changing.max() > GOAL:
            failed.append(f"platforms: {what} is {changing.max():.2f} % off MoorDyn's, goal {GOAL:g} %")
    one, two = cost(None), cost(NAMES)
    rows_of_floaters = list(of_rows((2, 5) if quick else (2, 5, 10, 25)))
    content = {
        "platforms": tables.table(["", "standard deviation (kN, kN m)", "rms of the difference (%)", "of the means (%)"], rows),
        "platforms_cost": tables.table(["platforms", COST], [["one, both floaters on it", f"{1e6 * one:.0f}"], ["two", f"{1e6 * two:.0f}"]]),
        "platforms_row": tables.table(["floaters, each a platform", "lines", COST, "for one line", "times real time"], rows_of_floaters),
    }
    print("\n\n".join(content.values()), flush=True)
    return {"tables": content, "failed": failed}
