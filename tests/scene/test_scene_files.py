"""Files that a scene names: bathymetry, currents, waves and curves, in MoorDyn-C's and MoorDyn-F's forms, from the disk or from a recording."""

import math
import os

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator

from mooring_ros.scene import COMPONENTS, ELEVATION, REGULAR, SceneError, Waves, bed_level, load_scene, parse_scene

from .decks import FILES, FULL, PLAIN, swap

# The same bed in both of MoorDyn's forms: 3 x by 2 y
OF_PLACES = "3 2\n-500 0 500.0\n-400 400\n-500 -400 -90\n0 -400 -95\n500 -400 -110\n-500 400 -80\n0 400 -85\n500 400 -100\n"
OF_ROWS = "--- MoorDyn Bathymetry Input File ---\nnGridX 3\nnGridY 2\n     -500 0 500\n-400 90 95 110\n400 80 85 100.0\n"
WATER = """\
MoorDyn Waves and Currents input file
notes
--------------------------- WAVES -------------------------------------
1         WaveKinMod  - type of wave input
"eta.txt" WaveKinFile - file
0.5       dtWave      - s
-90       WaveDir     - deg
2         - X wave input type
-800, 10, 101 - X wave grid point data
0
0
1
-600, 0
--------------------------- CURRENT -------------------------------------
1         CurrentMod  - type
2         - Z wave input type
-600, 0, 50 - Z wave grid point data
z-depth     x-current      y-current
(m)           (m/s)         (m/s)
0.0             0.9          0.1
150             0.5          0.0
1000            0.25         0.0
--------------------- need this line ------------------
"""
ETA = "".join(f"{0.25 * i} {math.sin(0.7 * i):.6f}\n" for i in range(21))


def with_options(*options, text=PLAIN):
    return swap("0        FrictionCoefficient\n", "".join(f"{option}\n" for option in options), text)


def scene_of(text, files):
    return parse_scene(text, "deck.txt", files.items())


def error_of(text, files):
    with pytest.raises(SceneError) as caught:
        scene_of(text, files)
    assert "expected" in caught.value.message and "\n" not in str(caught.value)
    return caught.value


def no_depth(*options):
    return swap("100      WtrDpth  water depth (m)\n", "", with_options(*options))


@pytest.mark.parametrize(
    "text, files",
    [
        (no_depth("bed.txt SeafloorFile"), {"bed.txt": OF_PLACES}),
        (no_depth('"bed.txt" WtrDpth'), {"bed.txt": OF_ROWS}),
        (no_depth("'grids/bed.dat' depth"), {"grids/bed.dat": OF_PLACES}),
        (no_depth("bed.txt SeafloorPath"), {"bed.txt": OF_ROWS.removeprefix("--- MoorDyn Bathymetry Input File ---")}),
    ],
    ids=["C", "F", "C under F's name", "F under C's name, no title"],
)
def test_both_forms_of_bathymetry_give_the_same_bed(text, files):
    environment = scene_of(text, files).environment
    assert environment.bathymetry.x == (-500.0, 0.0, 500.0) and environment.bathymetry.y == (-400.0, 400.0)
    assert environment.bathymetry.depth == ((90.0, 80.0), (95.0, 85.0), (110.0, 100.0))
    assert environment.depth == 90.0


def test_the_bed_is_bilinear_and_beyond_the_grid_that_of_its_edge():
    environment = scene_of(no_depth("bed.txt SeafloorFile"), {"bed.txt": OF_PLACES}).environment
    grid = environment.bathymetry
    inside = RegularGridInterpolator((grid.x, grid.y), -np.array(grid.depth))
    for x, y in np.random.default_rng(3).uniform(-900, 900, (200, 2)):
        assert bed_level(environment, x, y) == pytest.approx(inside((np.clip(x, -500, 500), np.clip(y, -400, 400))).item(), abs=1e-10)


def test_a_depth_beside_a_bathymetry_file_is_said_not_to_count():
    scene = scene_of(with_options("bed.txt SeafloorFile"), {"bed.txt": OF_PLACES})
    assert scene.environment.depth == 90.0
    assert any("WtrDpth is not used: the depth is that of the bathymetry file" in warning for warning in scene.warnings)


