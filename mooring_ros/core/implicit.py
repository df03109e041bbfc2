"""Implicit time stepping over one interval between two samples of the platform's motion: generalised-alpha with Newton's method.

Steps are as long as the motion, the curves of the lines and the waves across them allow; axial waves, internal damping, bending and the bed's
stiffness do not limit them. A step whose forces do not come to balance, or in which tensions jump or bend, is taken in two halves, down to FINEST
(implicit_control.py: less for tensions), and the finer step is kept for a while. So a step costs at most
FINEST * (1 + MOST_ITERATIONS * (1 + SEARCHES)) evaluations.
"""

from dataclasses import replace

import numpy as np

from .cache import kernel, paragraph, routine, stage
from .explicit import DONE, MOST_STEPS, OVERSTRETCHED, RUNAWAY, SURFACE_MARGIN, LIKELY_SPEED, TOO_FAST, TOO_LONG
from .explicit import look_at_surface, remember_grip
from .failures import part
from .forces import evaluate_in_place
from .guard import EVEN, FASTEST, IMPLAUSIBLE, copy_row, copy_rows, keep_tension, overstretched, recall, runaway, save, speed_of_ends, tension_jumped
from .implicit_control import BENT, BENT_PIECES, CALM, SUDDEN, calm_step, jumps_may_be_finer, keep_rate, passing_of_waves, tension_bent
from .implicit_gates import forget_landings
from .implicit_newton import LOOSE, NEWTON_DONE, TOLERANCE, Work, balance_step, keep_start, return_to_start, scheme_of
from .implicit_parts import share_accelerations
from .implicit_plan import make_topology
from .packed import entry
from .platforms import average_acceleration, end_interval, recall_acceleration, start_motions
from .readings import show
from .stability import nothing_damps
from .surface import all_wet
from .waves import copy_window, outdated, refresh

PARTED = 16  # status besides those of explicit.py: lines have parted, the equations must be listed again
FINEST = 256  # parts of a step that are tried
KEPT = 8  # steps for which a finer step is kept
SPECTRAL_RADIUS = 0.6
LONGEST, STEPS_A_SWING = 0.05, 50.0  # s; of the step that is taken when none is given
UNDAMPED = 0.1  # of it where no water takes the waves across the lines away
HARD_BED, ON_HARD_BED = 2e-3, 0.5  # s, of StepLimit's bed damping: below, what lands stops at once and the line rings; the step is so much shorter there
SMOOTHING = 1e-3  # s: samples closer than this share one mean acceleration
LEAST_STRAIN = 1e-9
ROUNDING = 16.0 * np.finfo(float).eps


@routine
def save_accelerations(state, work):
    copy_rows(state.acceleration, work.saved[0])
    copy_rows(state.filtered, work.saved[1])
    copy_rows(state.parts_acceleration, work.saved_parts[0])
    copy_rows(state.parts_filtered, work.saved_parts[1])
    copy_row(state.tension_rate, work.saved_rate)


@routine
def recall_accelerations(state, work):
    copy_rows(work.saved[0], state.acceleration)
    copy_rows(work.saved[1], state.filtered)
    copy_rows(work.saved_parts[0], state.parts_acceleration)
    copy_rows(work.saved_parts[1], state.parts_filtered)
    copy_row(work.saved_rate, state.tension_rate)


@routine
def recall_start_accelerations(state, work):
    """A jump of the forces is for the next step to answer: accelerations of its first moment tell nothing of it."""
    copy_rows(work.moved[2], state.acceleration)
    copy_rows(work.parts_moved[0], state.parts_acceleration)


@stage
def coarsest(at, pieces):
    """Whether a step of twice the length, FINEST parts in all, can begin at part `at`."""
    return at % (2 * pieces) == 0 and 2 * pieces <= FINEST


