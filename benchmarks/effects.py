"""Only what is there: a scene without an effect against a build of the package in which that effect's stage is removed.

The builds are copies of the package, patched (`removed.py`). Both run in processes of their own and are asked in turns, A B A B, so that what the
machine does besides hits both; the medians count.
"""

import os
import subprocess
import sys
import tempfile
from contextlib import ExitStack
from pathlib import Path

import numpy as np

from . import removed, tables

SCENE = Path(__file__).parent.parent / "config" / "scenes" / "oc4.txt"  # has none of the effects
WORKER = Path(__file__).parent / "effects_worker.py"
SEGMENTS = (20, 100)
COUNTS = {("evaluation", 20): 30000, ("evaluation", 100): 7000, ("run", 20): 1000, ("run", 100): 150}  # some 20 ms each
TURNS = 41
GOAL = 0.02
NOTHING = "nothing (how far two equal builds are apart)"


class Build:
    """A process with a build of the package in which the stages of `effects` are removed."""

    def __init__(self, effects, segments, stack):
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        removed.build(effects, folder)
        command = [sys.executable, str(WORKER), str(SCENE), str(segments)]
        self.process = stack.enter_context(
            subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": str(folder)}, cwd=folder)
        )
        stack.callback(self.process.stdin.close)
        self._answer("ready")

    def measure(self, what, count):
        """(s of CPU time, hash of the forces)."""
        self.process.stdin.write(f"{what} {count}\n")
        self.process.stdin.flush()
        taken, forces = self._answer("a time and a hash").split()
        return float(taken), forces

    def _answer(self, expected):
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"the process of a build has ended; expected {expected}")
        return line


def compare(effects, segments, turns):
    """{what: (median cost with the stage over that without it, less 1; its standard error)}, in turns."""
    found = {}
    with ExitStack() as stack:
        whole, without = Build([], segments, stack), Build(effects, segments, stack)
        for what in ("evaluation", "run"):
            count = COUNTS[what, segments]
            pairs = []
            for turn in range(turns + 2):
                order = (whole, without) if turn % 2 == 0 else (without, whole)
                took = {build: build.measure(what, count) for build in order}
                if took[whole][1] != took[without][1]:
                    raise RuntimeError(f"without the stage of {', '.join(effects)} the forces are others")
                pairs.append((took[whole][0], took[without][0]))
            with_it, bare = np.array(pairs[2:]).T
            ratio = with_it / bare
            found[what] = np.median(with_it) / np.median(bare) - 1.0, 1.25 * ratio.std() / np.sqrt(turns)
    return found


def run(quick=False):
    """All effects; prints the table."""
    cases = {NOTHING: [], **{name: [name] for name in removed.STAGES}, removed.ALL: list(removed.STAGES)}
    rows, body, failed = [], [], []
    for name, effects in cases.items():
        cells = []
        for segments in SEGMENTS[:1] if quick else SEGMENTS:
            found = compare(effects, segments, 11 if quick else TURNS)
            rows.append({"removed": name, "segments": segments, "more": found})
            for what, (more, error) in found.items():
                cells.append(f"{100 * more:+.1f} ± {100 * error:.1f} %")
                if effects and more - 2.0 * error > GOAL:
                    failed.append(f"3 x {segments}, {what}: {100 * more:.1f} % more than without the stage of {name}, goal {100 * GOAL:g} %")
        body.append([name, *cells])
        print(" | ".join(body[-1]), flush=True)
    head = ["stage removed", *(f"3 × {segments}: {what}" for segments in (SEGMENTS[:1] if quick else SEGMENTS) for what in ("an evaluation", "a run"))]
    content = {"effects": tables.table(head, body)}
    print(content["effects"], flush=True)
    return {"rows": rows, "tables": content, "failed": failed}
