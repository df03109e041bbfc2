"""Elastic catenaries on a rough bed: `stick` friction from the as-laid state against the closed form with CB."""

import numpy as np
import pytest
from scenes_in_code import COUPLED, FIXED, HERE, line_type, scene, table

from mooring_ros import Mooring
from mooring_ros.scene.description import Friction

# An inextensible line on a rough bed has no definite friction: nothing slides. Its row is taken with a strain of some 1e-5.
STIFFEST = 1e10
ROWS = [row for row in table("catenary_static.csv") if float(row["CB"]) > 0.0]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['case']}-{row['CB']}")
def test_a_line_on_a_rough_bed_has_the_tensions_of_the_catenary_with_friction(row):
    value = {key: float(row[key]) for key in ("x_span_m", "z_span_m", "L_m", "EA_N", "w_N_per_m", "CB", "H_fair_N", "V_fair_N", "H_anch_N")}
    depth, length, weight, mu = value["z_span_m"], value["L_m"], value["w_N_per_m"], value["CB"]
    kind = line_type(diameter=0.1 if length > 100.0 else 0.002, mass=weight / 9.80665, stiffness=min(value["EA_N"], STIFFEST if depth == 200.0 else np.inf))
    points = [(FIXED, (0.0, 0.0, -depth)), (COUPLED, (value["x_span_m"], 0.0, 0.0))]
    friction = Friction("stick", mu, mu, mu, mu)
    mooring = Mooring(scene(points, [(kind, 1, 2, length, 200)], depth=depth, water_density=0.0, friction=friction))
    mooring.settle(HERE)
    assert mooring.static_result.converged
    fairlead, anchor = -mooring.fairlead_end_force[0], mooring.anchor_end_force[0]
    within = 2e-3 * value["H_fair_N"]
    assert fairlead[0] == pytest.approx(value["H_fair_N"], abs=within)
    assert fairlead[2] == pytest.approx(value["V_fair_N"], abs=within)
    # where sliding ends before the anchor, some of a node's share is left
    assert anchor[0] == pytest.approx(value["H_anch_N"], abs=within + mu * weight * length / 200)
