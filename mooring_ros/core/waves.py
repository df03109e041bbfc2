"""Kinematics of the water at the nodes: linear waves with Wheeler stretching, in a window of time that goes with the nodes.

Summing a hundred components at every node in every evaluation would cost many times the forces. So velocities, accelerations and elevation
are summed only at the ends of a window of `sea.refresh` (s), at the places where the nodes will be by then, and interpolated inside it.
The far end lies where the nodes would come to at their present velocity; the near end is what the last window says, so nothing jumps.

Along the waves and upwards, with theta = w t - k x' - phase and ' along the waves (Airy; Wheeler 1970 puts z' = h (z - eta)/(h + eta)
in place of z):
    u = w a C cos(theta)    w = -w a S sin(theta)    C, S = cosh, sinh k(z' + h) / sinh(k h)
Approximated: sine, cosine and exponential to 5e-10; components that have decayed below 1e-6 at all nodes of a block are left out.
"""

import numpy as np

from .cache import kernel, stage
from .current import add_layers

# rows of a window at each of its ends: velocity along the waves and up; their rates as the node goes; the part of these that comes from
# the node's own way through the waves; elevation and its rate as the node goes
U, W, U_RATE, W_RATE, U_WAY, W_WAY, ETA, ETA_RATE = range(8)
WINDOW_ROWS = 8

BLOCK = 32  # nodes taken together: a component is left out for all of them
X, Z, SURFACE, SURFACE_RATE, SURFACE_SLOPE, SUM_U, SUM_W, SUM_DU, SUM_DW, SUM_UX, SUM_UZ = [row * BLOCK for row in range(11)]
WORK_SIZE = 11 * BLOCK
DECAYED = 14.0  # k |z'|: exp(-14) = 8e-7
SHALLOWEST = 0.1  # of the depth: what is left at least under a trough, for Wheeler's stretching
TO_INTEGER = 1.5 * 2.0**52  # added and taken away again: rounds to a whole number


@stage
def sin_cos(turns):
    """(sine, cosine) of a number of turns, to 5e-10: polynomials for half the angle, within a quarter turn."""
    r = turns - ((turns + TO_INTEGER) - TO_INTEGER)
    q = r * r
    s = 0.082050350201481 + q * -0.00702830385522069
    s = r * (3.141592653536132 + q * (-5.167712764593 + q * (2.550163317938427 + q * (-0.5992521865315841 + q * s))))
    c = 0.23493706859508748 + q * -0.02439593209755079
    c = 0.999999999779154 + q * (-4.934802136928946 + q * (4.058709154763134 + q * (-1.3352119493905508 + q * c)))
    return 2.0 * s * c, 1.0 - 2.0 * s * s


@stage
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
            s, c = sin_cos(start - per_metre * work[X + i])
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
            s, c = sin_cos(start - per_metre * work[X + i])
            e = decay(-k * work[Z + i])
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
    if time >= sea.ramp:
        return 1.0, 0.0
    if time <= 0.0:
        return 0.0, 0.0
    angle = np.pi * time / sea.ramp
    return 0.5 - 0.5 * np.cos(angle), 0.5 * np.pi / sea.ramp * np.sin(angle)


@stage
def _sum_end(sea, time, ahead, size, position, velocity, work, window, end):
    """Fill one end of the window: the kinematics at `time` (s) where the nodes will be after `ahead` (s) at their present velocity."""
    dx, dy, h = sea.direction[0], sea.direction[1], sea.depth
    grown, growing = _grown(sea, time)
    for first in range(0, size, BLOCK):
        for i in range(BLOCK):
            node = min(first + i, size - 1)
            x, y = position[0, node] + ahead * velocity[0, node], position[1, node] + ahead * velocity[1, node]
            work[X + i] = dx * x + dy * y
        _sum_surface(sea, time, work)
        highest = -h
        for i in range(BLOCK):
            node = min(first + i, size - 1)
            z = position[2, node] + ahead * velocity[2, node]
            eta = grown * work[SURFACE + i]
            stretched = (z - eta) * h / max(h + eta, SHALLOWEST * h)
            work[Z + i] = max(min(stretched, 0.0), -h)
            highest = max(highest, work[Z + i])
        _sum_below(sea, time, highest, work)
        for i in range(min(BLOCK, size - first)):
            node = first + i
            along = dx * velocity[0, node] + dy * velocity[1, node]
            up, z = velocity[2, node], position[2, node] + ahead * velocity[2, node]
            eta = grown * work[SURFACE + i]
            eta_rate = grown * (work[SURFACE_RATE + i] + along * work[SURFACE_SLOPE + i]) + growing * work[SURFACE + i]
            column = max(h + eta, SHALLOWEST * h)
            rise = (up - (z + h) / column * eta_rate) * h / column  # dz'/dt
            if not -h < work[Z + i] < 0.0:
                rise = 0.0
            u_way = grown * (along * work[SUM_UX + i] + rise * work[SUM_UZ + i])
            w_way = grown * (along * work[SUM_UZ + i] - rise * work[SUM_UX + i])
            window[end, U, node] = grown * work[SUM_U + i]
            window[end, W, node] = grown * work[SUM_W + i]
            window[end, U_RATE, node] = grown * work[SUM_DU + i] + growing * work[SUM_U + i] + u_way
            window[end, W_RATE, node] = grown * work[SUM_DW + i] + growing * work[SUM_W + i] + w_way
            window[end, U_WAY, node] = u_way
            window[end, W_WAY, node] = w_way
            window[end, ETA, node] = eta
            window[end, ETA_RATE, node] = eta_rate


