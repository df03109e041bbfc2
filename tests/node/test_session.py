"""A session without ROS, on a real mooring and clocks that are only numbers."""
import numpy as np
import pytest
from node_peer import SCENE, UPRIGHT

from mooring_ros.mooring import Mooring
from mooring_ros.motion import Adapter, Gate, Sample
from mooring_ros.motion.gate import RELOCATED_AFTER
from mooring_ros.node.output import Output
from mooring_ros.node.session import HORIZON, Session
from mooring_ros.node.states import ASKED, FAULT, FOUND, HOLD, IDLE, LOST, RAMP, RAMPED, RUN, SAFE, SETTLED
from mooring_ros.node.timing import WALL_CLOCK
from mooring_ros.recording import schedule

MS = 1_000_000


def sample(stamp, x=0.0, v=0.0):
    return Sample(stamp, (x, 0.0, 0.0, *UPRIGHT), (v, 0.0, 0.0, 0.0, 0.0, 0.0))


class Clock:
    """ns, set by hand."""

    def __init__(self):
        self.now = 0

    def __call__(self):
        return self.now

    def at(self, ms):
        self.now = round(ms * MS)


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def session(clock):
    return Session(Mooring(SCENE), Gate(Adapter()), Output(), clock=clock)


def static(x):
    mooring = Mooring(SCENE)
    mooring.settle(np.array([x, 0.0, 0.0, *UPRIGHT]))
    return mooring.wrench


def events(session):
    return [transition.event for transition in session.states.news()]


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
    assert session.wind({"line1": 16.0}) == (False, "cannot wind line1: IDLE, no input yet")
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


def test_a_slip_of_the_decimal_point_at_a_winch_is_refused_with_the_limit_that_it_broke():
    session = Session(Mooring(SCENE), Gate(Adapter()), Output())
    session.take(sample(0), None)
    session.most_wound = 0.2
    length = session.mooring.unstretched_length[0]
    done, words = session.wind({"line2": 0.9 * length, "line1": 0.1 * length})
    assert not done and "line1" in words and "20 %" in words and "limits.winch" in words
    np.testing.assert_array_equal(session.mooring.unstretched_length, length)
    assert session.wind({"line1": 0.85 * length})[0] and session.wind({"line1": 0.7 * length})[0]


def test_ticks_carry_the_motion_on_and_stop_past_the_horizon(session, clock):
    assert session.tick() is None
    clock.at(1000)
    assert session.observe(sample(0, 0.0, 2.0), None) == 0
    clock.at(1100)
    assert session.observe(sample(100 * MS, 0.2, 2.0), None) is None
    clock.at(1150)
    assert session.tick() == 100 * MS
    assert session.mooring.time == pytest.approx(0.15)
    assert session.mooring.pose[0] == pytest.approx(0.3)
    clock.at(1101 + 1000 * HORIZON)
    assert session.tick() is None and session.state == RUN
    assert session.tick() == 100 * MS
    assert session.states.lost and session.mooring.time == pytest.approx(0.15)
    clock.at(1400)
    session.observe(sample(400 * MS, 0.8, 2.0), None)
    assert session.tick() == 400 * MS
    assert session.state == RAMP and session.mooring.pose[0] == pytest.approx(0.8)
    assert events(session) == [SETTLED, RAMPED, LOST, FOUND]


def test_settling_between_ticks_does_not_turn_time_back(session, clock):
    session.observe(sample(0, 0.0, 1.0), None)
    clock.at(50)
    session.tick()
    assert session.settle()[0]
    clock.at(60)
    session.tick()
    times = [schedule.decode(record).time for _, record in session.actions()]
    assert times == pytest.approx([0.0, 0.05, 0.05, 0.06])


def test_silence_leads_to_hold_by_the_clock_and_the_static_wrench_at_the_last_good_pose_goes_out(session, clock):
    session.watch.input_age = 0.3
    for k in range(20):
        clock.at(50 * k)
        session.take(sample(k * 50 * MS, 0.1 * k, 2.0), None)
        assert session.look() is None
    moved = session.wrenches[0].copy()
    clock.at(950 + 299)
    assert session.look() is None and session.state == RUN
    shares = []
    clock.at(950 + 300.5)
    assert session.look() is None and session.state == RUN
    for ms in np.linspace(301, 1302, 78):
        clock.at(950 + ms)
        assert session.look() == 950 * MS
        shares.append((session.wrenches[0][0] - moved[0]) / (static(1.9)[0] - moved[0]))
    assert session.state == HOLD and "0.301 s" in session.states.cause
    assert shares[0] == pytest.approx(0.0, abs=1e-3) and max(np.diff(shares)) < 0.025 and min(np.diff(shares)) >= -1e-12
    np.testing.assert_allclose(session.wrenches[0], static(1.9), rtol=1e-6, atol=1.0)
    assert session.mooring.time == pytest.approx(0.95)
    clock.at(3000)
    assert session.take(sample(3000 * MS, 2.0, 0.0), None) == 3000 * MS and session.state == RAMP
    np.testing.assert_allclose(session.wrenches[0], static(1.9), rtol=1e-6, atol=1.0)
    session.take(sample(4000 * MS, 2.0, 0.0), None)
    assert session.state == RUN
    np.testing.assert_array_equal(session.wrenches[0], session.mooring.wrench)
    assert events(session) == [SETTLED, RAMPED, LOST, FOUND, RAMPED]


