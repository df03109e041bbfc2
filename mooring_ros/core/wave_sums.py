"""Linear waves summed at the nodes: velocity, acceleration, elevation and their gradients, with Wheeler's stretching.

Along the waves and upwards, with theta = w t - k x' - phase and x' along the waves (Airy; Wheeler 1970 puts z' = h (z - eta)/(h + eta)
in place of z):
    u = w a C cos(theta)    w = -w a S sin(theta)    C, S = cosh, sinh k(z' + h) / sinh(k h)
Approximated: sine, cosine and exponential to 5e-10; components that have decayed below 1e-6 at all nodes of a block are left out.
"""

import numpy as np

from .cache import formula, stage

# rows of what is known at a node: velocity along the waves and upwards, each with its rate at a place that the stretching follows, what the
# stretching adds to the rate at a fixed place, and its gradients along x' and z; elevation with its rate and slope; the place, x' and z
U, DU, U_SHIFT, U_X, U_Z, W, DW, W_SHIFT, W_X, W_Z, ETA, ETA_T, ETA_X, X, Z = range(15)
WINDOW_ROWS = 15

BLOCK = 32  # nodes taken together: a component is left out for all of them
ALONG, LEVEL, SURFACE, SURFACE_RATE, SURFACE_SLOPE, SUM_U, SUM_W, SUM_DU, SUM_DW, SUM_UX, SUM_UZ = [row * BLOCK for row in range(11)]
WORK_SIZE = 11 * BLOCK
DECAYED = 14.0  # k |z'|: exp(-14) = 8e-7
SHALLOWEST = 0.1  # of the depth: what is left at least under a trough, for Wheeler's stretching
TO_INTEGER = 1.5 * 2.0**52  # added and taken away again: rounds to a whole number


@formula
def sin_cos(turns):
    """(sine, cosine) of a number of turns, to 5e-10: polynomials for half the angle, within a quarter turn."""
    r = turns - ((turns + TO_INTEGER) - TO_INTEGER)
    q = r * r
    s = 0.082050350201481 + q * -0.00702830385522069
    s = r * (3.141592653536132 + q * (-5.167712764593 + q * (2.550163317938427 + q * (-0.5992521865315841 + q * s))))
    c = 0.23493706859508748 + q * -0.02439593209755079
    c = 0.999999999779154 + q * (-4.934802136928946 + q * (4.058709154763134 + q * (-1.3352119493905508 + q * c)))
    return 2.0 * s * c, 1.0 - 2.0 * s * s


@formula
def decay(y):
    """exp(-y), to 2e-10, for 0 <= y <= 14; exp(-14) beyond."""
    r = min(y, DECAYED) * (-1.0 / 64.0)
    e = 1.0 + r * (1.0 + r * (0.5 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * (1.0 / 120.0)))))
    e = e * e
    e = e * e
    e = e * e
    e = e * e
    e = e * e
    return e * e


@stage
def _turns(sea, j, time):
    """Phase of component j at the origin, in turns."""
    turns = (sea.frequency[j] * time - sea.phase[j]) / (2.0 * np.pi)
    return turns - np.floor(turns)


@stage
def _sum_surface(sea, time, work):
    """Elevation of a block's nodes, its rate and its slope."""
    for i in range(BLOCK):
        work[SURFACE + i] = 0.0
        work[SURFACE_RATE + i] = 0.0
        work[SURFACE_SLOPE + i] = 0.0
    for j in range(sea.frequency.size):
        a, start, per_metre = sea.amplitude[j], _turns(sea, j, time), sea.wave_number[j] / (2.0 * np.pi)
        a_rate, a_slope = a * sea.frequency[j], a * sea.wave_number[j]
        for i in range(BLOCK):
            s, c = sin_cos(start - per_metre * work[ALONG + i])
            work[SURFACE + i] += a * c
            work[SURFACE_RATE + i] -= a_rate * s
            work[SURFACE_SLOPE + i] += a_slope * s


