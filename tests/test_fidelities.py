"""The cheaper fidelities against what they approximate."""

from dataclasses import replace

import numpy as np
import pytest
from scenes_in_code import HERE, SCENES, STILL, same_bits, surge_heave, turn

from mooring_ros import Mooring, MooringError
from mooring_ros.core.statics import StaticResult


def settled(fidelity, file="oc4.txt", pose=HERE):
    mooring = Mooring(SCENES / file, fidelity=fidelity)
    mooring.settle(pose)
    return mooring


@pytest.mark.parametrize("file", ["oc3_spar.txt", "oc4.txt", "volturnus_s_chain.txt", "chalmers_33m.txt"])
def test_quasi_static_is_the_equilibrium_at_every_sample(file):
    scale = 0.01 if "33m" in file else 1.0
    times = np.arange(1, 21) * 0.5
    poses, twists = surge_heave(times, 4.0 * scale, 3.0 * scale, 10.0, pitch=0.05)
    run = settled("quasi_static", file).run(times, poses, twists)
    other = settled("dynamic", file)
    for k in (3, 11, 19):
        other.settle(poses[k])
        np.testing.assert_allclose(run.wrench[k], other.wrench, rtol=1e-6, atol=1e-6 * np.abs(other.wrench).max())
        np.testing.assert_allclose(run.fairlead_tension[k], other.fairlead_tension, rtol=1e-6)


def test_quasi_static_is_what_slow_motion_comes_to():
    """Ten metres in twenty minutes: the dynamic wrench is the quasi-static one within 0.2 %."""
    times = np.arange(1, 2401) * 0.5
    poses, twists = np.tile(HERE, (times.size, 1)), np.zeros((times.size, 6))
    poses[:, 0] = 5.0 * (1.0 - np.cos(np.pi * times / times[-1]))
    twists[:, 0] = 5.0 * np.pi / times[-1] * np.sin(np.pi * times / times[-1])
    dynamic = settled("dynamic").run(times, poses, twists)
    quasi_static = settled("quasi_static").run(times[::100], poses[::100], twists[::100])
    np.testing.assert_allclose(dynamic.fairlead_tension[::100], quasi_static.fairlead_tension, rtol=2e-3)


@pytest.mark.parametrize("start", [HERE, np.concatenate([[4.0, -2.0, 0.5], turn([1, 2, 3], 0.1)])], ids=["at rest", "moved and turned"])
def test_linear_wrench_is_the_stiffness_times_the_offset(start):
    mooring = settled("linear", pose=start)
    before, stiffness = mooring.wrench, mooring.stiffness()
    pose = start + np.array([0.02, -0.01, 0.03, 0, 0, 0, 0])
    mooring.step(1.0, pose, STILL)
    np.testing.assert_allclose(before - mooring.wrench, stiffness[:, :3] @ [0.02, -0.01, 0.03], rtol=1e-9)


def test_linear_is_the_quasi_static_to_first_order():
    """The error falls fourfold when the offset is halved, in wrench, tension and shape."""
    linear, exact = settled("linear"), settled("quasi_static")
    errors = []
    for k, size in enumerate((0.4, 0.2), 1):
        pose = np.concatenate([size * np.array([1.0, 0.7, -0.5]), turn([1, -1, 2], 0.01 * size)])
        for one in (linear, exact):
            one.step(float(k), pose, STILL)
        errors.append(
            [
                np.abs(linear.wrench - exact.wrench).max(),
                np.abs(linear.fairlead_tension - exact.fairlead_tension).max(),
                np.abs(linear.node_positions("line1") - exact.node_positions("line1")).max(),
            ]
        )
    assert (np.array(errors[1]) < 0.45 * np.array(errors[0])).all(), errors


@pytest.mark.parametrize("fidelity", ["linear", "quasi_static"])
def test_snapshots_of_the_cheap_fidelities_are_exact(fidelity):
    mooring = settled(fidelity)
    mooring.step(1.0, HERE + np.array([1.0, 0, 0, 0, 0, 0, 0]), STILL)
    saved = mooring.snapshot()
    mooring.settle(HERE + np.array([5.0, 0, 0, 0, 0, 0, 0]), time=2.0)
    mooring.restore(saved)
    assert same_bits(saved, mooring.snapshot())
    twin = settled(fidelity)
    twin.step(1.0, HERE + np.array([1.0, 0, 0, 0, 0, 0, 0]), STILL)
    for one in (mooring, twin):
        one.step(2.0, HERE + np.array([1.5, 0.2, 0, 0, 0, 0, 0]), STILL)
    assert same_bits(mooring.snapshot(), twin.snapshot())


def test_what_a_fidelity_leaves_out_of_a_scene_is_said():
    file = SCENES / "rm3_cable.txt"
    assert not any("waves" in warning for warning in Mooring(file).warnings)
    assert any("know no waves" in warning for warning in Mooring(file, fidelity="quasi_static").warnings)


@pytest.mark.parametrize("file", ["oc4.txt", "volturnus_s_semi_taut_friction.txt", "iswec_c2a.txt", "chalmers_33m.txt"])
def test_quasi_static_finds_the_equilibrium_of_large_moves_between_samples(file):
    """Random places, up to a third of the depth and a radian away: that of a cold start."""
    rng, moved, cold = np.random.default_rng(7), settled("quasi_static", file), settled("quasi_static", file)
    depth = moved.scene.environment.depth
    for k in range(1, 9):
        pose = np.concatenate([depth / 3.0 * rng.uniform(-1, 1, 3) * [1, 1, 0.1], turn(rng.normal(size=3), rng.uniform(-1, 1))])
        moved.step(float(k), pose, STILL)
        cold.settle(pose)
        np.testing.assert_allclose(moved.fairlead_tension, cold.fairlead_tension, rtol=1e-4, atol=1e-4 * cold.fairlead_tension.max())


def test_quasi_static_follows_in_parts_of_the_move_where_newton_does_not_find_the_way_at_once(monkeypatch):
    mooring, target = settled("quasi_static"), HERE + np.array([12.0, 3.0, 0, 0, 0, 0, 0])
    solve, tried = mooring._statics.solve, []

    def not_at_once(state, scratch, quick=False):
        tried.append(float(state.pose[0, 0]))
        result = solve(state, scratch, quick=quick)
        return replace(result, residual=np.inf, converged=False) if len(tried) == 1 else result

    monkeypatch.setattr(mooring._statics, "solve", not_at_once)
    mooring.step(1.0, target, STILL)
    assert tried == pytest.approx([12.0, 3.0, 6.0, 9.0, 12.0])
    cold = settled("quasi_static", pose=target)
    np.testing.assert_allclose(mooring.fairlead_tension, cold.fairlead_tension, rtol=1e-9)


def test_a_quasi_static_step_without_an_equilibrium_is_refused_in_words_and_undone(monkeypatch):
    mooring = settled("quasi_static")
    saved = mooring.snapshot()
    monkeypatch.setattr(mooring._statics, "solve", lambda *_, **__: StaticResult(3, 1e9, 1.0, False))
    with pytest.raises(MooringError, match=r"no equilibrium for the step to t = 2 s: .*settle\(\)"):
        mooring.step(2.0, HERE, STILL)
    assert same_bits(saved, mooring.snapshot())
