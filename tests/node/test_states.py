"""The state machine and its watch, by a clock that is only numbers."""
import itertools

import pytest

from mooring_ros.node.states import (ASKED, EVENTS, FAULT, FOUND, HOLD, IDLE, LOST, NO_INPUT, RAMP, RAMPED, RUN, SAFE, SETTLED, STATES, TABLE, States,
                                     Watch)

MS = 1_000_000
WAYS = {IDLE: [], RAMP: [SETTLED], RUN: [SETTLED, RAMPED], HOLD: [SETTLED, LOST], SAFE: [SETTLED, FAULT]}


def standing(state):
    states = States(0)
    for event in WAYS[state]:
        assert states.fire(0, event, "on the way")
    assert states.state == state
    states.news()
    return states


@pytest.mark.parametrize("state, event", list(itertools.product(STATES, EVENTS)))
def test_every_event_in_every_state_does_what_the_table_says_and_nothing_else(state, event):
    states = standing(state)
    count = states.count
    done = states.fire(7, event, "because")
    assert done == ((state, event) in TABLE)
    if done:
        assert (states.state, states.cause, states.since, states.count) == (TABLE[state, event], "because", 7, count + 1)
        assert states.news() == [(7, state, TABLE[state, event], event, "because")] and states.news() == []
    else:
        assert states.state == state and states.cause != "because" and states.news() == []


def test_it_begins_idle_and_says_why():
    assert (States(3).state, States(3).cause, States(3).since) == (IDLE, NO_INPUT, 3)


def test_a_fault_is_left_by_settling_only():
    assert {event for (state, event) in TABLE if state == SAFE} == {SETTLED}


def test_a_lost_input_that_comes_back_ends_its_hold_but_not_one_that_was_asked_for():
    states = standing(HOLD)
    assert states.lost and states.held
    assert states.fire(1, ASKED, "~/hold") and states.state == HOLD and not states.lost
    assert not states.fire(2, FOUND, "back") and not states.fire(2, LOST, "lost") and not states.fire(2, ASKED, "again")
    assert states.fire(3, SETTLED, "~/settle") and states.fire(4, RAMPED, "") and states.fire(5, LOST, "lost") and states.fire(6, FOUND, "back")


def test_the_output_is_static_in_hold_and_safe_only():
    assert {state for state in STATES if standing(state).held} == {HOLD, SAFE}


def test_a_transition_reads_as_a_sentence():
    states = standing(RUN)
    states.fire(5, LOST, "no good input for 0.3 s")
    assert str(states.news()[0]) == "RUN -> HOLD, input lost: no good input for 0.3 s"


def test_without_limits_nothing_is_ever_lost():
    watch = Watch()
    watch.hear(0)
    assert not watch.on and watch.input_lost(1e9) == "" and watch.heart_lost(10**18) == ""


def test_an_input_is_lost_when_older_than_the_limit_or_than_the_one_that_holds_otherwise():
    assert Watch(input_age=0.5).input_lost(0.5) == ""
    assert "0.501 s, limit 0.5 s" in Watch(input_age=0.5).input_lost(0.501)
    assert "limit 0.2 s" in Watch().input_lost(0.3, 0.2) and Watch(input_age=1.0).input_lost(0.3, 0.2) == ""


def test_frames_may_be_missing_up_to_the_limit_at_the_rate_that_was_given():
    watch = Watch(lost_frames=3, input_rate=100.0)
    assert watch.input_lost(0.0449) == ""
    assert "4.6 frames of 10 ms, 3 may be missing" in watch.input_lost(0.046)


def test_the_rate_is_learned_from_arrivals_before_frames_are_counted():
    watch = Watch(lost_frames=2)
    for k in range(8):
        watch.hear(k * 20 * MS)
        assert watch.input_lost(10.0) == ""
    watch.hear(8 * 20 * MS)
    assert watch.input_lost(0.069) == "" and "20 ms" in watch.input_lost(0.071)
    watch.forget()
    assert watch.input_lost(10.0) == ""


def test_the_age_of_the_input_counts_from_its_arrival_and_anew_when_the_clock_is_set_back():
    watch = Watch()
    assert watch.since_input(5) == 0.0
    watch.hear(1000 * MS)
    assert watch.since_input(1250 * MS) == pytest.approx(0.25)
    assert watch.since_input(100 * MS) == 0.0 and watch.since_input(300 * MS) == pytest.approx(0.2)


def test_a_heartbeat_is_missing_until_the_first_and_after_the_limit():
    watch = Watch(heartbeat=0.5)
    assert watch.on and watch.heart_lost(0) == "no heartbeat yet"
    watch.beat(0)
    assert watch.heart_lost(500 * MS) == "" and "0.501 s, limit 0.5 s" in watch.heart_lost(501 * MS)
    watch.beat(600 * MS)
    assert watch.heart_lost(601 * MS) == ""
