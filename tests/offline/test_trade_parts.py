"""The parts of a trade, on histories whose errors are known by construction."""

from dataclasses import replace

import numpy as np
import pytest

from mooring_ros.mooring import Mooring
from mooring_ros.offline import trade_window
from mooring_ros.offline.console import ComputationFailed
from mooring_ros.offline.motion_file import Motion
from mooring_ros.offline.trade_choice import Goal, choose, front
from mooring_ros.offline.trade_errors import Errors, errors_between
from mooring_ros.offline.trade_family import Family, Result
from mooring_ros.offline.trade_measure import Measured, measure
from mooring_ros.offline.trade_motion import one_stretch
from mooring_ros.offline.trade_reference import converged_reference
from mooring_ros.offline.trade_setting import Meshes, Setting, step_of, steps_in
from mooring_ros.recording import schedule

TIMES = np.arange(0.0, 120.0, 0.05)
TRUE = np.column_stack([1e6 + 1e5 * np.sin(0.6 * TIMES), 5e5 + 4e4 * np.cos(0.6 * TIMES)])  # (k, 2) N


def result(cost, error, refused=None):
    errors = Errors(0.0, error, 0.0, 0)
    return Result(Setting("dynamic", "explicit", dt=cost), 1.0, 1, errors, errors, cost, refused=refused)


def moved(times, surge, speed):
    """A Motion in surge alone."""
    poses, twists = np.zeros((times.size, 7)), np.zeros((times.size, 6))
    poses[:, 6], poses[:, 0], twists[:, 0] = 1.0, surge, speed
    return Motion("motion.csv", times, poses, twists, np.rint(times * 1e9).astype(np.int64), "made")


def test_errors_are_those_that_were_put_in():
    wrong = TRUE.copy()
    wrong[:, 1] += 5e3 + 0.03 * 4e4 * np.sin(3.0 * TIMES)
    found = errors_between(wrong, TRUE)
    assert found.mean == pytest.approx(1.0, rel=0.02)
    assert found.dynamic == pytest.approx(3.0, rel=0.02)
    assert found.peak == pytest.approx(100.0 * (wrong[:, 1].max() / TRUE[:, 1].max() - 1.0), rel=1e-9)
    assert found.line == 1 and found.worst == found.dynamic


def test_a_line_that_hardly_moves_is_not_held_against_its_own_trembling():
    still = np.column_stack([TRUE[:, 0], np.full(TIMES.size, 5e5)])
    wrong = still.copy()
    wrong[::2, 1] += 10.0
    assert errors_between(wrong, still).dynamic < 1.1


@pytest.mark.parametrize("seed", range(5))
def test_nothing_beats_what_is_on_the_front_and_something_beats_all_else(seed):
    rng = np.random.default_rng(seed)
    results = [result(cost, error) for cost, error in rng.lognormal(size=(40, 2))]
    kept = front(results)
    for r in results:
        better = [o for o in results if o.cost <= r.cost and o.errors.worst <= r.errors.worst and o is not r]
        if r in kept:
            assert not better
        else:
            assert any(o.cost <= r.cost and o.errors.worst <= r.errors.worst / 0.98 for o in kept)


def test_an_error_asks_for_the_cheapest_a_budget_for_the_most_accurate():
    results = [result(1e-3, 5.0), result(1e-2, 0.9), result(0.05, 0.5), result(0.2, 0.1)]
    assert choose(results, Goal(error=1.0))[0] is results[1]
    assert choose(results, Goal(budget=10.0))[0] is results[2]
    assert choose(results, Goal(error=0.95, budget=50.0))[0] is results[1]
    for impossible in (Goal(error=0.01), Goal(budget=1e6), Goal(error=0.2, budget=10.0)):
        chosen, why = choose(results, impossible)
        assert chosen is None and why.startswith("no setting is within")


