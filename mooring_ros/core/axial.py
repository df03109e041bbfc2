"""The lines' axial stiffness and internal damping taken implicitly within a leapfrog step: a scalar tridiagonal solve along the lines.

Leapfrog with the mass M + beta h^2 K + gamma h C in place of M, where K and C are the axial stiffness and damping along the present tangents,
is Newmark's scheme for the axial waves alone (beta = 1/4, gamma = 1/2: second order, no damping of its own, stable at any step), and
plain leapfrog for all the rest. The Woodbury identity leaves one unknown a segment, the impulse y (N s) by which the step's tension
differs from the one at its start:

    y = D (rate* - rate + B W B' y),    D = h (beta h EA/l + gamma BA/l),

with the segments' rates of length before and after the explicit step (rate, rate*), the nodes' mobility W = M^-1 and the differences along
the tangents B. A segment that is slack at the start of the step is met as an impact without rebound: its tension is that at the step's end,
EA (L/l - 1) + BA (dL/dt)/l there, or none: which of them pull is found by passes, `PASSES` at most. One that pulls may end the step slack; what
it pushes in the rest of that step is not taken away, because that would leave a jump between the velocities of its ends for the next step.
"""

import numpy as np

from .cache import routine, stage
from .joints import follow_joints, give_to_nodes, join, move_joints
from .model import LOOSE
from .points import gather
from .tension import TINY

BETA = 0.25  # unconditionally stable, and no more
OVERDAMPED = 3.0  # of h C/M for the mass of a node: from here on gamma goes from 1/2 to 1, so that what is damped dies out instead of ringing
PASSES = 3
TRANSVERSE = 0.8  # of the limit of the transverse waves under the present tension, which may grow within the step
LIGHTEST = 1e-30  # kg


@stage
def _mobilities(model, state, across, surplus):
    """Inverse inertia of the nodes, across I + surplus t t'; state.bed_relief goes on vertical components for what the bed holds."""
    normal, axial = state.inertia_normal, state.inertia_axial
    qx, qy, qz = state.tangent[0], state.tangent[1], state.tangent[2]
    for i in range(model.size):
        tx, ty, tz = qx[i] + qx[i + 1], qy[i] + qy[i + 1], qz[i] + qz[i + 1]
        square = max(tx * tx + ty * ty + tz * tz, TINY)
        both = 1.0 / (normal[i] * axial[i] * square + 1e-300)
        across[i], surplus[i] = axial[i] * square * both, (normal[i] - axial[i]) * both
    across[model.size] = surplus[model.size] = 0.0
    for e in range(model.end_node.size):
        if state.end_point[e] != LOOSE:
            across[model.end_node[e]] = surplus[model.end_node[e]] = 0.0


