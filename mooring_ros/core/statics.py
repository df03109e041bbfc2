"""Static equilibrium by Newton's method, lines eliminated onto their ends, and the stiffness that comes with it.

Tension-only lines, weight and a never adhesive bed have a convex energy: every damped Newton step goes down, and a line search on the
force along the step finds where to stop. The damping (Levenberg-Marquardt, scaled by each node's weight) carries slack parts, which have
no stiffness, and fades as the residual falls.
"""

from dataclasses import dataclass

import numpy as np

from . import catenary
from .condense import condense_lines, spread
from .forces import evaluate_once
from .model import LOOSE, POINT_COUPLED, POINT_FIXED
from .platform import rotate
from .tangent import balance, fill_tangent, predict_tension, stretch_linearly

TOLERANCE, ACCEPTABLE = 1e-9, 1e-6  # of the heaviest line's weight: what is asked for, and what will do when nothing finds more
OWN_TENSION_ITERATIONS = 60  # and one more for each segment of the longest line: nodes may leave the bed one by one
DOWNHILL_ITERATIONS = 150
SOFT_STRAINS, SOFT_TOLERANCE = (0.1, 0.01), 1e-4  # under the line's weight; of the weight
LEAST_DAMPING = 1e-13
STIFFNESS_DAMPING = 1e-10  # carries slack parts where the stiffness is read
SMALLEST_SHARE = 0.01  # of a step
LONGEST_MOVE = 0.3  # of the longest line's length, in one step
STRAIN_SCALE = 10.0  # a strain of 10 % counts like a force of the line's weight


@dataclass(frozen=True)
class StaticResult:
    """How a static solution ended: iterations, largest out-of-balance force on a node (N), the force asked for (N), converged."""

    iterations: int
    residual: float
    tolerance: float
    converged: bool


