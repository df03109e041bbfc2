"""Rigid parts against closed forms: a sphere that falls in water, one that heaves at the surface, and a rod that swings.

Each hangs in equilibrium on a thread that weighs nothing in water, until the platform lets go of it; everything is read from the façade.
"""

import numpy as np
from scipy.special import ellipj, ellipk

from mooring_ros.mooring import Mooring
from mooring_ros.scene.description import BODY, COUPLED, FREE, PINNED, Body, Environment, Line, LineType, Point, Rod, RodEnd, RodType, Scene

from . import figures, tables

RHO, G = 1025.0, 9.80665
THREAD = LineType("thread", float(np.sqrt(4e-3 / (np.pi * RHO))), 1e-3, 2e5, -1.0)
VOLUME, ADDED = 0.2, 0.5  # m^3, coefficient of a sphere
DIAMETER = (6.0 * VOLUME / np.pi) ** (1.0 / 3.0)
HERE = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
GOAL = 0.005


def let_go(scene, times, read):
    """Rows of ``read(mooring)`` at the times (from 0) after the first line was let go."""
    mooring = Mooring(scene, dt=2e-3)
    mooring.settle(HERE)
    rows = [read(mooring)]
    mooring.release(mooring.line_names[0])
    for t in times[1:]:
        mooring.step(t, HERE, np.zeros(6))
        rows.append(read(mooring))
    return np.array(rows)


def sphere(mass, top, length, drag_area):
    """A free sphere on a thread of ``length`` (m) from the platform at height ``top`` (m)."""
    water = {"volume": VOLUME, "drag_area": (drag_area,) * 6, "added_mass": (ADDED,) * 3}
    body = Body(1, FREE, (0.0, 0.0, top - length), mass=mass, inertia=(20.0, 20.0, 20.0), **water)
    points = (Point(1, COUPLED, (0.0, 0.0, top)), Point(2, BODY, (0.0, 0.0, 0.0), body=1))
    return Scene("sphere", "", (THREAD,), points, (Line(1, THREAD, 1, 2, length, 1),), Environment(depth=500.0), bodies=(body,))


def falling():
    """(times, height fallen (n,) in m, closed form)."""
    mass, area = 500.0, 0.25 * np.pi * DIAMETER**2 * 0.5
    times = 0.1 * np.arange(101)
    weight, inertia = (mass - RHO * VOLUME) * G, mass + ADDED * RHO * VOLUME
    terminal = np.sqrt(2.0 * weight / (RHO * area))
    tau = inertia * terminal / weight
    z = let_go(sphere(mass, -20.0, 10.0, area), times, lambda m: m.body_poses["body1"][2])
    return times, z - z[0], -terminal * tau * np.log(np.cosh(times / tau))


def heaving():
    """(times, height over the rest (n,) in m, closed form for small heave) of a sphere half as heavy as its water, held 0.5 % of its width too high."""
    mass = 0.5 * RHO * VOLUME
    length = 0.5
    times = 0.01 * np.arange(401)
    omega = np.sqrt(RHO * G * 0.25 * np.pi * DIAMETER**2 / (mass + 0.5 * ADDED * RHO * VOLUME))
    z = let_go(sphere(mass, 0.005 * DIAMETER + length, length, 0.0), times, lambda m: m.body_poses["body1"][2])
    return times, z, z[0] * np.cos(omega * times)


def swinging():
    """(times, angle from the vertical (n,) in rad, closed form) of a rod that is pinned at its upper end, in water with its added mass."""
    length, diameter, mass, held = 6.0, 0.4, 300.0, np.deg2rad(60.0)
    kind = RodType("rod", diameter, mass, added_mass_normal=1.0)
    low = (length * np.sin(held), 0.0, -20.0 - length * np.cos(held))
    rod = Rod(1, kind, PINNED, (0.0, 0.0, -20.0), low, 8)
    points = (Point(1, COUPLED, (low[0] + 10.0, 0.0, low[2] + 10.0)),)
    thread = Line(1, THREAD, 1, RodEnd(1, "B"), 10.0 * np.sqrt(2.0), 1)
    scene = Scene("pendulum", "", (THREAD,), points, (thread,), Environment(depth=500.0), rod_types=(kind,), rods=(rod,))
    times = 0.05 * np.arange(401)

    def angle(mooring):
        a, b = mooring.rod_positions("rod1")
        return np.arctan2(b[0] - a[0], a[2] - b[2])

    found = let_go(scene, times, angle)
    water = 0.25 * np.pi * diameter**2 * RHO
    inertia = (mass + water) * length**3 / 3.0 + mass * length * diameter**2 / 16.0
    omega, k = np.sqrt((mass - water) * G * length**2 / 2.0 / inertia), np.sin(0.5 * found[0])
    return times, found, 2.0 * np.arcsin(k * ellipj(omega * times + ellipk(k * k), k * k)[0])


CASES = {"sphere falling (m)": falling, "sphere heaving (m)": heaving, "rod swinging (rad)": swinging}


def run(quick=False):
    """All cases; prints the table."""
    rows, failed, found = [], [], {}
    for name, case in CASES.items():
        times, ours, exact = case()
        found[name] = times, ours, exact
        error = np.abs(ours - exact).max() / np.ptp(exact)
        rows.append([name, f"{times[-1]:g} s", f"{100 * error:.3f} %"])
        if error > GOAL:
            failed.append(f"{name}: {100 * error:.2f} % of its way from the closed form, goal {100 * GOAL:g} %")
    text = tables.table(["", "over", "largest difference, of the way"], rows)
    print(text, flush=True)
    return {"tables": {"parts": text}, "failed": failed, "figures": {"parts.png": picture(found)}}


def picture(found):
    """Each case over time, with its closed form."""
    figure, grid = figures.axes(1, len(found), height=3.2)
    for axis, (name, (times, ours, exact)) in zip(grid[0], found.items(), strict=True):
        axis.plot(times, ours, label="ours", **figures.STYLES["ours"])
        axis.plot(times, exact, color=figures.COLOURS[3], linewidth=1.1, label="closed form")
        axis.set(xlabel="time since it was let go (s)", ylabel=name)
    figures.legend(figure, grid[0, 0])
    return figure
