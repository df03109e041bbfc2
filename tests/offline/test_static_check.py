"""`mooring static` and `mooring check`: the keys of the contract, and figures that are those of the façade."""

import numpy as np
import pytest

from mooring_ros.mooring import Mooring
from mooring_ros.offline.arguments import pose

POSE = "-3,1,0.5,2,-4,10"


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
