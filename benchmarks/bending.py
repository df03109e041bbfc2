"""The cantilevers of Hall, Srinivas and Yu (2020): tip deflection and decay beside MoorDyn's at the same segments, and the exact elastica.

The tip of a lumped chain rests where its energy is least, so ours is the statics. MoorDyn has no statics that is exact: its tip sinks in water with a
large drag area at the mass, and the mean over the last 10 s counts, in which it moves by less than `GOAL_STILL` of its deflection.
"""

import csv
from dataclasses import replace
from pathlib import Path

import moordyn
import numpy as np

from mooring_ros import Mooring
from mooring_ros.scene import load_scene
from mooring_ros.scene.description import ANGLE, PAPER

from . import figures, moordyn_peer, tables

ROOT = Path(__file__).parent.parent
SCENES = ROOT / "config" / "scenes"
EXACT = ROOT / "tests" / "reference" / "hall2020_cantilever.csv"
CASES = ((10, 1000), (10, 2000), (20, 1000), (20, 3000))  # m, kg
SEGMENTS = (2, 4, 6, 8, 40)
PEER_SCHEME = "RK4"  # RK2 lets bending waves grow at 40 segments, which nothing but drag damps
PEER_STEP = 4e-4  # s for each metre of a segment: three quarters of its axial limit
SINKING = 6.0  # s for each metre of the cantilever
BRAKE = 1000.0  # m^2, drag area of the end mass while MoorDyn's tip sinks
GOALS = {8: 0.005, 40: 0.0005}  # of our deflection
GOAL_STILL = 2e-4
DECAY_SEGMENTS = (2, 4, 6, 8)
DECAY = 12.0  # s
HERE, STILL = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]), np.zeros(6)


class AtRest:
    """A platform that does not move."""

    def displacement(self, times):
        return np.zeros((len(times), 3)), np.zeros((len(times), 3))


def cantilever(length, mass, drag_area=0.0, suffix=""):
    """Scene of the cantilever with its end mass changed."""
    scene = load_scene(SCENES / f"cantilever_{length}m{suffix}.txt")
    tip = replace(scene.points[0], mass=float(mass), drag_area=drag_area)
    return replace(scene, points=(tip, *scene.points[1:]))


def exact_deflection(length, mass):
    """Deflection (m) of the inextensible elastica."""
    with open(EXACT, newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["g"] == "9.80665"]
    return next(float(row["w_tip_exact_m"]) for row in rows if (float(row["L_m"]), float(row["end_mass_kg"])) == (length, mass))


def our_deflection(scene, segments, measure=ANGLE):
    """Settled deflection of the tip, m."""
    mooring = Mooring(replace(scene, bending=measure), segments=segments)
    mooring.settle(HERE)
    return scene.points[0].position[2] - mooring.node_positions("line1")[-1, 2]


def _tip(lines, segments):
    return moordyn.GetLineNodePos(lines[0], segments)


def peer_deflection(length, mass, segments):
    """(mean deflection of MoorDyn's tip over the last 10 s, m; how far it still moved in them, m)."""
    scene = cantilever(length, mass, BRAKE)
    sinking = SINKING * length
    run = moordyn_peer.run(
        scene,
        AtRest(),
        PEER_STEP * length / segments,
        PEER_SCHEME,
        segments=segments,
        steps_per_call=100,
        sample=0.1,
        options=("1 ICgenDynamic",),
        until=sinking,
        probe=lambda lines: _tip(lines, segments),
    )
    sunk = scene.points[0].position[2] - run.probed[run.times > sinking - 10.0, 2]
    return float(sunk.mean()), float(np.ptp(sunk))


def static_rows(quick):
    """Rows of length, mass, segments, exact deflection, and the relative errors: ours, the paper's measure in our core, MoorDyn's, and how much that still moved."""
    rows = []
    for length, mass in CASES[:2] if quick else CASES:
        exact = exact_deflection(length, mass)
        scene = cantilever(length, mass)
        for segments in SEGMENTS:
            ours, paper = (our_deflection(scene, segments, measure) / exact - 1.0 for measure in (ANGLE, PAPER))
            peer, moved = (None, 0.0) if quick and segments > 8 else peer_deflection(length, mass, segments)
            rows.append((length, mass, segments, exact, ours, paper, None if peer is None else peer / exact - 1.0, moved / exact))
            print(f"   {length} m, {mass} kg, {segments} segments: ours {100 * ours:+.4f} %", flush=True)
    return rows


