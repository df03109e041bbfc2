"""Claim: with prescribed surge and heave, our converged fairlead tensions are MoorDyn's, and the default step is within 1 % of converged.

MoorDyn's converged runs come from benchmarks/data/moordyn_converged.csv; where the package is installed, a run of it checks that the file
is its own.
"""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from benchmarks import moordyn_history, ours
from benchmarks.errors import dynamic_difference
from mooring_ros.scene import load_scene

SCENES = moordyn_history.SCENES
CASES = {name: (file, segments) for name, file, segments in moordyn_history.CASES}


@pytest.fixture(scope="module")
def moordyn():
    return moordyn_history.load()


@pytest.fixture(scope="module", params=CASES)
def case(request):
    """Name, scene, segments, and our converged run."""
    file, segments = CASES[request.param]
    scene = load_scene(SCENES / file)
    dt = moordyn_history.transit_time(scene, segments) / moordyn_history.REFINEMENT
    return request.param, scene, segments, ours.run(scene, moordyn_history.MOTION, 20.0, segments, dt)


def difference(run, times, tension):
    """Worst line's rms difference from the tensions at the times, over their standard deviation."""
    keep = run.times <= times[-1]
    return dynamic_difference(run.times[keep], run.tension[keep], times, tension, times[0]).max()


def test_our_converged_tensions_are_those_of_moordyn_within_half_a_percent_of_their_variation(case, moordyn):
    name, _, _, converged = case
    times, tensions = moordyn
    assert difference(converged, times, tensions[name]) <= 0.005


def test_mean_tensions_are_those_of_moordyn_within_a_tenth_of_a_percent(case, moordyn):
    name, _, _, converged = case
    times, tensions = moordyn
    there = CubicSpline(converged.times, converged.tension)(times)
    np.testing.assert_allclose(there.mean(axis=0), tensions[name].mean(axis=0), rtol=1e-3)


@pytest.mark.parametrize("rate", [10.0, 20.0])
def test_the_default_step_is_within_one_percent_of_converged(case, rate):
    _, scene, segments, converged = case
    run = ours.run(scene, moordyn_history.MOTION, rate, segments)
    measured = converged.times >= moordyn_history.MOTION.start
    assert difference(run, converged.times[measured], converged.tension[measured]) <= 0.01


def test_sample_by_sample_gives_the_bits_of_one_call(case):
    _, scene, segments, _ = case
    short = moordyn_history.SurgeHeave(ramp_periods=0.3, measured_periods=0.1)
    in_one = ours.run(scene, short, 20.0, segments)
    by_step = ours.run(scene, short, 20.0, segments, call="step")
    np.testing.assert_array_equal(in_one.tension, by_step.tension)


def test_the_file_of_moordyns_tensions_is_its_own(moordyn):
    peer = pytest.importorskip("benchmarks.moordyn_peer", reason="MoorDyn is not installed; ./run bench installs it", exc_type=ImportError)
    file, segments = CASES["OC4 3 x 20"]
    run = peer.run(load_scene(SCENES / file), moordyn_history.MOTION, 0.005, "RK2", segments)
    times, tensions = moordyn
    assert difference(run, times, tensions["OC4 3 x 20"]) <= 0.002
