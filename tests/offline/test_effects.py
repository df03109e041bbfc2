"""What `mooring check` says of a scene, by the scene's description alone: every effect that a file switches on is listed as on."""

import json

import numpy as np
import pytest

from mooring_ros.offline.contents import contents, contents_text
from mooring_ros.offline.effects import effects
from mooring_ros.scene import parse_scene

GRID = "2 2\n-400 400\n-400 400\n-400 -400 -50\n-400 400 -50\n400 -400 -70\n400 400 -70\n"
CURVE = "Rope\nStrain Tension\n(-) (N)\n0 0\n0.1 1e5\n0.2 3e5\n"
PROFILE = "Current\nz ux uy uz\n(m) (m/s) (m/s) (m/s)\n-60 0.1 0 0\n0 0.9 0 0\n"
EVERYTHING = """\
--- LINE TYPES ---
Name  Diam  Mass/m  EA  BA/-zeta  EI  Cd  Ca  CdAx  CaAx
chain  0.05  50  2.0e7  -0.8  0  2.0  0.8  0.4  0.25
cable  0.20  40  5.0e8  1e5  1.2e4  1.0  1.0  0.0  0.0
rope  0.10  8  2e6|1e7  1e9|1e6  0  1.2  1.0  0.0  0.0
tail  0.10  8  curve.txt  -0.1  0  1.2  1.0  0.0  0.0
--- ROD TYPES ---
Name  Diam  Mass/m  Cd  Ca  CdEnd  CaEnd
pipe  0.3  120  0.6  1.0  1.0  1.0
--- BODIES ---
ID  Attachment  X  Y  Z  r  p  y  Mass  CG  I  Volume  CdA  Ca
1  Free  100  0  -20  0  0  0  2e4  0  1e4  30  5  0.5
--- RODS ---
ID  Type  Attachment  Xa  Ya  Za  Xb  Yb  Zb  NumSegs  Outputs
1  pipe  Coupled  20  0  -5  21  0  -7  2  -
2  pipe  Body1  0  0  1  0  0  3  2  -
--- POINTS ---
ID  Type  X  Y  Z  Mass  Volume  CdA  Ca
1  Fixed    300  0  -67.5  0  0  0  0
2  Body1   0  0  -1  0  0  0  0
3  Coupled   -20  0   -5  0  0  0  0
4  Free  -150  0  -40  500  0.1  1  0.5
5  Fixed    -300  0  -52.5  0  0  0  0
--- LINES ---
ID  LineType  AttachA  AttachB  UnstrLen  NumSegs  Outputs
1  chain  1  2  220  8  -
2  cable  R1B  R2A  90  8  -
3  rope  5  4  160  8  -
4  tail  4  3  140  8  -
--- FAILURE ---
ID  Point  Lines  Time  Tension
1  4  3,4  60  0
2  R2A  2  0  2e6
--- OPTIONS ---
depths.txt  WtrDpth
0.9  mu_kT
0.7  mu_kA
1.3  mc
stick FrictionModel
jonswap WaveModel
6  WaveHeight
11 WavePeriod
30 WaveDirection
7 WaveSeed
60 WaveRamp
1  Currents
"""
FILES = (("depths.txt", GRID), ("curve.txt", CURVE), ("current_profile.txt", PROFILE))


class Lying:
    """Stands in for a settled mooring: each line has one node on the bed and one at the surface."""

    def __init__(self, scene):
        self.line_names = [line.name for line in scene.lines]

    def node_positions(self, _):
        return np.array([[0.0, 0.0, -60.0], [0.0, 0.0, -1.0]])


def found(text, files=FILES):
    scene = parse_scene(text, "scene.txt", files)
    return scene, {effect["name"]: (effect["on"], effect["why"]) for effect in effects(scene, Lying(scene))}


