"""MoorDyn's converged tensions of the four cases, kept in a file, so that the tests can hold ours against them without MoorDyn.

``python -m benchmarks.moordyn_history`` writes the file anew (it needs MoorDyn: ``./run bench`` installs it).
"""

from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from mooring_ros.scene import load_scene

from .motions import SurgeHeave

SCENES = Path(__file__).parent.parent / "config" / "scenes"
CASES = (
    ("OC4 3 x 20", "oc4.txt", 20),
    ("OC4 3 x 40", "oc4.txt", 40),
    ("OC4 3 x 100", "oc4.txt", 100),
    ("VolturnUS-S 3 x 50", "volturnus_s_chain.txt", 50),
)
FILE = Path(__file__).parent / "data" / "moordyn_converged.csv"
MOTION = SurgeHeave(measured_periods=2.0)
INTERVAL = 0.05  # s
REFINEMENT = 10  # steps in a segment's transit time


def transit_time(scene, segments=None):
    """Time (s) in which an axial wave runs through the segment that it crosses soonest; ``segments`` of every line, None for the scene's."""
    return min(n.length / (segments or n.segments) * np.sqrt(n.type.mass / n.type.stiffness) for n in scene.lines)


def load():
    """(times (n,) in s, {case: fairlead segment tensions (n, 3) in N}) from the file."""
    with open(FILE, encoding="utf-8") as file:
        rows = [line for line in file if not line.startswith("#")]
    names = rows[0].strip().split(",")[1:]
    values = np.loadtxt(rows[1:], delimiter=",")
    cases = dict.fromkeys(name.rsplit(" line", 1)[0] for name in names)
    return values[:, 0], {case: values[:, [1 + k for k, name in enumerate(names) if name.rsplit(" line", 1)[0] == case]] for case in cases}


def write():
    """Run MoorDyn finely on every case and write the file."""
    from importlib.metadata import version

    from . import moordyn_peer

    times = np.arange(MOTION.start, MOTION.end - INTERVAL, INTERVAL)
    columns, names = [times], ["time"]
    for case, file, segments in CASES:
        scene = load_scene(SCENES / file)
        run = moordyn_peer.run(scene, MOTION, transit_time(scene, segments) / REFINEMENT, "RK2", segments, sample=0.02)
        columns += list(CubicSpline(run.times, run.tension)(times).T)
        names += [f"{case} {line.name}" for line in scene.lines]
        print(case, flush=True)
    with open(FILE, "w", encoding="utf-8") as file:
        file.write(f"# Tension [N] of the end segments at the fairleads, MoorDyn {version('moordyn')}, RK2, a step of 1/{REFINEMENT} of a segment's transit time\n")
        file.write(f"# Surge {MOTION.surge} m, heave {MOTION.heave} m, {MOTION.period} s, after {MOTION.ramp_periods} periods of ramp: benchmarks/motions.py\n")
        file.write(",".join(names) + "\n")
        for row in np.column_stack(columns):
            file.write(",".join([f"{row[0]:.2f}", *(f"{x:.0f}" for x in row[1:])]) + "\n")


if __name__ == "__main__":
    write()
