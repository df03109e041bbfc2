"""Explicit time stepping over one interval between two samples of the platform's motion."""

import numpy as np

from .axial import pull_implicitly, transverse_step
from .cache import kernel, paragraph, routine, stage
from .failures import part
from .forces import evaluate, evaluate_in_place
from .ground import commit_grip
from .guard import EVEN, FASTEST, IMPLAUSIBLE, TORN, UNEVEN, copy_row, hardest_acceleration, keep_tension, overstretched, recall, runaway, save, speed_of_ends, tension_jumped
from .packed import entry
from .platforms import average_acceleration, end_interval, recall_acceleration, start_motions
from .points import carry_ends, place_coupled_points, place_staggered_coupled_points, speed_coupled_points
from .readings import show
from .rigid import copy_parts, euler_parts, mix_parts
from .schemes import AXIAL, LEAPFROG
from .surface import all_wet, reaches_above
from .waves import copy_window, outdated, refresh

DONE, RUNAWAY, TOO_FAST, TOO_LONG, OVERSTRETCHED = 0, 1, 2, 3, 4  # status codes

CHUNK = 64  # largest steps between two looks at the guard
MOST_STEPS = 1e7  # largest steps in an interval: some minutes of work
FINEST = 64.0  # times finer than the largest step a chunk is tried, before its interval is given up
JUMP = 0.1  # of the tension and the line's weight: the change of a tension, from Euler steps to their mean, that is too much
AXIAL_JUMP = 0.15  # the same for the scheme `AXIAL`, whose steps are long
GENTLE = 0.3  # of the lines' weight: the tension that the platform may cause in a step by what it gains in speed
MOST_REFINED = 8.0  # times finer steps for that cause; a jump that stays is one of the line, not of the scheme
REFINED_STEPS = 40.0  # largest steps for which a finer step is kept
DRAG_SAFETY = 0.9  # of the Euler step at which drag would turn a velocity round
STAGGERED_DRAG_SAFETY = 0.45  # ... with velocities that are led on by half a step
SURFACE_MARGIN, LIKELY_SPEED = 1.0, 5.0  # m, m/s: how far below the surface nodes may be before wet shares matter in a chunk


@stage
def choose_step(table, span, refined, calm, transverse):
    """(row of the table, number of steps) with the least cost over `span` (s); of equals, the shorter steps.

    Steps are at most those of the table over `refined`, and those that the platform's motion asks for: `calm` (s), down to one in `MOST_REFINED`. The
    scheme `AXIAL` also keeps to what the transverse waves allow (s), and is left where that takes more than others at one in `FINEST`.
    """
    best, best_steps, best_cost = 0, 0.0, np.inf
    for row in range(table.shape[0]):
        largest = table[row, 1]
        if table[row, 0] == AXIAL:
            step = min(largest, min(calm, transverse)) / refined
        else:
            step = max(min(largest, max(calm, largest / MOST_REFINED)) / refined, largest / FINEST)
        steps = max(np.ceil(span / step - 1e-9), 1.0)
        cost = steps * table[row, 3]
        if cost < best_cost:
            best, best_steps, best_cost = row, steps, cost
    return best, int(best_steps)


@stage
def adapt(model, state, scheme, euler_step, h):
    """Set what the evaluations depend on from the Euler step (s) of which the scheme is made, and its whole step h (s)."""
    lag = 0.5 * h if scheme <= LEAPFROG else 0.0  # the time by which its velocities stand back
    state.settings[0] = euler_step / (STAGGERED_DRAG_SAFETY if lag > 0.0 else DRAG_SAFETY)
    state.settings[1] = euler_step
    state.settings[8] = lag
    state.settings[9] = lag if scheme == LEAPFROG else 0.0  # `AXIAL` takes the mean of the rates before and after


@stage
def stagger(model, state, lag, before):
    """Bring velocities that stand `before` (s) behind the places to where they stand `lag` behind. True when they have moved."""
    if lag == 0.0 or before == 0.0 or abs(lag - before) <= 1e-9 * before:
        return False
    share = lag / before
    for k in range(3):
        for i in range(model.size):
            state.velocity[k, i] += (1.0 - share) * state.lead[k, i]
            state.lead[k, i] *= share
    return True


@stage
def look_at_surface(model, state, margin):
    """Compute wet shares only when a node is less than `margin` (m) below the surface, or above it."""
    surfaced = reaches_above(model, state, -margin)
    if not surfaced and state.settings[2] != 0.0:
        all_wet(model, state)
    state.settings[2] = 1.0 if surfaced else 0.0


@routine
def evaluate_again(model, state, scratch):
    """Evaluate from recalled positions and velocities with the settings in the state."""
    evaluate_in_place(model, state, scratch, state.settings[0], state.settings[1], state.settings[2] != 0.0)


@stage
def start_step(model, state, scratch):
    for k in range(3):
        for i in range(model.size):
            scratch.position[k, i] = state.position[k, i]
            scratch.velocity[k, i] = state.velocity[k, i]
    if state.parts.size > 0:
        copy_parts(state.parts, scratch.parts)
    copy_row(state.creep, scratch.creep)


