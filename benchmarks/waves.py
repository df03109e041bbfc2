"""The sea: height and period of a long realisation, and the water's motion below it beside MoorDyn's sum of the same components (its WaveKin 7)."""

import os
import tempfile

import numpy as np
from scipy.signal import welch

from mooring_ros.core.cache import kernel
from mooring_ros.core.sea import build_sea, elevation
from mooring_ros.core.waves import WINDOW_ROWS, WORK_SIZE, refresh, streams
from mooring_ros.scene.description import JONSWAP, Environment, Waves

from . import figures, tables
from .moordyn_deck import WAVES, wave_frequencies

STORM = Waves(kind=JONSWAP, height=8.25, period=14.5, direction=0.3)
DEPTHS = (3.0, 20.0, 70.0, 850.0)  # m
PLACES = 300
INSTANTS = (0.0, 7.5, 31.0, 112.5)  # s
GOAL = 1e-5  # of the water's largest speed and acceleration; MoorDyn solves its wave numbers to seven digits
DAY = 24 * 3600.0

_DECK = """MoorDyn input
its own
---- LINE TYPES ----
Name Diam Mass EA BA EI Cd Ca CdAx CaAx
(-) (-) (-) (-) (-) (-) (-) (-) (-) (-)
wire 0.01 1.0 1e6 -1.0 0 0 0 0 0
---- POINTS ----
ID Type X Y Z M V CdA Ca
(-) (-) (-) (-) (-) (-) (-) (-) (-)
1 Fixed 0 0 {low!r} 0 0 0 0
2 Coupled 0 0 {high!r} 0 0 0 0
---- LINES ----
ID Type A B L N Out
(-) (-) (-) (-) (-) (-) (-)
1 wire 1 2 {length!r} 1 -
---- OPTIONS ----
0.5 dtM
Euler tScheme
{gravity!r} g
{depth!r} WtrDpth
7 WaveKin
0 writeLog
1 disableOutput
1 disableOutTime
---- END ----
"""


@kernel
def _streams(sea, time, size, position, window_times, window, stream, swell):
    streams(sea, time, size, position, window_times, window, stream, swell)


def of_ours(sea, time, position):
    """Velocity (3, n) in m/s and acceleration (3, n) in m/s^2 of the water at places (3, n)."""
    n = position.shape[1]
    times, window, work = np.array([0.0, -1.0]), np.zeros((2, WINDOW_ROWS, n)), np.zeros(WORK_SIZE)
    stream, swell = np.zeros((3, n)), np.zeros((4, n))
    refresh(sea, time, time, n, position, np.zeros_like(position), work, times, window)
    _streams(sea, time, n, position, times, window, stream, swell)
    return stream, swell[:3]


def of_moordyn(sea, direction, instants, position):
    """The same of MoorDyn at each of the instants (growing, s)."""
    import moordyn

    from .moordyn_peer import silence

    high = -0.5 * sea.depth
    found = []
    with tempfile.TemporaryDirectory(prefix="moordyn_") as folder, silence():
        path = os.path.join(folder, "lines.txt")
        with open(path, "w", encoding="utf-8") as file:
            file.write(_DECK.format(low=high - 1.0, high=high, length=0.99, gravity=sea.gravity, depth=sea.depth))
        with open(os.path.join(folder, WAVES), "w", encoding="utf-8") as file:
            file.write(wave_frequencies(sea.frequency, sea.amplitude, sea.phase, direction))
        system = moordyn.Create(path)
        moordyn.SetVerbosity(system, moordyn.LEVEL_NONE)
        moordyn.Init_NoIC(system, [0.0, 0.0, high], [0.0] * 3)
        now = 0.0
        for instant in instants:
            if instant > now:
                moordyn.Step(system, [0.0, 0.0, high], [0.0] * 3, now, instant - now)
                now = instant
            waves = moordyn.GetWaves(system)
            rows = [moordyn.GetWavesKin(waves, *map(float, place)) for place in position.T]
            found.append((np.array([row[0] for row in rows]).T, np.array([row[1] for row in rows]).T))
        moordyn.Close(system)
    return found


def scattered(sea, rng):
    """Places (3, n) from the bed to the trough of the waves."""
    n = PLACES
    top = -min(1.5 * STORM.height / 2.0, 0.5 * sea.depth)
    return np.array([rng.uniform(-400.0, 400.0, n), rng.uniform(-400.0, 400.0, n), rng.uniform(-sea.depth, top, n)])


