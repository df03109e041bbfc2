"""Statics with friction that remembers, on beds down which a line without friction would slide far."""

import numpy as np
import pytest
from scenes_in_code import COUPLED, FIXED, HERE, anchored, line_type, scene

from mooring_ros import Mooring
from mooring_ros.scene import STICK, Friction

CHAIN = line_type(0.2, 180.0, 1e9)


def rough(coefficient):
    return Friction(STICK, 1.1 * coefficient, 1.1 * coefficient, coefficient, coefficient)


def across(slope, coefficient, height=0.0):
    """A chain that runs along y, across a bed that rises along x; its anchor `height` (m) above the bed."""
    return anchored(
        CHAIN, (0.0, 600.0, height - 120.0), (0.0, 10.0, -5.0), 650.0, 65, depth=120.0, bed_slope=(slope, 0.0), friction=rough(coefficient)
    )


@pytest.mark.parametrize("slope, coefficient", [(1.0 / 15.0, 0.6), (0.125, 0.3), (0.125, 1.0), (0.3, 0.6), (0.4, 0.4)])
def test_a_line_laid_across_a_slope_settles_where_friction_holds_it(slope, coefficient):
    """Without friction it lies tens of metres downhill; held, its nodes on the bed stay within a metre of the line in which they were laid."""
    mooring = Mooring(across(slope, coefficient))
    mooring.settle(HERE)
    assert mooring.static_result.converged and mooring.static_result.as_laid and not mooring.warnings
    x, _, z = mooring.node_positions("line1").T
    lying = z < -120.0 + slope * x
    assert lying.sum() > 20
    assert np.abs(x[lying]).max() < 1.0
    free = Mooring(across(slope, 0.0))
    free.settle(HERE)
    assert np.abs(free.node_positions("line1")[:, 0]).max() > 20.0


def test_lines_up_and_down_and_across_a_slope_settle_together():
    anchors = [(400.0, 0.0), (0.0, 400.0), (-400.0, 0.0), (0.0, -400.0), (300.0, 300.0)]
    points = [(FIXED, (x, y, -100.0 + 0.2 * x)) for x, y in anchors]
    points += [(COUPLED, (0.02 * x, 0.02 * y, -10.0)) for x, y in anchors]
    lengths = [np.linalg.norm(np.subtract(a[1], b[1])) * 1.06 for a, b in zip(points[:5], points[5:])]
    lines = [(CHAIN, k + 1, k + 6, lengths[k], 40) for k in range(5)]
    mooring = Mooring(scene(points, lines, depth=100.0, bed_slope=(0.2, 0.0), friction=rough(0.7)))
    mooring.settle(HERE)
    assert mooring.static_result.converged and mooring.static_result.as_laid


def test_a_platform_that_moves_far_between_samples_drags_its_lines_along():
    mooring = Mooring(across(0.125, 0.6), fidelity="quasi_static")
    mooring.settle(HERE)
    for k in range(1, 6):
        pose = HERE.copy()
        pose[:2] = 2.0 * k, -1.0 * k
        mooring.step(float(k), pose, np.zeros(6))
        assert np.isfinite(mooring.fairlead_tension).all()
