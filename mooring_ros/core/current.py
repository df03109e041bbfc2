"""A current that changes with depth: linear between the levels of its profile, constant beyond them."""

import numpy as np

from .cache import stage


def layers(current, profile):
    """(current (3,) below the lowest level, bottom (L,), height (L,), shear (3, L)) of a uniform current (3,) and rows (z, vx, vy, vz)."""
    rows = np.array(profile, dtype=float).reshape(-1, 4)
    base = np.array(current, dtype=float)
    if len(rows) == 0:
        return base, np.zeros(0), np.zeros(0), np.zeros((3, 0))
    height = np.diff(rows[:, 0])
    return base + rows[0, 1:], rows[:-1, 0].copy(), height, np.ascontiguousarray((np.diff(rows[:, 1:], axis=0) / height[:, None]).T)


@stage
def add_layers(sea, size, position, stream):
    """Add to stream (3, n) what each layer below the node adds to the current: its shear over the part of it that lies below."""
    z = position[2]
    for layer in range(sea.layer_bottom.size):
        bottom, height = sea.layer_bottom[layer], sea.layer_height[layer]
        sx, sy, sz = sea.layer_shear[0, layer], sea.layer_shear[1, layer], sea.layer_shear[2, layer]
        for i in range(size):
            below = min(max(z[i] - bottom, 0.0), height)
            stream[0, i] += sx * below
            stream[1, i] += sy * below
            stream[2, i] += sz * below
