"""The sea of a scene: linear wave components in one direction, and the current.

Elevation at x' along the waves: sum of a cos(w t - k x' - phase), times the ramp; w^2 = g k tanh(k h) with the depth h at the origin.
"""

from typing import NamedTuple

import numpy as np

from ..scene.description import COMPONENTS, ELEVATION, JONSWAP, REGULAR
from .current import layers
from .packed import packed

LOWEST, HIGHEST = 0.4, 5.0  # of the peak frequency: the spectrum's range; beyond lies less than 0.2 % of its energy
LEFT_OUT = 1e-5  # of the energy of a given elevation: carried by the components that are left out, 0.3 % of its rms
VELOCITY_ERROR = 1e-3  # of the rms velocity at the surface: what interpolation in time may cost
REFRESHES = 16.0  # in a mean period, at least: nodes leave the straight way on which their window foresees them


@packed
class Sea(NamedTuple):
    """Constant. J components, none without waves, by growing frequency; L layers of current, none without a profile. World frame, SI."""

    frequency: np.ndarray  # (J,), rad/s
    wave_number: np.ndarray  # (J,), 1/m
    amplitude: np.ndarray  # (J,), m
    phase: np.ndarray  # (J,), rad
    direction: np.ndarray  # (2,), unit vector along x and y
    depth: float  # m
    gravity: float  # m/s^2
    ramp: float  # s, over which the waves grow from nothing
    refresh: float  # s, that a window of the nodes' kinematics spans; inf without waves
    current: np.ndarray  # (3,), m/s, below the lowest layer
    layer_bottom: np.ndarray  # (L,), m
    layer_height: np.ndarray  # (L,), m
    layer_shear: np.ndarray  # (3, L), 1/s


def build_sea(environment):
    """Sea of an `Environment`; the depth is that at the origin."""
    waves = environment.waves
    frequency, amplitude, phase = components(waves) if waves else (np.zeros(0),) * 3
    direction = waves.direction if waves else 0.0
    current, bottom, height, shear = layers(environment.current, environment.current_profile)
    return Sea(
        frequency=frequency,
        wave_number=wave_number(frequency, environment.depth, environment.gravity),
        amplitude=amplitude,
        phase=phase,
        direction=np.array([np.cos(direction), np.sin(direction)]),
        depth=float(environment.depth),
        gravity=float(environment.gravity),
        ramp=float(waves.ramp) if waves else 0.0,
        refresh=refresh_interval(frequency, amplitude),
        current=current,
        layer_bottom=bottom,
        layer_height=height,
        layer_shear=shear,
    )


def fastest_water(environment):
    """Speed (m/s) that currents, and the crests of all components together, do not pass."""
    sea = build_sea(environment)
    rows = np.array(environment.current_profile, dtype=float).reshape(-1, 4)
    profile = np.max(np.linalg.norm(rows[:, 1:], axis=1), initial=0.0)
    crests = np.sum(sea.frequency * sea.amplitude / np.tanh(sea.wave_number * sea.depth))
    return float(np.linalg.norm(environment.current) + profile + crests)


def components(waves):
    """(frequency, amplitude, phase), each (J,), of a `Waves` description; none where the sea is flat."""
    found = _components(waves)
    return tuple(values[found[1] != 0.0] for values in found)


def _components(waves):
    if waves.kind == REGULAR:
        return np.array([2.0 * np.pi / waves.period]), np.array([0.5 * waves.height]), np.array([float(waves.phase)])
    if waves.kind == JONSWAP:
        return spectrum_components(waves)
    if waves.kind == ELEVATION:
        return series_components(np.array(waves.elevation, dtype=float))
    if waves.kind == COMPONENTS:
        return given_components(np.array(waves.spectrum, dtype=float))
    raise ValueError(f"waves of kind {waves.kind!r}, expected {REGULAR!r}, {JONSWAP!r}, {ELEVATION!r} or {COMPONENTS!r}")


def wave_number(frequency, depth, gravity):
    """k (1/m) of w^2 = g k tanh(k h), to rounding, for frequency (rad/s) > 0 of any shape and depth h (m)."""
    deep = np.asarray(frequency, dtype=float) ** 2 * depth / gravity
    kh = deep / np.sqrt(np.tanh(deep))  # Eckart 1952, within 5 %; Newton squares the error each time
    for _ in range(6):
        tanh = np.tanh(kh)
        kh = kh - (kh * tanh - deep) / (tanh + kh * (1.0 - tanh**2))
    return kh / depth


def jonswap(frequency, period, peakedness):
    """JONSWAP spectral density (n,) without scale (Hasselmann et al. 1973) at frequency (n,) rad/s > 0; period Tp in s."""
    peak = 2.0 * np.pi / period
    width = np.where(frequency <= peak, 0.07, 0.09)
    bump = np.exp(-0.5 * ((frequency / peak - 1.0) / width) ** 2)
    return (frequency / peak) ** -5.0 * np.exp(-1.25 * (peak / frequency) ** 4) * peakedness**bump


