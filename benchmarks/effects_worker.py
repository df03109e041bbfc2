"""One build of the package, timed on request: ``python effects_worker.py SCENE SEGMENTS SETTLED`` with that build first on the path.

SETTLED is a pickle of what `settle` gave (`settled`): settling here would compile the statics of every build. Reads what to time from standard input, a line each, "evaluation" or "run", and answers with the CPU time (s) and a hash of the forces.
"""

import hashlib
import pickle
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from mooring_ros import Mooring
from mooring_ros.core import costs
from mooring_ros.scene import load_scene

RATE = 20.0  # Hz
PLACES = 12


class Worker:
    """Settled moorings, all alike but for where their arrays lie in memory: by that alone two equal builds can be 6 % apart."""

    def __init__(self, scene, segments, settled):
        arrays = pickle.loads(Path(settled).read_bytes())
        random, self.spacers, self.moorings = np.random.default_rng(1), [], []
        scene = load_scene(scene)
        for _ in range(PLACES):
            mooring = Mooring(scene, segments=segments)
            self.spacers.append([np.zeros(int(size)) for size in random.integers(1, 200, 50)])
            blank = mooring.snapshot()
            saved = replace(blank, state=type(blank.state)(*arrays), settled=True)
            mooring.restore(saved)
            self.moorings.append((mooring, saved))
        self.times = np.arange(1, 1001) / RATE
        self.poses, self.twists = np.zeros((1000, 7)), np.zeros((1000, 6))
        self.poses[:, 0], self.poses[:, 6] = 1.0 - np.cos(0.4 * self.times), 1.0
        self.twists[:, 0] = 0.4 * np.sin(0.4 * self.times)
        self.measure("run", 100)

    def evaluation(self, mooring, saved, count):
        costs.repeat_evaluation(mooring._model, mooring._state, mooring._scratch, False, count)

    def run(self, mooring, saved, count):
        mooring.restore(saved)
        mooring.run(self.times[:count], self.poses[:count], self.twists[:count])

    def measure(self, what, count):
        """(s of CPU time of all together, hash of the forces afterwards)."""
        act, forces = getattr(self, what), hashlib.sha256()
        began = time.process_time()
        for mooring, saved in self.moorings:
            act(mooring, saved, count)
        taken = time.process_time() - began
        for mooring, _ in self.moorings:
            forces.update(mooring._state.force.tobytes() + mooring.wrench.tobytes())
        return taken, forces.hexdigest()[:16]


def main():
    worker = Worker(sys.argv[1], int(sys.argv[2]), sys.argv[3])
    print("ready", flush=True)
    for line in sys.stdin:
        what, count = line.split()
        print(*worker.measure(what, int(count)), flush=True)


if __name__ == "__main__":
    main()