@stage
def stand_together(model, state):
    """Velocities of the schemes of several stages belong to the same time as the places."""
    for k in range(3):
        for i in range(model.size):
            state.lead[k, i] = 0.0


@stage
def euler_others(model, state, h, staggered):
    """An Euler step of h (s) of what moves besides the nodes."""
    if state.parts.size > 0:
        euler_parts(state.parts, state.parts_acceleration, h, staggered)
    for i in range(state.creep.size):
        state.creep[i] += h * state.creep_rate[i]


@stage
def euler_stage(model, state, h):
    position, velocity, acceleration = state.position, state.velocity, state.acceleration
    for k in range(3):
        for i in range(model.size):
            position[k, i] += h * velocity[k, i]
            velocity[k, i] += h * acceleration[k, i]
    euler_others(model, state, h, False)


@stage
def last_stage(model, state, scratch, h, stages):
    """y = (y_0 + (s - 1) (y + h f(y))) / s."""
    position, velocity, acceleration = state.position, state.velocity, state.acceleration
    old = 1.0 / stages
    new = 1.0 - old
    for k in range(3):
        for i in range(model.size):
            position[k, i] = old * scratch.position[k, i] + new * (position[k, i] + h * velocity[k, i])
            velocity[k, i] = old * scratch.velocity[k, i] + new * (velocity[k, i] + h * acceleration[k, i])
    euler_others(model, state, h, False)
    if state.parts.size > 0:
        mix_parts(state.parts, scratch.parts, old)
    for i in range(state.creep.size):
        state.creep[i] = old * scratch.creep[i] + new * state.creep[i]


@stage
def leapfrog_stage(model, state, h):
    position, velocity, acceleration, lead = state.position, state.velocity, state.acceleration, state.lead
    for k in range(3):
        for i in range(model.size):
            gain = h * acceleration[k, i]
            lead[k, i] = 0.5 * gain
            velocity[k, i] += gain
            position[k, i] += h * velocity[k, i]
    euler_others(model, state, h, True)


@stage
def remember_grip(model, state, scratch):
    commit_grip(
        model.ground,
        model.size,
        state.position,
        state.velocity,
        state.tangent,
        model.bed_stiffness,
        model.bed_damping,
        scratch.bed,
        state.grip,
    )


@stage
def expect(model, state):
    """Keep the accelerations of nodes that share their motion: friction goes by the speed that they are about to have."""
    for k in range(3):
        for i in range(model.size):
            state.expected[k, i] = state.acceleration[k, i] if state.slaved[i] else 0.0


@routine
def let_go(model, state, scratch, time):
    """Let lines part that are due at `time` (s)."""
    parted = part(
        model.failures, time, state.tension, state.end_point, model.end_node, state.position, state.velocity, model.point_node, state.failed
    )
    if parted > 0:
        evaluate_again(model, state, scratch)


@paragraph
def take_steps(model, state, scratch, scheme, h, steps, start, ds):
    """`steps` steps of h (s) from `start` of the interval, ds of it each; accelerations must be those of the current state.

    Returns the worst of `tension_jumped` from the Euler steps of a step to their mean, or in leapfrog's case from one step to the next:
    lines that snap from slack to taut pump energy out of long steps.
    """
    worst, evaluations = EVEN, max(scheme, 1)
    if evaluations > 1:
        stand_together(model, state)
    for j in range(steps):
        if evaluations > 1:
            start_step(model, state, scratch)
        end = start + (j + 1) * ds
        for k in range(evaluations):
            if evaluations == 1:
                keep_tension(model, state, scratch)
                leapfrog_stage(model, state, h)
                place_staggered_coupled_points(model, state, scratch.motion, end, h)
                if scheme == AXIAL:
                    carry_ends(model, state)
                    pull_implicitly(model, state, scratch, h)
            elif k < evaluations - 1:
                part = 1.0 / (evaluations - 1)
                euler_stage(model, state, h * part)
                speed_coupled_points(model, state, scratch.motion, end - ds * (evaluations - 2 - k) * part, h * part)
            else:
                keep_tension(model, state, scratch)
                last_stage(model, state, scratch, h / (evaluations - 1), evaluations)
                place_coupled_points(model, state, scratch.motion, end)
            if k == evaluations - 1:
                state.settings[6] = state.clock[0] + end * scratch.motion[0, 7, 0] + 0.5 * h  # the middle of the next step, which begins with this evaluation
            evaluate(model, state, scratch, state.settings[0], state.settings[1], state.settings[2] != 0.0, k == evaluations - 1)
        worst = max(worst, tension_jumped(model, state, scratch, AXIAL_JUMP if scheme == AXIAL else JUMP))
        if state.grip.shape[1] > 0:
            remember_grip(model, state, scratch)
        if state.expected.shape[1] > 0:
            expect(model, state)
        if model.failures.point.size > 0:
            let_go(model, state, scratch, state.clock[0] + end * scratch.motion[0, 7, 0])
    return worst


