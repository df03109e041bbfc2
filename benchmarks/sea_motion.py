"""A platform that follows a sea: surge and heave from the sea's components through response amplitude operators."""

from dataclasses import dataclass

import numpy as np

from .motions import smooth_ramp


@dataclass(frozen=True)
class SeaMotion:
    """Surge along the waves and heave of a platform at the origin, each component of the sea in its own phase, ramped up smoothly from rest.

    The operators were chosen, not taken from a converter: 0.9 of the elevation at long waves in surge, all of it in heave, falling with the fourth
    power of the frequency; surge lags the crest by a quarter period, as the water does, and heave by 15 degrees.
    """

    frequency: np.ndarray  # (J,) rad/s
    amplitude: np.ndarray  # (J,) m
    phase: np.ndarray  # (J,) rad: elevation sum a cos(w t - phase)
    direction: float = 0.0  # rad
    ramp: float = 29.0  # s
    measured: float = 87.0  # s

    @property
    def start(self) -> float:
        """Time from which is measured (s)."""
        return self.ramp

    @property
    def end(self) -> float:
        """Time to which is measured (s)."""
        return self.ramp + self.measured

    def _unramped(self, t):
        """Displacement (n, 3) in m and velocity (n, 3) in m/s without the ramp."""
        response = self.amplitude / (1.0 + (self.frequency / 0.8) ** 4)
        turn = np.exp(1j * (np.multiply.outer(t, self.frequency) - self.phase))
        surge, heave = 0.9 * response * np.exp(-0.5j * np.pi), response * np.exp(-1j * np.deg2rad(15.0))
        parts = []
        for rates in (turn, turn * 1j * self.frequency):
            x, z = (rates @ surge).real, (rates @ heave).real
            parts.append(np.stack([x * np.cos(self.direction), x * np.sin(self.direction), z], axis=1))
        return parts

    def displacement(self, t):
        """Displacement (n, 3) in m and velocity (n, 3) in m/s at the times t (n,)."""
        t = np.asarray(t, dtype=float)
        place, velocity = self._unramped(t)
        factor, rate = smooth_ramp(t, self.ramp)
        return factor[:, None] * place, factor[:, None] * velocity + rate[:, None] * place
