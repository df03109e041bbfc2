"""The timing policies against a clock that is only numbers."""
import pytest

from mooring_ros.node.timing import FixedRate, SourceClock

MS = 1_000_000


def test_ticks_come_once_each_period_whatever_the_jitter_of_a_timer_that_may_be_early():
    rate = FixedRate(100.0, early=0.5)
    times = [0, 12, 19, 31, 40, 54]
    assert [rate.due(t * MS) for t in times] == [True] * 6
    assert rate.missed == 0 and rate.ticks == 6


def test_without_that_a_deadline_is_met_when_it_has_come_and_its_lateness_is_known():
    rate = FixedRate(100.0)
    assert rate.next(7 * MS) == 7 * MS
    assert [(rate.due(t * MS), rate.late) for t in (7, 16, 17, 29, 36)] == [(True, 0), (False, 0), (True, 0), (True, 2 * MS), (False, 2 * MS)]
    assert rate.next(36 * MS) == 37 * MS


def test_a_second_call_for_the_same_deadline_does_nothing():
    rate = FixedRate(100.0)
    assert [rate.due(t * MS) for t in (0, 1, 10, 13)] == [True, False, True, False]


def test_missed_deadlines_are_skipped_and_counted_and_the_later_ones_stay_where_they_are():
    rate = FixedRate(100.0)
    rate.due(0)
    assert rate.due(57 * MS)
    assert (rate.missed, rate.skipped, rate.ticks, rate.late, rate.next(57 * MS)) == (4, 4, 2, 7 * MS, 60 * MS)
    assert not rate.due(58 * MS) and rate.due(60 * MS)
    assert (rate.missed, rate.skipped) == (4, 0)


def test_late_ticks_do_not_add_up():
    rate = FixedRate(1000.0, early=0.5)
    taken = sum(rate.due(round(k * 1.0003 * MS)) for k in range(10_000))
    assert taken == 10_000 and rate.missed == 3


def test_the_fastest_sample_sets_the_clock():
    clock = SourceClock(drift=0.0)
    assert clock.now(5) is None
    for stamp, delay in ((1000, 30), (2000, 10), (3000, 50)):
        clock.hear(stamp, stamp + 5_000_000 + delay)
    assert clock.now(5_003_510) == 3500


def test_shown_time_never_runs_backwards():
    clock = SourceClock(drift=0.1)
    clock.hear(0, 1000)
    assert clock.now(2000) == 1000
    clock.hear(0, 3000)
    assert clock.now(2001) == 1000


@pytest.mark.parametrize("slow", [1 - 1e-4, 1 + 1e-4])
def test_a_clock_that_runs_at_another_speed_is_followed(slow):
    clock = SourceClock()
    for k in range(2000):
        now = k * 10 * MS
        clock.hear(round(now * slow), now)
        assert abs(clock.now(now) - round(now * slow)) <= 1
