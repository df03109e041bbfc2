"""The free surface, still or in waves: only the wet part of a segment or point feels water."""

import numpy as np

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
    """Wet share of every node: what is wet of its half segments, or the wet cap of a point's sphere.

    A slice of a segment goes under evenly over its vertical extent, diameter x horizontal part of the axis; that is summed along the segment
    and shared between its nodes so that force and moment are those of the slices: exact for a rod that stands upright, of any fineness.
    """
    if state.swell.shape[1] > 0:
        _share(model, state.position[2], state.swell[3], state.tangent[2], 1.0, state.wet, scratch.wet_segment, scratch.wet_moment)
    else:
        _share(model, state.position[2], state.position[2], state.tangent[2], 0.0, state.wet, scratch.wet_segment, scratch.wet_moment)


@stage
def wet_part(deep, shallow, radius):
    """(wet share of a segment, surplus of its deep half): depths (m) of its ends' centres, and half the vertical extent of its slices (m).

    A slice at depth h is wet to g(h) = clip(h / 2r + 1/2, 0, 1). Along the segment g has the mean p and, with its end weighted from 0 at the
    shallow to 1 at the deep end, the mean p/2 + q/2; two integrals of g give both, a parabola where these would cancel.
    """
    r, span = max(radius, 1e-9), deep - shallow
    low, high = min(max(shallow / r, -1.0), 1.0), min(max(deep / r, -1.0), 1.0)
    under_low, under_high = 0.5 + 0.5 * low, 0.5 + 0.5 * high  # g at the ends
    above_low, above_high = max(shallow - r, 0.0), max(deep - r, 0.0)
    first_low, first_high = r * under_low * under_low + above_low, r * under_high * under_high + above_high
    second_low = r * r * (2.0 / 3.0 * under_low * under_low * under_low) + above_low * (r + 0.5 * above_low)
    second_high = r * r * (2.0 / 3.0 * under_high * under_high * under_high) + above_high * (r + 0.5 * above_high)
    flat = span < 0.01 * r
    inverse = 1.0 / max(span, 1e-12)
    mean = 0.5 * (under_low + under_high) if flat else (first_high - first_low) * inverse
    weighted = (first_high - (second_high - second_low) * inverse) * inverse
    surplus = (under_high - under_low) / 6.0 if flat else 2.0 * weighted - mean
    dry, all_under = deep <= -r, shallow >= r
    return (0.0 if dry else 1.0 if all_under else mean), (0.0 if dry or all_under else surplus)


@stage
def _share(model, z, elevation, steepness, waves, wet, part, moment):
    """Wet shares of nodes at heights z - waves x elevation (m) above the surface; `part`, `moment` (n,) get those of the segments, and the surplus of their right halves."""
    diameter, share_left, share_right = model.diameter, model.share_left, model.share_right
    for i in range(model.size):
        flat = np.sqrt(max(1.0 - steepness[i + 1] * steepness[i + 1], 0.0))
        left, right = waves * elevation[i] - z[i], waves * elevation[i + 1] - z[i + 1]
        mean, surplus = wet_part(max(left, right), min(left, right), 0.5 * diameter[i + 1] * flat)
        part[i + 1] = mean
        moment[i + 1] = surplus if right > left else -surplus
    for i in range(model.size):
        wet[i] = 1.0 + share_left[i] * (part[i] + moment[i] - 1.0) + share_right[i] * (part[i + 1] - moment[i + 1] - 1.0)
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
