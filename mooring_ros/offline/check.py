"""`mooring check`: what a scene contains, what is switched on because of it, its largest stable step and its cost."""

import math

from .arguments import add_platforms_argument, load_mooring, names_of, remarks_on
from .console import ComputationFailed, Preparing, print_json
from .contents import contents, contents_text, g
from .effects import effects, with_shares
from .measure import measured_cost
from .shares import cost_shares


def add_arguments(parser):
    parser.add_argument("scene", metavar="SCENE", help="MoorDyn v2 input file, or a recording that holds one")
    add_platforms_argument(parser)
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output, nothing else")


def run(args):
    with Preparing("check"):
        mooring = load_mooring(args.scene, platforms=names_of(args.platforms) or None)
    found = {"scene": str(args.scene), **contents(mooring.scene)}
    try:
        with Preparing("check"):
            found |= measured(args.scene, mooring)
    except ComputationFailed:
        if not args.json:  # what is in the scene may show why
            print("\n".join([*contents_text(found), *_warnings_text(remarks_on(mooring))]))
        raise
    if args.json:
        print_json(found)
    else:
        print(_text(found))
    return 0


def measured(path, mooring):
    """What computing a scene shows, as the second half of the object that --json prints. Raises ComputationFailed."""
    from mooring_ros.mooring import MooringError

    scene = mooring.scene
    try:
        mooring.settle(mooring.pose_in_file)
        switched, passes = with_shares(effects(scene, mooring), cost_shares(mooring))
        limit = mooring.step_limit
        cost = measured_cost(mooring)
    except MooringError as error:
        raise ComputationFailed(f"{path}: {error}") from error
    return {
        "platforms": list(mooring.platforms or ()),
        "effects": switched,
        "cost_shares": passes,
        "solver": {"name": mooring.solver, "why": mooring.choice},
        "step_limit": {
            "dt": float(limit.dt),
            "limited_by": limit.limited_by,
            "limits": {name: float(step) if math.isfinite(step) else None for name, step in limit.limits.items()},
        },
        "cost": cost,
        "warnings": remarks_on(mooring),
    }


def _text(found):
    limit, cost = found["step_limit"], found["cost"]
    switched = [["on" if effect["on"] else "off", effect["name"], _share(effect), effect["why"]] for effect in found["effects"]]
    beside = [(row["what"], _percent(row["share"])) for row in found["cost_shares"] if not row["effects"]]
    width = max(len(name) for name in [row[1] for row in switched] + [what for what, _ in beside])
    text = [
        *contents_text(found),
        *(["", f"Platforms of their own: {', '.join(found['platforms'])}"] if found["platforms"] else []),
        "",
        "Effects, with their share of the CPU time of steps, measured just now on this machine",
        *(f"  {state:3}  {name.ljust(width)}  {share:>6}  {why}" for state, name, share, why in switched),
        *(f"       {what.ljust(width)}  {share:>6}" for what, share in beside),
        "  (″: in the same pass as an effect above)",
        "",
        f"Solver: {found['solver']['why']}",
        f"Largest stable step: {g(limit['dt'])} s, limited by {limit['limited_by']}",
        "Limits of a plain leapfrog step",
        *(f"  {name}: {g(step)} s" if step else f"  {name}: no limit" for name, step in limit["limits"].items()),
        "",
        f"Cost: {g(cost['real_time_factor'])} times real time, measured just now on this machine"
        f" ({g(cost['simulated'])} s simulated in {g(cost['elapsed'])} s, a sample of the motion every {g(cost['sample'])} s)",
        *_warnings_text(found["warnings"]),
    ]
    return "\n".join(text)


def _warnings_text(warnings):
    return ["", "Warnings", *(f"  {warning}" for warning in warnings)] if warnings else []


def _share(effect):
    """An effect's share; a mark when it is in the share of an earlier one."""
    if effect["share"] is None:
        return ""
    return _percent(effect["share"]) if effect["share_with"][0] == effect["name"] else "″"


def _percent(share):
    return f"{100.0 * share:.1f} %"
