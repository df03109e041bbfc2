"""Checks across the sections of a scene: references, and whether everything that is free is held by something and can move."""

import difflib
from collections.abc import Iterator

from .description import BODY, COUPLED_PINNED, FREE, PINNED, Body, Line, LineType, Point, Rod, RodEnd
from .errors import SceneError
from .tables import LineRow

_MISSING = "which does not exist, expected one of the IDs in the section"


def resolve_lines(rows: tuple[LineRow, ...], line_types: tuple[LineType, ...], points: tuple[Point, ...], rods: tuple[Rod, ...]) -> tuple[Line, ...]:
    """Lines with their types and ends looked up; SceneError when one is missing or both ends are the same place."""
    types = {line_type.name: line_type for line_type in line_types}
    point_ids, rod_ids = {point.id for point in points}, {rod.id for rod in rods}
    lines = []
    for line in rows:
        if line.type_name not in types:
            near = difflib.get_close_matches(line.type_name, types, n=1)
            names = near or sorted(types)
            raise line.row.error(f"unknown line type '{line.type_name}', expected {'one of ' if len(names) > 1 else ''}{', '.join(names)}")
        for end, holder in (("A", line.end_a), ("B", line.end_b)):
            if isinstance(holder, RodEnd):
                if holder.rod not in rod_ids:
                    raise line.row.error(f"end {end} is attached to rod {holder.rod}, {_MISSING} RODS")
            elif holder not in point_ids:
                raise line.row.error(f"end {end} is attached to point {holder}, {_MISSING} POINTS")
        if line.end_a == line.end_b:
            raise line.row.error(f"both ends are attached to {_name(line.end_a)}, expected two different places")
        lines.append(Line(line.id, types[line.type_name], line.end_a, line.end_b, line.length, line.segments, line.row.line))
    return tuple(lines)


def _name(holder: int | RodEnd) -> str:
    return f"end {holder.end} of rod {holder.rod}" if isinstance(holder, RodEnd) else f"point {holder}"


def check_carriers(file: str, points: tuple[Point, ...], rods: tuple[Rod, ...], bodies: tuple[Body, ...]) -> None:
    """SceneError for a point or a rod on a body that does not exist."""
    ids = {body.id for body in bodies}
    for part in (*points, *rods):
        if part.kind == BODY and part.body not in ids:
            raise SceneError(file, part.source_line, f"{part.name} is attached to body {part.body}, {_MISSING} BODIES")


def check_holding(file: str, points: tuple[Point, ...], rods: tuple[Rod, ...], bodies: tuple[Body, ...], lines: tuple[Line, ...]) -> list[str]:
    """SceneError for a free part that nothing holds; a warning for each point without a line."""
    used = {holder for line in lines for holder in (line.end_a, line.end_b)}
    held = _held(points, rods, bodies, lines)
    warnings = []
    for point in points:
        if point.id not in used:
            if point.kind == FREE:
                raise SceneError(file, point.source_line, f"free point {point.id} carries no line, expected one at least")
            if point.kind != BODY or not (point.mass or point.volume or point.drag_area):
                warnings.append(f"{file}:{point.source_line}: point {point.id} carries no line")
        elif point.kind == FREE and point not in held:
            raise SceneError(file, point.source_line, _unheld(f"free point {point.id}", "its lines"))
    for part in (*rods, *bodies):
        if part.kind == FREE and part not in held:
            raise SceneError(file, part.source_line, _unheld(f"free {part.name}", "lines"))
    return warnings


def _unheld(what: str, lines: str) -> str:
    return f"{what} is held by nothing, expected {lines} to lead to something fixed or coupled"


def _held(points: tuple[Point, ...], rods: tuple[Rod, ...], bodies: tuple[Body, ...], lines: tuple[Line, ...]) -> set[Point | Rod | Body]:
    """The parts from which lines lead to a fixed, pinned or coupled part."""
    by_point, by_rod, by_body = ({part.id: part for part in parts} for parts in (points, rods, bodies))

    def joined() -> Iterator[tuple[Point | Rod | Body, Point | Rod | Body]]:
        for line in lines:
            yield tuple(by_rod[holder.rod] if isinstance(holder, RodEnd) else by_point[holder] for holder in (line.end_a, line.end_b))
        for part in (*points, *rods):
            if part.kind == BODY:
                yield part, by_body[part.body]

    neighbours: dict[Point | Rod | Body, list] = {part: [] for part in (*points, *rods, *bodies)}
    for one, other in joined():
        neighbours[one].append(other)
        neighbours[other].append(one)
    reached = [part for part in neighbours if part.kind not in (FREE, BODY)]
    held = set(reached)
    while reached:
        for part in neighbours[reached.pop()]:
            if part not in held:
                held.add(part)
                reached.append(part)
    return held


def check_masses(file: str, points: tuple[Point, ...], rods: tuple[Rod, ...], bodies: tuple[Body, ...]) -> None:
    """SceneError for a part that moves freely and has no mass, or a body that turns freely and has no moment of inertia."""
    for rod in rods:
        if rod.kind in (FREE, PINNED, COUPLED_PINNED) and rod.segments and rod.type.mass <= 0:
            raise SceneError(file, rod.source_line, f"{rod.name} moves freely and its type '{rod.type.name}' has no mass, expected one > 0 kg/m")
    for body in bodies:
        if body.kind != FREE:
            continue
        own_rods = [rod for rod in rods if rod.body == body.id and rod.segments and rod.type.mass > 0]
        own_points = [point for point in points if point.body == body.id and point.mass > 0]
        if body.mass <= 0 and not own_rods and not own_points:
            raise SceneError(file, body.source_line, f"free {body.name} has no mass, expected one > 0 kg, or rods or points with mass on it")
        if min(body.inertia) <= 0 and not own_rods:
            missing = "has no moment of inertia about some axis, expected one > 0 kg m^2, or a rod on it"
            raise SceneError(file, body.source_line, f"free {body.name} {missing}")