def test_an_input_that_is_there_but_refused_is_lost_for_that_cause(session, clock):
    session.watch.input_age = 0.3
    session.take(sample(0), None)
    for k in range(1, 5):
        clock.at(100 * k)
        assert session.take(sample(100 * k * MS, 500.0), None) is None
        session.look()
    session.look()
    assert session.state == HOLD and "no good input for 0.400 s" in session.states.cause and "4 refused, the last: jump: pose is 500 m" in session.states.cause


@pytest.mark.parametrize("missing", ["input_age", "heartbeat"])
def test_a_process_that_was_held_up_hears_what_waits_for_it_before_it_judges(session, clock, missing):
    setattr(session.watch, missing, 0.3)
    session.beat()
    session.take(sample(0), None)
    for k in range(1, 4):
        clock.at(1000 * k)
        session.look()
        session.beat()
        session.take(sample(1000 * k * MS), None)
        session.look()
    assert session.state == RUN


def test_a_hold_leaves_the_core_as_it_was(session):
    session.take(sample(0), None)
    session.take(sample(50 * MS, 0.1, 2.0), None)
    before = session.mooring.snapshot()
    assert session.hold()[0]
    after = session.mooring.snapshot()
    assert all(np.array_equal(a, b) for a, b in zip(before.state, after.state)) and len(session.actions()) == 2


def test_the_static_wrench_of_a_hold_is_without_a_line_that_was_let_go(session, clock):
    session.take(sample(0), None)
    session.release("line2")
    session.take(sample(10 * MS), None)
    session.hold()
    clock.at(2000)
    session.look()
    assert np.linalg.norm(session.wrenches[0][:3] - static(0.0)[:3]) > 5e5


def test_more_frames_without_a_pose_than_are_bridged_lead_to_hold_until_a_good_one(session):
    session.gate.limits.lost_frames = 2
    for k in range(10):
        session.take(sample(k * 10 * MS), None)
    for k in range(10, 12):
        assert session.take(sample(k * 10 * MS, float("nan")), None) == k * 10 * MS and session.state == RUN
    assert session.take(sample(120 * MS, float("nan")), None) is None
    assert session.states.lost and "not finite" in session.states.cause
    assert session.take(sample(130 * MS), None) == 130 * MS and session.state == RAMP


def test_without_limits_silence_changes_nothing(session, clock):
    session.take(sample(0), None)
    clock.at(1e9)
    assert session.look() is None and session.state == RUN


def test_a_hold_that_was_asked_for_outlives_inputs_which_are_answered_by_the_held_wrench(session, clock):
    first = session.take(sample(0), None), session.wrenches[0].copy()
    assert first[0] == 0 and session.hold()[0]
    for k in range(1, 60):
        clock.at(50 * k)
        assert session.take(sample(50 * k * MS, 0.002 * k * k, 0.08 * k), None) == 50 * k * MS
        assert session.look() is None
    np.testing.assert_allclose(session.wrenches[0], first[1], rtol=1e-9, atol=1e-3)
    assert session.state == HOLD and not session.states.lost and session.steps == 59
    clock.at(6000)
    assert session.look() == 59 * 50 * MS
    assert session.settle()[0] and session.state == RAMP
    assert events(session) == [SETTLED, RAMPED, ASKED, SETTLED]


def test_without_a_heartbeat_it_does_not_start_and_a_lost_one_is_a_fault_until_it_beats_and_somebody_settles(session, clock):
    session.watch.heartbeat = 0.5
    assert session.take(sample(0), None) is None and session.state == IDLE and "heartbeat" in session.states.cause
    session.beat()
    clock.at(10)
    assert session.take(sample(10 * MS), None) == 10 * MS and session.state == RUN
    clock.at(511)
    session.look()
    session.look()
    assert session.state == SAFE and "0.511 s" in session.states.cause
    assert session.take(sample(511 * MS), None) is None
    assert session.settle() == (False, "not settled: no heartbeat for 0.511 s, limit 0.5 s")
    session.beat()
    assert session.look() == 10 * MS and session.state == SAFE
    assert session.settle()[0] and session.state == RAMP
    assert events(session) == [SETTLED, RAMPED, FAULT, SETTLED]


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


def test_after_a_step_that_failed_no_input_is_answered_until_settle(session, clock, monkeypatch):
    session.take(sample(0), None)
    clock.at(10)
    session.take(sample(10 * MS), None)
    session.actions()
    with monkeypatch.context() as broken:
        broken.setattr(type(session.mooring), "wrench", property(lambda self: np.full(6, np.inf)))
        assert session.take(sample(20 * MS), None) is None
    assert session.state == SAFE and "not finite" in session.states.cause and session.actions() == []
    assert session.take(sample(30 * MS), None) is None and session.unanswered == 2
    clock.at(2000)
    assert session.look() == 10 * MS
    np.testing.assert_allclose(session.wrenches[0], static(0.0), rtol=1e-6, atol=1.0)
    assert session.hold() == (True, f"SAFE already, until ~/settle: {session.states.cause}")
    assert session.settle()[0] and session.state == RAMP
    assert session.take(sample(40 * MS), None) == 40 * MS


def test_nothing_can_be_done_before_the_first_sample(session):
    assert session.state == IDLE
    assert not session.settle()[0] and not session.hold()[0] and not session.release("line1")[0]


def test_an_unknown_or_released_line_is_refused_in_words(session):
    session.take(sample(0), None)
    assert session.release("line1")[0]
    done, words = session.release("line1")
    assert not done and "line1" in words
