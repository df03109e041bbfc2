"""Several platforms whose mooring is cut into several: a fidelity for each line, and blocks of very many lines."""

from dataclasses import fields

import numpy as np
import pytest
from test_platforms import NAMES, PAIR, PARTS, TIMES, close

from mooring_ros import Mooring, MooringError, blocks
from mooring_ros.blocks import BlockMooring
from mooring_ros.mixed import MixedMooring
from mooring_ros.scene import parse_scene

MIX = {"line1": "quasi_static", "line3": "linear", "line4": "linear", "default": "dynamic"}  # no linear line on body1


def motion(home, count=40):
    """Poses (count, 2, 7) and twists (count, 2, 6) that begin at rest: surges of their own, and sway."""
    times = TIMES[:count, None]
    poses, twists = np.tile(home, (count, 1, 1)), np.zeros((count, 2, 6))
    rates = np.array([0.8, 1.1])
    for axis, size in ((0, 2.0), (1, -1.0)):
        poses[:, :, axis] += size * (1.0 - np.cos(rates * times))
        twists[:, :, axis] = size * rates * np.sin(rates * times)
    return poses, twists


def settled(fidelity="dynamic", scene=PAIR, **settings):
    mooring = Mooring(scene, fidelity=fidelity, platforms=NAMES, **settings)
    mooring.settle(mooring.pose_in_file)
    return mooring


def test_each_line_is_as_with_all_lines_of_its_fidelity_and_the_wrenches_add_up():
    mixed = settled(MIX)
    assert type(mixed) is MixedMooring and mixed.platforms == tuple(NAMES)
    way = motion(mixed.pose_in_file)
    found = mixed.run(TIMES[:40], *way)
    alone = {fidelity: settled(fidelity).run(TIMES[:40], *way) for fidelity in ("dynamic", "quasi_static", "linear")}
    forces = np.zeros((40, 2, 3))
    for line, fidelity in enumerate(("quasi_static", "dynamic", "linear", "linear", "dynamic")):
        own, tolerance = alone[fidelity], 5e-3 if fidelity == "linear" else 5e-4
        close(found.fairlead_tension[:, line], own.fairlead_tension[:, line], tolerance)
        ends = [own.fairlead_end_force[:, line]] if line < 4 else [own.anchor_end_force[:, line], own.fairlead_end_force[:, line]]  # line5 from body1 to body2
        for platform, force in zip([line // 2] if line < 4 else [0, 1], ends):
            forces[:, platform] += force
    assert found.wrench.shape == (40, 2, 6)
    close(found.wrench[:, :, :3], forces, 5e-3)
    difference = alone["dynamic"].fairlead_tension - alone["quasi_static"].fairlead_tension
    assert np.abs(difference[:, 0]).max() > 1e3  # the fidelities differ


def test_it_is_one_mooring_sample_by_sample_in_one_call_and_after_a_snapshot_and_a_refused_step_changes_nothing():
    mixed, single = settled(MIX), settled(MIX)
    poses, twists = motion(mixed.pose_in_file)
    whole = mixed.run(TIMES[:40], poses, twists)
    for k in range(20):
        single.step(TIMES[k], poses[k], twists[k])
    saved = single.snapshot()
    away = poses[20] + np.array([[5e4, 0, 0, 0, 0, 0, 0], [0] * 7])
    with pytest.raises(MooringError):
        single.step(TIMES[20], away, twists[20])
    with pytest.raises(ValueError, match="body1, body2"):
        single.step(TIMES[20], poses[20, 0], twists[20, 0])
    np.testing.assert_array_equal(single.wrench, whole.wrench[19])
    single.restore(saved)
    rest = single.run(TIMES[20:40], poses[20:], twists[20:])
    for one in fields(whole):
        np.testing.assert_array_equal(getattr(whole, one.name)[20:], getattr(rest, one.name))
    np.testing.assert_array_equal(mixed.twin().wrench, whole.wrench[-1])


def test_stiffness_and_names_are_those_of_one_fidelity():
    mixed, uniform = settled(MIX), settled()
    assert mixed.stiffness().shape == (12, 12)
    close(mixed.stiffness(), uniform.stiffness(), 1e-7)
    for name in ("coupled_names", "platform_of_coupled", "line_names"):
        assert getattr(mixed, name) == getattr(uniform, name)
    for name in ("pose_in_file", "pose", "twist", "wrench", "coupled_wrenches"):
        value = getattr(uniform, name)
        np.testing.assert_allclose(getattr(mixed, name), value, rtol=1e-6, atol=1e-6 * np.abs(value).max())


def test_bodies_with_rods_and_loads_of_their_own_have_them_once():
    scene = parse_scene(PARTS, "parts.txt", {})
    mixed, whole = (settled(fidelity, scene) for fidelity in ({"line1": "quasi_static", "line3": "linear", "default": "dynamic"}, "dynamic"))
    for mooring in (mixed, whole):
        mooring.step(0.05, mooring.pose_in_file, np.zeros((2, 6)))
    assert mixed.coupled_names == whole.coupled_names and mixed.platform_of_coupled == whole.platform_of_coupled
    close(mixed.coupled_wrenches, whole.coupled_wrenches, 1e-5)
    close(mixed.wrench, whole.wrench, 1e-5)
    assert mixed.body_poses.keys() == whole.body_poses.keys()


def test_lines_that_something_joins_share_one_fidelity_also_between_platforms():
    with pytest.raises(ValueError, match="joins lines of different fidelities"):
        Mooring(parse_scene(PARTS, "parts.txt", {}), fidelity="line5=linear,dynamic", platforms=NAMES)


@pytest.mark.parametrize("names", [["body1"], ["body1", "body3"], "body1"])
def test_names_that_cannot_be_platforms_are_refused_as_with_one_fidelity(names):
    with pytest.raises(ValueError) as plain:
        Mooring(PAIR, platforms=names)
    with pytest.raises(ValueError) as mixed:
        Mooring(PAIR, fidelity=MIX, platforms=names)
    assert str(plain.value) == str(mixed.value)


def test_very_many_lines_on_several_platforms_are_advanced_in_blocks_to_the_same_forces(monkeypatch):
    whole = settled(dt=0.005)
    monkeypatch.setattr(blocks, "LARGE", 50)
    monkeypatch.setattr(blocks, "BLOCK", 30)
    cut = settled(dt=0.005)
    assert type(whole) is Mooring and type(cut) is BlockMooring and len(cut._groups) == 5
    assert cut.platforms == whole.platforms and cut.coupled_names == whole.coupled_names and cut.platform_of_coupled == whole.platform_of_coupled
    way = motion(whole.pose_in_file)
    found, expected = cut.run(TIMES[:40], *way), whole.run(TIMES[:40], *way)
    close(found.fairlead_tension, expected.fairlead_tension, 1e-6)
    close(found.wrench, expected.wrench, 1e-6)
