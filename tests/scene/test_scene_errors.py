"""What is wrong with a file is said with file, line and what was expected."""

import copy
import os
import pickle
import re

import pytest

from mooring_ros.scene import SceneError, load_scene, parse_scene

from .decks import PLAIN, line_of, swap

# (old, new, words of the message): the error belongs to the line in which the old text stood.
CHANGES = [
    # numbers
    ("0.0766 ", "abc ", "diameter is 'abc', expected a number > 0 (m)"),
    ("0.0766 ", "0 ", "diameter is 0, expected a number > 0"),
    ("0.0766 ", "-0.07 ", "diameter is -0.07, expected"),
    ("113.35", "nan", "mass is 'nan', expected a number > 0 (kg/m)"),
    ("113.35", "NaN", "mass is 'NaN', expected"),
    ("113.35", "inf", "mass is 'inf', expected"),
    ("113.35", "1e999", "mass is 1e999, expected"),
    ("113.35", "1e-300", "mass is 1e-300, expected"),
    ("113.35", "0x71", "mass is '0x71', expected"),
    ("113.35", "1_000", "mass is '1_000', expected"),
    ("113.35", "113,35", "mass is '113,35', expected"),
    ("113.35", "١١٣", "mass is '١١٣', expected"),
    ("113.35", "1.0e", "mass is '1.0e', expected"),
    ("113.35", "--1", "mass is '--1', expected"),
    ("7.536e8 ", "0.0 ", "stiffness EA is 0.0, expected a number > 0 (N)"),
    ("7.536e8 ", "4e8|3.4e8 ", "stiffness EA is '4e8|3.4e8', expected EA_S|EA_D with 0 < EA_S < EA_D (N)"),
    ("7.536e8 ", "0|3.4e8 ", "stiffness EA is '0|3.4e8', expected EA_S|EA_D with 0 < EA_S < EA_D (N)"),
    ("7.536e8 ", "3e8|x ", "stiffness EA is 'x', expected a number >= 0 (N)"),
    ("7.536e8 ", "3e8| ", "stiffness EA is '', expected a number"),
    ("7.536e8 ", "3e8|4e8|0.3 ", "expected EA_S|EA_D: a stiffness that depends on the load (EA_S|a|b) is not modelled"),
    ("7.536e8 ", "SYROPE:owc.txt|1|2 ", "expected a number, a file or EA_S|EA_D: Syrope working curves are not modelled"),
    ("7.536e8  -1.0 ", "3e8|4e8  -1.0 ", "damping BA of a viscoelastic line is -1.0, expected a number >= 0 (N s)"),
    ("7.536e8  -1.0 ", "3e8|4e8  0|0 ", "damping BA is '0|0', expected BA_S|BA_D (N s), one of them > 0"),
    ("7.536e8  -1.0 ", "3e8|4e8  1|2|3 ", "damping BA of a viscoelastic line is '1|2|3', expected 1 or 2 numbers separated by |"),
    ("7.536e8 ", "curve.txt ", "the file 'curve.txt': there is no such file, expected a load-strain curve"),
    ("7.536e8 ", "curve ", "stiffness EA is 'curve', expected a number > 0 (N) or the name of a file such as curve.txt"),
    ("-1.0     0 ", "-1|1e5     0 ", "damping BA is '-1|1e5', expected one number, because the stiffness EA is not given as EA_S|EA_D"),
    ("-1.0     0 ", "ba.txt     0 ", "damping BA is the file 'ba.txt', expected a number: damping curves are not modelled"),
    ("-1.0     0 ", "x     0 ", "damping BA/-zeta is 'x', expected a number"),
    ("-1.0     0 ", "-1.0     -5 ", "bending stiffness EI is -5, expected a number >= 0"),
    ("-1.0     0 ", "-1.0     ei/table.dat ", "bending stiffness EI is 'ei/table.dat', expected a number >= 0 (N m^2): moment-curvature"),
    ("2.0  0.8  0.4   0.25", "-2.0  0.8  0.4   0.25", "drag coefficient Cd is -2.0, expected a number >= 0"),
    ("2.0  0.8  0.4   0.25", "2.0  -1  0.4   0.25", "added mass coefficient Ca is -1"),
    ("2.0  0.8  0.4   0.25", "2.0  0.8  -1   0.25", "axial drag coefficient CdAx is -1"),
    ("2.0  0.8  0.4   0.25", "2.0  0.8  0.4   -1", "axial added mass coefficient CaAx is -1"),
    ("2.0  0.8  0.4   0.25", "2.0  0.8  0.4", "9 columns, expected 10: Name Diam"),
    ("2.0  0.8  0.4   0.25", "2.0  0.8  0.4 0.25 0.6", "Cl is 0.6, expected 0: vortex-induced vibration is not modelled"),
    ("2.0  0.8  0.4   0.25", "2.0  0.8  0.4 0.25 0 0 0 0", "14 columns, expected 10"),
    ("rope   0.15", "chain   0.15", "a second line type 'chain' (the first is in line 5)"),
    # points
    ("1  Fixed    400.0", "0  Fixed    400.0", "point ID is '0', expected a whole number from 1"),
    ("1  Fixed    400.0", "-1  Fixed    400.0", "point ID is '-1', expected"),
    ("1  Fixed    400.0", "1.0  Fixed    400.0", "point ID is '1.0', expected"),
    ("1  Fixed    400.0", "P1  Fixed    400.0", "point ID is 'P1', expected"),
    ("2  Vessel", "1  Vessel", "a second point 1 (the first is in line 13)"),
    ("2  Vessel", "2  Vesel", "point type is 'Vesel', expected Fixed, Coupled, Free or Body1 (did you mean Vessel?)"),
    ("2  Vessel", "2  Body1", "point2 is attached to body 1, which does not exist, expected one of the IDs in the section BODIES"),
    ("2  Vessel", "2  Rod1", "attached to 'Rod1', expected Fixed, Coupled, Free or Body1: points on rods and turbines are not modelled"),
    ("2  Vessel", "2  Turbine1", "attached to 'Turbine1', expected"),
    ("0.0   -12.5", "0.0   seabed", "z is 'seabed' at a coupled point, expected a number (m): only fixed and free points can stand on the bed"),
    ("-150   5 ", "-150   five ", "y is 'five', expected a number (m)"),
    ("2.0e3 0.5", "-2.0e3 0.5", "mass is -2.0e3, expected a number >= 0 (kg)"),
    ("2.0e3 0.5", "2.0e3 -0.5", "volume is -0.5, expected a number >= 0 (m^3)"),
    ("1.5  0.9\n", "-1.5  0.9\n", "drag area CdA is -1.5, expected"),
    ("1.5  0.9\n", "1.5    -0.9\n", "added mass coefficient Ca is -0.9, expected"),
    ("1.5  0.9\n", "1.5\n", "8 columns, expected 9: ID Type X Y Z Mass Volume CdA Ca"),
    ("1.5  0.9\n", "0 0 5.0 1.5 0.9\n", "force in z is 5.0, expected 0: constant forces on points are not modelled"),
    ("10     0.0   -12.5", "10     0.0   -112.5", "coupled point 2 at z = -112.5 m is below the bed, expected z >= -100 m there"),
    ("5     -60 ", "5     -160 ", "free point 3 at z = -160 m is below the bed"),
    ("--- LINES ---", "6 Free 0 0 0 0 0 0 0\n--- LINES ---", "free point 6 carries no line, expected one at least"),
    # lines
    ("1  chain    1 ", "1  chainn    1 ", "unknown line type 'chainn', expected chain"),
    ("1  chain    1 ", "1  xyz    1 ", "unknown line type 'xyz', expected one of chain, rope"),
    ("1  chain    1 ", "1  Chain    1 ", "unknown line type 'Chain', expected chain"),
    ("2  chain    4 ", "1  chain    4 ", "a second line 1 (the first is in line 21)"),
    ("2  chain    4 ", "two  chain    4 ", "line ID is 'two', expected"),
    ("1  chain    1       2 ", "1  chain    9       2 ", "end A is attached to point 9, which does not exist"),
    ("1  chain    1       2 ", "1  chain    1       9 ", "end B is attached to point 9, which does not exist"),
    ("1  chain    1       2 ", "1  chain    1       0 ", "end B is attached to point 0, which does not exist"),
    ("1  chain    1       2 ", "1  chain    1       1 ", "both ends are attached to point 1, expected two different places"),
    ("1  chain    1       2 ", "1  chain    R1A       2 ", "end A is attached to rod 1, which does not exist, expected one of the IDs"),
    ("1  chain    1       2 ", "1  chain    Rod1       2 ", "end A is attached to 'Rod1', expected Rod1A or Rod1B: the end of the rod is missing"),
    ("1  chain    1       2 ", "1  chain    1.0       2 ", "end A is attached to '1.0', expected a point ID"),
    ("1  chain    1       2 ", "1  chain    -       2 ", "end A is attached to '-', expected a point ID"),
    ("420.5    20", "0    20", "unstretched length is 0, expected a number > 0 (m)"),
    ("420.5    20", "-420.5    20", "unstretched length is -420.5, expected"),
    ("420.5    20", "420.5    0", "number of segments is '0', expected a whole number from 1 to 100000"),
    ("420.5    20", "420.5    2.5", "number of segments is '2.5', expected"),
    ("420.5    20", "420.5    -3", "number of segments is '-3', expected"),
    ("420.5    20", "420.5    1000000", "number of segments is '1000000', expected"),
    ("420.5    20      pt", "420.5", "5 columns, expected 7: ID LineType AttachA AttachB UnstrLen NumSegs Outputs"),
    ("AttachA AttachB UnstrLen NumSegs", "UnstrLen NumSegs NodeAnch NodeFair", "columns in the order of MoorDyn v1"),
    ("Cd   Ca   CdAx  CaAx", "Can  Cat   Cdn  Cdt", "columns in the order of MoorDyn v1"),
    # options
    ("9.81     g ", "-9.81     g ", "g is -9.81, expected a number >= 0 (m/s^2)"),
    ("1000     rhoW", "-1     rhoW", "rhoW is -1, expected a number >= 0"),
    ("2.0e6    kBot", "-1    kBot", "kBot is -1, expected a number >= 0 (Pa/m)"),
    ("2.0e5    cBot", "x    cBot", "cBot is 'x', expected a number >= 0 (Pa s/m)"),
    ("100      WtrDpth", "0      WtrDpth", "WtrDpth is 0, expected a number > 0 (m)"),
    ("100      WtrDpth", "bed.txt      WtrDpth", "the file 'bed.txt': there is no such file, expected a bathymetry file"),
    ("100      WtrDpth", "tests      WtrDpth", "the file 'tests': is a directory, expected a bathymetry file"),
    ("100      WtrDpth", "default      WtrDpth", "the water depth is missing, expected an option like '200 WtrDpth'"),
    ("0.3      CurrentX", "nan      CurrentX", "CurrentX is 'nan', expected a number (m/s)"),
    ("0.001    dtM", "fast    dtM", "dtM is 'fast', expected a number (s)"),
    ("0.001    dtM", "0.001    dtMax", "unknown option 'dtMax', expected dtM or another option of MoorDyn"),
    ("0.001    dtM", "0.001    frobnicate", "unknown option 'frobnicate', expected one of "),
    ("0.001    dtM", "dtM    0.001", "'dtM' stands before its value, expected '0.001 dtM'"),
    ("0.001    dtM      time step", "0.001", "'0.001' stands alone, expected a value and the name of an option"),
    ("0.001    dtM", "9.8    gravity", "a second value for g (the first is in line"),
    ("0.001    dtM", "9.8    G", "a second value for g"),
    ("0        FrictionCoefficient", "-0.5        FrictionCoefficient", "FrictionCoefficient is -0.5, expected a number >= 0"),
    ("0        FrictionCoefficient", "0.5        MU_KX", "unknown option 'MU_KX', expected mu_k"),
    ("0        FrictionCoefficient", "glue        FrictionModel", "FrictionModel is 'glue', expected saturated or stick"),
    ("0        FrictionCoefficient", "cubic        BendingModel", "BendingModel is 'cubic', expected angle or paper"),
    ("0        FrictionCoefficient", "1        WaveKin", "WaveKin is '1', expected 0 or 3 or 7: waves set from outside are not modelled"),
    ("0        FrictionCoefficient", "2        WaveKin", "WaveKin is '2', expected 0 or 3 or 7: kinematics from a grid"),
    ("0        FrictionCoefficient", "3        WaveKin", "the file 'wave_elevation.txt': there is no such file, expected a wave elevation"),
    ("0        FrictionCoefficient", "7        WaveKin", "the file 'wave_frequencies.txt': there is no such file, expected wave components"),
    ("0        FrictionCoefficient", "1        Currents", "the file 'current_profile.txt': there is no such file, expected a steady current profile"),
    ("0        FrictionCoefficient", "2        Currents", "Currents is '2', expected 0 or 1: currents that change in time are not modelled"),
    ("0        FrictionCoefficient", "x        Currents", "Currents is 'x', expected 0 or 1"),
    ("0        FrictionCoefficient", "SEASTATE        WaterKin", "WaterKin is 'SEASTATE', expected the name of a file or nothing"),
    ("0        FrictionCoefficient", "water.dat        WaterKin", "the file 'water.dat': there is no such file, expected a water kinematics"),
    ("0        FrictionCoefficient", "bed.txt        SeafloorFile", "the file 'bed.txt': there is no such file, expected a bathymetry file"),
    ("0        FrictionCoefficient", "rough        WaveModel", "WaveModel is 'rough', expected regular or jonswap or elevation or none"),
    ("0        FrictionCoefficient", "jonswap        WaveModel", "the sea is jonswap without WaveHeight, expected an option like '8 WaveHeight'"),
    ("0        FrictionCoefficient", "elevation        WaveModel", "the sea is elevation without WaveElevationFile, expected an option"),
    ("0        FrictionCoefficient", "8        WavePeriod", "WavePeriod stands without WaveModel, expected an option like 'jonswap WaveModel'"),
    ("0        FrictionCoefficient", "0.5        WaveGamma", "WaveGamma is 0.5, expected a number >= 1"),
    ("0        FrictionCoefficient", "1.5        WaveSeed", "WaveSeed is '1.5', expected a whole number from 0 to 999999999"),
    ("0        FrictionCoefficient", "0        WaveComponents", "WaveComponents is '0', expected a whole number from 1 to 10000"),
    # sections
    ("--- OUTPUTS ---", "--- OUTPUTZ ---", "unknown section 'OUTPUTZ', expected OUTPUT"),
    ("--- OUTPUTS ---", "--- WEATHER ---", "unknown section 'WEATHER', expected one of LINE TYPES, POINTS, LINES, OPTIONS"),
    ("--- OUTPUTS ---", "--- POINTS ---", "a second section POINTS (the first is in line 10)"),
    ("--- OUTPUTS ---", "--- POINTS AND LINES ---", "names several sections (LINES, POINTS), expected one"),
    ("--- LINE TYPES ---", "--- LINE TYPS ---", "unknown section 'LINE TYPS', expected LINE TYPES"),
]


