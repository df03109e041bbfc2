"""Prescribed platform motions: pose and twist as functions of time, arrays in, arrays out."""

from dataclasses import dataclass

import numpy as np


def smooth_ramp(t, duration):
    """Factor from 0 to 1 over ``duration`` s and its rate: the fifth-order polynomial with no velocity or acceleration at its ends."""
    s = np.clip(np.asarray(t, dtype=float) / duration, 0.0, 1.0)
    factor = s**3 * (10.0 + s * (6.0 * s - 15.0))
    rate = 30.0 * s**2 * (1.0 - s) ** 2 / duration
    return factor, rate


def poses_and_twists(position, velocity):
    """Positions and velocities (n, 3) of a platform that does not rotate as poses (n, 7) and twists (n, 6)."""
    n = len(position)
    poses = np.zeros((n, 7))
    poses[:, :3] = position
    poses[:, 6] = 1.0
    twists = np.zeros((n, 6))
    twists[:, :3] = velocity
    return poses, twists


class Periodic:
    """A motion of ``period`` s that is ramped up over ``ramp_periods`` and then measured over ``measured_periods``."""

    @property
    def start(self) -> float:
        """Time from which is measured (s)."""
        return self.ramp_periods * self.period

    @property
    def end(self) -> float:
        """Time to which is measured (s)."""
        return (self.ramp_periods + self.measured_periods) * self.period


@dataclass(frozen=True)
class SurgeHeave(Periodic):
    """Surge ``sin`` and heave ``cos`` at one period: the reference point runs an ellipse, ramped up smoothly from rest at the zero pose.

    With a ``heading`` other than 0 the surge is along it, in degrees from x towards y.
    """

    surge: float = 4.0  # m, amplitude
    heave: float = 3.0  # m, amplitude
    period: float = 14.5  # s
    ramp_periods: float = 3.0
    measured_periods: float = 4.0
    heading: float = 0.0

    def displacement(self, t):
        """Displacement (n, 3) in m and velocity (n, 3) in m/s of the platform at the times t (n,)."""
        t = np.asarray(t, dtype=float)
        w = 2.0 * np.pi / self.period
        factor, rate = smooth_ramp(t, self.start)
        x, y = np.cos(np.deg2rad(self.heading)), np.sin(np.deg2rad(self.heading))
        along, rate_along = self.surge * np.sin(w * t), self.surge * np.cos(w * t)
        shape = np.stack([x * along, y * along, self.heave * np.cos(w * t)], axis=1)
        slope = w * np.stack([x * rate_along, y * rate_along, -self.heave * np.sin(w * t)], axis=1)
        return factor[:, None] * shape, factor[:, None] * slope + rate[:, None] * shape


@dataclass(frozen=True)
class Circle(Periodic):
    """A circle of the given radius in the vertical x-z plane about the zero pose; starts at rest in the centre and spirals out.

    Seen with x to the right and z up, clockwise goes up on the left, to the right at the top, down on the right.
    """

    radius: float  # m
    period: float  # s
    clockwise: bool = True
    ramp_periods: float = 3.0
    measured_periods: float = 5.0

    def displacement(self, t):
        """Displacement (n, 3) in m and velocity (n, 3) in m/s of the platform at the times t (n,)."""
        t = np.asarray(t, dtype=float)
        w = 2.0 * np.pi / self.period
        # the first half of the ramp time brings it onto the circle, the second lets the start die out
        factor, rate = smooth_ramp(t, 0.5 * self.start)
        sense = 1.0 if self.clockwise else -1.0
        zero = np.zeros_like(t)
        shape = self.radius * np.stack([sense * np.sin(w * t), zero, np.cos(w * t)], axis=1)
        slope = self.radius * w * np.stack([sense * np.cos(w * t), zero, -np.sin(w * t)], axis=1)
        return factor[:, None] * shape, factor[:, None] * slope + rate[:, None] * shape


@dataclass(frozen=True)
class Sines(Periodic):
    """Surge, sway and heave as sums of sines, ramped up smoothly from rest at the zero pose; the same at every run.

    A sea of three components about ``period``: amplitudes in parts of 0.6, 0.3 and 0.2 of those given, at 1, 0.83 and 1.31 times the period, heave a
    quarter period behind surge, and sway at the third alone.
    """

    surge: float  # m
    sway: float  # m
    heave: float  # m
    period: float  # s
    ramp_periods: float = 3.0
    measured_periods: float = 6.0

    SHARES = ((0.6, 1.0, 0.0), (0.3, 0.83, 1.1), (0.2, 1.31, 2.3))  # of the amplitudes, of the period, phase (rad)

    def displacement(self, t):
        """Displacement (n, 3) in m and velocity (n, 3) in m/s of the platform at the times t (n,)."""
        t = np.asarray(t, dtype=float)
        factor, rate = smooth_ramp(t, self.start)
        shape, slope = np.zeros((len(t), 3)), np.zeros((len(t), 3))
        for k, (share, of_period, phase) in enumerate(self.SHARES):
            w = 2.0 * np.pi / (of_period * self.period)
            for axis, amplitude, lag in ((0, self.surge, 0.0), (1, self.sway if k == 2 else 0.0, 0.7), (2, self.heave, 0.5 * np.pi)):
                shape[:, axis] += share * amplitude * np.sin(w * t + phase - lag)
                slope[:, axis] += share * amplitude * w * np.cos(w * t + phase - lag)
        return factor[:, None] * shape, factor[:, None] * slope + rate[:, None] * shape
