"""Settings of one method: meshes times steps, some of them run, the others predicted from those.

Error: that of the mesh, measured along the meshes at one step, and that of the step, measured as differences along the steps at one mesh, as squares
added. Cost: that of one mesh with as many steps, times what the mesh changes. Both are then corrected by what the nearest run says.
"""

import math
from dataclasses import dataclass

import numpy as np

from .trade_errors import Errors, errors_between
from .trade_setting import Setting, step_of, steps_in

NEAR = 0.35  # of a run that corrects a prediction: distance in the logarithms of mesh and steps
SHARED = 0.95  # of the least error along the steps: the mesh's, which all of them share
LEAST_MESH_SHARE = 0.3  # of an error, where that of the step seems to be all of it


@dataclass(frozen=True)
class Result:
    """One setting with what it costs and how far it is off. factor: on the file's segments; steps: in a sample interval; errors, force_errors: of the
    end segments' tension and of the end force; measured: run, not predicted; refused: why there is none of this."""

    setting: Setting
    factor: float
    steps: int
    errors: Errors | None = None
    force_errors: Errors | None = None
    cost: float = math.nan
    worst_step: float | None = None
    measured: bool = True
    refused: str | None = None
    tension: np.ndarray | None = None  # (k, lines) N over the part that is compared


class Family:
    """One way of solving on many meshes with many steps. `limits`: of a mesh factor, the default step (s), for the explicit solver alone."""

    def __init__(self, fidelity, solver, meshes, interval, limits=None):
        self.fidelity, self.solver, self.meshes, self.interval = fidelity, solver, meshes, interval
        self._limits, self._default = limits, {}
        self.results = {}  # (factor, steps) -> Result
        self._steps_table, self._mesh_tables = None, {}

    def default_steps(self, factor):
        """Steps in a sample interval that the scene's own choice is; 1 where that has no meaning."""
        if self._limits is None:
            return 1
        if factor not in self._default:
            self._default[factor] = steps_in(self.interval, self._limits(factor))
        return self._default[factor]

    def setting(self, factor, steps):
        """The Setting of a mesh factor (as Meshes.nearest gives it) and a number of steps in a sample interval."""
        own = self._limits is not None and steps <= self.default_steps(factor)
        dt = None if own or self.fidelity != "dynamic" else step_of(self.interval, steps)
        return Setting(self.fidelity, self.solver, dt, **self.meshes.arguments(factor))

    def usable(self):
        return [result for result in self.results.values() if result.refused is None]

    def add(self, result):
        self.results[result.factor, result.steps] = result
        self._steps_table, self._mesh_tables = None, {}

    def predict(self, factor, steps, which="errors"):
        """((3,) errors in per cent, cost) of a setting that may not have been run; None before there are runs to tell from."""
        column = self._column()
        if len(column) < 2:
            return None
        if which not in self._mesh_tables:
            whole = np.array([getattr(result, which).parts() for result in column])
            by_step = np.array([self._step_errors(result.steps) for result in column])
            mesh = np.sqrt(np.maximum(whole**2 - by_step**2, (LEAST_MESH_SHARE * whole) ** 2))
            costs = np.log([r.cost / self._cost_of_steps(r.steps) for r in column])
            self._mesh_tables[which] = np.log([r.factor for r in column]), np.log(np.maximum(mesh, 1e-9)), costs
        factors, mesh, costs = self._mesh_tables[which]
        own = np.exp([_along(factors, part, math.log(factor)) for part in mesh.T])
        errors = np.sqrt(own**2 + self._step_errors(steps) ** 2)
        return errors, math.exp(_along(factors, costs, math.log(factor))) * self._cost_of_steps(steps)

    def corrected(self, factor, steps, which="errors"):
        """`predict`, times what the nearest run has against its own prediction."""
        predicted = self.predict(factor, steps, which)
        if predicted is None:
            return None
        errors, cost = predicted
        near = min(self.usable(), key=lambda result: _distance(result, factor, steps))
        weight = 1.0 - _distance(near, factor, steps) / NEAR
        if weight > 0.0:
            there, its_cost = self.predict(near.factor, near.steps, which)
            errors = errors * np.clip(getattr(near, which).parts() / np.maximum(there, 1e-12), 0.3, 3.0) ** weight
            cost *= (near.cost / its_cost) ** weight
        return errors, cost

    def _column(self):
        """Results along the meshes at the share of the default step that most of them have, by mesh."""
        return _most(self.usable(), lambda r: round(r.steps / self.default_steps(r.factor), 3), lambda r: r.factor)

    def _row(self):
        """Results along the steps at the mesh that has most of them, by steps."""
        return _most(self.usable(), lambda r: r.factor, lambda r: r.steps)

    def _step_errors(self, steps):
        """(3,) per cent: what the length of the step alone makes."""
        if self._steps_table is None:
            self._steps_table = _step_table(self._row())
        counts, logs, order = self._steps_table
        if len(counts) == 0:
            return np.zeros(3)
        x = math.log(steps)
        nearest = min(max(x, counts[0]), counts[-1])
        return np.exp([np.interp(nearest, counts, part) - order * (x - nearest) for part in logs.T])

    def _cost_of_steps(self, steps):
        """Cost of a number of steps in a sample at the row's mesh, over that of its fewest."""
        row = self._row()
        if len(row) < 2:
            return float(steps)
        return math.exp(_along(np.log([r.steps for r in row]), np.log([r.cost / row[0].cost for r in row]), math.log(steps)))


def _step_table(row):
    """(log steps (r,), log errors (r, 3), order): Richardson's errors of all but the finest run of a row, and the order that continues them."""
    if len(row) < 2:
        return np.zeros(0), np.zeros((0, 3)), 2.0
    apart = np.array([errors_between(r.tension, row[-1].tension).parts() for r in row[:-1]])
    counts = np.log([r.steps for r in row[:-1]])
    order = 2.0
    if len(counts) > 1:
        slope = -(math.log(max(apart[-1, 1], 1e-9)) - math.log(max(apart[0, 1], 1e-9))) / (counts[-1] - counts[0])
        order = min(max(slope, 1.0), 2.0)
    own = apart / (1.0 - np.exp(-order * (math.log(row[-1].steps) - counts)))[:, None]
    # the error that there is leaves no room for more: what is not the mesh's, which all of the row share
    whole = np.array([result.errors.parts() for result in row])
    room = np.sqrt(whole[:-1] ** 2 - (SHARED * whole.min(axis=0)) ** 2)
    return counts, np.log(np.maximum(np.minimum(own, room), 1e-9)), order


def _most(results, kind, rank):
    """The largest group of results of one kind, by rank."""
    kinds = {}
    for result in results:
        kinds.setdefault(kind(result), []).append(result)
    return sorted(max(kinds.values(), key=len), key=rank) if kinds else []


def _distance(result, factor, steps):
    return abs(math.log(result.factor / factor)) + abs(math.log(result.steps / steps))


def _along(x, y, place):
    """y at `place`: linear between the points, and beyond them along the last two (x ascending)."""
    if len(x) == 1 or x[0] <= place <= x[-1]:
        return float(np.interp(place, x, y))
    a, b = (0, 1) if place < x[0] else (-2, -1)
    return float(y[b] + (y[b] - y[a]) / (x[b] - x[a]) * (place - x[b]))
