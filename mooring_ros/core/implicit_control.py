"""What tells that an implicit step is too long: it comes to a balance at its end, whatever has happened within it.

Tensions that jump in a step; tensions that leave the rate at which they changed: those of a wave of amplitude A and frequency w do by A (w h)^2, and
(w h)^2 / 12 of its period or more is lost; and a platform whose acceleration jumps.
"""

import numpy as np

from .cache import stage

SUDDEN, SUDDEN_PIECES = 0.08, 32  # of a tension and the line's weight: its change in a step that is too much; parts of a step that are tried for it
MOST_PIECES, PASSED = 128, 0.5  # ... and those that are, as long as they are longer than this share of what an axial wave takes to pass a segment
BENT, BENT_PIECES = 0.015, 8  # of the same: how far a tension may be from where its rate led to; parts of a step that are tried for it
CALM = 0.5  # of SUDDEN, and its square of BENT, where steps may be doubled again
GENTLE = 0.07  # of the lines' weight: the tension that a jump of the platform's acceleration may cause in a step
CALMEST = 32.0  # parts of an interval, or of the longest step, that are taken for it


@stage
def tension_bent(model, state, scratch, h, share):
    """Whether a tension is further than `share` of it and of the line's weight from where its rate in the last step leads to in h (s)."""
    bent = 0
    for i in range(model.size + 1):
        missed = state.tension[i] - scratch.tension[i] - h * state.tension_rate[i]
        bent |= abs(missed) > share * (state.tension[i] + model.tension_scale[i])
    return bent != 0


@stage
def jumps_may_be_finer(pieces, piece, passing):
    """Whether a part of a step, one of `pieces` and `piece` (s) long, is to be halved for tensions that jump; passing (s): `passing_of_waves`."""
    return pieces < SUDDEN_PIECES or (pieces < MOST_PIECES and piece > PASSED * passing)


@stage
def keep_rate(model, state, scratch, h):
    """Keep the rates of the tensions in a step of h (s), from those in scratch.tension."""
    for i in range(model.size + 1):
        state.tension_rate[i] = (state.tension[i] - scratch.tension[i]) / h


@stage
def calm_step(model, state, twists, motions, span):
    """Longest step (s) for an interval to twists (M, 6) with its motions (platforms.start_motions); not below one in CALMEST of `span` (s).

    At a sample the platform's acceleration should be the mean of those over the intervals before and after. It is not where the platform gets going at
    once, nor where twists lag behind the poses, as differences of poses do: then it swings once an interval, and looks the same at every sample.
    """
    hardest = 0.0
    for m in range(motions.shape[0]):
        motion, place, turn = motions[m], 0.0, 0.0
        per = 1.0 / motion[7, 0]
        for k in range(3):
            start = (6.0 * (motion[2, k] - motion[0, k]) - 4.0 * motion[1, k] - 2.0 * motion[3, k]) * per * per
            mean = 0.5 * ((twists[m, k] - state.twist[m, k]) * per + state.acceleration_of_platform[m, k])
            place += (start - mean) ** 2
            start = (6.0 * motion[4, k] - 4.0 * motion[5, k] - 2.0 * motion[6, k]) * per * per
            mean = 0.5 * ((twists[m, 3 + k] - state.twist[m, 3 + k]) * per + state.acceleration_of_platform[m, 3 + k])
            turn += (start - mean) ** 2
        hardest = max(hardest, np.sqrt(place) + model.reach[m] * np.sqrt(turn))
    return max(GENTLE * model.gentle / max(hardest, 1e-12), span / CALMEST)


def passing_of_waves(model):
    """s: what an axial wave takes to pass the segment that it passes first."""
    shortest = np.inf
    for first, count in zip(model.first_node, model.segments):
        mass, stiffness = model.mass[first : first + count + 1].sum() / count, model.stiffness[first + 1]
        if stiffness > 0.0:
            shortest = min(shortest, float(np.sqrt(mass * model.length[first + 1] / stiffness)))
    return shortest
