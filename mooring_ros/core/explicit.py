"""Explicit time stepping over one interval between two samples of the platform's motion."""

import numpy as np

from .cache import kernel, stage
from .forces import evaluate
from .guard import recall, runaway, save
from .platform import start_motion
from .points import place_coupled_points
from .readings import observe
from .schemes import LEAPFROG
from .seabed import set_bed_relief
from .surface import all_wet, reaches_above

DONE, RUNAWAY = 0, 1  # status codes

CHUNK = 64  # steps between two looks at the guard
HALVINGS = 6  # of the step, before an interval is given up
SURFACE_MARGIN = 1.0  # m below the surface at which wet shares begin to be computed


@stage
def choose_step(table, duration):
    """(row of the table, number of steps) with the fewest evaluations over `duration`; of equals, the shorter steps."""
    best, best_steps, best_cost = 0, 0.0, np.inf
    for row in range(table.shape[0]):
        steps = max(np.ceil(duration / table[row, 1] - 1e-9), 1.0)
        cost = steps * table[row, 0]
        if cost < best_cost:
            best, best_steps, best_cost = row, steps, cost
    return best, int(best_steps)


@stage
def adapt(model, state, settings_h, row):
    """Set what the evaluations depend on from the step `settings_h` (s) and the scheme's row of the table."""
    state.settings[0] = settings_h * row[2]
    state.settings[1] = settings_h * row[3]
    state.settings[2] = settings_h * settings_h * row[4]
    set_bed_relief(model, state, state.settings[1], state.settings[2])


@stage
def look_at_surface(model, state, reach):
    """Compute wet shares only when something may come out of the water within `reach` (m)."""
    surfaced = reaches_above(model, state, -SURFACE_MARGIN - reach)
    if not surfaced and state.settings[3] != 0.0:
        all_wet(model, state)
    state.settings[3] = 1.0 if surfaced else 0.0


@kernel
def evaluate_at(model, state, scratch, s):
    """Evaluate with the coupled points at s of the interval in scratch.motion and the settings in the state."""
    place_coupled_points(model, state, scratch.motion, s)
    evaluate(model, state, scratch, state.settings[0], state.settings[3] != 0.0)


@kernel
def reevaluate(model, state, scratch):
    """Evaluate again where the state stands, after something but its motion has changed."""
    evaluate(model, state, scratch, state.settings[0], state.settings[3] != 0.0)


@stage
def start_step(model, state, scratch):
    for k in range(3):
        for i in range(model.size):
            scratch.position[k, i] = state.position[k, i]
            scratch.velocity[k, i] = state.velocity[k, i]


@stage
def stabilised_stage(model, state, scratch, c):
    """y = y_0 + c f(y)."""
    position, velocity, acceleration = state.position, state.velocity, state.acceleration
    for k in range(3):
        for i in range(model.size):
            position[k, i] = scratch.position[k, i] + c * velocity[k, i]
            velocity[k, i] = scratch.velocity[k, i] + c * acceleration[k, i]


@stage
def leapfrog_stage(model, state, h):
    position, velocity, acceleration = state.position, state.velocity, state.acceleration
    for k in range(3):
        for i in range(model.size):
            velocity[k, i] += h * acceleration[k, i]
            position[k, i] += h * velocity[k, i]


@stage
def take_steps(model, state, scratch, alphas, evaluations, h, first, count, steps):
    """Steps first .. first + count - 1 of `steps` over the interval; accelerations must be those of the current state."""
    ds = 1.0 / steps
    for j in range(first, first + count):
        if evaluations != LEAPFROG:
            start_step(model, state, scratch)
        for k in range(evaluations):
            if evaluations == LEAPFROG:
                alpha = 1.0
                leapfrog_stage(model, state, h)
            else:
                alpha = alphas[evaluations, k]
                stabilised_stage(model, state, scratch, alpha * h)
            place_coupled_points(model, state, scratch.motion, (j + alpha) * ds)
            evaluate(model, state, scratch, state.settings[0], state.settings[3] != 0.0)


@kernel
def advance(model, state, scratch, table, alphas, time, pose, twist, speed_limit, report):
    """Advance `state` to `time` (s), where the platform has `pose` (7,) and `twist` (6,). Returns a status code.

    `table`, `alphas`: from `schemes`. A chunk of steps that ends in a runaway is taken again from its start with half the step, and
    refused after `HALVINGS`: the state is then as it was. `report` (4,) gets evaluations, steps, retries and the step (s).
    """
    duration = time - state.clock[0]
    start_motion(state.pose, state.twist, pose, twist, duration, scratch.motion)
    row, steps = choose_step(table, duration)
    evaluations = int(table[row, 0])
    previous = (state.settings[0], state.settings[1], state.settings[2], state.settings[3])
    save(model, state, scratch.saved[0])
    chunks = (steps + CHUNK - 1) // CHUNK
    retries, taken = 0, 0
    for chunk in range(chunks):
        begin = chunk * CHUNK
        count = min(CHUNK, steps - begin)
        if chunk > 0:
            save(model, state, scratch.saved[1])
        source = 0 if chunk == 0 else 1
        finer, failed = 1, True
        for _ in range(HALVINGS + 1):
            h = duration / (steps * finer)
            adapt(model, state, h, table[row])
            look_at_surface(model, state, count * finer * h * speed_limit * 0.01)
            if finer > 1:
                evaluate_at(model, state, scratch, begin / steps)
            take_steps(model, state, scratch, alphas, evaluations, h, begin * finer, count * finer, steps * finer)
            taken += count * finer
            failed = runaway(model, state, speed_limit)
            if not failed:
                break
            recall(model, state, scratch.saved[source])
            finer *= 2
            retries += 1
        if failed:
            recall(model, state, scratch.saved[0])
            for i in range(4):
                state.settings[i] = previous[i]
            set_bed_relief(model, state, previous[1], previous[2])
            if previous[3] == 0.0:
                all_wet(model, state)
            evaluate_at(model, state, scratch, 0.0)
            return RUNAWAY
    for i in range(7):
        state.pose[i] = pose[i]
    for i in range(6):
        state.acceleration_of_platform[i] = (twist[i] - state.twist[i]) / duration
        state.twist[i] = twist[i]
    state.clock[0] = time
    report[0], report[1], report[2], report[3] = taken * evaluations, steps, retries, duration / steps
    return DONE


@kernel
def run(model, state, scratch, table, alphas, times, poses, twists, speed_limit, report, readings):
    """Advance through samples: times (k,), poses (k, 7), twists (k, 6); readings get a row for each. Returns (status, samples done)."""
    for sample in range(times.size):
        status = advance(model, state, scratch, table, alphas, times[sample], poses[sample], twists[sample], speed_limit, report)
        if status != DONE:
            return status, sample
        observe(model, state, sample, readings)
    return DONE, times.size
