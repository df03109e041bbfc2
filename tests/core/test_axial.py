"""Leapfrog with the lines' axial stiffness and damping taken implicitly (core/axial.py)."""

import numpy as np
import pytest
from scenes_in_code import COUPLED, FIXED, FREE, HERE, SCENES, line_type, scene, surge_heave, vacuum

from mooring_ros import Mooring
from mooring_ros.core import axial, explicit
from mooring_ros.core.cache import kernel
from mooring_ros.core.forces import evaluate_once
from mooring_ros.core.points import carry_ends
from mooring_ros.core.schemes import AXIAL, step_table


@kernel
def step_of_a_held_platform(model, state, scratch, h):
    explicit.leapfrog_stage(model, state, h)
    carry_ends(model, state)
    axial.pull_implicitly(model, state, scratch, h)


def bridle(zeta=0.5, clump=300.0, current=0.3):
    """Two legs to a coupled platform and one to the anchor meet at a clump weight; a line of its own beside them."""
    kind = line_type(0.1, 80.0, 5e8, -zeta, drag=1.5, added=1.0, drag_axial=0.2, added_axial=0.2)
    points = [(FIXED, (-300, 0, -100)), (FREE, (-60, 0, -40), clump), (COUPLED, (-10, 12, -10)), (COUPLED, (-10, -12, -10)), (FIXED, (250, 0, -100)), (COUPLED, (10, 0, -10))]
    lines = [(kind, 1, 2, 262.0, 12), (kind, 2, 3, 60.0, 5), (kind, 2, 4, 60.0, 6), (kind, 5, 6, 265.0, 10)]
    return scene(points, lines, depth=150.0, current=(current, 0.0, 0.0))


def dense_change(model, state, h):
    """Changes of velocity (3, n) that solve (M + h^2/4 K + h/2 C) dv = h M a for a mooring at rest, all segments taut: one dense system."""
    size, group = model.size, np.arange(model.size)
    held = np.zeros(model.size, dtype=bool)
    for e, p in enumerate(state.end_point):
        group[model.end_node[e]] = model.point_node[p] if model.free_index[p] >= 0 else model.end_node[e]
        held[model.end_node[e]] = model.free_index[p] < 0
    inertia, force = np.zeros((3 * size, 3 * size)), np.zeros(3 * size)
    for i in range(size):
        t = state.tangent[:, i] + state.tangent[:, i + 1]
        t = t / max(np.linalg.norm(t), 1e-100)
        m = state.inertia_normal[i] * np.eye(3) + (state.inertia_axial[i] - state.inertia_normal[i]) * np.outer(t, t)
        rows = slice(3 * group[i], 3 * group[i] + 3)
        inertia[rows, rows] += m
        force[rows] += m @ state.acceleration[:, i]
    left = inertia.copy()
    for j in np.flatnonzero(model.live[: size + 1]):
        gain = 0.25 * h**2 * model.stiffness[j] * model.inverse_length[j] + 0.5 * h * model.damping[j]
        row = np.zeros(3 * size)
        for i, sign in ((j, 1.0), (j - 1, -1.0)):
            if not held[i]:
                row[3 * group[i] : 3 * group[i] + 3] += sign * state.tangent[:, j]
        left += gain * np.outer(row, row)
    moves = np.repeat(np.bincount(group, minlength=size) > 0, 3) & ~np.repeat(held, 3) & (np.diag(inertia) > 0.0)
    change = np.zeros(3 * size)
    change[moves] = np.linalg.solve(left[np.ix_(moves, moves)], h * force[moves])
    return change.reshape(size, 3)[group].T