class StaticSolver:
    """Work arrays of the static solution of one model."""

    def __init__(self, scene, model):
        n, lines = model.mass.size, len(model.first_node)
        self.model = model
        self.diagonal, self.above, self.below = np.zeros((n, 3, 3)), np.zeros((n, 3, 3)), np.zeros((n, 3, 3))
        self.c, self.a, self.g = np.zeros((n, 3, 3)), np.zeros((n, 3, 3)), np.zeros((n, 3))
        self.ends, self.end_load = np.zeros((lines, 2, 2, 3, 3)), np.zeros((lines, 2, 3))
        self.work = np.zeros((6, 3, 3))
        self.move = np.zeros((3, n))
        self.end_move = np.zeros((2 * lines, 3))
        self.lengths = [line.length for line in scene.lines]
        load = np.abs(model.weight) + np.abs(model.buoyancy)
        tension = model.live * model.stiffness * 1e-6  # a scale where nothing weighs
        self.scale = np.maximum(load, 1e-6 * max(load.max(), tension.max())) / np.maximum(model.length, 1e-6)
        line_weight = max(load[s : s + k + 1].sum() for s, k in zip(model.first_node, model.segments))
        self.weight = max(line_weight, load.max(), tension.max())
        self.tolerance, self.acceptable = TOLERANCE * self.weight, ACCEPTABLE * self.weight

    # -- placing ----------------------------------------------------------------------------------------------------------------------

    def place(self, state, pose, first_guess=True):
        """Put points where `pose` (7,) carries them, at rest, and (with `first_guess`) lines on their catenaries."""
        model = self.model
        state.pose[:] = pose
        state.twist[:] = 0.0
        state.acceleration_of_platform[:] = 0.0
        state.velocity[:] = 0.0
        state.wet[:] = 1.0
        for p, node in enumerate(model.point_node):
            if model.point_kind[p] == POINT_COUPLED:
                state.position[:, node] = pose[:3] + np.array(rotate(pose[3:], model.point_place[p]))
            elif first_guess or model.point_kind[p] == POINT_FIXED:
                state.position[:, node] = model.point_place[p]
        if not first_guess:
            return
        for line, (start, count) in enumerate(zip(model.first_node, model.segments)):
            held = [state.end_point[2 * line + end] for end in (0, 1)]
            a, b = (state.position[:, model.point_node[p]] if p != LOOSE else None for p in held)
            a, b = self._loose_ends(line, a, b)
            weight, level = self._weight_and_level(line, 0.5 * (a[2] + b[2]) > 0.0)
            shape, tension = catenary.guess(a, b, self.lengths[line], count + 1, weight, model.stiffness[start + 1], level)
            state.position[:, start : start + count + 1] = shape
            state.tension[start + 1 : start + count + 1] = 0.5 * (tension[1:] + tension[:-1])

    def _weight_and_level(self, line, in_air):
        """Weight (N/m) that shapes a line, and the z (m) at which the bed, or the water's surface, holds it."""
        model, node = self.model, self.model.first_node[line]
        lumped = 0.5 * model.length[node + 1]
        weight, buoyancy = model.weight[node] / lumped, model.buoyancy[node] / lumped
        if weight >= buoyancy or in_air:
            submerged = weight if in_air else weight - buoyancy
            carried = model.bed_stiffness[node] / lumped  # N/m for each metre
            return submerged, model.bed_level - submerged / carried if carried > 0.0 else -np.inf
        return weight - buoyancy, (0.5 - weight / buoyancy) * model.diameter[node + 1]

    def _loose_ends(self, line, a, b):
        """A line let go of hangs straight down from its other end, or lies on the bed."""
        held = a if b is None else b
        fallen = held.copy()
        fallen[2] = max(held[2] - self.lengths[line], self.model.bed_level)
        fallen[0] += self.lengths[line] - (held[2] - fallen[2])
        return (fallen if a is None else a), (fallen if b is None else b)

    # -- solving ----------------------------------------------------------------------------------------------------------------------

    def solve(self, state, scratch):
        """Newton from the present positions (and tensions); returns a StaticResult. Positions are the best found, velocities zero."""
        free = _free_rows(self.model, state)
        state.settings[:] = (0.0, 0.0, 1.0, 1.0, 0.0, np.inf)
        state.bed_relief[:] = 1.0
        goal = max(self.tolerance, self._rounding(state))
        best = _Best()
        iterations = self._with_own_tensions(state, scratch, free, goal, best)
        if best.residual > goal:
            iterations += self._by_softening(state, scratch, free, goal, best)
        state.position[:] = best.position
        residual = self._evaluate(state, scratch, free)
        return StaticResult(iterations, residual, goal, bool(residual <= goal))

    def _with_own_tensions(self, state, scratch, free, goal, best):
        """Newton with tensions as unknowns of their own: quick for stiff lines, where a small move makes a large force.

        Eliminated from the linear system, they leave its matrix as it is, but with the tension predicted by the last step in place of that
        of the present strain; a segment goes slack when its predicted tension does.
        """
        tension, predicted = state.tension.copy(), np.zeros_like(state.tension)
        damping, rejected = 1e-3, 0
        most = OWN_TENSION_ITERATIONS + int(self.model.segments.max())
        merit = self._merit(state, scratch, tension, free)
        for iteration in range(1, most + 1):
            residual = self._residual(state, free)
            best.keep(residual, state)
            if residual <= goal:
                return iteration - 1
            stretch_linearly(self.model, state, tension)
            step = self._step(state, damping)
            if step is None:
                return iteration
            self._shorten(step)
            predict_tension(self.model, state, step, predicted)
            share, merit = self._search_with_tensions(state, scratch, step, tension, predicted, merit, free)
            damping = max(0.1 * damping, LEAST_DAMPING) if share == 1.0 else min(10.0 * damping, 1.0) if share < 0.2 else damping
            rejected = rejected + 1 if share < SMALLEST_SHARE else 0
            if rejected > 8:
                return iteration
        return most

    def _search_with_tensions(self, state, scratch, step, tension, predicted, merit, free):
        """Halve the step until positions and tensions together are better balanced; returns (share, merit) and leaves them there."""
        start, old = state.position.copy(), tension.copy()
        share = 1.0
        while True:
            state.position[:] = start + share * step
            tension[:] = old + share * (predicted - old)
            new = self._merit(state, scratch, tension, free)
            if new <= (1.0 - 0.1 * share) * merit or share < SMALLEST_SHARE:
                return share, new
            share *= 0.5

    def _merit(self, state, scratch, tension, free):
        """Forces out of balance with tensions of their own, over the weight, and the strains that these tensions miss, in one norm."""
        _evaluate_at_rest(self.model, state, scratch)
        missed = balance(self.model, state, tension, self.move)
        force = _gathered(self.model, state, self.move)[:, free] / self.weight
        return float(np.hypot(np.sqrt((force**2).sum()), STRAIN_SCALE * missed))

    def _shorten(self, step):
        """Keep the longest move below a share of the lines' length."""
        step *= min(LONGEST_MOVE * max(self.lengths) / max(np.sqrt((step**2).sum(axis=0).max()), 1e-300), 1.0)

    def _by_softening(self, state, scratch, free, goal, best):
        """Downhill with lines soft enough to move far, then stiffened stage by stage: each finds the next one's shape and tensions."""
        stiff = self.model
        state.position[:] = best.start
        iterations = 0
        try:
            for strain in SOFT_STRAINS:
                soft = np.minimum(stiff.stiffness, self.weight / strain)
                self.model = stiff._replace(stiffness=np.where(stiff.live > 0.0, soft, 0.0))
                stage = _Best()
                iterations += self._downhill(state, scratch, free, SOFT_TOLERANCE * self.weight, stage)
                state.position[:] = stage.position
                self._evaluate(state, scratch, free)
                iterations += self._with_own_tensions(state, scratch, free, SOFT_TOLERANCE * self.weight, stage)
                state.position[:] = stage.position
                self._evaluate(state, scratch, free)
        finally:
            self.model = stiff
        iterations += self._with_own_tensions(state, scratch, free, goal, best)
        if best.residual > goal:
            state.position[:] = best.position
            iterations += self._downhill(state, scratch, free, goal, best)
        return iterations

    def _downhill(self, state, scratch, free, goal, best):
        """Damped Newton with a line search from the present positions: slow and sure."""
        residual = self._evaluate(state, scratch, free)
        best.keep(residual, state)
        damping = 1.0
        for iteration in range(1, DOWNHILL_ITERATIONS + 1):
            if best.residual <= goal:
                return iteration - 1
            step = self._step(state, damping)
            if step is None:
                damping = max(damping, 1e-10) * 100.0
                continue
            self._shorten(step)
            share, residual = self._search(state, scratch, step, free)
            damping = max(damping * (0.1 if share >= 1.0 else 0.5 if share > 0.3 else 3.0), LEAST_DAMPING)
            best.keep(residual, state)
        return DOWNHILL_ITERATIONS

    def _rounding(self, state):
        """The force that rounding of the positions alone makes in the stiffest segment or bed spring (N)."""
        model = self.model
        stiffest = max((model.live * model.stiffness * model.inverse_length).max(), model.bed_stiffness.max())
        return 16.0 * stiffest * np.finfo(float).eps * max(np.abs(state.position).max(), 1.0)

    def _evaluate(self, state, scratch, free):
        _evaluate_at_rest(self.model, state, scratch)
        return self._residual(state, free)

    def _residual(self, state, free):
        return float(np.sqrt((_gathered(self.model, state, state.force)[:, free] ** 2).sum(axis=0).max(initial=0.0)))

    def _step(self, state, damping):
        """Newton step (3, n) of the nodes, or None when the system is singular."""
        model = self.model
        points = self._condensed_tangent(state, damping)
        if points is None:
            return None
        stiffness, load = points
        solved = _free_dofs(model)
        x = np.zeros(load.size)
        if solved.size:
            try:
                x[solved] = np.linalg.solve(stiffness[np.ix_(solved, solved)], load[solved])
            except np.linalg.LinAlgError:
                return None
        x = x.reshape(-1, 3)
        self._move_ends(state, x)
        self.move[:] = 0.0
        spread(model, self.c, self.a, self.g, self.end_move, self.move)
        self.move[:, model.point_node] = x.T
        return self.move.copy() if np.isfinite(self.move).all() else None

    def _condensed_tangent(self, state, damping):
        """(3P, 3P) damped stiffness between all points and (3P,) loads on them, lines eliminated; None when singular."""
        model = self.model
        fill_tangent(model, state, self.diagonal, self.above, self.below)
        for k in range(3):
            self.diagonal[:, k, k] += damping * self.scale
        if not condense_lines(
            model, self.diagonal, self.above, self.below, state.force, self.c, self.a, self.g, self.ends, self.end_load, self.work
        ):
            return None
        count = len(model.point_node)
        stiffness, load = np.zeros((count, 3, count, 3)), np.zeros((count, 3))
        for p, node in enumerate(model.point_node):
            stiffness[p, :, p] += self.diagonal[node]
            load[p] += state.force[:, node]
        for line in range(len(model.first_node)):
            ends, end_load = self.ends[line], self.end_load[line]
            held = [state.end_point[2 * line], state.end_point[2 * line + 1]]
            ends, end_load = _without_loose(ends, end_load, held)
            for i, p in enumerate(held):
                if p == LOOSE:
                    continue
                load[p] += end_load[i]
                for j, r in enumerate(held):
                    if r != LOOSE:
                        stiffness[p, :, r] += ends[i, j]
        return stiffness.reshape(3 * count, 3 * count), load.reshape(-1)

    def _move_ends(self, state, x):
        """Moves of the lines' ends from those of the points, x (P, 3); a loose end follows its own row."""
        for e, p in enumerate(state.end_point):
            if p != LOOSE:
                self.end_move[e] = x[p]
        for e, p in enumerate(state.end_point):
            if p == LOOSE:
                line, end = divmod(e, 2)
                other = self.end_move[2 * line + 1 - end]
                own = self.ends[line, end, end]
                self.end_move[e] = np.linalg.solve(own, self.end_load[line, end] - self.ends[line, end, 1 - end] @ other)

    def _search(self, state, scratch, step, free):
        """Go along `step` to where the force along it has all but vanished. Returns (share of the step, residual)."""
        start = state.position.copy()
        slope0 = float((state.force * step).sum())
        low, high, share = 0.0, None, 1.0
        slope_low = slope0
        for _ in range(30):
            state.position[:] = start + share * step
            residual = self._evaluate(state, scratch, free)
            slope = float((state.force * step).sum())
            if slope >= -0.3 * abs(slope0) and (high is not None or slope <= 0.9 * abs(slope0) or share >= 1.0):
                break
            if slope < 0.0:
                high, slope_high = share, slope
            else:
                low, slope_low = share, slope
            if high is None:
                break
            guess = low + (high - low) * (slope_low / (slope_low - slope_high) if slope_low > slope_high else 0.5)
            share = min(max(guess, low + 0.02 * (high - low)), high - 0.1 * (high - low))
        return share, residual

    # -- stiffness --------------------------------------------------------------------------------------------------------------------

    def platform_stiffness(self, state, scratch):
        """(6, 6) minus the change of the wrench with the pose at an equilibrium in `state`; rotations about the world axes."""
        model = self.model
        if not model.coupled_points.size:
            return np.zeros((6, 6))
        _evaluate_at_rest(model, state, scratch)
        stiffness, _ = self._condensed_tangent(state, STIFFNESS_DAMPING)
        free = _free_dofs(model)
        held = np.concatenate([np.arange(3 * p, 3 * p + 3) for p in model.coupled_points])
        reduced = stiffness[np.ix_(held, held)]
        if free.size:
            coupling = stiffness[np.ix_(held, free)]
            reduced = reduced - coupling @ np.linalg.solve(stiffness[np.ix_(free, free)], stiffness[np.ix_(free, held)])
        arms = [state.position[:, model.point_node[p]] - state.pose[:3] for p in model.coupled_points]
        rigid = np.concatenate([np.hstack([np.eye(3), -_skew(arm)]) for arm in arms])
        total = rigid.T @ reduced @ rigid
        forces = point_forces(model, state)[model.coupled_points]
        for arm, force in zip(arms, forces):
            # the arms turn with the platform while the forces stay: d(r x F) = (d theta x r) x F
            total[3:, 3:] -= _skew(force) @ _skew(arm)
        return total


