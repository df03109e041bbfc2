"""Loop, histograms and what diagnostics make of them, by clocks that are only numbers; and what the system grants."""
import os
import subprocess
import sys

import numpy as np
import pytest

from mooring_ros.node.histogram import BINS, Histogram, edge
from mooring_ros.node.loop import LEAD, POLL, Loop
from mooring_ros.node.punctuality import DEFAULTS, ERROR, OK, RATE_ERROR, STEP_MEAN, WARN, Punctuality
from mooring_ros.node.timing import FixedRate

MS = 1_000_000


class World:
    """A clock, an executor and a node in one: events and sleeps take their time."""

    def __init__(self, rate, events=()):
        self.now, self.rate, self.cycles, self.waits = 0, rate, [], []
        self._events = list(events)     # ns that the next messages take

    def spin_once(self, timeout_sec):
        self.waits.append(timeout_sec)
        self.now += self._events.pop(0) if self._events else round(timeout_sec * 1e9)

    def sleep(self, seconds):
        self.now += round(seconds * 1e9) + 50_000

    def deadline(self):
        return self.rate and self.rate.next(self.now)

    def cycle(self):
        if self.rate.due(self.now):
            self.cycles.append(self.now)

    def turn(self, turns):
        loop = Loop(self, self, lambda: self.now, self.sleep)
        for _ in range(turns):
            loop.turn()


def test_without_deadlines_the_loop_only_waits_for_messages():
    world = World(None)
    world.turn(3)
    assert world.waits == [POLL] * 3


def test_cycles_come_at_their_deadlines_late_by_no_more_than_the_sleep():
    world = World(FixedRate(100.0))
    world.turn(41)
    assert world.cycles == [0] + [10 * MS * k + 50_000 for k in range(1, 21)] and world.rate.missed == 0


def test_messages_are_taken_up_between_deadlines_but_not_shortly_before_one():
    world = World(FixedRate(100.0), events=[2 * MS, 3 * MS, 5 * MS - LEAD])
    world.turn(5)
    assert world.waits == pytest.approx([(10 * MS - LEAD) * 1e-9, (8 * MS - LEAD) * 1e-9, (5 * MS - LEAD) * 1e-9])
    assert world.cycles == [0, 10 * MS + 50_000]


def test_a_message_that_takes_too_long_costs_cycles_which_are_counted_and_not_made_up_for():
    world = World(FixedRate(100.0), events=[34 * MS])
    world.turn(5)
    assert world.cycles == [0, 34 * MS, 40 * MS + 50_000] and world.rate.missed == 2


def test_a_histogram_holds_every_time_between_its_edges():
    histogram = Histogram()
    times = [0, 1000, 1001, 1122, 1123, 999_999, 1_000_000, 1_000_001, 10 * 10**9, 10**11]
    for time in times:
        histogram.add(time)
    bins = [k for k, count in enumerate(histogram.counts) for _ in range(count)]
    assert len(histogram.counts) == BINS and bins == [0, 0, 1, 1, 2, 60, 60, 61, 140, 141] and histogram.most == 10**11
    assert all((k == 0 or edge(k - 1) * (1 - 1e-9) < time) and (k == BINS - 1 or time <= edge(k) * (1 + 1e-9)) for k, time in zip(bins, times))


def test_its_quantiles_are_right_within_a_bin():
    histogram, rng = Histogram(), np.random.default_rng(3)
    times = rng.lognormal(np.log(2e5), 0.7, 5000)
    for time in times:
        histogram.add(int(time))
    for share in (0.5, 0.99, 0.999):
        assert np.quantile(times, share) <= histogram.quantile(share) * 1.001 <= np.quantile(times, share) * 1.13
    assert histogram.quantile(1.0) == histogram.most and Histogram().quantile(0.5) == 0


def run(rate, intervals_ms, took_us, **keywords):
    punctuality, now = Punctuality(rate, **keywords), 0
    for interval, took in zip(intervals_ms, took_us):
        now += round(interval * MS)
        punctuality.begin(now, 0)
        punctuality.answered(round(took * 1000))
    return punctuality.report()