def our_decay(segments):
    """(times after the stay parts (k,), s; height of the tip over the clamp (k,), m)."""
    scene = cantilever(10, 1000, suffix="_decay")
    parted = scene.failures[0].time
    mooring = Mooring(scene, segments=segments)
    mooring.settle(HERE)
    times = np.arange(0.05, parted + DECAY, 0.05)
    heights = []
    for t in times:
        mooring.step(t, HERE, STILL)
        heights.append(mooring.node_positions("line1")[-1, 2] - scene.points[0].position[2])
    return times - parted, np.array(heights)


def peer_decay(segments):
    """The same of MoorDyn, whose cable starts straight and without a stay."""
    scene = cantilever(10, 1000)
    run = moordyn_peer.run(
        scene,
        AtRest(),
        PEER_STEP * 10.0 / segments,
        PEER_SCHEME,
        segments=segments,
        steps_per_call=10,
        sample=0.02,
        options=("1 ICgenDynamic", "0.0 TmaxIC"),
        until=DECAY,
        probe=lambda lines: _tip(lines, segments),
    )
    return run.times, run.probed[:, 2] - scene.points[0].position[2]


def picture(rows, decays):
    """Errors of the tip over the segments, and the tip's way down."""
    figure, ((left, right),) = figures.axes(1, 2, height=3.6)
    for code, column, marker in (("ours", 4, "o"), ("MoorDyn", 6, "s")):
        for length, mass in dict.fromkeys(row[:2] for row in rows):
            chosen = [row for row in rows if row[:2] == (length, mass) and row[column] is not None]
            label = code if (length, mass) == CASES[0] else None
            style = figures.STYLES[code] | {"linewidth": 1.3, "alpha": 0.8, "marker": marker, "markersize": 4}
            left.loglog([row[2] for row in chosen], [100 * abs(row[column]) for row in chosen], label=label, **style)
    left.set(xlabel="segments", ylabel="error of the tip deflection, %", title="static, against the exact elastica")
    left.set_xticks(SEGMENTS, SEGMENTS)
    left.minorticks_off()
    for segments, (times, heights) in decays["ours"].items():
        right.plot(times, heights, **figures.STYLES["ours"] | {"alpha": 1.0 if segments == DECAY_SEGMENTS[-1] else 0.3})
    right.plot(*decays["MoorDyn"], **figures.STYLES["MoorDyn"])
    right.set(xlabel="time, s", ylabel="height of the tip, m", title="10 m, 1000 kg, let go: 2, 4, 6 and (dark) 8 segments", xlim=(0.0, DECAY))
    figures.legend(figure, left)
    return figure


def run(quick):
    """Table ``bending_tip``, picture ``bending.png``, and the goals that are missed."""
    rows = static_rows(quick)
    failed = []
    for length, mass, segments, _, ours, _, peer, moved in rows:
        what = f"{length} m, {mass} kg, {segments} segments"
        if abs(ours) > GOALS.get(segments, np.inf):
            failed.append(f"tip deflection of {what}")
        if peer is not None and abs(ours) >= abs(peer):
            failed.append(f"tip deflection of {what} is worse than MoorDyn's")
        if moved > GOAL_STILL:
            failed.append(f"MoorDyn's tip of {what} has not come to rest")
    shown = [
        (f"{length} m, {mass} kg", segments, f"{exact:.4f}", _percent(ours), _percent(paper), _percent(peer))
        for length, mass, segments, exact, ours, paper, peer, _ in rows
    ]
    header = ("cantilever", "segments", "exact, m", "ours", "ours, measure and clamp of the paper", "MoorDyn")
    content = tables.table(header, shown)
    print(content, "\n")
    decays = {"ours": {n: our_decay(n) for n in DECAY_SEGMENTS}, "MoorDyn": peer_decay(DECAY_SEGMENTS[-1])}
    return {"tables": {"bending_tip": content}, "failed": failed, "figures": {"bending.png": picture(rows, decays)}}


def _percent(value):
    return "-" if value is None else f"{100 * value:+.4f} %"
