"""Scenes, motions and tables for the tests of the core and the façade."""

import csv
from pathlib import Path

import numpy as np

from mooring_ros.core.forces import evaluate_once
from mooring_ros.core.readings import observe
from mooring_ros.scene import COUPLED, FIXED, FREE, Environment, Line, LineType, Point, Scene

KINDS = (FIXED, COUPLED, FREE)
TESTS = Path(__file__).parent
SCENES = TESTS.parent / "config" / "scenes"
HERE = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
STILL = np.zeros(6)


def table(name):
    """Rows (dicts of text) of a reference table."""
    with open(TESTS / "reference" / name, newline="") as file:
        return list(csv.DictReader(file))


def line_type(diameter=0.1, mass=100.0, stiffness=1e8, damping=0.0, drag=0.0, added=0.0, drag_axial=0.0, added_axial=0.0, name="rope"):
    return LineType(
        name, diameter, mass, stiffness, damping, drag_normal=drag, added_mass_normal=added, drag_axial=drag_axial, added_mass_axial=added_axial
    )


def scene(points, lines, environment=None, **water):
    """Scene of points (kind, position, [mass, volume, drag_area, added_mass]) and lines (type, a, b, length, segments); IDs from 1.

    `water` are fields of Environment, with a depth of 1000 m unless given.
    """
    water = {"depth": 1000.0, **water}
    kinds = {row[0].name: row[0] for row in lines}
    return Scene(
        path="",
        text="",
        line_types=tuple(kinds.values()),
        points=tuple(Point(i, kind, tuple(map(float, where)), *own) for i, (kind, where, *own) in enumerate(points, 1)),
        lines=tuple(Line(i, *row) for i, row in enumerate(lines, 1)),
        environment=environment or Environment(**water),
    )


def anchored(kind, anchor, fairlead, length, segments, **water):
    """One line from a fixed anchor to a coupled fairlead."""
    return scene([(FIXED, anchor), (COUPLED, fairlead)], [(kind, 1, 2, length, segments)], **water)


def catenary_scene(row, segments):
    """The line of a row of catenary_static.csv without water (w = m g), its anchor at the origin of x on a bed that gives way by 1e-5 m."""
    w, height = float(row["w_N_per_m"]), float(row["z_span_m"])
    gravity, diameter = 10.0, 0.1
    return anchored(
        line_type(diameter, mass=w / gravity, stiffness=float(row["EA_N"])),
        (0.0, 0.0, -height),
        (float(row["x_span_m"]), 0.0, 0.0),
        float(row["L_m"]),
        segments,
        depth=height,
        gravity=gravity,
        water_density=0.0,
        bed_stiffness=w / diameter / 1e-5,
        bed_damping=0.0,
    )


def vacuum(points, lines, **more):
    """A scene without gravity, water and bed contact."""
    return scene(points, lines, gravity=0.0, water_density=0.0, bed_stiffness=0.0, bed_damping=0.0, **more)


def refresh(mooring):
    """Evaluate forces and readings again after a test has written into the state."""
    state = mooring._state
    evaluate_once(mooring._model, state, mooring._scratch, state.settings[0], state.settings[1], bool(state.settings[2]))
    observe(mooring._model, state, 0, mooring._readings)


def same_bits(a, b):
    """Whether two snapshots hold the same bits, NaN and the sign of zero included."""
    return (
        all(x.tobytes() == y.tobytes() for x, y in zip(a.state, b.state))
        and all(x.tobytes() == y.tobytes() for x, y in zip(a.readings, b.readings))
        and a.settled == b.settled
    )


def turn(axis, angle):
    """Quaternion x, y, z, w of a turn by `angle` (rad) about a world axis (3,)."""
    axis = np.asarray(axis, dtype=float)
    return np.append(np.sin(0.5 * angle) * axis / np.linalg.norm(axis), np.cos(0.5 * angle))


def times_quaternion(p, q):
    """The turn q followed by the turn p."""
    a, b = p[:3], q[:3]
    return np.append(p[3] * b + q[3] * a + np.cross(a, b), p[3] * q[3] - a @ b)


def difference(mooring, pose, steps):
    """-d wrench / d pose (6, 6) by central differences of fourth order; rotations about the world axes through the reference point."""
    columns = []
    for axis, step in enumerate(steps):
        total = np.zeros(6)
        for shift, weight in ((1, 8.0), (-1, -8.0), (2, -1.0), (-2, 1.0)):
            moved = pose.copy()
            if axis < 3:
                moved[axis] += shift * step
            else:
                moved[3:] = times_quaternion(turn(np.eye(3)[axis - 3], shift * step), pose[3:])
            mooring.settle(moved)
            total += weight * mooring.wrench
        columns.append(-total / (12.0 * step))
    return np.array(columns).T


def surge_heave(times, surge=4.0, heave=3.0, period=14.5, pitch=0.0):
    """Poses (k, 7) and twists (k, 6) of a harmonic motion that starts from rest over one period."""
    w = 2.0 * np.pi / period
    s = np.clip(times / period, 0.0, 1.0)
    ramp, slope = s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s) / period
    value, rate = ramp * np.sin(w * times), slope * np.sin(w * times) + ramp * w * np.cos(w * times)
    poses, twists = np.zeros((times.size, 7)), np.zeros((times.size, 6))
    poses[:, 0], twists[:, 0] = surge * value, surge * rate
    poses[:, 2], twists[:, 2] = heave * value, heave * rate
    poses[:, 4], poses[:, 6], twists[:, 4] = np.sin(0.5 * pitch * value), np.cos(0.5 * pitch * value), pitch * rate
    return poses, twists


