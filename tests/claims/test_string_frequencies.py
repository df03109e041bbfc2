"""Free oscillations of a taut string: the frequencies of the discrete string, which lumped masses must hit."""

import warnings

import numpy as np
import pytest
from scenes_in_code import FIXED, HERE, line_type, refresh, table, vacuum
from scipy.optimize import OptimizeWarning, curve_fit

from mooring_ros import Mooring

LENGTH, MASS, STIFFNESS = 100.0, 2.0, 5e4
STRAIN = 0.01
COLUMN = "omega_discrete_times_L_over_c=2N sin(j pi/2N)"
PICKED = [(2, 1), (5, 3), (10, 1), (20, 1), (20, 5), (50, 3), (100, 5), (200, 2)]
ROWS = [row for row in table("lumped_mass_discrete_string.csv") if (int(row["N_segments"]), int(row["mode"])) in PICKED]


def frequency(time, signal, near):
    """Least-squares frequency (rad/s) of a sinusoid with a mean, from a start near it."""

    def wave(t, omega, a, b, mean):
        return a * np.sin(omega * t) + b * np.cos(omega * t) + mean

    size = np.abs(signal).max()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OptimizeWarning)  # no covariance from a fit without a residual
        fitted, _ = curve_fit(wave, time, signal / size, p0=(near, 1.0, 0.0, 0.0), xtol=1e-13, ftol=1e-13)
    assert np.abs(signal / size - wave(time, *fitted)).max() < 1e-3  # one mode and nothing else
    return fitted[0]


@pytest.mark.parametrize("direction", ["axial", "transverse"])
@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['N_segments']} segments, mode {row['mode']}")
def test_frequency_is_that_of_the_discrete_string(row, direction):
    """lumped_mass_discrete_string.csv, both ends held, no gravity, water or damping: 1e-4 (reached: 2e-5, the step's own (omega h)^2/24).

    Started at the taut rest shape with the velocities of one mode, so small that the change of tension does not matter; seen at the end
    force of an anchor over 20 periods at steps of 1/300 period. c is sqrt(EA/m) along and sqrt(T l / (m L)) across, per unstretched l.
    """
    n, mode = int(row["N_segments"]), int(row["mode"])
    span = LENGTH * (1.0 + STRAIN)
    celerity = np.sqrt(STIFFNESS / MASS) if direction == "axial" else np.sqrt(STIFFNESS * STRAIN / MASS / (1.0 + STRAIN))
    omega = float(row[COLUMN]) * celerity / LENGTH
    step = min(2.0 * np.pi / omega / 300.0, 0.9 * LENGTH / n * np.sqrt(MASS / STIFFNESS))
    scene = vacuum([(FIXED, (0, 0, -50)), (FIXED, (span, 0, -50))], [(line_type(mass=MASS, stiffness=STIFFNESS), 1, 2, LENGTH, n)])
    mooring = Mooring(scene, dt=step)
    mooring.settle(HERE)
    assert mooring.fairlead_tension[0] == pytest.approx(STIFFNESS * STRAIN, rel=1e-9)
    shape = np.sin(mode * np.pi * np.arange(n + 1) / n)
    mooring._state.velocity[0 if direction == "axial" else 1, : n + 1] = 1e-6 * span * omega * shape
    refresh(mooring)
    every = max(int(2.0 * np.pi / omega / step / 30.0), 1)
    times = every * step * np.arange(1, int(20 * 2.0 * np.pi / omega / step / every) + 1)
    run = mooring.run(times, np.tile(HERE, (times.size, 1)), np.zeros((times.size, 6)))
    signal = run.anchor_end_force[:, 0, 0] - STIFFNESS * STRAIN if direction == "axial" else run.anchor_end_force[:, 0, 1]
    assert frequency(times, signal, omega) == pytest.approx(omega, rel=1e-4)
