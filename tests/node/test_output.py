"""Ramps and limits on what goes out."""
import numpy as np
import pytest

from mooring_ros.node.output import FORCE, FORCE_RATE, STATIC, Output

SAFE = np.array([[100.0, 0, 0, 0, 10.0, 0], [100.0, 0, 0, 0, 0, 0]])


def started(**limits):
    output = Output(**limits)
    output.start(0.0, SAFE)
    return output


def test_without_limits_wrenches_pass_bit_for_bit():
    wrenches = np.random.default_rng(0).normal(size=(3, 6))
    np.testing.assert_array_equal(started().apply(0.0, wrenches), wrenches)


def test_ramp_goes_from_nothing_to_the_computed_wrench_without_a_kink():
    output = started(ramp_time=2.0)
    shares = [output.apply(t, SAFE)[0, 0] / 100.0 for t in (0.0, 0.1, 1.0, 1.9, 2.0, 3.0)]
    assert shares[0] == 0.0 and shares[1] < 0.01
    assert shares[2] == pytest.approx(0.5)
    assert shares[3] > 0.99 and shares[4:] == [1.0, 1.0]


def test_a_large_force_is_scaled_down_with_its_moment_and_counted():
    output = started(force=50.0)
    out = output.apply(0.0, SAFE)
    np.testing.assert_allclose(out, 0.5 * SAFE)
    assert output.limited == {FORCE: 1}
    output.apply(1.0, 0.4 * SAFE)
    assert output.limited == {FORCE: 1}


def test_a_fast_change_is_followed_at_the_given_rate():
    output = started(force_rate=20.0, ramp_from=STATIC)
    output.apply(0.0, SAFE)
    np.testing.assert_allclose(output.apply(1.0, 2.0 * SAFE), 1.2 * SAFE)
    np.testing.assert_allclose(output.apply(2.0, 1.3 * SAFE), 1.3 * SAFE)
    assert output.limited == {FORCE_RATE: 1}


def test_the_first_answer_goes_to_an_actuator_that_applies_nothing_and_keeps_to_the_rate_too():
    output = started(force_rate=20.0)
    np.testing.assert_allclose([output.apply(t, SAFE)[0, 0] for t in (0.0, 1.0, 3.0, 6.0)], [0.0, 20.0, 60.0, 100.0])
    assert output.limited == {FORCE_RATE: 3}


def test_a_turn_ramps_over_the_hold_time_from_what_goes_out_and_back():
    output = started(hold_time=2.0)
    output.apply(0.0, 3.0 * SAFE)
    output.turn(0.0)
    np.testing.assert_allclose(output.apply(1.0, SAFE), 2.0 * SAFE)
    assert output.ramping(1.9) and not output.ramping(2.0)
    np.testing.assert_allclose(output.apply(2.0, SAFE), SAFE)
    output.turn(3.0)
    np.testing.assert_allclose(output.apply(4.0, 9.0 * SAFE), 5.0 * SAFE)
    np.testing.assert_allclose(output.apply(5.0, 9.0 * SAFE), 9.0 * SAFE)


def test_settling_again_ramps_from_what_went_out_before():
    output = started(ramp_time=2.0)
    output.apply(5.0, 4.0 * SAFE)
    output.start(6.0, 2.0 * SAFE)
    np.testing.assert_allclose(output.apply(7.0, 2.0 * SAFE), 3.0 * SAFE)


def test_the_first_ramp_can_begin_from_the_static_wrench():
    output = started(ramp_time=2.0, ramp_from=STATIC)
    np.testing.assert_allclose(output.apply(0.0, 3.0 * SAFE), SAFE)
    np.testing.assert_allclose(output.apply(1.0, 3.0 * SAFE), 2.0 * SAFE)


def test_after_a_hold_the_ramp_takes_the_hold_time_where_a_start_takes_none():
    output = started(hold_time=2.0)
    output.apply(0.0, 3.0 * SAFE)
    output.start(1.0, SAFE, held=True)
    np.testing.assert_allclose(output.apply(2.0, SAFE), 2.0 * SAFE)


def test_a_clock_that_is_set_back_does_not_freeze_a_limited_rate():
    output = started(force_rate=20.0, ramp_from=STATIC)
    output.apply(1000.0, SAFE)
    output.start(0.0, SAFE)
    np.testing.assert_allclose(output.apply(1.0, 2.0 * SAFE), 1.2 * SAFE)