@pytest.mark.parametrize("h", [1e-3, 0.02, 0.3])
def test_a_step_is_that_of_newmark_for_the_axial_waves_with_a_free_point(h):
    """Against one dense system over all nodes and the free point, 1e-9 of the largest change; out of balance by nodes moved at random by 0.1 mm."""
    mooring = Mooring(bridle(zeta=0.01))
    mooring.settle(HERE)
    model, state, scratch = mooring._model, mooring._state, mooring._scratch
    moves = 1e-4 * np.random.default_rng(1).standard_normal(state.position[:, : model.size].shape)
    moves[:, model.end_node] = 0.0
    state.position[:, : model.size] += moves
    evaluate_once(model, state, scratch, 0.0, 0.0, False)
    assert state.tension[model.live > 0.0].min() > 0.0
    want = dense_change(model, state, h)
    before = state.velocity.copy()
    step_of_a_held_platform(model, state, scratch, h)
    got = (state.velocity - before)[:, : model.size]
    nodes = np.flatnonzero(np.abs(want).max(axis=0) > 0.0)
    np.testing.assert_allclose(got[:, nodes], want[:, nodes], rtol=0.0, atol=1e-9 * np.abs(want).max())


@pytest.mark.parametrize("times_the_limit", [3.0, 30.0, 300.0])
def test_axial_waves_do_not_grow_in_steps_far_beyond_their_limit(times_the_limit):
    """A taut string in a vacuum, no damping, nodes set moving along it at random: energy within a factor 4 of that put in, for 2000 steps."""
    count, length = 20, 100.0
    kind = line_type(mass=10.0, stiffness=1e7)
    mooring = Mooring(vacuum([(FIXED, (0, 0, -50)), (FIXED, (1.01 * length, 0, -50))], [(kind, 1, 2, length, count)]))
    mooring.settle(HERE)
    strained, state = mooring.energy.total, mooring._state
    state.velocity[0, 1:count] = 1e-3 * np.random.default_rng(2).standard_normal(count - 1)
    put_in = mooring.energy.total - strained
    h = times_the_limit * mooring.step_limit.limits["axial"]
    mooring._table = step_table({AXIAL: np.inf}, h * (1.0 + 1e-9))
    for k in range(1, 201):
        mooring.step(10.0 * h * k, HERE, np.zeros(6))
        assert np.abs(state.velocity[0]).max() < 2e-3 * np.sqrt(count)
    assert mooring.energy.kinetic < 4.0 * put_in


def rms(got, want):
    return np.sqrt(np.mean((got - want) ** 2, axis=0)) / want.std(axis=0)


@pytest.mark.parametrize("clump", [0.0, 300.0, 1e5])
def test_a_bridle_in_steps_of_ten_times_the_axial_limit_is_that_of_fine_steps(clump):
    """Tensions within 2 % of their deviation; the free point has no mass of its own, that of a clump, or that of a ship's anchor."""
    description = bridle(clump=clump)
    times = np.arange(1, 401) * 0.1
    poses, twists = surge_heave(times, surge=3.0, heave=2.0, period=9.0)
    runs = []
    axial_limit = Mooring(description).step_limit.limits["axial"]
    for dt in (axial_limit / 10.0, None):
        mooring = Mooring(description, dt=dt)
        mooring.settle(HERE)
        runs.append(mooring.run(times, poses, twists).fairlead_tension[100:])
    assert mooring.step_limit.dt > 2.5 * axial_limit
    assert rms(runs[1], runs[0]).max() < 0.02


@pytest.mark.parametrize("dt", [0.005, 0.01])
def test_the_rm3_cable_goes_in_steps_of_ten_milliseconds(dt):
    """Tension at the converter within 2 % of the deviation of steps of 1 ms, in its storm, whose axial limit is 0.3 ms; no step is taken again."""
    runs = []
    times = np.arange(1, 201) * 0.1
    poses, twists = surge_heave(times, surge=2.0, heave=2.0, period=10.0)
    for step in (0.001, dt):
        mooring = Mooring(SCENES / "rm3_cable.txt", dt=step)
        mooring.settle(HERE)
        runs.append(mooring.run(times, poses, twists).fairlead_tension[50:])
    assert mooring.last_step["retries"] == 0
    assert mooring.last_step["dt"] > 0.49 * dt
    assert rms(runs[1], runs[0])[0] < 0.02