def test_anchors_are_set_on_a_grid():
    scene = scene_of(with_options("bed.txt SeafloorFile"), {"bed.txt": OF_PLACES})
    assert scene.point(4).position == pytest.approx((-400.0, 0.0, -86.0))  # from -100 m
    assert scene.point(1).position == (400.0, 0.0, -100.0)  # above the bed, where it was put


@pytest.mark.parametrize(
    "content, line, message",
    [
        (OF_PLACES.replace("3 2\n", "3 2.5\n"), 1, "expected the numbers of x and y (MoorDyn-C), or a title above rows of nGridX"),
        (OF_PLACES.replace("3 2\n", "1 2\n"), 1, "the number of x is '1', expected a whole number from 2"),
        (OF_PLACES.replace("-500 0 500.0", "-500 0"), 2, "2 columns, expected 3 numbers: the x of the grid (m)"),
        (OF_PLACES.replace("-500 0 500.0", "-500 0 0"), 2, "x = 0 follows 0, expected growing numbers"),
        (OF_PLACES.replace("-400 400\n-500", "-400 nan\n-500"), 3, "y is 'nan', expected a number (m)"),
        (OF_PLACES.replace("0 -400 -95", "1 -400 -95"), 5, "x = 1 is no place of the grid, expected one of those in line 2"),
        (OF_PLACES.replace("0 -400 -95", "0 -401 -95"), 5, "y = -401 is no place of the grid, expected one of those in line 3"),
        (OF_PLACES.replace("0 -400 -95", "0 -400 95"), 5, "z of the bed is 95, expected a number < 0 (m): z is up, as MoorDyn-C reads it"),
        (OF_PLACES.replace("0 -400 -95", "0 -400"), 5, "2 columns, expected 3: x y z"),
        (OF_PLACES.replace("0 -400 -95", "-500 -400 -95"), 5, "a second z at x = -500, y = -400, expected one"),
        (OF_PLACES.replace("0 -400 -95\n", ""), 1, "there is no z at x = 0, y = -400, expected one for each place of the grid"),
        ("3 2\n1 2 3\n", 2, "the file ends here, expected a row of x and a row of y"),
        (OF_ROWS.replace("nGridX 3", "nGridX"), 2, "the number of x is missing, expected nGridX and a whole number"),
        (OF_ROWS.replace("nGridY 2", "nGridY 3"), 6, "2 rows of depths, expected 3 (nGridY in line 3)"),
        (OF_ROWS.replace("400 80 85 100.0", "400 80 85"), 6, "3 columns, expected 4: y and 3 depths"),
        (OF_ROWS.replace("400 80 85 100.0", "-400 80 85 100"), 6, "y = -400 follows -400, expected growing numbers"),
        (OF_ROWS.replace("95 110", "-95 110"), 5, "depth is -95, expected a number > 0 (m)"),
        (OF_ROWS.replace("nGridX", "nx"), 1, "expected the numbers of x and y (MoorDyn-C), or a title"),
        ("\n# nothing\n", 0, "the file is empty, expected a bathymetry file"),
    ],
)
def test_an_error_in_a_bathymetry_names_its_own_file_and_line(content, line, message):
    error = error_of(with_options("grids/bed.txt SeafloorFile"), {"grids/bed.txt": content})
    assert (error.file, error.line) == ("grids/bed.txt", line), str(error)
    assert message in error.message


def test_beds_contradict_each_other():
    both = no_depth("bed.txt SeafloorFile", "bed.txt WtrDpth")
    assert "a second bathymetry file" in error_of(both, {"bed.txt": OF_PLACES}).message
    sloped = no_depth("bed.txt SeafloorFile", "0.1 BedSlopeY")
    assert "BedSlopeY is 0.1 beside a bathymetry file, expected one of them" in error_of(sloped, {"bed.txt": OF_PLACES}).message


def test_a_curve_in_a_file_is_checked_there():
    for content, line, message in [
        ("a\nb\nc\n0 0\n0.1 5\n0.05 6\n", 6, "strain 0.05 with tension 6 N follows 0.1 with 5 N, expected both to grow"),
        ("a\nb\nc\n0 0\n0.1 5\n0.2 5\n", 6, "expected both to grow"),
        ("a\nb\nc\n0 1\n0.1 5\n", 4, "expected both to grow"),
        ("a\nb\nc\n-0.1 1\n0.1 5\n", 4, "strain is -0.1, expected a number >= 0"),
        ("a\nb\nc\n0 0\nx 5\n", 5, "strain is 'x', expected a number"),
        ("a\nb\nc\n0 0\n0.1 5 6\n", 5, "3 columns, expected 2: strain (-) tension (N)"),
        ("a\nb\nc\n0.1 5\n", 0, "1 rows of numbers, expected two at least: strain (-) tension (N)"),
        ("a\nb\nc\nd\n0.1 5\n", 4, "1 columns, expected 2"),
    ]:
        error = error_of(FULL, FILES | {"nylon.txt": content})
        assert (error.file, error.line) == ("nylon.txt", line), str(error)
        assert message in error.message


