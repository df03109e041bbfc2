"""How fast a scene runs on this machine: a short run, timed."""

import math
import time

import numpy as np

_WALL = 1.0  # s, how long is measured
_SAMPLE = 0.02  # s between two samples of the motion


def measured_cost(mooring):
    """Run a settled Mooring through a mild surge and heave and time it; its state is restored.

    Returns {"real_time_factor", "simulated" (s), "elapsed" (s of wall time), "sample" (s between two samples)}. Raises MooringError.
    """
    saved = mooring.snapshot()
    # Froude-scaled with the depth: 14 s and 1 m in 200 m of water.
    depth = mooring.scene.environment.depth
    amplitude, rate = depth / 200.0, 2.0 * math.pi / (14.0 * math.sqrt(depth / 200.0))
    sample = _SAMPLE * min(1.0, math.sqrt(depth / 200.0))
    start, origin = mooring.time, np.array(mooring.pose)
    done = 0

    def advance(samples):
        nonlocal done
        times = sample * np.arange(done + 1, done + samples + 1)
        # A raised cosine starts from rest.
        phase = rate * times
        poses, twists = np.tile(origin, (samples, 1)), np.zeros((samples, 6))
        for axis, share in ((0, 1.0), (2, 0.5)):
            poses[:, axis] += share * amplitude * (1.0 - np.cos(phase))
            twists[:, axis] = share * amplitude * rate * np.sin(phase)
        mooring.run(start + times, poses, twists)
        done += samples

    try:
        advance(10)  # compiled and in the caches from here on
        samples, simulated, elapsed = 10, 0.0, 0.0
        while elapsed < _WALL and simulated < 600.0:
            before = time.perf_counter()
            advance(samples)
            took = time.perf_counter() - before
            simulated += samples * sample
            elapsed += took
            samples = min(2 * samples, 2000) if took < 0.1 else samples
        return {"real_time_factor": simulated / elapsed, "simulated": simulated, "elapsed": elapsed, "sample": sample}
    finally:
        mooring.restore(saved)