def error_of(text, path="deck.txt"):
    with pytest.raises(SceneError) as caught:
        parse_scene(text, path)
    assert str(caught.value).count("\n") == 0
    return caught.value


@pytest.mark.parametrize("old, new, message", CHANGES, ids=lambda value: str(value)[:40])
def test_an_error_names_its_line_and_what_was_expected(old, new, message):
    error = error_of(swap(old, new))
    line = PLAIN[: PLAIN.index(old)].count("\n") + 1
    assert (error.file, error.line) == ("deck.txt", line)
    assert message in error.message
    assert "expected" in error.message
    assert str(error) == f"deck.txt:{line}: {error.message}"


@pytest.mark.parametrize("section", ["EXTERNAL LOADS", "SYROPE"])
def test_a_section_that_is_not_modelled_may_be_empty_and_is_refused_at_its_first_row(section):
    text = re.sub("--- ROD TYPES ---", f"--- {section} ---", PLAIN)
    parse_scene(text)
    error = error_of(swap("(name) (m) (kg/m) (-) (-) (-) (-)", "(name) (m)\n\n1 main 1,2 12 0\n2 x 1 2 3", text))
    assert error.line == line_of(PLAIN, "(name)") + 2
    assert f"the section {section} has rows, expected none" in error.message


@pytest.mark.parametrize("end", ["--- need this line ---", "END"])
def test_what_follows_the_end_of_a_section_is_not_dropped(end):
    error = error_of(swap(end + "\n", end + "\n8 chain 1 2 100 10 -\n"))
    assert error.line == line_of(PLAIN, end) + 1
    assert "stands after the end of a section" in error.message


