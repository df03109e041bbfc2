"""The tables of rod types, bodies and rods, each row checked by itself."""

import difflib
import math
import re

from .description import BODY, COUPLED, COUPLED_PINNED, FIXED, FREE, PINNED, Body, Rod, RodType
from .rows import Row, parse_number
from .sections import Section
from .tables import body_of, new_id, place

MOST_SEGMENTS = 1000  # of a rod

_COUPLED = ("COUPLED", "CPLD", "VESSEL", "VES")
_BODY_KINDS = {
    **dict.fromkeys(("FIXED", "FIX", "ANCHOR"), FIXED),
    **dict.fromkeys(_COUPLED, COUPLED),
    "FREE": FREE,
}
_ROD_KINDS = {
    **_BODY_KINDS,
    **dict.fromkeys(("CONNECT", "CON", "POINT", "P"), FREE),
    **dict.fromkeys(("PINNED", "PIN"), PINNED),
    **dict.fromkeys(("COUPLEDPINNED", "CPLDPIN", "VESSELPINNED", "VESPIN"), COUPLED_PINNED),
}
_PINNED_BODY = re.compile(r"(?:PINNED|PIN|COUPLEDPINNED|CPLDPIN|VESSELPINNED|VESPIN)", re.IGNORECASE)
_PINNED_TO_BODY = re.compile(r"BODY\d+(?:PINNED|PIN)", re.IGNORECASE)
_TURBINE = re.compile(r"(?:TURBINE|T)\d+(?:PINNED|PIN)?", re.IGNORECASE)
_BODY_COLUMNS = "ID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG I Volume CdA Ca"
_ROD_COLUMNS = "ID RodType Attachment Xa Ya Za Xb Yb Zb NumSegs RodOutputs"


def read_rod_types(section: Section) -> tuple[RodType, ...]:
    """The rod types by the order of the file."""
    types: dict[str, RodType] = {}
    for row in section.rows:
        if len(row.words) != 7:
            raise row.error(f"{len(row.words)} columns, expected 7: Name Diam Mass/m Cd Ca CdEnd CaEnd (a comment begins with #)")
        name = row.words[0]
        if name in types:
            raise row.error(f"a second rod type '{name}' (the first is in line {types[name].source_line}), expected another name")
        types[name] = RodType(
            name=name,
            diameter=row.number(1, "diameter", "m", above=0),
            mass=row.number(2, "mass", "kg/m", at_least=0),
            drag_normal=row.number(3, "drag coefficient Cd", at_least=0),
            added_mass_normal=row.number(4, "added mass coefficient Ca", at_least=0),
            drag_end=row.number(5, "drag coefficient of the ends CdEnd", at_least=0),
            added_mass_end=row.number(6, "added mass coefficient of the ends CaEnd", at_least=0),
            source_line=row.line,
        )
    return tuple(types.values())


def read_bodies(section: Section) -> tuple[Body, ...]:
    """The bodies by the order of the file."""
    bodies: dict[int, Body] = {}
    for row in section.rows:
        if len(row.words) != 14:
            raise row.error(f"{len(row.words)} columns, expected 14: {_BODY_COLUMNS} (a comment begins with #)")
        id = new_id(row, "body", bodies)
        if _PINNED_BODY.fullmatch(row.words[1]):
            raise row.error(f"body type is '{row.words[1]}', expected Fixed, Coupled or Free: pinned bodies are not modelled")
        bodies[id] = Body(
            id=id,
            kind=_kind(row, 1, "body type", _BODY_KINDS, "Fixed, Coupled or Free"),
            position=place(row, 2),
            orientation=quaternion(*(math.radians(row.number(5 + i, name, "degrees")) for i, name in enumerate(("roll", "pitch", "yaw")))),
            mass=row.number(8, "mass", "kg", at_least=0),
            centre_of_gravity=_centre_of_gravity(row, 9),
            inertia=_by_axis(row, 10, "moment of inertia I", "kg m^2"),
            volume=row.number(11, "volume", "m^3", at_least=0),
            drag_area=_drag_area(row, 12),
            added_mass=_by_axis(row, 13, "added mass coefficient Ca", ""),
            source_line=row.line,
        )
    return tuple(bodies.values())


