"""What a step may not leave behind: numbers that are no numbers, speeds that nothing in the scene can cause, tensions that jump."""

from .cache import stage

EVEN, UNEVEN, TORN = 0, 1, 2


@stage
def runaway(model, state, speed_limit):
    """True when a node is faster than `speed_limit` (m/s) or not a number."""
    u, v, w = state.velocity[0], state.velocity[1], state.velocity[2]
    z = state.position[2]
    limit = speed_limit * speed_limit
    bad = 0
    for i in range(model.size):
        bad |= not (u[i] * u[i] + v[i] * v[i] + w[i] * w[i] + 0.0 * z[i] <= limit)
    return bad != 0


@stage
def save(model, state, copy):
    for k in range(3):
        for i in range(model.mass.size):
            copy[k, i] = state.position[k, i]
            copy[3 + k, i] = state.velocity[k, i]


@stage
def recall(model, state, copy):
    for k in range(3):
        for i in range(model.mass.size):
            state.position[k, i] = copy[k, i]
            state.velocity[k, i] = copy[3 + k, i]


@stage
def keep_tension(model, state, scratch):
    for i in range(model.size + 1):
        scratch.tension[i] = state.tension[i]


@stage
def tension_jumped(model, state, scratch, share):
    """EVEN, UNEVEN when a tension differs from the kept one by more than `share` of it and of the line's weight, TORN when one has collapsed.

    However stiff a line, snapping taut only adds tension: a drop by more than what is left and the line's weight is not the line's doing.
    """
    jumped, collapsed = 0, 0
    for i in range(model.size + 1):
        change = state.tension[i] - scratch.tension[i]
        measure = state.tension[i] + model.tension_scale[i]
        jumped |= abs(change) > share * measure
        collapsed |= -change > measure
    return TORN if collapsed != 0 else UNEVEN if jumped != 0 else EVEN
