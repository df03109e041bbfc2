"""Prediction against motions whose future is known."""
import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from benchmarks import late_spring
from mooring_ros.motion import Predictor, carry_on

AXIS = np.array([0.6, 0.0, 0.8])


def falling(t):
    """Constant acceleration, also in angle: pose, twist, acceleration."""
    acceleration = np.array([0.3, -0.2, 0.1, *(0.05 * AXIS)])
    speed = np.array([1.0, 2.0, -1.0, *(0.4 * AXIS)])
    moved = speed * t + 0.5 * acceleration * t * t
    return np.array([*moved[:3], *Rotation.from_rotvec(moved[3:]).as_quat()]), speed + acceleration * t, acceleration


def test_a_motion_of_constant_acceleration_is_predicted_exactly():
    pose, twist, acceleration = falling(1.0)
    later, faster, _ = falling(1.5)
    predicted = carry_on(pose, twist, 0.5, acceleration)
    np.testing.assert_allclose(predicted[0], later, atol=1e-14)
    np.testing.assert_allclose(predicted[1], faster, atol=1e-14)


def error_of_an_oscillation(delay, omega=2.0, step=0.001):
    predictor, worst = Predictor(delay), 0.0
    for k in range(2000):
        t = step * k
        _, pose, _ = predictor.predict(t, (math.sin(omega * t), 0, 0, 0, 0, 0, 1.0), (omega * math.cos(omega * t), 0, 0, 0, 0, 0))
        worst = max(worst, abs(pose[0] - math.sin(omega * (t + delay)))) if k > 1 else worst
    return worst


def test_of_an_oscillation_the_sixth_of_the_cube_of_its_angle_is_left():
    for delay in (0.05, 0.1):
        assert error_of_an_oscillation(delay, step=1e-4) == pytest.approx((2.0 * delay) ** 3 / 6.0, rel=0.1)


def test_the_acceleration_is_differenced_where_nobody_gives_it():
    predictor = Predictor(0.2)
    for t in (1.0, 1.1):
        pose, twist, _ = falling(t)
        time, predicted, faster = predictor.predict(t, pose, twist)
    expected = falling(1.3)
    assert time == pytest.approx(1.3)
    np.testing.assert_allclose(predicted, expected[0], atol=1e-12)
    np.testing.assert_allclose(faster, expected[1], atol=1e-12)


def test_without_a_delay_the_sample_comes_back_bit_for_bit():
    pose, twist, _ = falling(0.7)
    assert Predictor().predict(0.7, pose, twist) == (0.7, tuple(pose), tuple(twist))


@pytest.mark.parametrize("forget", ["restart", "pause", "set back"])
def test_a_jump_of_the_platform_is_no_acceleration(forget):
    predictor = Predictor(0.1)
    predictor.predict(100.0, (0, 0, 0, 0, 0, 0, 1.0), (0,) * 6)
    if forget == "restart":
        predictor.restart()
    time = {"restart": 100.01, "pause": 200.0, "set back": 1.0}[forget]
    assert predictor.predict(time, (5.0, 0, 0, 0, 0, 0, 1.0), (1.0, 0, 0, 0, 0, 0))[1][0] == pytest.approx(5.1)


@pytest.mark.parametrize("delay", [-0.1, math.nan, math.inf])
def test_a_delay_that_is_none_is_refused(delay):
    with pytest.raises(ValueError, match="delay"):
        Predictor(delay)


@pytest.mark.parametrize("delay", late_spring.DELAYS)
def test_a_late_spring_takes_half_omega_tau_of_the_damping_and_prediction_gives_nearly_all_of_it_back(delay):
    lost = late_spring.lost(2.0, delay, predicted=False)
    assert lost == pytest.approx(0.5 * 2.0 * delay, rel=0.03)
    assert abs(late_spring.lost(2.0, delay, predicted=True)) < 0.05 * lost
