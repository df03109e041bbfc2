"""Only what is there: a scene without an effect against a build of the package in which that effect's stage is removed.

The builds are copies of the package, patched (`removed.py`). Both run in processes of their own and are asked in turns, A B A B, so that what the
machine does besides hits both; the medians count.
"""

import os
import pickle
import subprocess
import sys
import tempfile
from contextlib import ExitStack
from pathlib import Path

import numpy as np

from mooring_ros import Mooring

from . import removed, tables

SCENE = Path(__file__).parent.parent / "config" / "scenes" / "oc4.txt"  # has none of the effects
WORKER = Path(__file__).parent / "effects_worker.py"
BUILDS = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "mooring_ros" / "builds"
SEGMENTS = 20  # of a line: few, since looking whether a stage is taken costs the same for all numbers of nodes
COUNTS = {"evaluation": 4000, "run": 200}  # evaluations, samples of each of the moorings in a worker: some 30 ms
PAIRS, TURNS = 4, 15  # processes of each build, and how often they take turns
GOAL = 0.02
NOTHING = "nothing (how far two equal builds are apart)"


def settled(folder):
    """File with the settled state of the scene."""
    mooring = Mooring(SCENE, segments=SEGMENTS)
    mooring.settle([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
    path = Path(folder) / "settled.pickle"
    path.write_bytes(pickle.dumps(list(mooring.snapshot().state)))
    return path


class Build:
    """A process with a build of the package in which the stages of `effects` are removed."""

    def __init__(self, effects, state, stack):
        command = [sys.executable, str(WORKER), str(SCENE), str(SEGMENTS), str(state)]
        folder = removed.build(effects, BUILDS)
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


def compare(effects, pairs, turns):
    """{what: (median cost with the stage over that without it, less 1; its standard error)}: the mean of several pairs of processes.

    Even equal builds differ from process to process by more than from turn to turn: by where their memory lies.
    """
    ratios = {what: [] for what in COUNTS}
    with tempfile.TemporaryDirectory() as folder:
        state = settled(folder)
        for _ in range(pairs):
            with ExitStack() as stack:
                whole, without = Build([], state, stack), Build(effects, state, stack)
                for what, count in COUNTS.items():
                    took = []
                    for turn in range(turns + 1):
                        order = (whole, without) if turn % 2 == 0 else (without, whole)
                        answers = {build: build.measure(what, count) for build in order}
                        if answers[whole][1] != answers[without][1]:
                            raise RuntimeError(f"without the stage of {', '.join(effects)} the forces are others")
                        took.append((answers[whole][0], answers[without][0]))
                    medians = np.median(took[1:], axis=0)  # the first turn warms up
                    ratios[what].append(medians[0] / medians[1])
    return {what: (float(np.mean(found)) - 1.0, float(np.std(found, ddof=1) / np.sqrt(len(found)))) for what, found in ratios.items()}


def run(quick=False):
    """All effects; prints the table."""
    cases = {NOTHING: [], removed.ALL: list(removed.STAGES), **{name: [name] for name in removed.STAGES}}
    rows, body, failed = [], [], []
    for name, effects in cases.items():
        found = compare(effects, 2 if quick else PAIRS, 7 if quick else TURNS)
        rows.append({"removed": name, "more": found})
        body.append([name, *(f"{100 * more:+.1f} ± {100 * error:.1f} %" for more, error in found.values())])
        failed += [
            f"{what}: {100 * more:.1f} % more than without the stage of {name}, goal {100 * GOAL:g} %"
            for what, (more, error) in found.items()
            if effects and more - 2.0 * error > GOAL
        ]
        print(" | ".join(body[-1]), flush=True)
    content = {"effects": tables.table(["stage removed", "an evaluation costs more with it by", "a run"], body)}
    print(content["effects"], flush=True)
    return {"rows": rows, "tables": content, "failed": failed}
