"""Kinematics of the water at the nodes against closed forms, and what the window of time costs in accuracy."""

import numpy as np
import pytest

from mooring_ros.core.cache import kernel
from mooring_ros.core.sea import build_sea, elevation
from mooring_ros.core.wave_sums import WINDOW_ROWS, WORK_SIZE
from mooring_ros.core.waves import calm, refresh, streams
from mooring_ros.scene.description import JONSWAP, REGULAR, Environment, Waves

STORM = Waves(kind=JONSWAP, height=8.25, period=14.5, direction=0.3)


@kernel
def streams_at(sea, time, size, position, window_times, window, stream, swell):
    streams(sea, time, size, position, window_times, window, stream, swell)


class Nodes:
    """Nodes (3, n) in a sea, with the arrays that a state has for them."""

    def __init__(self, environment, position, velocity=0.0):
        self.sea = build_sea(environment)
        self.position = np.array(position, dtype=float)
        self.velocity = np.array(np.broadcast_to(velocity, self.position.shape), dtype=float)
        n = self.position.shape[1]
        self.times, self.window, self.work = np.array([0.0, -1.0]), np.zeros((2, WINDOW_ROWS, n)), np.zeros(WORK_SIZE)
        self.stream, self.swell = np.zeros((3, n)), np.zeros((4, n))

    def refresh(self, start, end=None):
        end = start if end is None else end
        refresh(self.sea, start, end, self.position.shape[1], self.position, self.velocity, self.work, self.times, self.window)

    def at(self, time):
        """(velocity (3, n), acceleration (3, n), elevation (n,)) as the window has them."""
        streams_at(self.sea, time, self.position.shape[1], self.position, self.times, self.window, self.stream, self.swell)
        return self.stream.copy(), self.swell[:3].copy(), self.swell[3].copy()

    def exactly(self, time):
        self.times[:] = (0.0, -1.0)
        self.refresh(time)
        return self.at(time)


def wheeler(sea, time, position):
    """The same written out with hyperbolic functions, component by component, at places (3, n)."""
    h = sea.depth
    along = sea.direction @ position[:2]
    eta = elevation(sea, time, position[0], position[1])
    z = np.clip((position[2] - eta) * h / (h + eta), -h, 0.0)
    u, w, du, dw = np.zeros((4, position.shape[1]))
    for f, k, a, phase in zip(sea.frequency, sea.wave_number, sea.amplitude, sea.phase):
        theta = f * time - k * along - phase
        if k * h < 300.0:
            c, s = np.cosh(k * (z + h)) / np.sinh(k * h), np.sinh(k * (z + h)) / np.sinh(k * h)
        else:
            c = s = np.exp(k * z)
        u += f * a * c * np.cos(theta)
        w -= f * a * s * np.sin(theta)
        du -= f * f * a * c * np.sin(theta)
        dw -= f * f * a * s * np.cos(theta)
    dx, dy = sea.direction
    return np.array([dx * u, dy * u, w]), np.array([dx * du, dy * du, dw]), eta


def scattered(n, depth, seed=1, top=0.0):
    """Places (3, n) in the water, half of them in its upper tenth."""
    rng = np.random.default_rng(seed)
    z = np.where(np.arange(n) % 2, rng.uniform(-depth, top, n), rng.uniform(-0.1 * depth, top, n))
    return np.array([rng.uniform(-400.0, 400.0, n), rng.uniform(-400.0, 400.0, n), z])


