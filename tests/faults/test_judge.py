"""The judge of the campaign finds what is wrong."""
import numpy as np
import pytest

from benchmarks.faults import motion
from benchmarks.faults.judge import Judge, Wrong
from benchmarks.faults.peer import Heard
from benchmarks.faults.process import SCENE
from mooring_ros import Mooring

STEP = 20_000_000


@pytest.fixture
def answered():
    """A judge that knows five good samples, and the right answers to them."""
    judge, mooring, answers = Judge(SCENE), Mooring(SCENE), []
    for k in range(5):
        stamp, state = k * STEP, motion.at(k * STEP * 1e-9)
        judge.good[stamp] = state
        mooring.settle(state.pose) if k == 0 else mooring.step(stamp * 1e-9, state.pose, state.twist)
        answers.append(Heard(0.0, stamp, tuple(mooring.wrench)))
    return judge, answers


def test_right_answers_pass(answered):
    judge, answers = answered
    for answer in answers:
        judge.check(answer)
    assert judge.checked == 5 and judge.worst == 0.0


def test_what_one_session_may_be_off_is_not_held_against_the_next_one(answered):
    judge, answers = answered
    judge.tolerance = 1e-5
    judge.check(answers[0]._replace(wrench=tuple(x * (1.0 + 1e-6) for x in answers[0].wrench)))
    good = judge.good
    judge.begin()
    judge.good = good
    for answer in answers:
        judge.check(answer)
    assert judge.checked == 6 and judge.worst > 1e-7


@pytest.mark.parametrize("change, words", [
    (lambda a: a._replace(wrench=(np.nan, *a.wrench[1:])), "not finite"),
    (lambda a: a._replace(wrench=(a.wrench[0] * (1.0 + 1e-6), *a.wrench[1:])), "expected"),
    (lambda a: a._replace(stamp=a.stamp + 1), "expected no answer"),
    (lambda a: a._replace(stamp=0), "later ones alone"),
])
def test_a_wrong_answer_is_found(answered, change, words):
    judge, answers = answered
    for answer in answers[:3]:
        judge.check(answer)
    with pytest.raises(Wrong, match=words):
        judge.check(change(answers[3]))


def test_an_answer_to_a_motion_that_took_another_way_is_found_later(answered):
    judge, answers = answered
    judge.check(answers[0])
    judge.check(answers[1])
    with pytest.raises(Wrong):
        judge.check(answers[3])     # the right one after a step to sample 2, which nobody heard of


def test_a_held_wrench_goes_to_the_static_one_and_nowhere_else(answered):
    judge, answers = answered
    for answer in answers:
        judge.check(answer)
    static = Mooring(SCENE)
    static.settle(judge.good[4 * STEP].pose)
    begin, end = np.array(answers[-1].wrench), static.wrench
    with pytest.raises(Wrong):
        judge.check(answers[-1])
    judge.held()
    for share in (0.0, 0.3, 1.0, 1.0):
        judge.check(Heard(0.0, 4 * STEP, tuple(begin + share * (end - begin))))
    assert judge.holds and judge.share == pytest.approx(1.0)
    with pytest.raises(Wrong, match="not between"):
        judge.check(Heard(0.0, 4 * STEP, tuple(begin + 1.1 * (end - begin))))
