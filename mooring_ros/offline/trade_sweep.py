"""Which settings are run: along the meshes, along the steps, and then those that the predictions put on the front or at the goal."""

import math

import numpy as np

from mooring_ros.mooring import SOLVERS, Mooring

from .trade_choice import front
from .trade_errors import Errors, errors_between
from .trade_family import Family, Result
from .trade_setting import Meshes, Setting

LADDER = math.sqrt(2.0)  # from mesh to mesh
FEWEST = 3.0  # segments of a line, on average
WORST = 10.0  # per cent of error beyond which nothing coarser is tried, or five times what is asked
USELESS = 3.0  # times the cost of another method at no less error: not followed on other meshes
ENOUGH = 0.2  # of the error: a finer step that changes less ends the row of steps
SLOW, PATIENCE = 0.85, 3  # of the last error, and how often in a row: finer meshes that bring no more lead nowhere
STUCK = 0.8  # of the last change: a finer step that changes as much leads nowhere
AS_GOOD = 1.15  # times the least error: worth nothing more
DEEPEST = 6  # doublings of the steps
SEARCH_MESH, SEARCH_STEP = 1.02, 1.2  # grid on which the goal is searched for
WORTH = 0.04  # less gain than this is not run for
SURE = 1.02  # times a predicted error that should be within the goal
HOPEFUL, WORTH_HOPING, HOPES = 0.88, 0.15, 4  # times one that may be by chance, what it must save, and how often that is tried
KEPT = 0.3  # of the time, for search and verifying
ROUNDS = 10  # runs of the search, and of verifying the front
PASSES = 4.0  # runs that one measurement takes


