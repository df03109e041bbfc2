"""What the reader makes of a file that is right, however it is written."""

import copy
import dataclasses
import pickle
import random
import re
from pathlib import Path

import pytest

from mooring_ros.scene import COUPLED, FIXED, FREE, Environment, Line, LineType, Point, load_scene, parse_scene
from mooring_ros.scene.options import FATES

from .decks import PLAIN, line_of, swap

PAGE = Path(__file__).parents[2] / "docs" / "scene.md"


def parts(scene):
    """All of a scene but its text, where it stood in the file, and its warnings."""
    def unplaced(items):
        return tuple(dataclasses.replace(item, source_line=0) for item in items)

    lines = tuple(dataclasses.replace(line, source_line=0, type=dataclasses.replace(line.type, source_line=0)) for line in scene.lines)
    return unplaced(scene.line_types), unplaced(scene.points), lines, scene.environment, dict(scene.options)


def test_every_column_lands_in_its_field():
    scene = parse_scene(PLAIN, "deck.txt")
    chain, rope = scene.line_types
    assert chain == LineType("chain", 0.0766, 113.35, 7.536e8, -1.0, 0.0, 2.0, 0.8, 0.4, 0.25, source_line=5)
    assert rope == LineType("rope", 0.15, 20.5, 3.0e7, 1.0e5, 0.0, 1.6, 1.0, 0.1, 0.0, source_line=6)
    assert scene.points == (
        Point(1, FIXED, (400.0, 0.0, -100.0), source_line=13),
        Point(2, COUPLED, (10.0, 0.0, -12.5), source_line=14),
        Point(3, FREE, (-150.0, 5.0, -60.0), 2000.0, 0.5, 1.5, 0.9, source_line=15),
        Point(4, FIXED, (-400.0, 0.0, -100.0), source_line=16),
        Point(5, COUPLED, (-10.0, 0.0, -12.5), source_line=17),
    )
    assert scene.lines == (
        Line(1, chain, 1, 2, 420.5, 20, source_line=21),
        Line(2, chain, 4, 3, 270.0, 15, source_line=22),
        Line(7, rope, 3, 5, 150.0, 10, source_line=23),
    )
    assert scene.environment == Environment(100.0, 9.81, 1000.0, 2.0e6, 2.0e5, (0.3, -0.1, 0.0))
    assert scene.options == {"dtM": 0.001, "FrictionCoefficient": 0.0}
    assert [line.name for line in scene.lines] == ["line1", "line2", "line7"]
    assert scene.point(3).name == "point3"
    with pytest.raises(KeyError):
        scene.point(6)


def test_what_is_not_used_is_said_with_its_line():
    scene = parse_scene(PLAIN, "deck.txt")
    step, outputs = scene.warnings
    assert step.startswith(f"deck.txt:{line_of(PLAIN, '0.001')}: the option dtM is not used: ")
    assert outputs.startswith(f"deck.txt:{line_of(PLAIN, '--- OUTPUTS')}: ")


def test_options_that_are_not_used_for_one_reason_share_a_warning():
    text = PLAIN.replace("--- OPTIONS ---\n", "--- OPTIONS ---\n100 TmaxIC\n0.5 dtIC\n4 CdScaleIC\n")
    first = line_of(text, "100 TmaxIC")
    found = [warning for warning in parse_scene(text, "deck.txt").warnings if "IC" in warning]
    assert len(found) == 1
    assert found[0].startswith(f"deck.txt:{first}: the options TmaxIC, dtIC (line {first + 1}), CdScaleIC (line {first + 2}) are not used: the initial state")


def test_environment_defaults_are_those_of_moordyn():
    text = re.sub(r"(?s)--- OPTIONS.*", "--- OPTIONS ---\n100 WtrDpth\n", PLAIN)
    assert parse_scene(text).environment == Environment(100.0, 9.80665, 1025.0, 3.0e6, 3.0e5, (0.0, 0.0, 0.0))
    assert parse_scene(text + "default g\nDEFAULT kb\n").environment == parse_scene(text).environment


def _shuffled(text):
    head, *sections = re.split(r"(?m)^(?=--- )", text)
    sections = [section for section in sections if "need this" not in section]
    random.Random(4).shuffle(sections)
    return head + "".join(sections)


