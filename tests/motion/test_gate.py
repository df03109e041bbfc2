"""What the gate lets through, what it refuses, and what it says about it."""
import math

import pytest

from mooring_ros.motion import Adapter, Gate, Limits, Sample, gate as gate_module

STILL = (0.0,) * 6
UPRIGHT = (0.0, 0.0, 0.0, 1.0)


def sample(t, x=0.0, twist=STILL, q=UPRIGHT, **names):
    return Sample(stamp=round(t * 1e9), pose=(x, 0.0, 0.0, *q), twist=twist, **names)


def moving(t, speed=1.0):
    return sample(t, speed * t, (speed, 0.0, 0.0, 0.0, 0.0, 0.0))


def gate(**keywords):
    return Gate(Adapter(), **keywords)


def refused(the_gate, bad, reason, now=None):
    last, before = the_gate.last, the_gate.rejected[reason]
    assert the_gate.admit(bad, now) is None
    assert the_gate.rejected[reason] == before + 1
    assert the_gate.cause.startswith(reason)
    assert the_gate.last is last


def test_smooth_motion_passes_and_is_counted():
    g = gate()
    for k in range(100):
        assert g.admit(moving(0.01 * k)).stamp == round(k * 1e7)
    assert (g.received, g.accepted, sum(g.rejected.values())) == (100, 100, 0)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("place", range(13))
def test_any_number_that_is_not_finite_is_refused(bad, place):
    numbers = [0.0, 0.0, 0.0, *UPRIGHT, *STILL]
    numbers[place] = bad
    refused(gate(), Sample(0, tuple(numbers[:7]), tuple(numbers[7:])), "non_finite")


def test_a_twist_that_overflows_on_conversion_is_refused():
    refused(gate(), sample(0.0, twist=(1e308, 1e308, 0.0, 0.0, 0.0, 0.0), q=(0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))), "non_finite")


@pytest.mark.parametrize("q", [(0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.01), (1.0, 0.0, 0.0, 1.0), (1e200, 0.0, 0.0, 1e200)])
def test_a_quaternion_that_is_not_unit_is_refused(q):
    refused(gate(), sample(0.0, q=q), "quaternion")


def test_a_slightly_long_quaternion_is_normalised():
    motion = gate().admit(sample(0.0, q=(0.0, 0.0, 0.0, 1.0005)))
    assert motion.pose[3:] == UPRIGHT


def test_repeated_and_reordered_stamps_are_refused():
    g = gate()
    g.admit(moving(1.0))
    refused(g, moving(1.0), "repeated")
    refused(g, moving(0.9), "reordered")
    assert g.admit(moving(1.1))


def test_old_and_future_samples_are_refused_by_the_receiving_clock():
    g = gate(limits=Limits(input_age=0.5))
    refused(g, sample(10.0), "stale", now=round(10.6e9))
    refused(g, sample(10.0), "ahead", now=round(9.4e9))
    assert g.admit(sample(10.0), now=round(10.4e9))


def test_age_is_not_limited_unless_asked_for():
    assert gate().admit(sample(10.0), now=round(1e18))


@pytest.mark.parametrize("bad", [
    sample(1.01, 1.5, (1.0, 0, 0, 0, 0, 0)),                     # 0.49 m in 10 ms
    sample(1.01, 1e300, (1.0, 0, 0, 0, 0, 0)),
    sample(1.01, 1.01, (50.0, 0, 0, 0, 0, 0)),                   # spike in the velocity alone
    sample(1.01, 1.01, (1.0, 0, 0, 0, 9.0, 0)),                  # and in the angular velocity
    sample(1.01, 1.01, (1.0, 0, 0, 0, 0, 0), (0.0, 0.0, math.sin(0.1), math.cos(0.1))),
    sample(30.0, 80.0, (1.0, 0, 0, 0, 0, 0)),                    # long after, but too far for the limit in metres
    moving(1e9),                                                 # a clock that changes its epoch
])
def test_jumps_are_refused(bad):
    g = gate()
    g.admit(moving(1.0))
    refused(g, bad, "jump")
    assert g.admit(moving(1.02))


def test_limits_of_zero_switch_the_jump_check_off():
    g = gate(limits=Limits(jump=0.0, jump_angle=0.0, jump_speed=0.0, jump_rate=0.0, gap=0.0))
    g.admit(moving(1.0))
    assert g.admit(sample(1e9, 1e6))


def test_a_gap_in_a_smooth_motion_is_no_jump():
    g = gate()
    wave = [(t, 4.0 * math.sin(0.433 * t), 4.0 * 0.433 * math.cos(0.433 * t)) for t in (0.0, 0.01, 3.0, 3.01)]
    assert all(g.admit(sample(t, x, (v, 0, 0, 0, 0, 0))) for t, x, v in wave)


def test_a_quaternion_may_change_its_sign():
    g = gate()
    g.admit(sample(0.0))
    assert g.admit(sample(0.01, q=(0.0, 0.0, 0.0, -1.0)))


def test_a_new_place_is_taken_only_when_asked_and_only_when_samples_agree():
    g = gate()
    g.admit(sample(0.0))
    for k in range(gate_module.RELOCATED_AFTER):
        assert not g.relocated and g.relocate() is None
        refused(g, sample(0.01 * (k + 1), 200.0), "jump")
    assert g.relocated
    assert g.relocate().pose[0] == 200.0
    assert g.admit(sample(0.2, 200.0)) and not g.relocated


def test_samples_that_do_not_agree_are_no_new_place():
    g = gate()
    g.admit(sample(0.0))
    for k in range(40):
        refused(g, sample(0.01 * (k + 1), 200.0 + 50.0 * (k % 2)), "jump")
    assert not g.relocated


def test_a_source_that_restarts_its_clock_can_be_taken_up_again():
    g = gate()
    g.admit(moving(100.0))
    for k in range(gate_module.RELOCATED_AFTER):
        refused(g, moving(0.01 * k), "reordered")
    assert g.relocate().stamp == round((gate_module.RELOCATED_AFTER - 1) * 1e7)
    assert g.admit(moving(0.01 * gate_module.RELOCATED_AFTER))


def test_frames_that_differ_from_the_given_ones_are_refused():
    g = gate(world_frame="map", platform_frame="base_link")
    refused(g, sample(0.0, frame="odom", child_frame="base_link"), "frame")
    refused(g, sample(0.0, frame="map", child_frame="ship"), "frame")
    assert g.admit(sample(0.0, frame="map", child_frame=""))


def test_frames_not_given_are_those_of_the_first_sample():
    g = gate()
    g.admit(sample(0.0, frame="odom", child_frame="hull"))
    assert (g.frame, g.child_frame) == ("odom", "hull")
    refused(g, sample(0.1, frame="map", child_frame="hull"), "frame")


def test_poses_alone_give_their_twist():
    g = gate()
    motions = [g.admit(sample(0.01 * k, 3.0 * (0.01 * k) ** 2, twist=None)) for k in range(5)]
    assert motions[0].twist == STILL
    assert motions[4].twist[0] == pytest.approx(6.0 * 0.04)
    refused(g, sample(0.05, 9.0, twist=None), "jump")


def test_limits_hold_at_full_scale_for_a_model():
    g = Gate(Adapter(scale=50.0))
    g.admit(sample(0.0))
    assert g.admit(sample(5.0, 0.1))
    refused(g, sample(10.0, 0.4), "jump")
