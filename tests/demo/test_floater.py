"""The floater's figures against the published ones, and its equations against conservation laws."""

import dataclasses

import numpy as np
import pytest
from mooring_ros.demo.floater import Floater, FloaterProperties, quaternion_rate, rotation_matrix
from mooring_ros.demo.integrator import Integrator

STEP = 0.02

# A linear spring mooring: the linearised VolturnUS-S moorings of the reference model (WAMIT inputs).
STIFFNESS = np.array(
    [
        [7.192e4, 0.0, 0.0, 0.0, 1.145e6, 0.0],
        [0.0, 7.192e4, 0.0, -1.145e6, 0.0, 0.0],
        [0.0, 0.0, 6.076e4, 0.0, 0.0, 0.0],
        [0.0, -1.145e6, 0.0, 2.587e8, 0.0, 0.0],
        [1.145e6, 0.0, 0.0, 0.0, 2.587e8, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 2.524e8],
    ]
)
PULL = np.array([0.0, 0.0, -6.065e6, 0.0, 0.0, 0.0])  # N, the report's vertical pull


def wrench(pose):
    """Wrench (6,) on the platform at pose (7,), small rotations."""
    x, y, z, w = pose[3:7]
    rotation = 2.0 * np.arctan2(np.linalg.norm([x, y, z]), w) * np.array([x, y, z]) / max(np.linalg.norm([x, y, z]), 1e-300)
    return PULL - STIFFNESS @ np.concatenate([pose[:3], rotation])


def still_water(time):
    return np.zeros(6)


def drift(integrator, seconds, mooring=wrench):
    """Poses (n, 7) over so many seconds, the first one included."""
    poses = [integrator.pose]
    for _ in range(round(seconds / integrator.step)):
        integrator.advance(mooring(integrator.pose))
        poses.append(integrator.pose)
    return np.array(poses)


def undamped():
    return Floater(dataclasses.replace(FloaterProperties(), quadratic_damping=np.zeros((6, 6)), linear_damping=np.zeros(6)))