@pytest.mark.parametrize("section", ["LINE TYPES", "POINTS", "LINES", "OPTIONS"])
def test_a_section_that_is_missing_is_named(section):
    error = error_of(re.sub(rf"(?ms)^--- {section} ---\n.*?(?=^---)", "", PLAIN))
    assert str(error) == (
        f"deck.txt: no section {section}, expected a MoorDyn v2 input file with the sections LINE TYPES, POINTS, LINES and OPTIONS"
    )


def test_a_scene_without_lines_is_refused():
    error = error_of(re.sub(r"(?m)^[127]  (chain|rope) +[1-9P].*\n", "", PLAIN))
    assert error.line == line_of(PLAIN, "--- LINES")
    assert "the section LINES has no rows, expected one line at least" in error.message


def test_a_scene_without_depth_is_refused():
    error = error_of(swap("100      WtrDpth  water depth (m)\n", ""))
    assert error.line == line_of(PLAIN, "--- OPTIONS")
    assert "the water depth is missing" in error.message


def test_lines_that_nothing_holds_are_refused():
    text = swap("--- LINES ---", "6 Free 0 0 0 0 0 0 0\n8 Free 9 0 0 0 0 0 0\n--- LINES ---")
    text = swap("7  rope     Point3", "9 rope 6 8 10 2 -\n7  rope     Point3", text)
    error = error_of(text)
    assert error.line == line_of(PLAIN, "5  Coupled") + 1
    assert "free point 6 is held by nothing" in error.message


