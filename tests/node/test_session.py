"""A session without ROS, on a real mooring and clocks that are only numbers."""
import numpy as np
import pytest
from node_peer import SCENE, UPRIGHT

from mooring_ros.mooring import Mooring
from mooring_ros.motion import Adapter, Gate, Sample
from mooring_ros.motion.gate import RELOCATED_AFTER
from mooring_ros.node.output import Output
from mooring_ros.node.session import AGE_HOLD, FAILED, HORIZON, RUNNING, WAITING, Session
from mooring_ros.node.timing import WALL_CLOCK
from mooring_ros.recording import schedule

MS = 1_000_000


def sample(stamp, x=0.0, v=0.0):
    return Sample(stamp, (x, 0.0, 0.0, *UPRIGHT), (v, 0.0, 0.0, 0.0, 0.0, 0.0))


@pytest.fixture
def session():
    return Session(Mooring(SCENE), Gate(Adapter()), Output())


def test_the_schedule_done_again_gives_the_same_bits(session):
    wrenches = []
    for k in range(20):
        assert session.take(sample(k * 50 * MS, 0.01 * k * k, 0.4 * k), None) == k * 50 * MS
        wrenches.append(session.wrenches[0].copy())
    assert session.release("line2") == (True, "line2 released at its fairlead")
    session.take(sample(1000 * MS, 4.0, 8.0), None)
    wrenches.append(session.wrenches[0].copy())
    again, answers = Mooring(SCENE), []
    for stamp, record in session.actions():
        action = schedule.decode(record)
        if action.kind == schedule.RELEASE:
            again.release(again.line_names[action.line])
            continue
        if action.kind == schedule.SETTLE:
            again.settle(action.pose, action.time)
        else:
            again.step(action.time, action.pose, action.twist)
        answers.append(again.wrench)
    np.testing.assert_array_equal(answers, wrenches)
    assert session.actions() == []


def test_lengths_are_wound_at_the_sources_scale_recorded_and_all_or_none():
    session = Session(Mooring(SCENE), Gate(Adapter(scale=50.0)), Output())
    assert session.wind({"line1": 16.0}) == (False, "cannot wind line1: waiting for input")
    session.take(sample(0), None)
    before = session.mooring.unstretched_length
    for lengths, words in (({"line1": 16.0, "line9": 16.0}, "no line 'line9'"), ({"line2": 16.0, "line1": -1.0}, "line1 is -1 m"), ({"line1": np.nan}, "nan")):
        done, said = session.wind(lengths)
        assert not done and words in said
    np.testing.assert_array_equal(session.mooring.unstretched_length, before)
    assert session.wind({"line1": 16.6, "line3": 16.8})[0]
    np.testing.assert_allclose(session.mooring.unstretched_length, [830.0, before[1], 840.0])
    winds = [schedule.decode(record) for _, record in session.actions()][1:]
    wound = session.mooring.unstretched_length
    assert [(wind.kind, wind.line, wind.length) for wind in winds] == [(schedule.WIND, 0, wound[0]), (schedule.WIND, 2, wound[2])]


def test_ticks_carry_the_motion_on_and_stop_past_the_horizon(session):
    assert session.tick(0) is None
    assert session.observe(sample(0, 0.0, 2.0), None, 1000 * MS) == 0
    assert session.observe(sample(100 * MS, 0.2, 2.0), None, 1100 * MS) is None
    assert session.tick(1150 * MS) == 100 * MS
    assert session.mooring.time == pytest.approx(0.15)
    assert session.mooring.pose[0] == pytest.approx(0.3)
    late = 1100 + round(1000 * HORIZON) + 1
    assert session.tick(late * MS) == 100 * MS
    assert session.output.holding == AGE_HOLD and session.mooring.time == pytest.approx(0.15)
    session.observe(sample(400 * MS, 0.8, 2.0), None, 1400 * MS)
    assert session.tick(1400 * MS) == 400 * MS
    assert not session.output.holding and session.mooring.pose[0] == pytest.approx(0.8)


def test_settling_between_ticks_does_not_turn_time_back(session):
    session.observe(sample(0, 0.0, 1.0), None, 0)
    session.tick(50 * MS)
    assert session.settle()[0]
    session.tick(60 * MS)
    times = [schedule.decode(record).time for _, record in session.actions()]
    assert times == pytest.approx([0.0, 0.05, 0.05, 0.06])


def test_a_source_that_restarts_is_taken_up_by_settle(session):
    session.take(sample(10_000 * MS), None)
    for k in range(RELOCATED_AFTER):
        assert session.take(sample(k * MS), None) is None
    assert session.settle()[0] and session.mooring.time == pytest.approx((RELOCATED_AFTER - 1) * 1e-3)
    assert session.take(sample(RELOCATED_AFTER * MS), None) == RELOCATED_AFTER * MS
    assert session.mooring.time == pytest.approx(RELOCATED_AFTER * 1e-3)


@pytest.mark.parametrize("first, time", [(12_000 * MS, 12.0), (WALL_CLOCK + 12_000 * MS, 0.0)], ids=["simulation", "wall clock"])
def test_the_cores_time_is_that_of_a_simulated_clock_and_begins_with_a_wall_clocks_first_sample(session, first, time):
    session.take(sample(first), None)
    assert session.mooring.time == pytest.approx(time)
    session.take(sample(first + 10 * MS), None)
    assert session.mooring.time == pytest.approx(time + 0.01)


def test_after_a_step_that_failed_nothing_is_answered_until_settle(session, monkeypatch):
    session.take(sample(0), None)
    session.take(sample(10 * MS), None)
    session.actions()
    monkeypatch.setattr(type(session.mooring), "wrench", property(lambda self: np.full(6, np.inf)))
    assert session.take(sample(20 * MS), None) is None
    assert session.state == FAILED and "not finite" in session.cause and session.actions() == []
    monkeypatch.undo()
    assert session.take(sample(30 * MS), None) is None and session.unanswered == 2
    assert session.settle()[0] and session.state == RUNNING
    assert session.take(sample(40 * MS), None) == 40 * MS


def test_nothing_can_be_done_before_the_first_sample(session):
    assert session.state == WAITING
    assert not session.settle()[0] and not session.hold()[0] and not session.release("line1")[0]


def test_an_unknown_or_released_line_is_refused_in_words(session):
    session.take(sample(0), None)
    assert session.release("line1")[0]
    done, words = session.release("line1")
    assert not done and "line1" in words