def test_rows_that_moordyn_would_skip_are_read_and_said():
    scene = scene_of(FULL, FILES | {"nylon.txt": "0 0\n0.1 5e5\n0.2 2e6\n0.3 4e6\n"})
    assert len(scene.line_types[3].curve) == 4
    assert any("nylon.txt:1: numbers in the first 3 lines are read here, MoorDyn would skip them" in warning for warning in scene.warnings)


def test_a_current_profile_may_fall_and_must_not_turn():
    down = "a\nb\nc\n0, 1, 0, 0\n-50, 0.5, 0, 0\n-100, 0.1, 0, 0.01\n"
    profile = scene_of(FULL, FILES | {"current_profile.txt": down}).environment.current_profile
    assert profile == ((-100.0, 0.1, 0.0, 0.01), (-50.0, 0.5, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0))
    error = error_of(FULL, FILES | {"current_profile.txt": down + "-90 0 0 0\n"})
    assert error.file == "current_profile.txt" and "stands next to" in error.message


def test_moordyn_c_elevations_are_sampled_in_its_steps():
    waves = scene_of(with_options("3 WaveKin", "0.5 dtWave"), {"wave_elevation.txt": ETA}).environment.waves
    assert waves.kind == ELEVATION and waves.direction == 0.0
    assert waves.elevation == tuple((0.5 * i, float(f"{math.sin(1.4 * i):.6f}")) for i in range(10))  # the last of 11 is dropped
    quarter = scene_of(with_options("3 WaveKin"), {"wave_elevation.txt": ETA}).environment.waves
    assert quarter.elevation[:3] == waves.elevation[:1] + ((0.25, 0.644218), waves.elevation[1]) and len(quarter.elevation) == 20


def test_moordyn_f_water_kinematics_are_read():
    scene = scene_of(with_options('"water.dat" WaterKin'), {"water.dat": WATER, "eta.txt": "t eta\n(s) (m)\n" + ETA})
    waves = scene.environment.waves
    assert (waves.kind, waves.direction) == (ELEVATION, math.radians(-90))
    assert waves.elevation[1] == (0.5, 0.98545)
    assert scene.environment.current_profile == ((-1000.0, 0.25, 0.0, 0.0), (-150.0, 0.5, 0.0, 0.0), (0.0, 0.9, 0.1, 0.0))
    assert any("wave grid in 'water.dat' is not used" in warning for warning in scene.warnings)
    assert any("taken as depths" in warning for warning in scene.warnings)
    assert [name for name, _ in scene.files] == ["water.dat", "eta.txt"]


@pytest.mark.parametrize(
    "old, new, line, message",
    [
        ("1         WaveKinMod", "2         WaveKinMod", 4, "WaveKinMod is '2', expected 0 (no waves) or 1 (from an elevation)"),
        ("1         CurrentMod", "2         CurrentMod", 15, "CurrentMod is '2', expected 0 (no current) or 1 (a steady profile)"),
        ('"eta.txt"', '""', 5, 'WaveKinFile is "", expected the name of a file'),
        ('"eta.txt"', '"other.txt"', 5, "the file 'other.txt' is not among the recorded files"),
        ("0.5       dtWave", "0       dtWave", 6, "dtWave is 0, expected a number > 0 (s)"),
        ("150             0.5          0.0", "150  0.5", 21, "'150 0.5' stands in the table of the current, expected 3 numbers"),
        ("150             0.5", "-150             0.5", 15, "z above and below 0"),
        ("-- CURRENT --", "-- FLOW --", 1, "there is no part CURRENT"),
    ],
)
def test_what_is_wrong_in_moordyn_f_water_kinematics_is_said_there(old, new, line, message):
    error = error_of(with_options("water.dat WaterKin"), {"water.dat": swap(old, new, WATER), "eta.txt": ETA})
    assert (error.file, error.line) == ("water.dat", line), str(error)
    assert message in error.message


