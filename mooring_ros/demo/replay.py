"""The run's recording replayed by `mooring replay`, and whether the same forces come out, bit for bit."""

import sys
from dataclasses import dataclass

import numpy as np

from mooring_ros.demo.history import read_answers
from mooring_ros.demo.processes import Child


class ReplayFailed(Exception):
    """`mooring replay` did not come to its end; the text holds what it said."""


@dataclass(frozen=True)
class Comparison:
    """samples compared; identical: whether all tensions and wrenches have the same bits; difference: the largest one (N, N·m)."""

    samples: int
    identical: bool
    difference: float


def replay(scene, recording, folder, variables, interrupted):
    """Replay a recording into folder / replay.mcap and return its path.

    Raises ReplayFailed, KeyboardInterrupt when interrupted() is true.
    """
    result = folder / "replay.mcap"
    child = Child("replay", "mooring_ros.offline", ["replay", str(scene), str(recording), "-o", str(result)], folder / "replay.log", variables, sys.executable)
    try:
        while child.wait(0.1) is None:
            if interrupted():
                raise KeyboardInterrupt
    finally:
        child.stop()
    if child.status != 0:
        raise ReplayFailed(f"mooring replay ended with status {child.status}: {child.tail()}")
    return result


def compare(recorded, replayed_path, start_stamp):
    """The Comparison of recorded Answers with the replayed file; start_stamp: ns, as in read_answers."""
    replayed = read_answers(replayed_path, start_stamp)
    names = ("times", "wrenches", "fairlead_tension", "anchor_tension")
    pairs = [(getattr(recorded, name), getattr(replayed, name)) for name in names]
    if any(first.shape != second.shape for first, second in pairs):
        return Comparison(len(recorded.times), False, np.inf)
    identical = all(first.tobytes() == second.tobytes() for first, second in pairs)
    return Comparison(len(recorded.times), identical, max(float(np.abs(first - second).max()) for first, second in pairs))
