"""Tangent stiffness K = -dF/dx of the static forces, block tridiagonal along the lines.

blocks (n, 3, 3, 3): those of each node with its left neighbour, itself and its right one.
"""

import numpy as np

from .cache import kernel, stage
from .packed import entry
from .surface import wet_part


@entry
@kernel
def fill_tangent(model, state, blocks):
    """Blocks at the current positions; `evaluate` must have run there with all velocities zero."""
    blocks[:] = 0.0
    below, diagonal, above = blocks[:, 0], blocks[:, 1], blocks[:, 2]
    _axial(model, state, diagonal, above, below)
    for i in range(model.size):
        if not model.ground.on and state.position[2, i] < model.bed_level:
            diagonal[i, 2, 2] += model.bed_stiffness[i]
    for i in range(model.size):
        _drag(model, state, i, diagonal, above, below)
    _buoyancy(model, state, diagonal, above, below)


@stage
def _axial(model, state, diagonal, above, below):
    """EA/l q q' + T/L (I - q q') for taut segments; none for slack ones."""
    x = state.position
    for i in range(model.size):
        tension = state.tension[i + 1]
        if tension <= 0.0:
            continue
        q = state.tangent[:, i + 1]
        axial = model.stiffness[i + 1] * model.inverse_length[i + 1]
        stretched = q[0] * (x[0, i + 1] - x[0, i]) + q[1] * (x[1, i + 1] - x[1, i]) + q[2] * (x[2, i + 1] - x[2, i])
        turning = tension / max(stretched, 0.1 * model.length[i + 1])
        for a in range(3):
            for b in range(3):
                k = (axial - turning) * q[a] * q[b]
                if a == b:
                    k += turning
                diagonal[i, a, b] += k
                diagonal[i + 1, a, b] += k
                above[i, a, b] -= k
                below[i + 1, a, b] -= k


@stage
def _drag(model, state, i, diagonal, above, below):
    """Change of the stream's drag on node i as its tangent turns with the segments on both sides."""
    if state.stream[0, i] == 0.0 and state.stream[1, i] == 0.0 and state.stream[2, i] == 0.0:
        return
    tx, ty, tz = (
        state.tangent[0, i] + state.tangent[0, i + 1],
        state.tangent[1, i] + state.tangent[1, i + 1],
        state.tangent[2, i] + state.tangent[2, i + 1],
    )
    size = np.sqrt(tx * tx + ty * ty + tz * tz)
    if size < 1e-6:
        return
    t = (tx / size, ty / size, tz / size)
    u = (state.stream[0, i], state.stream[1, i], state.stream[2, i])
    along = u[0] * t[0] + u[1] * t[1] + u[2] * t[2]
    ua = (along * t[0], along * t[1], along * t[2])
    un = (u[0] - ua[0], u[1] - ua[1], u[2] - ua[2])
    speed_a = max(abs(along), 1e-12)
    speed_n = max(np.sqrt(un[0] * un[0] + un[1] * un[1] + un[2] * un[2]), 1e-12)
    ca = state.wet[i] * model.drag_axial[i]
    cn = state.wet[i] * model.drag_normal[i]
    for side in range(2):
        s = i + side  # the segment to the left, then to the right
        if model.live[s] == 0.0:
            continue
        q = state.tangent[:, s]
        length = model.length[s] * (state.tension[s] / model.stiffness[s] + 1.0)
        for a in range(3):
            for b in range(3):
                # dF_a/dq_b summed over the chain F <- u_a <- t <- q <- x
                total = 0.0
                for c in range(3):
                    # (I - t t')/size (I - q q')/length, column b
                    turn = 0.0
                    for d in range(3):
                        project = (1.0 if c == d else 0.0) - t[c] * t[d]
                        turn += project * ((1.0 if d == b else 0.0) - q[d] * q[b])
                    turn /= size * length
                    for e in range(3):
                        force = ca * (speed_a * (1.0 if a == e else 0.0) + ua[a] * ua[e] / speed_a)
                        force -= cn * (speed_n * (1.0 if a == e else 0.0) + un[a] * un[e] / speed_n)
                        total += force * (t[e] * u[c] + (along if e == c else 0.0)) * turn
                # F grows with q, q with x of the far end: K takes the negative
                if side == 0:
                    diagonal[i, a, b] -= total
                    below[i, a, b] += total
                else:
                    above[i, a, b] -= total
                    diagonal[i, a, b] += total


