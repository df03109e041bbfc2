"""The sea: dispersion, spectrum, and given elevations and components."""

import numpy as np
import pytest
from scipy.signal import welch
from scenes_in_code import table

from mooring_ros.core.sea import build_sea, elevation, wave_number
from mooring_ros.scene.description import COMPONENTS, ELEVATION, JONSWAP, REGULAR, Environment, Waves

GRAVITY = 9.80665


def sea(depth=200.0, gravity=GRAVITY, **waves):
    return build_sea(Environment(depth=depth, gravity=gravity, waves=Waves(**waves)))


def storm(**changed):
    return sea(**{"kind": JONSWAP, "height": 8.25, "period": 14.5, **changed})


def test_wave_numbers_are_those_of_the_table():
    for row in table("airy_dispersion.csv"):
        frequency, depth = float(row["omega"]), float(row["depth_m"])
        k = float(wave_number(frequency, depth, GRAVITY))
        assert k == pytest.approx(float(row["k"]), rel=1e-9)
        assert 2.0 * np.pi / k == pytest.approx(float(row["wavelength_m"]), rel=1e-9)


def test_wave_numbers_solve_the_dispersion_relation_to_rounding_from_tides_to_ripples():
    frequency = np.geomspace(1e-3, 10.0, 200)
    for depth in (0.5, 3.0, 70.0, 5000.0):
        k = wave_number(frequency, depth, GRAVITY)
        assert np.all(np.abs(GRAVITY * k * np.tanh(k * depth) / frequency**2 - 1.0) < 1e-12)


def test_a_long_realisation_has_the_significant_height_and_peak_period_asked_for():
    waves = storm()
    eta = elevation(waves, np.arange(0.0, 24 * 3600.0, 0.5))
    assert 4.0 * eta.std() == pytest.approx(8.25, rel=0.02)
    frequency, density = welch(eta, fs=2.0, nperseg=512)
    assert np.sum(density**4) / np.sum(frequency * density**4) == pytest.approx(14.5, rel=0.02)  # Young 1995: peak from a noisy spectrum


def test_the_energy_of_the_components_is_that_of_the_significant_height():
    for seed in range(5):
        assert 4.0 * np.sqrt(np.sum(storm(seed=seed).amplitude ** 2) / 2.0) == pytest.approx(8.25, rel=1e-12)


def test_mean_zero_crossing_period_is_that_of_the_spectrum():
    """Tz = 0.7777 Tp for gamma 3.3 (DNV-RP-C205, 3.5.5.5); without what lies beyond 5 peak frequencies it is 2 % longer."""
    expected = 14.5 * (0.6673 + 0.05037 * 3.3 - 0.00623 * 3.3**2 + 0.0003341 * 3.3**3)
    found = []
    for seed in range(20):
        waves = storm(seed=seed)
        found.append(2.0 * np.pi * np.sqrt(np.sum(waves.amplitude**2) / np.sum((waves.amplitude * waves.frequency) ** 2)))
    assert np.mean(found) == pytest.approx(1.02 * expected, rel=0.01)
    assert np.std(found) < 0.02 * expected


def test_the_record_does_not_repeat_within_an_hour():
    waves = storm()
    lags = np.arange(120.0, 3600.0, 0.25)
    correlation = np.cos(np.outer(lags, waves.frequency)) @ waves.amplitude**2 / np.sum(waves.amplitude**2)
    assert np.max(np.abs(correlation)) < 0.5


def test_same_seed_same_sea_and_another_seed_another():
    t = np.linspace(0.0, 500.0, 400)
    assert np.array_equal(elevation(storm(seed=7), t), elevation(storm(seed=7), t))
    apart = elevation(storm(seed=7), t) - elevation(storm(seed=8), t)
    assert np.std(apart) > 0.5 * 8.25 / 4.0


def test_a_regular_wave_is_half_its_height_and_runs_in_its_direction():
    waves = sea(kind=REGULAR, height=3.0, period=9.0, direction=0.6, phase=0.4)
    t, k = np.linspace(0.0, 30.0, 50), waves.wave_number[0]
    for x, y in ((0.0, 0.0), (40.0, -25.0)):
        expected = 1.5 * np.cos(2.0 * np.pi * t / 9.0 - k * (x * np.cos(0.6) + y * np.sin(0.6)) - 0.4)
        assert np.allclose(elevation(waves, t, x, y), expected, atol=1e-12)


def test_given_components_are_taken_as_they_are_in_any_order():
    rows = ((0.9, 0.3, 1.0), (0.4, 1.2, -2.0), (0.0, 0.0, 0.0), (0.4, 0.5, 0.3))
    t = np.linspace(0.0, 100.0, 300)
    expected = sum(a * np.cos(w * t - phase) for w, a, phase in rows)
    waves = sea(kind=COMPONENTS, spectrum=rows)
    assert np.allclose(elevation(waves, t), expected, atol=1e-12)
    assert np.all(np.diff(waves.frequency) >= 0.0)


def test_a_component_without_a_frequency_is_refused():
    with pytest.raises(ValueError, match="0 rad/s"):
        sea(kind=COMPONENTS, spectrum=((0.0, 1.0, 0.0), (0.4, 0.5, 0.3)))


@pytest.mark.parametrize("samples", [7200, 7201])
def test_a_given_elevation_comes_back_at_the_origin(samples):
    """What is left out carries 1e-5 of the energy: 0.32 % of the rms."""
    t = 0.5 * np.arange(samples)
    given = elevation(storm(height=4.0, period=11.0), t)
    given -= given.mean()
    waves = sea(kind=ELEVATION, elevation=tuple(zip(t, given)))
    wrong = elevation(waves, t) - given
    assert np.std(wrong) < 0.0032 * np.std(given)
    assert waves.frequency.size < samples // 6


def test_a_given_elevation_keeps_its_time_between_samples():
    """A series of whole periods is one component, and so is known between its samples."""
    t = 0.25 * np.arange(400)
    waves = sea(kind=ELEVATION, elevation=tuple(zip(t, 0.7 * np.cos(2.0 * np.pi * t / 10.0 - 0.9))))
    between = np.linspace(0.0, 37.0, 101)
    assert np.allclose(elevation(waves, between), 0.7 * np.cos(2.0 * np.pi * between / 10.0 - 0.9), atol=1e-9)


def test_waves_grow_over_the_ramp():
    still, grown = storm(ramp=40.0), storm()
    assert elevation(still, 0.0) == 0.0
    assert elevation(still, 20.0) == pytest.approx(0.5 * elevation(grown, 20.0), rel=1e-12)
    assert elevation(still, [40.0, 100.0]) == pytest.approx(elevation(grown, [40.0, 100.0]), rel=1e-12)


def test_a_ramp_of_no_length_leaves_times_before_the_start_their_waves():
    assert elevation(storm(), -50.0) != 0.0


@pytest.mark.parametrize(
    "flat",
    [
        None,
        Waves(kind=REGULAR, height=0.0, period=9.0),
        Waves(kind=JONSWAP, height=0.0, period=9.0),
        Waves(kind=ELEVATION, elevation=((0.0, 0.3), (0.5, 0.3), (1.0, 0.3))),
        Waves(kind=COMPONENTS, spectrum=((0.0, 0.0, 0.0),)),
    ],
)
def test_a_flat_sea_has_no_components(flat):
    waves = build_sea(Environment(depth=100.0, waves=flat))
    assert waves.frequency.size == waves.amplitude.size == waves.phase.size == waves.wave_number.size == 0
    assert waves.layer_bottom.size == 0 and waves.refresh == np.inf
