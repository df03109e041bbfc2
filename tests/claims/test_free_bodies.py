"""Free points as bodies (clump weights, buoys), conservation, and the balance of the wrench on the platform."""

import numpy as np
import pytest
from scenes_in_code import COUPLED, FIXED, FREE, HERE, SCENES, line_type, refresh, scene, surge_heave, table, times_quaternion, turn

from mooring_ros import Mooring

RHO, G = 1025.0, 9.80665
MASS, VOLUME = 500.0, 0.2
FEATHER = 1e-3  # kg/m of a line that carries nothing of its own


def feather(stiffness):
    """A line type without weight in water."""
    return line_type(np.sqrt(4.0 * FEATHER / (np.pi * RHO)), FEATHER, stiffness)


def rest(times):
    return np.tile(HERE, (times.size, 1)), np.zeros((times.size, 6))


def hung(stiffness, length=10.0, segments=1, dt=None, **point):
    own = (point.get("mass", MASS), point.get("volume", VOLUME), point.get("drag_area", 0.0), point.get("added_mass", 0.0))
    points = [(FIXED, (0, 0, -20)), (FREE, (0, 0, -20 - length), *own)]
    return Mooring(scene(points, [(feather(stiffness), 1, 2, length, segments)], depth=1000.0), dt=dt)


def test_clump_weight_hangs_with_its_submerged_weight():
    """Tension (m - rho V) g, 1e-6: the line weighs nothing in water."""
    mooring = hung(1e6)
    mooring.settle(HERE)
    weight = (MASS - RHO * VOLUME) * G
    assert mooring.fairlead_tension[0] == pytest.approx(weight, rel=1e-6)
    assert mooring.node_positions("line1")[-1] == pytest.approx([0.0, 0.0, -20.0 - 10.0 * (1.0 + weight / 1e6)], abs=1e-6)


def test_buoy_under_water_pulls_its_line_up():
    """Tension (rho V - m) g, 1e-6."""
    points = [(FIXED, (0, 0, -40)), (FREE, (0, 0, -20), 50.0, VOLUME)]
    mooring = Mooring(scene(points, [(feather(1e6), 1, 2, 20.0, 10)], depth=40.0))
    mooring.settle(HERE)
    assert mooring.anchor_tension[0] == pytest.approx((RHO * VOLUME - 50.0) * G, rel=1e-6)


@pytest.mark.parametrize("added_mass", [0.0, 0.5, 1.0])
def test_clump_weight_swings_with_the_period_of_a_pendulum_in_water(added_mass):
    """2 pi sqrt((m + Ca rho V) L / ((m - rho V) g)), L stretched, small swing, no drag: 1e-4 over 10 periods."""
    mooring = hung(1e6, added_mass=added_mass)
    mooring.settle(HERE)
    length = 10.0 * (1.0 + (MASS - RHO * VOLUME) * G / 1e6)
    period = 2.0 * np.pi * np.sqrt((MASS + added_mass * RHO * VOLUME) * length / ((MASS - RHO * VOLUME) * G))
    mooring._state.velocity[1, mooring._model.point_node[1]] = 1e-3
    refresh(mooring)
    times = np.arange(1, 2001) * period / 200.0
    side = mooring.run(times, *rest(times)).anchor_end_force[:, 0, 1]
    crossings = np.flatnonzero((side[:-1] < 0.0) & (side[1:] >= 0.0))
    exact = times[crossings] - side[crossings] * np.diff(times)[crossings] / (side[crossings + 1] - side[crossings])
    assert np.diff(exact).mean() == pytest.approx(period, rel=1e-4)


def floating_sphere(**more):
    points = [(FIXED, (0, 0, -40)), (FREE, (0, 0, -0.3), 0.5 * RHO * VOLUME, VOLUME, 0.0, 0.5)]
    return Mooring(scene(points, [(feather(1e5), 1, 2, 60.0, 1)], depth=40.0, **more))


def test_sphere_of_half_the_waters_density_floats_half_submerged():
    """z = 0 of its centre within 1e-4 of its diameter (the slack line's end node weighs something out of the water)."""
    mooring = floating_sphere()
    mooring.settle(HERE)
    assert mooring.node_positions("line1")[-1, 2] == pytest.approx(0.0, abs=1e-4 * (6.0 * VOLUME / np.pi) ** (1.0 / 3.0))


