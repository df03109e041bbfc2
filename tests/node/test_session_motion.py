"""Frame times, lost frames and predicted motion in a session, on a real mooring and clocks that are only numbers."""
import numpy as np
import pytest
from node_peer import SCENE, UPRIGHT
from test_session import MS, Clock, sample

from benchmarks import camera_frames as recorded
from mooring_ros.mooring import Mooring
from mooring_ros.motion import Adapter, Gate, Limits, Sample, Velocity
from mooring_ros.node.output import Output
from mooring_ros.node.session import Session
from mooring_ros.node.states import HOLD, RAMP, RUN
from mooring_ros.recording import schedule


def session_of(gate, clock=None, mode="off", seconds=0.0):
    made = Session(Mooring(SCENE), gate, Output(hold_time=0.05), clock=clock or Clock())
    made.delay.mode, made.delay.seconds = mode, seconds
    return made


def steps(session):
    return [(stamp, schedule.decode(record)) for stamp, record in session.actions()]


def test_predicted_motion_is_stepped_to_ahead_of_the_stamp_which_the_answer_keeps():
    late, prompt = session_of(Gate(Adapter()), mode="given", seconds=0.02), session_of(Gate(Adapter()))
    for k in range(40):
        v = 0.5
        assert late.take(sample(k * 10 * MS, 0.01 * k * v, v), None) == k * 10 * MS
        t = k * 10 + (20 if k else 0)
        prompt.take(sample(t * MS, 1e-3 * t * v, v), None)
    for (stamp, ahead), (_, expected) in zip(steps(late)[1:], steps(prompt)[1:]):
        assert ahead.time == pytest.approx(expected.time) and ahead.time == pytest.approx(1e-9 * stamp + 0.02)
        np.testing.assert_allclose(ahead.pose, expected.pose, atol=1e-12)
    np.testing.assert_allclose(late.wrenches, prompt.wrenches, rtol=1e-9)


def test_the_delay_is_by_the_clock_of_the_model_and_the_core_runs_ahead_at_full_scale():
    session = session_of(Gate(Adapter(scale=49.0)), mode="given", seconds=0.02)
    for k in range(3):
        session.take(sample(k * 10 * MS, 0.01 * k, 1.0), None)
    last = steps(session)[-1][1]
    assert last.time == pytest.approx(7.0 * 0.04) and last.pose[0] == pytest.approx(49.0 * 0.04)


def test_prediction_may_be_switched_while_it_runs_and_over_a_settle_and_time_never_goes_back():
    session = session_of(Gate(Adapter()))
    for k in range(200):
        session.delay.mode, session.delay.seconds = [("off", 0.0), ("given", 0.05), ("given", 0.005), ("off", 0.0)][k // 50]
        session.take(sample(k * 10 * MS, 0.001 * k, 0.1), None)
        if k in (75, 120):
            assert session.settle()[0]
    times = [action.time for _, action in steps(session)]
    assert (np.diff(times) >= 0.0).all() and times[-1] == pytest.approx(1.99)
    assert session.state == RUN


def test_bunched_frames_are_stepped_to_when_they_were_taken_and_answered_with_their_stamps():
    made = recorded.bunched(recorded.frames(1.0))
    session = session_of(Gate(Adapter(scale=50.0), velocity=Velocity(recorded.RATE, 10.0)))
    assert [session.take(frame.sample, None) for frame in made] == [frame.sample.stamp for frame in made]
    times = np.array([action.time for _, action in steps(session)])
    np.testing.assert_allclose(times / 50.0 ** 0.5, [frame.time for frame in made], atol=0.1 / recorded.RATE)


def test_in_timer_mode_lost_frames_lead_to_one_hold_which_lasts_until_a_good_one():
    clock = Clock()
    session = session_of(Gate(Adapter(), Limits(lost_frames=2)), clock)
    session.watch.lost_frames, session.watch.input_rate = 2, 100.0
    heard = []
    for k in range(120):
        clock.at(10.0 * k)
        bad = 40 <= k < 60
        session.observe(sample(10 * k * MS) if not bad else Sample(10 * k * MS, (np.nan,) * 7, (0.0,) * 6), None)
        clock.at(10.0 * k + 5.0)
        session.tick()
        heard += [transition.after for transition in session.states.news()]
    assert heard == [RAMP, RUN, HOLD, RAMP, RUN]
    assert np.isfinite(session.wrenches).all() and session.gate.bridged == 2


def test_in_timer_mode_the_acceleration_is_carried_on():
    clock = Clock()
    session = session_of(Gate(Adapter()), clock)
    for k in range(3):
        t = 0.1 * k
        clock.at(100.0 * k)
        session.observe(Sample(100 * k * MS, (0.5 * 2.0 * t * t, 0.0, 0.0, *UPRIGHT), (2.0 * t, 0.0, 0.0, 0.0, 0.0, 0.0)), None)
    clock.at(260.0)
    session.tick()
    assert session.mooring.pose[0] == pytest.approx(0.26 ** 2) and session.mooring.twist[0] == pytest.approx(0.52)