def test_the_first_of_several_errors_is_reported():
    assert error_of(PLAIN.replace("0.0766", "x").replace("420.5", "y").replace("9.81", "z")).line == 5


def test_what_is_no_scene_file_is_refused(tmp_path):
    def message(content=None):
        path = tmp_path / "deck.txt"
        if content is not None:
            path.write_bytes(content)
        with pytest.raises(SceneError) as caught:
            load_scene(path)
        return str(caught.value).removeprefix(str(path))

    assert message() == ": there is no such file, expected a MoorDyn v2 input file"
    assert message(b"") == ": the file is empty, expected a MoorDyn v2 input file"
    assert message(b" \r\n# only a comment\n") == ": the file is empty, expected a MoorDyn v2 input file"
    assert message(b"some words\nand others\n").startswith(": no section LINE TYPES, expected")
    assert message(b"\n\n\x00\x01") == ":3: not a text file, expected a MoorDyn v2 input file"
    assert message(b"one\ntwo \xb2\n") == ":2: byte 0xB2 is not UTF-8 text, expected a MoorDyn v2 input file saved as UTF-8"
    assert message("deck".encode("utf-16")).startswith(":1: byte 0xFF is not UTF-8 text")


def test_what_is_no_file_is_refused(tmp_path):
    with pytest.raises(SceneError, match="is a directory, expected a MoorDyn v2 input file"):
        load_scene(tmp_path)
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(SceneError, match="is no regular file, expected"):
        load_scene(tmp_path / "pipe")
    with pytest.raises(SceneError):
        load_scene("a\0b")


def test_errors_survive_copying():
    error = error_of(swap("420.5", "x"))
    for other in (pickle.loads(pickle.dumps(error)), copy.copy(error)):
        assert (str(other), other.file, other.line, other.message) == (str(error), error.file, error.line, error.message)
    assert isinstance(error, ValueError)
