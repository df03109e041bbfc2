"""The delay and what makes up for it, on clocks that are only numbers."""
import math

import pytest

from mooring_ros.node.delay import FIELDS, Delay, Frequency

MS = 1_000_000


def late_by(delay, milliseconds, count=300, step=10, begin=0):
    """Answers that go out late, one each `step` ms; the leads they had, s."""
    leads = []
    for k in range(count):
        moment = (begin + k * step) * MS
        leads.append(delay.ahead(moment) * 1e-9)
        delay.add(moment, moment + round(milliseconds * MS), 1 * MS)
    return leads


def test_mean_and_percentile_are_those_of_the_answers():
    delay = Delay()
    for k in range(1000):
        delay.add(k * 10 * MS, k * 10 * MS + (30 if k % 50 == 0 else 10) * MS, MS)
    assert delay.mean == pytest.approx(0.0104, abs=2e-4) and delay.percentile == pytest.approx(0.030)
    assert delay.by_stamps and delay.lead == 0.0


def test_stamps_of_another_clock_are_seen_and_the_delay_counted_from_the_arrival():
    delay = Delay()
    delay.add(5 * MS, 1_760_000_000 * 1000 * MS, 2 * MS)
    assert not delay.by_stamps and delay.mean == pytest.approx(0.002)


def test_off_predicts_nothing_and_given_all_of_it_from_the_first_step():
    assert set(late_by(Delay(), 20.0)) == {0.0}
    assert set(late_by(Delay("given", 0.02), 5.0)) == {0.02}


def test_measured_goes_to_the_mean_and_adds_what_cannot_be_seen():
    leads = late_by(Delay("measured", 0.004), 16.0)
    assert leads[-1] == pytest.approx(0.020)


@pytest.mark.parametrize("step", [1, 10, 100])
def test_the_prediction_changes_slowly_so_that_the_time_of_the_core_never_goes_back(step):
    delay = Delay("given", 0.05)
    moments = [k * step * 1e-3 + lead for k, lead in enumerate(late_by(delay, 1.0, 20, step))]
    delay.seconds = 0.5
    moments += [(20 + k) * step * 1e-3 + lead for k, lead in enumerate(late_by(delay, 1.0, 20, step, 20 * step))]
    delay.mode = "off"
    moments += [(40 + k) * step * 1e-3 + lead for k, lead in enumerate(late_by(delay, 1.0, 20, step, 40 * step))]
    steps = [b - a for a, b in zip(moments, moments[1:])]
    assert min(steps) >= 0.899e-3 * step and max(steps[1:]) <= 1.101e-3 * step


def test_the_report_says_what_is_lost_of_the_damping_and_what_is_left():
    delay = Delay("given", 0.015)
    late_by(delay, 20.0)
    found = dict(zip(FIELDS, delay.report(2.0)))
    assert found["mean (s)"] == pytest.approx(0.02) and found["predicted (s)"] == pytest.approx(0.015)
    assert found["damping ratio added by the delay"] == pytest.approx(-0.02)
    assert found["with the prediction"] == pytest.approx(-0.005)
    assert delay.report(None)[3:] == [0.0, 0.0, 0.0]


def swing(frequency, moments, omega, offset=3.0):
    for t in moments:
        x, v = math.sin(omega * t), omega * math.cos(omega * t)
        frequency.add(t, (offset + 0.3 * x, 1.0 + 0.1 * x, 5.0 * t, 0, 0, 0, 1.0), (0.3 * v, 0.1 * v, 5.0, 0, 0, 0))


@pytest.mark.parametrize("omega", [0.05, 0.5, 6.0])
def test_the_frequency_is_found_from_the_motion_in_three_periods(omega):
    frequency, step = Frequency(), 0.05 / omega
    swing(frequency, [k * step for k in range(20)], omega)
    assert frequency.value is None
    swing(frequency, [k * step for k in range(20, 500)], omega)
    assert frequency.value == pytest.approx(omega, rel=0.1)


def test_a_platform_at_rest_has_no_frequency():
    frequency = Frequency()
    for k in range(1000):
        frequency.add(0.1 * k, (3.0, 0, 0, 0, 0, 0, 1.0), (0.0,) * 6)
    assert frequency.value is None