@stage
def _rows(model, state, h, across, surplus, gain, source, own, shared, pulls, stretch):
    """For each segment: D, the right hand side, the diagonal and the coupling to the right of B W B', whether it looks as if it pulls (1 or 0),
    and how far it is beyond its length (m).
    """
    x, y, z = state.position[0], state.position[1], state.position[2]
    u, v, w = state.velocity[0], state.velocity[1], state.velocity[2]
    lu, lv, lw = state.lead[0], state.lead[1], state.lead[2]
    qx, qy, qz = state.tangent[0], state.tangent[1], state.tangent[2]
    tension, rate, inertia = state.tension, state.strain_rate, state.inertia_axial
    stiffness, damping, inverse_length, live, lift = model.stiffness, model.damping, model.inverse_length, model.live, state.bed_relief
    for i in range(model.size):
        ax, ay, az = qx[i], qy[i], qz[i]
        bx, by, bz = qx[i + 1], qy[i + 1], qz[i + 1]
        cx, cy, cz = (qx[i + 2], qy[i + 2], qz[i + 2])
        lx, ly, lz = ax + bx, ay + by, (az + bz) * lift[i]
        rx, ry, rz = bx + cx, by + cy, (bz + cz) * lift[i + 1]
        left = bx * lx + by * ly + bz * lz
        right = bx * rx + by * ry + bz * rz
        far = cx * rx + cy * ry + cz * rz
        flat = bx * bx + by * by
        upright = bz * bz
        g = across[i] * (flat + lift[i] * upright) + surplus[i] * left * left
        g += across[i + 1] * (flat + lift[i + 1] * upright) + surplus[i + 1] * right * right
        own[i + 1] = g
        shared[i + 1] = across[i + 1] * (bx * cx + by * cy + lift[i + 1] * bz * cz) + surplus[i + 1] * right * far
        dx, dy, dz = x[i + 1] - x[i], y[i + 1] - y[i], z[i + 1] - z[i]
        strain = np.sqrt(dx * dx + dy * dy + dz * dz) * inverse_length[i + 1] - 1.0
        du, dv, dw = u[i + 1] - u[i], v[i + 1] - v[i], w[i + 1] - w[i]
        after = bx * du + by * dv + bz * dw
        du, dv, dw = du - 2.0 * (lu[i + 1] - lu[i]), dv - 2.0 * (lv[i + 1] - lv[i]), dw - 2.0 * (lw[i + 1] - lw[i])
        turning = h * inverse_length[i + 1] * (du * du + dv * dv + dw * dw - rate[i + 1] * rate[i + 1])
        per_second, resist = h * h * stiffness[i + 1] * inverse_length[i + 1], h * damping[i + 1]
        centred = max(0.5 * resist, resist - OVERDAMPED * inertia[i])  # gamma h C
        taut = tension[i + 1] > 0.0
        elastic = BETA * per_second
        d = elastic + centred if taut else per_second + resist
        gain[i + 1] = d * live[i + 1]
        change = d * (after - rate[i + 1]) + elastic * turning if taut else h * stiffness[i + 1] * strain + resist * after
        source[i + 1] = change * live[i + 1]
        stretch[i + 1] = live[i + 1] * strain / inverse_length[i + 1]
        pulls[i + 1] = 1.0 if taut or min(strain, change) * live[i + 1] > 0.0 else 0.0


@stage
def _equations(n, gain, source, own, shared, pulls, diagonal, before, after, right):
    """Rows diagonal y_i - before y_i-1 - after y_i+1 = right; nothing in segments that do not pull."""
    for i in range(n):
        d = gain[i + 1] * pulls[i + 1]
        diagonal[i + 1] = 1.0 + d * own[i + 1]
        before[i + 1], after[i + 1] = d * shared[i], d * shared[i + 1]
        right[i + 1] = source[i + 1] * pulls[i + 1]


@stage
def _solve(n, diagonal, before, after, y):
    """Solve in place, y holding the right hand side of rows 1..n; elimination from both ends to the middle, which halves the chain of divisions."""
    half = n // 2  # n is even
    low, high = diagonal[1], diagonal[n]
    for i in range(2, half + 1):
        j = n + 1 - i
        down, up = 1.0 / low, 1.0 / high
        y[i] += before[i] * down * y[i - 1]
        y[j] += after[j] * up * y[j + 1]
        diagonal[i - 1], diagonal[j + 1] = down, up
        low = diagonal[i] - before[i] * after[i - 1] / low
        high = diagonal[j] - after[j] * before[j + 1] / high
    i, j = half, half + 1
    determinant = 1.0 / (low * high - after[i] * before[j])
    y[i], y[j] = (high * y[i] + after[i] * y[j]) * determinant, (low * y[j] + before[j] * y[i]) * determinant
    for i in range(half - 1, 0, -1):
        j = n + 1 - i
        y[i] = (y[i] + after[i] * y[i + 1]) * diagonal[i]
        y[j] = (y[j] + before[j] * y[j - 1]) * diagonal[j]


