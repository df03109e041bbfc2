"""Laws that jump, made whole for the iterations of a step.

Dampers act on taut segments and in the bed only: where a segment becomes taut, or a node comes down, its force jumps from nothing to the
damper's. No step ends in the middle of a jump, so Newton's method would go back and forth. But a segment or node that has been across in an
iteration will be stopped within this step: from then on its law holds on both sides, spring and damper together never pushing a line or
pulling at the bed. So it is caught by the damper, at most rate * (damping / stiffness) before it arrives.
"""

from .cache import routine


@routine
def catch_segments(model, state, pulled):
    """Add the pull (N) of segments that have been taut and are slack by the plain law; pulled (n,): which have."""
    x, q = state.position, state.tangent
    for s in range(1, model.size + 1):
        if state.tension[s] > 0.0:
            pulled[s] = 1.0
        elif model.stiffness[s] > 0.0:
            i = s - 1
            length = q[0, s] * (x[0, s] - x[0, i]) + q[1, s] * (x[1, s] - x[1, i]) + q[2, s] * (x[2, s] - x[2, i])
            strain = length * model.inverse_length[s] - 1.0
            if strain > 0.0:
                pulled[s] = 1.0
            elif pulled[s] != 0.0:
                pull = max(model.stiffness[s] * strain + model.damping[s] * state.strain_rate[s], 0.0)
                state.tension[s] = pull
                for k in range(3):
                    state.force[k, i] += pull * q[k, s]
                    state.force[k, s] -= pull * q[k, s]


@routine
def catch_nodes(model, state, bed, touched):
    """Add the push (N) of the bed, level and normal (4, n) or flat, on nodes that have been in it and are above; touched (n,): which have."""
    for i in range(model.size):
        n = (bed[1, i], bed[2, i], bed[3, i]) if model.ground.on else (0.0, 0.0, 1.0)
        depth = ((bed[0, i] if model.ground.on else model.bed_level) - state.position[2, i]) * n[2]
        if depth > 0.0:
            touched[i] = 1.0
        elif touched[i] != 0.0:
            v = state.velocity
            speed = v[0, i] * n[0] + v[1, i] * n[1] + v[2, i] * n[2]
            push = max(model.bed_stiffness[i] * depth - model.bed_damping[i] * speed, 0.0)
            for k in range(3):
                state.force[k, i] += push * n[k]
