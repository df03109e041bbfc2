"""The tables of a MoorDyn v2 file: line types, points and lines, each row checked by itself."""

import difflib
import re
from dataclasses import dataclass

from .description import COUPLED, FIXED, FREE, LineType, Point
from .rows import Row, parse_number
from .sections import Section

LARGEST_ID = 999_999
MOST_SEGMENTS = 100_000

_POINT_KINDS = {
    **dict.fromkeys(("FIXED", "FIX", "ANCHOR"), FIXED),
    **dict.fromkeys(("COUPLED", "CPLD", "VESSEL", "VES", "FAIRLEAD"), COUPLED),
    **dict.fromkeys(("FREE", "CONNECT", "CON", "POINT", "P"), FREE),
}
_CARRIER = re.compile(r"(BODY|TURBINE|ROD|T|R)\d", re.IGNORECASE)
_POINT_END = re.compile(r"(?:POINT|P|CON|C|NODE|N)?(\d{1,9})", re.IGNORECASE | re.ASCII)
_ROD_END = re.compile(r"(ROD|R)\d+[AB]?", re.IGNORECASE)


@dataclass(frozen=True)
class LineRow:
    """A row of LINES with its references still unresolved."""

    id: int
    type_name: str
    end_a: int
    end_b: int
    length: float
    segments: int
    row: Row


def read_line_types(section: Section) -> tuple[LineType, ...]:
    """The line types by the order of the file. SceneError for what is wrong or not built (curves, bending, viscoelasticity, VIV)."""
    _refuse_version_1_line_types(section)
    types: dict[str, LineType] = {}
    for row in section.rows:
        if len(row.words) not in (10, 11, 12, 13):
            raise row.error(f"{len(row.words)} columns, expected 10: Name Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx (a comment begins with #)")
        name = row.words[0]
        if name in types:
            raise row.error(f"a second line type '{name}' (the first is in line {types[name].source_line}), expected another name")
        _refuse_curve(row, 3, "stiffness EA")
        _refuse_curve(row, 4, "damping BA")
        _refuse_curve(row, 5, "bending stiffness EI")
        types[name] = LineType(
            name=name,
            diameter=row.number(1, "diameter", "m", above=0),
            mass=row.number(2, "mass", "kg/m", above=0),
            stiffness=row.number(3, "stiffness EA", "N", above=0),
            damping=row.number(4, "damping BA/-zeta", "N s, or minus the fraction of critical damping"),
            bending_stiffness=row.number(5, "bending stiffness EI", "N m^2", at_least=0),
            drag_normal=row.number(6, "drag coefficient Cd", at_least=0),
            added_mass_normal=row.number(7, "added mass coefficient Ca", at_least=0),
            drag_axial=row.number(8, "axial drag coefficient CdAx", at_least=0),
            added_mass_axial=row.number(9, "axial added mass coefficient CaAx", at_least=0),
            source_line=row.line,
        )
        if types[name].bending_stiffness > 0:
            raise row.error(f"bending stiffness EI is {row.words[5]}, expected 0: bending is not built yet")
        for index in range(10, len(row.words)):
            value = row.number(index, ("lift coefficient Cl", "dF", "cF")[index - 10], at_least=0)
            if index == 10 and value > 0:
                raise row.error(f"lift coefficient Cl is {row.words[10]}, expected 0: vortex-induced vibration is not built yet")
    return tuple(types.values())


def _refuse_version_1_line_types(section: Section) -> None:
    names = [word.upper() for word in section.names.words] if section.names else []
    added_mass = [i for i, name in enumerate(names) if name.startswith("CA")]
    drag = [i for i, name in enumerate(names) if name.startswith("CD")]
    if added_mass and drag and added_mass[0] < drag[0]:
        raise section.names.error(
            "columns in the order of MoorDyn v1 (added mass before drag), expected those of v2: Name Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx"
        )


def _refuse_curve(row: Row, index: int, what: str) -> None:
    word = row.words[index]
    if "|" in word:
        raise row.error(f"{what} is '{word}', expected one number: viscoelastic lines are not built yet")
    if parse_number(word) is None and re.search(r"[\\/]|\.(?:txt|dat|csv|inp)$", word, re.IGNORECASE):
        raise row.error(f"{what} is the file '{word}', expected a number: curves from a file are not built yet")


