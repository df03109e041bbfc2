import numpy as np
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from std_msgs.msg import Float64MultiArray

from mooring_ros.recording import schedule


def through_cdr(record):
    return deserialize_message(serialize_message(Float64MultiArray(data=record)), Float64MultiArray).data


def test_a_step_comes_back_with_every_bit():
    random = np.random.default_rng(1)
    pose, twist = random.standard_normal(7), random.standard_normal(6) * 1e-300
    twist[0] = -0.0
    action = schedule.decode(through_cdr(schedule.encode_step(0.1 + 0.2, pose, twist)))
    assert action.kind == schedule.STEP and action.time == 0.1 + 0.2
    assert action.pose.tobytes() == pose.tobytes() and action.twist.tobytes() == twist.tobytes()


def test_settle_and_release_come_back():
    pose = np.array([1.0, 2, 3, 0, 0, 0, 1])
    settle = schedule.decode(through_cdr(schedule.encode_settle(4.5, pose)))
    assert (settle.kind, settle.time) == (schedule.SETTLE, 4.5) and np.array_equal(settle.pose, pose)
    release = schedule.decode(through_cdr(schedule.encode_release(7.25, 2)))
    assert (release.kind, release.time, release.line, release.pose) == (schedule.RELEASE, 7.25, 2, None)


def test_a_change_of_unstretched_length_comes_back_with_every_bit():
    wind = schedule.decode(through_cdr(schedule.encode_wind(7.25, 2, 0.1 + 0.2)))
    assert (wind.kind, wind.time, wind.line, wind.length, wind.pose) == (schedule.WIND, 7.25, 2, 0.1 + 0.2, None)


@pytest.mark.parametrize('data, message', [
    ([0.0] * 14, '14 numbers'), ([4.0] + [0.0] * 14, 'kind 4'), ([float('nan')] * 15, 'not finite'),
    ([2.0, 0.0, 1.5] + [0.0] * 12, 'line 1.5'), ([2.0, 0.0, 1.0] + [0.5] * 12, 'zeros'),
    ([3.0, 0.0, 1.0] + [0.0] * 12, 'a length and zeros'), ([3.0, 0.0, 1.0, 5.0, 1.0] + [0.0] * 10, 'a length and zeros')])
def test_what_is_no_schedule_record_is_refused(data, message):
    with pytest.raises(ValueError, match=message):
        schedule.decode(data)


def test_wrong_shapes_are_refused():
    with pytest.raises(ValueError, match=r'\(7,\)'):
        schedule.encode_step(0.0, np.zeros(6), np.zeros(6))