@pytest.mark.parametrize("name, says", [
    ("axial elasticity", "EA = 2e+07 to 5e+08 N"),
    ("load-strain curves", "tail (3 points)"),
    ("viscoelastic ropes", "rope (EA 2e+06 N when slow, 1e+07 N when quick)"),
    ("bending stiffness", "EI = 1.2e+04 N m² in 1 of 4 lines, curvature by the turning angle; 2 of their 2 ends at rods"),
    ("added mass", "; and of point4, body1, rod1, rod2"),
    ("drag", "; and of point4, body1, rod1, rod2"),
    ("current", "a profile of 2 rows from z = -60 to 0 m, up to 0.9 m/s"),
    ("waves on the lines", "jonswap, Hs = 6 m, Tp = 11 s, gamma = 3.3, 100 components, seed 7, running 30° from x towards y, growing over 60 s"),
    ("bed contact", "at the zero pose 4 of 8 nodes lie on it"),
    ("bathymetry", "depth 50 to 70 m on a grid of 2 × 2, x -400 to 400 m, y -400 to 400 m; under the lines at the zero pose 60 to 60 m"),
    ("bed friction", "law stick, kinetic 0.7 along and 0.9 across the line, static 0.91 and 1.17; statics as laid from the anchors"),
    ("free surface", "the waves' surface"),
    ("free points", "point4 (500 kg, 0.1 m³)"),
    ("rods", "rod1 (coupled, 2.23607 m), rod2 (on body1, 2 m)"),
    ("bodies", "body1 (free, 20000 kg, 30 m³)"),
    ("line failures", "line3, line4 part from point4 at 60 s; line2 part from rod2A beyond 2e+06 N"),
])
def test_each_effect_of_a_scene_with_all_of_them_is_on_and_says_why(name, says):
    on, why = found(EVERYTHING)[1][name]
    assert on and says in why, why


@pytest.mark.parametrize("option, effect, says", [
    ("regular WaveModel\n2 WaveHeight\n8 WavePeriod\n45 WavePhase", "waves on the lines", "regular, H = 2 m, T = 8 s, phase 45°, running 0°"),
    ("0.6 FrictionCoefficient\n2 StatDynFricScale", "bed friction", "law saturated, kinetic 0.6, static 1.2 in every direction, ramp 100 N s/m; by the speed, so none in the statics"),
    ("0.1 BedSlopeX\n-0.05 BedSlopeY", "bathymetry", "depth 60 m at the origin, the bed rises by 0.1 along x and -0.05 along y"),
    ("0.3 CurrentX\n0.4 CurrentY", "current", "0.5 m/s"),
])
def test_options_of_a_plain_scene(option, effect, says):
    from conftest import SCENE

    plain = SCENE.replace("-60  0  0  0  0", "-80  0  0  0  0") if "Slope" in option else SCENE
    assert found(SCENE, ())[1][effect][0] is False
    on, why = found(plain + option + "\n", ())[1][effect]
    assert on and says in why, why


def test_contents_count_and_weigh_rods_bodies_and_points_on_them():
    scene, _ = found(EVERYTHING)
    listed = contents(scene)
    json.dumps(listed, allow_nan=False)
    assert [line["ends"] for line in listed["lines"]] == [["point1", "point2"], ["rod1B", "rod2A"], ["point5", "point4"], ["point4", "point3"]]
    assert listed["totals"]["points"] == {"fixed": 2, "coupled": 1, "free": 1, "body": 1}
    assert listed["totals"]["rods"] == {"coupled": 1, "body": 1} and listed["totals"]["bodies"] == {"free": 1}
    rods = 120.0 * (np.hypot(1.0, 2.0) + 2.0)
    assert listed["totals"]["mass"] == pytest.approx(220 * 50 + 90 * 40 + 300 * 8 + 500 + 2e4 + rods)
    assert listed["bodies"][0]["weight_in_water"] == pytest.approx((2e4 - 1025 * 30) * 9.80665)
    assert listed["failures"][1] == {"name": "failure2", "at": "rod2A", "lines": ["line2"], "time": None, "tension": 2e6}
    assert listed["files"] == ["curve.txt", "depths.txt", "current_profile.txt"]


def test_the_text_names_rods_bodies_and_the_files_that_were_read():
    scene, _ = found(EVERYTHING)
    text = "\n".join(contents_text({"scene": "scene.txt", **contents(scene)}))
    assert "points: 2 fixed, 1 coupled, 1 free, 1 on bodies; rods: 1 coupled, 1 on bodies; bodies: 1 free; depth 50 to 70 m" in text
    assert "rod1B – rod2A" in text and "on body1" in text and "Read from curve.txt, depths.txt, current_profile.txt as well" in text
