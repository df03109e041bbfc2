"""What is worth its cost, and which setting to use."""

from dataclasses import dataclass

GAIN = 0.02  # of the error: for less nobody pays


def front(results, of="errors"):
    """The results that no other beats in both error and cost, cheapest first, each with less error than the one before by GAIN.

    results: of trade_family.Result, not refused; of: which errors.
    """
    best, kept = float("inf"), []
    for cost, error, result in sorted(((result.cost, getattr(result, of).worst, result) for result in results), key=lambda entry: entry[:2]):
        if error < (1.0 - GAIN) * best:
            kept.append(result)
            best = error
    return kept


@dataclass(frozen=True)
class Goal:
    """What is asked for: error in per cent, budget in times real time; None where nothing is. of: "errors" (tension) or "force_errors"."""

    error: float | None = None
    budget: float | None = None
    of: str = "errors"

    def within_error(self, error):
        return self.error is None or error <= self.error

    def within_budget(self, cost):
        return self.budget is None or cost * self.budget <= 1.0

    def rank(self, error, cost):
        """What is to be least: cost where an error is asked for, error where a budget is."""
        return (cost, error) if self.error is not None else (error, cost)

    def words(self):
        parts = ["" if self.error is None else f"an error of {self.error:g} %", "" if self.budget is None else f"{self.budget:g} times real time"]
        return " and ".join(part for part in parts if part)


def choose(results, goal):
    """(Result or None, why) for a goal: the cheapest within the error, if that is within the budget; without an error the most accurate
    within the budget."""
    named = [(getattr(result, goal.of).worst, result.cost, result) for result in results]
    if not named:
        return None, "no setting could be run"
    within = [entry for entry in named if goal.within_error(entry[0])]
    if not within:
        least = min(named, key=lambda entry: entry[0])
        return None, f"no setting is within {goal.error:g} %: the most accurate, {_words(least)}, expected a larger --error, or a longer --time"
    affordable = [entry for entry in within if goal.within_budget(entry[1])]
    if not affordable:
        quickest = min(within, key=lambda entry: entry[1])
        return None, f"no setting is within {goal.words()}: the cheapest{' within that error' if goal.error is not None else ''}, {_words(quickest)}"
    best = min(affordable, key=lambda entry: goal.rank(entry[0], entry[1]))
    return best[2], f"{'the cheapest' if goal.error is not None else 'the most accurate'} setting within {goal.words()}"


def _words(entry):
    error, cost, result = entry
    setting = result.setting
    return f"{setting.method}, {setting.mesh} segments, step {setting.step}, has {error:.3g} % at {1.0 / cost:.3g} times real time"