@stage
def _sum_below(sea, time, highest, work):
    """Velocities, accelerations and gradients of a block's nodes, none of which stands higher than `highest` (z', m)."""
    for i in range(BLOCK):
        work[SUM_U + i] = 0.0
        work[SUM_W + i] = 0.0
        work[SUM_DU + i] = 0.0
        work[SUM_DW + i] = 0.0
        work[SUM_UX + i] = 0.0
        work[SUM_UZ + i] = 0.0
    for j in range(sea.frequency.size):
        w, k = sea.frequency[j], sea.wave_number[j]
        if -k * highest > DECAYED:
            break
        start, per_metre = _turns(sea, j, time), k / (2.0 * np.pi)
        image = np.exp(-2.0 * k * sea.depth)
        scale = w * sea.amplitude[j] / (1.0 - image)
        for i in range(BLOCK):
            s, c = sin_cos(start - per_metre * work[ALONG + i])
            e = decay(-k * work[LEVEL + i])
            mirrored = image / e
            along, up = scale * (e + mirrored), scale * (e - mirrored)
            us, uc, ws, wc = along * s, along * c, up * s, up * c
            work[SUM_U + i] += uc
            work[SUM_W + i] -= ws
            work[SUM_DU + i] -= w * us
            work[SUM_DW + i] -= w * wc
            work[SUM_UX + i] += k * us
            work[SUM_UZ + i] += k * wc


@stage
def _grown(sea, time):
    """(factor, its rate in 1/s) by which the waves have grown: half a cosine."""
    if time >= sea.ramp or sea.ramp <= 0.0:
        return 1.0, 0.0
    if time <= 0.0:
        return 0.0, 0.0
    angle = np.pi * time / sea.ramp
    return 0.5 - 0.5 * np.cos(angle), 0.5 * np.pi / sea.ramp * np.sin(angle)


@stage
def sum_waves(sea, time, ahead, size, position, velocity, work, known):
    """Fill `known` (WINDOW_ROWS, n) at `time` (s), where the nodes will be after `ahead` (s) at their present velocity. `work`: (WORK_SIZE,)."""
    dx, dy, h = sea.direction[0], sea.direction[1], sea.depth
    grown, growing = _grown(sea, time)
    for first in range(0, size, BLOCK):
        for i in range(BLOCK):
            node = min(first + i, size - 1)
            x, y = position[0, node] + ahead * velocity[0, node], position[1, node] + ahead * velocity[1, node]
            work[ALONG + i] = dx * x + dy * y
        _sum_surface(sea, time, work)
        highest = -h
        for i in range(BLOCK):
            node = min(first + i, size - 1)
            eta = grown * work[SURFACE + i]
            stretched = (position[2, node] + ahead * velocity[2, node] - eta) * h / max(h + eta, SHALLOWEST * h)
            work[LEVEL + i] = max(min(stretched, 0.0), -h)
            highest = max(highest, work[LEVEL + i])
        _sum_below(sea, time, highest, work)
        for i in range(min(BLOCK, size - first)):
            node, z = first + i, position[2, first + i] + ahead * velocity[2, first + i]
            eta, slope = grown * work[SURFACE + i], grown * work[SURFACE_SLOPE + i]
            eta_rate = grown * work[SURFACE_RATE + i] + growing * work[SURFACE + i]
            column = max(h + eta, SHALLOWEST * h)
            stretch = h / column if -h < work[LEVEL + i] < 0.0 else 0.0  # dz'/dz; beyond surface and bed z' stands
            sinking = -stretch * (z + h) / column  # dz'/d eta
            u_x, u_z = grown * work[SUM_UX + i], grown * work[SUM_UZ + i]  # at constant z', and by z'; also w_z' = -u_x, w_x = u_z
            known[U, node] = grown * work[SUM_U + i]
            known[W, node] = grown * work[SUM_W + i]
            known[DU, node] = grown * work[SUM_DU + i] + growing * work[SUM_U + i]
            known[DW, node] = grown * work[SUM_DW + i] + growing * work[SUM_W + i]
            known[U_SHIFT, node], known[W_SHIFT, node] = sinking * eta_rate * u_z, -sinking * eta_rate * u_x
            known[U_X, node], known[U_Z, node] = u_x + sinking * slope * u_z, stretch * u_z
            known[W_X, node], known[W_Z, node] = u_z - sinking * slope * u_x, -stretch * u_x
            known[ETA, node], known[ETA_T, node], known[ETA_X, node] = eta, eta_rate, slope
            known[X, node], known[Z, node] = work[ALONG + i], z