def quaternion(roll: float, pitch: float, yaw: float) -> tuple[float, float, float, float]:
    """x, y, z, w of the intrinsic turns about x, then y, then z (R = Rx Ry Rz), as MoorDyn means the angles (rad) of bodies."""
    (sx, cx), (sy, cy), (sz, cz) = ((math.sin(angle / 2), math.cos(angle / 2)) for angle in (roll, pitch, yaw))
    return (
        sx * cy * cz + cx * sy * sz,
        cx * sy * cz - sx * cy * sz,
        cx * cy * sz + sx * sy * cz,
        cx * cy * cz - sx * sy * sz,
    )


def _centre_of_gravity(row: Row, index: int) -> tuple[float, float, float]:
    values = row.numbers(index, "centre of gravity CG", (1, 3), "m")
    return values if len(values) == 3 else (0.0, 0.0, values[0])


def _by_axis(row: Row, index: int, what: str, unit: str) -> tuple[float, float, float]:
    values = row.numbers(index, what, (1, 3), unit, at_least=0)
    return values if len(values) == 3 else values * 3


def _drag_area(row: Row, index: int) -> tuple[float, ...]:
    """CdA along and about the three axes: given for all, for along and about, for the axes (both), or one by one."""
    values = row.numbers(index, "drag area CdA", (1, 2, 3, 6), "m^2", at_least=0)
    if len(values) == 1:
        return values * 6
    if len(values) == 2:
        return (values[0],) * 3 + (values[1],) * 3
    return values * 2 if len(values) == 3 else values


def read_rods(section: Section, types: tuple[RodType, ...]) -> tuple[Rod, ...]:
    """The rods by the order of the file."""
    by_name = {rod_type.name: rod_type for rod_type in types}
    rods: dict[int, Rod] = {}
    for row in section.rows:
        words = row.words
        if len(words) < 10 or (len(words) > 11 and parse_number(words[10]) is not None):
            raise row.error(f"{len(words)} columns, expected 11: {_ROD_COLUMNS} (a comment begins with #)")
        id = new_id(row, "rod", rods)
        if words[1] not in by_name:
            near = difflib.get_close_matches(words[1], by_name, n=1) or sorted(by_name)
            names = f"{'one of ' if len(near) > 1 else ''}{', '.join(near)}" if near else "its name in a section ROD TYPES"
            raise row.error(f"unknown rod type '{words[1]}', expected {names}")
        kind, body = _rod_kind(row)
        segments = 0 if words[9] == "0" else row.count(9, "number of segments (or 0 for a rod without length)", MOST_SEGMENTS)
        rod = Rod(
            id=id,
            type=by_name[words[1]],
            kind=kind,
            end_a=place(row, 3, ("xa", "ya", "za")),
            end_b=place(row, 6, ("xb", "yb", "zb")),
            segments=segments,
            body=body,
            source_line=row.line,
        )
        if rod.end_a == rod.end_b and segments:
            raise row.error(f"both ends of rod {id} are at the same place, expected a length > 0 m (or 0 segments for a rod without length)")
        if rod.end_a == rod.end_b and kind not in (FREE, PINNED, COUPLED_PINNED):
            raise row.error(f"both ends of the {kind} rod {id} are at the same place, expected another end B: it gives the direction")
        rods[id] = rod
    return tuple(rods.values())


def _rod_kind(row: Row) -> tuple[str, int | None]:
    """How the rod is held, and the body that it rides on."""
    word = row.words[2]
    if (body := body_of(word)) is not None:
        return BODY, body
    if _PINNED_TO_BODY.fullmatch(word):
        raise row.error(f"the rod is attached to '{word}', expected {word[: word.upper().index('PIN')]}: rods pinned to bodies are not modelled")
    return _kind(row, 2, "rod type", _ROD_KINDS, "Fixed, Coupled, Free, Pinned, CoupledPinned or Body1"), None


def _kind(row: Row, index: int, what: str, kinds: dict[str, str], expected: str) -> str:
    word = row.words[index]
    kind = kinds.get(word.upper())
    if kind is not None:
        return kind
    if _TURBINE.fullmatch(word):
        raise row.error(f"{what} is '{word}', expected {expected}: several turbines are not modelled")
    near = difflib.get_close_matches(word.upper(), kinds, n=1)
    raise row.error(f"{what} is '{word}', expected {expected}{f' (did you mean {near[0].capitalize()}?)' if near else ''}")
