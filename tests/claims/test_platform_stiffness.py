"""The 6 x 6 stiffness of whole systems against the closed form, and against finite differences of settled wrenches."""

import dataclasses

import numpy as np
import pytest
from scenes_in_code import HERE, SCENES, difference, line_type, same_bits, scene, table, times_quaternion, turn

from mooring_ros import Mooring
from mooring_ros.scene import load_scene

CASES = {"OC3_Hywind": "oc3_spar.txt", "OC4_DeepCwind_rtest_L835.35": "oc4.txt", "VolturnUS_S": "volturnus_s_chain.txt"}
TILTED = np.concatenate([[6.0, -4.0, 1.5], times_quaternion(turn([0, 0, 1], 0.2), turn([1, 2, 0], 0.1))])


def closed_form(case):
    rows = sorted((row for row in table("system_stiffness_6x6.csv") if row["case"] == case), key=lambda row: int(row["row"]))
    return np.array([[float(row[f"K_i{k}"]) for k in range(1, 7)] for row in rows]), np.array([float(row["F0_i"]) for row in rows])


def symmetric(scene):
    """The scene with the files' rounding of anchor and fairlead positions to millimetres taken back: radius and heading kept exact."""
    points = []
    for point in scene.points:
        x, y, z = point.position
        radius = max(abs(other.position[0]) for other in scene.points if other.kind == point.kind)
        heading = np.round(np.arctan2(y, x) / (np.pi / 3.0)) * np.pi / 3.0
        points.append(dataclasses.replace(point, position=(radius * np.cos(heading), radius * np.sin(heading), z)))
    return dataclasses.replace(scene, points=tuple(points))


@pytest.mark.parametrize("segments", [800, 1000, 1500])
@pytest.mark.parametrize("case", CASES)
def test_stiffness_and_force_at_rest_are_those_of_the_catenaries(case, segments):
    """system_stiffness_6x6.csv at 800 segments and more (the error wobbles, as the line leaves the bed within a segment): each non-zero entry and the vertical force within 1 %, zeros within 1e-5 of their neighbours.

    The table stands on a rigid bed; the scenes' bed gives way by some millimetres. Scenes with exact symmetry, so that zeros are zeros.
    """
    mooring = Mooring(symmetric(load_scene(SCENES / CASES[case])), segments=segments)
    mooring.settle(HERE)
    want, force = closed_form(case)
    got = mooring.stiffness()
    size = np.sqrt(np.outer(np.diag(want), np.diag(want)))
    nonzero = np.abs(want) > 1e-9 * size
    np.testing.assert_allclose(got[nonzero], want[nonzero], rtol=0.01)
    assert (np.abs(got - want)[~nonzero] / size[~nonzero]).max() < 1e-5
    assert mooring.wrench[2] == pytest.approx(force[2], rel=0.01)
    np.testing.assert_allclose(mooring.wrench[[0, 1]], 0.0, atol=1e-6 * abs(force[2]))
    np.testing.assert_allclose(mooring.wrench[3:], 0.0, atol=1e-5 * abs(force[2]))


@pytest.mark.parametrize("pose", [HERE, TILTED], ids=["at rest", "moved and turned"])
@pytest.mark.parametrize("file", CASES.values())
def test_stiffness_is_the_derivative_of_the_settled_wrench(file, pose):
    """Fourth-order differences of the wrench after settle, 1e-6 of the matrix's scale; steps so small that no node changes contact."""
    mooring = Mooring(SCENES / file, segments=50)
    want = difference(mooring, pose, [2e-4] * 3 + [4e-6] * 3)
    mooring.settle(pose)
    got = mooring.stiffness()
    scale = np.sqrt(np.outer(np.abs(np.diag(want)), np.abs(np.diag(want))))
    assert (np.abs(got - want) / scale).max() < 1e-6


def test_stiffness_with_free_points_is_the_derivative_too():
    """A bridle: two legs from the platform to a free ring with a clump weight, one line to the anchor; 1e-6 as above, moved and turned."""
    kind = line_type(0.08, 20.0, 5e7)
    points = [("fixed", (-400, 0, -100)), ("free", (-60, 5, -30), 2000.0, 0.3), ("coupled", (-20, 10, -5)), ("coupled", (-20, -10, -5))]
    points += [("fixed", (300, 50, -100)), ("coupled", (20, 0, -5))]
    lines = [(kind, 1, 2, 360.0, 30), (kind, 2, 3, 48.0, 6), (kind, 2, 4, 48.0, 6), (kind, 5, 6, 310.0, 30)]
    mooring = Mooring(scene(points, lines, depth=100.0))
    pose = np.concatenate([[1.0, -2.0, 0.5], turn([1, 1, 3], 0.1)])
    want = difference(mooring, pose, [2e-4] * 3 + [4e-6] * 3)
    mooring.settle(pose)
    scale = np.sqrt(np.outer(np.abs(np.diag(want)), np.abs(np.diag(want))))
    assert (np.abs(mooring.stiffness() - want) / scale).max() < 1e-6


def test_asking_for_the_stiffness_changes_nothing():
    mooring = Mooring(SCENES / "oc4.txt")
    mooring.settle(HERE)
    mooring.step(0.1, HERE, np.array([0.1, 0.0, 0.0, 0.0, 0.0, 0.0]))
    before = mooring.snapshot()
    mooring.stiffness()
    assert same_bits(before, mooring.snapshot())