@paragraph
def advance(model, state, scratch, table, time, poses, twists, report):
    """Advance `state` to `time` (s), where the platforms have poses (M, 7) and twists (M, 6). Returns a status code.

    `table`: from `schemes.step_table`. The interval is taken in chunks. One whose tensions come out uneven is taken again from its start
    with half the step, down to one in `MOST_REFINED`, or in `FINEST` where they collapse, and the finer step is kept for a while. One that
    runs away even in the finest steps is refused: the state is as it was. `report` (5,) gets evaluations, steps, chunks taken again, the shortest
    step (s), and chunks whose tensions come out uneven however fine the steps.
    """
    duration = time - state.clock[0]
    start_motions(state, poses, twists, duration, scratch.motion)
    ends = speed_of_ends(model, state.twist, twists, scratch.motion)
    if not ends <= FASTEST:
        return TOO_FAST
    fastest = IMPLAUSIBLE * (model.natural_speed + ends)
    largest, smallest = table[0, 1], table[0, 1]
    for row in range(table.shape[0]):
        largest, smallest = max(largest, table[row, 1]), min(smallest, table[row, 1])
    calm = GENTLE * model.gentle / max(hardest_acceleration(model, scratch.motion), 1e-12)
    settings = state.settings
    previous = (settings[0], settings[1], settings[2], settings[3], settings[4], settings[6], settings[8], settings[9])
    if not duration <= MOST_STEPS * largest:
        return TOO_LONG
    average_acceleration(state, scratch, twists, duration, min(duration / smallest, 1.0))  # samples closer than a step share one mean: their differences are noise
    chunks = int(np.ceil(duration / min(CHUNK * largest, model.sea.refresh)))
    span = duration / chunks
    evaluations_taken, steps_taken, retries, shortest, uneven, looked_ahead = 0.0, 0, 0, duration, 0, False
    for chunk in range(chunks):
        start = chunk / chunks
        source = min(chunk, 1)
        save(model, state, scratch, source)
        refined, again, lag = settings[3], False, settings[8]
        now = state.clock[0] + start * duration
        if model.sea.frequency.size > 0 and outdated(state.window_times, now, now + span):
            if not looked_ahead:
                copy_window(state.window_times, state.window, scratch.saved_window_times, scratch.saved_window)
                looked_ahead = True
            refresh(model.sea, now, now + span, model.size, state.position, state.velocity, scratch.wave_work, state.window_times, state.window)
        while True:
            transverse = transverse_step(model, state) if table[0, 0] == AXIAL else np.inf
            row, steps = choose_step(table, span, refined, calm, transverse)
            h = span / steps
            adapt(model, state, table[row, 0], h / table[row, 2], h)
            look_at_surface(model, state, SURFACE_MARGIN + model.bulk + span * max(LIKELY_SPEED, ends))
            if stagger(model, state, settings[8], lag) or again:
                settings[6] = state.clock[0] + start * duration + 0.5 * h
                evaluate_again(model, state, scratch)
            tensions = take_steps(model, state, scratch, int(table[row, 0]), h, steps, start, 1.0 / (steps * chunks))
            evaluations_taken += steps * max(table[row, 0], 1.0)
            wild = runaway(model, state, fastest)
            again = refined < FINEST if wild or tensions == TORN else tensions == UNEVEN and refined < MOST_REFINED
            if not again:
                break
            recall(model, state, scratch, source)
            refined *= 2.0
            retries += 1
        torn = overstretched(model, state, settings[5])
        if wild or torn:
            recall(model, state, scratch, 0)
            recall_acceleration(state, scratch)
            settings[0], settings[1], settings[2], settings[3], settings[4], settings[6], settings[8], settings[9] = previous
            if settings[2] == 0.0:
                all_wet(model, state)
            if looked_ahead:
                copy_window(scratch.saved_window_times, scratch.saved_window, state.window_times, state.window)
            evaluate_again(model, state, scratch)
            return RUNAWAY if wild else OVERSTRETCHED
        steps_taken += steps
        uneven += tensions != EVEN
        shortest = min(shortest, h)
        now = state.clock[0] + (chunk + 1) * span
        if refined > settings[3]:
            settings[3], settings[4] = refined, now + REFINED_STEPS * largest
        elif refined > 1.0 and now >= settings[4]:
            settings[3], settings[4] = 0.5 * refined, now + REFINED_STEPS * largest
    end_interval(state, time, poses, twists)
    report[0], report[1], report[2], report[3], report[4] = evaluations_taken, steps_taken, retries, shortest, uneven
    return DONE


@entry
@kernel
def run(model, state, scratch, table, times, poses, twists, report, readings):
    """Advance through samples: times (k,), poses (k, M, 7), twists (k, M, 6); readings get a row for each. Returns (status, samples done)."""
    for sample in range(times.size):
        status = advance(model, state, scratch, table, times[sample], poses[sample], twists[sample], report)
        if status != DONE:
            return status, sample
        show(model, state, sample, readings)
        readings.uneven[sample] = report[4]
    return DONE, times.size
