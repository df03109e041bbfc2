"""Checks across the sections of a scene: references, positions, and whether everything is held."""

import difflib

from .description import FIXED, FREE, Line, LineType, Point
from .errors import SceneError
from .tables import LineRow

# Decks give the bed and the anchors with few digits; more than this below the bed is no rounding.
BED_TOLERANCE = 1e-4  # of the depth


def resolve_lines(rows: tuple[LineRow, ...], line_types: tuple[LineType, ...], points: tuple[Point, ...]) -> tuple[Line, ...]:
    """Lines with their types and ends looked up; SceneError when one is missing or both ends are the same point."""
    types = {line_type.name: line_type for line_type in line_types}
    ids = {point.id for point in points}
    lines = []
    for line in rows:
        if line.type_name not in types:
            near = difflib.get_close_matches(line.type_name, types, n=1)
            names = near or sorted(types)
            raise line.row.error(f"unknown line type '{line.type_name}', expected {'one of ' if len(names) > 1 else ''}{', '.join(names)}")
        for end, id in (("A", line.end_a), ("B", line.end_b)):
            if id not in ids:
                raise line.row.error(f"end {end} is attached to point {id}, which does not exist, expected one of the IDs in the section POINTS")
        if line.end_a == line.end_b:
            raise line.row.error(f"both ends are attached to point {line.end_a}, expected two points")
        lines.append(Line(line.id, types[line.type_name], line.end_a, line.end_b, line.length, line.segments, line.row.line))
    return tuple(lines)


def check_points(file: str, points: tuple[Point, ...], lines: tuple[Line, ...], depth: float) -> list[str]:
    """SceneError for a point below the bed or a free point that nothing holds; a warning for each point without a line."""
    used = {id for line in lines for id in (line.end_a, line.end_b)}
    held = _held(points, lines)
    warnings = []
    for point in points:
        z = point.position[2]
        if z < -depth * (1 + BED_TOLERANCE):
            what = "anchor" if point.kind == FIXED else point.kind + " point"
            raise SceneError(file, point.source_line, f"{what} {point.id} at z = {z:g} m is below the bed, expected z >= {-depth:g} m (WtrDpth)")
        if point.id not in used:
            if point.kind == FREE:
                raise SceneError(file, point.source_line, f"free point {point.id} carries no line, expected one at least")
            warnings.append(f"{file}:{point.source_line}: point {point.id} carries no line")
        elif point.id not in held:
            raise SceneError(
                file, point.source_line, f"free point {point.id} is held by nothing, expected its lines to lead to a fixed or a coupled point"
            )
    return warnings


def _held(points: tuple[Point, ...], lines: tuple[Line, ...]) -> set[int]:
    """IDs of the points from which lines lead to a fixed or a coupled point."""
    neighbours: dict[int, list[int]] = {point.id: [] for point in points}
    for line in lines:
        neighbours[line.end_a].append(line.end_b)
        neighbours[line.end_b].append(line.end_a)
    reached = [point.id for point in points if point.kind != FREE]
    held = set(reached)
    while reached:
        for id in neighbours[reached.pop()]:
            if id not in held:
                held.add(id)
                reached.append(id)
    return held