VARIANTS = {
    "CRLF": PLAIN.replace("\n", "\r\n"),
    "CR": PLAIN.replace("\n", "\r"),
    "byte order mark": "\ufeff" + PLAIN,
    "tabs": re.sub(r" +", "\t", PLAIN).replace("---\t", "--- ").replace("\t---", " ---"),
    "wide spaces and no-break spaces": re.sub(r" ", " \u00a0 ", PLAIN),
    "indented": re.sub(r"(?m)^", "   ", PLAIN),
    "blank lines": PLAIN.replace("\n", "\n\n \t\n"),
    "comment lines": PLAIN.replace("\n", "\n# one\n  ! two\n// three 1 2 3\n%four\n"),
    "trailing comments": re.sub(r"(?m)^(\d.*)$", r"\1  # 4 Fixed 0 0 0", PLAIN),
    "no end": PLAIN.replace("END\n--- need this line ---\n", ""),
    "no newline at the end": PLAIN.rstrip("\n"),
    "upper case": PLAIN.upper().replace("CHAIN", "chain").replace("ROPE", "rope"),
    "lower-case headings": re.sub(r"(?m)^---.*$", lambda match: match.group().lower(), PLAIN),
    "long headings": re.sub(r"(?m)^--- (.*) ---$", r"------------------ \1 (all of them) -------", PLAIN),
    "shuffled sections": _shuffled(PLAIN),
    "other names of the sections": swap("--- LINES ---", "--- LINE PROPERTIES ---", swap("--- OPTIONS ---", "--- SOLVER OPTIONS ---")),
    "connections": PLAIN.replace("--- POINTS ---", "--- CONNECTION PROPERTIES ---"),
    "point properties": PLAIN.replace("--- POINTS ---", "--- POINT PROPERTIES ---"),
    "line dictionary": PLAIN.replace("--- LINE TYPES ---", "--- LINE DICTIONARY ---"),
    "a heading of the file": "--- MoorDyn Input File ---\nFALSE Echo\n" + PLAIN,
    "no columns of outputs": PLAIN.replace("20      pt", "20").replace("10      p t", "10"),
    "Fortran exponents": PLAIN.replace("7.536e8", "7.536d8").replace("2.0e6", "2.0D+06"),
    "signs and bare points": PLAIN.replace("420.5", "+420.5").replace("100      WtrDpth", "100. WtrDpth").replace("0.9\n", ".9\n"),
    "the older columns of points": re.sub(r"(?m)^(\d  (?:Fixed|Vessel|Free|Coupled) .*?) (\S+ +\S+)$", r"\1 0 0 0 \2", PLAIN),
    "columns of no lift": PLAIN.replace("0.4   0.25", "0.4   0.25  0.0 0.08 0.18"),
    "aliases of types": PLAIN.replace("Fixed    400", "Anchor 400").replace("Vessel", "FAIRLEAD").replace("Free", "connect"),
    "aliases of ends": PLAIN.replace("Point3  P5", "con3  C5"),
    "aliases of options": PLAIN.replace("rhoW", "WtrDnsty").replace("kBot\n", "kb\n").replace("WtrDpth", "depth").replace(" g  ", " gravity "),
}


@pytest.mark.parametrize("variant", VARIANTS)
def test_spelling_changes_nothing(variant):
    assert VARIANTS[variant] != PLAIN
    plain, varied = parts(parse_scene(PLAIN)), parts(parse_scene(VARIANTS[variant]))
    if variant == "shuffled sections":
        plain, varied = [*plain[:4], sorted(plain[4])], [*varied[:4], sorted(varied[4])]
    assert plain == varied


@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
def test_lines_are_counted_as_an_editor_does(ending):
    scene = parse_scene(PLAIN.replace("gravity (m/s^2)", "gravity \x0b \x0c \u2028 \x85").replace("\n", ending), "deck.txt")
    assert scene.lines[-1].source_line == line_of(PLAIN, "7  rope")
    assert scene.warnings[0].startswith(f"deck.txt:{line_of(PLAIN, '0.001')}:")


@pytest.mark.parametrize("rows", [0, 1])
def test_a_row_of_numbers_is_never_taken_for_column_names(rows):
    names = "ID LineType AttachA AttachB UnstrLen NumSegs Outputs\n(#) (name)  (#)     (#)     (m)      (-)     (-)\n"
    fewer = parse_scene(swap(names, "".join(names.splitlines(keepends=True)[:rows])), "deck.txt")
    assert parts(fewer) == parts(parse_scene(PLAIN))
    assert any(f"deck.txt:{line_of(PLAIN, '--- LINES')}: the section LINES has {rows} instead of 2" in warning for warning in fewer.warnings)


@pytest.mark.parametrize("friction", ["saturated", "Stick"])
def test_friction_options_that_do_nothing_yet_are_read_and_said(friction):
    options = {"FrictionModel": friction, "mu_kT": "0.0", "mu_kA": "0", "mc": "1.2", "cv": "200"}
    scene = parse_scene(swap("0        FrictionCoefficient\n", "".join(f"{value} {name}\n" for name, value in options.items())))
    assert {name: scene.options[name] for name in options} == {"FrictionModel": friction.lower(), "mu_kT": 0.0, "mu_kA": 0.0, "mc": 1.2, "cv": 200.0}
    assert sum("the bed has no friction" in warning for warning in scene.warnings) == 3


def test_a_point_without_a_line_is_said():
    scene = parse_scene(swap("--- LINES ---", "6 Fixed 0 0 -100 0 0 0 0\n--- LINES ---"), "deck.txt")
    assert "deck.txt:18: point 6 carries no line" in scene.warnings


def test_anchors_may_be_rounded_onto_the_bed():
    assert parse_scene(swap("400.0  0     -100 ", "400.0  0     -100.005 ")).points[0].position[2] == -100.005


@pytest.mark.parametrize(
    "text", [PLAIN, VARIANTS["CRLF"], VARIANTS["byte order mark"], PLAIN + "# µ, m³, 180°\n"], ids=["plain", "CRLF", "BOM", "UTF-8"]
)
def test_the_scene_holds_the_bytes_of_its_file(tmp_path, text):
    path = tmp_path / "deck.txt"
    path.write_bytes(text.encode("utf-8"))
    scene = load_scene(path)
    assert scene.text.encode("utf-8") == path.read_bytes()
    assert scene.path == str(path)
    assert parse_scene(scene.text, scene.path) == scene == load_scene(str(path))


def test_scenes_are_values():
    scene = parse_scene(PLAIN)
    assert pickle.loads(pickle.dumps(scene)) == scene == copy.deepcopy(scene)
    assert hash(scene) == hash(parse_scene(PLAIN))
    assert scene != parse_scene(swap("420.5", "420.6"))
    with pytest.raises(dataclasses.FrozenInstanceError):
        scene.path = "other"


def test_every_option_that_counts_stands_in_the_documentation():
    page = PAGE.read_text(encoding="utf-8")
    missing = {fate.name for fate in FATES.values() if not fate.unused and f"`{fate.name}`" not in page}
    assert not missing
