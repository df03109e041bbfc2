"""Bending through the façade: the cantilevers of Hall, Srinivas and Yu (2020), static and let go."""

from dataclasses import replace

import numpy as np
import pytest
from scenes_in_code import HERE, SCENES, STILL, refresh, table
from scipy.optimize import brentq

from mooring_ros import Mooring
from mooring_ros.scene import load_scene

ROWS = [row for row in table("hall2020_cantilever.csv") if row["g"] == "9.80665"]


def cantilever(length, **tip):
    scene = load_scene(SCENES / f"cantilever_{length}m.txt")
    return replace(scene, points=(replace(scene.points[0], **tip),))


def tip(mooring):
    """Deflection and shortening, m."""
    first, *_, last = mooring.node_positions("line1")
    return first[2] - last[2], mooring.scene.lines[0].length - last[0]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['L_m']}m-{row['end_mass_kg']}kg")
def test_cantilevers_of_the_seed_deflect_as_the_exact_elastica(row):
    """Within 0.5 % at 8 segments and 0.05 % at 40."""
    scene = cantilever(int(row["L_m"]), mass=float(row["end_mass_kg"]))
    for segments, bound in ((8, 0.005), (40, 0.0005)):
        mooring = Mooring(scene, segments=segments)
        mooring.settle(HERE)
        assert tip(mooring)[0] == pytest.approx(float(row["w_tip_exact_m"]), rel=bound)


def test_tip_converges_with_second_order():
    row = next(row for row in ROWS if row["L_m"] == "20" and row["end_mass_kg"] == "1000")
    scene = cantilever(20, mass=1000.0)
    exact = float(row["w_tip_exact_m"]), float(row["u_shortening_exact_m"])
    errors = []
    for segments in (4, 8, 16):
        mooring = Mooring(scene, segments=segments)
        mooring.settle(HERE)
        errors.append(np.abs(np.subtract(tip(mooring), exact)).max())
    assert errors[0] > 3.5 * errors[1] > 3.5**2 * errors[2]


def test_the_clamp_takes_the_moment_of_the_load():
    """Reaction of the platform that carries the clamp: P times the tip's distance, about the clamp."""
    scene = cantilever(10, mass=1000.0)
    scene = replace(scene, rods=(replace(scene.rods[0], kind="coupled"),))
    mooring = Mooring(scene, segments=20)
    mooring.settle(HERE)
    load = 1000.0 * scene.environment.gravity
    reach = mooring.node_positions("line1")[-1, 0]
    force, moment = mooring.wrench[:3], mooring.wrench[3:]
    assert force[2] == pytest.approx(-load, rel=1e-3)
    about_clamp = moment - np.cross([0.0, 0.0, -30.0], force)
    assert about_clamp[1] == pytest.approx(load * reach, rel=1e-3)


def first_frequency(length, rigidity, mass_per_length, end_mass):
    """rad/s of the first mode of a cantilever with a mass at its end."""
    alpha = end_mass / (mass_per_length * length)
    beta = brentq(lambda b: 1 + np.cos(b) * np.cosh(b) + alpha * b * (np.cos(b) * np.sinh(b) - np.sin(b) * np.cosh(b)), 0.1, 1.8751)
    return beta**2 * np.sqrt(rigidity / (mass_per_length * length**4))


def test_a_cantilever_swings_with_the_frequency_of_the_beam():
    """Small swings about a sag of 17 mm, without drag, at 8 segments: 1 %, a lumped beam's 0.6 % and more."""
    volume = (1000.0 - 100.0 / 9.80665) / 1024.68853
    scene = cantilever(10, mass=1000.0, volume=volume)
    kind = replace(scene.line_types[0], drag_normal=0.0)
    scene = replace(scene, line_types=(kind,), lines=(replace(scene.lines[0], type=kind),))
    mooring = Mooring(scene, segments=8)
    mooring.settle(HERE)
    rest = mooring.node_positions("line1")[-1, 2]
    moving = mooring._model.size
    mooring._state.velocity[2, :moving] = 1e-3 * np.clip(mooring._state.position[0, :moving] / 10.0, 0.0, 1.0) ** 2
    refresh(mooring)
    frequency = first_frequency(10.0, 2e6, 100.0 + 1024.68853 * 0.25 * np.pi * 0.3525**2, 1000.0)
    times = np.arange(1, 401) * 0.02
    heights = []
    for t in times:
        mooring.step(t, HERE, STILL)
        heights.append(mooring.node_positions("line1")[-1, 2])
    heights = np.array(heights) - rest
    crossings = np.flatnonzero((heights[:-1] > 0.0) & (heights[1:] <= 0.0))
    exact = times[crossings] + 0.02 * heights[crossings] / (heights[crossings] - heights[crossings + 1])
    assert np.diff(exact).mean() == pytest.approx(2.0 * np.pi / frequency, rel=0.01)


def test_a_cantilever_that_is_let_go_swings_about_and_comes_to_its_static_deflection():
    scene = load_scene(SCENES / "cantilever_10m_decay.txt")
    braked = replace(scene, points=(replace(scene.points[0], drag_area=2.0), scene.points[1]))
    mooring = Mooring(braked, segments=4)
    mooring.settle(HERE)
    assert tip(mooring)[0] == pytest.approx(0.0, abs=0.01)
    times = np.arange(1, 801) * 0.05
    deflections = []
    for t in times:
        mooring.step(t, HERE, STILL)
        deflections.append(tip(mooring)[0])
    deflections = np.array(deflections)
    assert abs(deflections[times <= 1.0]).max() < 0.01
    still = Mooring(cantilever(10), segments=4)
    still.settle(HERE)
    rest = tip(still)[0]
    assert deflections.max() > 1.25 * rest
    assert deflections[times > 30.0].mean() == pytest.approx(rest, rel=0.005)
    assert np.ptp(deflections[times > 30.0]) < 0.1 * rest
