"""Static equilibrium by Newton's method, and the stiffness that comes with it.

Tension-only lines, weight and a never adhesive bed have a convex energy: every damped Newton step goes down, and a line search on the
force along the step finds where to stop. The damping (Levenberg-Marquardt, scaled by each node's weight) carries slack parts, which have
no stiffness, and fades as the residual falls.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import splu

from . import catenary
from .bending_tangent import bending_blocks, bending_pattern
from .equations import Equations
from .forces import evaluate_once
from .freedom import Freedom
from .ground import commit_grip, ground_blocks
from .laying import lay, move_to_laid
from .layout import POINT_COUPLED, POINT_FIXED, POINT_RIDING
from .model import LOOSE
from .platform import rotate
from .ropes import build_ropes, rope_statics, settle_creep
from .tangent import balance, fill_tangent, predict_tension, stretch_linearly
from .toppling import direction_of_fall
from .waves import calm

TOLERANCE, ACCEPTABLE = 1e-9, 1e-6  # of the heaviest line's weight: what is asked for, and what will do when nothing finds more
OWN_TENSION_ITERATIONS = 60  # and one more for each segment of the longest line: nodes may leave the bed one by one
DOWNHILL_ITERATIONS = 150
SOFT_STRAINS, SOFT_TOLERANCE = (0.1, 0.01), 1e-4  # under the line's weight; of the weight
FRICTION_GROWTH, LEAST_GROWTH = 2.5, 1.05  # of the friction's stiffness from stage to stage
SOFT_YIELD = 0.1  # of a segment's length: over which the softest friction lets a line slide
LEAST_DAMPING = 1e-13
STIFFNESS_DAMPING = 1e-10  # carries slack parts where the stiffness is read
SMALLEST_SHARE = 0.01  # of a step
LONGEST_MOVE = 0.3  # of the longest line's length, in one step
LARGEST_TURN = 0.5  # rad, of a part in one step
TIPPED = 0.05  # m or rad: how far an equilibrium that topples is pushed
STRAIN_SCALE = 10.0  # a strain of 10 % counts like a force of the line's weight


@dataclass(frozen=True)
class StaticResult:
    """How a static solution ended: iterations, largest out-of-balance force on a node (N), the force asked for (N), converged.

    as_laid: False where friction that remembers does not begin with the lines as they were laid, but where they lie without friction.
    """

    iterations: int
    residual: float
    tolerance: float
    converged: bool
    as_laid: bool = True


class StaticSolver:
    """Work arrays of the static solution of one model."""

    def __init__(self, scene, model):
        n = model.mass.size
        self._bed = None
        self.model = model._replace(stiffness=model.stiffness.copy())  # of ropes: where their tensions stand
        self._slack_strain = np.zeros(n)
        self._no_ropes = build_ropes([])
        self.blocks = np.zeros((n, 3, 3, 3))  # of each node with its left neighbour, itself and its right one
        self.move = np.zeros((3, n))
        self._freedom, self._equations, self._held = None, None, None
        self._pattern = bending_pattern(model.bending)
        clamps = model.clamps.part.size
        self._bent, self._turn, self._axis = np.zeros((self._pattern.rows.size, 3, 3)), np.zeros((clamps, 2, 3, 3)), np.zeros((clamps, 3, 3))
        self.lengths = [line.length for line in scene.lines]
        load = np.abs(model.weight) + np.abs(model.buoyancy)
        tension = model.live * model.stiffness * 1e-6  # a scale where nothing weighs
        self.scale = np.maximum(load, 1e-6 * max(load.max(), tension.max())) / np.maximum(model.length, 1e-6)
        line_weight = max(load[s : s + k + 1].sum() for s, k in zip(model.first_node, model.segments))
        self.weight = max(line_weight, load.max(), tension.max())
        self.tolerance, self.acceptable = TOLERANCE * self.weight, ACCEPTABLE * self.weight

    # -- placing ----------------------------------------------------------------------------------------------------------------------

    def place(self, state, pose, first_guess=True):
        """Put points where the platforms at `pose` (M, 7) carry them, at rest, and (with `first_guess`) lines on their catenaries."""
        model = self.model
        state.pose[:] = pose
        state.twist[:] = 0.0
        state.acceleration_of_platform[:] = 0.0
        halt(state)
        state.wet[:] = 1.0
        calm(state.window_times, state.window)
        if first_guess:
            state.parts[:, :7] = model.rigid.start
        for p, node in enumerate(model.point_node):
            if model.point_kind[p] == POINT_COUPLED:
                own = pose[model.point_platform[p]]
                state.position[:, node] = own[:3] + np.array(rotate(own[3:], model.point_place[p]))
            elif model.point_kind[p] == POINT_FIXED or first_guess and model.point_kind[p] != POINT_RIDING:
                state.position[:, node] = model.point_place[p]
        for c in np.flatnonzero(model.clamps.platform >= 0):
            state.clamp_axis[c] = rotate(pose[model.clamps.platform[c], 3:], model.clamps.axis[c])
        for p in model.rigid.riding:
            part = state.parts[model.rigid.part[p]]
            state.position[:, model.point_node[p]] = part[:3] + np.array(rotate(part[3:7], model.point_place[p]))
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

    def solve(self, state, scratch, quick=False):
        """Newton from the present positions (and tensions); returns a StaticResult. Positions are the best found, velocities zero.

        quick: give up when the first way does not lead there; the positions stay as they were.
        """
        goal, best = self._begin(state, scratch), _Best()
        iterations = self._with_own_tensions(state, scratch, goal, best)
        if best.residual > goal and quick:
            best.take(state, first=True)
            state.settings[7] = 0.0
            return StaticResult(iterations, best.residual, goal, False)
        if best.residual > goal and (state.grip[3:] >= 0.0).any():
            best.take(state, first=True)
            iterations += self._mobilise(state, scratch, goal, best)
        elif best.residual > goal:
            iterations += self._by_softening(state, scratch, goal, best)
        return self._end(state, scratch, iterations, goal, best)

    def pull_tight(self, state, scratch):
        """From a solution without friction to the one with friction that remembers, the lines pulled tight from where they were laid."""
        goal, best = self._begin(state, scratch), _Best()
        self._evaluate(state, scratch)
        lay(self.model.ground, self.model, state.end_point, state.position, state.grip)
        move_to_laid(self.model, self._bed, state.position, state.grip)
        iterations = self._mobilise(state, scratch, goal, best)
        return self._end(state, scratch, iterations, goal, best)

    def _begin(self, state, scratch):
        """Everything at rest and ready; returns the force asked for (N)."""
        if self._held is None or (self._held != state.end_point).any():
            self._freedom, self._held = Freedom(self.model, state), state.end_point.copy()
            self._equations = Equations(self.model, self._freedom, self._pattern, self.weight)
        self._bed = scratch.bed
        state.settings[:6] = (0.0, 0.0, 1.0, 1.0, 0.0, np.inf)
        state.settings[7], state.settings[8:] = 1.0, 0.0
        state.bed_relief[:] = 1.0
        return max(self.tolerance, self._rounding(state))

    def _end(self, state, scratch, iterations, goal, best):
        best.take(state)
        residual = self._evaluate(state, scratch)
        settle_creep(self.model.ropes, state.tension, state.creep)
        state.settings[7] = 0.0
        return StaticResult(iterations, residual, goal, bool(residual <= goal))

    def hold_on(self, state):
        """Let the nodes hold on to the bed where they are, as far as friction goes; after `solve`."""
        model = self.model
        commit_grip(
            model.ground, model.size, state.position, state.velocity, state.tangent, model.bed_stiffness, model.bed_damping, self._bed, state.grip
        )

    def _with_own_tensions(self, state, scratch, goal, best):
        """Newton with tensions as unknowns of their own: quick for stiff lines, where a small move makes a large force.

        Eliminated from the linear system, they leave its matrix as it is, but with the tension predicted by the last step in place of that
        of the present strain; a segment goes slack when its predicted tension does.
        """
        tension, predicted = state.tension.copy(), np.zeros_like(state.tension)
        damping, rejected = 1e-3, 0
        most = OWN_TENSION_ITERATIONS + int(self.model.segments.max())
        merit = self._merit(state, scratch, tension)
        for iteration in range(1, most + 1):
            residual = self._residual(state)
            best.keep(residual, state)
            if residual <= goal:
                return iteration - 1
            stretch_linearly(self.model, state, self._slack_strain, tension)
            step = self._step(state, damping)
            if step is None:
                return iteration
            predict_tension(self.model, state, self._slack_strain, self.move, predicted)
            share, merit = self._search_with_tensions(state, scratch, step, tension, predicted, merit)
            damping = max(0.1 * damping, LEAST_DAMPING) if share == 1.0 else min(10.0 * damping, 1.0) if share < 0.2 else damping
            rejected = rejected + 1 if share < SMALLEST_SHARE else 0
            if rejected > 8:
                return iteration
        return most

    def _search_with_tensions(self, state, scratch, step, tension, predicted, merit):
        """Halve the step until positions and tensions together are better balanced; returns (share, merit) and leaves them there."""
        start, old = _configuration(state), tension.copy()
        share = 1.0
        while True:
            self._freedom.put(state, start, step, share)
            tension[:] = old + share * (predicted - old)
            new = self._merit(state, scratch, tension)
            if new <= (1.0 - 0.1 * share) * merit or share < SMALLEST_SHARE:
                return share, new
            share *= 0.5

    def _merit(self, state, scratch, tension):
        """Forces out of balance with tensions of their own, over the weight, and the strains that these tensions miss, in one norm."""
        _evaluate_at_rest(self.model, state, scratch)
        rope_statics(self.model.ropes, tension, self.model.stiffness, self._slack_strain)
        missed = balance(self.model, state, self._slack_strain, tension, self.move)
        force = self._sizes(state, self.move) / self.weight
        return float(np.hypot(np.sqrt((force**2).sum()), STRAIN_SCALE * missed))

    def _mobilise(self, state, scratch, goal, best):
        """Friction that remembers, soft at first, so that all slide over a share of a segment, and stiffer from stage to stage.

        Friction is mobilised within less than a millimetre: from farther away Newton sees nothing but sliding nodes.
        """
        full, last = self.model, None
        stiffest, ratio, growth, iterations = full.ground.stiffness_ratio, self._softest_friction(), FRICTION_GROWTH, 0
        try:
            while True:
                self.model = full._replace(ground=full.ground._replace(stiffness_ratio=float(ratio)))
                stage, wanted = (best, goal) if ratio == stiffest else (_Best(), SOFT_TOLERANCE * self.weight)
                self._evaluate(state, scratch)
                iterations += self._with_own_tensions(state, scratch, wanted, stage)
                if stage.residual > wanted and last is None:
                    iterations += self._by_softening(state, scratch, wanted, stage)
                if stage.residual <= wanted:
                    stage.take(state)
                    self._evaluate(state, scratch)
                    last = ratio, _configuration(state), state.tension.copy()
                elif last is None or growth < LEAST_GROWTH:
                    best.keep(np.inf, state)
                    return iterations
                else:
                    growth = np.sqrt(growth)
                    (state.position[:], state.parts[:]), state.tension[:] = last[1:]
                if last[0] == stiffest:
                    return iterations
                ratio = min(last[0] * growth, stiffest)
        finally:
            self.model = full

    def _softest_friction(self):
        """Tangential over normal stiffness of the bed with which lines slide over SOFT_YIELD."""
        model, ground = self.model, self.model.ground
        lying = np.flatnonzero((model.bed_stiffness * (model.share_left + model.share_right) > 0.0) & (model.mass > 0.0))
        if not lying.size:
            return ground.stiffness_ratio
        friction = max(ground.kinetic_axial, ground.kinetic_across) * np.abs(model.weight[lying] - model.buoyancy[lying])
        softest = (friction / (model.bed_stiffness[lying] * SOFT_YIELD * np.maximum(model.length[lying], model.length[lying + 1]))).max()
        return min(max(softest, 1e-6 * ground.stiffness_ratio), ground.stiffness_ratio)

    def _by_softening(self, state, scratch, goal, best):
        """Downhill with lines soft enough to move far, then stiffened stage by stage: each finds the next one's shape and tensions."""
        stiff = self.model
        best.take(state, first=True)
        iterations = 0
        try:
            for strain in SOFT_STRAINS:
                soft = np.minimum(stiff.stiffness, self.weight / strain)
                self.model = stiff._replace(stiffness=np.where(stiff.live > 0.0, soft, 0.0), ropes=self._no_ropes)
                self._slack_strain[:] = 0.0
                stage = _Best()
                iterations += self._downhill(state, scratch, SOFT_TOLERANCE * self.weight, stage)
                stage.take(state)
                self._evaluate(state, scratch)
                iterations += self._with_own_tensions(state, scratch, SOFT_TOLERANCE * self.weight, stage)
                stage.take(state)
                self._evaluate(state, scratch)
        finally:
            self.model = stiff
        iterations += self._with_own_tensions(state, scratch, goal, best)
        if best.residual > goal:
            best.take(state)
            iterations += self._downhill(state, scratch, goal, best)
        return iterations

    def _downhill(self, state, scratch, goal, best):
        """Damped Newton with a line search from the present positions: slow and sure."""
        residual = self._evaluate(state, scratch)
        best.keep(residual, state)
        damping = 1.0
        for iteration in range(1, DOWNHILL_ITERATIONS + 1):
            if best.residual <= goal:
                return iteration - 1
            step = self._step(state, damping)
            if step is None:
                damping = max(damping, 1e-10) * 100.0
                continue
            share, residual = self._search(state, scratch, step)
            damping = max(damping * (0.1 if share >= 1.0 else 0.5 if share > 0.3 else 3.0), LEAST_DAMPING)
            best.keep(residual, state)
        return DOWNHILL_ITERATIONS

    def _rounding(self, state):
        """The force that rounding of the positions alone makes in the stiffest segment or bed spring (N)."""
        model = self.model
        bed = model.bed_stiffness.max() * (model.ground.stiffness_ratio if state.grip.size else 1.0)
        stiffest = max((model.live * model.stiffness * model.inverse_length).max(), bed)
        return 16.0 * stiffest * np.finfo(float).eps * max(np.abs(state.position).max(), 1.0)

    def _evaluate(self, state, scratch):
        _evaluate_at_rest(self.model, state, scratch)
        return self._residual(state)

    def _residual(self, state):
        return float(self._sizes(state, state.force).max(initial=0.0))

    def _sizes(self, state, force):
        """Norms (N) of the nodes' forces (3, n) on everything that may move."""
        return self._freedom.sizes(state, self._load(state, force))

    def _load(self, state, force):
        return self._freedom.forces(state, force)

    def _step(self, state, damping):
        """Newton step of the unknowns, shortened where it goes far, with the nodes' moves in self.move; None when the system is singular."""
        free = self._freedom
        step = self._equations.solve(free.forces(state, state.force), state, *self._stiffness(state, damping))
        if step is None:
            return None
        free.moves(state, step, self.move)
        farthest = np.sqrt((self.move**2).sum(axis=0).max())
        share = min(LONGEST_MOVE * max(self.lengths) / max(farthest, 1e-300), 1.0)
        turns = step[free.own :].reshape(-1, 6)[:, 3:]
        share = min(share, LARGEST_TURN / max(np.sqrt((turns**2).sum(axis=1)).max(initial=0.0), 1e-300))
        step *= share
        self.move *= share
        return step

    def _stiffness(self, state, damping):
        """Blocks of the stiffness for Equations, damped."""
        model = self.model
        fill_tangent(model, state, self.blocks)
        if model.ground.on:
            ground_blocks(model.ground, model.size, state.position, state.tangent, model.bed_stiffness, self._bed, state.grip, self.blocks[:, 1])
        for k in range(3):
            self.blocks[:, 1, k, k] += damping * self.scale
        if model.bending.stiffness.size:
            bending_blocks(
                model.bending, self._pattern, state.position, state.tangent, model.length, state.end_point, state.clamp_axis, self._bent, self._turn,
                self._axis,
            )  # fmt: skip
        return self.blocks, self._bent, self._turn, self._axis

    def _search(self, state, scratch, step):
        """Go along `step` to where the force along it has all but vanished. Returns (share of the step, residual)."""
        start = _configuration(state)
        slope0 = float(self._load(state, state.force) @ step)
        low, high, share = 0.0, None, 1.0
        slope_low = slope0
        for _ in range(30):
            self._freedom.put(state, start, step, share)
            residual = self._evaluate(state, scratch)
            slope = float(self._load(state, state.force) @ step)
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

    def falls(self, state, scratch):
        """Step (count,) of the unknowns, its largest entry 1 m or rad, along which an equilibrium without friction topples, or None where it stands."""
        if not (self._freedom.parts or self._pattern.rows.size or self.model.ground.grid.x.size):
            return None  # lines that only pull stand wherever they hang
        state.settings[7] = 1.0
        _evaluate_at_rest(self.model, state, scratch)
        rope_statics(self.model.ropes, state.tension, self.model.stiffness, self._slack_strain)
        stiffness = self._equations.matrix(state, *self._stiffness(state, 0.0))
        state.settings[7] = 0.0
        return direction_of_fall(stiffness, np.full(self._freedom.count, self.weight / max(self.lengths)))

    def tip(self, state, step):
        """Move everything by `step` (count,) times TIPPED."""
        self._freedom.put(state, _configuration(state), step, TIPPED)

    def platform_stiffness(self, state, scratch):
        """(6 M, 6 M) minus the change of the wrenches with the poses at an equilibrium in `state`; rotations about the world axes."""
        free = self._freedom
        held = np.arange(free.count, free.count + 6 * self.model.reach.size)
        if not self.model.coupled_points.size:
            return np.zeros((held.size, held.size))
        state.settings[7] = 1.0
        _evaluate_at_rest(self.model, state, scratch)
        rope_statics(self.model.ropes, state.tension, self.model.stiffness, self._slack_strain)
        equations = Equations(self.model, free, self._pattern, self.weight, platform=True)
        total = equations.matrix(state, *self._stiffness(state, STIFFNESS_DAMPING))
        kept = np.flatnonzero(np.repeat(free.kept, 3))
        own = total[held][:, held].toarray()
        if not kept.size:
            return own
        factors = splu(total[kept][:, kept].tocsc())
        # column by column: all at once takes ten times as long for a hundred of them
        moves = np.column_stack([factors.solve(column) for column in total[kept][:, held].toarray().T])
        return own - total[held][:, kept] @ moves


class _Best:
    """The configuration with the least residual so far, and the first one."""

    def __init__(self):
        self.residual, self._best, self._first = np.inf, None, None

    def keep(self, residual, state):
        if self._first is None:
            self._first = _configuration(state)
        if self._best is None or residual < self.residual:
            self.residual, self._best = residual, _configuration(state)

    def take(self, state, first=False):
        """Put `state` there."""
        state.position[:], state.parts[:] = self._first if first else self._best


def halt(state):
    """Stop everything that moves."""
    state.velocity[:] = 0.0
    state.expected[:] = 0.0
    state.lead[:] = 0.0
    state.parts[:, 7:] = 0.0


def _configuration(state):
    return state.position.copy(), state.parts.copy()


def _evaluate_at_rest(model, state, scratch):
    evaluate_once(model, state, scratch, 0.0, 0.0, True)
