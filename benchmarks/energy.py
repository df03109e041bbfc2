"""A closed account of energy: a cable with bending stiffness, clamped below, its upper end driven, without damping, drag and friction, for 100 periods.

Kinetic, strain, bending and potential energy together are what they were at first and the work that the platform has done at the end:
the sum of end force times speed, from the readings alone.
"""

import numpy as np

from mooring_ros.mooring import Mooring
from mooring_ros.scene.description import COUPLED, FIXED, Environment, Line, LineType, Point, Rod, RodEnd, RodType, Scene

from . import figures, tables
from .motions import SurgeHeave
from .ours import at_rest, samples

KIND = LineType("cable", 0.1, 60.0, 5e6, 0.0, bending_stiffness=2e5)
MOTION = SurgeHeave(surge=1.5, heave=1.0, period=8.0, ramp_periods=2.0, measured_periods=98.0)
RATE = 50.0  # Hz: of the readings that the work is summed from
STEPS = (None, 0.5, 0.25)  # of the default step
GOAL = 1e-3  # of the largest change of energy within a period


def scene():
    """80 m of cable in a vacuum between a clamp in the ground and the platform."""
    rod = Rod(1, RodType("clamp", 0.1, 60.0), FIXED, (-1.0, 0.0, -60.0), (0.0, 0.0, -60.0), 1)
    ends = (Point(1, COUPLED, (55.0, 0.0, -20.0)),)
    line = Line(1, KIND, RodEnd(1, "B"), 1, 80.0, 40)
    return Scene("energy", "", (KIND,), ends, (line,), Environment(depth=200.0, water_density=0.0), rod_types=(rod.type,), rods=(rod,))


def energies(mooring):
    """{name: J} now."""
    held = mooring.energy
    return {name: getattr(held, name) for name in ("kinetic", "strain", "bending", "potential")}


def account(share=None, motion=MOTION):
    """(times, {name: energies (n,) in J}, work (n,) in J) with a share of the default step."""
    mooring = Mooring(scene())
    if share is not None:
        mooring = Mooring(scene(), dt=share * mooring.step_limit.dt)
    mooring.settle(at_rest(motion))
    times, poses, twists = samples(motion, RATE)
    every = round(motion.period * RATE / 16.0)
    half = 0.5 * KIND.mass * mooring.scene.lines[0].length / mooring.scene.lines[0].segments
    speed = np.concatenate([np.zeros((1, 3)), twists[:, :3]])
    # the reading has the mean of the acceleration since the last sample
    late = half * (np.diff(speed, axis=0) * RATE - np.gradient(speed, 1.0 / RATE, axis=0)[1:])
    power, found, at = [0.0], [energies(mooring)], [0.0]
    for first in range(0, len(times), every):
        block = slice(first, first + every)
        history = mooring.run(times[block], poses[block], twists[block])
        power += list(-((history.fairlead_end_force[:, 0] + late[block]) * twists[block, :3]).sum(axis=1))
        found.append(energies(mooring))
        at.append(times[block][-1])
    work = np.concatenate([[0.0], np.cumsum(0.5 * (np.array(power[1:]) + np.array(power[:-1])) / RATE)])
    rows = np.rint(np.array(at) * RATE).astype(int)
    return np.array(at), {name: np.array([row[name] for row in found]) for name in found[0]}, work[rows]


def run(quick=False):
    """The account at three steps; prints the table."""
    motion = SurgeHeave(surge=1.5, heave=1.0, period=8.0, ramp_periods=2.0, measured_periods=8.0) if quick else MOTION
    rows, failed, kept = [], [], None
    for share in STEPS:
        times, parts, work = account(share, motion)
        total = sum(parts.values())
        swing = np.ptp(total[times > motion.start])
        error = (total - total[0] - work) / swing
        late = times > motion.start
        drift = np.polyfit(times[late], error[late], 1)[0] * (motion.end - motion.start)
        rows.append(["default" if share is None else f"{share:g} of it", f"{np.abs(error).max():.1e}", f"{drift:+.1e}"])
        if share is None:
            kept = times, parts, work, error
            if abs(drift) > GOAL:
                failed.append(f"energy: the account drifts by {100 * drift:.2f} %, goal {100 * GOAL:g} %")
    text = tables.table(["step", "largest difference, of the swing of the energy", "drift over all periods"], rows)
    print(text, flush=True)
    return {"tables": {"energy": text}, "failed": failed, "figures": {"energy.png": picture(*kept)}}


def picture(times, parts, work, error):
    """Energies over the first ten periods, and what the account lacks over all."""
    figure, grid = figures.axes(1, 2, height=3.2)
    early = times <= 10.0 * MOTION.period
    for colour, (name, values) in zip(figures.COLOURS, {**parts, "work done": work}.items(), strict=False):
        grid[0, 0].plot(times[early], (values - values[0])[early] / 1e3, color=colour, linewidth=1.2, label=name)
    grid[0, 0].set(xlabel="time (s)", ylabel="change since the start (kJ)")
    grid[0, 1].plot(times, 1e3 * error, color=figures.COLOURS[0], linewidth=0.8)
    grid[0, 1].set(xlabel="time (s)", ylabel="account, of the energy's swing (‰)")
    figures.legend(figure, grid[0, 0])
    return figure
