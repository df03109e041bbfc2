"""`mooring check`: what a scene contains, what is switched on because of it, its largest stable step and its cost."""

import math

from .arguments import load_mooring
from .console import ComputationFailed, print_json, table
from .effects import effects
from .measure import measured_cost


def add_arguments(parser):
    parser.add_argument("scene", metavar="SCENE", help="MoorDyn v2 input file, or a recording that holds one")
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output, nothing else")


def run(args):
    found = inspect(args.scene)
    if args.json:
        print_json(found)
    else:
        print(_text(found))
    return 0


def inspect(path):
    """Everything about a scene, as the object that --json prints. Raises UsageError, ComputationFailed."""
    from mooring_ros.mooring import MooringError

    mooring = load_mooring(path)
    scene = mooring.scene
    try:
        mooring.settle([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
        switched = effects(scene, mooring)
        limit = mooring.step_limit
        cost = measured_cost(mooring)
    except MooringError as error:
        raise ComputationFailed(f"{path}: {error}") from error
    return {
        "scene": str(path),
        **_contents(scene),
        "effects": switched,
        "step_limit": {
            "dt": float(limit.dt),
            "limited_by": limit.limited_by,
            "limits": {name: float(step) if math.isfinite(step) else None for name, step in limit.limits.items()},
        },
        "cost": cost,
        "warnings": list(scene.warnings),
    }


def _contents(scene):
    gravity, density = scene.environment.gravity, scene.environment.water_density
    wet = {kind.name: (kind.mass - density * _area(kind)) * gravity for kind in scene.line_types}
    return {
        "lines": [
            {
                "name": line.name,
                "type": line.type.name,
                "ends": [scene.point(line.end_a).name, scene.point(line.end_b).name],
                "length": line.length,
                "segments": line.segments,
                "mass": line.type.mass * line.length,
                "weight_in_water": wet[line.type.name] * line.length,
            }
            for line in scene.lines
        ],
        "line_types": [
            {
                "name": kind.name,
                "diameter": kind.diameter,
                "mass": kind.mass,
                "stiffness": kind.stiffness,
                "damping": kind.damping,
                "weight_in_water": wet[kind.name],
            }
            for kind in scene.line_types
        ],
        "points": [{"name": point.name, "kind": point.kind, "position": list(point.position)} for point in scene.points],
        "totals": {
            "lines": len(scene.lines),
            "points": {kind: sum(point.kind == kind for point in scene.points) for kind in ("fixed", "coupled", "free")},
            "segments": sum(line.segments for line in scene.lines),
            "length": sum(line.length for line in scene.lines),
            "mass": sum(line.type.mass * line.length for line in scene.lines) + sum(point.mass for point in scene.points),
            "weight_in_water": sum(wet[line.type.name] * line.length for line in scene.lines)
            + sum((point.mass - density * point.volume) * gravity for point in scene.points),
        },
        "environment": {
            "depth": scene.environment.depth,
            "gravity": gravity,
            "water_density": density,
            "current": list(scene.environment.current),
        },
    }


def _area(kind):
    return 0.25 * math.pi * kind.diameter**2


def _text(found):
    totals, limit, cost = found["totals"], found["step_limit"], found["cost"]
    points = ", ".join(f"{count} {kind}" for kind, count in totals["points"].items() if count)
    lines = [
        [line["name"], line["type"], " – ".join(line["ends"]), _g(line["length"]), line["segments"], _g(line["weight_in_water"] / 1e3)]
        for line in found["lines"]
    ]
    types = [
        [kind["name"], _g(kind["diameter"]), _g(kind["mass"]), _g(kind["stiffness"]), _g(kind["weight_in_water"])]
        for kind in found["line_types"]
    ]
    switched = [["on" if effect["on"] else "off", effect["name"], effect["why"]] for effect in found["effects"]]
    width = max(len(row[1]) for row in switched)
    text = [
        f"{found['scene']}: {totals['lines']} lines, {totals['segments']} segments; points: {points}; depth {_g(found['environment']['depth'])} m",
        f"together {_g(totals['length'])} m of line, {_g(totals['mass'])} kg, {_g(totals['weight_in_water'] / 1e3)} kN in water",
        "",
        table(["line", "type", "ends", "length (m)", "segments", "weight in water (kN)"], lines),
        "",
        table(["type", "diameter (m)", "mass (kg/m)", "EA (N)", "weight in water (N/m)"], types),
        "",
        "Effects",
        *(f"  {state:3}  {name.ljust(width)}  {why}" for state, name, why in switched),
        "",
        f"Largest stable step: {_g(limit['dt'])} s, limited by {limit['limited_by']}",
        "Limits of a plain leapfrog step",
        *(f"  {name}: {_g(step)} s" if step else f"  {name}: no limit" for name, step in limit["limits"].items()),
        "",
        f"Cost: {_g(cost['real_time_factor'])} times real time, measured just now on this machine"
        f" ({_g(cost['simulated'])} s simulated in {_g(cost['elapsed'])} s, a sample of the motion every {_g(cost['sample'])} s)",
    ]
    if found["warnings"]:
        text += ["", "Warnings", *(f"  {warning}" for warning in found["warnings"])]
    return "\n".join(text)


def _g(value):
    return f"{value:.4g}" if abs(value) < 1e4 else f"{value:.5g}"
