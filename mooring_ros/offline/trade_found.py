"""What a trade has found, for the report, the terminal and programs."""

import math
from dataclasses import asdict, dataclass

from .trade_cache import machine_text
from .trade_choice import Goal
from .trade_reference import PARTS, Reference
from .trade_window import Window

GOOD_REFERENCE = 0.3  # of the error asked for: a reference that is known no better is told of
CHAOTIC = 5.0  # per cent of dynamic error that is left in the reference


@dataclass
class Found:
    """results: all of trade_family.Result, of which front are worth their cost; left_out: (Setting, why); chosen: Result or None, and why; of: tension or
    force; runs, from_cache: counts; cpu: s, measuring; elapsed: s; chosen_motion: words of the command line that choose the motion in its file;
    parameters: path of the file that holds the chosen setting."""

    window: Window
    reference: Reference
    results: list
    front: list
    left_out: list
    chosen: object
    why: str
    goal: Goal
    of: str
    line_names: list
    runs: int
    from_cache: int
    cpu: float
    elapsed: float
    scene: str = ""
    motion: str = ""
    chosen_motion: tuple = ()
    parameters: str | None = None

    @property
    def replay_command(self):
        """The `mooring replay` that computes with the chosen setting."""
        return self.chosen.setting.replay_command(self.scene, self.motion, self.chosen_motion)

    def error(self, result):
        """Errors of a result in what the trade is of."""
        return getattr(result, self.goal.of)

    @property
    def remarks(self):
        """What one should know before trusting it."""
        known, said = float(self.reference.error.max()), []
        if not self.reference.converged:
            said.append(f"the reference itself is known to {known:.2g} %: {self.reference.why}")
        if self.goal.error is not None and known > GOOD_REFERENCE * self.goal.error:
            said.append(f"an error of {self.goal.error:g} % cannot be told for certain with it; expected a longer --time")
        if self.reference.error[1] > CHAOTIC:
            said.append("runs of the reference drift apart although they are fine: slack, snap or impact makes much of the smallest differences")
        if not self.window.whole:
            said.append(f"measured on {self.window.why}")
        if self.chosen is not None and self.chosen.worst_step > self.window.interval:
            said.append(f"its worst step takes {1e3 * self.chosen.worst_step:.3g} ms, longer than the {1e3 * self.window.interval:.3g} ms between samples")
        return said

    def as_dict(self):
        """The object that --json prints."""
        window, chosen = self.window, self.chosen
        return {
            "scene": self.scene, "motion": self.motion, "machine": machine_text(), "of": self.of,
            "window": {"start": float(window.times[0]), "compared_from": float(window.times[window.compared + 1]), "end": float(window.times[-1]),
                       "samples": len(window.times), "interval": window.interval, "whole": window.whole, "why": window.why},
            "reference": self.reference.as_dict(),
            "settings": [self._entry(result) for result in self.results],
            "left_out": [{**setting.arguments(), "why": why} for setting, why in self.left_out],
            "front": [self.results.index(result) for result in self.front],
            "goal": asdict(self.goal), "chosen": None if chosen is None else self._entry(chosen), "why": self.why, "parameters": self.parameters,
            "replay": None if chosen is None else self.replay_command,
            "remarks": self.remarks, "runs": self.runs, "from_cache": self.from_cache, "cpu": self.cpu, "elapsed": self.elapsed,
        }

    def _entry(self, result):
        entry = {**result.setting.arguments(), "steps_per_sample": result.steps, "measured": result.measured, "refused": result.refused}
        for key, errors in (("errors", result.errors), ("force_errors", result.force_errors)):
            entry[key] = None if errors is None else dict(zip(PARTS, errors.parts().tolist())) | {
                "worst": errors.worst, "worst_line": None if errors.line < 0 else self.line_names[errors.line]}
        ran = math.isfinite(result.cost)
        entry |= {"cost": result.cost if ran else None, "real_time_factor": 1.0 / result.cost if ran else None, "worst_step": result.worst_step}
        entry["on_front"] = result in self.front
        return entry
