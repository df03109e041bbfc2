"""`mooring check`: what a scene contains, what is switched on because of it, its largest stable step and its cost."""

import math

from .arguments import load_mooring
from .console import ComputationFailed, print_json
from .contents import contents, contents_text, g
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
        **contents(scene),
        "effects": switched,
        "step_limit": {
            "dt": float(limit.dt),
            "limited_by": limit.limited_by,
            "limits": {name: float(step) if math.isfinite(step) else None for name, step in limit.limits.items()},
        },
        "cost": cost,
        "warnings": list(scene.warnings),
    }


def _text(found):
    limit, cost = found["step_limit"], found["cost"]
    switched = [["on" if effect["on"] else "off", effect["name"], effect["why"]] for effect in found["effects"]]
    width = max(len(row[1]) for row in switched)
    text = [
        *contents_text(found),
        "",
        "Effects",
        *(f"  {state:3}  {name.ljust(width)}  {why}" for state, name, why in switched),
        "",
        f"Largest stable step: {g(limit['dt'])} s, limited by {limit['limited_by']}",
        "Limits of a plain leapfrog step",
        *(f"  {name}: {g(step)} s" if step else f"  {name}: no limit" for name, step in limit["limits"].items()),
        "",
        f"Cost: {g(cost['real_time_factor'])} times real time, measured just now on this machine"
        f" ({g(cost['simulated'])} s simulated in {g(cost['elapsed'])} s, a sample of the motion every {g(cost['sample'])} s)",
    ]
    if found["warnings"]:
        text += ["", "Warnings", *(f"  {warning}" for warning in found["warnings"])]
    return "\n".join(text)
