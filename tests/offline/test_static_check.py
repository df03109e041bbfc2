"""`mooring static` and `mooring check`: the keys of the contract, and figures that are those of the façade."""

import io
from pathlib import Path

import numpy as np
import pytest

from mooring_ros.mooring import Mooring, MooringError
from mooring_ros.offline import check
from mooring_ros.offline.arguments import pose
from mooring_ros.offline.console import Preparing
from mooring_ros.offline.mild import MildMotion

POSE = "-3,1,0.5,2,-4,10"
WITH_PARTS = """\
A chain, a cable clamped to a hang-off, and a body on the platform
--- LINE TYPES ---
Name  Diam  Mass/m  EA  BA/-zeta  EI  Cd  Ca  CdAx  CaAx
(-)  (m)  (kg/m)  (N)  (N-s/-)  (N-m2)  (-)  (-)  (-)  (-)
chain  0.05  50  2.0e7  -0.8  0  2.0  0.8  0.4  0.25
cable  0.10  20  5.0e7  -0.5  5e3  1.0  1.0  0.1  0.0
--- ROD TYPES ---
Name  Diam  Mass/m  Cd  Ca  CdEnd  CaEnd
(-)  (m)  (kg/m)  (-)  (-)  (-)  (-)
pipe  0.3  120  0.6  1.0  1.0  1.0
--- BODIES ---
ID  Attachment  X  Y  Z  r  p  y  Mass  CG  I  Volume  CdA  Ca
(-)  (-)  (m)  (m)  (m)  (deg)  (deg)  (deg)  (kg)  (m)  (kg-m2)  (m3)  (m2)  (-)
1  Coupled   -22  0  -6   0  0  0  500   0     1e2  0.2  1  0.5
--- RODS ---
ID  Type  Attachment  Xa  Ya  Za  Xb  Yb  Zb  NumSegs  Outputs
(-)  (-)  (-)  (m)  (m)  (m)  (m)  (m)  (m)  (-)  (-)
1  pipe  Coupled  0  10  -5  0  11.5  -7  2  -
--- POINTS ---
ID  Type  X  Y  Z  Mass  Volume  CdA  Ca
(-)  (-)  (m)  (m)  (m)  (kg)  (m3)  (m2)  (-)
3  Fixed   150  0  -60  0  0  0  0
4  Coupled   20  0   -5  0  0  0  0
5  Fixed   0  110  -60  0  0  0  0
--- LINES ---
ID  LineType  AttachA  AttachB  UnstrLen  NumSegs  Outputs
(-)  (-)  (-)  (-)  (m)  (-)  (-)
2  chain  3  4  145  6  -
3  cable  R1B  5  125  14  -
--- OPTIONS ---
60  WtrDpth
"""


def test_static_json_has_the_keys_of_the_contract_and_no_others(scene, mooring):
    found = mooring("static", scene, "--json").json()
    assert list(found) == ["lines", "wrench", "stiffness", "residual", "iterations"]
    assert [line["name"] for line in found["lines"]] == ["line1", "line2"]
    for line in found["lines"]:
        assert list(line) == ["name", "fairlead_tension", "anchor_tension", "fairlead_end_force", "anchor_end_force"]
        assert len(line["fairlead_end_force"]) == len(line["anchor_end_force"]) == 3
    assert list(found["wrench"]) == ["force", "torque"]
    assert np.shape(found["stiffness"]) == (6, 6)
    assert isinstance(found["iterations"], int) and isinstance(found["residual"], float)


def test_static_json_holds_the_bits_of_the_facade(scene, mooring):
    found = mooring("static", scene, f"--pose={POSE}", "--json").json()
    moored = Mooring(scene)
    moored.settle(pose(POSE))
    assert [line["fairlead_tension"] for line in found["lines"]] == moored.fairlead_tension.tolist()
    assert [line["anchor_end_force"] for line in found["lines"]] == moored.anchor_end_force.tolist()
    assert found["wrench"]["force"] + found["wrench"]["torque"] == moored.wrench.tolist()
    assert found["stiffness"] == moored.stiffness().tolist()


def test_static_shows_where_rods_and_bodies_are_and_what_each_coupled_part_hands_on(mooring, tmp_path):
    (tmp_path / "deck.txt").write_text(WITH_PARTS)
    outcome = mooring("static", tmp_path / "deck.txt", "--pose", "1,0,0,0,0,5", "--json")
    found = outcome.json()
    moored = Mooring(tmp_path / "deck.txt")
    moored.settle(pose("1,0,0,0,0,5"))
    assert [part["name"] for part in found["coupled"]] == moored.coupled_names == ["point4", "rod1", "body1"]
    assert [part["force"] + part["torque"] for part in found["coupled"]] == moored.coupled_wrenches.tolist()
    assert [rod["end_b"] for rod in found["rods"]] == [moored.rod_positions(name)[1].tolist() for name in ("rod1",)]
    assert found["bodies"][0]["position"] + found["bodies"][0]["quaternion"] == moored.body_poses["body1"].tolist()
    text = mooring("static", tmp_path / "deck.txt").out
    for heading in ("Of it, at each coupled point, rod", "Rods: ends A and B (m)", "Bodies: origin (m)"):
        assert heading in text