def test_floating_sphere_heaves_with_its_natural_period():
    """omega^2 = rho g (pi d^2/4) / (m + Ca rho V/2), small heave: 1 %; the water line of a sphere at mid height."""
    mooring = floating_sphere()
    mooring.settle(HERE)
    diameter = (6.0 * VOLUME / np.pi) ** (1.0 / 3.0)
    omega = np.sqrt(RHO * G * 0.25 * np.pi * diameter**2 / (0.5 * RHO * VOLUME * 1.5))
    node = mooring._model.point_node[1]
    mooring._state.velocity[2, node] = 1e-3
    refresh(mooring)
    heights = []
    step = 2.0 * np.pi / omega / 100.0
    for k in range(1, 1001):
        mooring.step(k * step, HERE, np.zeros(6))
        heights.append(mooring._state.position[2, node])
    heights = np.array(heights) - np.mean(heights)
    crossings = np.flatnonzero((heights[:-1] < 0.0) & (heights[1:] >= 0.0))
    assert np.diff(crossings).mean() * step == pytest.approx(2.0 * np.pi / omega, rel=0.01)


@pytest.mark.parametrize("added_mass", [0.0, 1.0])
def test_falling_point_follows_the_closed_form(added_mass):
    """v(t) = v_t tanh(t/tau), v_t^2 = 2 (m - rho V) g / (rho CdA), tau = (m + Ca rho V) v_t / ((m - rho V) g): 0.5 %; g m/(m + m_a) at first."""
    area = 0.4
    mooring = hung(1e5, length=500.0, dt=0.005, drag_area=area, added_mass=added_mass)
    mooring.settle(HERE)
    node = mooring._model.point_node[1]
    mooring._state.position[:, node] = [0.0, 0.0, -30.0]
    refresh(mooring)
    weight, inertia = (MASS - RHO * VOLUME) * G, MASS + added_mass * RHO * VOLUME
    assert mooring._state.acceleration[2, node] == pytest.approx(-weight / inertia, rel=2e-3)
    terminal = np.sqrt(2.0 * weight / (RHO * area))
    tau = inertia * terminal / weight
    for t in (0.3, 1.0, 2.0, 10.0):
        mooring.step(t, HERE, np.zeros(6))
        assert -mooring._state.velocity[2, node] == pytest.approx(terminal * np.tanh(t / tau), rel=5e-3)


def energy(mooring):
    """Kinetic, elastic and potential energy (J) of all nodes and segments in a vacuum."""
    model, state = mooring._model, mooring._state
    last = model.size
    position, velocity = state.position[:, :last], state.velocity[:, :last]
    kinetic = 0.5 * (model.mass[:last] * (velocity**2).sum(axis=0)).sum()
    stretch = np.linalg.norm(np.diff(state.position[:, : last + 1], axis=1), axis=0) - model.length[1 : last + 1]
    elastic = 0.5 * (model.live * model.stiffness * model.inverse_length)[1 : last + 1] * np.maximum(stretch, 0.0) ** 2
    return kinetic + elastic.sum() + (model.weight[:last] * position[2]).sum()


def test_conservative_swing_keeps_its_energy():
    """A rope of 10 segments with a weight at its end swings for 100 periods in a vacuum: energy within 5e-3 of the swing's own, drift below 2e-3."""
    kind = line_type(mass=5.0, stiffness=1e5)
    points = [(FIXED, (0, 0, -20)), (FREE, (0, 0, -30), 100.0)]
    mooring = Mooring(scene(points, [(kind, 1, 2, 10.0, 10)], depth=100.0, water_density=0.0))
    mooring.settle(HERE)
    swing = np.linspace(0.0, 1.0, 11) * 3.0
    mooring._state.velocity[0, :11] = swing
    lowest = energy(mooring)
    mooring._state.velocity[0, mooring._model.point_node[1]] = 3.0
    refresh(mooring)
    total, start = [], energy(mooring)
    times = np.arange(1, 2001) * 0.3
    for block in times.reshape(100, 20):
        mooring.run(block, *rest(block))
        total.append(energy(mooring))
    assert mooring.anchor_tension[0] > 100.0
    total = (np.array(total) - start) / (start - lowest + 0.5 * 50.0 * 1.0)
    assert np.abs(total).max() < 5e-3
    assert abs(np.polyfit(np.arange(100), total, 1)[0]) * 100 < 2e-3


