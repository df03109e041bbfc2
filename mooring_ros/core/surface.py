"""The free surface, still or in waves: only the wet part of a segment or point feels water."""

from .cache import stage


@stage
def reaches_above(model, state, level):
    """True when any node stands higher than `level` (m) above the surface."""
    z = state.position[2]
    above = 0
    if state.swell.shape[1] > 0:
        elevation = state.swell[3]
        for i in range(model.size):
            above |= z[i] - elevation[i] > level
    else:
        for i in range(model.size):
            above |= z[i] > level
    return above != 0


@stage
def all_wet(model, state):
    wet = state.wet
    for i in range(model.size):
        wet[i] = 1.0


@stage
def wet_shares(model, state, scratch):
    """Wet share of every node: the wet lengths of its half segments, or the wet cap of a point's sphere.

    A segment between depths a and b, a cylinder of diameter d, is taken to go under evenly over the vertical extent |a - b| + d, which is
    exact for a steep one and has the right ends for one that lies in the surface.
    """
    if state.swell.shape[1] > 0:
        _share(model, state.position[2], state.swell[3], 1.0, state.wet, scratch.wet_segment)
    else:
        _share(model, state.position[2], state.position[2], 0.0, state.wet, scratch.wet_segment)


@stage
def _share(model, z, elevation, waves, wet, part):
    """Wet shares of nodes at heights z - waves x elevation (m) above the surface; `part` (n,) gets those of the segments."""
    diameter, share_left, share_right = model.diameter, model.share_left, model.share_right
    for i in range(model.size):
        radius = 0.5 * diameter[i + 1]
        left, right = waves * elevation[i] - z[i], waves * elevation[i + 1] - z[i + 1]
        deep = max(left, right) + radius
        shallow = min(left, right) - radius
        part[i + 1] = (max(deep, 0.0) - max(shallow, 0.0)) / max(deep - shallow, 1e-9)
    for i in range(model.size):
        wet[i] = 1.0 + share_left[i] * (part[i] - 1.0) + share_right[i] * (part[i + 1] - 1.0)
    for p in range(model.point_node.size):
        node = model.point_node[p]
        if node >= model.size or share_left[node] + share_right[node] > 0.0:  # merely held, or on a rod, whose segments count
            continue
        height = z[node] - waves * elevation[node]
        if model.point_diameter[p] > 0.0:
            under = min(max(0.5 - height / model.point_diameter[p], 0.0), 1.0)
            wet[node] = under * under * (3.0 - 2.0 * under)
        else:
            wet[node] = 1.0 if height <= 0.0 else 0.0