def spectrum_components(waves):
    """Components of equal energy, Hs^2/16 together, each at a random place of its share of the spectrum.

    Equal shares spend the components where the energy is. A place drawn by the spectrum inside each share keeps all moments of the spectrum
    on the mean (not only m0, which is exact), and makes frequencies that have no common period: the record does not repeat.
    """
    random = np.random.Generator(np.random.PCG64(waves.seed))
    count = waves.components
    grid = np.linspace(LOWEST, HIGHEST, 20001) * 2.0 * np.pi / waves.period
    density = jonswap(grid, waves.period, waves.peakedness)
    energy = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    places = (np.arange(count) + random.uniform(size=count)) / count
    frequency = np.interp(places, energy / energy[-1], grid)
    amplitude = np.full(count, waves.height * np.sqrt(0.125 / count))
    return frequency, amplitude, random.uniform(0.0, 2.0 * np.pi, count)


def series_components(series):
    """Components of an evenly spaced elevation at the origin, (samples, 2): s from 0 and m. After its last sample it repeats.

    The mean is no wave and is left out, and so are the weakest components, which together carry `LEFT_OUT` of the energy. Where the
    series does not end as it starts, its step would ring through all frequencies: a mean period is put in between that leads back.
    """
    spacing = (series[-1, 0] - series[0, 0]) / (len(series) - 1)
    eta = series[:, 1] - series[:, 1].mean()
    plain = _strongest(eta, spacing)
    if plain[0].size == 0:
        return plain
    mean = np.sum(plain[1] ** 2 * plain[0]) / np.sum(plain[1] ** 2)
    bridged = _strongest(np.concatenate([eta, _way_back(eta, int(np.ceil(2.0 * np.pi / (mean * spacing))))]), spacing)
    return min(plain, bridged, key=lambda found: found[0].size)


def _strongest(eta, spacing):
    """(frequency, amplitude, phase) of the components of a periodic elevation (n,) that carry all but `LEFT_OUT` of its energy."""
    count = len(eta)
    turned = np.fft.rfft(eta) / count
    amplitude = 2.0 * np.abs(turned)
    amplitude[0] = 0.0
    if count % 2 == 0:
        amplitude[-1] *= 0.5  # a frequency that stands alone
    order = np.argsort(amplitude, kind="stable")
    energy = np.cumsum(amplitude[order] ** 2)
    kept = np.sort(order[energy > LEFT_OUT * energy[-1]])
    return 2.0 * np.pi * kept / (count * spacing), amplitude[kept], -np.angle(turned[kept])


def _way_back(eta, count):
    """`count` samples from the end of `eta` to its start: a cubic with the slopes of both."""
    s = np.arange(1, count + 1) / (count + 1)
    leave, arrive = (eta[-1] - eta[-2]) * (count + 1), (eta[1] - eta[0]) * (count + 1)
    rest = 1.0 - s
    return rest**2 * ((1.0 + 2.0 * s) * eta[-1] + s * leave) + s**2 * ((1.0 + 2.0 * rest) * eta[0] - rest * arrive)


def given_components(rows):
    """Components by growing frequency from rows (rad/s, m, rad)."""
    if np.any((rows[:, 0] <= 0.0) & (rows[:, 1] != 0.0)):
        raise ValueError(f"a wave component of {rows[:, 0].min():g} rad/s, expected more than 0")
    frequency, amplitude, phase = rows[np.argsort(rows[:, 0], kind="stable")].T.copy()
    return frequency, amplitude, phase


def refresh_interval(frequency, amplitude):
    """Span (s) of a window in which cubic Hermite, (w dt)^4/384 wrong for a component, misses `VELOCITY_ERROR` of the rms velocity."""
    if frequency.size == 0:
        return np.inf
    energy = amplitude**2
    mean = np.sum(energy * frequency) / np.sum(energy)
    steepness = np.sum(energy * frequency**10) / np.sum(energy * frequency**2)
    return float(min((384.0 * VELOCITY_ERROR) ** 0.25 / steepness**0.125, 2.0 * np.pi / (REFRESHES * mean)))


def elevation(sea, t, x=0.0, y=0.0):
    """Surface elevation (m) at times t (s) and places x, y (m), of any shapes that broadcast."""
    t, along = np.broadcast_arrays(np.asarray(t, dtype=float), sea.direction[0] * np.asarray(x) + sea.direction[1] * np.asarray(y))
    total = np.zeros(t.shape)
    for w, k, a, phase in zip(sea.frequency, sea.wave_number, sea.amplitude, sea.phase):
        total += a * np.cos(w * t - k * along - phase)
    grown = np.clip(t / sea.ramp, 0.0, 1.0) if sea.ramp > 0.0 else 1.0
    return (0.5 - 0.5 * np.cos(np.pi * grown)) * total
