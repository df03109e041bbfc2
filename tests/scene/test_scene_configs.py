"""The scenes that come with the package are the published systems."""

import math
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import fsolve
from scipy.spatial.transform import Rotation

from mooring_ros.scene import load_scene

FOLDER = Path(__file__).parents[2] / "config" / "scenes"
SCENES = sorted(FOLDER.glob("*.txt"))


def submerged_weight(scene):
    kind = scene.line_types[0]
    return (kind.mass - scene.environment.water_density * math.pi * kind.diameter**2 / 4) * scene.environment.gravity


def fairlead_force(scene, line, fairlead):
    """Elastic catenary with a part on a frictionless bed, closed form: force (3,) of the line on its fairlead at ``fairlead``."""
    anchor = np.array(scene.point(line.end_a).position)
    across = anchor[:2] - fairlead[:2]
    span, height = np.hypot(*across), fairlead[2] - anchor[2]
    weight, stiffness = submerged_weight(scene), line.type.stiffness

    def mismatch(forces):
        horizontal, vertical = np.exp(forces)
        return (
            line.length - vertical / weight + horizontal / weight * math.asinh(vertical / horizontal) + horizontal * line.length / stiffness - span,
            horizontal / weight * (math.hypot(1, vertical / horizontal) - 1) + vertical**2 / (2 * stiffness * weight) - height,
        )

    horizontal, vertical = np.exp(fsolve(mismatch, np.log([0.7 * weight * line.length, 0.5 * weight * line.length]), xtol=1e-13))
    assert vertical < weight * line.length  # some of the line lies on the bed
    return np.array([*(horizontal * across / span), -vertical])


def wrench(scene, offset):
    """(6,) of all lines on the platform about its moved origin; ``offset`` is (6,): m, and small rotations about the world axes."""
    rotation = Rotation.from_rotvec(offset[3:])
    total = np.zeros(6)
    for line in scene.lines:
        arm = rotation.apply(scene.point(line.end_b).position)
        force = fairlead_force(scene, line, arm + offset[:3])
        total += [*force, *np.cross(arm, force)]
    return total


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_a_scene_loads_without_a_warning(path):
    scene = load_scene(path)
    assert scene.warnings == ()
    if len(scene.points) == 2 * len(scene.lines) and not scene.bodies:  # every line runs from its own anchor to its own fairlead
        assert {scene.point(line.end_a).kind for line in scene.lines} == {"fixed"}
        assert {scene.point(line.end_b).kind for line in scene.lines} == {"coupled"}


def test_the_list_of_scenes_is_complete():
    assert set(re.findall(r"(?m)^\| `(\S+)`", (FOLDER / "README.md").read_text(encoding="utf-8"))) == {path.name for path in SCENES}


# Submerged weight (N/m) and static tension at the fairlead (N): published, or closed form of the published figures.
@pytest.mark.parametrize(
    "name, weight, tension",
    [
        ("oc3_spar", 698.0945, 911088.4),
        ("oc4", 1065.26128, 1105373.14),
        ("volturnus_s_chain", 5842.12230, 2435559.7),
        ("chalmers_33m", 0.699, 22.6715),
    ],
)
def test_weight_and_pretension_are_the_published_ones(name, weight, tension):
    scene = load_scene(FOLDER / f"{name}.txt")
    assert submerged_weight(scene) == pytest.approx(weight, rel=1e-6)
    for line in scene.lines:
        force = fairlead_force(scene, line, np.array(scene.point(line.end_b).position))
        assert np.linalg.norm(force) == pytest.approx(tension, rel=1e-4)


# NREL/TP-500-47535 eq. 5-3; the closed form of NREL/TP-5000-60601 and of IEA-15-240-RWT with the lengths in the files.
@pytest.mark.parametrize(
    "name, vertical, surge, heave, roll, yaw, surge_pitch, accuracy",
    [
        ("oc3_spar", -1.607e6, 41180.0, 11940.0, 311.1e6, 11.56e6, -2.8185e6, 2e-3),
        ("oc4", -1893320.2, 70836.05, 19140.47, 87240750.0, 116970167.0, -107232.0, 2e-4),
        ("volturnus_s_chain", -6082426.2, 71891.38, 60742.61, 258591174.0, 252292414.0, 1144725.2, 2e-4),
    ],
)
def test_platform_stiffness_is_the_published_one(name, vertical, surge, heave, roll, yaw, surge_pitch, accuracy):
    scene = load_scene(FOLDER / f"{name}.txt")
    step = np.array([0.05] * 3 + [5e-4] * 3)
    stiffness = np.column_stack([(wrench(scene, -d) - wrench(scene, d)) / (2 * d.sum()) for d in np.diag(step)])
    assert wrench(scene, np.zeros(6))[2] == pytest.approx(vertical, rel=accuracy)
    expected = np.diag([surge, surge, heave, roll, roll, yaw])
    expected[0, 4] = expected[4, 0] = surge_pitch
    expected[1, 3] = expected[3, 1] = -surge_pitch
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    present = expected != 0
    assert stiffness[present] == pytest.approx(expected[present], rel=accuracy)
    assert np.abs(stiffness / scale)[~present].max() < 1e-4


def test_forces_of_the_water_on_the_laboratory_chain_are_those_of_its_published_diameter():
    scene = load_scene(FOLDER / "chalmers_33m.txt")
    chain, published = scene.line_types[0], 2.2e-3
    assert chain.drag_normal * chain.diameter == pytest.approx(2.5 * published, rel=1e-3)
    assert chain.drag_axial * math.pi * chain.diameter == pytest.approx(0.5 * published, rel=1e-3)
    assert chain.added_mass_normal * chain.diameter**2 == pytest.approx((3.8 - 1) * published**2, rel=1e-3)
    assert scene.environment.bed_stiffness * chain.diameter == pytest.approx(3e9 * published, rel=1e-3)
    submerged_mass = chain.mass + scene.environment.water_density * chain.added_mass_normal * math.pi * chain.diameter**2 / 4
    critical = 2 * math.sqrt(scene.environment.bed_stiffness * submerged_mass / chain.diameter)
    assert scene.environment.bed_damping == pytest.approx(critical, rel=1e-3)


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_a_scene_is_read_by_moordyn_itself(path, tmp_path, monkeypatch):
    moordyn = pytest.importorskip("moordyn")
    scene = load_scene(path)
    shutil.copytree(FOLDER, tmp_path, dirs_exist_ok=True)  # it writes its files beside the scene
    monkeypatch.chdir(tmp_path)  # from where it looks for the files that a scene names
    system = moordyn.Create(str(tmp_path / path.name))
    try:
        assert moordyn.GetNumberLines(system) == len(scene.lines)
        for line in scene.lines:
            other = moordyn.GetLine(system, line.id)
            assert moordyn.GetLineUnstretchedLength(other) == line.length
            assert moordyn.GetLineN(other) == line.segments
        freedoms = 3 * sum(point.kind == "coupled" for point in scene.points) + 6 * sum(part.kind == "coupled" for part in (*scene.rods, *scene.bodies))
        assert moordyn.NCoupledDOF(system) == freedoms
    finally:
        moordyn.Close(system)
