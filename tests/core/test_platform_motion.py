"""The platform's motion between two samples: a cubic Hermite curve in position and rotation."""

import numpy as np
import pytest
from scenes_in_code import times_quaternion, turn
from scipy.spatial.transform import Rotation

from mooring_ros.core.platform import platform_at, rotate, start_motion, turned


def random_interval(seed, size=1.0):
    """Poses, twists and duration of an interval with a turn of some `size` (rad)."""
    rng = np.random.default_rng(seed)
    q0 = turn(rng.normal(size=3), rng.uniform(0.0, np.pi))
    q1 = times_quaternion(turn(rng.normal(size=3), size * rng.uniform(0.0, 1.0)), q0) * rng.choice([-1.0, 1.0])
    pose0, pose1 = np.append(rng.normal(size=3), q0), np.append(rng.normal(size=3), q1)
    return pose0, rng.normal(size=6), pose1, rng.normal(size=6), rng.uniform(0.05, 2.0)


def motion_of(pose0, twist0, pose1, twist1, duration):
    motion = np.zeros((8, 3))
    start_motion(pose0, twist0, pose1, twist1, duration, motion)
    return motion


def rotation_at(motion, q0, s):
    return Rotation.from_rotvec(platform_at(motion, s)[2]) * Rotation.from_quat(q0)


@pytest.mark.parametrize("seed", range(30))
def test_both_ends_are_met_in_pose_and_twist(seed):
    pose0, twist0, pose1, twist1, duration = random_interval(seed, size=3.0)
    motion = motion_of(pose0, twist0, pose1, twist1, duration)
    for s, pose, twist in ((0.0, pose0, twist0), (1.0, pose1, twist1)):
        place, velocity, _, omega = platform_at(motion, s)
        np.testing.assert_allclose(place, pose[:3], atol=1e-13)
        np.testing.assert_allclose(velocity, twist[:3], atol=1e-12)
        np.testing.assert_allclose(omega, twist[3:], atol=1e-9)
        assert (rotation_at(motion, pose0[3:], s) * Rotation.from_quat(pose[3:]).inv()).magnitude() < 1e-12


@pytest.mark.parametrize("seed", range(10))
def test_velocities_are_the_derivatives_of_place_and_rotation(seed):
    """Central differences, 1e-6."""
    pose0, twist0, pose1, twist1, duration = random_interval(seed, size=2.5)
    motion = motion_of(pose0, twist0, pose1, twist1, duration)
    step = 1e-5
    for s in (0.1, 0.35, 0.5, 0.8):
        _, velocity, _, omega = platform_at(motion, s)
        after, before = platform_at(motion, s + step)[0], platform_at(motion, s - step)[0]
        np.testing.assert_allclose((np.array(after) - before) / (2.0 * step * duration), velocity, rtol=1e-6, atol=1e-7)
        turned_by = rotation_at(motion, pose0[3:], s + step) * rotation_at(motion, pose0[3:], s - step).inv()
        np.testing.assert_allclose(turned_by.as_rotvec() / (2.0 * step * duration), omega, rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("angle", [1e-9, 1e-3, 0.29, 0.31, 1.5, 3.1])
def test_constant_angular_velocity_is_slerp(angle):
    axis = np.array([1.0, -2.0, 0.5]) / np.linalg.norm([1.0, -2.0, 0.5])
    q0 = turn([0.2, 1.0, 0.3], 0.8)
    duration = 0.7
    twist = np.append(np.zeros(3), axis * angle / duration)
    motion = motion_of(np.append(np.zeros(3), q0), twist, np.append(np.zeros(3), times_quaternion(turn(axis, angle), q0)), twist, duration)
    for s in np.linspace(0.0, 1.0, 11):
        _, _, phi, omega = platform_at(motion, s)
        np.testing.assert_allclose(phi, axis * angle * s, rtol=1e-9, atol=1e-15)
        np.testing.assert_allclose(omega, twist[3:], rtol=1e-9, atol=1e-12)


def test_sign_of_a_quaternion_does_not_matter():
    pose0, twist0, pose1, twist1, duration = random_interval(3)
    flipped = np.append(pose1[:3], -pose1[3:])
    np.testing.assert_allclose(
        motion_of(pose0, twist0, pose1, twist1, duration), motion_of(pose0, twist0, flipped, twist1, duration), atol=1e-12
    )


@pytest.mark.parametrize("miss", [0.0, 1e-12, 1e-6, -1e-6])
def test_half_a_turn_is_finite_and_meets_its_ends(miss):
    """180 degrees in one interval: either way round is right, not-a-number is not."""
    q1 = turn([0.0, 0.6, 0.8], np.pi + miss)
    motion = motion_of(np.array([0, 0, 0, 0, 0, 0, 1.0]), np.zeros(6), np.append(np.zeros(3), q1), np.zeros(6), 1.0)
    assert np.isfinite(motion).all()
    for s in np.linspace(0.0, 1.0, 21):
        assert np.isfinite(np.concatenate(platform_at(motion, s))).all()
    assert (rotation_at(motion, [0, 0, 0, 1.0], 1.0) * Rotation.from_quat(q1).inv()).magnitude() < 1e-9
    assert np.linalg.norm(platform_at(motion, 0.5)[2]) == pytest.approx(np.pi / 2.0, abs=1e-5)


@pytest.mark.parametrize("seed", range(5))
def test_vectors_are_turned_as_a_rotation_matrix_turns_them(seed):
    rng = np.random.default_rng(seed)
    q, a, phi = turn(rng.normal(size=3), rng.uniform(0, 6)), rng.normal(size=3), rng.normal(size=3) * 10.0 ** rng.uniform(-6, 0.5)
    np.testing.assert_allclose(rotate(q, a), Rotation.from_quat(q).apply(a), atol=1e-14)
    np.testing.assert_allclose(turned(phi, a), Rotation.from_rotvec(phi).apply(a), atol=1e-13)


def test_cubic_motion_is_reproduced_exactly():
    """Positions that are cubic in time need nothing between the samples: 1e-12."""
    t0, t1 = 0.4, 0.9
    coefficients = np.random.default_rng(1).normal(size=(4, 3))
    place = lambda t: sum(c * t**k for k, c in enumerate(coefficients))  # noqa: E731
    speed = lambda t: sum(k * c * t ** (k - 1) for k, c in enumerate(coefficients) if k)  # noqa: E731
    still = np.array([0.0, 0.0, 0.0, 1.0])
    twists = [np.append(speed(t), np.zeros(3)) for t in (t0, t1)]
    motion = motion_of(np.append(place(t0), still), twists[0], np.append(place(t1), still), twists[1], t1 - t0)
    for s in np.linspace(0.0, 1.0, 7):
        got = platform_at(motion, s)
        np.testing.assert_allclose(got[0], place(t0 + s * (t1 - t0)), atol=1e-12)
        np.testing.assert_allclose(got[1], speed(t0 + s * (t1 - t0)), atol=1e-12)
