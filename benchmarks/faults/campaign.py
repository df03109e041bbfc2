"""`./run bench faults`: all faults, one after the other, and the table of docs/faults.md."""
import contextlib
import re
import sys
import tempfile
import time
import traceback

from . import clocks, commands, disks, inputs, modes, processes, sources
from .judge import Wrong
from .registry import FAULTS
from .rig import Rig
from .setups import SETUPS

GROUPS = (inputs, clocks, modes, sources, commands, disks, processes)    # in the order of the table; importing them fills the list
HEADER = ("fault", "shown in `/diagnostics` as", "after (s)", "wrenches checked", "recovery")


def add_arguments(parser):
    """Options of `bench faults`."""
    parser.add_argument("--only", metavar="NAME", action="append", help="a fault to do, by its name; may be given again")


def run(quick=False, only=None):
    """Do the faults; quick: those of the tests alone."""
    unknown = set(only or ()) - {fault.name for fault in FAULTS}
    if unknown:
        raise SystemExit(f"bench: no fault is called {', '.join(sorted(unknown))}; there are: {', '.join(fault.name for fault in FAULTS)}")
    chosen = [fault for fault in FAULTS if fault.name in (only or [f.name for f in FAULTS]) and (fault.quick or not quick)]
    rows, failed, worst = [], [], 0.0
    for node in dict.fromkeys(fault.node for fault in chosen):
        for fault, outcome in outcomes([fault for fault in chosen if fault.node == node]):
            print(f"{fault.name:<32} {outcome['verdict']}  {outcome['seconds']:.1f} s", flush=True)
            rows.append([fault.act.__module__, fault.what, *outcome["cells"], fault.recovery])
            worst = max(worst, outcome["worst"])
            if outcome["verdict"] != "ok":
                failed.append(f"{fault.name}: {outcome['verdict']}")
    words = (f"{len(rows)} faults, {len(failed)} of them not as documented; wrenches at most {worst:.1e} of the largest force off a `Mooring` "
             "that was given the same samples.")
    whole = {} if only or quick else {"faults": _table(rows) + "\n\n" + words}     # a part of it is no table for the documents
    return {"tables": whole, "failed": failed, "rows": rows, "worst": worst}


def _table(rows):
    """Markdown, a table for each group. Cells are sentences, too long to be padded."""
    parts = []
    for group in GROUPS:
        own = [row[1:] for row in rows if row[0] == group.__name__]
        if own:
            lines = ["| " + " | ".join(map(str, row)) + " |" for row in [HEADER, ["---"] * len(HEADER), *own]]
            parts.append("\n".join([f"**{group.__doc__.splitlines()[0].rstrip('.')}**", "", *lines]))
    return "\n\n".join(parts)


def outcomes(faults):
    """Yields (fault, outcome) of faults that share a node, or that start their own."""
    rig = None
    with contextlib.ExitStack() as stack:
        for fault in faults:
            begin = time.monotonic()
            if fault.node:
                if rig is None or not rig.process.alive:    # the first one, or after one that ended it
                    stack.close()
                    rig = stack.enter_context(Rig(SETUPS[fault.node]))
                else:
                    rig.fresh()
            yield fault, {**_outcome(fault, rig), "seconds": time.monotonic() - begin}


def _outcome(fault, rig):
    verdict = "ok"
    with contextlib.ExitStack() as stack:
        try:
            if rig is None:
                rig = fault.act(stack.enter_context(tempfile.TemporaryDirectory(prefix="mooring_faults_")))
            else:
                fault.act(rig)
                rig.judged()
        except (Wrong, TimeoutError, AssertionError) as error:
            verdict = str(error) or repr(error)
            if not isinstance(error, (Wrong, TimeoutError)):
                traceback.print_exc(file=sys.stderr)
    if rig is None:
        return {"verdict": verdict, "cells": ["", "", ""], "worst": 0.0}
    shown = "; ".join(f"{name}: {_short(words)}" for name, words, _ in rig.shown)
    after = max((after for *_, after in rig.shown), default=None)
    cells = [shown or "nothing: it is none to the node", "" if after is None else f"{after:.2f}", rig.judge.checked]
    worst, rig.judge.checked, rig.judge.worst = rig.judge.worst, 0, 0.0
    return {"verdict": verdict, "cells": cells, "worst": worst}


def _short(words, most=110):
    words = re.sub(r"/tmp/mooring_faults_\w+", "…", " ".join(words.split())).replace("|", "/").removeprefix("refused: ")
    return words if len(words) <= most else words[:most] + " …"