@stage
def _weights(time, window_times):
    """Cubic Hermite at `time` (s): weights of (near value, near rate, far value, far rate), the same for the rate, and the share of the way.

    A window of no length, or of all times, is all near end.
    """
    width = window_times[1] - window_times[0]
    if not 0.0 < width < np.inf:
        return (1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), 0.0
    s = (time - window_times[0]) / width
    rest = 1.0 - s
    steep = 6.0 * s * rest / width
    value = (rest * rest * (1.0 + 2.0 * s), width * s * rest * rest, s * s * (3.0 - 2.0 * s), -width * s * s * rest)
    rate = (-steep, rest * (1.0 - 3.0 * s), steep, s * (3.0 * s - 2.0))
    return value, rate, s


@stage
def outdated(window_times, start, end):
    """True when the window does not hold the times from `start` to `end` (s)."""
    return not (window_times[0] <= start and end <= window_times[1])


@kernel
def calm(window_times, window):
    """Still water at all times, until `waken`."""
    window_times[0], window_times[1] = -np.inf, np.inf
    for end in range(2):
        for row in range(WINDOW_ROWS):
            for i in range(window.shape[2]):
                window[end, row, i] = 0.0


@kernel
def waken(window_times):
    """Let the next `refresh` start anew."""
    window_times[0], window_times[1] = 0.0, -1.0


@stage
def copy_window(times, window, times_to, window_to):
    times_to[0], times_to[1] = times[0], times[1]
    for end in range(2):
        for row in range(WINDOW_ROWS):
            for i in range(window.shape[2]):
                window_to[end, row, i] = window[end, row, i]


@kernel
def refresh(sea, start, end, size, position, velocity, work, window_times, window):
    """Make the window hold the times from `start` to `end` (s), with the nodes now, at `start`, at `position` and `velocity` (3, n).

    It then spans `sea.refresh`, or up to `end` where that is later. Where the old window holds `start`, the new one goes on from there
    without a jump; otherwise both ends are summed. Without waves nothing is done.
    """
    if window.shape[2] == 0 or not outdated(window_times, start, end):
        return
    far = max(start + sea.refresh, end)
    if window_times[0] <= start <= window_times[1]:
        value, rate, s = _weights(start, window_times)
        for k in range(3):
            row, row_rate = (U, U_RATE) if k == 0 else (W, W_RATE) if k == 1 else (ETA, ETA_RATE)
            for i in range(size):
                n, nr, f, fr = window[0, row, i], window[0, row_rate, i], window[1, row, i], window[1, row_rate, i]
                window[0, row, i] = value[0] * n + value[1] * nr + value[2] * f + value[3] * fr
                window[0, row_rate, i] = rate[0] * n + rate[1] * nr + rate[2] * f + rate[3] * fr
        for row in range(U_WAY, W_WAY + 1):
            for i in range(size):
                window[0, row, i] += s * (window[1, row, i] - window[0, row, i])
    else:
        _sum_end(sea, start, 0.0, size, position, velocity, work, window, 0)
    _sum_end(sea, far, far - start, size, position, velocity, work, window, 1)
    window_times[0], window_times[1] = start, far


@stage
def streams(sea, time, size, position, window_times, window, stream, swell):
    """Water at the nodes at `time` (s): stream (3, n), its velocity (m/s); swell (4, n), the waves' acceleration (m/s^2) and
    elevation (m). Without waves and layers of current nothing changes, and they are left as they are.

    At a node above the surface it is the water of the surface under it: what is wet of its neighbourhood moves with that.
    """
    if window.shape[2] != 0:
        _interpolate(sea, time, size, window_times, window, stream, swell)
    elif sea.layer_bottom.size != 0:
        for k in range(3):
            for i in range(size):
                stream[k, i] = sea.current[k]
    if sea.layer_bottom.size != 0:
        add_layers(sea, size, position, stream)


@stage
def _interpolate(sea, time, size, window_times, window, stream, swell):
    (v0, v1, v2, v3), (r0, r1, r2, r3), s = _weights(time, window_times)
    rest = 1.0 - s
    dx, dy = sea.direction[0], sea.direction[1]
    cx, cy, cz = sea.current[0], sea.current[1], sea.current[2]
    near, far = window[0], window[1]
    for i in range(size):
        u = v0 * near[U, i] + v1 * near[U_RATE, i] + v2 * far[U, i] + v3 * far[U_RATE, i]
        rate = r0 * near[U, i] + r1 * near[U_RATE, i] + r2 * far[U, i] + r3 * far[U_RATE, i]
        a = rate - rest * near[U_WAY, i] - s * far[U_WAY, i]
        stream[0, i], stream[1, i] = cx + dx * u, cy + dy * u
        swell[0, i], swell[1, i] = dx * a, dy * a
    for i in range(size):
        w = v0 * near[W, i] + v1 * near[W_RATE, i] + v2 * far[W, i] + v3 * far[W_RATE, i]
        rate = r0 * near[W, i] + r1 * near[W_RATE, i] + r2 * far[W, i] + r3 * far[W_RATE, i]
        stream[2, i] = cz + w
        swell[2, i] = rate - rest * near[W_WAY, i] - s * far[W_WAY, i]
    for i in range(size):
        swell[3, i] = v0 * near[ETA, i] + v1 * near[ETA_RATE, i] + v2 * far[ETA, i] + v3 * far[ETA_RATE, i]
