"""Readings of many samples, as they leave the façade."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class History:
    """Readings of many samples, one row each; k samples, world frame."""

    time: np.ndarray  # (k,) s
    wrench: np.ndarray  # (k, 6) N, N m, or (k, platforms, 6)
    anchor_tension: np.ndarray  # (k, lines) N
    fairlead_tension: np.ndarray  # (k, lines) N
    anchor_end_force: np.ndarray  # (k, lines, 3) N
    fairlead_end_force: np.ndarray  # (k, lines, 3) N
    stretched_length: np.ndarray  # (k, lines) m
    length_rate: np.ndarray  # (k, lines) m/s
    coupled_wrenches: np.ndarray  # (k, outputs, 6) N, N m: at each coupled point, rod and body
    uneven: np.ndarray  # (k,) of a dynamic mooring: see Mooring.last_step

    @classmethod
    def of(cls, times, readings):
        """History of `times` (k,) and core.readings.Readings of k rows."""
        return cls(
            time=times.copy(),
            wrench=readings.wrench,
            anchor_tension=readings.tension[:, :, 0],
            fairlead_tension=readings.tension[:, :, 1],
            anchor_end_force=readings.end_force[:, :, 0],
            fairlead_end_force=readings.end_force[:, :, 1],
            stretched_length=readings.length,
            length_rate=readings.length_rate,
            coupled_wrenches=readings.coupled,
            uneven=readings.uneven.astype(int),
        )
