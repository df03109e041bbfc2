"""Static states of a mooring: where Newton's method does not find the way at once, the platform's move in parts, and lines that swing and drag."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from .core import explicit
from .core.failures import build_failures
from .core.forces import evaluate_once
from .core.friction import NO_FRICTION
from .core.ground import NO_CONTACT
from .core.model import Model, Scratch, State
from .core.poses import between, moved
from .core.readings import new_readings
from .core.statics import StaticSolver, halt
from .errors import MooringError

NOT_AS_LAID = "statics with friction from the lines as laid did not converge: they hold on to the bed where they lie without friction"
SWINGS, PIECES = 40, 40  # how often lines may swing where the statics do not converge at once, and in how many pieces
SWING_TIME, LONGER = 20.0, 1.2  # s, and by how much each swing is longer than the last one
MOST_EFFORT = 2e8  # evaluations times nodes of all swings: ten seconds at worst, of small scenes
PARTS = (1, 4, 16)  # of a platform's move from sample to sample, in which the statics follow it
STEP_EFFORT = 2e7  # evaluations times nodes of the swings in one step
TOPPLES = 6  # equilibria that topple, one after the other, and swings to find the next
TOPPLES_STILL = "the equilibrium that the statics found topples when it is touched: give bodies and rods places nearer to where they come to rest"
AT_REST = 1e-5  # of the longest line: moves of a whole swing


@dataclass(frozen=True)
class Equilibria:
    """Finds states of a model in which forces balance, with the platform at rest at a pose. MooringError where it finds none.

    table: step table of swings, of which `longest` is the longest step (s). warn: gets the words on what is found and is not what it should be.
    """

    model: Model
    statics: StaticSolver
    scratch: Scratch
    table: np.ndarray
    longest: float
    warn: Callable[[str], None]

    def near(self, present, pose):
        """A State in equilibrium at `pose` and its StaticResult, from the State `present`; where that finds no way, in parts of the move, then from cold.

        The effort is bounded: by the iterations of StaticSolver.solve, once from the present shape, once from cold, 20 times its quick way, and
        a share of a second of swinging.
        """
        state, remembers, tries = copied(present), present.grip.size > 0, 0
        way = between(state.pose, pose)
        for parts in PARTS:
            state = copied(present)
            for share in np.arange(1, parts + 1) / parts:
                self.statics.place(state, moved(present.pose, share * way) if share < 1.0 else pose, first_guess=False)
                result = self.statics.solve(state, self.scratch, quick=parts > 1)
                tries += result.iterations
                if result.residual > self.statics.acceptable:
                    break
                if remembers:
                    self.statics.hold_on(state)
            else:
                return state, replace(result, iterations=tries, converged=True)
        swing = SWING_TIME / self.longest * self.model.size
        state, result = self.from_cold(present, pose, swings=min(int(STEP_EFFORT / swing), SWINGS))
        return state, replace(result, iterations=tries + result.iterations)

    def from_cold(self, present, pose, swings=SWINGS):
        """A State in equilibrium at `pose`, and its StaticResult, from the catenaries; where Newton finds no way, lines swing and drag in the water first."""
        state = copied(present)
        self.statics.place(state, pose)
        remembers = state.grip.size > 0
        if remembers:
            state.grip[3] = NO_CONTACT
        result = self.statics.solve(state, self.scratch)
        best, best_state = result, copied(state)
        effort = 0
        for swing in range(swings):
            if best.residual <= self.statics.acceptable or effort > MOST_EFFORT:
                break
            took, at_rest = self._swing(state, SWING_TIME * LONGER**swing)
            effort += took
            result = self.statics.solve(state, self.scratch, quick=not at_rest)
            if result.residual < best.residual:
                best, best_state = result, copied(state)
            if at_rest:
                break
        if not best.converged and best.residual <= self.statics.acceptable:
            best = replace(best, tolerance=self.statics.acceptable, converged=True)
        if best.converged:
            best, best_state = self._standing(best, best_state, swings)
        if best.converged and remembers:
            state = copied(best_state)
            laid = self.statics.pull_tight(state, self.scratch)
            iterations = laid.iterations + best.iterations
            if laid.residual <= self.statics.acceptable:
                best, best_state = replace(laid, iterations=iterations, converged=True), state
            else:
                best = replace(best, iterations=iterations, as_laid=False)
                self.warn(NOT_AS_LAID)
        if best.converged:
            if remembers:
                self.statics.hold_on(best_state)
            return best_state, best
        raise MooringError(
            f"the statics did not converge in {best.iterations} iterations: "
            f"{best.residual:.3g} N out of balance, {best.tolerance:.3g} N asked for; "
            "expected lines that can hold what hangs on them, and free points, rods and bodies nearer to where they come to rest"
        )

    def _standing(self, result, state, swings):
        """An equilibrium that stands, from one that may topple: pushed, it swings until Newton's method finds another. Warns where none is found."""
        found, trial = (result, state), state
        for swing in range(min(TOPPLES, swings)):
            step = self.statics.falls(trial, self.scratch)
            if step is None:
                return found[0], trial
            trial = copied(trial)
            self.statics.tip(trial, step)
            for _ in range(TOPPLES):
                self._swing(trial, SWING_TIME * LONGER**swing)
                next_result = self.statics.solve(trial, self.scratch)
                if next_result.residual <= self.statics.acceptable:
                    break
            else:
                break
            found = replace(next_result, iterations=found[0].iterations + next_result.iterations, converged=True), trial
        self.warn(TOPPLES_STILL)
        return found

    def _swing(self, state, duration):
        """Let everything move for `duration` (s) without friction, the platform held, and stop it whenever it has gathered most of its speed.

        Returns the evaluations that it took, times nodes, and whether it has come to rest (or cannot go on).
        """
        model = self.model
        free = model._replace(failures=build_failures([]), ground=model.ground._replace(law=NO_FRICTION))
        start, effort, before, report, readings = state.position.copy(), 0.0, 0.0, np.zeros(5), new_readings(model, 1)
        state.clock[0] = 0.0
        halt(state)
        evaluate_once(free, state, self.scratch, 0.0, 0.0, True)
        for time in np.arange(1, PIECES + 1) * (duration / PIECES):
            status, _ = explicit.run(
                free, state, self.scratch, self.table, np.array([time]), state.pose[None].copy(), np.zeros((1, *state.twist.shape)), report, readings
            )
            effort += report[0] * model.size
            energy = (model.mass * state.velocity**2).sum() + (model.rigid.mass[:, None] * state.parts[:, 7:10] ** 2).sum()
            if energy < before:
                halt(state)
            before = energy if energy >= before else 0.0
            if status != explicit.DONE:
                break
        halt(state)
        if state.grip.size:
            state.grip[3] = NO_CONTACT
        farthest = np.abs(state.position - start).max()
        return effort, status != explicit.DONE or farthest < AT_REST * max(self.statics.lengths)


def copied(state):
    return State(*(array.copy() for array in state))
