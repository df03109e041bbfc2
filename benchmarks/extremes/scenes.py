"""Small scenes, drawn up in code."""

import numpy as np

from mooring_ros.scene import COUPLED, FIXED, FREE, Environment, Line, LineType, Point, Scene

G, RHO = 9.80665, 1025.0
VACUUM = {"gravity": 0.0, "water_density": 0.0, "bed_stiffness": 0.0, "bed_damping": 0.0, "depth": 1000.0}


def kind(name="chain", diameter=0.1, mass=100.0, stiffness=4e8, damping=-0.5, bending=0.0, drag=1.2, added=1.0, drag_axial=0.05):
    """A type of line; a chain of 902 N/m in water unless told otherwise."""
    return LineType(name, diameter, mass, stiffness, damping, bending, drag, added, drag_axial)


def weight(line_type, water_density=RHO, gravity=G):
    """N/m in water."""
    return (line_type.mass - water_density * 0.25 * np.pi * line_type.diameter**2) * gravity


def scene(points, lines, failures=(), **environment):
    """Points (kind, place, [mass, volume, CdA, Ca]) and lines (type, a, b, length, segments); IDs from 1."""
    types = {row[0].name: row[0] for row in lines}
    return Scene(
        path="",
        text="",
        line_types=tuple(types.values()),
        points=tuple(Point(i, held, tuple(map(float, place)), *map(float, own)) for i, (held, place, *own) in enumerate(points, 1)),
        lines=tuple(Line(i, of, a, b, float(length), int(count)) for i, (of, a, b, length, count) in enumerate(lines, 1)),
        failures=tuple(failures),
        environment=Environment(**{"depth": 100.0, **environment}),
    )


def one_line(of, anchor, fairlead, length, segments, **environment):
    """From a fixed anchor to a point on the platform."""
    return scene([(FIXED, anchor), (COUPLED, fairlead)], [(of, 1, 2, length, segments)], **environment)


def chain(segments=20, length=335.0, of=None, **environment):
    """A chain from the bed 300 m away in 100 m of water to the platform, a third of it on the bed."""
    return one_line(of or kind(), (300.0, 0.0, -environment.get("depth", 100.0)), (0.0, 0.0, -10.0), length, segments, **environment)


def three_chains(segments=12, radius=5.0):
    """Three of them around a small platform."""
    points, lines = [], []
    for k in range(3):
        c, s = np.cos(2.0 * np.pi * k / 3.0), np.sin(2.0 * np.pi * k / 3.0)
        points += [(FIXED, (300.0 * c, 300.0 * s, -100.0)), (COUPLED, (radius * c, radius * s, -10.0))]
        lines.append((kind(), 2 * k + 1, 2 * k + 2, 335.0, segments))
    return scene(points, lines)


def bridle(mass=0.0, volume=0.0, failures=(), legs=2):
    """A line from the platform to a free point, which two legs hold."""
    points = [(COUPLED, (0.0, 0.0, -10.0)), (FREE, (60.0, 0.0, -40.0), mass, volume), (FIXED, (300.0, 80.0, -100.0)), (FIXED, (300.0, -80.0, -100.0))]
    lines = [(kind(), 2, 1, 70.0, 6), (kind(), 3, 2, 270.0, 12), (kind(), 4, 2, 270.0, 12)]
    return scene(points[: 2 + legs], lines[: 1 + legs], failures)
