"""Equilibria that topple are left for ones that stand, or called so."""

import numpy as np
import pytest
from parts_in_code import world
from scenes_in_code import COUPLED, FIXED, HERE, line_type
from scipy import sparse

from benchmarks.extremes.random_scenes import random_case
from mooring_ros import Mooring
from mooring_ros.core.toppling import direction_of_fall
from mooring_ros.scene import BODY, FREE


def test_direction_of_fall_is_the_most_unstable_one():
    stiffness = sparse.diags([1e8, -2.0, 3.0, -50.0, 1.0]).tocsr()
    step = direction_of_fall(stiffness, np.ones(5))
    np.testing.assert_allclose(np.abs(step), [0.0, 0.0, 0.0, 1.0, 0.0], atol=1e-6)


def test_what_stands_or_is_neutral_does_not_fall():
    assert direction_of_fall(sparse.diags([1e8, 0.0, 3.0]).tocsr(), np.ones(3)) is None


def test_body_hung_upside_down_turns_over():
    """Hung at a point below its centre of gravity: an equilibrium that Newton's method finds, and that gravity would not keep."""
    chain = line_type(mass=20.0, stiffness=1e7, drag=1.2, added=1.0)
    body = {"kind": FREE, "position": (0.0, 0.0, -60.0), "mass": 5000.0, "centre_of_gravity": (0.0, 0.0, 1.0), "inertia": (5000.0,) * 3, "volume": 1.0, "drag_area": (1.0,) * 6}
    points = [(COUPLED, (0.0, 0.0, -10.0)), (BODY, (0.0, 0.0, 0.5), 0.0, 0.0, 0.0, 0.0, 1), (FIXED, (0.0, 0.0, -100.0)), (BODY, (0.0, 0.0, -0.5), 0.0, 0.0, 0.0, 0.0, 1)]
    mooring = Mooring(world(points, [(chain, 1, 2, 49.0, 4), (chain, 3, 4, 60.0, 4)], bodies=[body], idle=False, depth=100.0))
    mooring.settle(HERE)
    x, y, z, w = mooring.body_poses["body1"][3:]
    assert 1.0 - 2.0 * (x * x + y * y) < 0.0, "its axis still points upwards"
    assert mooring.warnings == ()


@pytest.mark.parametrize("seed", [171])
def test_a_random_scene_that_toppled_stays_where_it_settles(seed):
    _, scene, motion = random_case(seed)
    mooring = Mooring(scene)
    mooring.settle(motion.start)
    rest = mooring.fairlead_tension
    mooring.run(np.arange(1, 41) * 0.2, np.tile(motion.start, (40, 1)), np.zeros((40, 6)))
    np.testing.assert_allclose(mooring.fairlead_tension, rest, rtol=1e-3)
