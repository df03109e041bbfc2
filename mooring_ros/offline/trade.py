"""`mooring trade`: the speed-accuracy trade of a scene on this machine, and the setting to use."""

import time
from pathlib import Path

from .arguments import add_topic_arguments, load_mooring, names_of, positive
from .console import ComputationFailed, complain, print_json, reading
from .files import check_output

TIME = 120.0  # s of CPU time
FOR_REFERENCE = 0.4  # of it, at most
SCOUTING = 0.1  # of it, for finding the window
PARAMETERS = "trade_parameters.yaml"
QUANTITIES = {"tension": "errors", "force": "force_errors"}


def add_arguments(parser):
    parser.add_argument("scene", metavar="SCENE", help="MoorDyn v2 input file, or a recording that holds one")
    parser.add_argument("motion", metavar="MOTION", help="the motion that is traded on: CSV or MCAP, as for replay")
    parser.add_argument("--budget", type=positive, metavar="FACTOR",
                        help="choose the most accurate setting that is at least this many times as fast as real time")
    parser.add_argument("--error", type=positive, metavar="PERCENT",
                        help="choose the cheapest setting with no more error, in mean, dynamic and peak tension")
    parser.add_argument("-o", "--output", metavar="REPORT.html", help="write a report with plots: one file, no network")
    parser.add_argument("--of", choices=tuple(QUANTITIES), default="tension",
                        help="what the error is of: the fairlead tension as published, that of the end segment (tension, the default), "
                        "or the force at the fairlead, of which the wrench is made (force)")
    parser.add_argument("--time", type=positive, default=TIME, metavar="S",
                        help=f"CPU time that it may take, s, without compiling (default {TIME:g})")
    add_topic_arguments(parser)
    parser.add_argument("--fresh", action="store_true", help="measure again what is in the cache")
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output, nothing else")


def run(args):
    if args.output:
        check_output(args.output, args.scene, args.motion, suffix=".html")
    parameters = Path(args.output).with_suffix(".yaml") if args.output else Path(PARAMETERS)
    wanted = args.error is not None or args.budget is not None
    if wanted:
        check_output(parameters, args.scene, args.motion)
    motion = _motion(args)
    scene = load_mooring(args.scene, platforms=motion.platforms or None).scene
    for remark in (*scene.warnings, *motion.remarks):
        complain(remark)
    try:
        found = trade(scene, motion, error=args.error, budget=args.budget, of=args.of, seconds=args.time, fresh=args.fresh)
    except KeyboardInterrupt:
        complain("trade: what has been measured is kept, and the same command goes on from there")
        raise
    except ComputationFailed as failure:
        raise ComputationFailed(f"{args.scene}: {failure}") from failure
    found.scene, found.motion = str(args.scene), str(args.motion)
    found.chosen_motion = tuple(word for option in ("topic", "platforms") if (said := getattr(args, option)) is not None for word in (f"--{option}", said))
    if found.chosen is not None:
        _write_parameters(args, scene, parameters, found, motion.platforms)
    if args.output:
        from .trade_report import write

        with reading(args.output):
            write(args.output, found)
    if args.json:
        print_json(found.as_dict())
    else:
        from .trade_text import text

        print(text(found))
        if args.output:
            print(f"\nReport: {args.output}")
    if wanted and found.chosen is None:
        raise ComputationFailed(f"{args.scene}: {found.why}")
    return 0


def trade(scene, motion, error=None, budget=None, of="tension", seconds=TIME, fresh=False):
    """Found, of a Scene and a motion_file.Motion. error: per cent; budget: times real time; seconds: of CPU time. Raises ComputationFailed."""
    from . import trade_window
    from .trade_cache import Cache
    from .trade_choice import Goal, choose, front
    from .trade_found import Found
    from .trade_reference import WELL_BELOW, converged_reference
    from .trade_runner import Bar, Runner
    from .trade_sweep import Sweep

    began = time.perf_counter()
    goal = Goal(error, budget, QUANTITIES[of])
    cache = Cache(scene, motion, fresh)
    with Bar(seconds) as bar:
        runner = Runner(scene, cache, bar, motion.platforms or None)
        runner.window = window = _window(trade_window, runner, motion, seconds)
        reference = converged_reference(
            scene, window, lambda setting: runner.need(setting), WELL_BELOW * (error or 1.0), lambda: FOR_REFERENCE * seconds - runner.spent
        )
        sweep = Sweep(runner, reference, goal, lambda: seconds - runner.spent)
        sweep.explore()
    chosen, why = choose(sweep.usable, goal) if error is not None or budget is not None else (None, "")
    if not sweep.usable:
        raise ComputationFailed("no setting could be run: " + "; ".join(sorted({r.refused for r in sweep.results if r.refused})))
    return Found(
        window=window, reference=reference, results=sorted(sweep.results, key=_order), front=front(sweep.usable, goal.of),
        left_out=sweep.left_out, chosen=chosen, why=why, goal=goal, of=of, line_names=[line.name for line in scene.lines], runs=runner.runs, from_cache=cache.read,
        cpu=runner.spent, elapsed=time.perf_counter() - began,
    )


def _order(result):
    return result.setting.method, result.refused is not None, result.cost


def _window(trade_window, runner, motion, seconds):
    """The window, found with the default setting over a tenth of the motion and, where that is affordable, over all of it."""
    from .trade_setting import Setting

    everything = trade_window.whole(motion)
    default, allowed = Setting("dynamic", "auto"), SCOUTING * seconds
    share = trade_window.first_part(everything)
    cost = runner.need(default, window=share, what="default setting").cost
    tension = None
    if cost * everything.duration < allowed:
        scout = runner.need(default, window=everything, what="default setting")
        cost, tension = scout.cost, scout.tension
    return trade_window.choose(motion, cost, tension, seconds)


def _motion(args):
    from .motion_file import load_motion
    from .trade_motion import one_stretch

    with reading(args.motion):
        return one_stretch(load_motion(args.motion, args.topic, names_of(args.platforms)))


def _write_parameters(args, scene, path, found, platforms):
    from .trade_parameters import write_parameters

    if not Path(scene.path).is_file():
        complain(f"{args.scene}: is a recording, and the node reads a MoorDyn v2 file: set scene in {path} to one")
    with reading(path):
        write_parameters(path, scene.path or args.scene, found.chosen.setting, f"mooring trade {args.scene} {args.motion}: {found.why}", platforms)
    found.parameters = str(path)