@pytest.mark.parametrize("interval, took, level, words", [
    (10.0, (500, 600), OK, ""),
    (10.7, (500, 600), WARN, "periodicity.mean_error is 6.542 Hz, limit 5"),
    (11.6, (500, 600), ERROR, "periodicity.mean_error is 13.79 Hz, limit 10"),
    (10.0, (1200, 1200), WARN, "execution_time.mean is 1200 us, limit 1000"),
    (10.0, (2500, 2500), ERROR, "execution_time.mean is 2500 us, limit 2000"),
    (10.0, (300, 600), WARN, "execution_time.standard_deviation is 150 us, limit 100"),
    (10.0, (100, 700), ERROR, "execution_time.standard_deviation is 300 us, limit 200"),
])
def test_thresholds_are_those_of_ros2_control(interval, took, level, words):
    found = run(100.0, [interval] * 200, took * 100)
    assert found[:2] == (level, words)


def test_uneven_cycles_are_found_where_the_mean_rate_is_right():
    level, words, _ = run(100.0, [9.0, 11.0] * 100, [500] * 200)
    assert level == ERROR and words.startswith("periodicity.standard_deviation is 10.1 Hz")


def test_a_lockstep_of_no_promised_rate_may_be_as_slow_as_it_likes():
    level, words, values = run(0.0, [900.0] * 50, [5e4] * 50)
    assert (level, words) == (OK, "") and values["input to wrench p50 (ms)"] == "50.000"


def test_deadlines_that_were_skipped_are_as_late_as_they_are_old():
    punctuality = Punctuality(100.0)
    punctuality.begin(0, 0)
    punctuality.begin(57 * MS, 7 * MS, skipped=4)
    assert sum(punctuality.lateness.counts) == 6 and punctuality.lateness.most == 47 * MS


def test_a_threshold_of_zero_is_never_reached():
    off = {**DEFAULTS, RATE_ERROR: (0.0, 0.0), STEP_MEAN: (0.0, 0.0)}
    assert run(100.0, [20.0] * 100, [5000] * 100, thresholds=off)[0] == OK


GRANT = """
import os, threading
from mooring_ros.node import realtime
stop = threading.Event()
threading.Thread(target=stop.wait).start()
granted = realtime.ask({priority}, {lock})
threading.Thread(target=stop.wait).start()      # the middleware starts some later, too
now = sorted((os.sched_getscheduler(int(t)), os.sched_getparam(int(t)).sched_priority) for t in os.listdir("/proc/self/task"))
locked = [int(l.split()[1]) for l in open("/proc/self/status") if l.startswith("VmLck")][0]
realtime.give_back()
after = {{os.sched_getscheduler(int(t)) for t in os.listdir("/proc/self/task")}}
stop.set()
print((granted, now, locked > 0, after))
"""


def granted(priority, lock, before=""):
    done = subprocess.run(["bash", "-c", f'{before} "$0" -c "$1"', sys.executable, GRANT.format(priority=priority, lock=lock)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return eval(done.stdout, {"Granted": lambda **fields: fields})


def test_what_was_asked_for_is_granted_in_full_or_said_and_given_back():
    found, threads, locked, after = granted(40, True)
    assert (found["scheduling"] == "SCHED_FIFO 40") == (not any("SCHED_FIFO" in problem for problem in found["problems"]))
    assert (found["memory"] != "not locked") == (not any("memory" in problem for problem in found["problems"])) == locked
    if found["scheduling"] != "normal":
        assert threads[-1] == (os.SCHED_FIFO, 40) and {*threads} == {(os.SCHED_FIFO, 39), (os.SCHED_FIFO, 40)}
    assert after == {os.SCHED_OTHER}


@pytest.mark.skipif(os.geteuid() != 0, reason="capabilities can be dropped by root only")
def test_what_is_not_granted_is_a_problem_in_words_and_nothing_is_changed():
    found, threads, locked, _ = granted(40, True, before="ulimit -r 0; ulimit -l 64; setpriv --bounding-set=-sys_nice,-ipc_lock --inh-caps=-all")
    assert found["scheduling"] == "normal" and found["memory"] == "not locked" and not locked
    assert [words.split(" was")[0] for words in found["problems"]] == ["SCHED_FIFO 40", "memory"]
    assert {policy for policy, _ in threads} == {os.SCHED_OTHER}


def test_nothing_is_asked_for_by_default():
    found, threads, locked, _ = granted(0, False)
    assert found == {"scheduling": "normal", "memory": "not locked", "problems": ()} and not locked
