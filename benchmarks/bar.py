"""A chain on a rough bed, dragged along itself at one end and let back: force over displacement against the bar on a Coulomb bed (closed form).

Loaded from rest it gives way by u = F^2/2k with k = EA mu w, unloaded from u1, F1 by u1 - u = (F1 - F)^2/4k; a full cycle costs (F1 - F2)^3/12k.
Then the end is held for five minutes; and one more chain is pulled at a quarter of what all of it can hold, for an hour.
"""

from dataclasses import dataclass

import numpy as np

from mooring_ros.mooring import Mooring
from mooring_ros.scene.description import COUPLED, FIXED, SATURATED, STICK, Environment, Friction, Line, LineType, Point, Scene

from . import figures, tables
from .motions import poses_and_twists, smooth_ramp

STIFFNESS, FRICTION, WEIGHT, LOAD = 1229.8e6, 0.69, 2441.85952623, 1e6  # N, -, N/m, N: first rows of tests/reference/bar_on_coulomb_bed.csv
SPRING = STIFFNESS * FRICTION * WEIGHT  # k, N^2/m
SEGMENTS = 200
LENGTH = 1.2 * LOAD / (FRICTION * WEIGHT)  # m: the slip zone does not reach the other end
DEPTH, DIAMETER = 100.0, 0.216  # m
STROKE = 60.0  # s, of one loading or unloading: the inertia of the chain takes less than 0.1 % of the force
HELD = 300.0  # s
HOUR = 3600.0  # s
LAWS = (SATURATED, STICK)
GOAL = 0.01
GOAL_DRIFT = 1e-3  # m


def scene(law):
    """The chain along x, end B on the platform, pressed into the bed as deep as the rest of it lies."""
    env = Environment(depth=DEPTH, friction=Friction(law, *(FRICTION,) * 4))
    mass = WEIGHT / env.gravity + env.water_density * np.pi / 4.0 * DIAMETER**2
    kind = LineType("chain", DIAMETER, mass, STIFFNESS, -0.5)
    level = -DEPTH - WEIGHT / (env.bed_stiffness * DIAMETER)
    points = (Point(1, FIXED, (0.0, 0.0, level)), Point(2, COUPLED, (LENGTH, 0.0, level)))
    return Scene("bar", "", (kind,), points, (Line(1, kind, 1, 2, LENGTH, SEGMENTS),), env)


@dataclass(frozen=True)
class Strokes:
    """The end goes along x from one stop to the next, each way in ``stroke`` s, and stays at the last for ``held`` s."""

    stops: tuple  # m, from 0
    stroke: float = STROKE
    held: float = 0.0

    @property
    def end(self):
        """s"""
        return self.stroke * (len(self.stops) - 1) + self.held

    def displacement(self, t):
        """Displacement (n, 3) in m and velocity (n, 3) in m/s at the times t (n,)."""
        t = np.asarray(t, dtype=float)
        place, speed = np.zeros((2, len(t), 3))
        for k, (start, stop) in enumerate(zip(self.stops, self.stops[1:], strict=False)):
            gone, rate = smooth_ramp(t - k * self.stroke, self.stroke)
            place[:, 0] += (stop - start) * gone
            speed[:, 0] += (stop - start) * rate
        return place, speed


def drag(law, motion, sample):
    """(times, force at the end (n,) in N, mooring) from the statics through the motion."""
    mooring = Mooring(scene(law))
    start, _ = poses_and_twists(*motion.displacement(np.zeros(1)))
    mooring.settle(start[0])
    times = sample * np.arange(1, round(motion.end / sample) + 1)
    history = mooring.run(times, *poses_and_twists(*motion.displacement(times)))
    return times, -history.fairlead_end_force[:, 0, 0], mooring


def quarter_for_an_hour():
    """(largest way of a node in m, change of the tension at the end of it all) while the end stays where a quarter of the limit has drawn it."""
    force = 0.25 * FRICTION * WEIGHT * LENGTH
    mooring = Mooring(scene(STICK))
    motion = Strokes((0.0, force**2 / (2.0 * SPRING)), held=1.0)
    times = np.arange(1.0, motion.end + 0.5)
    mooring.settle(np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]))
    poses, twists = poses_and_twists(*motion.displacement(times))
    mooring.run(times, poses, twists)
    before, pulled = mooring.node_positions("line1"), mooring.fairlead_tension[0]
    later = motion.end + 60.0 * np.arange(1, round(HOUR / 60.0) + 1)
    mooring.run(later, np.repeat(poses[-1:], len(later), axis=0), np.zeros((len(later), 6)))
    return float(np.abs(mooring.node_positions("line1") - before).max()), float(mooring.fairlead_tension[0] / pulled - 1.0)