class Sweep:
    """Results of all settings of one scene against its reference. left() s of CPU time remain."""

    def __init__(self, runner, reference, goal, left):
        self._runner, self._window, self._reference, self._goal, self._left = runner, runner.window, reference, goal, left
        self._meshes = Meshes(runner.scene)
        self._least = goal.error / 2.0 if goal.error else max(0.2, 2.0 * float(reference.error.max()))  # per cent: no finer mesh is needed
        self.families, self._alone, self.left_out = [], [], []
        self._kept = KEPT * max(left(), 0.0)  # s of CPU time, for what the predictions will ask for

    def explore(self):
        """Run what is needed; afterwards `results` has it."""
        for solver in (name for name in SOLVERS if name != "auto"):
            family = self._family("dynamic", solver)
            self.families.append(family)
            if solver == "explicit":
                self._along_meshes(family)
                self._along_steps(family, self._finest_step_mesh(family))
            else:
                self._along_steps(family, 1.0)
                if not self._beaten(family):
                    self._along_meshes(family)
        for fidelity in ("quasi_static", "linear"):
            family = self._family(fidelity, "auto")
            self.families.append(family)
            self._run(family, 1.0, 1)
            if not self._beaten(family):
                self._along_meshes(family)
        self._default()
        self._kept = 0.0
        if self._goal.error is not None or self._goal.budget is not None:
            self._search()
        self._verify()

    @property
    def results(self):
        """All Results; predicted ones only where the same was not run."""
        run = [result for family in self.families for result in family.results.values()]
        return [*self._alone, *run, *(result for result in self._predictions() if result.setting not in {r.setting for r in run})]

    @property
    def usable(self):
        """Those that were run and not refused; the default last of those that are alike."""
        family = [result for family in self.families for result in family.usable()]
        known = {(result.errors, result.force_errors) for result in family}
        return family + [result for result in self._alone if result.refused is None and (result.errors, result.force_errors) not in known]

    # -- parts of it ------------------------------------------------------------------------------------------------------------------

    def _family(self, fidelity, solver):
        scene, meshes = self._runner.scene, self._meshes
        limits = (lambda factor: Mooring(scene, solver=solver, **meshes.arguments(factor)).step_limit.dt) if solver == "explicit" else None
        return Family(fidelity, solver, meshes, self._window.interval, limits)

    def _run(self, family, factor, steps, expected=None):
        """The Result of a family's setting, run unless it would take too long; None then."""
        if (factor, steps) in family.results:
            return family.results[factor, steps]
        setting = family.setting(factor, steps)
        left = max(self._left() - self._kept, 0.0)
        if expected is not None and PASSES * expected * self._window.duration > left:
            self.left_out.append((setting, f"would take about {PASSES * expected * self._window.duration:.3g} s of CPU time, {left:.3g} s are left"))
            return None
        result = self._result(setting, factor, steps, max(left / 2.0, 1.0))
        family.add(result)
        return result

    def _result(self, setting, factor, steps, limit):
        measured = self._runner.run(setting, limit)
        if measured.refused:
            return Result(setting, factor, steps, refused=measured.refused)
        rows = slice(self._window.compared, None)
        return Result(
            setting, factor, steps, errors_between(measured.tension[rows], self._reference.tension),
            errors_between(measured.force[rows], self._reference.tension), measured.cost, measured.worst_step,
            tension=measured.tension[rows].astype(np.float32),
        )

    def _error(self, result):
        return getattr(result, self._goal.of).worst

    def _along_meshes(self, family):
        """Finer until the error is small enough or the time is up, with shorter steps where finer meshes alone do not help; coarser while it is of use."""
        more = self._best_share(family)
        first = self._run(family, 1.0, more * family.default_steps(1.0))
        before, last, slow = None, first, 0
        while last and (last.refused or self._error(last) > self._least):
            slow = slow + 1 if before and not last.refused and not before.refused and self._error(last) > SLOW * self._error(before) else 0
            if slow and family.fidelity == "dynamic":
                shorter = self._run(family, last.factor, 2 * more * family.default_steps(last.factor), 2.0 * last.cost)
                if shorter and shorter.refused is None and self._error(shorter) < STUCK * self._error(last):
                    before, last, slow, more = None, shorter, 0, 2 * more
            if slow == PATIENCE:
                break
            factor = self._meshes.nearest(min(last.factor * LADDER, self._reference.refine / 2.0))
            if factor <= last.factor:
                break
            growth = last.cost / before.cost if before and before.cost > 0.0 else 2.0
            expected = last.cost * max(growth, 1.0) if last.refused is None else None
            before, last = last, self._run(family, factor, more * family.default_steps(factor), expected)
        last, more = first, self._best_share(family)
        while last and last.refused is None and self._error(last) < max(WORST, 5.0 * (self._goal.error or 0.0)):
            factor = self._meshes.nearest(last.factor / LADDER)
            if factor >= last.factor or factor * self._meshes.mean < FEWEST:
                break
            last = self._run(family, factor, more * family.default_steps(factor), last.cost)

    def _along_steps(self, family, factor):
        """Shorter steps, half by half, until they change nothing any more, or as much as the step before."""
        steps, before = family.default_steps(factor), math.inf
        last = self._run(family, factor, steps)
        for _ in range(DEEPEST):
            finer = self._run(family, factor, 2 * steps, 2.0 * last.cost if last and last.refused is None else None)
            if finer is None:
                break
            if finer.refused is None and last.refused is None:
                change = errors_between(last.tension, finer.tension).worst
                if change < ENOUGH * min(self._error(finer), self._least) or change > STUCK * before:
                    break
                before = change
            steps, last = 2 * steps, finer

    def _finest_step_mesh(self, family):
        """The mesh along whose steps is looked: the file's, where it could be run."""
        usable = family.usable()
        return 1.0 if not usable or any(result.factor == 1.0 for result in usable) else usable[0].factor

    def _best_share(self, family):
        """Steps over the default's with which the file's mesh is hardly worse than with the best there, the fewest."""
        row = sorted((result for result in family.usable() if result.factor == 1.0), key=lambda result: result.steps)
        if not row:
            return 1
        best = min(self._error(result) for result in row)
        return next(result.steps for result in row if self._error(result) <= AS_GOOD * best) // family.default_steps(1.0)

    def _beaten(self, family):
        """Whether everything of a family costs much more than something else that is no less accurate."""
        others = [result for other in self.families if other is not family for result in other.usable()]
        return all(any(o.cost * USELESS < own.cost and self._error(o) <= self._error(own) for o in others) for own in family.usable())

    def _default(self):
        """What the scene's own settings do."""
        self._alone.append(self._result(Setting("dynamic", "auto"), 1.0, 1, max(self._left(), 10.0)))

    # -- predictions ------------------------------------------------------------------------------------------------------------------

    def _predictions(self):
        """Results of all meshes times all steps that were not run, in the methods that have runs along both."""
        made = []
        for family in self.families:
            usable = family.usable()
            if family.fidelity != "dynamic" or len(usable) < 3:
                continue
            shares = {result.steps / family.default_steps(result.factor) for result in usable}
            for factor in sorted({result.factor for result in usable}):
                for share in sorted(shares):
                    steps = max(1, round(share * family.default_steps(factor)))
                    if (factor, steps) not in family.results:
                        made += self._predicted(family, factor, steps)
        return made

    def _predicted(self, family, factor, steps):
        of_tension, of_force = family.corrected(factor, steps), family.corrected(factor, steps, "force_errors")
        if of_tension is None:
            return []
        worst = Errors(*of_tension[0].tolist(), -1), Errors(*of_force[0].tolist(), -1)
        return [Result(family.setting(factor, steps), factor, steps, *worst, of_tension[1], measured=False)]

    def _verify(self):
        """Run what the predictions put on the front."""
        for _ in range(ROUNDS):
            expected = front(self.usable + self._predictions(), self._goal.of)
            waiting = [result for result in expected if not result.measured and not self._refused_for_time(result)]
            if not waiting:
                break
            self._run_predicted(waiting[0])

    def _search(self):
        """Run what the predictions, on all meshes and steps between those that were run, hold for the best answer to the goal.

        Errors wobble from mesh to mesh: what should just miss the error is tried, too, where it would save much.
        """
        for _ in range(ROUNDS):
            better = self._better(SURE, WORTH)
            if not better:
                break
            self._run_predicted(min(better, key=lambda c: self._goal.rank(self._error(c), c.cost)))
        for _ in range(HOPES if self._goal.error is not None else 0):
            better = self._better(HOPEFUL, WORTH_HOPING)
            if better:
                self._run_predicted(min(better, key=self._error))

    def _better(self, margin, gain):
        """Predicted Results that, with `margin` times their errors, would answer the goal by the share `gain` better than what has been run."""
        goal = self._goal
        runs = [(self._error(result), result.cost) for result in self.usable]
        met = [goal.rank(*pair) for pair in runs if goal.within_error(pair[0]) and goal.within_budget(pair[1])]
        best = min(met, default=(math.inf, math.inf))[0]
        candidates = [c for family in self.families for c in self._near_goal(family, margin)]
        return [c for c in candidates if goal.rank(self._error(c), c.cost)[0] < (1.0 - gain) * best and not self._refused_for_time(c)]

    def _near_goal(self, family, margin):
        """Predicted Results of a family that would answer the goal with `margin` times their errors."""
        usable = family.usable()
        if len(usable) < 2:
            return []
        lowest, highest = min(r.factor for r in usable), max(r.factor for r in usable)
        shares = sorted({r.steps / family.default_steps(r.factor) for r in usable}) if family.fidelity == "dynamic" else [1.0]
        factors = {self._meshes.nearest(lowest * SEARCH_MESH**i) for i in range(1 + int(math.log(highest / lowest) / math.log(SEARCH_MESH)))}
        counts = 1 + int(math.log(shares[-1] / shares[0]) / math.log(SEARCH_STEP))
        found, seen = [], {r.setting for r in family.results.values()}
        for factor in sorted(factors):
            for steps in sorted({max(1, round(shares[0] * SEARCH_STEP**i * family.default_steps(factor))) for i in range(counts)}):
                if (factor, steps) in family.results or family.setting(factor, steps) in seen:
                    continue
                predicted = family.corrected(factor, steps, self._goal.of)
                if predicted and self._goal.within_error(margin * predicted[0].max()) and self._goal.within_budget(SURE * predicted[1]):
                    found.append((family, factor, steps))
        return [result for place in found for result in self._predicted(*place)]

    def _run_predicted(self, result):
        family = next(f for f in self.families if f.setting(result.factor, result.steps) == result.setting)
        return self._run(family, result.factor, result.steps, result.cost)

    def _refused_for_time(self, result):
        return any(setting == result.setting for setting, _ in self.left_out)
