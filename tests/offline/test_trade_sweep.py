"""Which settings a trade runs, on made-up moorings whose errors and costs are formulas: the answer can be held against all settings there are."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from mooring_ros.mooring import Mooring
from mooring_ros.offline import trade_window
from mooring_ros.offline.motion_file import Motion
from mooring_ros.offline.trade_choice import Goal, choose
from mooring_ros.offline.trade_errors import errors_between
from mooring_ros.offline.trade_measure import Measured
from mooring_ros.offline.trade_setting import step_of, steps_in
from mooring_ros.offline.trade_sweep import Sweep

INTERVAL = 0.1
TIMES = np.arange(0.0, 60.0, INTERVAL)
TRUE = (1e6 + 1e5 * np.sin(0.6 * TIMES))[:, None] * np.ones(2)


class MadeUp:
    """Stands for the runner: a mesh error of some order that wobbles from mesh to mesh, step errors of second order, and costs of two solvers."""

    def __init__(self, path, seed):
        rng = np.random.default_rng(seed)
        self.scene, self.spent, self.asked = Mooring(path).scene, 0.0, []
        poses, twists = np.zeros((TIMES.size, 7)), np.zeros((TIMES.size, 6))
        poses[:, 6] = 1.0
        self.window = trade_window.whole(Motion("", TIMES, poses, twists, np.zeros(TIMES.size, np.int64), ""))
        self._order, self._mesh, self._wobble = rng.uniform(1.0, 2.2), 10.0 ** rng.uniform(-2.0, -0.8), rng.uniform(0.0, 0.15)
        self._step, self._implicit_step, self._dear = 10.0 ** rng.uniform(-5.0, -2.5), 10.0 ** rng.uniform(-3.5, -1.5), 10.0 ** rng.uniform(-0.7, 1.2)
        self._limits = {}

    def truth(self, solver, segments, steps):
        """(error in per cent, cost) of a setting."""
        factor = segments / 8.0
        mesh = self._mesh * factor**-self._order * (1.0 + self._wobble * math.sin(7.0 * segments))
        step = (self._implicit_step if solver == "implicit" else self._step) / steps**2
        history = TRUE + 1e5 * (mesh * np.sin(2.0 * TIMES) + step * np.cos(3.0 * TIMES))[:, None]
        return history, (self._dear if solver == "implicit" else 1.0) * 1e-6 * (1.0 + factor * (2.0 + 8.0 * steps))

    def steps(self, setting):
        if setting.solver == "implicit":
            return steps_in(INTERVAL, setting.dt or 0.05)
        if setting.segments not in self._limits:
            self._limits[setting.segments] = Mooring(self.scene, segments=setting.segments).step_limit.dt
        return steps_in(INTERVAL, min(setting.dt or math.inf, self._limits[setting.segments]))

    def run(self, setting, limit):
        self.asked.append(setting)
        if setting.fidelity != "dynamic":
            return Measured(1.3 * TRUE[1:], 1.3 * TRUE[1:], 1e-3, 1e-3, 1e-2)
        history, cost = self.truth(setting.solver, setting.segments or 8, self.steps(setting))
        self.spent += 4.0 * cost * self.window.duration
        return Measured(history[1:], history[1:], cost, cost, 4.0 * cost * self.window.duration)

    def error(self, history):
        rows = slice(1 + self.window.compared, None)
        return errors_between(history[rows], TRUE[rows]).worst

    def everything(self):
        """[(error, cost)] of all meshes and steps."""
        found = []
        for segments in range(3, 65):
            from_limit = steps_in(INTERVAL, Mooring(self.scene, segments=segments).step_limit.dt)
            for solver, least in (("explicit", from_limit), ("implicit", 1)):
                for more in (1, 1.25, 1.5, 2, 3, 4, 6, 8, 16):
                    history, cost = self.truth(solver, segments, math.ceil(least * more))
                    found.append((self.error(history), cost))
        return found


def swept(path, seed, goal):
    made = MadeUp(path, seed)
    reference = SimpleNamespace(tension=TRUE[1 + made.window.compared :], refine=16, error=np.full(3, 1e-3))
    sweep = Sweep(made, reference, goal, lambda: 10.0)
    sweep.explore()
    return made, sweep


@pytest.mark.parametrize("seed", [0, 2, 4, 7, 8, 11])
def test_the_chosen_setting_costs_little_more_than_the_cheapest_that_there_is(scene, seed):
    asked = 0.5
    made, sweep = swept(scene, seed, Goal(error=asked))
    chosen, why = choose(sweep.usable, Goal(error=asked))
    cheapest = min((cost for error, cost in made.everything() if error <= asked), default=None)
    if cheapest is None:
        assert chosen is None and why.startswith("no setting is within")
        return
    assert chosen is not None, why
    assert chosen.errors.worst <= asked and chosen.cost <= 1.3 * cheapest
    assert len(made.asked) == len(set(made.asked)) and len(made.asked) < 60


@pytest.mark.parametrize("seed", range(2))
def test_within_a_budget_hardly_anything_is_more_accurate(scene, seed):
    made, sweep = swept(scene, seed, Goal(budget=2e4))
    chosen, why = choose(sweep.usable, Goal(budget=2e4))
    assert chosen is not None, why
    best = min(error for error, cost in made.everything() if 2e4 * cost <= 1.0)
    assert 2e4 * chosen.cost <= 1.0 and chosen.errors.worst <= max(1.5 * best, 0.2)


def test_what_is_predicted_is_marked_and_never_chosen(scene):
    _, sweep = swept(scene, 3, Goal(error=0.5))
    assert all(result.measured for result in sweep.usable)
    predicted = [result for result in sweep.results if not result.measured]
    assert predicted and not {result.setting for result in predicted} & {result.setting for result in sweep.usable}


def test_a_trade_without_time_left_says_what_it_leaves_out(scene):
    made = MadeUp(scene, 1)
    reference = SimpleNamespace(tension=TRUE[1 + made.window.compared :], refine=16, error=np.full(3, 1e-3))
    sweep = Sweep(made, reference, Goal(error=0.01), lambda: 1e-6)
    sweep.explore()
    assert sweep.left_out and all("are left" in why for _, why in sweep.left_out)
    assert not {setting for setting, _ in sweep.left_out} & set(made.asked)


def test_steps_are_halved_until_they_change_nothing(scene):
    made, sweep = swept(scene, 5, Goal(error=0.5))
    implicit = [setting.dt for setting in made.asked if setting.solver == "implicit" and setting.segments == 8]
    assert implicit[0] == pytest.approx(step_of(INTERVAL, 1)) and implicit[:2] == sorted(implicit[:2], reverse=True)