@pytest.mark.parametrize(
    "depth, form",
    [
        (2000.0, lambda k, z, h: (np.exp(k * z), np.exp(k * z))),  # deep: k h = 43
        (1.5, lambda k, z, h: (1.0 / (k * h) + 0.0 * z, 1.0 / (k * h) * k * (z + h))),  # shallow: k h = 0.13
        (30.0, lambda k, z, h: (np.cosh(k * (z + h)) / np.sinh(k * h), np.sinh(k * (z + h)) / np.sinh(k * h))),
    ],
)
def test_small_airy_wave_moves_the_water_as_the_closed_form_says(depth, form):
    """Deep and shallow limits to 1 %, the full form to 1e-5; a height of 0.1 mm leaves nothing to stretch."""
    wave = Waves(kind=REGULAR, height=1e-4, period=13.6 if depth > 10.0 else 18.0, direction=0.5, phase=0.7)
    nodes = Nodes(Environment(depth=depth, waves=wave), scattered(40, depth, top=-1e-4))
    k, w, a = nodes.sea.wave_number[0], nodes.sea.frequency[0], 0.5e-4
    x, y, z = nodes.position
    c, s = form(k, z, depth)
    tolerance = 1e-5 if depth == 30.0 else 0.01
    for time in (0.0, 3.3, 4000.7):
        theta = w * time - k * (x * np.cos(0.5) + y * np.sin(0.5)) - 0.7
        velocity, acceleration, eta = nodes.exactly(time)
        u, du = w * a * c * np.cos(theta), -w * w * a * c * np.sin(theta)
        scale = w * a * np.max(c)
        assert np.allclose(velocity, [u * np.cos(0.5), u * np.sin(0.5), -w * a * s * np.sin(theta)], atol=tolerance * scale)
        assert np.allclose(acceleration, [du * np.cos(0.5), du * np.sin(0.5), -w * w * a * s * np.cos(theta)], atol=tolerance * w * scale)
        assert np.allclose(eta, a * np.cos(theta), atol=1e-6 * a)


@pytest.mark.parametrize("depth", [20.0, 70.0, 850.0])
def test_irregular_sea_at_nodes_is_the_sum_of_its_components(depth):
    """Approximations of functions, and components left out, cost less than 1e-5 of the surface's velocities."""
    nodes = Nodes(Environment(depth=depth, waves=STORM), scattered(83, depth, top=6.0))
    for time in (1.0, 777.7, 1e5 + 0.3):
        for found, exact in zip(nodes.exactly(time), wheeler(nodes.sea, time, nodes.position)):
            assert np.max(np.abs(found - exact)) < 1e-5 * np.max(np.abs(exact))


def test_stretching_carries_the_velocity_of_the_still_level_to_the_surface_and_leaves_that_at_the_bed():
    """Wheeler: under crest and trough alike the surface moves as Airy's z = 0 does, the bed as z = -h."""
    depth, height, period = 40.0, 6.0, 12.0
    wave = Waves(kind=REGULAR, height=height, period=period)
    for time, eta in ((0.0, 3.0), (0.5 * period, -3.0)):
        nodes = Nodes(Environment(depth=depth, waves=wave), [[0.0, 0.0], [0.0, 0.0], [eta, -depth]])
        k, w = nodes.sea.wave_number[0], nodes.sea.frequency[0]
        velocity, _, found = nodes.exactly(time)
        assert found == pytest.approx(eta)
        crest = np.sign(eta) * w * 0.5 * height
        assert velocity[0] == pytest.approx([crest / np.tanh(k * depth), crest / np.sinh(k * depth)], rel=1e-6)


def test_above_the_surface_the_water_is_that_of_the_surface():
    wave = Waves(kind=REGULAR, height=4.0, period=10.0)
    nodes = Nodes(Environment(depth=100.0, waves=wave), [[5.0, 5.0], [0.0, 0.0], [0.0, 9.0]])
    nodes.position[2, 0] = elevation(nodes.sea, 2.0, 5.0)
    velocity, acceleration, eta = nodes.exactly(2.0)
    assert np.allclose(velocity[:, 0], velocity[:, 1], rtol=1e-12)
    assert np.allclose(acceleration[:, 0], acceleration[:, 1], rtol=1e-12)
    assert eta[0] == eta[1] == pytest.approx(nodes.position[2, 0])


