"""Run benchmarks: ``python -m benchmarks [NAMES] [--quick] [-o DIR] [--docs]``."""

import argparse
import importlib
import json
import sys
from pathlib import Path

from . import machine, tables

BENCHMARKS = {
    "peer_moordyn": "OC4 and VolturnUS-S chains: how far the converged runs of MoorDyn and ours are apart",
    "peer_cost": "what a simulated second costs beside MoorDyn's and CableDyn's best, at the same error (the peers' runs are kept)",
    "trade": "what mooring trade says of error and cost against the truth, on six scenes kept aside (half an hour)",
    "trades": "the trade of speed for accuracy on twelve moorings, beside MoorDyn's and CableDyn's best (half an hour)",
    "closed_forms": "statics and platform stiffness against closed forms",
    "cold_statics": "what the statics of whole scenes take from a cold start, and what is left out of balance (a quarter of a minute)",
    "extremes": "the battery of extremes beside MoorDyn, and ten thousand random scenes (an hour or two)",
    "guard": "what the guard against blow-ups costs",
    "kernel_cost": "ns for one node and force evaluation, against a bare vector kernel",
    "implicit_steps": "implicit steps: how far off and how dear, beside explicit ones (half a minute)",
    "growth": "cost per node from 60 to 150 000 nodes, and a thousand platforms in real time (three minutes)",
    "effects": "a scene without an effect against builds in which that effect's stage is removed (half an hour the first time: it compiles them)",
    "bergdahl": "the 33 m laboratory chain: 30 measured maxima",
    "bending": "the cantilevers of Hall, Srinivas and Yu against MoorDyn and the exact elastica: tip deflection, and decay",
    "rm3_cable": "the RM3 umbilical in waves against MoorDyn and CableDyn: tension and curvature along the cable (a quarter of an hour)",
    "waves": "the sea: a long realisation, and the water's motion against MoorDyn's",
    "bathymetry": "the VolturnUS-S semi-taut mooring on four beds without friction, against MoorDyn and CableDyn",
    "friction": "bed friction along and across a chain and in waves: both laws, closed form, CableDyn",
    "bar": "a chain dragged along a rough bed and let back: both laws against the bar on a Coulomb bed",
    "energy": "a driven cable with bending stiffness and no losses: its account of energy over 100 periods",
    "parts": "a sphere that falls, one that heaves, and a rod that swings, against closed forms",
    "iswec": "load and excursion of the two ISWEC moorings, against MoorPy",
    "ropes": "a viscoelastic rope, stretched, held and swung, against closed forms and MoorDyn",
    "fidelity": "the linear fidelity beyond its range, and the estimate of a mooring's error, against the truth (two minutes)",
    "coupled_decay": "a floater on moorings, coupled with the node over DDS, against both as one system: period, damping, order (six minutes)",
    "coupled_delay": "the same with a delay of the wrench: damping that is lost, and what prediction in the node gives back (five minutes)",
    "platforms": "two floaters that share a chain, each with its own motion: tensions and forces beside MoorDyn's, and the cost (twenty seconds)",
    "node_latency": "the ROS 2 node: input stamp to wrench, against an empty echo node",
    "late_spring": "a spring that answers late: the damping that is lost, and what prediction gives back (ten seconds)",
    "late_platforms": "two floaters on shared moorings that answer late: the damping that each mode loses, and what prediction gives back (twenty seconds)",
    "delay": "how far the force of a running node lags the motion, with prediction and without (two minutes)",
    "motion_capture": "noise, bunched stamps and lost frames of a camera system: what they make of velocities and of the force (a minute)",
    "timing": "the node at 200 and 500 Hz, idle and loaded, with and without SCHED_FIFO, beside an empty loop (25 minutes; --steps 1000000: 20 hours)",
    "loops": "three ways in which a loop on rclpy can wait for its deadlines, with and without SCHED_FIFO (two minutes)",
    "faults": "everything that may go wrong around a running node, done to it from outside (five minutes)",
    "look": "the pictures of docs/look.md, from a real run of the node",
    "soak": "an hour of the node at 200 Hz with recording: nothing missing, nothing growing, replayed bit for bit",
}
# Where it is not the name itself.
MODULES = {"node_latency": "latency_table", "extremes": "extremes.report", "faults": "faults.campaign", "soak": "faults.soak"}
# Those whose module has `add_arguments(parser)`, for options of their own behind their name: `bench soak --minutes 10`.
WITH_OPTIONS = ("faults", "soak", "timing")
DOCS = Path(__file__).parent.parent / "docs"
DEFAULT_DOCUMENT = DOCS / "measurements.md"