def run(quick=False):
    """Both tables."""
    rng = np.random.default_rng(1)
    rows, failed = [], []
    for depth in DEPTHS[2:3] if quick else DEPTHS:
        storm = STORM if depth > 10.0 else Waves(kind=JONSWAP, height=0.3, period=3.0, direction=STORM.direction)
        sea = build_sea(Environment(depth=depth, waves=storm))
        places = scattered(sea, rng)
        worst = np.zeros(2)
        for instant, theirs in zip(INSTANTS, of_moordyn(sea, storm.direction, INSTANTS, places), strict=True):
            for k, (a, b) in enumerate(zip(of_ours(sea, instant, places), theirs, strict=True)):
                worst[k] = max(worst[k], np.abs(a - b).max() / np.abs(b).max())
        rows.append([f"{depth:g} m, Hs {storm.height:g} m, Tp {storm.period:g} s", f"{worst[0]:.1e}", f"{worst[1]:.1e}"])
        if worst.max() > GOAL:
            failed.append(f"waves at {depth:g} m: {worst.max():.1e} from MoorDyn's, goal {GOAL:g}")
    against = tables.table(["depth and sea", "velocity", "acceleration"], rows)

    rows = []
    for seed in range(1, 2 if quick else 4):
        eta, (frequency, density) = realisation(seed)
        height, peak = 4.0 * eta.std(), np.sum(density**4) / np.sum(frequency * density**4)
        off = height / STORM.height - 1.0, peak / STORM.period - 1.0
        rows.append([str(seed), f"{height:.3f} m", f"{100 * off[0]:+.2f} %", f"{peak:.2f} s", f"{100 * off[1]:+.2f} %"])
        if max(map(abs, off)) > 0.02:
            failed.append(f"waves, seed {seed}: Hs {height:.2f} m, Tp {peak:.2f} s of a day, goal 2 %")
    day = tables.table(["seed", "Hs", "of 8.25 m", "Tp", "of 14.5 s"], rows)
    print(against, day, sep="\n\n", flush=True)
    return {"tables": {"waves_peer": against, "waves_day": day}, "failed": failed, "figures": {"waves.png": picture()}}


def realisation(seed):
    """Elevation of a day at 2 Hz (m), and its spectrum (frequency in Hz, density in m^2/Hz)."""
    sea = build_sea(Environment(depth=200.0, waves=Waves(kind=JONSWAP, height=STORM.height, period=STORM.period, seed=seed)))
    eta = elevation(sea, np.arange(0.0, DAY, 0.5))
    return eta, welch(eta, fs=2.0, nperseg=1024)


def jonswap(frequency, height, period, gamma=3.3):
    """Spectral density (m^2/Hz) over frequency (Hz): Hasselmann et al. 1973, with Goda's factor for the height."""
    peak = 1.0 / period
    width = np.where(frequency <= peak, 0.07, 0.09)
    raised = gamma ** np.exp(-((frequency / peak - 1.0) ** 2) / (2.0 * width**2))
    shape = frequency**-5 * np.exp(-1.25 * (peak / frequency) ** 4) * raised
    return shape * height**2 / 16.0 / np.trapezoid(shape, frequency)


def picture():
    """Spectrum of a day beside JONSWAP's, and speeds below a crest beside MoorDyn's."""
    figure, grid = figures.axes(1, 2, height=3.4)
    _, (frequency, density) = realisation(1)
    fine = np.linspace(0.02, 0.3, 600)
    grid[0, 0].plot(frequency, density, label="a day at 2 Hz", **figures.STYLES["ours"])
    grid[0, 0].plot(fine, jonswap(fine, STORM.height, STORM.period), color=figures.COLOURS[3], linewidth=1.0, label="JONSWAP")
    grid[0, 0].set(xlabel="frequency (Hz)", ylabel="density (m²/Hz)", xlim=(0.0, 0.25))
    grid[0, 0].legend(frameon=False, fontsize=8)
    sea = build_sea(Environment(depth=70.0, waves=STORM))
    t = np.arange(0.0, 600.0, 0.5)
    crest = float(t[np.argmax(elevation(sea, t))])
    z = np.linspace(-70.0, float(elevation(sea, crest)) - 0.2, 24)
    places = np.array([np.zeros_like(z), np.zeros_like(z), z])
    ((velocity, acceleration),) = of_moordyn(sea, STORM.direction, (crest,), places)
    ours, ours_acceleration = of_ours(sea, crest, places)
    for k, (a, b, what) in enumerate(((ours, velocity, "speed (m/s)"), (ours_acceleration, acceleration, "acceleration (m/s²)"))):
        axis = grid[0, 1]
        axis.plot(np.linalg.norm(a, axis=0), z, color=figures.COLOURS[k], label=what)
        axis.plot(np.linalg.norm(b, axis=0), z, "o", color=figures.COLOURS[k], markersize=3.5, label="MoorDyn" if k else None)
    grid[0, 1].set(xlabel="below a crest", ylabel="z (m)")
    grid[0, 1].legend(frameon=False, fontsize=8)
    return figure