def test_wrench_is_the_sum_of_the_fairlead_forces_and_their_moments():
    """About the reference point, in a motion with surge, heave and pitch from a turned pose: 1e-12 of the largest arm times force."""
    mooring = Mooring(SCENES / "oc4.txt")
    heading = turn([0.3, 0.2, 1.0], 0.4)
    times = np.arange(1, 61) * 0.1
    poses, twists = surge_heave(times, pitch=0.1)
    poses[:, 3:] = [times_quaternion(q, heading) for q in poses[:, 3:]]
    start = np.concatenate([np.zeros(3), heading])
    mooring.settle(start)
    run = mooring.run(times, poses, twists)
    places = [np.array(p.position) for p in mooring.scene.points if p.kind == COUPLED]
    for k in (0, 29, 59):
        axis, w = poses[k, 3:6], poses[k, 6]
        arms = [r + 2.0 * np.cross(axis, np.cross(axis, r) + w * r) for r in places]
        forces = run.coupled_wrenches[k, :, :3]
        moment = sum(np.cross(r, f) for r, f in zip(arms, forces))
        np.testing.assert_allclose(run.wrench[k, :3], forces.sum(axis=0), rtol=1e-12, atol=1e-6)
        np.testing.assert_allclose(run.wrench[k, 3:], moment, rtol=1e-9, atol=1e-9 * np.abs(forces).max() * 41.0)
        np.testing.assert_allclose(run.fairlead_end_force[k], forces, rtol=1e-12)


def test_still_wrench_carries_the_lines_weight_with_the_anchors_and_the_bed():
    """Vertical balance at rest: fairleads + anchors + bed = submerged weight of the lines; horizontal: fairleads + anchors = 0; 1e-9."""
    mooring = Mooring(SCENES / "volturnus_s_chain.txt")
    mooring.settle(np.concatenate([[5.0, 3.0, -1.0], turn([0, 0, 1], 0.1)]))
    model, state = mooring._model, mooring._state
    bed = (model.bed_stiffness * np.maximum(model.bed_level - state.position[2], 0.0))[: model.size].sum()
    total = mooring.fairlead_end_force.sum(axis=0) + mooring.anchor_end_force.sum(axis=0)
    weight = (model.weight - model.buoyancy).sum()
    assert total[2] == pytest.approx(bed - weight, rel=1e-9)
    np.testing.assert_allclose(total[:2], 0.0, atol=1e-9 * weight)
    assert weight == pytest.approx(3 * 850.0 * float(table("catenary_static.csv")[13]["w_N_per_m"]), rel=1e-3)


def test_end_forces_hold_the_inertia_of_the_half_segments():
    """A bar of one segment spun about its middle at constant speed: m L/2 omega^2 r at each end, less its tension; 1e-3.

    And pushed along with constant acceleration: half its mass times that at each end.
    """
    kind = line_type(mass=50.0, stiffness=1e9)
    points = [(COUPLED, (-5, 0, -20)), (COUPLED, (5, 0, -20))]
    mooring = Mooring(scene(points, [(kind, 1, 2, 9.999, 1)], gravity=0.0, water_density=0.0))
    mooring.settle(HERE)
    tension = mooring.fairlead_tension[0]
    omega, times = 0.5, np.arange(1, 101) * 0.01
    poses = np.array([np.concatenate([np.zeros(3), turn([0, 0, 1], omega * t)]) for t in times])
    mooring._state.twist[0, 5] = omega
    run = mooring.run(times, poses, np.tile([0, 0, 0, 0, 0, omega], (100, 1)))
    outward = np.array([np.cos(omega), np.sin(omega), 0.0])
    want = (50.0 * 9.999 / 2.0 * omega**2 * 5.0 - tension) * outward
    np.testing.assert_allclose(run.fairlead_end_force[-1, 0], want, atol=1e-3 * np.linalg.norm(want))
    mooring.settle(HERE)
    poses, twists = rest(times)
    poses[:, 1], twists[:, 1] = 0.5 * 2.0 * times**2, 2.0 * times
    run = mooring.run(times, poses, twists)
    np.testing.assert_allclose(run.wrench[1:, 1], -50.0 * 9.999 * 2.0, rtol=1e-6)
