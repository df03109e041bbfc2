"""Rigid parts in motion and at rest against closed forms: bodies, rods, and what holds them."""

import numpy as np
import pytest
from parts_in_code import G, RHO, mooring, period, rod_type, start, watch
from scenes_in_code import FIXED, HERE, line_type, turn
from scipy.spatial.transform import Rotation
from scipy.special import ellipk

from mooring_ros.scene.description import BODY, COUPLED, FREE, PINNED

MASS, VOLUME = 500.0, 0.2
FEATHER = line_type(np.sqrt(4e-3 / (np.pi * RHO)), 1e-3, 1e5, name="feather")  # weighs nothing in water
DIAMETER = (6.0 * VOLUME / np.pi) ** (1.0 / 3.0)


def sphere(length=500.0, above=20.0, dt=0.005, **body):
    """A free body at z = 0, on a slack feather line to a point 20 m below it."""
    own = dict(kind=FREE, position=(0.0, 0.0, 0.0), mass=MASS, volume=VOLUME, inertia=(20.0, 20.0, 20.0))
    points = [(FIXED, (0, 0, -above)), (BODY, (0, 0, 0), 0.0, 0.0, 0.0, 0.0, 1)]
    return mooring(points, [(FEATHER, 1, 2, length, 1)], bodies=[{**own, **body}], dt=dt, idle=False)


@pytest.mark.parametrize("added_mass", [0.0, 1.0])
def test_falling_body_reaches_its_terminal_speed_as_the_closed_form_says(added_mass):
    """v(t) = v_t tanh(t/tau), v_t^2 = 2 (m - rho V) g / (rho CdA), tau = (m + Ca rho V) v_t / ((m - rho V) g): 0.5 %."""
    body = sphere(drag_area=(0.4,) * 6, added_mass=(added_mass,) * 3)
    body.settle(HERE)
    start(body, 0, (0.0, 0.0, -30.0))
    weight, inertia = (MASS - RHO * VOLUME) * G, MASS + added_mass * RHO * VOLUME
    terminal = np.sqrt(2.0 * weight / (RHO * 0.4))
    tau = inertia * terminal / weight
    times = np.array([0.3, 1.0, 2.0, 10.0])
    np.testing.assert_allclose(-watch(body, 0, times)[:, 9], terminal * np.tanh(times / tau), rtol=5e-3)


def floating(density, **body):
    return sphere(length=60.0, mass=density * RHO * VOLUME, **body)


@pytest.mark.parametrize("density", [0.2, 0.5, 0.9])
def test_floating_sphere_draws_the_water_of_its_cap(density):
    """Cap pi h^2 (3 R - h) / 3 = m / rho: 1e-3 of the diameter."""
    body = floating(density)
    body.settle(HERE)
    under = 0.5 - body.body_poses["body1"][2] / DIAMETER
    assert under * under * (3.0 - 2.0 * under) == pytest.approx(density, abs=1e-3)


def test_floating_body_heaves_with_its_natural_period():
    """omega^2 = rho g pi d^2/4 / (m + Ca rho V/2), half submerged, small heave: 0.5 %."""
    body = floating(0.5, added_mass=(0.5,) * 3)
    body.settle(HERE)
    omega = np.sqrt(RHO * G * 0.25 * np.pi * DIAMETER**2 / (0.5 * RHO * VOLUME * 1.5))
    start(body, 0, velocity=(0.0, 0.0, 1e-2))
    times = np.arange(1, 801) * 0.02
    assert period(times, watch(body, 0, times)[:, 2]) == pytest.approx(2.0 * np.pi / omega, rel=5e-3)


@pytest.mark.parametrize("amplitude", [0.02, np.pi / 3.0], ids=["small", "60 degrees"])
@pytest.mark.parametrize("added_mass", [0.0, 0.7])
def test_body_with_low_centre_of_gravity_rocks_with_the_period_of_the_pendulum(added_mass, amplitude):
    """As heavy as its water, nothing else acts on it: the mass and the added mass turn about their common centre.

    omega^2 = m g d / (I + d^2 m m_a / (m + m_a)) for small angles, times pi / 2K(sin(amplitude / 2)) for large ones: 0.1 %.
    """
    depth, mass, inertia = 0.15, RHO * VOLUME, 20.0
    body = floating(1.0, added_mass=(added_mass,) * 3, centre_of_gravity=(0.0, 0.0, -depth), inertia=(inertia, 1.3 * inertia, inertia))
    body.settle(HERE)
    start(body, 0, (0.0, 0.0, -10.0), turn([1, 0, 0], amplitude))
    added = added_mass * mass
    omega = np.sqrt(mass * G * depth / (inertia + depth**2 * mass * added / (mass + added)))
    omega *= 0.5 * np.pi / ellipk(np.sin(0.5 * amplitude) ** 2)
    times = np.arange(1, 1001) * 0.02
    assert period(times, watch(body, 0, times)[:, 3]) == pytest.approx(2.0 * np.pi / omega, rel=1e-3)


