"""Scenes with rods and bodies for the tests of rigid parts, and how to set parts in motion."""

import dataclasses

import numpy as np
from scenes_in_code import COUPLED, FIXED, HERE, line_type, refresh, scene

from mooring_ros import Mooring
from mooring_ros.scene.description import Body, Rod, RodType

RHO, G = 1025.0, 9.80665
IDLE = line_type(0.01, 0.0805, 1e4, name="idle")  # weighs nothing in water


def world(points, lines, rods=(), bodies=(), idle=True, **water):
    """`scene` with rods (tuples as Rod's fields after id) and bodies (dicts of Body's fields).

    `idle`: with one more line that no part feels, below all: a scene has one line at least.
    """
    points = list(points)
    lines = list(lines)
    if idle:
        depth = water.get("depth", 1000.0)
        points += [(FIXED, (0.0, 0.0, -depth + 100.0)), (COUPLED, (0.0, 0.0, -depth + 190.0))]
        lines.append((IDLE, len(points) - 1, len(points), 100.0, 2))
    base = scene([point[:6] for point in points], lines, **water)
    on_bodies = {i: point[6] for i, point in enumerate(points) if len(point) > 6}
    held = tuple(dataclasses.replace(p, body=on_bodies.get(i)) for i, p in enumerate(base.points))
    rods = tuple(Rod(i, *row) for i, row in enumerate(rods, 1))
    return dataclasses.replace(
        base,
        points=held,
        rods=rods,
        rod_types=tuple({rod.type.name: rod.type for rod in rods}.values()),
        bodies=tuple(Body(i, **row) for i, row in enumerate(bodies, 1)),
    )


def rod_type(diameter=0.5, mass=100.0, drag=0.0, added=0.0, drag_end=0.0, added_end=0.0):
    return RodType("rod", diameter, mass, drag, added, drag_end, added_end)


def mooring(*args, dt=None, **kwargs):
    return Mooring(world(*args, **kwargs), dt=dt)


def start(mooring, b, place=None, quaternion=None, velocity=None, spin=None):
    """Put part b there, at rest or moving, and evaluate."""
    part = mooring._state.parts[b]
    part[7:] = 0.0
    for where, values in ((slice(0, 3), place), (slice(3, 7), quaternion), (slice(7, 10), velocity), (slice(10, 13), spin)):
        if values is not None:
            part[where] = values
    refresh(mooring)


def watch(mooring, b, times):
    """States (k, 13) of part b at times (k,), the platform at rest."""
    rows = []
    for t in times:
        mooring.step(t, HERE, np.zeros(6))
        rows.append(mooring._state.parts[b].copy())
    return np.array(rows)


def period(times, values):
    """Mean time between upward crossings of the values' mean level."""
    values = values - 0.5 * (values.max() + values.min())
    up = np.flatnonzero((values[:-1] < 0.0) & (values[1:] >= 0.0))
    exact = times[up] - values[up] * np.diff(times)[up] / (values[up + 1] - values[up])
    return np.diff(exact).mean()