def period_of_decay(poses, values, step):
    """Mean time between upward zero crossings of a decay about its end."""
    values = values - np.mean(values[len(values) // 2:])
    up = np.flatnonzero((values[:-1] < 0) & (values[1:] >= 0))
    crossings = (up - values[up] / (values[up + 1] - values[up])) * step
    assert len(crossings) >= 2
    return np.diff(crossings).mean()


def test_report_balances_weight_buoyancy_and_mooring_within_half_a_percent_of_the_surplus():
    floater = Floater()
    rest = floater.hydrostatic_wrench(np.array([0, 0, 0, 0, 0, 0, 1.0])) + PULL
    assert abs(rest[2]) < 0.005 * abs(PULL[2])
    assert rest[[0, 1, 3, 4, 5]] == pytest.approx(np.zeros(5))


def test_trimmed_floater_stays_where_it_is():
    floater = Floater()
    pull = PULL + [0.0, 0.0, 3e5, 4e6, -5e6, 0.0]
    floater.trim(pull)
    poses = drift(Integrator(floater, still_water, STEP), 20.0, lambda pose: pull)
    assert np.abs(poses - [0, 0, 0, 0, 0, 0, 1]).max() < 1e-9


# Report, table of rigid-body natural frequencies: 0.007, 0.049, 0.036 and 0.011 Hz for surge, heave, pitch and yaw, to the
# rounding of their last digit.
@pytest.mark.parametrize(
    "mode, shortest, longest",
    [(0, 133.0, 154.0), (2, 20.2, 20.7), (4, 27.3, 28.2), (5, 86.9, 95.3)],
    ids=["surge", "heave", "pitch", "yaw"],
)
def test_natural_period_is_the_published_one(mode, shortest, longest):
    floater = Floater()
    p = floater.properties
    righting = p.tilt_stiffness - p.mass * p.gravity * p.centre_of_gravity
    stiffness = STIFFNESS + np.diag([0, 0, p.heave_stiffness, righting, righting, 0])
    squares, shapes = np.linalg.eig(np.linalg.solve(floater.mass_matrix, stiffness))
    scaled = np.abs(shapes) * np.sqrt(np.diag(floater.mass_matrix))[:, None]
    square = squares.real[np.argmax(scaled[mode] / np.linalg.norm(scaled, axis=0))]
    assert shortest < 2.0 * np.pi / np.sqrt(square) < longest


@pytest.mark.parametrize("mode, start, expected", [("heave", 1.0, 20.4), ("pitch", np.radians(3.0), 27.8)])
def test_free_decay_has_the_published_period_and_dies_out(mode, start, expected):
    pose = np.array([0, 0, 0, 0, 0, 0, 1.0])
    if mode == "heave":
        pose[2] = start
    else:
        pose[4], pose[6] = np.sin(start / 2), np.cos(start / 2)
    floater = Floater()
    floater.trim(PULL)
    poses = drift(Integrator(floater, still_water, 0.05, pose), 8 * expected)
    values = poses[:, 2] if mode == "heave" else 2.0 * poses[:, 4]
    assert period_of_decay(poses, values, 0.05) == pytest.approx(expected, rel=0.03)
    cycle = round(expected / 0.05)
    assert np.ptp(values[-cycle:]) < 0.6 * np.ptp(values[:cycle])


def test_free_body_without_damping_keeps_its_energy():
    floater = undamped()
    surplus = (floater.properties.density * floater.properties.displacement - floater.properties.mass) * 9.80665
    floater.trim(np.zeros(6))
    pose = np.array([0, 0, 1.0, *rotated(0.1, 0.15, 0.4)])
    integrator = Integrator(floater, still_water, 0.02, pose, [0.5, -0.3, 0.2, 0.01, 0.02, -0.015])
    before = floater.energy(integrator.pose, integrator.twist)
    drift(integrator, 60.0, lambda pose: np.zeros(6))
    assert floater.energy(integrator.pose, integrator.twist) == pytest.approx(before, rel=2e-5)
    assert surplus > 0


def test_damping_takes_energy_whatever_the_motion():
    floater = Floater()
    random = np.random.default_rng(3)
    for _ in range(200):
        twist = random.normal(size=6) * [1, 1, 1, 0.02, 0.02, 0.02]
        assert floater.damping_wrench(twist) @ twist < 0.0


def test_turning_the_world_about_z_turns_the_motion():
    """Nothing in the equations prefers a compass direction: the same push, turned by 70 degrees, gives the turned motion."""
    turn = np.radians(70.0)
    c, s = np.cos(turn), np.sin(turn)
    world = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    push = np.array([2e6, 5e5, 1e6, 3e7, 8e7, 1e7])
    turned_push = np.concatenate([world @ push[:3], world @ push[3:]])
    plain, turned = Floater(), Floater()
    first = Integrator(plain, still_water, STEP)
    second = Integrator(turned, still_water, STEP, [0, 0, 0, 0, 0, np.sin(turn / 2), np.cos(turn / 2)])
    drift(first, 10.0, lambda pose: push)
    drift(second, 10.0, lambda pose: turned_push)
    assert second.pose[:3] == pytest.approx(world @ first.pose[:3], abs=1e-9)
    assert rotation_matrix(second.pose[3:]) == pytest.approx(world @ rotation_matrix(first.pose[3:]), abs=1e-9)


def test_integrator_is_of_second_order_with_the_mooring_answering_once_a_step():
    def end(step):
        integrator = Integrator(Floater(), lambda t: np.array([3e6 * np.sin(0.5 * t), 0, 0, 0, 0, 0]), step)
        integrator.floater.trim(PULL)
        drift(integrator, 16.0)
        return integrator.pose[:3]

    coarse, middle, fine = end(0.4), end(0.2), end(0.1)
    assert np.linalg.norm(coarse - middle) / np.linalg.norm(middle - fine) == pytest.approx(4.0, rel=0.2)


def test_quaternion_rate_is_that_of_the_rotation():
    quaternion, spin, step = np.array(rotated(0.3, -0.2, 0.5)), np.array([0.1, -0.3, 0.2]), 1e-6
    after = quaternion + step * quaternion_rate(quaternion, spin)
    change = (rotation_matrix(after) - rotation_matrix(quaternion)) / step @ rotation_matrix(quaternion).T
    assert [change[2, 1], change[0, 2], change[1, 0]] == pytest.approx(spin, abs=1e-5)


def test_a_motion_that_is_not_finite_is_refused_and_the_state_kept():
    integrator = Integrator(Floater(), still_water, STEP)
    before = integrator.pose.copy()
    with pytest.raises(ArithmeticError, match="not finite"):
        integrator.advance(np.full(6, np.nan))
    assert (integrator.pose == before).all() and integrator.count == 0


def rotated(roll, pitch, yaw):
    """Quaternion x, y, z, w of fixed-axis roll, pitch, yaw (rad)."""
    cr, sr, cp, sp, cy, sy = (f(a / 2) for a in (roll, pitch, yaw) for f in (np.cos, np.sin))
    return [sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy]
