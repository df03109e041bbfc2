"""What stands in a scene, as the objects that `mooring check --json` prints, and as text."""

import math
from collections import Counter

from mooring_ros.scene import BODY, RodEnd

from .bed_shape import depths
from .console import table

_ALWAYS_COUNTED = ("fixed", "coupled", "free")


def contents(scene):
    """Lines, types, points, rods, bodies and failures of a Scene, their totals and the environment; SI units."""
    env = scene.environment
    gravity, density = env.gravity, env.water_density

    def weight(mass, volume):  # in water, N
        return (mass - density * volume) * gravity

    lines = [
        {
            "name": line.name,
            "type": line.type.name,
            "ends": [end_name(line.end_a), end_name(line.end_b)],
            "length": line.length,
            "segments": line.segments,
            "mass": line.type.mass * line.length,
            "weight_in_water": weight(line.type.mass, _area(line.type)) * line.length,
        }
        for line in scene.lines
    ]
    points = [{"name": point.name, "kind": point.kind, "position": list(point.position), **_carrier(point),
               "mass": point.mass, "weight_in_water": weight(point.mass, point.volume)} for point in scene.points]
    rods = [
        {
            "name": rod.name,
            "type": rod.type.name,
            "kind": rod.kind,
            **_carrier(rod),
            "ends": [list(rod.end_a), list(rod.end_b)],
            "length": rod.length,
            "segments": rod.segments,
            "mass": rod.type.mass * rod.length,
            "weight_in_water": weight(rod.type.mass, _area(rod.type)) * rod.length,
        }
        for rod in scene.rods
    ]
    bodies = [{"name": body.name, "kind": body.kind, "position": list(body.position), "mass": body.mass,
               "weight_in_water": weight(body.mass, body.volume)} for body in scene.bodies]
    return {
        "lines": lines,
        "line_types": [
            {
                "name": kind.name,
                "diameter": kind.diameter,
                "mass": kind.mass,
                "stiffness": kind.stiffness,
                "damping": kind.damping,
                "bending_stiffness": kind.bending_stiffness,
                "weight_in_water": weight(kind.mass, _area(kind)),
            }
            for kind in scene.line_types
        ],
        "points": points,
        "rods": rods,
        "bodies": bodies,
        "failures": [
            {
                "name": f"failure{failure.id}",
                "at": end_name(failure.holder),
                "lines": [f"line{line}" for line in failure.lines],
                "time": _finite(failure.time),
                "tension": _finite(failure.tension),
            }
            for failure in scene.failures
        ],
        "totals": {
            "lines": len(lines),
            "points": {**dict.fromkeys(_ALWAYS_COUNTED, 0), **_kinds(points)},
            "rods": _kinds(rods),
            "bodies": _kinds(bodies),
            "segments": sum(line.segments for line in scene.lines),
            "length": sum(line.length for line in scene.lines),
            "mass": sum(part["mass"] for part in (*lines, *points, *rods, *bodies)),
            "weight_in_water": sum(part["weight_in_water"] for part in (*lines, *points, *rods, *bodies)),
        },
        "environment": {
            "depth": env.depth,
            "bed": depths(env),
            "gravity": gravity,
            "water_density": density,
            "current": list(env.current),
        },
        "files": [name for name, _ in scene.files],
    }


def end_name(end):
    """Of a line's end: point3, rod1A."""
    return f"rod{end.rod}{end.end}" if isinstance(end, RodEnd) else f"point{end}"


def contents_text(found):
    """The paragraphs about `contents`, as a list of lines."""
    totals = found["totals"]
    held = [f"{what}: {_counted(totals[what])}" for what in ("points", "rods", "bodies") if any(totals[what].values())]
    lines = [
        [line["name"], line["type"], " – ".join(line["ends"]), g(line["length"]), line["segments"], g(line["weight_in_water"] / 1e3)]
        for line in found["lines"]
    ]
    types = [
        [kind["name"], g(kind["diameter"]), g(kind["mass"]), g(kind["stiffness"]), g(kind["bending_stiffness"]), g(kind["weight_in_water"])]
        for kind in found["line_types"]
    ]
    text = [
        f"{found['scene']}: {_number_of(totals['lines'], 'line')}, {_number_of(totals['segments'], 'segment')}; "
        f"{'; '.join(held)}; {found['environment']['bed']}",
        f"together {g(totals['length'])} m of line, {g(totals['mass'])} kg, {g(totals['weight_in_water'] / 1e3)} kN in water",
        "",
        table(["line", "type", "ends", "length (m)", "segments", "weight in water (kN)"], lines),
        "",
        table(["type", "diameter (m)", "mass (kg/m)", "EA (N)", "EI (N m²)", "weight in water (N/m)"], types),
    ]
    if found["rods"]:
        rods = [[rod["name"], rod["type"], _held(rod), g(rod["length"]), rod["segments"], g(rod["weight_in_water"] / 1e3)] for rod in found["rods"]]
        text += ["", table(["rod", "type", "held", "length (m)", "segments", "weight in water (kN)"], rods)]
    if found["bodies"]:
        bodies = [[body["name"], body["kind"], g(body["mass"]), g(body["weight_in_water"] / 1e3)] for body in found["bodies"]]
        text += ["", table(["body", "held", "mass (kg)", "weight in water (kN)"], bodies)]
    if found["files"]:
        text += ["", f"Read from {', '.join(found['files'])} as well"]
    return text


def _number_of(count, what):
    return f"{count} {what}{'s' * (count != 1)}"


def g(value):
    """A number for the eye."""
    return f"{value:.4g}" if abs(value) < 1e4 else f"{value:.5g}"


def _area(kind):
    return 0.25 * math.pi * kind.diameter**2


def _carrier(part):
    return {"body": f"body{part.body}"} if part.kind == BODY else {}


def _held(rod):
    return f"on {rod['body']}" if "body" in rod else rod["kind"]


def _kinds(parts):
    return dict(Counter(part["kind"] for part in parts))


def _counted(kinds):
    return ", ".join(f"{count} {'on bodies' if kind == BODY else kind}" for kind, count in kinds.items() if count)


def _finite(value):
    return value if math.isfinite(value) else None
