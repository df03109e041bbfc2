"""What one evaluation of the equations of motion costs for each node, against a bare vector kernel over as many array streams.

The bare kernel does nothing but read and write: triads ``a = b + c + d`` over separate rows, as many reads and writes as the
evaluation's passes have. It is what the memory and the loop cost at this length without any physics. Both are timed in this process, alternating.
"""

import time
from pathlib import Path

import numba
import numpy as np

from mooring_ros.core.forces import evaluate
from mooring_ros.core.points import place_coupled_points
from mooring_ros.scene import load_scene

from . import ours, tables
from .motions import SurgeHeave

SCENE = Path(__file__).parent.parent / "config" / "scenes" / "oc4.txt"
NODES = (60, 120, 300, 1000, 10000)
GOAL = 10e-9  # s for a node and evaluation
GOAL_FROM = 120  # nodes
WRITES = 17  # rows written by the passes of one evaluation; they read 46, the bare kernel 51
ROUNDS = 7


@numba.njit(nogil=True)
def repeat_evaluation(model, state, scratch, count):
    """Forces and accelerations of all nodes, under water, ``count`` times."""
    for _ in range(count):
        evaluate(model, state, scratch, state.settings[0], state.settings[1], False, True)


@numba.njit(nogil=True)
def repeat_evaluation_in_step(model, state, scratch, count):
    """The same as a step does it: the platform's points are moved first, and wet shares computed if anything is near the surface."""
    for _ in range(count):
        place_coupled_points(model, state, scratch.motion, 0.5)
        evaluate(model, state, scratch, state.settings[0], state.settings[1], state.settings[2] != 0.0, True)


@numba.njit(nogil=True)
def triads(rows, size):
    """One write and three reads for each of ``WRITES`` rows."""
    for k in range(WRITES):
        a, b, c, d = rows[k], rows[k + 1], rows[k + 2], rows[k + 3]
        for i in range(size):
            a[i] = b[i] + c[i] + d[i]


@numba.njit(nogil=True)
def repeat_triads(rows, size, count):
    """Run the bare kernel ``count`` times."""
    for _ in range(count):
        triads(rows, size)


def fastest(calls, seconds):
    """Least CPU time (s) of one repetition of each call, rounds alternating; a call gets the number of repetitions."""
    counts = []
    for call in calls:
        call(1)
        count = 1
        while True:
            began = time.process_time()
            call(count)
            if time.process_time() - began > 0.01:
                break
            count *= 4
        counts.append(max(1, round(count * seconds / (time.process_time() - began))))
    best = [np.inf] * len(calls)
    for _ in range(ROUNDS):
        for k, call in enumerate(calls):
            began = time.process_time()
            call(counts[k])
            best[k] = min(best[k], (time.process_time() - began) / counts[k])
    return best


def measure(scene, nodes, seconds):
    """One row: nodes, s for a node and evaluation, the same within a step and of the bare kernel, ratio to the latter."""
    segments = round(nodes / len(scene.lines)) - 1
    mooring = ours.Mooring(scene, solver="explicit", segments=segments)
    motion = SurgeHeave()
    mooring.settle(ours.at_rest(motion))
    times, poses, twists = ours.samples(motion, 20.0)
    mooring.run(times[:20], poses[:20], twists[:20])
    given = mooring._model, mooring._state, mooring._scratch  # what the facade hands to the core
    size = given[0].size
    rows = np.random.default_rng(0).random((WRITES + 3, size + 1))
    calls = [lambda n: repeat_evaluation(*given, n), lambda n: repeat_evaluation_in_step(*given, n), lambda n: repeat_triads(rows, size, n)]
    count = (segments + 1) * len(scene.lines)
    plain, in_step, bare = (x / count for x in fastest(calls, seconds))
    return {"nodes": count, "evaluation": plain, "in_step": in_step, "bare": bare, "ratio": plain / bare}


def run(quick=False):
    """All sizes; prints the table."""
    scene = load_scene(SCENE)
    rows = [measure(scene, nodes, 0.02 if quick else 0.1) for nodes in NODES]
    body = [[r["nodes"], *(f"{1e9 * r[key]:.1f}" for key in ("evaluation", "in_step", "bare")), f"{r['ratio']:.2f}"] for r in rows]
    content = {"kernel_cost": tables.table(["nodes", "ns for a node and evaluation", "within a step", "bare kernel", "evaluation to bare"], body)}
    print(content["kernel_cost"], flush=True)
    failed = [
        f"{r['nodes']} nodes: {1e9 * r['evaluation']:.1f} ns for a node and evaluation, goal {1e9 * GOAL:.0f}"
        for r in rows
        if r["nodes"] >= GOAL_FROM - 3 and r["evaluation"] > GOAL
    ]
    return {"rows": rows, "tables": content, "failed": failed}
