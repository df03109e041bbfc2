"""Claim: a flat scene turned into a slope, with everything that acts in it, gives the same tensions.

Gravity stays upright, so the line weighs nothing in water: its ends stand below the bed and draw it against it. `stick` is left to
tests/core/test_bathymetry.py: it begins with a line that is laid down from above, which is not turned.
"""

import numpy as np
import pytest

from mooring_ros import Mooring
from mooring_ros.scene.description import COUPLED, FIXED, SATURATED, Environment, Friction, Line, LineType, Point, Scene

DEPTH, SLOPE = 100.0, 0.125
DIAMETER = 0.2
KIND = LineType("line", DIAMETER, 1025.0 * np.pi * DIAMETER**2 / 4.0, 2e7, -0.2, drag_normal=1.2, added_mass_normal=1.0, drag_axial=0.1)
ANCHOR, FAIRLEAD = np.array([-30.0, 5.0, -0.05]), np.array([30.0, -3.0, -0.04])  # m, from a place on the bed
TIMES = np.arange(1, 401) * 0.05


def turned(slope):
    """Turn of the flat bed into the slope."""
    up = np.arctan(slope)
    return np.array([[np.cos(up), 0.0, -np.sin(up)], [0.0, 1.0, 0.0], [np.sin(up), 0.0, np.cos(up)]])


def tensions(slope, law):
    """Tensions (samples, 2) N of the end segments at rest and while the fairlead is drawn about on the bed."""
    turn, middle = turned(slope), np.array([0.0, 0.0, -DEPTH])
    places = [tuple(middle + turn @ place) for place in (ANCHOR, FAIRLEAD)]
    friction = law and Friction(law, 0.5, 0.8, 0.4, 0.6, ramp=1e4)
    environment = Environment(depth=DEPTH, bed_slope=(slope, 0.0), friction=friction)
    length = np.linalg.norm(FAIRLEAD - ANCHOR) * 0.999
    points = (Point(1, FIXED, places[0]), Point(2, COUPLED, places[1]))
    mooring = Mooring(Scene("turned", "", (KIND,), points, (Line(1, KIND, 1, 2, length, 30),), environment))
    mooring.settle(np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]))
    first = [mooring.anchor_tension[0], mooring.fairlead_tension[0]]
    grow = np.minimum(TIMES / 5.0, 1.0)[:, None] ** 2 * np.column_stack([0.01 * np.sin(TIMES), 0.3 * np.sin(0.7 * TIMES), 0.01 * np.sin(2.0 * TIMES)])
    poses, twists = np.zeros((TIMES.size, 7)), np.zeros((TIMES.size, 6))
    poses[:, :3], poses[:, 6] = grow @ turn.T, 1.0
    twists[:, :3] = np.gradient(grow, 0.05, axis=0) @ turn.T
    history = mooring.run(TIMES, poses, twists)
    return np.vstack([first, np.column_stack([history.anchor_tension, history.fairlead_tension])])


@pytest.mark.parametrize("law", [None, SATURATED])
def test_a_flat_scene_turned_into_a_slope_has_the_same_tensions(law):
    flat, sloped = tensions(0.0, law), tensions(SLOPE, law)
    assert np.ptp(flat[:, 1]) > 0.1 * flat[0, 1] > 0.0
    np.testing.assert_allclose(sloped, flat, rtol=0.0, atol=3e-6 * np.abs(flat).max())


def test_the_beds_friction_matters_to_the_turned_scene():
    assert np.abs(tensions(0.0, SATURATED) - tensions(0.0, None)).max() > 1e-3 * np.abs(tensions(0.0, None)).max()