def test_moordyn_c_wave_components_are_the_same_sea():
    content = "0.0 0.0 0.0\n0.35 1.0 0.0 0.6\n0.4 0.0 2.0 0.6\n0.5 0 0 3\n0.6 -0.3 0.4 0.6\n"
    waves = scene_of(with_options("7 WaveKin"), {"wave_frequencies.txt": content}).environment.waves
    assert (waves.kind, waves.direction) == (COMPONENTS, 0.6)
    t, s, k = np.linspace(0, 100, 57), 3.7, 0.02
    theirs = sum(abs(a) * np.sin(w * t - k * s + np.angle(a)) for w, a in ((0.35, 1.0), (0.4, 2j), (0.6, -0.3 + 0.4j)))
    ours = sum(a * np.cos(w * t - k * s - phase) for w, a, phase in waves.spectrum)
    assert ours == pytest.approx(theirs, abs=1e-12)
    for bad, message in [
        ("0.35 1 0 0\n0.4 1 0 0.1\n", "direction is 0.1 after 0 in line 1, expected one direction"),
        ("0 1 0\n0.4 1 0\n", "the component of frequency 0 has the amplitude 1 m, expected 0"),
        ("0 0 0\n0.4 0 0\n", "holds no wave"),
        ("0.4 1\n", "2 columns, expected 3 or 4"),
        ("-0.4 1 0\n", "frequency is -0.4, expected a number >= 0 (rad/s)"),
    ]:
        assert message in error_of(with_options("7 WaveKin"), {"wave_frequencies.txt": bad}).message


@pytest.mark.parametrize("height, period, breaks", [(2, 8, False), (3.5, 4, False), (3.7, 4, True), (2, 0.8, True), (77, 40, False), (79, 40, True)])
@pytest.mark.parametrize("model", ["regular", "jonswap"])
def test_waves_that_no_sea_has_are_warned_of(model, height, period, breaks):
    """Steeper than 1 to 7: 3.57 m at 4 s; higher than 0.78 of the depth of 100 m."""
    found = scene_of(with_options(f"{model} WaveModel", f"{height} WaveHeight", f"{period} WavePeriod"), {}).warnings
    assert sum(f"waves of {height:g} m and {period:g} s in 100 m of water would break" in warning for warning in found) == breaks


def test_own_seas_are_read():
    options = ("Regular WaveModel", "2 WaveHeight", "8 WavePeriod", "90 WavePhase", "45 WaveDirection", "5 WaveRamp")
    regular = scene_of(with_options(*options), {}).environment.waves
    assert regular == Waves(REGULAR, 2.0, 8.0, math.radians(45), phase=math.radians(90), ramp=5.0)
    given = scene_of(with_options("elevation WaveModel", "eta.txt WaveElevationFile", "180 WaveDirection"), {"eta.txt": ETA}).environment.waves
    assert (given.kind, given.direction, len(given.elevation), given.elevation[1]) == (ELEVATION, math.pi, 21, (0.25, 0.644218))
    assert scene_of(with_options("none WaveModel"), {}).environment.waves is None


def test_options_that_the_sea_does_not_use_are_said():
    scene = scene_of(with_options("regular WaveModel", "2 WaveHeight", "8 WavePeriod", "3 WaveGamma", "0.1 dtWave"), {})
    assert sum("it does not belong to the waves of this scene" in warning for warning in scene.warnings) == 2
    calm = scene_of(with_options("10 waveKin_rampT"), {})
    assert any("waveKin_rampT is not used: there are no waves in this scene" in warning for warning in calm.warnings)


@pytest.mark.parametrize(
    "content, line, message",
    [
        ("0 0\n1 1\n2 0\n4 1\n", 2, "time is 1, expected 1.33333333 (s): evenly spaced times"),
        ("1 0\n2 1\n3 0\n4 1\n", 1, "time is 1, expected the first to be 0 (s)"),
        ("0 0\n1 1\n1 0\n4 1\n", 3, "time 1 follows 1, expected growing times (s)"),
        ("0 0\n1 1\n2 0\n", 3, "the wave elevation has 3 samples, expected 4 at least"),
        ("0 0\n1 inf\n2 0\n3 0\n", 2, "elevation is 'inf', expected a number (m)"),
    ],
)
def test_an_elevation_is_checked_in_its_file(content, line, message):
    error = error_of(with_options("elevation WaveModel", "eta.txt WaveElevationFile"), {"eta.txt": content})
    assert (error.file, error.line) == ("eta.txt", line), str(error)
    assert message in error.message


