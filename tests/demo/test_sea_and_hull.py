"""Waves and their force: spectrum, dispersion, and the published excitation of the VolturnUS-S."""

import numpy as np
import pytest
from scipy.integrate import trapezoid

from mooring_ros.demo.hull import volturnus_s
from mooring_ros.demo.waves import Excitation, SeaState, Waves, force_transfer, jonswap, wave_number

DEPTH = 200.0


def test_wave_number_solves_the_dispersion_relation_from_shallow_to_deep():
    frequency = np.array([1e-3, 0.05, 0.2, 0.5, 1.0, 3.0, 10.0])
    for depth in (5.0, 50.0, 1000.0):
        k = wave_number(frequency, depth)
        assert 9.80665 * k * np.tanh(k * depth) == pytest.approx(frequency**2, rel=1e-13)


def test_elevation_has_the_significant_height_asked_for():
    waves = Waves(SeaState(height=6.0, period=12.0, ramp=0.0), DEPTH)
    elevation = waves.elevation(np.arange(0.0, 3 * 3600.0, 0.5))
    assert 4.0 * elevation.std() == pytest.approx(6.0, rel=0.03)
    assert abs(elevation.mean()) < 0.05


def test_components_follow_the_jonswap_density():
    sea = SeaState(height=6.0, period=12.0, components=20000, ramp=0.0)
    waves = Waves(sea, DEPTH)
    edges = np.linspace(0.35, 1.2, 18)
    energy = np.histogram(waves.frequency, edges, weights=0.5 * waves.amplitude**2)[0]
    middle = 0.5 * (edges[1:] + edges[:-1])
    fine = [trapezoid(jonswap(grid, 6.0, 12.0), grid) for grid in map(lambda a, b: np.linspace(a, b, 50), edges[:-1], edges[1:])]
    assert energy == pytest.approx(fine, rel=0.03)
    assert middle[np.argmax(energy)] == pytest.approx(2 * np.pi / 12.0, abs=0.05)


def test_jonswap_without_enhancement_is_pierson_moskowitz():
    frequency, peak = np.array([0.3, 0.5, 0.9]), 2 * np.pi / 12.0
    expected = 5.0 / 16.0 * 36.0 * peak**4 * frequency**-5.0 * np.exp(-1.25 * (peak / frequency) ** 4)
    assert jonswap(frequency, 6.0, 12.0, 1.0) == pytest.approx(expected, rel=2e-3)


def test_the_same_seed_gives_the_same_sea_and_another_one_another():
    times = np.linspace(0, 60, 100)
    first, again, other = (Waves(SeaState(seed=seed), DEPTH).elevation(times) for seed in (5, 5, 6))
    assert (first == again).all()
    assert np.abs(first - other).max() > 0.1


def test_waves_run_towards_their_heading():
    waves = Waves(SeaState(period=10.0, components=1, ramp=0.0, heading=np.pi / 2), DEPTH)
    delay = 2.0
    distance = delay * waves.frequency[0] / waves.wave_number[0]
    times = np.linspace(50, 80, 40)
    assert waves.elevation(times + delay, y=distance) == pytest.approx(waves.elevation(times), abs=1e-9)


def test_the_sea_grows_from_rest():
    waves = Waves(SeaState(ramp=10.0), DEPTH)
    force = Excitation(waves, volturnus_s())
    assert waves.elevation([0.0])[0] == 0.0 and np.abs(force(0.0)).max() == 0.0
    assert np.abs(waves.elevation(np.linspace(0, 1, 20))).max() < 0.3
    assert waves.ramp(np.array([5.0, 10.0, 50.0])) == pytest.approx([0.5, 1.0, 1.0])


def test_hull_has_the_displacement_and_centre_of_buoyancy_of_the_report():
    hull = volturnus_s()
    assert hull.volume.sum() == pytest.approx(20206.0)
    assert hull.volume @ hull.position / hull.volume.sum() == pytest.approx([0.0, 0.0, -13.63], abs=0.01)
    assert 1025.0 * 9.80665 * hull.disc_area.sum() == pytest.approx(4.47e6, rel=0.01)


def test_strips_add_up_to_the_published_added_mass():
    hull = volturnus_s()
    surge, _, heave = 1025.0 * hull.added_mass.sum(axis=0).diagonal()
    assert surge == pytest.approx(1.264e7, rel=0.03)
    assert heave == pytest.approx(2.693e7, rel=0.035)


def test_very_long_waves_lift_the_floater_like_a_tide():
    hull = volturnus_s()
    force = force_transfer(hull, np.array([2 * np.pi / 2000.0]), 0.0, DEPTH)[0]
    assert force[2].real == pytest.approx(1025.0 * 9.80665 * hull.disc_area.sum(), rel=0.01)
    assert abs(force[0]) < 0.01 * abs(force[2])


# Published WAMIT results of the reference model over ρ g: period (s) -> surge (m²), heave (m²), pitch (m³), for waves along x.
PUBLISHED = {10.4720: (465.25, 549.42, 10188.9), 12.5664: (480.10, 441.78, 6338.3), 15.7080: (399.22, 198.49, 2823.4)}


@pytest.mark.parametrize("period", PUBLISHED)
def test_wave_force_is_near_the_published_one(period):
    force = np.abs(force_transfer(volturnus_s(), np.array([2 * np.pi / period]), 0.0, DEPTH)[0]) / (1025.0 * 9.80665)
    surge, heave, pitch = PUBLISHED[period]
    assert force[0] == pytest.approx(surge, rel=0.06)
    assert force[2] == pytest.approx(heave, rel=0.25)
    assert force[4] == pytest.approx(pitch, rel=0.11)
    assert force[[1, 3, 5]] == pytest.approx(np.zeros(3), abs=1e-6 * pitch)


def test_waves_from_the_side_push_sideways():
    hull = volturnus_s()
    frequency = np.array([0.5])
    ahead, abeam = force_transfer(hull, frequency, 0.0, DEPTH)[0], force_transfer(hull, frequency, np.pi / 2, DEPTH)[0]
    assert abs(abeam[1]) == pytest.approx(abs(ahead[0]), rel=0.05)
    assert abs(abeam[0]) < 0.05 * abs(ahead[0])


def test_force_in_time_is_the_transfer_function_at_work():
    waves = Waves(SeaState(height=2.0, period=14.0, components=1, ramp=0.0), DEPTH)
    force = Excitation(waves, volturnus_s())
    transfer = force_transfer(volturnus_s(), waves.frequency, 0.0, DEPTH)[0]
    times = np.linspace(0, 28, 200)
    surge = np.array([force(t)[0] for t in times])
    assert np.abs(surge).max() == pytest.approx(abs(transfer[0]) * waves.amplitude[0], rel=1e-3)


@pytest.mark.parametrize("wrong", [{"height": -1.0}, {"period": 0.0}, {"period": float("nan")}, {"peak_enhancement": 0.5}, {"ramp": -1.0}])
def test_an_impossible_sea_is_refused(wrong):
    with pytest.raises(ValueError, match=next(iter(wrong))):
        SeaState(**wrong)
