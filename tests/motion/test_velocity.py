"""Twist from poses, against motions whose twist is known."""
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mooring_ros.motion import OnlineTwist, twist_from_poses

AXIS = np.array([0.6, 0.0, 0.8])


def turning(times):
    """A platform that heaves and at the same time yaws about z, after a swing about a fixed tilted axis: poses and twists."""
    angle, rate = 0.4 * np.sin(0.9 * times), 0.36 * np.cos(0.9 * times)
    swing, heading = Rotation.from_rotvec(angle[:, None] * AXIS), Rotation.from_rotvec(0.3 * times[:, None] * [0.0, 0.0, 1.0])
    omega = np.array([0.0, 0.0, 0.3]) + heading.apply(rate[:, None] * AXIS)
    position = np.column_stack((np.sin(times), np.cos(0.5 * times), times ** 2))
    velocity = np.column_stack((np.cos(times), -0.5 * np.sin(0.5 * times), 2 * times))
    return np.hstack((position, (heading * swing).as_quat())), np.hstack((velocity, omega))


def follow(tracker, time, pose):
    """The Estimate of one more pose."""
    estimate = tracker.propose(time, pose)
    tracker.take(estimate)
    return estimate


def uneven(n, span=6.0, seed=2):
    steps = np.random.default_rng(seed).uniform(0.6, 1.4, n - 1)
    return np.concatenate(([0.0], np.cumsum(steps))) * span / steps.sum()


def worst(n):
    times = np.linspace(0.0, 6.0, n) ** 1.2
    poses, twists = turning(times)
    return np.abs(twist_from_poses(times, poses) - twists).max()


def test_error_falls_with_the_fourth_power_of_the_spacing_to_the_ends():
    assert worst(60) / worst(120) > 12.0
    assert worst(120) / worst(240) > 13.0


def test_uneven_samples_at_twenty_hertz_are_within_a_ten_thousandth():
    times = uneven(120)
    poses, twists = turning(times)
    np.testing.assert_allclose(twist_from_poses(times, poses), twists, atol=3e-4)


def test_the_sign_of_a_quaternion_does_not_matter():
    times = uneven(40)
    poses, _ = turning(times)
    flipped = poses.copy()
    flipped[::3, 3:] *= -1.0
    np.testing.assert_allclose(twist_from_poses(times, flipped), twist_from_poses(times, poses), atol=1e-12)


@pytest.mark.parametrize("n", [1, 2, 3, 4])
def test_a_few_samples_of_a_steady_motion_are_enough(n):
    times = np.arange(n) * 0.1
    poses = np.zeros((n, 7))
    poses[:, 0] = 2.0 * times
    poses[:, 3:] = Rotation.from_rotvec(0.5 * times[:, None] * AXIS).as_quat()
    expected = [2.0, 0.0, 0.0, *(0.5 * AXIS)] if n > 1 else [0.0] * 6
    np.testing.assert_allclose(twist_from_poses(times, poses), np.tile(expected, (n, 1)), atol=1e-12)


@pytest.mark.parametrize("times, poses, words", [
    ([0.0, 1.0, 1.0], np.tile([0, 0, 0, 0, 0, 0, 1.0], (3, 1)), "after row 1"),
    ([0.0, 1.0], np.zeros((2, 6)), "fit"),
    ([0.0, np.nan], np.tile([0, 0, 0, 0, 0, 0, 1.0], (2, 1)), "finite"),
])
def test_histories_that_cannot_be_differenced_are_refused(times, poses, words):
    with pytest.raises(ValueError, match=words):
        twist_from_poses(times, poses)


def test_online_twist_is_second_order_and_looks_only_back():
    def worst_online(n):
        times = np.linspace(0.0, 6.0, n)
        poses, twists = turning(times)
        online = OnlineTwist()
        return np.abs([np.subtract(follow(online, t, pose).twist, twist) for t, pose, twist in zip(times, poses, twists)][2:]).max()
    assert worst_online(100) / worst_online(200) > 3.7


def test_online_twist_starts_from_rest_and_then_from_one_difference():
    online = OnlineTwist()
    assert follow(online, 0.0, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)).twist == (0.0,) * 6
    assert follow(online, 0.5, (1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)).twist[0] == pytest.approx(2.0)
