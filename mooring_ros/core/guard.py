"""What a step may not leave behind: numbers that are no numbers, speeds that nothing in the scene can cause, tensions that jump."""

from .cache import stage


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
        for i in range(model.size + 1):
            copy[k, i] = state.position[k, i]
            copy[3 + k, i] = state.velocity[k, i]


@stage
def recall(model, state, copy):
    for k in range(3):
        for i in range(model.size + 1):
            state.position[k, i] = copy[k, i]
            state.velocity[k, i] = copy[3 + k, i]


@stage
def keep_tension(model, state, scratch):
    for i in range(model.size + 1):
        scratch.tension[i] = state.tension[i]


@stage
def tension_jumped(model, state, scratch, share):
    """1 when a tension differs from the kept one by more than `share` of it and of the line's weight, else 0."""
    jumped = 0
    for i in range(model.size + 1):
        jumped |= abs(state.tension[i] - scratch.tension[i]) > share * (state.tension[i] + model.tension_scale[i])
    return jumped
