"""Resets, told from reordered samples; lost steps, told by stamps; without ROS."""
import numpy as np
import pytest
from node_peer import SCENE, UPRIGHT

from mooring_ros.mooring import Mooring
from mooring_ros.motion import Adapter, Gate, Sample
from mooring_ros.node.output import Output
from mooring_ros.node.resets import REFUSE, SETTLE, Resets
from mooring_ros.node.session import Session
from mooring_ros.node.states import RUN, SAFE
from mooring_ros.node.steps_in import StepsIn

MS = 1_000_000


def sample(ms, x=0.0):
    return Sample(ms * MS, (x, 0.0, 0.0, *UPRIGHT), (0.0,) * 6)


def session(policy):
    return Session(Mooring(SCENE), Gate(Adapter(), resets=Resets(policy)), Output())


def begun(policy, begin=5000, steps=4):
    made = session(policy)
    for k in range(steps):
        assert made.take(sample(begin + 10 * k), None) is not None
    return made


def test_time_back_to_before_the_start_settles_anew_at_the_first_sample():
    made = begun(SETTLE)
    assert made.take(sample(0, 30.0), None) == 0
    assert made.state == RUN and made.settles == 2 and made.mooring.time == 0.0
    fresh = Mooring(SCENE)
    fresh.settle(np.array([30.0, 0.0, 0.0, *UPRIGHT]))
    np.testing.assert_array_equal(made.wrenches[0], fresh.wrench)
    assert made.take(sample(10, 30.0), None) == 10 * MS
    assert made.gate.rejected.total() == 0 and made.gate.resets.count == 1 and made.steps_in.lost == 0


def test_a_reordered_sample_is_no_reset():
    made = begun(SETTLE)
    assert made.take(sample(5005), None) is None
    assert made.settles == 1 and made.gate.rejected["reordered"] == 1


def test_the_same_sample_is_one_once_the_clock_has_gone_back():
    made = begun(SETTLE)
    made.gate.resets.clock_went_back()
    assert made.take(sample(5005), None) == 5005 * MS and made.settles == 2


def test_a_bad_sample_does_not_begin_anything():
    made = begun(SETTLE)
    assert made.take(sample(0, np.nan), None) is None
    assert made.take(sample(5040), None) == 5040 * MS and made.settles == 1


def test_refused_the_way_out_is_one_settle_after_one_sample():
    made = begun(REFUSE)
    for k in range(3):
        assert made.take(sample(10 * k), None) is None
    assert made.gate.rejected["reordered"] == 3 and made.gate.resets.count == 1 and made.gate.relocated
    done, words = made.settle()
    assert done and "new place" in words
    assert made.take(sample(30), None) == 30 * MS


def test_a_reset_leads_out_of_no_fault():
    made = begun(SETTLE)
    made._fail("for the test")
    assert made.take(sample(0), None) is None and made.state == SAFE


def counted(stamps, nominal=0.0):
    steps = StepsIn(nominal)
    for stamp in stamps:
        steps.add(stamp * MS)
    return steps


def test_lost_steps_are_counted_against_the_step_that_was_learned():
    stamps = [k * 10 for k in range(60) if k not in (30, 40, 41, 42)]
    steps = counted(stamps)
    assert steps.nominal == 10 * MS and (steps.lost, steps.gaps) == (4, 2)


def test_a_nominal_step_that_is_given_counts_from_the_first():
    steps = counted([0, 30, 40], 0.01)
    assert (steps.lost, steps.gaps) == (2, 1)


def test_jitter_below_half_a_step_loses_nothing():
    rng = np.random.default_rng(1)
    assert counted((10 * k + int(rng.integers(0, 5)) for k in range(500))).lost == 0


def test_a_source_that_changes_its_step_for_good_is_followed():
    times = [10 * k for k in range(100)] + [1000 + 20 * k for k in range(300)]
    steps = counted(times)
    assert steps.nominal == 20 * MS and steps.lost < 60


@pytest.mark.parametrize("restarted", [True, False])
def test_nothing_is_lost_over_a_reset(restarted):
    steps = counted([10 * k for k in range(50)])
    if restarted:
        steps.restart()
        steps.add(5000 * MS)
    else:
        steps.add(0)
    assert steps.lost == 0


def test_a_clock_that_leaps_has_not_been_silent_and_the_sources_clock_is_learned_anew():
    """The first sample comes before the first message on /clock, which begins at an hour."""
    clock = [0]
    made = Session(Mooring(SCENE), Gate(Adapter(), resets=Resets()), Output(), clock=lambda: clock[0])
    hour = 3_600_000
    assert made.observe(sample(hour), None) == hour * MS
    clock[0] = hour * MS
    made.forget_clock()
    for k in range(1, 30):
        clock[0] = (hour + 10 * k) * MS
        made.observe(sample(hour + 10 * k, 0.001 * k), None)
        made.tick()
        made.tick()
    assert made.state == RUN and made.steps == 29