@pytest.mark.parametrize("amplitude", [0.02, np.pi / 3.0], ids=["small", "60 degrees"])
@pytest.mark.parametrize("segments", [1, 10])
@pytest.mark.parametrize("density, added", [(0.0, 0.0), (RHO, 1.0)], ids=["in air", "in water"])
def test_pinned_rod_swings_as_a_physical_pendulum(density, added, segments, amplitude):
    """omega^2 = (m - rho A) g L/2 / ((m + Ca rho A) L^2/3 + m d^2/16), and the elliptic integral: 0.1 %, whatever the number of segments."""
    length, diameter, mass = 6.0, 0.4, 300.0
    kind = rod_type(diameter, mass, added=added)
    top = np.array([0.0, 0.0, -20.0])
    rods = [(kind, PINNED, tuple(top), tuple(top - [0.0, 0.0, length]), segments)]
    pendulum = mooring([], [], rods, depth=500.0, water_density=density, dt=0.005)
    pendulum.settle(HERE)
    start(pendulum, 0, quaternion=turn([1, 0, 0], amplitude))
    water = 0.25 * np.pi * diameter**2 * density
    inertia = (mass + added * water) * length**3 / 3.0 + mass * length * diameter**2 / 16.0
    omega = np.sqrt((mass - water) * G * length**2 / 2.0 / inertia) * 0.5 * np.pi / ellipk(np.sin(0.5 * amplitude) ** 2)
    times = np.arange(1, 1501) * 0.02
    assert period(times, watch(pendulum, 0, times)[:, 3]) == pytest.approx(2.0 * np.pi / omega, rel=1e-3)


def spinning(inertia, spin, leapfrog):
    """A free body without gravity that spins; its line is slack, and the water too thin to be felt: it makes the solver choose its scheme."""
    kind = line_type(0.01, 1e-6, 10.0, damping=0.0 if leapfrog else -0.8, drag=1.0, name="thread")
    points = [(FIXED, (0, 0, -20)), (BODY, (0, 0, 0), 0.0, 0.0, 0.0, 0.0, 1)]
    body = dict(kind=FREE, position=(0.0, 0.0, 0.0), mass=100.0, inertia=inertia)
    top = mooring(points, [(kind, 1, 2, 60.0, 1)], bodies=[body], idle=False, gravity=0.0, water_density=0.0 if leapfrog else 1e-12, bed_stiffness=0.0, bed_damping=0.0, dt=0.01)
    top.settle(HERE)
    start(top, 0, spin=spin)
    return top


@pytest.mark.parametrize("leapfrog", [True, False], ids=["leapfrog", "Runge-Kutta"])
def test_free_symmetric_top_keeps_its_momentum_and_precesses_at_the_closed_form_rate(leapfrog):
    """Its axis turns about L at L / I_1; L within 5e-3 (leapfrog's spin stands half a step back), its size, the energy and the rate within 1e-3 over 100 s, some 50 turns."""
    inertia, spin = np.array([20.0, 20.0, 35.0]), np.array([0.6, 0.0, 2.0])
    top = spinning(tuple(inertia), spin, leapfrog)
    times = np.arange(1, 1001) * 0.1
    parts = watch(top, 0, times)
    turns = Rotation.from_quat(parts[:, 3:7]).as_matrix()
    momentum = np.array([r @ (inertia * (r.T @ row[10:])) for r, row in zip(turns, parts)])
    energy = np.array([0.5 * row[10:] @ m for row, m in zip(parts, momentum)])
    first = inertia * spin
    assert np.linalg.norm(momentum - first, axis=1).max() < 5e-3 * np.linalg.norm(first)
    np.testing.assert_allclose(np.linalg.norm(momentum, axis=1), np.linalg.norm(first), rtol=1e-3)
    np.testing.assert_allclose(energy, 0.5 * first @ spin, rtol=1e-3)
    axes = np.array([r[:, 2] for r in turns])
    along = first / np.linalg.norm(first)
    x = np.cross([0.0, 1.0, 0.0], along)
    angle = np.unwrap(np.arctan2(axes[:, 1], axes @ x))
    assert abs(np.polyfit(times, angle, 1)[0]) == pytest.approx(np.linalg.norm(first) / inertia[0], rel=1e-3)


@pytest.mark.parametrize("segments", [1, 5])
def test_coupled_rod_hands_its_inertia_to_the_platform(segments):
    """At end A, the platform's reference point, without gravity: -m a and m L/2 a with the acceleration, -(m L^2/3 + m d^2/16) alpha with the spin: 1e-6."""
    mass, length, diameter = 300.0 * 6.0, 6.0, 0.4
    rods = [(rod_type(diameter, 300.0), COUPLED, (0.0, 0.0, 0.0), (0.0, 0.0, -length), segments)]
    rod = mooring([], [], rods, water_density=0.0, gravity=0.0, dt=0.005)
    at = rod.coupled_names.index("rod1")
    times, a = np.arange(1, 11) * 0.01, 2.0
    poses, twists = np.tile(HERE, (10, 1)), np.zeros((10, 6))
    poses[:, 1], twists[:, 1] = 0.5 * a * times**2, a * times
    rod.settle(HERE)
    wrench = rod.run(times, poses, twists).coupled_wrenches[-1, at]
    np.testing.assert_allclose(wrench, [0.0, -mass * a, 0.0, -mass * a * 0.5 * length, 0.0, 0.0], atol=1e-6 * mass * length)
    poses, twists = np.array([np.append(np.zeros(3), turn([1, 0, 0], 0.5 * a * t**2)) for t in times]), np.zeros((10, 6))
    twists[:, 3] = a * times
    rod.settle(HERE)
    wrench = rod.run(times, poses, twists).coupled_wrenches[-1, at]
    assert wrench[3] == pytest.approx(-(mass * length**2 / 3.0 + mass * diameter**2 / 16.0) * a, rel=1e-6)
