"""What a step may not leave behind: numbers that are no numbers, speeds that nothing in the scene can cause, tensions that jump."""

import numpy as np

from .cache import routine, stage
from .rigid import copy_parts

EVEN, UNEVEN, TORN = 0, 1, 2
IMPLAUSIBLE = 10.0  # times the speed that anything in the scene should reach: beyond, a step has blown up
FASTEST = 1e5  # m/s that a platform may be said to move at


@stage
def speed_of_ends(model, twists0, twists1, motions):
    """Speed (m/s) that coupled points do not pass in an interval between two twists (M, 6), with its motions (platforms.start_motions)."""
    fastest = 0.0
    for m in range(motions.shape[0]):
        speed = _speed_of_ends(model.reach[m], twists0[m], twists1[m], motions[m])
        if not speed <= FASTEST:
            return speed  # which may be no number
        fastest = max(fastest, speed)
    return fastest


@stage
def _speed_of_ends(reach, twist0, twist1, motion):
    square, turn, moved, turned = 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        square = max(square, twist0[k] ** 2, twist1[k] ** 2)
        turn = max(turn, twist0[3 + k] ** 2, twist1[3 + k] ** 2)
        moved += (motion[2, k] - motion[0, k]) ** 2
        turned += motion[4, k] ** 2
    return 2.0 * np.sqrt(square) + 2.0 * reach * np.sqrt(turn) + (np.sqrt(moved) + reach * np.sqrt(turned)) / motion[7, 0]


@stage
def hardest_acceleration(model, motions):
    """Acceleration (m/s^2) that coupled points do not pass in an interval with its motions (platforms.start_motions), turning for small angles."""
    hardest = 0.0
    for m in range(motions.shape[0]):
        hardest = max(hardest, _hardest_acceleration(model.reach[m], motions[m]))
    return hardest


@stage
def _hardest_acceleration(reach, motion):
    hardest = 0.0
    for s in (0.0, 1.0):
        place, turn = 0.0, 0.0
        for k in range(3):
            a, b = (4.0, 2.0) if s == 0.0 else (2.0, 4.0)
            moved = 6.0 * (motion[2, k] - motion[0, k]) - a * motion[1, k] - b * motion[3, k]
            turned = 6.0 * motion[4, k] - a * motion[5, k] - b * motion[6, k]
            place, turn = place + moved * moved, turn + turned * turned
        hardest = max(hardest, np.sqrt(place) + reach * np.sqrt(turn))
    return hardest / (motion[7, 0] * motion[7, 0])


@stage
def runaway(model, state, fastest):
    """True when a node is faster than `fastest` (m/s), or a place, speed or tension is not a finite number."""
    u, v, w = state.velocity[0], state.velocity[1], state.velocity[2]
    z, tension = state.position[2], state.tension
    limit = fastest * fastest
    bad = 0
    for i in range(model.size):
        bad |= not (u[i] * u[i] + v[i] * v[i] + w[i] * w[i] + 0.0 * z[i] <= limit)
        bad |= not (tension[i] < np.inf)
    return bad != 0


@stage
def overstretched(model, state, strain):
    """True when a segment is stretched beyond `strain`: the platform has gone where its lines do not reach."""
    over = 0
    for i in range(model.size + 1):
        over |= state.tension[i] > strain * model.stiffness[i]
    return over != 0


@stage
def copy_row(source, target):
    for i in range(source.size):
        target[i] = source[i]


@stage
def copy_rows(source, target):
    for k in range(source.shape[0]):
        for i in range(source.shape[1]):
            target[k, i] = source[k, i]


@routine
def save(model, state, scratch, place):
    """Keep what moves, in the first (0) or second (1) place."""
    copy = scratch.saved[place]
    for k in range(3):
        for i in range(model.mass.size):
            copy[k, i] = state.position[k, i]
            copy[3 + k, i] = state.velocity[k, i]
            copy[6 + k, i] = state.lead[k, i]
    copy_parts(state.parts, scratch.saved_parts[place])
    copy_row(state.creep, scratch.saved_creep[place])
    copy_rows(state.grip, scratch.saved_grip[place])
    copy_rows(state.expected, scratch.saved_expected[place])
    copy_rows(state.clamp_axis, scratch.saved_axes[place])
    copy_row(state.end_point, scratch.saved_ends[place])
    copy_row(state.failed, scratch.saved_failed[place])


@routine
def recall(model, state, scratch, place):
    copy = scratch.saved[place]
    for k in range(3):
        for i in range(model.mass.size):
            state.position[k, i] = copy[k, i]
            state.velocity[k, i] = copy[3 + k, i]
            state.lead[k, i] = copy[6 + k, i]
    copy_parts(scratch.saved_parts[place], state.parts)
    copy_row(scratch.saved_creep[place], state.creep)
    copy_rows(scratch.saved_grip[place], state.grip)
    copy_rows(scratch.saved_expected[place], state.expected)
    copy_rows(scratch.saved_axes[place], state.clamp_axis)
    copy_row(scratch.saved_ends[place], state.end_point)
    copy_row(scratch.saved_failed[place], state.failed)


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