class _Best:
    """The positions with the least residual so far, and the first ones."""

    def __init__(self):
        self.residual, self.position, self.start = np.inf, None, None

    def keep(self, residual, state):
        if self.start is None:
            self.start = state.position.copy()
        if self.position is None or residual < self.residual:
            self.residual, self.position = residual, state.position.copy()


def point_forces(model, state):
    """(P, 3) static forces on the points: those on their own node and on the ends they hold."""
    forces = state.force[:, model.point_node].T.copy()
    for e, p in enumerate(state.end_point):
        if p != LOOSE:
            forces[p] += state.force[:, model.end_node[e]]
    return forces


def _skew(v):
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def _evaluate_at_rest(model, state, scratch):
    evaluate_once(model, state, scratch, 0.0, 0.0, True)


def _free_rows(model, state):
    """(n,) mask of the nodes that must be in balance: interior nodes, loose ends and free points."""
    rows = np.zeros(model.mass.size, dtype=bool)
    for start, count in zip(model.first_node, model.segments):
        rows[start + 1 : start + count] = True
    for e, p in enumerate(state.end_point):
        rows[model.end_node[e]] = p == LOOSE
    rows[model.point_node[model.free_points]] = True
    return rows


def _gathered(model, state, force):
    """(3, n) forces with those of held ends added to their points."""
    gathered = force.copy()
    for e, p in enumerate(state.end_point):
        if p != LOOSE:
            gathered[:, model.point_node[p]] += force[:, model.end_node[e]]
    return gathered


def _free_dofs(model):
    return np.concatenate([np.arange(3 * p, 3 * p + 3) for p in model.free_points]) if model.free_points.size else np.zeros(0, dtype=int)


def _without_loose(ends, end_load, held):
    """Eliminate a loose end onto the other one."""
    if LOOSE not in held:
        return ends, end_load
    loose = held.index(LOOSE)
    other = 1 - loose
    ends, end_load = ends.copy(), end_load.copy()
    factor = ends[other, loose] @ np.linalg.inv(ends[loose, loose])
    ends[other, other] -= factor @ ends[loose, other]
    end_load[other] -= factor @ end_load[loose]
    return ends, end_load