def read_points(section: Section) -> tuple[Point, ...]:
    """The points by the order of the file."""
    points: dict[int, Point] = {}
    for row in section.rows:
        words = row.words
        if len(words) not in (9, 12):
            raise row.error(f"{len(words)} columns, expected 9: ID Type X Y Z Mass Volume CdA Ca (a comment begins with #)")
        id = row.count(0, "point ID", LARGEST_ID)
        if id in points:
            raise row.error(f"a second point {id} (the first is in line {points[id].source_line}), expected another ID")
        kind = _point_kind(row)
        if len(words) == 12:  # the older form: a constant force before CdA and Ca
            for index, axis in ((7, "x"), (8, "y"), (9, "z")):
                if row.number(index, f"force in {axis}", "N") != 0:
                    raise row.error(f"force in {axis} is {words[index]}, expected 0: constant forces on points are not built yet")
        points[id] = Point(
            id=id,
            kind=kind,
            position=(row.number(2, "x", "m"), row.number(3, "y", "m"), row.number(4, "z", "m")),
            mass=row.number(5, "mass", "kg", at_least=0),
            volume=row.number(6, "volume", "m^3", at_least=0),
            drag_area=row.number(len(words) - 2, "drag area CdA", "m^2", at_least=0),
            added_mass=row.number(len(words) - 1, "added mass coefficient Ca", at_least=0),
            source_line=row.line,
        )
    return tuple(points.values())


def _point_kind(row: Row) -> str:
    word = row.words[1]
    kind = _POINT_KINDS.get(word.upper())
    if kind is not None:
        return kind
    if _CARRIER.match(word):
        raise row.error(f"the point is attached to '{word}', expected Fixed, Coupled or Free: points on bodies, rods and turbines are not built yet")
    near = difflib.get_close_matches(word.upper(), _POINT_KINDS, n=1)
    hint = f" (did you mean {near[0].capitalize()}?)" if near else ""
    raise row.error(f"point type is '{word}', expected Fixed, Coupled or Free{hint}")


def read_lines(section: Section) -> tuple[LineRow, ...]:
    """The rows of LINES by the order of the file; what they refer to is not looked up here."""
    names = [word.upper() for word in section.names.words] if section.names else []
    attach = [i for i, name in enumerate(names) if name.startswith(("ATTACH", "NODEA", "NODEF"))]
    if attach and any(name.startswith("UNSTR") for name in names[: attach[0]]):
        raise section.names.error(
            "columns in the order of MoorDyn v1 (length before the ends), expected those of v2: ID LineType AttachA AttachB UnstrLen NumSegs Outputs"
        )
    lines: dict[int, LineRow] = {}
    for row in section.rows:
        # The outputs may be left out or stand in several columns: they decide nothing here.
        if len(row.words) < 6:
            raise row.error(f"{len(row.words)} columns, expected 7: ID LineType AttachA AttachB UnstrLen NumSegs Outputs")
        id = row.count(0, "line ID", LARGEST_ID)
        if id in lines:
            raise row.error(f"a second line {id} (the first is in line {lines[id].row.line}), expected another ID")
        lines[id] = LineRow(
            id=id,
            type_name=row.words[1],
            end_a=_end(row, 2, "A"),
            end_b=_end(row, 3, "B"),
            length=row.number(4, "unstretched length", "m", above=0),
            segments=row.count(5, "number of segments", MOST_SEGMENTS),
            row=row,
        )
    return tuple(lines.values())


def _end(row: Row, index: int, end: str) -> int:
    word = row.words[index]
    match = _POINT_END.fullmatch(word)
    if match:
        return int(match.group(1))
    if _ROD_END.fullmatch(word):
        raise row.error(f"end {end} is attached to '{word}', expected a point ID: rods are not built yet")
    raise row.error(f"end {end} is attached to '{word}', expected a point ID such as 3 or Point3")