def closed_form(u):
    """{stroke: force (n,) in N at the displacements u (n,)} of loading, unloading to no force and loading again."""
    top, bottom = LOAD**2 / (2.0 * SPRING), LOAD**2 / (4.0 * SPRING)
    loading = np.where(u <= top, np.sqrt(2.0 * SPRING * np.clip(u, 0.0, top)), np.nan)
    between = np.where((u >= bottom) & (u <= top), u, np.nan)
    return {"loaded": loading, "unloaded": LOAD - 2.0 * np.sqrt(SPRING * (top - between)), "loaded again": 2.0 * np.sqrt(SPRING * (between - bottom))}


def run(quick=False):
    """Both laws; prints the table."""
    top, bottom = LOAD**2 / (2.0 * SPRING), LOAD**2 / (4.0 * SPRING)
    motion = Strokes((0.0, top, bottom, top), held=10.0 if quick else HELD)
    found = {law: drag(law, motion, 0.25) for law in LAWS}
    rows, failed = [], []
    for law, (times, force, mooring) in found.items():
        u = motion.displacement(times)[0][:, 0]
        at = [np.searchsorted(times, k * STROKE - 1e-6) for k in (1, 2, 3)]
        cycle = slice(at[0], at[2] + 1)
        loss = np.trapezoid(force[cycle], u[cycle])
        exact = LOAD**3 / (12.0 * SPRING)
        held = mooring.node_tension("line1")[SEGMENTS // 2]
        rows.append([law, *(f"{force[k] / 1e3:.1f}" for k in at), f"{abs(loss) / 1e3:.2f}", f"{force[-1] / 1e3:.1f}", f"{held / 1e3:.1f}"])
        if law == STICK:
            errors = dict(zip(("F1", "F2", "F1 again"), force[at] / LOAD - np.array([1.0, 0.0, 1.0]), strict=True)) | {"loss": abs(loss) / exact - 1.0}
            failed += [f"bar on a rough bed: {name} off by {100 * x:+.2f} %, goal {100 * GOAL:.0f} %" for name, x in errors.items() if abs(x) > GOAL]
    middle = FRICTION * WEIGHT * (0.5 * LENGTH - LENGTH) + LOAD
    loaded = f"{LOAD / 1e3:.1f}"
    rows.append(["closed form", loaded, "0.0", loaded, f"{LOAD**3 / (12.0 * SPRING) / 1e3:.2f}", loaded, f"{middle / 1e3:.1f}"])
    header = ["law", "force when loaded, kN", "when let back", "when loaded again", "lost in the cycle, kJ", "after 5 min, kN", "in the middle, kN"]
    text = tables.table(header, rows)
    if not quick:
        drift, lost = quarter_for_an_hour()
        text += "\n\nPulled at a quarter of its limit for an hour, `stick`: "
        text += f"no node goes farther than {1e3 * drift:.4f} mm, the tension changes by {100 * lost:+.4f} %."
        if drift > GOAL_DRIFT:
            failed.append(f"bar on a rough bed: {1e3 * drift:.2f} mm in an hour, goal {1e3 * GOAL_DRIFT:.0f} mm")
    print(text, flush=True)
    return {"tables": {"friction_bar": text}, "failed": failed, "figures": {"friction_bar.png": picture(motion, found)}}


def picture(motion, found):
    """Force over displacement of both laws, and over time while the end is held."""
    figure, grid = figures.axes(1, 2, height=3.6, width_ratios=(1.3, 1.0))
    u = np.linspace(0.0, motion.stops[1], 400)
    for k, force in enumerate(closed_form(u).values()):
        grid[0, 0].plot(1e3 * u, force / 1e3, color=figures.COLOURS[3], linewidth=4.0, alpha=0.35, label=None if k else "closed form")
    for colour, (law, (times, force, _)) in zip(figures.COLOURS, found.items(), strict=False):
        moving = times <= motion.end - motion.held
        grid[0, 0].plot(1e3 * motion.displacement(times[moving])[0][:, 0], force[moving] / 1e3, color=colour, linewidth=1.3, label=law)
        grid[0, 1].plot(times[~moving] - times[moving][-1], force[~moving] / 1e3, color=colour, linewidth=1.3)
    grid[0, 0].set(xlabel="displacement of the end (mm)", ylabel="force (kN)")
    grid[0, 1].set(xlabel="time that the end is held (s)", ylabel="force (kN)")
    figures.legend(figure, grid[0, 0])
    return figure
