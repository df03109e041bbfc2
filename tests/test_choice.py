"""`solver="auto"`: which solver a scene gets, and the reason that is given."""

from dataclasses import replace

import numpy as np
import pytest
from scenes_in_code import HERE, SCENES

from mooring_ros import Mooring
from mooring_ros.choice import choose_solver
from mooring_ros.core.schemes import LEAPFROG, step_table


@pytest.mark.parametrize("file", ["oc4", "rm3_cable", "lazy_wave", "volturnus_s_axial_friction"])
def test_chains_and_cables_go_explicitly(file):
    mooring = Mooring(SCENES / f"{file}.txt")
    assert mooring.solver == "explicit"
    assert mooring.choice.startswith("explicit: ") and "evaluations of the forces" in mooring.choice


def test_where_explicit_steps_cost_five_times_as_much_it_goes_implicitly():
    """An OC4 whose explicit steps are said to be 0.1 ms long; not so with friction on the bed."""
    for file, solver in (("oc4", "implicit"), ("volturnus_s_axial_friction", "explicit")):
        mooring = Mooring(SCENES / f"{file}.txt")
        limit = replace(mooring.step_limit, dt=1e-4)
        chosen, why = choose_solver(mooring.scene, mooring._model, limit, step_table({LEAPFROG: 1.0}, 1e-4), None)
        assert chosen == solver
        assert "10000 evaluations" in why


def test_a_given_solver_is_taken():
    assert Mooring(SCENES / "oc4.txt", solver="implicit").choice == "implicit, as asked for"
    assert Mooring(SCENES / "oc4.txt", solver="explicit").solver == "explicit"


def test_both_solvers_agree():
    """OC4 in calm motion: tensions of the solvers rms within 5 % of the largest deviation."""
    times = np.arange(1, 301) * 0.1
    poses, twists = np.tile(HERE, (300, 1)), np.zeros((300, 6))
    poses[:, 0], twists[:, 0] = 1.0 - np.cos(0.5 * times), 0.5 * np.sin(0.5 * times)
    runs = []
    for solver in ("auto", "implicit"):
        mooring = Mooring(SCENES / "oc4.txt", solver=solver)
        mooring.settle(HERE)
        runs.append(mooring.run(times, poses, twists).fairlead_tension[50:])
    assert np.sqrt(np.mean((runs[0] - runs[1]) ** 2)) < 0.05 * runs[0].std(axis=0).max()
