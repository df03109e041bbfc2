"""Bending forces and moments: of an energy, in balance, and nothing where nothing bends."""

import numpy as np
import pytest
from bent_lines import BentLines, three_bent_lines, turned


@pytest.mark.parametrize("measure", ["angle", "paper"])
def test_forces_are_the_gradient_of_the_energy(measure):
    lines = three_bent_lines(1, measure)
    force, _ = lines.forces(lines.position)
    step = 1e-6
    for node in range(lines.size):
        for k in range(3):
            ahead, behind = lines.position.copy(), lines.position.copy()
            ahead[k, node] += step
            behind[k, node] -= step
            slope = (lines.energy(ahead) - lines.energy(behind)) / (2.0 * step)
            assert force[k, node] == pytest.approx(-slope, abs=1e-6 * np.abs(force).max())


@pytest.mark.parametrize("measure", ["angle", "paper"])
def test_moments_on_the_holders_are_the_gradient_of_the_energy_by_turns_of_the_axes(measure):
    lines = three_bent_lines(2, measure)
    _, moment = lines.forces(lines.position)
    step = 1e-6
    for clamp in range(4):
        for k in range(3):
            slopes = []
            for sign in (1.0, -1.0):
                axes = lines.axes.copy()
                axes[clamp] = turned(axes[clamp], sign * step * np.eye(3)[k])
                slopes.append(lines.energy(lines.position, axes))
            assert moment[clamp, k] == pytest.approx(-(slopes[0] - slopes[1]) / (2.0 * step), abs=1e-6 * np.abs(moment).max())


@pytest.mark.parametrize("measure", ["angle", "paper"])
def test_forces_and_moments_balance_to_rounding(measure):
    lines = three_bent_lines(3, measure)
    force, moment = lines.forces(lines.position)
    size = np.abs(force).max()
    assert size > 1.0
    assert np.abs(force.sum(axis=1)).max() < 1e-13 * size
    arms = np.cross(lines.position.T, force.T)
    assert np.abs(arms.sum(axis=0) + moment.sum(axis=0)).max() < 1e-13 * np.abs(arms).max()


def test_forces_turn_with_the_lines():
    lines = three_bent_lines(4)
    force, moment = lines.forces(lines.position)
    vector = np.array([0.4, -1.1, 0.7])
    rotation = np.array([turned(e, vector) for e in np.eye(3)]).T
    turned_force, turned_moment = lines.forces(rotation @ lines.position, lines.axes @ rotation.T)
    assert turned_force == pytest.approx(rotation @ force, abs=1e-12 * np.abs(force).max())
    assert turned_moment == pytest.approx(moment @ rotation.T, abs=1e-12 * np.abs(moment).max())


def test_a_straight_line_feels_exactly_nothing():
    axis = np.array([1.0, 0.0, 0.0])
    lines = BentLines([(8, 10.0, 2e6), (4, 10.0, 2e6)], [(0, axis), (3, -axis)], [[(1, -1.0), (2, 1.0)]])
    lines.position[0, : lines.size] = np.concatenate([np.linspace(0.0, 10.3, 9), np.linspace(10.3, 21.0, 5)])
    force, moment = lines.forces(lines.position)
    assert not force.any() and not moment.any()
    assert not lines.curvature(lines.position).any()


@pytest.mark.parametrize("measure", ["angle", "paper"])
def test_folded_and_crumpled_lines_stay_finite(measure):
    axis = np.array([-1.0, 0.0, 0.0])
    lines = BentLines([(3, 3.0, 50.0), (2, 2.0, 50.0)], [(0, axis)], [[(1, -1.0), (2, 1.0)]], measure)
    lines.position[0, :7] = [0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0]  # onto itself, against its clamp and its joint, and a segment without length
    force, moment = lines.forces(lines.position)
    data, turn, around = lines.blocks(lines.position)
    for values in (force, moment, data, turn, around, lines.curvature(lines.position), lines.energy(lines.position)):
        assert np.isfinite(values).all()


def test_a_sharp_bend_is_pushed_open_ever_harder():
    moments = []
    for degrees in range(5, 166, 5):
        lines = BentLines([(2, 2.0, 10.0)])
        lines.position[:, 1] = [1.0, 0.0, 0.0]
        lines.position[:, 2] = [1.0 + np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0.0]
        moments.append(np.linalg.norm(lines.forces(lines.position)[0][:, 2]))
    assert (np.diff(moments) > 0.0).all()
    angles = np.radians(np.arange(5, 166, 5))
    assert moments[:18] == pytest.approx(10.0 * angles[:18], rel=0.002)  # to 90 degrees
    assert moments[:24] == pytest.approx(10.0 * angles[:24], rel=0.01)  # to 120 degrees