@paragraph
def take_step(model, state, scratch, plan, work, scheme, h, start, share, fastest, passing, report):
    """One step of h (s), `share` of the interval, in pieces where it must be. Returns False when the finest one does not come near a balance.

    passing (s): see `passing_of_waves`.
    """
    settings = state.settings
    pieces = FINEST // int(settings[3])
    at, good = 0, True
    while at < FINEST:
        keep_start(model, state, work)
        keep_tension(model, state, scratch)
        piece = h * pieces / FINEST
        end = start + share * (at + pieces) / FINEST
        settings[6] = state.clock[0] + end * scratch.motion[0, 7, 0]
        tolerance = LOOSE if pieces == 1 else TOLERANCE
        status, iterations, evaluations = balance_step(model, state, scratch, plan, work, scheme, piece, end, tolerance)
        report[0] += evaluations
        jumped = tension_jumped(model, state, scratch, SUDDEN) != EVEN
        bent = tension_bent(model, state, scratch, piece, BENT)
        coarse = jumped and jumps_may_be_finer(FINEST // pieces, piece, passing) or bent and FINEST // pieces < BENT_PIECES
        if status == NEWTON_DONE and not coarse and not runaway(model, state, fastest):
            at += pieces
            calm = tension_jumped(model, state, scratch, CALM * SUDDEN) == EVEN and not tension_bent(model, state, scratch, piece, CALM**2 * BENT)
            keep_rate(model, state, scratch, piece)
            report[1] += 1.0
            report[3] = min(report[3], piece)
            report[4] += 1.0 if jumped else 0.0
            forget_landings(model, state, scratch.bed, work.touched, work.moved[0], piece)
            share_accelerations(model, state)
            if state.grip.shape[1] > 0:
                remember_grip(model, state, scratch)
            settings[4] += 1.0
            if settings[4] >= KEPT and coarsest(at, pieces) and calm:
                pieces, settings[4] = 2 * pieces, 0.0
        else:
            return_to_start(model, state, work)
            copy_row(scratch.tension, state.tension)
            report[2] += 1.0
            settings[4] = 0.0
            if pieces == 1:
                good = False
                break
            pieces //= 2
    settings[3] = FINEST // pieces
    return good


@paragraph
def advance(model, state, scratch, plan, work, scheme, longest, passing, time, poses, twists, progress, report):
    """Advance `state` to `time` (s), where the platforms have poses (M, 7) and twists (M, 6), in steps of at most `longest` (s). Returns a status code.

    A refused interval leaves the state as it was. `report` (5,) gets evaluations, pieces of steps, those taken again, the shortest (s), and those in
    which tensions jump however short they are.
    `progress` (1,): steps done when PARTED is returned; called again with other equations, the interval is gone on with, or ended.
    """
    duration = time - state.clock[0]
    start_motions(state, poses, twists, duration, scratch.motion)
    ends = speed_of_ends(model, state.twist, twists, scratch.motion)
    if not ends <= FASTEST:
        return TOO_FAST
    if not duration <= MOST_STEPS * longest:
        return TOO_LONG
    fastest = IMPLAUSIBLE * (model.natural_speed + ends)
    settings = state.settings
    if progress[0] == 0:
        save(model, state, scratch, 0)
        save_accelerations(state, work)
        for k in range(10):
            work.settings[k] = settings[k]
        work.settings[11] = calm_step(model, state, twists, scratch.motion, max(duration, longest))
        average_acceleration(state, scratch, twists, duration, min(duration / SMOOTHING, 1.0))
        work.settings[10] = 0.0  # whether the waves have been looked at further ahead
        report[0], report[1], report[2], report[3], report[4] = 0.0, 0.0, 0.0, duration, 0.0
    settings[0], settings[1], settings[8], settings[9] = 0.0, 0.0, 0.0, 0.0
    steps = int(np.ceil(duration / min(longest, work.settings[11], model.sea.refresh) - 1e-9))
    h = duration / steps
    good, torn = True, False
    while progress[0] < steps and good:
        j = progress[0]
        now = state.clock[0] + j * h
        if model.sea.frequency.size > 0 and outdated(state.window_times, now, now + h):
            if work.settings[10] == 0.0:
                copy_window(state.window_times, state.window, scratch.saved_window_times, scratch.saved_window)
                work.settings[10] = 1.0
            refresh(model.sea, now, now + h, model.size, state.position, state.velocity, scratch.wave_work, state.window_times, state.window)
        look_at_surface(model, state, SURFACE_MARGIN + model.bulk + h * max(LIKELY_SPEED, ends))
        good = take_step(model, state, scratch, plan, work, scheme, h, j / steps, 1.0 / steps, fastest, passing, report)
        progress[0] += 1
        if good and model.failures.point.size > 0:
            parted = part(
                model.failures, now + h, state.tension, state.end_point, model.end_node, state.position, state.velocity, model.point_node, state.failed
            )
            if parted > 0:
                keep_start(model, state, work)
                evaluate_in_place(model, state, scratch, 0.0, 0.0, settings[2] != 0.0)
                recall_start_accelerations(state, work)
                return PARTED
    progress[0] = 0
    torn = good and overstretched(model, state, settings[5])
    if torn or not good:
        recall(model, state, scratch, 0)
        recall_acceleration(state, scratch)
        for k in range(10):
            settings[k] = work.settings[k]
        if settings[2] == 0.0:
            all_wet(model, state)
        if work.settings[10] != 0.0:
            copy_window(scratch.saved_window_times, scratch.saved_window, state.window_times, state.window)
        evaluate_in_place(model, state, scratch, settings[0], settings[1], settings[2] != 0.0)
        recall_accelerations(state, work)
        return OVERSTRETCHED if torn else RUNAWAY
    end_interval(state, time, poses, twists)
    return DONE


@entry
@kernel
def run(model, state, scratch, plan, work, scheme, longest, passing, times, poses, twists, first, progress, report, readings):
    """Advance through samples from the `first` on: times (k,), poses (k, M, 7), twists (k, M, 6); readings get a row for each. Returns (status, samples done)."""
    for sample in range(first, times.size):
        status = advance(model, state, scratch, plan, work, scheme, longest, passing, times[sample], poses[sample], twists[sample], progress, report)
        if status != DONE:
            return status, sample
        show(model, state, sample, readings)
        readings.uneven[sample] = report[4]
    return DONE, times.size


def step_limit(scene, limit, dt=None):
    """`limit`, the StepLimit of explicit steps, with the implicit step: `dt` (s), or what follows a line that swings, STEPS_A_SWING in sqrt(L / g);
    less where nothing damps the waves across the lines, and on hard beds."""
    if dt is not None:
        return replace(limit, dt=float(dt), limited_by="dt")
    longest = max(line.length for line in scene.lines)
    own = np.sqrt(longest / max(scene.environment.gravity, 1e-3)) / STEPS_A_SWING
    step, why = min(own, LONGEST), "accuracy of the lines' own swings" if own < LONGEST else "accuracy of the motion"
    if nothing_damps(scene):
        step, why = UNDAMPED * step, "accuracy of waves that nothing damps"
    elif limit.limits["bed damping"] < HARD_BED:
        step, why = ON_HARD_BED * step, "accuracy of what lands on a hard bed"
    return replace(limit, dt=float(step), limited_by=why)


def refuse(scene):
    """Raise ValueError for what the implicit solver does not know, with the remedy."""
    for line in scene.lines:
        if line.type.curve or line.type.slow_stiffness > 0.0:
            law = "a load-strain curve" if line.type.curve else "two-Kelvin ropes"
            raise ValueError(f"solver 'implicit' does not know {law} (line type {line.type.name!r}); expected solver 'explicit' for this scene")


class ImplicitSolver:
    """The implicit solver of one model: its equations, listed for how the ends are held, and its work space.

    longest: step (s). The measure of forces out of balance is that of the model as it was at first, whatever winches do to it.
    """

    def __init__(self, model, longest, spectral_radius):
        self._steps, self._force_scale = (float(longest), passing_of_waves(model)), force_scale(model)
        self._scheme = tuple(float(value) for value in scheme_of(spectral_radius))
        self._topology, self._work, self._progress = None, None, np.zeros(1, dtype=np.int64)

    def begin(self, state):
        """Begin at rest."""
        state.filtered[:] = state.acceleration
        state.parts_filtered[:] = state.parts_acceleration
        state.tension_rate[:] = 0.0

    def run(self, model, state, scratch, times, poses, twists, report, readings):
        """As `explicit.run`."""
        self._progress[0], done = 0, 0
        while True:
            if self._topology is None or (self._topology.end_point != state.end_point).any():
                self._list(model, state)
            plan, work = self._topology.plan, self._work
            status, done = run(
                model, state, scratch, plan, work, self._scheme, *self._steps, times, poses, twists, done, self._progress, report, readings
            )
            if status != PARTED:
                return status, done

    def _list(self, model, state):
        self._topology = make_topology(model, state, self._force_scale)
        work, kept = _new_work(model, self._topology.plan), self._work
        if kept is not None:  # lines may have parted within an interval: its start is still there to go back to
            work = work._replace(saved=kept.saved, saved_parts=kept.saved_parts, saved_rate=kept.saved_rate, settings=kept.settings)
        self._work = work


def force_scale(model):
    """(n,) N: the submerged weight of the line, or the node's own weight; LEAST_STRAIN of EA where nothing weighs, and no less than rounding makes."""
    beyond = np.append(np.arange(1, model.mass.size), 0)  # the segment to the right
    scale = np.abs(model.weight) + np.abs(model.buoyancy)
    for first, count in zip(model.first_node, model.segments):
        nodes = slice(first, first + count + 1)
        scale[nodes] = max(np.abs(model.weight[nodes] - model.buoyancy[nodes]).sum(), LEAST_STRAIN * model.stiffness[first + 1])
    stiffest = model.live * model.stiffness * model.inverse_length
    stiffest = np.maximum(stiffest, stiffest[beyond]) + model.bed_stiffness
    extent = max(np.abs(model.point_place).max(initial=1.0), abs(model.bed_level), (model.live * model.length).sum())
    return np.maximum(scale, ROUNDING / TOLERANCE * stiffest * extent)


def _new_work(model, plan):
    n, parts, threes = model.mass.size, model.rigid.mass.size, plan.scale.size
    clamps = model.clamps.part.size if model.bending.stiffness.size else 0
    return Work(
        values=np.zeros((plan.places + plan.riding_places + 1, 9)),
        right=np.zeros((threes, 3)),
        balance=np.zeros((threes, 3)),
        left=np.zeros((threes, 3)),
        axial=np.zeros(n),
        damper=np.zeros(n),
        foreseen=np.zeros(n),
        last=np.zeros(n),
        next=np.zeros(n),
        linear=np.zeros(n),
        pulled=np.zeros(n),
        touched=np.zeros(n),
        bent=np.zeros((plan.rows.size, 3, 3)),
        clamp_turn=np.zeros((clamps, 2, 3, 3)),
        clamp_axis=np.zeros((clamps, 3, 3)),
        moved=np.zeros((4, 3, n)),
        parts=np.zeros((parts, 13)),
        parts_moved=np.zeros((2, parts, 6)),
        turned=np.zeros((parts, 3)),
        saved=np.zeros((2, 3, n)),
        saved_parts=np.zeros((2, parts, 6)),
        saved_rate=np.zeros(n),
        settings=np.zeros(12),
    )
