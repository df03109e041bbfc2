"""The VolturnUS-S semi-taut mooring on four beds without friction (Housner et al. 2022, Figure 4), against MoorDyn and CableDyn.

The platform is moved by regular waves of 9.3 m and 14.9 s at 90 degrees: sway and heave a quarter period apart, the same on all beds.
MoorDyn (C++) pushes lines on a slope straight up; ours and CableDyn push along the bed's normal, as the paper and MoorDyn's Fortran version do.
At rest and in the plane of the slope that makes no difference without friction: the chain is held at the same place. Across it the chain slides
downhill, or not; and in waves that all but slacken a line its own weight draws the chain on a slope tight, or not.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from mooring_ros.mooring import Mooring
from mooring_ros.scene import load_scene

from . import figures, tables
from .moordyn_history import SCENES
from .motions import SurgeHeave
from .ours import at_rest, samples

BEDS = {"flat": "", "upslope": "_upslope", "downslope": "_downslope", "sideslope": "_sideslope"}
MOTION = SurgeHeave(surge=3.5, heave=3.7, period=14.9, ramp_periods=2.0, measured_periods=4.0, heading=90.0)
PEER_STEP = 2e-3  # s: a third of the step at which it blows up
CABLEDYN_STEP = 0.05  # s
SAMPLE = 0.1  # s
STILL = SurgeHeave(surge=0.0, heave=0.0, period=1.0, ramp_periods=0.5, measured_periods=0.5)
FILE = Path(__file__).parent / "data" / "bathymetry_peers.csv"
GOAL = 0.01  # of the mean tension, against MoorDyn where its law is the same, else against CableDyn
SAME_LAW = {"flat": (0, 1, 2), "upslope": (0,), "downslope": (0,), "sideslope": ()}  # at rest: lines in the plane of the slope
SAME_LAW_MOVING = {**SAME_LAW, "upslope": ()}  # its line 1 all but slackens in each wave


def fairleads(scene):
    """Indices of the lines that end on the platform, in the file's order."""
    coupled = {p.id for p in scene.points if p.kind == "coupled"}
    return [k for k, line in enumerate(scene.lines) if {line.end_a, line.end_b} & coupled]


def of_moordyn(scene, times, motion=MOTION):
    """Tension (samples, lines) N of the segments at the fairleads."""
    from . import moordyn_peer

    run = moordyn_peer.run(scene, motion, PEER_STEP, "RK2", sample=SAMPLE, options=("1 ICgenDynamic",))
    return CubicSpline(run.times, run.tension[:, fairleads(scene)])(times)


def of_cabledyn(scene, times, motion=MOTION):
    """The same; of a segment's axial force, the damping left out that CableDyn does not report."""
    from . import cabledyn_peer

    columns = []
    for chain in cabledyn_peer.chains(scene):
        run = cabledyn_peer.run(scene, chain, motion, CABLEDYN_STEP, motion.end, curvature=False)
        columns.append(CubicSpline(run.times, run.tension[:, 0])(times))
    return np.array(columns).T


def of_ours(scene, times, motion=MOTION):
    """The same."""
    mooring = Mooring(scene)
    mooring.settle(at_rest(motion))
    history = mooring.run(*samples(motion, 1.0 / SAMPLE))
    return CubicSpline(history.time, np.array(history.fairlead_tension)[:, fairleads(scene)])(times)


def scenes():
    """{bed: Scene}, without friction."""
    loaded = {bed: load_scene(SCENES / f"volturnus_s_semi_taut{ending}.txt") for bed, ending in BEDS.items()}
    return {bed: replace(scene, environment=replace(scene.environment, friction=None)) for bed, scene in loaded.items()}


def statics(scene):
    """Tension (lines,) N of the segments at the fairleads, at rest: ours."""
    mooring = Mooring(scene)
    mooring.settle(at_rest(STILL))
    return mooring.fairlead_tension[fairleads(scene)]


def peer_statics(scene):
    """The same of MoorDyn and of CableDyn."""
    end = np.array([STILL.end - SAMPLE])
    return of_moordyn(scene, end, STILL)[0], of_cabledyn(scene, end, STILL)[0]


def load_statics():
    """{(bed, index of the line): (MoorDyn's, CableDyn's static tension in N)} from the file."""
    with open(FILE, encoding="utf-8") as file:
        rows = [line.split(",") for line in file if not line.startswith("#")][1:]
    return {(bed, int(line)): (float(a), float(b)) for bed, line, a, b in rows}