def test_the_platform_is_pulled_down_and_back(scene, mooring):
    force = mooring("static", scene, "--pose", "-5,0,0,0,0,0", "--json").json()["wrench"]["force"]
    assert force[0] > 0.0 and force[2] < 0.0 and force[1] == pytest.approx(0.0, abs=1e-3 * force[0])


@pytest.mark.parametrize("words", [["--pose", POSE], [f"--pose={POSE}"]])
def test_a_pose_may_begin_with_a_minus(words, scene, mooring):
    assert mooring("static", scene, *words).status == 0


def test_static_text_shows_each_end_of_each_line_and_the_stiffness(scene, mooring):
    text = mooring("static", scene).out
    for word in ("line1  fairlead", "line1    anchor", "line2  fairlead", "Stiffness", "iterations", "rz"):
        assert word in text


def test_statics_that_fail_are_status_1_with_the_reason(scene, mooring, monkeypatch):
    from mooring_ros.mooring import MooringError

    def settle(self, pose, time=0.0):
        raise MooringError("statics: 12.5 N out of balance after 200 iterations")

    monkeypatch.setattr(Mooring, "settle", settle)
    outcome = mooring("static", scene, "--json")
    assert outcome.status == 1 and outcome.out == ""
    assert f"{scene}: statics: 12.5 N out of balance" in outcome.err


def effect(found, name):
    return {effect["name"]: effect["on"] for effect in found["effects"]}[name]


def test_check_says_what_the_scene_contains(scene, mooring):
    found = mooring("check", scene, "--json").json()
    assert found["totals"]["lines"] == 2 and found["totals"]["segments"] == 16
    assert found["totals"]["points"] == {"fixed": 2, "coupled": 2, "free": 0}
    assert found["totals"]["length"] == 584.0
    assert found["totals"]["mass"] == 584.0 * 50.0
    assert found["totals"]["weight_in_water"] == pytest.approx(584.0 * (50.0 - 1025.0 * np.pi / 4 * 0.05**2) * 9.80665)
    assert found["step_limit"]["dt"] > 0.0 and found["step_limit"]["limited_by"]
    assert found["cost"]["real_time_factor"] > 0.0 and found["cost"]["elapsed"] > 0.0
    assert effect(found, "drag") and effect(found, "bed contact") and effect(found, "internal damping")
    assert not effect(found, "current") and not effect(found, "free points") and not effect(found, "free surface")


def test_check_switches_effects_by_what_the_scene_contains(scene, mooring):
    text = scene.read_text().replace("2.0  0.8  0.4  0.25", "0  0  0  0").replace("-0.8", "0").replace("60  WtrDpth", "60  WtrDpth\n0.5  CurrentX")
    text = text.replace("3  Coupled   20  0   -5", "3  Coupled   20  0   1")
    scene.write_text(text)
    found = mooring("check", scene, "--json").json()
    assert not effect(found, "drag") and not effect(found, "added mass") and not effect(found, "internal damping")
    assert effect(found, "current") and effect(found, "free surface")


def test_check_text_says_that_the_cost_was_measured_here(scene, mooring):
    text = mooring("check", scene).out
    assert "measured just now on this machine" in text and "Largest stable step" in text and "limited by" in text


def test_check_hands_on_what_the_reader_warned_of(scene, mooring):
    scene.write_text(scene.read_text() + "0.001  dtM\n")
    warnings = mooring("check", scene, "--json").json()["warnings"]
    assert len(warnings) == 1 and "dtM is not used" in warnings[0]


PAIR = Path(__file__).parents[2] / "config" / "scenes" / "oc4_pair.txt"


def test_static_of_several_platforms_has_a_wrench_for_each_and_the_stiffness_between_them(mooring):
    found = mooring("static", PAIR, "--platforms", "body1,body2", "--pose", "body2=510,0,-1,0,0,5", "--json").json()
    moored = Mooring(PAIR, platforms=["body1", "body2"])
    moored.settle([moored.pose_in_file[0], pose("510,0,-1,0,0,5")])
    assert "wrench" not in found and found["stiffness"] == moored.stiffness().tolist()
    assert [[*row["wrench"]["force"], *row["wrench"]["torque"]] for row in found["platforms"]] == moored.wrench.tolist()
    assert [row["name"] for row in found["platforms"]] == ["body1", "body2"] and found["platforms"][0]["position"] == [-500.0, 0.0, 0.0]
    text = mooring("static", PAIR, "--platforms", "body1,body2").out
    assert "On each platform, about its body's origin" in text and "body2.rz" in text