def family(scene):
    """A Family whose runs have a mesh error of order 2, a step error of order 2, and a cost of segments times steps."""
    made = Family("dynamic", "implicit", Meshes(scene), 0.1)

    def add(factor, steps):
        history = TRUE * (1.0 + 0.02 * factor**-2.0) + 2e3 * factor**-2.0 * np.sin(2.0 * TIMES)[:, None] + 3e3 * steps**-2.0 * np.cos(5.0 * TIMES)[:, None]
        errors = errors_between(history, TRUE)
        made.add(Result(made.setting(factor, steps), factor, steps, errors, errors, 1e-3 * factor * (1.0 + steps), tension=history))
        return made.results[factor, steps]

    return made, add


def test_settings_that_were_not_run_are_predicted_from_orders(scene):
    made, add = family(Mooring(scene).scene)
    for place in ((0.5, 4), (1.0, 1), (1.0, 2), (1.0, 4), (1.0, 8), (2.0, 4)):
        add(*place)
    places = [(0.5, 1), (0.5, 8), (1.5, 3), (2.0, 1), (2.0, 8), (3.0, 4)]
    predicted = [made.corrected(*place) for place in places]
    for place, (errors, cost) in zip(places, predicted):
        true = add(*place)
        assert errors.max() == pytest.approx(true.errors.worst, rel=0.25), place
        assert cost == pytest.approx(true.cost, rel=0.15), place


def test_the_reference_knows_its_own_error(scene):
    """Runs with errors of second order in mesh and step: observed orders of 2, an estimate near the true error, refined to the target and not further."""
    described = Mooring(scene).scene
    window = trade_window.whole(moved(TIMES, np.sin(TIMES), np.cos(TIMES)))
    asked = []

    def run(setting):
        asked.append(setting)
        steps = steps_in(window.interval, setting.dt or Mooring(described, solver="explicit", refine=setting.refine).step_limit.dt)
        wave = 1e4 * setting.refine**-2.0 * np.sin(2.0 * TIMES) + 100.0 * steps**-2.0 * np.cos(5.0 * TIMES)
        history = (TRUE + wave[:, None])[1:]
        return Measured(history, history, 1e-6, 1e-6, 1e-4)

    reference = converged_reference(described, window, run, 0.3, lambda: 10.0)
    true = errors_between(reference.tension, TRUE[1 + window.compared :])
    assert reference.converged and reference.error.max() <= 0.3
    assert reference.error[1] == pytest.approx(true.dynamic, rel=0.25)
    assert reference.space_order[1] == pytest.approx(2.0, abs=0.1) and reference.time_order[1] == pytest.approx(2.0, abs=0.1)
    assert reference.refine == 16 and len(asked) == len(set(asked))


def test_a_reference_that_gets_worse_when_refined_is_the_best_that_there_was(scene):
    described = Mooring(scene).scene
    window = trade_window.whole(moved(TIMES, np.sin(TIMES), np.cos(TIMES)))

    def run(setting):
        wrong = 1e4 * (setting.refine**-2.0 if setting.refine <= 8.0 else 0.1 * np.cos(setting.refine))
        history = (TRUE + wrong * np.sin(2.0 * TIMES)[:, None])[1:]
        return Measured(history, history, 1e-6, 1e-6, 1e-4)

    reference = converged_reference(described, window, run, 1e-3, lambda: 10.0)
    assert not reference.converged and reference.refine == 8 and "differ more" in reference.why


def test_a_reference_that_cannot_be_refined_is_the_finest_that_could_be_run(scene):
    described = Mooring(scene).scene
    window = trade_window.whole(moved(TIMES, np.sin(TIMES), np.cos(TIMES)))

    def run(setting):
        if setting.refine > 4.0:
            raise ComputationFailed("ran away")
        history = (TRUE + 1e4 * setting.refine**-2.0 * np.sin(2.0 * TIMES)[:, None])[1:]
        return Measured(history, history, 1e-6, 1e-6, 1e-4)

    reference = converged_reference(described, window, run, 1e-3, lambda: 10.0)
    assert not reference.converged and reference.refine == 4 and reference.why == "ran away"


