"""The tables of points and lines, each row checked by itself."""

import difflib
import re
from dataclasses import dataclass

from .description import BODY, COUPLED, FIXED, FREE, Point, RodEnd
from .rows import Row
from .sections import Section

LARGEST_ID = 999_999
MOST_SEGMENTS = 100_000

_POINT_KINDS = {
    **dict.fromkeys(("FIXED", "FIX", "ANCHOR"), FIXED),
    **dict.fromkeys(("COUPLED", "CPLD", "VESSEL", "VES", "FAIRLEAD"), COUPLED),
    **dict.fromkeys(("FREE", "CONNECT", "CON", "POINT", "P"), FREE),
}
_ON_THE_BED = ("SEABED", "GROUND", "FLOOR")  # as z of a point: on the bed, wherever that is
_CARRIER = re.compile(r"(BODY|TURBINE|ROD|T|R)\d", re.IGNORECASE)
_BODY = re.compile(r"BODY(\d{1,9})", re.IGNORECASE | re.ASCII)
_POINT_END = re.compile(r"(?:POINT|P|CON|C|NODE|N)?(\d{1,9})", re.IGNORECASE | re.ASCII)
_ROD_END = re.compile(r"(?:ROD|R)(\d{1,9})([AB]?)", re.IGNORECASE | re.ASCII)


@dataclass(frozen=True)
class LineRow:
    """A row of LINES with its references still unresolved."""

    id: int
    type_name: str
    end_a: int | RodEnd
    end_b: int | RodEnd
    length: float
    segments: int
    row: Row


def new_id(row: Row, what: str, others: dict[int, object]) -> int:
    """The ID in the first column; SceneError when one of the ``others`` (each with a source_line) has it already."""
    id = row.count(0, f"{what} ID", LARGEST_ID)
    if id in others:
        raise row.error(f"a second {what} {id} (the first is in line {others[id].source_line}), expected another ID")
    return id


def body_of(word: str) -> int | None:
    """The id of the body that ``Body3`` names, None for other words."""
    match = _BODY.fullmatch(word)
    return int(match.group(1)) if match else None


def place(row: Row, index: int, names: str = "xyz") -> tuple[float, float, float]:
    """The coordinates (m) in three columns from ``index``."""
    return tuple(row.number(index + i, name, "m") for i, name in enumerate(names))


def read_points(section: Section) -> tuple[tuple[Point, ...], frozenset[int]]:
    """The points by the order of the file, and the ids of those that stand on the bed (their z is 0 here)."""
    points: dict[int, Point] = {}
    on_the_bed = set()
    for row in section.rows:
        words = row.words
        if len(words) not in (9, 12):
            raise row.error(f"{len(words)} columns, expected 9: ID Type X Y Z Mass Volume CdA Ca (a comment begins with #)")
        id = new_id(row, "point", points)
        kind, body = _point_kind(row)
        if len(words) == 12:  # the older form: a constant force before CdA and Ca
            for index, axis in ((7, "x"), (8, "y"), (9, "z")):
                if row.number(index, f"force in {axis}", "N") != 0:
                    raise row.error(f"force in {axis} is {words[index]}, expected 0: constant forces on points are not modelled")
        if words[4].upper() in _ON_THE_BED:
            if kind in (COUPLED, BODY):
                raise row.error(f"z is '{words[4]}' at a {kind} point, expected a number (m): only fixed and free points can stand on the bed")
            on_the_bed.add(id)
            position = (row.number(2, "x", "m"), row.number(3, "y", "m"), 0.0)
        else:
            position = place(row, 2)
        points[id] = Point(
            id=id,
            kind=kind,
            position=position,
            mass=row.number(5, "mass", "kg", at_least=0),
            volume=row.number(6, "volume", "m^3", at_least=0),
            drag_area=row.number(len(words) - 2, "drag area CdA", "m^2", at_least=0),
            added_mass=row.number(len(words) - 1, "added mass coefficient Ca", at_least=0),
            body=body,
            source_line=row.line,
        )
    return tuple(points.values()), frozenset(on_the_bed)


def _point_kind(row: Row) -> tuple[str, int | None]:
    """How the point is held, and the body that it rides on."""
    word = row.words[1]
    kind = _POINT_KINDS.get(word.upper())
    if kind is not None:
        return kind, None
    if (body := body_of(word)) is not None:
        return BODY, body
    if _CARRIER.match(word):
        raise row.error(f"the point is attached to '{word}', expected Fixed, Coupled, Free or Body1: points on rods and turbines are not modelled")
    near = difflib.get_close_matches(word.upper(), _POINT_KINDS, n=1)
    hint = f" (did you mean {near[0].capitalize()}?)" if near else ""
    raise row.error(f"point type is '{word}', expected Fixed, Coupled, Free or Body1{hint}")


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
            end_a=read_holder(row, 2, "end A is attached to"),
            end_b=read_holder(row, 3, "end B is attached to"),
            length=row.number(4, "unstretched length", "m", above=0),
            segments=row.count(5, "number of segments", MOST_SEGMENTS),
            row=row,
        )
    return tuple(lines.values())


def read_holder(row: Row, index: int, what: str) -> int | RodEnd:
    """The point or the rod's end that column ``index`` names."""
    word = row.words[index]
    if match := _POINT_END.fullmatch(word):
        return int(match.group(1))
    if match := _ROD_END.fullmatch(word):
        if not match.group(2):
            raise row.error(f"{what} '{word}', expected {word}A or {word}B: the end of the rod is missing")
        return RodEnd(int(match.group(1)), match.group(2).upper())
    raise row.error(f"{what} '{word}', expected a point ID such as 3 or Point3, or the end of a rod such as R1A")