@stage
def _shares_of_ends(left, right, radius):
    """Wet shares of the left and the right half of a segment whose ends are at these depths (m)."""
    mean, surplus = wet_part(max(left, right), min(left, right), radius)
    return (mean - surplus, mean + surplus) if right > left else (mean + surplus, mean - surplus)


@stage
def _buoyancy(model, state, diagonal, above, below):
    """Loss of buoyancy as the ends of a segment, or a point, rise through the surface (see `wet_shares`); differences of the wet shares."""
    z = state.position[2]
    for i in range(model.size):
        if model.live[i + 1] == 0.0:
            continue
        extent = model.diameter[i + 1] * np.sqrt(max(1.0 - state.tangent[2, i + 1] ** 2, 0.0))
        radius, span = 0.5 * extent, abs(z[i + 1] - z[i])
        if not (max(-z[i], -z[i + 1]) > -radius and min(-z[i], -z[i + 1]) < radius):
            continue
        small = 1e-6 * (span + extent)
        for column in range(2):
            left, right = -z[i], -z[i + 1]
            by = small if column == 0 else 0.0
            more_left, more_right = _shares_of_ends(left - by, right - (small - by), radius)
            less_left, less_right = _shares_of_ends(left + by, right + (small - by), radius)
            at_left = model.buoyancy[i] * model.share_right[i] * (less_left - more_left) / (2.0 * small)
            at_right = model.buoyancy[i + 1] * model.share_left[i + 1] * (less_right - more_right) / (2.0 * small)
            if column == 0:
                diagonal[i, 2, 2] += at_left
                below[i + 1, 2, 2] += at_right
            else:
                above[i, 2, 2] += at_left
                diagonal[i + 1, 2, 2] += at_right
    for p in range(model.point_node.size):
        node, diameter = model.point_node[p], model.point_diameter[p]
        if diameter > 0.0:
            under = min(max(0.5 - z[node] / diameter, 0.0), 1.0)
            diagonal[node, 2, 2] += model.buoyancy[node] * 6.0 * under * (1.0 - under) / diameter


@entry
@kernel
def stretch_linearly(model, state, slack_strain, tension):
    """Let segments with `tension` (n,) > 0 push as well as pull, and take these tensions into the state for `fill_tangent`.

    Here and below a segment's law is T = stiffness (strain - slack_strain), the piece of its curve where `tension` stands.
    """
    for i in range(model.size):
        if tension[i + 1] > 0.0 and state.tension[i + 1] <= 0.0:
            q = state.tangent[:, i + 1]
            length = 0.0
            for k in range(3):
                length += q[k] * (state.position[k, i + 1] - state.position[k, i])
            push = model.stiffness[i + 1] * (length * model.inverse_length[i + 1] - 1.0 - slack_strain[i + 1])
            for k in range(3):
                state.force[k, i] += push * q[k]
                state.force[k, i + 1] -= push * q[k]
        state.tension[i + 1] = tension[i + 1]


@entry
@kernel
def predict_tension(model, state, slack_strain, move, tension):
    """Tensions (n,) that the segments will have after `move` (3, n), to first order; zero for those that go slack."""
    for i in range(model.size):
        q = state.tangent[:, i + 1]
        length, growth = 0.0, 0.0
        for k in range(3):
            length += q[k] * (state.position[k, i + 1] - state.position[k, i])
            growth += q[k] * (move[k, i + 1] - move[k, i])
        strain = (length + growth) * model.inverse_length[i + 1] - 1.0 - slack_strain[i + 1]
        tension[i + 1] = max(model.live[i + 1] * model.stiffness[i + 1] * strain, 0.0)


@entry
@kernel
def balance(model, state, slack_strain, tension, force):
    """Forces (3, n) of the nodes with tensions (n,) of their own in place of the state's; returns the norm of the strains that these miss.

    `evaluate` must have run at the positions.
    """
    missed = 0.0
    for i in range(model.size):
        for k in range(3):
            left = (tension[i] - state.tension[i]) * state.tangent[k, i]
            right = (tension[i + 1] - state.tension[i + 1]) * state.tangent[k, i + 1]
            force[k, i] = state.force[k, i] + right - left
        if model.stiffness[i + 1] > 0.0:
            length = 0.0
            for k in range(3):
                length += state.tangent[k, i + 1] * (state.position[k, i + 1] - state.position[k, i])
            strain = length * model.inverse_length[i + 1] - 1.0 - slack_strain[i + 1] - tension[i + 1] / model.stiffness[i + 1]
            if tension[i + 1] <= 0.0:
                strain = max(strain, 0.0)
            missed += strain * strain
    return np.sqrt(missed)
