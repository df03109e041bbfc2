"""The scenes of the seeds at rest: a semi-taut line of two parts in closed form, and ISWEC's moorings beside MoorPy."""

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import fsolve

from mooring_ros import Mooring
from mooring_ros.scene import load_scene

SCENES = Path(__file__).parents[2] / "config" / "scenes"
REST = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]


def submerged_weight(kind, env):
    return (kind.mass - env.water_density * 0.25 * np.pi * kind.diameter**2) * env.gravity


def hanging(horizontal, vertical, weight, length, stiffness):
    """Span and height of an elastic catenary that pulls with these forces at its upper end."""
    below = vertical - weight * length
    span = horizontal / weight * (np.arcsinh(vertical / horizontal) - np.arcsinh(below / horizontal)) + horizontal * length / stiffness
    height = horizontal / weight * (np.hypot(1.0, vertical / horizontal) - np.hypot(1.0, below / horizontal))
    return span, height + (vertical - 0.5 * weight * length) * length / stiffness


def test_semi_taut_line_of_chain_and_polyester():
    """Fairlead force within 0.5 % of two elastic catenaries in series, the chain's lower part on the bed."""
    scene = load_scene(SCENES / "volturnus_s_semi_taut.txt")
    chain, rope = scene.lines[0], scene.lines[1]
    weight_chain, weight_rope = (submerged_weight(line.type, scene.environment) for line in (chain, rope))
    anchor, fairlead = (np.array(scene.point(id).position) for id in (chain.end_a, rope.end_b))

    def mismatch(logs):
        horizontal, vertical = np.exp(logs)
        span, height = hanging(horizontal, vertical, weight_rope, rope.length, rope.type.stiffness)
        carried = (vertical - weight_rope * rope.length) / weight_chain
        more, higher = hanging(horizontal, carried * weight_chain, weight_chain, carried, chain.type.stiffness)
        lying = (chain.length - carried) * (1.0 + horizontal / chain.type.stiffness)
        return span + more + lying - np.hypot(*(anchor - fairlead)[:2]), height + higher - (fairlead - anchor)[2]

    horizontal, vertical = np.exp(fsolve(mismatch, np.log([1e5, 1.7e5]), xtol=1e-12))
    mooring = Mooring(scene)
    mooring.settle(REST)
    force = mooring.fairlead_end_force[1]
    assert -force[0] == pytest.approx(horizontal, rel=1e-2)  # the touchdown falls between two nodes
    assert -force[2] == pytest.approx(vertical, rel=2e-3)
    assert np.linalg.norm(force) == pytest.approx(np.hypot(horizontal, vertical), rel=5e-3)
    assert np.abs(mooring.wrench[:2]).max() < 1e-3 * horizontal


def moorpy_force(scene, surge):
    """(3,) force of the moorings on the platform by MoorPy's catenaries, N."""
    moorpy = pytest.importorskip("moorpy")
    env = scene.environment
    system = moorpy.System(depth=env.depth, rho=env.water_density, g=env.gravity)
    for kind in scene.line_types:
        shape = {"name": kind.name, "d_vol": kind.diameter, "m": kind.mass, "EA": kind.stiffness, "w": submerged_weight(kind, env)}
        system.lineTypes[kind.name] = shape | {"material": "chain", "MBL": 1e9, "cost": 0, "EAd": 0, "EAd_Lm": 0}
    for point in scene.points:
        moved = np.array(point.position) + [surge if point.kind == "coupled" else 0.0, 0.0, 0.0]
        system.addPoint(0 if point.kind == "free" else 1, moved, m=point.mass, v=point.volume)
    for line in scene.lines:
        system.addLine(line.length, line.type.name, pointA=line.end_a, pointB=line.end_b)
    system.initialize()
    system.solveEquilibrium(tol=1e-5, maxIter=2000)
    return sum(system.pointList[point.id - 1].getForces() for point in scene.points if point.kind == "coupled")


@pytest.mark.parametrize(("name", "surge"), [("c2a", -10.0), ("c1", -10.0)])
def test_iswec_mooring_pulls_as_in_moorpy(name, surge):
    """Ten metres off: horizontal force within 0.5 %, vertical within 1 %; jumpers, clump weights, swivel and bridles all take part."""
    scene = load_scene(SCENES / f"iswec_{name}.txt")
    mooring = Mooring(scene)
    mooring.settle([surge, *REST[1:]])
    force = moorpy_force(scene, surge)
    assert mooring.wrench[0] == pytest.approx(force[0], rel=5e-3)
    assert mooring.wrench[2] == pytest.approx(force[2], rel=1e-2)
