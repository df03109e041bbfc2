"""Bed contact of parts that weigh little or nothing."""

import numpy as np
import pytest
from scenes_in_code import COUPLED, FIXED, FREE, HERE, anchored, line_type, refresh, scene

from mooring_ros import Mooring


@pytest.mark.parametrize("mass", [0.0, 1.0, 500.0])
def test_a_buoy_pressed_into_the_bed_rises(mass):
    """A cubic metre of volume 5 cm inside the bed, on a light rope: off the bed within two seconds, whatever little it weighs."""
    rope = line_type(diameter=0.02, mass=0.3, stiffness=1e6, damping=-0.5, drag=1.0, added=1.0)
    points = [(FIXED, (0, 0, -50)), (FREE, (0, 0, -45), mass, 1.0, 1.0, 0.5), (COUPLED, (20, 0, 0))]
    mooring = Mooring(scene(points, [(rope, 1, 2, 5.0, 4), (rope, 2, 3, 60.0, 20)], depth=50.0))
    mooring.settle(HERE)
    node = mooring._model.point_node[1]
    mooring._state.position[2, node] = -50.05
    refresh(mooring)
    mooring.run(0.05 * np.arange(1, 41), np.tile(HERE, (40, 1)), np.zeros((40, 6)))
    assert mooring._state.position[2, node] > -49.9


@pytest.mark.parametrize("short", [1e-9, 1e-7, 1e-5, 0.0])
def test_a_line_a_hair_short_of_lying_slack_settles(short):
    """Legs of 100 m and 500 m of bed between, as long as that to the hair: settles, with the legs' weight at the ends."""
    kind = line_type(diameter=0.1, mass=100.0, stiffness=1e9)
    mooring = Mooring(anchored(kind, (0, 0, -100), (500, 0, 0), 600.0 - short, 60, depth=100.0, water_density=0.0))
    mooring.settle(HERE)
    assert mooring.static_result.converged
    assert mooring.fairlead_end_force[0, 2] == pytest.approx(-100.0 * 9.80665 * 100.0, rel=0.1)


def test_a_scene_without_coupled_points_has_no_stiffness():
    kind = line_type(mass=50.0)
    mooring = Mooring(scene([(FIXED, (0, 0, -10)), (FIXED, (50, 0, -10))], [(kind, 1, 2, 55.0, 10)]))
    mooring.settle(HERE)
    assert not mooring.stiffness().any() and not mooring.wrench.any()