def test_without_time_the_reference_says_so(scene):
    described = Mooring(scene).scene
    window = trade_window.whole(moved(TIMES, np.sin(TIMES), np.cos(TIMES)))

    def run(setting):
        history = (TRUE * (1.0 + 0.1 / setting.refine))[1:]
        return Measured(history, history, 1.0, 1.0, 1.0)

    reference = converged_reference(described, window, run, 1e-3, lambda: 0.0)
    assert not reference.converged and reference.refine == 2 and "would take" in reference.why and reference.error.max() > 1.0


def test_the_window_holds_the_highest_tension_and_swells_from_rest():
    surge = 2.0 * np.sin(0.6 * TIMES) * (1.0 + (np.abs(TIMES - 80.0) < 10.0))
    motion = moved(TIMES, surge, np.gradient(surge, TIMES))
    tension = (1e6 + 1e5 * surge)[1:, None]
    window = trade_window.choose(motion, 1.0, tension, 1.0)
    assert not window.whole and window.duration < 0.8 * np.ptp(TIMES)
    assert window.times[1 + window.compared] <= TIMES[1 + tension[:, 0].argmax()] <= window.times[-1]
    assert not window.twists[0].any()
    inside = np.isin(TIMES, window.times[1 + window.compared :])
    np.testing.assert_array_equal(window.poses[1 + window.compared :], motion.poses[inside])
    np.testing.assert_allclose(np.gradient(window.poses[:, 0], window.times)[2:-2], window.twists[2:-2, 0], atol=0.02 * np.abs(window.twists[:, 0]).max())


def test_a_motion_that_can_be_afforded_is_taken_whole():
    motion = moved(TIMES, np.sin(TIMES), np.cos(TIMES))
    window = trade_window.choose(motion, 1e-6, None, 60.0)
    assert window.whole and window.times is motion.times and window.compared == pytest.approx(0.1 * TIMES.size, abs=2)


def test_a_recording_is_traded_on_its_longest_stretch():
    times = np.concatenate([np.arange(0.0, 2.0, 0.1), np.arange(1.9, 9.0, 0.1)])
    motion = replace(moved(times, np.sin(times), np.cos(times)), schedule=[schedule.decode(r) for r in ()])
    taken = one_stretch(motion)
    assert (np.diff(taken.times) > 0.0).all() and taken.times[0] == 1.9 and any("settled 2 times" in remark for remark in taken.remarks)
    with pytest.raises(ValueError, match="expected at least 20"):
        one_stretch(moved(times[:5], times[:5], times[:5]))


@pytest.mark.parametrize("interval", [0.05, 0.1, 1.0 / 30.0, 0.004])
@pytest.mark.parametrize("steps", [1, 2, 3, 7, 10, 64])
def test_a_step_is_written_so_that_the_core_takes_as_many_as_were_meant(interval, steps):
    assert steps_in(interval, step_of(interval, steps)) == steps


def test_a_setting_that_is_not_taken_as_it_is_given_is_refused_with_the_reason(scene):
    window = trade_window.whole(moved(TIMES[:60], np.sin(TIMES[:60]) - TIMES[:60], np.cos(TIMES[:60]) - 1.0))
    found = measure(Mooring(scene).scene, Setting("dynamic", "explicit", dt=5.0), window, 10.0)
    assert found.refused and found.refused.startswith("dt = 5 s is more than the largest step")


def test_meshes_say_the_segments_where_all_lines_have_as_many_and_a_factor_elsewhere(scene):
    even = Mooring(scene).scene
    assert Meshes(even).arguments(Meshes(even).nearest(1.3)) == {"segments": 10}
    uneven = replace(even, lines=(even.lines[0], replace(even.lines[1], segments=31)))
    assert Meshes(uneven).arguments(Meshes(uneven).nearest(0.7071)) == {"refine": 0.707}
