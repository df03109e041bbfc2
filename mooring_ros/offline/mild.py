"""A mild motion to time a mooring with: it begins at rest where the mooring stands, and takes all platforms along."""

import math

import numpy as np

SAMPLE = 0.02  # s between two samples in deep water
PERIOD, AMPLITUDE, DEPTH = 14.0, 1.0, 200.0  # s and m of the motion in m of water: Froude-scaled to others


class MildMotion:
    """Surge, and `heave` times as much heave, of a settled Mooring; sample: s between two samples."""

    def __init__(self, mooring, heave=0.0):
        scale = mooring.scene.environment.depth / DEPTH
        self._start, self._origin, self._done = mooring.time, np.array(mooring.pose), 0
        self._amplitude, self._rate = AMPLITUDE * scale, 2.0 * math.pi / (PERIOD * math.sqrt(scale))
        self._shares = (0, 1.0), (2, heave)
        self.sample = SAMPLE * min(1.0, math.sqrt(scale))

    def next(self, count):
        """times (count,), poses and twists (count, …) of the samples that follow."""
        times = self.sample * np.arange(self._done + 1, self._done + count + 1)
        self._done += count
        # A raised cosine starts from rest.
        phase = (self._rate * times).reshape(-1, *[1] * (self._origin.ndim - 1))
        poses, twists = np.tile(self._origin, (count, *[1] * self._origin.ndim)), np.zeros((count, *self._origin.shape[:-1], 6))
        for axis, share in self._shares:
            poses[..., axis] += share * self._amplitude * (1.0 - np.cos(phase))
            twists[..., axis] = share * self._amplitude * self._rate * np.sin(phase)
        return self._start + times, poses, twists
