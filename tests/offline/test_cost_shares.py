"""`mooring check` says what each effect costs: all of the cost is told once, and effects that a scene does not have cost nothing."""

from pathlib import Path

import numpy as np
import pytest

from mooring_ros import Mooring
from mooring_ros.offline.effects import effects, with_shares
from mooring_ros.offline.shares import cost_shares

SCENES = Path(__file__).parents[2] / "config" / "scenes"
HERE = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


@pytest.fixture(scope="module", params=["oc4", "rm3_cable", "volturnus_s_semi_taut_friction"])
def found(request):
    mooring = Mooring(SCENES / f"{request.param}.txt")
    mooring.settle(HERE)
    before = mooring.snapshot()
    switched, passes = with_shares(effects(mooring.scene, mooring), cost_shares(mooring))
    assert all(mine.tobytes() == kept.tobytes() for mine, kept in zip(mooring._state, before.state)), "measuring has moved the mooring"
    return mooring, {effect["name"]: effect for effect in switched}, passes


def test_the_shares_add_up_to_the_whole_step(found):
    _, _, passes = found
    assert sum(row["share"] for row in passes) == pytest.approx(1.0)
    assert all(row["share"] >= 0.0 for row in passes)
    assert all(row["effects"] or row["what"] for row in passes)


def test_what_is_off_has_no_share_and_what_is_on_has_that_of_its_pass(found):
    _, switched, passes = found
    of = {name: row for row in passes for name in row["effects"]}
    for name, effect in switched.items():
        assert (effect["share"] is None) == (not effect["on"])
        if name in of:
            assert effect["share"] == of[name]["share"] and effect["share_with"] == of[name]["effects"]
    assert {name for name in of} <= {name for name, effect in switched.items() if effect["on"]}


def test_what_a_scene_has_costs_something(found):
    mooring, switched, _ = found
    costly = ["axial elasticity", "drag", "bed contact"]
    costly += ["bending stiffness"] if mooring._model.bending.stiffness.size else []
    costly += ["waves on the lines"] if mooring.scene.environment.waves else []
    costly += ["bed friction"] if mooring.scene.environment.friction else []
    assert all(switched[name]["share"] > 0.001 for name in costly)
    assert np.sum([switched[name]["share"] for name in costly]) < 1.0