@stage
def _pulls(n, h, own, shared, tension, stretch, pulls, y):
    """Which segments pull with the impulses y: of those slack at first, the ones that the step would leave stretched. True when that has changed."""
    changed = 0
    for i in range(n):
        rate = shared[i] * y[i] + shared[i + 1] * y[i + 2] - own[i + 1] * y[i + 1]
        keeps = y[i + 1] > 0.0 if pulls[i + 1] > 0.0 else stretch[i + 1] + h * rate > 0.0
        pull = 1.0 if tension[i + 1] > 0.0 or keeps else 0.0
        changed |= pull != pulls[i + 1]
        pulls[i + 1] = pull
    return changed != 0


@stage
def _gains(n, tangent, across, surplus, lift, y, gain_x, gain_y, gain_z):
    """Changes of the nodes' velocities (m/s) by the impulses."""
    qx, qy, qz = tangent[0], tangent[1], tangent[2]
    for i in range(n):
        left, right = y[i], y[i + 1]
        tx, ty, tz = qx[i] + qx[i + 1], qy[i] + qy[i + 1], (qz[i] + qz[i + 1]) * lift[i]
        jx, jy, jz = right * qx[i + 1] - left * qx[i], right * qy[i + 1] - left * qy[i], right * qz[i + 1] - left * qz[i]
        along = surplus[i] * (tx * jx + ty * jy + tz * jz)
        gain_x[i] = across[i] * jx + along * tx
        gain_y[i] = across[i] * jy + along * ty
        gain_z[i] = across[i] * lift[i] * jz + along * tz


@stage
def _add(n, h, gain, position, velocity, lead):
    for i in range(n):
        position[i] += h * gain[i]
        velocity[i] += gain[i]
        lead[i] += 0.5 * gain[i]


@routine
def pull_implicitly(model, state, scratch, h):
    """Correct velocities and places that an explicit leapfrog step of h (s) has just reached; tangents, tensions, rates and inertia are still those of its start."""
    work = scratch.axial
    across, surplus, gain, source, own, shared = work[0], work[1], work[2], work[3], work[4], work[5]
    pulls, stretch, diagonal, before, after, y = work[6], work[7], work[8], work[9], work[10], work[11]
    n, tension = model.size, state.tension
    _mobilities(model, state, across, surplus)
    _rows(model, state, h, across, surplus, gain, source, own, shared, pulls, stretch)
    joined = model.free_points.size > 0
    matrix, envelope, change = scratch.joints, scratch.envelope, scratch.joint_change
    for i in range(change.size):
        change[i] = 0.0
    if joined:
        gather(model, state, scratch)  # scratch does not outlive a call
    for _ in range(PASSES):
        if joined:
            follow_joints(model, state, change, gain, -1.0, source)
            _equations(n, gain, source, own, shared, pulls, diagonal, before, after, y)
            join(model, state, scratch.load, matrix, envelope, diagonal, before, after, gain, pulls)
            _solve(n, diagonal, before, after, y)
            move_joints(model, state, matrix, envelope, y, change)
            follow_joints(model, state, change, gain, 1.0, source)
        _equations(n, gain, source, own, shared, pulls, diagonal, before, after, y)
        _solve(n, diagonal, before, after, y)
        if not _pulls(n, h, own, shared, tension, stretch, pulls, y):
            break
    _gains(n, state.tangent, across, surplus, state.bed_relief, y, diagonal, before, after)
    if joined:
        give_to_nodes(model, state, change, diagonal, before, after)
    for k in range(3):
        _add(n, h, work[8 + k], state.position[k], state.velocity[k], state.lead[k])


@stage
def transverse_step(model, state):
    """Step (s) at which leapfrog stays stable for the lines' transverse waves: each segment with half of the inertia at its ends, as in stability.py."""
    tension, normal, inverse_length = state.tension, state.inertia_normal, model.inverse_length
    square = 1e-300
    for i in range(model.size):
        square = max(square, tension[i + 1] * inverse_length[i + 1] * (normal[i] + normal[i + 1]) / max(normal[i] * normal[i + 1], LIGHTEST))
    return TRANSVERSE * np.sqrt(2.0 / square)