def test_check_of_several_platforms_names_them_and_times_all_in_motion(mooring):
    found = mooring("check", PAIR, "--platforms", "body1,body2", "--json").json()
    assert found["platforms"] == ["body1", "body2"] and found["cost"]["real_time_factor"] > 0.0
    assert found["step_limit"] == mooring("check", PAIR, "--json").json()["step_limit"]
    assert sum(row["share"] for row in found["cost_shares"]) == pytest.approx(1.0)
    assert "Platforms of their own: body1, body2" in mooring("check", PAIR, "--platforms", "body1,body2").out
    refused = mooring("check", PAIR, "--platforms", "body1")
    assert refused.status == 2 and "body2: coupled, but to none of body1" in refused.err


def test_the_motion_that_a_mooring_is_timed_with_begins_at_rest_and_takes_all_platforms_along():
    moored = Mooring(PAIR, platforms=["body1", "body2"])
    home = moored.pose_in_file
    moored.settle(home, time=3.0)
    motion = MildMotion(moored, heave=0.5)
    (times, poses, twists), (later, _, _) = motion.next(300), motion.next(2)
    assert times[0] == 3.0 + motion.sample and later[0] == pytest.approx(times[-1] + motion.sample)
    moved = poses - home
    assert (moved[:, 0] == moved[:, 1]).all() and np.ptp(moved[:, 0, 0]) > 1.0 and not moved[:, :, [1, *range(3, 7)]].any()
    np.testing.assert_allclose(moved[:, :, 2], 0.5 * moved[:, :, 0], atol=1e-12)
    np.testing.assert_allclose(np.gradient(poses[:, 0, 0], times)[1:-1], twists[1:-1, 0, 0], atol=1e-4)
    assert np.abs(twists[0]).max() < 0.01 and np.abs(moved[0]).max() < 1e-3


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--platforms", "body1,hull"), "no coupled body 'hull'"),
        (("--platforms", "body1,body2", "--pose", "0,0,0,0,0,0"), "a pose without a name, expected NAME=… of body1,body2"),
        (("--pose", "body1=0,0,0,0,0,0"), "body1, expected X,Y,Z,ROLL,PITCH,YAW without a name, or --platforms"),
    ],
)
def test_poses_and_names_that_do_not_go_together_are_bad_usage(mooring, words, said):
    outcome = mooring("static", PAIR, *words)
    assert outcome.status == 2 and said in outcome.err


def test_static_says_what_the_scene_warns_of(scene, mooring):
    scene.write_text(scene.read_text().replace("-300  0  -60", "-300  0  -61").replace("60  WtrDpth", "60  WtrDpth\n0.01  dtM"))
    found = mooring("static", scene, "--json")
    assert found.status == 0 and found.json()["lines"]
    assert "point 2 at z = -61 m is below the bed" in found.err and f"{scene}:20: the option dtM is not used" in found.err


def test_a_scene_without_anything_coupled_is_warned_of(scene, mooring):
    scene.write_text(scene.read_text().replace("Coupled", "Fixed"))
    assert "nothing is coupled" in mooring("static", scene).err


def test_check_shows_what_is_in_a_scene_that_cannot_be_computed(scene, mooring, monkeypatch):
    def fails(*_):
        raise MooringError("the step to t = 1 s fails")

    monkeypatch.setattr(check, "measured_cost", fails)
    found = mooring("check", scene)
    assert found.status == 1 and "the step to t = 1 s fails" in found.err
    assert "2 lines, 16 segments" in found.out and "Effects" not in found.out
    found = mooring("check", scene, "--json")
    assert found.status == 1 and found.out == ""


@pytest.mark.parametrize("terminal", [True, False])
def test_a_terminal_is_told_that_work_has_begun(terminal):
    stream = io.StringIO()
    stream.isatty = lambda: terminal
    with Preparing("static", stream):
        assert stream.getvalue().startswith("static: preparing") == terminal
    assert stream.getvalue().endswith("\x1b[K") == terminal


@pytest.mark.parametrize("pose, words", [("800,0,0,0,0,0", "line2 is stretched to"), ("0,0,-90,0,0,0", "line1 is up to 35 m in the ground"), (POSE, "")])
def test_a_pose_that_no_mooring_has_is_said(scene, mooring, pose, words):
    found = mooring("static", scene, f"--pose={pose}")
    assert found.status == 0 and words in found.err and bool(found.err) == bool(words)