def test_seas_contradict_each_other():
    text = with_options("7 WaveKin", "regular WaveModel", "2 WaveHeight", "8 WavePeriod")
    assert "WaveModel gives waves beside WaveKin (line" in error_of(text, {"wave_frequencies.txt": "0.4 1 0\n"}).message
    text = with_options("water.dat WaterKin", "1 Currents")
    files = {"water.dat": WATER, "eta.txt": ETA, "current_profile.txt": FILES["current_profile.txt"]}
    assert "Currents is 1 beside the current of WaterKin" in error_of(text, files).message


def test_a_scene_with_its_files_is_read_again_without_the_disk(tmp_path):
    folder = tmp_path / "scenes"
    folder.mkdir()
    (folder / "deck.txt").write_text(FULL)
    for name, content in FILES.items():
        (folder / name).write_text(content)
    scene = load_scene(folder / "deck.txt")
    assert scene.files == (("nylon.txt", FILES["nylon.txt"]), ("current_profile.txt", FILES["current_profile.txt"]))
    for name in FILES:
        os.remove(folder / name)
    assert parse_scene(scene.text, scene.path, scene.files) == scene
    with pytest.raises(SceneError, match="the file 'nylon.txt': there is no such file"):
        load_scene(folder / "deck.txt")
    with pytest.raises(SceneError, match="the file 'current_profile.txt' is not among the recorded files"):
        parse_scene(scene.text, scene.path, scene.files[:1])


def test_files_lie_where_the_scene_says_from_its_own_place(tmp_path):
    (tmp_path / "scenes").mkdir()
    (tmp_path / "beds").mkdir()
    (tmp_path / "beds" / "bed.txt").write_text(OF_PLACES)
    path = tmp_path / "scenes" / "deck.txt"
    path.write_text(with_options("../beds/bed.txt SeafloorFile"))
    scene = load_scene(path)
    assert scene.environment.depth == 90.0 and scene.files == (("../beds/bed.txt", OF_PLACES),)
    path.write_text(with_options("..\\beds\\bed.txt SeafloorFile"))
    assert load_scene(path).environment == scene.environment
    (tmp_path / "beds" / "bed.txt").write_bytes(b"3 2\n\xff\n")
    with pytest.raises(SceneError, match=r"beds/bed.txt:2: byte 0xFF is not UTF-8 text, expected a bathymetry file"):
        load_scene(path)


def test_only_regular_files_of_bounded_size_are_read(tmp_path):
    path = tmp_path / "deck.txt"
    path.write_text(with_options("bed.txt SeafloorFile"))
    os.mkfifo(tmp_path / "bed.txt")
    with pytest.raises(SceneError, match=r"deck.txt:\d+: the file 'bed.txt': is no regular file, expected a bathymetry file"):
        load_scene(path)
    os.remove(tmp_path / "bed.txt")
    with open(tmp_path / "bed.txt", "wb") as file:
        file.truncate(17 * 2**20)
    with pytest.raises(SceneError, match=r"the file 'bed.txt': is larger than 16 MiB"):
        load_scene(path)
    assert "not a text file" in error_of(with_options("bed.txt SeafloorFile"), {"bed.txt": "3 2\n\0"}).message


def test_the_bed_is_that_of_moordyn(tmp_path, monkeypatch):
    moordyn = pytest.importorskip("moordyn")
    monkeypatch.chdir(tmp_path)  # MoorDyn-C looks for the file from where it runs
    (tmp_path / "bed.txt").write_text(OF_PLACES)
    (tmp_path / "deck.txt").write_text(with_options("bed.txt SeafloorFile").replace("7  rope", "3  rope"))
    environment = load_scene("deck.txt").environment
    system = moordyn.Create("deck.txt")
    try:
        bed = moordyn.GetSeafloor(system)
        for x, y in np.random.default_rng(1).uniform(-900, 900, (100, 2)):
            assert bed_level(environment, x, y) == pytest.approx(moordyn.GetDepthAt(bed, x, y), abs=1e-9)
    finally:
        moordyn.Close(system)
