"""Axial tension of the segments, and its pull on the nodes."""

import numpy as np

from .cache import stage

TINY = 1e-200  # m^2: keeps coincident nodes from dividing by zero


@stage
def segment_tensions(model, state):
    """T = EA (L/l - 1) + BA (dL/dt)/l, never negative; a slack segment (L <= l) carries none, damping included.

    Where velocities stand back from places by the time settings[9], the present tangent sees a part of the turning as a rate of length; this part,
    the time by the square of the turning speed over L, is taken off.
    """
    position, velocity, back = state.position, state.velocity, state.settings[9]
    x, y, z = position[0], position[1], position[2]
    u, v, w = velocity[0], velocity[1], velocity[2]
    qx, qy, qz = state.tangent[0], state.tangent[1], state.tangent[2]
    tension, length_rate = state.tension, state.strain_rate
    stiffness, damping, inverse_length, live = model.stiffness, model.damping, model.inverse_length, model.live
    for i in range(model.size):
        dx, dy, dz = x[i + 1] - x[i], y[i + 1] - y[i], z[i + 1] - z[i]
        length = np.sqrt(max(dx * dx + dy * dy + dz * dz, TINY))
        scale = live[i + 1] / length
        tx, ty, tz = dx * scale, dy * scale, dz * scale
        du, dv, dw = u[i + 1] - u[i], v[i + 1] - v[i], w[i + 1] - w[i]
        rate = tx * du + ty * dv + tz * dw
        rate -= back * (du * du + dv * dv + dw * dw - rate * rate) / length
        strain = length * inverse_length[i + 1] - 1.0
        pull = max(stiffness[i + 1] * strain + damping[i + 1] * rate, 0.0)
        tension[i + 1] = pull if strain > 0.0 else 0.0
        length_rate[i + 1] = rate
        qx[i + 1], qy[i + 1], qz[i + 1] = tx, ty, tz


@stage
def pull_on_nodes(model, state):
    """Start the nodes' force with the tensions on both sides."""
    fx, fy, fz = state.force[0], state.force[1], state.force[2]
    qx, qy, qz = state.tangent[0], state.tangent[1], state.tangent[2]
    tension = state.tension
    for i in range(model.size):
        left, right = tension[i], tension[i + 1]
        fx[i] = right * qx[i + 1] - left * qx[i]
        fy[i] = right * qy[i + 1] - left * qy[i]
        fz[i] = right * qz[i + 1] - left * qz[i]
