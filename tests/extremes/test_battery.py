"""The battery of extremes, case by case through the façade: what comes out is what the case claims, or it is refused in the words that it expects."""

import numpy as np
import pytest

from benchmarks.extremes import battery, judge
from mooring_ros import Mooring, MooringError

CASES = list(battery.cases())
SLOW = ("EA 1e11 N", "EA 1e13 N", "1 cm to 200 m", "5000 segments", "three days")  # with implicit steps


def must_end_as_expected(case, solver):
    verdict = judge.judge(case, solver)
    assert verdict.outcome == (judge.REFUSED if case.refused else judge.RIGHT), verdict.words


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_extreme_ends_right_or_is_refused_as_expected(case):
    must_end_as_expected(case, "auto")


@pytest.mark.parametrize("case", [case for case in CASES if case.name not in SLOW and not case.name.startswith("file")], ids=lambda case: case.name)
def test_extreme_with_implicit_steps(case):
    must_end_as_expected(case, "implicit")


def test_after_a_refusal_it_settles_where_it_was_asked_to_jump():
    """The remedy that the refusal names works, and the run goes on from there."""
    case = next(c for c in CASES if c.name == "100 m in 50 ms, slack")
    motion = case.motion()
    mooring = Mooring(case.scene())
    mooring.settle(motion.start)
    with pytest.raises(MooringError, match="settle"):
        mooring.run(motion.times, motion.poses, motion.twists)
    mooring.settle(motion.poses[-1], motion.times[0])
    rest = mooring.fairlead_tension
    mooring.run(motion.times[1:20], np.tile(motion.poses[-1], (19, 1)), np.zeros((19, 6)))
    np.testing.assert_allclose(mooring.fairlead_tension, rest, rtol=1e-3)


def test_a_wrong_force_is_called_wrong_and_a_missing_number_so():
    """The judge itself: claims that miss, and NaN."""
    assert judge.from_claims([judge.claim("T", 1.06, 1.0, 0.05)]).outcome == judge.WRONG
    assert judge.from_claims([judge.claim("T", 1.04, 1.0, 0.05)]).outcome == judge.RIGHT
    assert judge.from_claims([judge.claim("T", 1.0, 1.0, 0.05), judge.claim("T", np.nan, 1.0, 0.05)]).outcome == judge.NOT_A_NUMBER
