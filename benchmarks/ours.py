"""mooring_ros on a scene with a prescribed motion, timed like the peer."""

import time
from dataclasses import dataclass

import numpy as np

from mooring_ros.mooring import Mooring

from .motions import poses_and_twists


@dataclass(frozen=True)
class OurRun:
    """What a run gave: tensions of the end segments at the samples, and what it cost."""

    times: np.ndarray  # (samples,) s
    tension: np.ndarray  # (samples, lines) N
    cpu: float  # s of CPU time for the run, or for all step calls
    simulated: float  # s

    @property
    def cost(self) -> float:
        """CPU time for one simulated second (s/s)."""
        return self.cpu / self.simulated


def samples(motion, rate):
    """Times (n,), poses (n, 7) and twists (n, 6) of the motion at ``rate`` (Hz), from the first sample after 0 to the motion's end."""
    times = np.arange(1, int(np.ceil(motion.end * rate)) + 1) / rate
    return times, *poses_and_twists(*motion.displacement(times))


def at_rest(motion):
    """Pose (7,) of the platform at time 0."""
    poses, _ = poses_and_twists(*motion.displacement(np.zeros(1)))
    return poses[0]


def run(scene, motion, rate=20.0, segments=None, dt=None, call="run"):
    """From the static state at time 0 to the motion's end, samples at ``rate`` (Hz); all in one call, or one ``step`` a sample."""
    mooring = Mooring(scene, fidelity="dynamic", solver="explicit", dt=dt, segments=segments)
    mooring.settle(at_rest(motion))
    times, poses, twists = samples(motion, rate)
    if call == "run":
        began = time.process_time()
        history = mooring.run(times, poses, twists)
        cpu = time.process_time() - began
        tension = history.fairlead_tension
    else:
        tension = np.empty((len(times), len(mooring.line_names)))
        began = time.process_time()
        for k in range(len(times)):
            mooring.step(times[k], poses[k], twists[k])
            tension[k] = mooring.fairlead_tension
        cpu = time.process_time() - began
    return OurRun(times, np.array(tension), cpu, float(times[-1]))
