"""Growth, and only what is there: a farm does what its lines do by themselves, and what a scene lacks has no arrays and no stage."""

from pathlib import Path

import numpy as np
import pytest

from benchmarks import removed
from benchmarks.growth import farm
from mooring_ros import Mooring, blocks
from mooring_ros.scene import load_scene

OC4 = Path(__file__).parents[2] / "config" / "scenes" / "oc4.txt"
HERE = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


def test_every_line_of_a_farm_has_the_tensions_that_it_has_in_a_small_scene(monkeypatch):
    monkeypatch.setattr(blocks, "LARGE", 300)
    monkeypatch.setattr(blocks, "BLOCK", 100)
    base = load_scene(OC4)
    large, small = Mooring(farm(base, 30)), Mooring(farm(base, 3))
    assert len(large._groups) == 6
    times = np.arange(1, 31) * 0.1
    poses, twists = np.tile(HERE, (30, 1)), np.zeros((30, 6))
    poses[:, 0], twists[:, 0] = 2.0 * (1.0 - np.cos(times)), 2.0 * np.sin(times)
    found = []
    for mooring in (large, small):
        mooring.settle(HERE)
        found.append(mooring.run(times, poses, twists))
    for k in range(30):
        np.testing.assert_allclose(found[0].fairlead_tension[:, k], found[1].fairlead_tension[:, k % 3], rtol=1e-8)
        np.testing.assert_allclose(found[0].anchor_tension[:, k], found[1].anchor_tension[:, k % 3], rtol=1e-8)
    np.testing.assert_allclose(found[0].wrench, 10.0 * found[1].wrench, rtol=1e-7, atol=1e-7 * np.abs(found[0].wrench).max())


def test_what_a_scene_lacks_has_arrays_of_no_length():
    mooring = Mooring(OC4)
    model, state, scratch = mooring._model, mooring._state, mooring._scratch
    absent = [model.bending.stiffness, model.ropes.curve_first, model.ropes.kelvin_first, model.sea.frequency, model.sea.layer_bottom, model.rigid.mass]
    absent += [model.hulls.point, model.free_points, model.failures.point, state.swell, state.window, state.grip, state.creep, state.parts]
    absent += [scratch.bending, scratch.bed, scratch.hold, scratch.wave_work, scratch.saved_grip, scratch.saved_creep]
    assert not model.ground.on
    assert [array.size for array in absent] == [0] * len(absent)


@pytest.mark.parametrize("effect", [*removed.STAGES, removed.ALL])
def test_every_effect_has_a_stage_that_can_be_taken_out(effect, tmp_path):
    folder = removed.build(list(removed.STAGES) if effect == removed.ALL else [effect], tmp_path)
    changed = 0
    for path in sorted((folder / "mooring_ros" / "core").glob("*.py")):
        text = path.read_text(encoding="utf-8")
        compile(text, str(path), "exec")
        changed += text != (removed.PACKAGE / "core" / path.name).read_text(encoding="utf-8")
    assert changed > 0
