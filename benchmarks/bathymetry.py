"""The VolturnUS-S semi-taut mooring on four beds without friction (Housner et al. 2022, Figure 4), against MoorDyn and CableDyn.

The platform is moved by regular waves of 9.3 m and 14.9 s at 90 degrees: sway and heave a quarter period apart, the same on all beds.
MoorDyn (C++) pushes lines on a slope straight up; ours and CableDyn push along the bed's normal, as the paper and MoorDyn's Fortran version do.
In the plane of the slope that makes no difference without friction: the chain is held at the same place. Across it the chain slides downhill, or not.
"""

from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline

from mooring_ros.mooring import Mooring
from mooring_ros.scene import load_scene

from . import cabledyn_peer, figures, moordyn_peer, tables
from .moordyn_history import SCENES
from .motions import SurgeHeave
from .ours import at_rest, samples

BEDS = {"flat": "", "upslope": "_upslope", "downslope": "_downslope", "sideslope": "_sideslope"}
MOTION = SurgeHeave(surge=3.5, heave=3.7, period=14.9, ramp_periods=2.0, measured_periods=4.0, heading=90.0)
PEER_STEP = 2e-3  # s: a third of the step at which it blows up
CABLEDYN_STEP = 0.05  # s
SAMPLE = 0.1  # s
GOAL = 0.01  # of the mean tension, against MoorDyn where its law is the same, else against CableDyn
SAME_LAW = {"flat": (0, 1, 2), "upslope": (0,), "downslope": (0,), "sideslope": ()}  # lines that lie in the plane of the slope


def fairleads(scene):
    """Indices of the lines that end on the platform, in the file's order."""
    coupled = {p.id for p in scene.points if p.kind == "coupled"}
    return [k for k, line in enumerate(scene.lines) if {line.end_a, line.end_b} & coupled]


def of_moordyn(scene, times, motion=MOTION):
    """Tension (samples, lines) N of the segments at the fairleads."""
    run = moordyn_peer.run(scene, motion, PEER_STEP, "RK2", sample=SAMPLE, options=("1 ICgenDynamic",), friction=False)
    return CubicSpline(run.times, run.tension[:, fairleads(scene)])(times)


def of_cabledyn(scene, times, motion=MOTION):
    """The same; of a segment's axial force, the damping left out that CableDyn does not report."""
    columns = []
    for chain in cabledyn_peer.chains(scene):
        run = cabledyn_peer.run(scene, chain, motion, CABLEDYN_STEP, motion.end, curvature=False)
        columns.append(CubicSpline(run.times, run.tension[:, 0])(times))
    return np.array(columns).T


def of_ours(scene, times, motion=MOTION):
    """The same."""
    mooring = Mooring(replace(scene, environment=replace(scene.environment, friction=None)))
    mooring.settle(at_rest(motion))
    history = mooring.run(*samples(motion, 1.0 / SAMPLE))
    return CubicSpline(history.time, np.array(history.fairlead_tension)[:, fairleads(scene)])(times)


def run(quick=False):
    """All beds; prints the table."""
    motion = replace(MOTION, measured_periods=1.0) if quick else MOTION
    times = np.arange(motion.start, motion.end - SAMPLE, SAMPLE)
    found = {}
    for bed, ending in BEDS.items():
        scene = load_scene(SCENES / f"volturnus_s_semi_taut{ending}.txt")
        found[bed] = {"ours": of_ours(scene, times, motion), "MoorDyn": of_moordyn(scene, times, motion), "CableDyn": of_cabledyn(scene, times, motion)}
        print(f"{bed}: done", flush=True)
    return report(times, found)


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
            peer = "MoorDyn" if k in SAME_LAW[bed] else "CableDyn"
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
