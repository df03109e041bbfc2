"""A scene cut into scenes of some of its lines each, which share the platforms and the ground and nothing that moves by itself."""

from collections.abc import Sequence, Set
from dataclasses import replace

from .description import BODY, FREE, Body, Line, Point, RodEnd, Scene


def joints(scene: Scene) -> list[tuple[str, tuple[str, ...]]]:
    """(name, lines) of everything that joins lines so that they cannot be solved apart: free points, rods, free bodies, failures."""
    found: dict[str, list[str]] = {}
    points, rods, bodies = ({part.id: part for part in parts} for parts in (scene.points, scene.rods, scene.bodies))
    for line in scene.lines:
        for end in (line.end_a, line.end_b):
            joint = _joint(points, rods, bodies, end)
            if joint and line.name not in found.setdefault(joint, []):
                found[joint].append(line.name)
    names = {line.id: line.name for line in scene.lines}
    for failure in scene.failures:
        found[f"failure {failure.id}"] = [names[id] for id in failure.lines]
    return [(joint, tuple(lines)) for joint, lines in found.items() if len(lines) > 1]


def _joint(points: dict, rods: dict, bodies: dict, end: int | RodEnd) -> str | None:
    """Name of what moves with a line's end, other than the platform or the ground; None when there is nothing."""
    part = rods[end.rod] if isinstance(end, RodEnd) else points[end]
    if part.kind == BODY and bodies[part.body].kind == FREE:
        return f"body{part.body}"
    return part.name if isinstance(end, RodEnd) or part.kind == FREE else None


def cut(scene: Scene, groups: Sequence[Set[str]], everywhere: Sequence[str] = ()) -> list[Scene]:
    """A Scene for each group of names of lines. Together they are the scene: what several of them hold has its own loads in the first of them,
    what carries no line is in the first scene. everywhere: names of bodies that all of them have, whatever they carry. No joint may have lines in two groups."""
    taken: set[object] = set()  # what has its loads in an earlier scene
    scenes = []
    for number, names in enumerate(groups):
        lines = tuple(line for line in scene.lines if line.name in names)
        scenes.append(_part(scene, lines, taken, everywhere, first=number == 0))
    return scenes


def _part(scene: Scene, lines: tuple[Line, ...], taken: set[object], everywhere: Sequence[str], first: bool) -> Scene:
    ids = {line.id for line in lines}
    ends = {end for line in lines for end in (line.end_a, line.end_b)}
    elsewhere = {end for line in scene.lines if line.id not in ids for end in (line.end_a, line.end_b)}
    used_rods, other_rods = ({end.rod for end in some if isinstance(end, RodEnd)} for some in (ends, elsewhere))
    free = {body.id for body in scene.bodies if body.kind == FREE}
    carriers = {part.body for part in (*scene.points, *scene.rods) if part.kind == BODY and _is_used(part, ends, used_rods)}

    def wanted(part, used, other):
        if used:
            return True
        if part.kind == BODY and part.body in free:
            return part.body in carriers
        return first and not other

    points = [point for point in scene.points if wanted(point, point.id in ends, point.id in elsewhere)]
    rods = [rod for rod in scene.rods if wanted(rod, rod.id in used_rods, rod.id in other_rods)]
    carriers = {part.body for part in (*points, *rods) if part.kind == BODY}
    all_carriers = {part.body for part in (*scene.points, *scene.rods) if part.kind == BODY}
    bodies = [body for body in scene.bodies if body.id in carriers or body.name in everywhere or first and body.id not in all_carriers]
    return replace(
        scene,
        lines=lines,
        points=tuple(_once(point, taken) for point in points),
        rods=tuple(rods),
        bodies=tuple(_once(body, taken) for body in bodies),
        failures=tuple(failure for failure in scene.failures if set(failure.lines) <= ids),
        warnings=(),
    )


def _is_used(part, ends, used_rods):
    return part.id in ends if isinstance(part, Point) else part.id in used_rods


def _once(part: Point | Body, taken: set[object]) -> Point | Body:
    """The part, without loads of its own when an earlier scene has them."""
    if (type(part), part.id) not in taken:
        taken.add((type(part), part.id))
        return part
    if isinstance(part, Point):
        return replace(part, mass=0.0, volume=0.0, drag_area=0.0)
    return replace(part, mass=0.0, inertia=(0.0,) * 3, volume=0.0, drag_area=(0.0,) * 6)
