"""The helper against a spring that answers, or does not."""

import time

import numpy as np
import pytest
import rclpy
from lifecycle_msgs.srv import GetState

from mooring_ros.coupling import Coupling, LinkError
from mooring_ros.coupling.link import Stopped

HOME = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
REST = np.zeros(6)
SPRING = -7.19e4
PULL = -6.08e6
ABOUT_Z = [0.0, 0.0, np.sin(0.25 * np.pi), np.cos(0.25 * np.pi)]  # 90 degrees


def at(x):
    return [x, *HOME[1:]]


def test_each_sample_is_answered_and_the_scheme_looks_half_a_step_ahead(spring):
    spring()
    with Coupling(step=0.1) as mooring:
        assert mooring.begin(HOME)[2] == PULL
        begin = mooring.time
        assert mooring.exchange(at(1.0), REST)[0] == pytest.approx(1.5 * SPRING)
        assert mooring.exchange(at(2.0), REST)[0] == pytest.approx(2.5 * SPRING)
        assert mooring.wrench[0] == pytest.approx(2.0 * SPRING) and mooring.time == pytest.approx(begin + 0.2)
        assert mooring.ahead(mooring.time + 0.1)[0] == pytest.approx(3.0 * SPRING)
        assert (mooring.counts.sent, mooring.counts.answered, mooring.counts.lost) == (2, 2, 0)


def test_lost_and_doubled_answers_are_counted_and_the_scheme_goes_on(spring):
    spring("--drop", "2", "--double", "3")
    with Coupling(step=0.1, patience=0.5) as mooring:
        mooring.begin(HOME)
        values = [mooring.exchange(at(float(number)), REST)[0] / SPRING for number in (1, 2, 3, 4)]
        assert values == pytest.approx([1.5, 2.5, 3.5, 4.5])
        assert (mooring.counts.lost, mooring.counts.doubled, mooring.counts.answered) == (1, 1, 3)


def test_it_runs_freely_until_the_first_answer_and_in_lockstep_from_then_on(spring):
    spring("--begin-after", "1")
    free = np.full(6, 7.0)
    with Coupling(step=0.01, timeout=30.0) as mooring:
        freely = 0
        while np.array_equal(mooring.exchange(HOME, REST, free), free):
            freely += 1
            time.sleep(0.01)
        assert freely > 10 and mooring.time == pytest.approx(1.0 + 0.01 * freely)
        assert mooring.exchange(HOME, REST)[2] == PULL
        for number in range(20):
            mooring.exchange(at(0.1 * number), REST)
        assert mooring.counts.sent == mooring.counts.answered == 21
        assert mooring.counts.lost == mooring.counts.doubled == mooring.counts.late == 0


def test_nobody_there_ends_the_free_run_after_the_time_out(domain):
    with Coupling(step=0.01, timeout=0.3) as mooring, pytest.raises(LinkError, match="platform/odom"):
        while True:
            mooring.exchange(HOME, REST)


def test_a_node_that_is_there_and_configures_is_waited_for_beyond_the_time_out(domain):
    context = rclpy.Context()
    context.init()
    node = rclpy.create_node("mooring", context=context)
    node.create_service(GetState, "~/get_state", lambda request, answer: answer)  # not spun: so is a node that compiles
    end = time.monotonic() + 4.0
    with Coupling(step=0.01, timeout=2.0, stop=lambda: time.monotonic() > end) as mooring, pytest.raises(Stopped):
        mooring.begin(HOME)
    node.destroy_node()
    with Coupling(step=0.01, timeout=1.0) as mooring, pytest.raises(LinkError, match="nobody answers on .*platform/odom .*, waited 1 s"):
        mooring.begin(HOME)
    context.try_shutdown()


def test_a_wrench_in_the_platforms_axes_is_turned_into_the_worlds(spring):
    spring("--frame", "platform")
    with Coupling(step=0.1, scheme="held") as mooring:
        mooring.begin(HOME)
        wrench = mooring.exchange([2.0, 0.0, 0.0, *ABOUT_Z], REST)
        np.testing.assert_allclose(wrench[:3], [0.0, 2.0 * SPRING, PULL], atol=1e-6)


def test_a_wrench_in_a_frame_of_its_own_is_no_answer(spring):
    spring("--frame", "tower")
    with Coupling(step=0.1, timeout=20.0) as mooring, pytest.raises(LinkError, match="'tower', expected 'world' or 'platform'"):
        mooring.begin(HOME)


def test_without_a_stiffness_the_scheme_that_needs_one_says_so(spring):
    spring()
    with Coupling(step=0.1, scheme="stiffness", patience=0.3) as mooring, pytest.raises(LinkError, match="mooring/stiffness.*stiffness_rate"):
        mooring.begin(HOME)


@pytest.mark.parametrize("pose, words", [([np.nan, *HOME[1:]], "finite numbers of shape \\(7,\\)"), (HOME[:6], "finite numbers of shape \\(7,\\)")])
def test_what_is_no_motion_is_not_sent(spring, pose, words):
    spring()
    with Coupling(step=0.1) as mooring:
        mooring.begin(HOME)
        begin = mooring.time
        with pytest.raises(ValueError, match=words):
            mooring.exchange(pose, REST)
        assert mooring.exchange(HOME, REST)[2] == PULL and mooring.time == pytest.approx(begin + 0.1)


@pytest.mark.parametrize("arguments, words", [({"step": 0.0}, "step is 0.0"), ({"step": 0.1, "scheme": "newton"}, "held"), ({"step": 0.1, "body": "a", "platforms": ["a", "b"]}, "one of the two")])
def test_wrong_arguments_name_what_was_expected(arguments, words):
    with pytest.raises(ValueError, match=words):
        Coupling(**arguments)


def test_steps_of_ones_own_go_on_from_where_they_led(spring):
    spring()
    with Coupling(step=0.1) as mooring:
        mooring.begin(HOME)
        mooring.exchange(at(1.0), REST, at=5.0)
        mooring.exchange(at(2.0), REST, at=5.02)
        assert mooring.ahead(5.04)[0] == pytest.approx(3.0 * SPRING)
        mooring.exchange(at(3.0), REST)
        assert mooring.time == pytest.approx(5.12)
        with pytest.raises(ValueError, match="expected a time after"):
            mooring.exchange(at(3.0), REST, at=5.0)
