"""The filter that makes motion of noisy poses, beside what theory says of it."""
import math

import numpy as np
import pytest

from benchmarks import camera_frames as recorded
from mooring_ros.motion import OnlineTwist
from mooring_ros.motion.tracking import PoseFilter

LEVEL = (0.0, 0.0, 0.0, 1.0)


def follow(tracker, times, positions):
    """Estimates for a motion in surge."""
    found = []
    for t, x in zip(times, positions):
        found.append(tracker.propose(float(t), (float(x), 0.0, 0.0, *LEVEL)))
        tracker.take(found[-1])
    return found


def test_the_gains_settle_at_those_of_the_butterworth_observer():
    period, bandwidth = 0.001, 2.0
    times = np.arange(4000) * period
    found = follow(PoseFilter(period, bandwidth), times, np.where(times < 3.9995 - period, 0.0, 1.0))
    omega = 2.0 * math.pi * bandwidth
    step = found[-1]
    gains = [2.0 * omega * period, 2.0 * omega ** 2 * period, omega ** 3 * period]
    assert [step.pose[0], step.twist[0], step.acceleration[0]] == pytest.approx(gains, rel=0.03)


@pytest.mark.parametrize("share", [0.05, 0.1, 0.2])
def test_velocity_is_too_large_by_twice_the_square_of_the_frequency_over_the_bandwidth_and_hardly_late(share):
    period, bandwidth = 0.004, 10.0
    omega = 2.0 * math.pi * share * bandwidth
    times = np.arange(3000) * period
    velocity = np.array([e.twist[0] for e in follow(PoseFilter(period, bandwidth), times, np.sin(omega * times))])[1500:]
    response = 2.0 * np.mean(velocity * np.exp(-1j * omega * times[1500:])) / omega
    expected = (1.0 + 2.0j * share) / (1.0 + 2.0j * share - 2.0 * share ** 2 - 1.0j * share ** 3)
    assert response == pytest.approx(expected, abs=0.02)
    assert abs(response) == pytest.approx(1.0 + 2.0 * share ** 2, abs=0.03)


def test_noise_of_the_velocity_is_a_tenth_of_what_differences_make_of_it():
    random = np.random.default_rng(7)
    times, noise = np.arange(3000) / 250.0, recorded.NOISE * random.standard_normal(3000)
    spread = {name: np.std([e.twist[0] for e in follow(tracker, times, noise)][500:])
              for name, tracker in (("filter", PoseFilter(0.004, 12.0)), ("differences", OnlineTwist()))}
    omega = 2.0 * math.pi * 12.0
    assert spread["filter"] == pytest.approx(recorded.NOISE * math.sqrt(1.5 * omega ** 3 * 0.004), rel=0.15)
    assert spread["filter"] < 0.1 * spread["differences"]


def test_turning_is_filtered_like_moving_whatever_the_attitude():
    made = recorded.frames()
    tracker, off = PoseFilter(1.0 / recorded.RATE, 12.0), []
    for frame in made:
        estimate = tracker.propose(frame.time, frame.sample.pose)
        tracker.take(estimate)
        off.append(np.subtract(estimate.twist[3:], frame.twist[3:]))
    assert np.sqrt(np.mean(np.square(off[100:]))) < 0.05       # rad/s of 0.57


def test_a_frame_that_is_missing_leaves_no_trace_in_a_steady_motion():
    times = np.arange(200) * 0.01
    kept = np.delete(np.arange(200), [120, 121, 150])
    for t, estimate in zip(times[kept], follow(PoseFilter(0.01, 5.0), times[kept], 0.3 + 2.0 * times[kept])):
        if t > 0.5:
            assert (estimate.pose[0], estimate.twist[0]) == pytest.approx((0.3 + 2.0 * t, 2.0), abs=1e-6)


def test_what_is_only_proposed_leaves_no_trace():
    one, other = PoseFilter(0.01, 5.0), PoseFilter(0.01, 5.0)
    for tracker in (one, other):
        follow(tracker, [0.0, 0.01, 0.02], [0.0, 0.1, 0.2])
    one.propose(0.03, (9.0, 9.0, 9.0, *LEVEL))
    assert follow(one, [0.04], [0.4]) == follow(other, [0.04], [0.4])


@pytest.mark.parametrize("period, bandwidth", [(0.0, 1.0), (0.01, 0.0), (0.01, 60.0), (math.nan, 1.0), (0.01, math.inf)])
def test_a_filter_that_cannot_be_is_refused(period, bandwidth):
    with pytest.raises(ValueError, match="below half the rate"):
        PoseFilter(period, bandwidth)
