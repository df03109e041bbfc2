"""A recording holds its scene and every file that the scene was read from: it replays wherever it is, and alone."""

import shutil

import pytest

from conftest import SCENE

GRID = """\
3 2
-320 0 320
-100 100
-320 -100 -64
0 -100 -60
320 -100 -56
-320 100 -64
0 100 -60
320 100 -56
"""
CURVE = """\
Chain, stiffer when it is taut
Strain  Tension
(-)  (N)
0.0  0.0
0.001  15000
0.01  195000
"""


@pytest.fixture
def folder(tmp_path):
    """A folder with a scene on a grid of depths and with a load-strain curve."""
    folder = tmp_path / "deck"
    (folder / "tables").mkdir(parents=True)
    (folder / "tables" / "depths.txt").write_text(GRID)
    (folder / "curve.txt").write_text(CURVE)
    text = SCENE.replace("2.0e7", "curve.txt").replace("60  WtrDpth", "tables/depths.txt  WtrDpth").replace("300  0  -60", "300  0  -56.25")
    (folder / "scene.txt").write_text(text.replace("-300  0  -60", "-300  0  -63.75"))
    return folder


@pytest.fixture
def recorded(folder, motion, mooring, tmp_path):
    """Path of a recording of that scene."""
    outcome = mooring("replay", folder / "scene.txt", motion, "-o", tmp_path / "one.mcap")
    assert outcome.status == 0, outcome.err
    return tmp_path / "one.mcap"


def test_a_scene_on_a_grid_that_was_moved_replays_bit_for_bit(folder, recorded, mooring, tmp_path):
    shutil.move(folder, tmp_path / "elsewhere")
    found = mooring("replay", tmp_path / "elsewhere" / "scene.txt", recorded, "-o", tmp_path / "two.mcap", "--json")
    assert found.status == 0 and found.err == "", found.err
    assert found.json()["identical"] == {"same": 61, "total": 61} and found.json()["scene_is_recorded"] is True


def test_a_recording_is_its_own_scene_when_the_files_are_gone(folder, recorded, mooring, tmp_path):
    shutil.rmtree(folder)
    for scene, name in ((recorded, "two.mcap"), (tmp_path / "two.mcap", "three.mcap")):
        found = mooring("replay", scene, recorded, "-o", tmp_path / name, "--json")
        assert found.status == 0 and found.err == "", found.err
        assert found.json()["identical"] == {"same": 61, "total": 61} and found.json()["scene_is_recorded"] is True


def test_another_grid_under_the_same_name_is_another_scene(folder, recorded, mooring, tmp_path):
    (folder / "tables" / "depths.txt").write_text(GRID.replace("-64", "-64.5"))
    found = mooring("replay", folder / "scene.txt", recorded, "-o", tmp_path / "two.mcap", "--json")
    assert found.status == 0 and found.json()["scene_is_recorded"] is False
    assert f"{folder / 'scene.txt'}: differs from the scene in the recording {recorded} (tables/depths.txt); this one is used" in found.err


def test_a_recording_without_a_scene_is_refused_as_a_scene(motion, mooring, tmp_path):
    from mooring_ros.recording.writer import RecordingWriter

    with RecordingWriter(tmp_path / "bare.mcap", {}):
        pass
    found = mooring("replay", tmp_path / "bare.mcap", motion, "-o", tmp_path / "out.mcap")
    assert found.status == 2 and "a recording without a scene, expected a MoorDyn v2 input file" in found.err
