"""Statics against the elastic catenary: end forces, node profiles, order of convergence."""

import numpy as np
import pytest
from scenes_in_code import HERE, anchored, catenary_scene, line_type, table
from scipy.optimize import fsolve

from mooring_ros import Mooring

FRICTIONLESS = [row for row in table("catenary_static.csv") if float(row["CB"]) == 0.0]
PROFILES = [row for row in table("catenary_node_profiles.csv") if float(row["CB"]) == 0.0]


def settled(scene):
    mooring = Mooring(scene)
    mooring.settle(HERE)
    return mooring


def case_row(name):
    return next(row for row in FRICTIONLESS if row["case"] == name)


@pytest.mark.parametrize("row", FRICTIONLESS, ids=lambda row: row["case"])
def test_end_forces_at_200_segments_are_within_a_thousandth(row):
    """catenary_static.csv, CB = 0: fairlead force by component, anchor force in plan and size, 0.1 %.

    The diameter only sets the bed's stiffness; the chosen one lets the chain sink by 1e-5 m, which no force feels. The vertical force at an
    anchor that a lying line ends at is half a segment's weight here and nothing in the table, because the node stands exactly on the bed.
    """
    mooring = settled(catenary_scene(row, 200))
    h, v = float(row["H_fair_N"]), float(row["V_fair_N"])
    np.testing.assert_allclose(mooring.fairlead_end_force[0], [-h, 0.0, -v], rtol=1e-3, atol=1e-6 * h)
    anchor = mooring.anchor_end_force[0]
    assert anchor[0] == pytest.approx(float(row["H_anch_N"]), rel=1e-3)
    assert np.linalg.norm(anchor) == pytest.approx(float(row["T_anch_N"]), rel=1e-3)
    half_segment = 0.5 * float(row["w_N_per_m"]) * float(row["L_m"]) / 200
    assert abs(anchor[2]) <= 1.05 * half_segment
    np.testing.assert_allclose(mooring.wrench[:3], mooring.fairlead_end_force[0], rtol=1e-12)


@pytest.mark.parametrize("name", sorted({row["case"] for row in PROFILES}))
def test_node_profile_follows_the_catenary(name):
    """catenary_node_profiles.csv, CB = 0, 41 stations, at 400 segments: positions within 2e-5 of the line's length, tensions within 0.1 %."""
    rows = [row for row in PROFILES if row["case"] == name]
    length, height = float(case_row(name)["L_m"]), float(case_row(name)["z_span_m"])
    mooring = settled(catenary_scene(case_row(name), 400))
    stations = np.rint([float(row["s_unstretched_from_anchor_m"]) / length * 400 for row in rows]).astype(int)
    want = np.array([[float(row["x_m"]), 0.0, float(row["z_m"]) - height] for row in rows])
    got = mooring.node_positions("line1")[stations]
    assert np.abs(got - want).max() < 2e-5 * length
    np.testing.assert_allclose(mooring.node_tension("line1")[stations], [float(row["tension_N"]) for row in rows], rtol=1e-3)


def hanging_end_force(span, rise, length, stiffness, w):
    """(H, V) at the upper end of the elastic catenary that touches nothing (Irvine, Cable Structures, 1981)."""

    def misfit(scaled):
        h, v = scaled * w * length
        x = h / w * (np.arcsinh(v / h) - np.arcsinh((v - w * length) / h)) + h * length / stiffness
        z = h / w * (np.hypot(1.0, v / h) - np.hypot(1.0, (v - w * length) / h)) + (v * length - 0.5 * w * length**2) / stiffness
        return np.array([x - span, z - rise]) / length

    solution = fsolve(misfit, [0.5, 0.8], xtol=1e-12)
    assert np.abs(misfit(solution)).max() < 1e-12
    return solution * w * length


@pytest.mark.parametrize(("span", "rise"), [(60.0, 70.0), (80.0, 10.0), (40.0, 30.0)])
def test_hanging_line_converges_with_second_order(span, rise):
    """End force of a line that touches nothing against the closed form: order 2.00 +- 0.05 over N = 25 .. 400, error at 200 below 1e-4."""
    length, stiffness, mass, gravity = 100.0, 2e6, 20.0, 10.0
    h, v = hanging_end_force(span, rise, length, stiffness, mass * gravity)
    counts = np.array([25, 50, 100, 200, 400])
    errors = []
    for n in counts:
        kind = line_type(mass=mass, stiffness=stiffness)
        mooring = settled(anchored(kind, (0, 0, -rise), (span, 0, 0), length, int(n), water_density=0.0, gravity=gravity))
        errors.append(np.linalg.norm(mooring.fairlead_end_force[0] - [-h, 0.0, -v]) / np.hypot(h, v))
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert order == pytest.approx(2.0, abs=0.05)
    assert errors[3] < 1e-4


@pytest.mark.parametrize("name", [row["case"] for row in FRICTIONLESS])
def test_line_with_touchdown_converges_with_second_order(name):
    """Fairlead force against catenary_static.csv. Where the line leaves the bed within a segment the error wobbles with N, so the order is
    that of a fit over 24 meshes, N = 25 .. 400: at least 1.7, and each error below 4/N^2."""
    row = case_row(name)
    want = np.array([-float(row["H_fair_N"]), 0.0, -float(row["V_fair_N"])])
    counts = np.unique(np.geomspace(25, 400, 24).astype(int))
    errors = []
    for n in counts:
        mooring = settled(catenary_scene(row, int(n)))
        errors.append(np.linalg.norm(mooring.fairlead_end_force[0] - want) / np.linalg.norm(want))
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert order >= 1.7
    assert (np.array(errors) * counts**2).max() < 4.0
