"""A mooring of many lines is advanced in blocks, and nobody can tell: the same forces, the same guarantees."""

from dataclasses import replace

import numpy as np
import pytest
from scenes_in_code import COUPLED, FIXED, FREE, HERE, line_type, scene, surge_heave

from mooring_ros import Mooring, MooringError, blocks
from mooring_ros.blocks import BlockMooring

CHAIN = line_type(0.1, 100.0, 1e8, -0.5, drag=1.6, added=1.0)
TIMES = np.arange(1, 41) * 0.1
POSES, TWISTS = surge_heave(TIMES, surge=1.5, heave=0.5, period=8.0, pitch=0.01)


def farm():
    """Ten chains around a platform, and a bridle: two chains from the platform to a free point, which a third one holds."""
    points, lines = [], []
    for k in range(10):
        way = np.array([np.cos(0.5 * k), np.sin(0.5 * k)])
        points += [(FIXED, (*(200.0 * way), -60.0)), (COUPLED, (*(5.0 * way), -5.0))]
        lines.append((CHAIN, 2 * k + 1, 2 * k + 2, 205.0 + k, 8))
    points += [(FIXED, (-220.0, 0.0, -60.0)), (FREE, (-60.0, 0.0, -25.0), 500.0), (COUPLED, (-5.0, 5.0, -5.0)), (COUPLED, (-5.0, -5.0, -5.0))]
    lines += [(CHAIN, 23, 22, 58.0, 5), (CHAIN, 21, 22, 167.0, 8), (CHAIN, 24, 22, 58.0, 5)]
    return scene(points, lines, depth=60.0)


@pytest.fixture
def small_blocks(monkeypatch):
    monkeypatch.setattr(blocks, "LARGE", 50)
    monkeypatch.setattr(blocks, "BLOCK", 30)


@pytest.fixture
def pair(small_blocks, monkeypatch):
    """(mooring in blocks, the same in one piece), settled; with one step for all, which each block would else choose for itself."""
    cut = Mooring(farm(), dt=0.002)
    with monkeypatch.context() as patch:
        patch.setattr(blocks, "LARGE", np.inf)
        whole = Mooring(farm(), dt=0.002)
    assert type(cut) is BlockMooring and type(whole) is Mooring
    for mooring in (cut, whole):
        mooring.settle(HERE)
    return cut, whole


def bits(mooring):
    return [array.tobytes() for part in mooring.snapshot().parts for array in (*part.state, *part.readings)]


def test_lines_that_are_joined_stay_in_one_block_and_every_line_is_in_one(small_blocks):
    counts = [line.segments for line in farm().lines]
    found = blocks._blocks(farm(), counts)
    assert len(found) > 3
    assert sorted(name for names in found for name in names) == sorted(line.name for line in farm().lines)
    assert sum({"line11", "line12", "line13"} <= names for names in found) == 1


def test_blocks_have_the_forces_of_one_piece(pair):
    cut, whole = pair
    found, expected = (mooring.run(TIMES, POSES, TWISTS) for mooring in pair)
    scale = np.abs(expected.fairlead_tension).max()
    for name in ("fairlead_tension", "anchor_tension", "fairlead_end_force", "anchor_end_force"):
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), rtol=0.0, atol=1e-6 * scale)
    np.testing.assert_allclose(found.stretched_length, expected.stretched_length, rtol=1e-8)
    np.testing.assert_allclose(found.coupled_wrenches, expected.coupled_wrenches, rtol=0.0, atol=1e-6 * scale)
    np.testing.assert_allclose(found.wrench, expected.wrench, rtol=0.0, atol=1e-5 * scale)
    np.testing.assert_allclose(cut.stiffness(), whole.stiffness(), rtol=0.0, atol=1e-5 * np.abs(whole.stiffness()).max())
    assert cut.line_names == whole.line_names and cut.segments == whole.segments and cut.coupled_names == whole.coupled_names
    assert cut.step_limit.dt == pytest.approx(whole.step_limit.dt)
    for name in ("line3", "line12"):
        np.testing.assert_allclose(cut.node_positions(name), whole.node_positions(name), rtol=0.0, atol=1e-5)


def test_steps_and_runs_have_the_same_bits_and_a_snapshot_brings_them_back(small_blocks):
    first, second = Mooring(farm()), Mooring(farm())
    for mooring in (first, second):
        mooring.settle(HERE)
    first.run(TIMES, POSES, TWISTS)
    saved = None
    for j in range(TIMES.size):
        if j == 20:
            saved = second.snapshot()
        second.step(TIMES[j], POSES[j], TWISTS[j])
    assert bits(first) == bits(second)
    second.restore(saved)
    second.run(TIMES[20:], POSES[20:], TWISTS[20:])
    assert bits(first) == bits(second)
    other = second.twin()
    other.step(5.0, POSES[-1], TWISTS[-1])
    assert bits(first) == bits(second) != bits(other)


@pytest.mark.parametrize("kept", [3, 256])
def test_a_step_that_one_block_cannot_do_leaves_all_as_they_were(small_blocks, monkeypatch, kept):
    monkeypatch.setattr(blocks, "KEPT", kept)
    mooring, single = Mooring(farm()), Mooring(farm())
    for one in (mooring, single):
        one.settle(HERE)
        one.run(TIMES[:4], POSES[:4], TWISTS[:4])
        for j in range(4, 10):
            one.step(TIMES[j], POSES[j], TWISTS[j])
    far = POSES.copy()
    far[:, 0] += np.where(TIMES > 1.55, 300.0, 0.0)
    before = bits(mooring)
    with pytest.raises(MooringError):
        mooring.step(TIMES[15], far[15], TWISTS[15])
    assert bits(mooring) == before
    with pytest.raises(MooringError) as raised:
        mooring.run(TIMES[10:], far[10:], TWISTS[10:])
    assert (raised.value.history.time == TIMES[10:15]).all()
    expected = single.run(TIMES[10:15], POSES[10:15], TWISTS[10:15])
    assert (raised.value.history.wrench == expected.wrench).all()
    assert bits(mooring) == bits(single)
    with pytest.raises(ValueError):
        mooring.step(TIMES[14], POSES[14], TWISTS[14])
    assert bits(mooring) == bits(single)
    mooring.step(TIMES[15], POSES[15], TWISTS[15])


def test_winches_and_releases_reach_the_line(pair):
    for mooring in pair:
        mooring.set_unstretched_length("line4", 200.0)
        mooring.release("line7")
        mooring.run(TIMES[:10], POSES[:10], TWISTS[:10])
    cut, whole = pair
    np.testing.assert_allclose(cut.fairlead_tension, whole.fairlead_tension, rtol=0.0, atol=1e-6 * whole.fairlead_tension.max())
    np.testing.assert_array_equal(cut.unstretched_length, whole.unstretched_length)


def test_small_scenes_other_solvers_and_bad_numbers_are_left_alone(small_blocks):
    lines = farm().lines[:3]
    assert type(Mooring(replace(farm(), lines=lines))) is Mooring
    assert type(Mooring(farm(), fidelity="quasi_static")) is Mooring
    assert type(type("Own", (Mooring,), {})(farm())).__name__ == "Own"
    for wrong in ({"segments": "many"}, {"refine": -1.0}, {"segments": np.nan}):
        with pytest.raises(ValueError):
            Mooring(farm(), **wrong)