def write_statics(found):
    """Keep the peers' static tensions {(bed, line): (MoorDyn's, CableDyn's)} in the file, for the tests."""
    with open(FILE, "w", encoding="utf-8") as file:
        file.write("# VolturnUS-S semi-taut on four beds without friction, benchmarks/bathymetry.py\n# Static tension [N] of the segments at the fairleads\n")
        file.write("# MoorDyn 2.7.2 (dynamic relaxation), CableDyn 0.3.0\nbed,line,MoorDyn,CableDyn\n")
        for (bed, line), (a, b) in found.items():
            file.write(f"{bed},{line},{a:.1f},{b:.1f}\n")


def statics_table():
    """Static tensions of ours and the peers, and what misses the goal; the peers' go into the file."""
    peers, rows, failed = {}, [], []
    for bed, scene in scenes().items():
        ours = statics(scene)
        for k, (a, m, c) in enumerate(zip(ours, *peer_statics(scene), strict=True)):
            peers[bed, k] = (m, c)
            rows.append([f"{bed}, line {k + 1}", f"{a / 1e3:.2f}", f"{100 * (a / m - 1):+.2f} %", f"{100 * (a / c - 1):+.2f} %"])
            change = a / (m if k in SAME_LAW[bed] else c) - 1.0
            if abs(change) > GOAL:
                failed.append(f"{bed}, line {k + 1}: static tension off by {100 * change:+.2f} %, goal {100 * GOAL:.0f} %")
    write_statics(peers)
    return tables.table(["", "static tension, kN", "against MoorDyn", "against CableDyn"], rows), failed


def run(quick=False):
    """All beds; prints the tables."""
    at_first, failed = statics_table()
    print(at_first, flush=True)
    motion = replace(MOTION, measured_periods=1.0) if quick else MOTION
    times = np.arange(motion.start, motion.end - SAMPLE, SAMPLE)
    found = {}
    for bed, scene in scenes().items():
        found[bed] = {code: solve(scene, times, motion) for code, solve in (("ours", of_ours), ("MoorDyn", of_moordyn), ("CableDyn", of_cabledyn))}
        print(f"{bed}: done", flush=True)
    result = report(times, found)
    result["tables"]["bathymetry_statics"] = at_first
    result["failed"] += failed
    return result


def report(times, found):
    """Table, figure and misses of {bed: {code: tension (samples, lines)}}."""
    rows, failed = [], []
    for bed, codes in found.items():
        mean = {code: tension.mean(axis=0) for code, tension in codes.items()}
        deviation = {code: tension.std(axis=0) for code, tension in codes.items()}
        for k in range(len(mean["ours"])):
            change = {code: mean["ours"][k] / mean[code][k] - 1.0 for code in ("MoorDyn", "CableDyn")}
            swing = {code: deviation["ours"][k] / deviation[code][k] - 1.0 for code in ("MoorDyn", "CableDyn")}
            rows.append([f"{bed}, line {k + 1}", f"{mean['ours'][k] / 1e3:.1f}", f"{deviation['ours'][k] / 1e3:.1f}"])
            rows[-1] += [f"{100 * x:+.2f} %" for code in ("MoorDyn", "CableDyn") for x in (change[code], swing[code])]
            peer = "MoorDyn" if k in SAME_LAW_MOVING[bed] else "CableDyn"
            if abs(change[peer]) > GOAL:
                failed.append(f"{bed}, line {k + 1}: mean tension {100 * change[peer]:+.2f} % of {peer}'s, goal {100 * GOAL:.0f} %")
    header = ["", "mean, kN", "deviation, kN", "mean against MoorDyn", "deviation", "mean against CableDyn", "deviation"]
    content = {"bathymetry_tension": tables.table(header, rows)}
    print(content["bathymetry_tension"], flush=True)
    return {"tables": content, "failed": failed, "figures": {"bathymetry.png": picture(times, found)}}


def picture(times, found):
    """Tension of line 1 in time on the four beds, as in the paper's Figure 4."""
    figure, grid = figures.axes(len(found), 1, height=7.5, sharex=True)
    for axis, (bed, codes) in zip(grid[:, 0], found.items(), strict=True):
        for code, tension in codes.items():
            axis.plot(times, tension[:, 0] / 1e3, label=code, **figures.STYLES[code])
        axis.set_title(bed, loc="left", fontsize=10)
        axis.set_ylabel("tension of line 1 (kN)")
    grid[-1, 0].set_xlabel("time (s)")
    figures.legend(figure, grid[0, 0])
    return figure
