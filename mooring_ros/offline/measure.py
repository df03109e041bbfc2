"""How fast a scene runs on this machine: a short run, timed."""

import time

from .mild import MildMotion

_WALL = 1.0  # s, how long is measured


def measured_cost(mooring):
    """Run a settled Mooring through a mild surge and heave and time it; its state is restored.

    Returns {"real_time_factor", "simulated" (s), "elapsed" (s of wall time), "sample" (s between two samples)}. Raises MooringError.
    """
    saved, motion = mooring.snapshot(), MildMotion(mooring, heave=0.5)

    def advance(samples):
        mooring.run(*motion.next(samples))

    try:
        advance(10)  # compiled and in the caches from here on
        samples, simulated, elapsed = 10, 0.0, 0.0
        while elapsed < _WALL and simulated < 600.0:
            before = time.perf_counter()
            advance(samples)
            took = time.perf_counter() - before
            simulated += samples * motion.sample
            elapsed += took
            samples = min(2 * samples, 2000) if took < 0.1 else samples
        return {"real_time_factor": simulated / elapsed, "simulated": simulated, "elapsed": elapsed, "sample": motion.sample}
    finally:
        mooring.restore(saved)
