"""One build of the package, timed on request: ``python effects_worker.py SCENE SEGMENTS`` with that build first on the path.

Reads what to time from standard input, a line each, "evaluation" or "run", and answers with the CPU time (s) and a hash of the forces.
"""

import hashlib
import sys
import time

import numpy as np

from mooring_ros import Mooring
from mooring_ros.core import costs

RATE = 20.0  # Hz


class Worker:
    """A settled mooring, and how often each thing is done in a measurement."""

    def __init__(self, scene, segments):
        self.mooring = Mooring(scene, segments=segments)
        self.mooring.settle([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
        self.saved = self.mooring.snapshot()
        self.times = np.arange(1, 1001) / RATE
        self.poses, self.twists = np.zeros((1000, 7)), np.zeros((1000, 6))
        self.poses[:, 0], self.poses[:, 6] = 1.0 - np.cos(0.4 * self.times), 1.0
        self.twists[:, 0] = 0.4 * np.sin(0.4 * self.times)
        self.run(100)

    def evaluation(self, count):
        mooring = self.mooring
        costs.repeat_evaluation(mooring._model, mooring._state, mooring._scratch, False, count)

    def run(self, count):
        self.mooring.restore(self.saved)
        self.mooring.run(self.times[:count], self.poses[:count], self.twists[:count])

    def measure(self, what, count):
        """(s of CPU time, hash of the forces afterwards)."""
        act = getattr(self, what)
        began = time.process_time()
        act(count)
        taken = time.process_time() - began
        mooring = self.mooring
        return taken, hashlib.sha256(mooring.wrench.tobytes() + mooring._state.force.tobytes()).hexdigest()[:16]


def main():
    worker = Worker(sys.argv[1], int(sys.argv[2]))
    print("ready", flush=True)
    for line in sys.stdin:
        what, count = line.split()
        print(*worker.measure(what, int(count)), flush=True)


if __name__ == "__main__":
    main()