@pytest.mark.parametrize("radius, in_velocity, in_acceleration", [(0.0, 0.001, 0.02), (4.0, 0.002, 0.04)])
def test_interpolation_in_the_window_costs_little_of_the_rms_velocity_and_acceleration(radius, in_velocity, in_acceleration):
    """Nodes in the water stand still, or go on circles of 4 m in 14.5 s, which the window foresees as straight lines."""
    around = scattered(64, 70.0, seed=4, top=-6.0)
    turn = 2.0 * np.pi / 14.5

    def motion(time):
        angle = turn * time + np.arange(64)
        here = around + radius * np.array([np.cos(angle), 0.3 * np.sin(angle), np.sin(angle)])
        return here, radius * turn * np.array([-np.sin(angle), 0.3 * np.cos(angle), np.cos(angle)])

    nodes = Nodes(Environment(depth=70.0, waves=STORM), around)
    wrong, right = [], []
    for time in np.arange(100.0, 140.0, 0.05):
        nodes.position[:], nodes.velocity[:] = motion(time)
        nodes.refresh(time, time + 0.05)
        here, _ = motion(time + 0.025)
        nodes.position[:] = here
        found, exact = nodes.at(time + 0.025), wheeler(nodes.sea, time + 0.025, here)
        wet = here[2] < exact[2]
        right.append([part * wet for part in exact[:2]])
        wrong.append([(a - b) * wet for a, b in zip(found[:2], exact[:2])])
    share = np.sqrt(np.sum(np.square(wrong), axis=(0, 2, 3)) / np.sum(np.square(right), axis=(0, 2, 3)))
    assert share[0] < in_velocity and share[1] < in_acceleration


def test_nothing_jumps_where_one_window_follows_another():
    nodes = Nodes(Environment(depth=70.0, waves=STORM), scattered(40, 70.0), velocity=[[1.0], [0.5], [-0.8]])
    nodes.refresh(50.0, 50.1)
    for early in (0.1, 0.02, 0.3):
        start = nodes.times[1] - early
        nodes.position += 0.3
        before = nodes.at(start)
        nodes.refresh(start, nodes.times[1] + 0.01)
        for old, new in zip(before, nodes.at(start)):
            assert np.allclose(old, new, rtol=0.0, atol=1e-12)


def test_a_window_that_holds_the_time_is_left_alone():
    nodes = Nodes(Environment(depth=70.0, waves=STORM), scattered(40, 70.0))
    nodes.refresh(10.0, 10.2)
    before = nodes.window.copy()
    nodes.position += 1.0
    nodes.refresh(10.1, 10.3)
    assert np.array_equal(before, nodes.window)


def test_the_window_reaches_to_the_end_of_a_long_step():
    nodes = Nodes(Environment(depth=70.0, waves=STORM), scattered(40, 70.0))
    nodes.refresh(10.0, 12.0)
    assert tuple(nodes.times) == (10.0, 12.0)
    for found, exact in zip(nodes.at(12.0), wheeler(nodes.sea, 12.0, nodes.position)):
        assert np.max(np.abs(found - exact)) < 1e-5 * np.max(np.abs(exact))


def test_a_calm_window_is_still_water():
    nodes = Nodes(Environment(depth=70.0, current=(0.4, 0.1, 0.0), waves=STORM), scattered(40, 70.0))
    nodes.refresh(10.0, 10.2)
    calm(nodes.times, nodes.window)
    velocity, acceleration, eta = nodes.at(10.1)
    assert np.all(velocity == np.array([[0.4], [0.1], [0.0]])) and not np.any(acceleration) and not np.any(eta)


def test_the_sea_grows_over_its_ramp_and_accelerates_as_its_velocity_changes():
    """At nodes that stand still the acceleration is the rate of the velocity, on the ramp too (1 mm high: nothing is stretched)."""
    wave = Waves(kind=REGULAR, height=1e-3, period=10.0, ramp=12.0)
    nodes = Nodes(Environment(depth=100.0, waves=wave), scattered(16, 30.0, top=-0.1))
    assert not np.any(nodes.exactly(0.0)[0])
    for time in (2.0, 7.0, 11.0):
        rate = (nodes.exactly(time + 1e-3)[0] - nodes.exactly(time - 1e-3)[0]) / 2e-3
        assert np.allclose(nodes.exactly(time)[1], rate, atol=1e-4 * np.max(np.abs(rate)))