def arguments(argv):
    """Parse the command line."""
    listing = "\n".join(f"  {name:<14} {what}" for name, what in BENCHMARKS.items())
    parser = argparse.ArgumentParser("bench", description="side-by-side benchmarks", epilog=listing, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="which; all when none is named")
    parser.add_argument("--quick", action="store_true", help="fewer settings, shorter runs; figures are rougher")
    parser.add_argument("-o", "--output", type=Path, default=Path("out/bench"), metavar="DIR", help="where the JSON results go (default: %(default)s)")
    parser.add_argument("--docs", action="store_true", help="put the tables and pictures into docs/")
    common = {action.dest for action in parser._actions}
    first = argv[0] if argv else None
    if first in WITH_OPTIONS:
        load(first).add_arguments(parser.add_argument_group(f"of {first} alone"))
    chosen = parser.parse_args(argv)
    chosen.options = {name: value for name, value in vars(chosen).items() if name not in common}
    if first in WITH_OPTIONS and len(chosen.names) > 1:
        parser.error(f"{first} has options of its own, expected no other name with it")
    unknown = [name for name in chosen.names if name not in BENCHMARKS]
    if unknown:
        parser.error(f"no benchmark is called {unknown[0]}; there are: {', '.join(BENCHMARKS)}")
    return chosen


def load(name):
    """The module of a benchmark. Raises ModuleNotFoundError when it, or a peer, is not installed."""
    return importlib.import_module(f".{MODULES.get(name, name)}", __package__)


def document(contents, pictures, sentence):
    """Put tables (name -> Markdown) between their markers in the documents, and pictures (file name -> figure) beside them."""
    texts = {path: path.read_text(encoding="utf-8") for path in sorted(DOCS.glob("*.md"))}
    for key, content in contents.items():
        path = next((p for p, text in texts.items() if f"<!-- {key} -->" in text), DEFAULT_DOCUMENT)
        texts[path] = tables.refresh(texts[path], key, f"{content}\n\n{sentence}")
    for path, text in texts.items():
        path.write_text(text, encoding="utf-8")
    for name, figure in pictures.items():
        figure.savefig(DOCS / "images" / name, dpi=110)


def lacking(missing):
    """Say which package a benchmark lacks; the exit status."""
    print(f"bench: the package {missing.name} is not installed; ./run bench installs the peers", file=sys.stderr)
    return 2


def main(argv=None):
    """0 all goals reached, 1 a goal missed or a benchmark failed, 2 bad usage, 130 interrupted."""
    try:
        chosen = arguments(sys.argv[1:] if argv is None else argv)
    except ModuleNotFoundError as missing:
        return lacking(missing)
    facts = machine.describe()
    print(machine.sentence(facts), flush=True)
    chosen.output.mkdir(parents=True, exist_ok=True)
    failed = []
    for name in chosen.names or BENCHMARKS:
        print(f"\n== {name}: {BENCHMARKS[name]}", flush=True)
        try:
            module = load(name)
        except ModuleNotFoundError as missing:
            return lacking(missing)
        result = module.run(chosen.quick, **chosen.options)
        result["machine"] = facts
        pictures = result.pop("figures", {})
        (chosen.output / f"{name}.json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
        if chosen.docs:
            document(result["tables"], pictures, machine.sentence(facts))
        for miss in result["failed"]:
            print(f"MISSED: {miss}", flush=True)
        failed += result["failed"]
    return 1 if failed else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
