"""The water's motion at the nodes, in a window of time that goes with them.

Summing a hundred components at every node in every evaluation would cost many times the forces. So they are summed only at the ends of a
window of `sea.refresh` (s), at the places where the nodes will be by then, and interpolated inside it: cubic Hermite along the straight
way that was foreseen, and to first order from there to where the node really is. The far end lies where the nodes come to at their present
velocity; the near end is what the last window says, so nothing jumps.
"""

import numpy as np

from .cache import kernel, stage
from .current import add_layers
from .wave_sums import DU, DW, ETA, ETA_T, ETA_X, U, U_SHIFT, U_X, U_Z, W, W_SHIFT, W_X, W_Z, WINDOW_ROWS, WORK_SIZE, X, Z, sum_waves

__all__ = ["WINDOW_ROWS", "WORK_SIZE", "calm", "copy_window", "outdated", "refresh", "streams", "waken"]


@stage
def _weights(time, window_times):
    """Cubic Hermite at `time` (s): weights of (near value, near rate, far value, far rate), the same for the rate; the way's share; 1/span.

    A window of no length, or of all times, is all near end.
    """
    width = window_times[1] - window_times[0]
    if not 0.0 < width < np.inf:
        return (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0), 0.0, 0.0
    s = (time - window_times[0]) / width
    rest = 1.0 - s
    steep = 6.0 * s * rest / width
    value = (rest * rest * (1.0 + 2.0 * s), width * s * rest * rest, s * s * (3.0 - 2.0 * s), -width * s * s * rest)
    rate = (-steep, rest * (1.0 - 3.0 * s), steep, s * (3.0 * s - 2.0))
    return value, rate, s, 1.0 / width


@stage
def _way(near, far, i, x, z, s, per_span):
    """(velocity of the foreseen way along x' and z, how far the node at x, z is off it)."""
    x0, z0 = near[X, i], near[Z, i]
    far_x, far_z = far[X, i] - x0, far[Z, i] - z0
    return far_x * per_span, far_z * per_span, x - x0 - s * far_x, z - z0 - s * far_z


@stage
def _flow(near, far, value, rate, shift, along_x, along_z, i, way, weights):
    """(velocity, acceleration at a fixed place) of node i from the rows of a component.

    The curve's rate is that which the node meets on its way; what is due to the way itself is taken off again.
    """
    vx, vz, off_x, off_z = way
    v, r, s, per_span = weights
    rest = 1.0 - s
    x0, x1, z0, z1 = near[along_x, i], far[along_x, i], near[along_z, i], far[along_z, i]
    met0, met1 = near[shift, i] + vx * x0 + vz * z0, far[shift, i] + vx * x1 + vz * z1
    rate0, rate1 = near[rate, i] + met0, far[rate, i] + met1
    velocity = v[0] * near[value, i] + v[1] * rate0 + v[2] * far[value, i] + v[3] * rate1
    velocity += off_x * (rest * x0 + s * x1) + off_z * (rest * z0 + s * z1)
    acceleration = r[0] * near[value, i] + r[1] * rate0 + r[2] * far[value, i] + r[3] * rate1 - rest * met0 - s * met1
    acceleration += per_span * (off_x * (x1 - x0) + off_z * (z1 - z0))
    return velocity, acceleration


@stage
def _surface(near, far, i, way, weights):
    """Elevation over node i."""
    vx, vz, off_x, off_z = way
    v, r, s, per_span = weights
    x0, x1 = near[ETA_X, i], far[ETA_X, i]
    rate0, rate1 = near[ETA_T, i] + vx * x0, far[ETA_T, i] + vx * x1
    return v[0] * near[ETA, i] + v[1] * rate0 + v[2] * far[ETA, i] + v[3] * rate1 + off_x * ((1.0 - s) * x0 + s * x1)


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
    without a jump; otherwise both ends are summed. Without waves nothing is done. `work`: (WORK_SIZE,).
    """
    if window.shape[2] == 0 or not outdated(window_times, start, end):
        return
    far = max(start + sea.refresh, end)
    if window_times[0] <= start <= window_times[1]:
        _go_on(sea, start, size, position, window_times, window)
    else:
        sum_waves(sea, start, 0.0, size, position, velocity, work, window[0])
    sum_waves(sea, far, far - start, size, position, velocity, work, window[1])
    window_times[0], window_times[1] = start, far


@stage
def _go_on(sea, time, size, position, window_times, window):
    """Make what the window says at `time` (s), where the nodes are, its near end."""
    weights = _weights(time, window_times)
    s = weights[2]
    near, far = window[0], window[1]
    for i in range(size):
        x, z = sea.direction[0] * position[0, i] + sea.direction[1] * position[1, i], position[2, i]
        way = _way(near, far, i, x, z, s, weights[3])
        near[U, i], near[DU, i] = _flow(near, far, U, DU, U_SHIFT, U_X, U_Z, i, way, weights)
        near[W, i], near[DW, i] = _flow(near, far, W, DW, W_SHIFT, W_X, W_Z, i, way, weights)
        near[ETA, i] = _surface(near, far, i, way, weights)
        near[X, i], near[Z, i] = x, z
    for row in (U_SHIFT, U_X, U_Z, W_SHIFT, W_X, W_Z, ETA_T, ETA_X):
        for i in range(size):
            near[row, i] += s * (far[row, i] - near[row, i])


@stage
def streams(sea, time, size, position, window_times, window, stream, swell):
    """Water at the nodes at `time` (s): stream (3, n), its velocity (m/s); swell (4, n), the waves' acceleration (m/s^2) and
    elevation (m). Without waves and layers of current nothing changes, and they are left as they are.

    At a node above the surface it is the water of the surface under it: what is wet of its neighbourhood moves with that.
    """
    if window.shape[2] != 0:
        _interpolate(sea, time, size, position, window_times, window, stream, swell)
    elif sea.layer_bottom.size != 0:
        for k in range(3):
            for i in range(size):
                stream[k, i] = sea.current[k]
    if sea.layer_bottom.size != 0:
        add_layers(sea, size, position, stream)


@stage
def _interpolate(sea, time, size, position, window_times, window, stream, swell):
    weights = _weights(time, window_times)
    s, per_span = weights[2], weights[3]
    dx, dy = sea.direction[0], sea.direction[1]
    cx, cy, cz = sea.current[0], sea.current[1], sea.current[2]
    near, far, x, y, z = window[0], window[1], position[0], position[1], position[2]
    for i in range(size):
        way = _way(near, far, i, dx * x[i] + dy * y[i], z[i], s, per_span)
        u, a = _flow(near, far, U, DU, U_SHIFT, U_X, U_Z, i, way, weights)
        stream[0, i], stream[1, i] = cx + dx * u, cy + dy * u
        swell[0, i], swell[1, i] = dx * a, dy * a
    for i in range(size):
        way = _way(near, far, i, dx * x[i] + dy * y[i], z[i], s, per_span)
        w, a = _flow(near, far, W, DW, W_SHIFT, W_X, W_Z, i, way, weights)
        stream[2, i], swell[2, i] = cz + w, a
    for i in range(size):
        way = _way(near, far, i, dx * x[i] + dy * y[i], z[i], s, per_span)
        swell[3, i] = _surface(near, far, i, way, weights)