def test_the_papers_measure_is_the_papers_formula():
    """Moment EI (2 / dl) sqrt((1 - q q) / 2) at a node, EI (4 / dl) sqrt((1 - q q) / 2) at a clamp (equations 7 and 10)."""
    rigidity, dl = 30.0, 1.5
    lines = BentLines([(2, 2 * dl, rigidity)], [(0, np.array([1.0, 0.0, 0.0]))], measure="paper")
    first, second = np.array([np.cos(0.3), np.sin(0.3), 0.0]), np.array([np.cos(0.3), np.sin(0.3) * np.cos(0.8), np.sin(0.3) * np.sin(0.8)])
    lines.position[:, 1], lines.position[:, 2] = dl * first, dl * (first + second)
    force, moment = lines.forces(lines.position)
    node = rigidity * 2.0 / dl * np.sqrt((1.0 - first @ second) / 2.0)
    clamp = rigidity * 4.0 / dl * np.sqrt((1.0 - first[0]) / 2.0)
    assert np.linalg.norm(force[:, 2]) == pytest.approx(node / dl, rel=1e-12)
    assert np.linalg.norm(moment[0]) == pytest.approx(clamp, rel=1e-12)
    assert lines.curvature(lines.position)[:2] == pytest.approx([clamp / rigidity, node / rigidity], rel=1e-12)


def test_an_end_that_has_left_its_clamp_or_joint_feels_nothing_of_it():
    free = BentLines([(5, 6.0, 300.0), (7, 4.0, 80.0), (4, 5.0, 200.0)], measure="paper")
    lines = three_bent_lines(5, "paper")
    lines.end_point[:] = -1
    force, moment = lines.forces(lines.position)
    assert force == pytest.approx(free.forces(lines.position)[0], abs=1e-12 * np.abs(force).max())
    assert not moment.any()


def test_two_equal_lines_at_a_joint_are_one_line():
    rng = np.random.default_rng(6)
    whole = BentLines([(6, 6.0, 70.0)], measure="paper")
    whole.position[0, :7] = np.arange(7.0)
    whole.position[:, :7] += rng.normal(0.0, 0.2, (3, 7))
    # the second line runs against the first one: end B of both at the joint
    parts = BentLines([(3, 3.0, 70.0), (3, 3.0, 70.0)], joints=[[(1, -1.0), (3, 1.0)]], measure="paper")
    parts.position[:, :4] = whole.position[:, :4]
    parts.position[:, 4:8] = whole.position[:, 6:2:-1]
    expected, _ = whole.forces(whole.position)
    got, _ = parts.forces(parts.position)
    assert got[:, :3] == pytest.approx(expected[:, :3], abs=1e-12 * np.abs(expected).max())
    assert got[:, 3] + got[:, 7] == pytest.approx(expected[:, 3], abs=1e-12 * np.abs(expected).max())
    assert got[:, 4:7] == pytest.approx(expected[:, 6:3:-1], abs=1e-12 * np.abs(expected).max())
    assert parts.curvature(parts.position)[3] == pytest.approx(whole.curvature(whole.position)[3], rel=0.02)


def test_the_moment_goes_on_through_a_joint_of_different_sections():
    lines = BentLines([(4, 8.0, 300.0), (10, 5.0, 40.0)], joints=[[(1, -1.0), (2, 1.0)]], measure="paper")
    bend_at = np.radians(0.5)
    lines.position[0, :5] = np.linspace(-8.0, 0.0, 5)
    along = np.linspace(0.0, 5.0, 11)
    lines.position[0, 5:16], lines.position[1, 5:16] = along * np.cos(bend_at), along * np.sin(bend_at)
    kappa = lines.curvature(lines.position)
    assert 300.0 * kappa[4] == pytest.approx(40.0 * kappa[5], rel=1e-4)
    assert kappa[4] > 0.0


def test_lines_without_bending_stiffness_cost_and_feel_nothing_and_still_have_a_curvature():
    lines = BentLines([(4, 4.0, 0.0)], [(0, np.array([1.0, 0.0, 0.0]))])
    assert lines.bending.stiffness.size == 0
    radius = 20.0
    angle = np.arange(5) / radius
    lines.position[0, :5], lines.position[1, :5] = radius * np.sin(angle), radius * (1.0 - np.cos(angle))
    force, _ = lines.forces(lines.position)
    assert not force.any()
    assert lines.curvature(lines.position)[1:4] == pytest.approx(lines.bending.reach[1:4] ** -1 * 1.0 / radius, rel=1e-9)
