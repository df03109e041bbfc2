"""Irregular long-crested waves (JONSWAP, linear theory, finite depth) and their first-order force on a hull.

The force stands in for what a radiation–diffraction code would give. It has two parts, both at the hull's mean position:
the Froude–Krylov force (the undisturbed pressure over the wetted surface, which is the water's acceleration over the
displaced volume plus the pressure over the water plane) and, for diffraction, each strip's added mass times the water's
acceleration (long waves). There is no drag, no second order, no drift. Between 10 and 16 s it comes within 6 % of the
published WAMIT excitation of the VolturnUS-S in surge, 11 % in pitch and 25 % in heave (tests/demo/test_sea_and_hull.py).
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import trapezoid


@dataclass(frozen=True)
class SeaState:
    """What the waves are: significant height (m), peak period (s), JONSWAP peak enhancement, heading they go to (rad from
    the x axis), seed, number of components, time over which they grow from rest (s)."""

    height: float = 6.0
    period: float = 12.0
    peak_enhancement: float = 3.3
    heading: float = 0.0
    seed: int = 1
    components: int = 200
    ramp: float = 10.0

    def __post_init__(self):
        for name, lowest in (("height", 0.0), ("period", 0.0), ("peak_enhancement", 1.0), ("ramp", 0.0)):
            value = getattr(self, name)
            if not (np.isfinite(value) and value >= lowest):
                raise ValueError(f"wave {name} is {value}, expected a finite number of at least {lowest:g}")
        if self.period <= 0.0:
            raise ValueError(f"wave period is {self.period}, expected more than 0")


class Waves:
    """A realisation of a SeaState in water of a given depth (m).

    frequency (n,) rad/s, amplitude (n,) m, wave_number (n,) 1/m, phase (n,) rad.
    The elevation is Σ amplitude cos(wave_number·x' − frequency t + phase), x' along the heading, times the ramp.
    """

    def __init__(self, sea, depth, gravity=9.80665):
        self.sea, self.depth, self.gravity = sea, depth, gravity
        random = np.random.default_rng(sea.seed)
        edges, self.frequency = _equal_energy_bands(sea, random)
        energy = sea.height**2 / 16.0
        self.amplitude = np.full(len(self.frequency), np.sqrt(2.0 * energy / (len(edges) - 1)))
        self.phase = random.uniform(0.0, 2.0 * np.pi, len(self.frequency))
        self.wave_number = wave_number(self.frequency, depth, gravity)

    def elevation(self, times, x=0.0, y=0.0):
        """Surface elevation (n,) m at times (n,) s at the point x, y (m)."""
        times = np.atleast_1d(np.asarray(times, float))
        along = x * np.cos(self.sea.heading) + y * np.sin(self.sea.heading)
        angle = self.wave_number * along - np.outer(times, self.frequency) + self.phase
        return self.ramp(times) * (np.cos(angle) @ self.amplitude)

    def ramp(self, times):
        """Factor 0..1 (same shape as times): half a cosine over the ramp time, so that the motion starts smoothly."""
        if self.sea.ramp <= 0.0:
            return np.ones_like(np.asarray(times, float))
        return 0.5 - 0.5 * np.cos(np.pi * np.clip(np.asarray(times, float) / self.sea.ramp, 0.0, 1.0))


class Excitation:
    """First-order wave force of Waves on a Hull; call with a time (s) for the wrench (6,) in N, N·m, world frame, about the
    reference point."""

    def __init__(self, waves, hull, density=1025.0):
        self.waves = waves
        transfer = force_transfer(hull, waves.frequency, waves.sea.heading, waves.depth, waves.gravity, density)
        self._spectrum = transfer * (waves.amplitude * np.exp(1j * waves.phase))[:, None]

    def __call__(self, time):
        turn = np.exp(-1j * self.waves.frequency * time)
        return float(self.waves.ramp(time)) * (turn @ self._spectrum).real


def jonswap(frequency, height, period, peak_enhancement=3.3):
    """JONSWAP spectral density (n,) m²·s/rad at frequency (n,) rad/s > 0, scaled so that four times the root of its area
    over all frequencies is the significant height."""
    return _jonswap_shape(frequency, period, peak_enhancement) * height**2 / 16.0 / _jonswap_area(period, peak_enhancement)


def wave_number(frequency, depth, gravity=9.80665):
    """Wave number (n,) 1/m of frequency (n,) rad/s from ω² = g k tanh(k h), to rounding; depth in m."""
    deep = np.asarray(frequency, float) ** 2 * depth / gravity
    kh = deep / np.sqrt(np.tanh(np.maximum(deep, 1e-300)))  # Eckart's approximation, then Newton
    for _ in range(8):
        tanh = np.tanh(kh)
        kh = kh - (kh * tanh - deep) / (tanh + kh * (1.0 - tanh**2))
    return kh / depth


def force_transfer(hull, frequency, heading, depth, gravity=9.80665, density=1025.0):
    """Wave force (n, 6) complex, N/m and N·m/m, for unit waves exp(i(k x' − ω t)) of frequency (n,) rad/s."""
    k = wave_number(frequency, depth, gravity)[:, None]
    direction = np.array([np.cos(heading), np.sin(heading), 0.0])
    z = hull.position[:, 2]
    # cosh k(z+h) / cosh kh and sinh k(z+h) / cosh kh without overflow
    decay, image = np.exp(k * z), np.exp(-k * (z + 2.0 * depth))
    scale = gravity * k * np.exp(1j * k * (hull.position @ direction)) / (1.0 + np.exp(-2.0 * k * depth))
    along, upward = -1j * scale * (decay + image), -scale * (decay - image)
    acceleration = along[..., None] * direction + upward[..., None] * np.array([0.0, 0.0, 1.0])  # (n, strips, 3)
    inertia = density * (hull.volume[:, None, None] * np.eye(3) + hull.added_mass)
    force = np.einsum("sij,nsj->nsi", inertia, acceleration)

    lift = density * gravity * hull.disc_area * np.exp(1j * k * (hull.disc_position @ direction))  # (n, discs)
    disc_force = lift[..., None] * np.array([0.0, 0.0, 1.0])
    total = force.sum(axis=1) + disc_force.sum(axis=1)
    moment = np.cross(hull.position, force).sum(axis=1) + np.cross(hull.disc_position, disc_force).sum(axis=1)
    return np.concatenate([total, moment], axis=1)


def _equal_energy_bands(sea, random):
    """Band edges and one random frequency in each: unequal spacing keeps the record from repeating."""
    peak = 2.0 * np.pi / sea.period
    grid = np.linspace(0.4 * peak, 5.0 * peak, 20001)
    cumulative = np.concatenate([[0.0], np.cumsum(_jonswap_shape(0.5 * (grid[1:] + grid[:-1]), sea.period, sea.peak_enhancement))])
    cumulative /= cumulative[-1]
    edges = np.interp(np.linspace(0.0, 1.0, sea.components + 1), cumulative, grid)
    return edges, edges[:-1] + np.diff(edges) * random.uniform(size=sea.components)


def _jonswap_shape(frequency, period, peak_enhancement):
    frequency = np.asarray(frequency, float)
    peak = 2.0 * np.pi / period
    width = np.where(frequency <= peak, 0.07, 0.09)
    bump = np.exp(-0.5 * ((frequency / peak - 1.0) / width) ** 2)
    return frequency**-5.0 * np.exp(-1.25 * (peak / frequency) ** 4) * peak_enhancement**bump


def _jonswap_area(period, peak_enhancement):
    peak = 2.0 * np.pi / period
    frequency = np.linspace(0.2 * peak, 40.0 * peak, 200001)
    return trapezoid(_jonswap_shape(frequency, period, peak_enhancement), frequency)
