"""What the statics of whole scenes take from a cold start, after compilation: CPU time, iterations, and what is left out of balance."""

import math
import time

from mooring_ros import Mooring
from mooring_ros.scene import load_scene

from . import tables
from .moordyn_history import SCENES

PLACE = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
ROUNDS = 5  # the fastest counts
CABLE, GOAL, RESIDUAL = "rm3_cable", 0.05, 1e-8  # s, and of the weight: the goal is set for one scene


def heaviest(scene):
    """N: submerged weight of the heaviest line."""
    env = scene.environment
    return max(abs(n.type.mass - env.water_density * math.pi / 4.0 * n.type.diameter**2) * env.gravity * n.length for n in scene.lines)


def measure(scene):
    """(s of CPU time, iterations, residual over the heaviest line's weight) of a settle at the file's place."""
    least = math.inf
    for _ in range(ROUNDS + 1):  # the first one may compile
        mooring = Mooring(scene)
        began = time.process_time()
        mooring.settle(PLACE)
        taken = time.process_time() - began
        least = taken if math.isinf(least) else min(least, taken)
        result = mooring.static_result
    return least, result.iterations, result.residual / heaviest(scene)


def run(quick=False):
    """All scenes in config/scenes (quick: the one with a goal); prints the table."""
    body, failed = [], []
    for path in sorted(SCENES.glob("*.txt")):
        if quick and path.stem != CABLE:
            continue
        scene = load_scene(path)
        taken, iterations, residual = measure(scene)
        body.append([path.stem, sum(line.segments for line in scene.lines), f"{1e3 * taken:.3g}", iterations, f"{residual:.0e}"])
        if path.stem == CABLE and (taken > GOAL or residual > RESIDUAL):
            failed.append(f"{CABLE}: {1e3 * taken:.3g} ms, {residual:.0e} of the weight; goals {1e3 * GOAL:g} ms, {RESIDUAL:g}")
    content = {"cold_statics": tables.table(["scene", "segments", "CPU, ms", "iterations", "residual / weight"], body)}
    print(content["cold_statics"], flush=True)
    return {"tables": content, "failed": failed}
