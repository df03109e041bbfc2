"""Where the parts of a scene stand to the bed.

MoorDyn leaves fixed points and rods where the file puts them, however far below the bed, so that the bed pushes the lines away from
their anchors. Here fixed points and rods without length that are below the bed are set on it, with a warning, and so is what the file
puts "on the seabed". What is above the bed stays there. Nothing that moves may start below it.
"""

from collections.abc import Iterator
from dataclasses import replace

from .bed import bed_level
from .description import BODY, FIXED, Body, Environment, Point, Rod
from .errors import SceneError

# Decks give the bed and the anchors with few digits; no more than this below the bed is rounding.
BED_TOLERANCE = 1e-4  # of the depth

Place = tuple[float, float, float]


def place_points(
    file: str, points: tuple[Point, ...], on_the_bed: frozenset[int], bodies: tuple[Body, ...], environment: Environment
) -> tuple[tuple[Point, ...], list[str]]:
    """The points with those on the bed set on it, and warnings. SceneError for one that moves and is below the bed."""
    by_id = {body.id: body for body in bodies}
    placed, warnings = [], []
    for point in points:
        if point.id in on_the_bed:
            point = _set_on_bed(point, environment)
        elif point.kind == BODY:
            body = by_id[point.body]
            _check(file, point, body.kind, [_carried(body, point.position)], environment, warnings)
        elif point.kind == FIXED and _is_below(point.position, environment):
            z, point = point.position[2], _set_on_bed(point, environment)
            level = point.position[2]
            warnings.append(f"{file}:{point.source_line}: point {point.id} at z = {z:g} m is below the bed, it is set on it (z = {level:g} m)")
        else:
            _check(file, point, point.kind, [point.position], environment, warnings)
        placed.append(point)
    return tuple(placed), warnings


def _set_on_bed(point: Point, environment: Environment) -> Point:
    x, y, _ = point.position
    return replace(point, position=(x, y, bed_level(environment, x, y)))


def place_rods(file: str, rods: tuple[Rod, ...], bodies: tuple[Body, ...], environment: Environment) -> tuple[tuple[Rod, ...], list[str]]:
    """The rods with fixed ones without length set on the bed, and warnings. SceneError for one that moves and is below the bed."""
    by_id = {body.id: body for body in bodies}
    placed, warnings = [], []
    for rod in rods:
        ends = [rod.end_a, rod.end_b] if rod.segments else [rod.end_a]
        if rod.kind == BODY:
            body = by_id[rod.body]
            _check(file, rod, body.kind, [_carried(body, end) for end in ends], environment, warnings)
        elif rod.kind == FIXED and not rod.segments and _is_below(rod.end_a, environment):
            level = bed_level(environment, *rod.end_a[:2])
            lift = level - rod.end_a[2]
            warnings.append(f"{file}:{rod.source_line}: {rod.name} at z = {rod.end_a[2]:g} m is below the bed, it is set on it (z = {level:g} m)")
            rod = replace(rod, end_a=(*rod.end_a[:2], level), end_b=(*rod.end_b[:2], rod.end_b[2] + lift))
        else:
            _check(file, rod, rod.kind, ends, environment, warnings)
        placed.append(rod)
    return tuple(placed), warnings


def check_bodies(file: str, bodies: tuple[Body, ...], environment: Environment) -> list[str]:
    """Warnings for fixed bodies below the bed; SceneError for others."""
    warnings: list[str] = []
    for body in bodies:
        _check(file, body, body.kind, [body.position], environment, warnings)
    return warnings


def _check(file: str, part: Point | Rod | Body, kind: str, places: list[Place], environment: Environment, warnings: list[str]) -> None:
    for x, y, z in places:
        if _is_below((x, y, z), environment):
            level = bed_level(environment, x, y)
            if kind == FIXED:
                warnings.append(f"{file}:{part.source_line}: {part.name} at z = {z:g} m is below the bed (z = {level:g} m) and stays there")
            else:
                name = f"point {part.id}" if isinstance(part, Point) else part.name
                what = f"{name} of the {kind} body {part.body}" if part.kind == BODY else f"{kind} {name}"
                raise SceneError(file, part.source_line, f"{what} at z = {z:g} m is below the bed, expected z >= {level:g} m there")


def _is_below(place: Place, environment: Environment) -> bool:
    level = bed_level(environment, *place[:2])
    return place[2] < level - BED_TOLERANCE * abs(level)


def _carried(body: Body, place: Place) -> Place:
    """World coordinates of a place in the axes of a body."""
    return tuple(_add(body.position, _turned(body.orientation, place)))


def _turned(quaternion: tuple[float, float, float, float], vector: Place) -> Place:
    *axis, w = quaternion
    twice = [2 * value for value in _cross(axis, vector)]
    return tuple(v + w * t + c for v, t, c in zip(vector, twice, _cross(axis, twice)))


def _cross(a, b) -> Place:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _add(a: Place, b: Place) -> Iterator[float]:
    return (one + other for one, other in zip(a, b))
