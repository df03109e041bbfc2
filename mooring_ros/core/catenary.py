"""A first guess of a line's shape and tension: the inextensible catenary between its ends, hanging free or laid on the bed."""

import numpy as np
from scipy.optimize import brentq

NEARLY = 1e-6
NO_SCALE = 1e-9  # of the length: H/w of a line that hangs straight down


def guess(end_a, end_b, length, nodes, weight, stiffness, level):
    """Positions (3, nodes) (m), evenly spaced in unstretched length from end_a to end_b (3,), and tension (nodes,) (N) at them.

    `length` (m) is unstretched, `weight` (N/m) submerged: a light line hangs upwards. `stiffness` EA (N). `level` is the z (m) at which
    the line is held up: the bed's for a heavy line, the surface's for a light one.
    """
    along = np.linspace(0.0, length, nodes)
    chord = end_b - end_a
    distance = np.sqrt(chord @ chord)
    if weight == 0.0 or distance >= length * (1.0 - NEARLY):
        tension = max(stiffness * (distance / length - 1.0), 0.0) + abs(weight) * length + NEARLY * stiffness
        return end_a[:, None] + chord[:, None] * along / length, np.full(nodes, tension)
    plan = np.hypot(chord[0], chord[1])
    up = 1.0 if weight > 0.0 else -1.0  # a light line is a heavy one upside down
    reach, height, tension = _hanging(plan, up * chord[2], length, along, abs(weight))
    heights = up * (np.array([end_a[2], end_b[2]]) - level)
    if heights[0] + height.min() < 0.0 and heights.min() >= 0.0:
        reach, height, tension = _laid(plan, heights, length, along, abs(weight))
    height = up * height
    shape = np.empty((3, nodes))
    shape[:2] = end_a[:2, None] + chord[:2, None] * reach
    shape[2] = end_a[2] + height
    shape[:, -1] = end_b
    return shape, tension


def _hanging(plan, rise, length, along, weight):
    """Share of the plan distance, height above end A and tension of a free catenary."""
    span = max(plan, 1e-3 * length)  # legs side by side when the ends are above each other
    sag = np.sqrt(length**2 - rise**2)
    ratio = sag / span
    if ratio <= 1.0 + NEARLY:
        share = along / length
        return share, rise * share, np.full(along.size, weight * length)
    # sinh(k)/k = sag/span with k = span/(2 H/w)
    k = brentq(lambda k: np.log(np.sinh(k) / k / ratio), 1e-6, 20.0 + 2.0 * np.log(ratio))
    scale = span / (2.0 * k)  # H/w
    start = np.arctanh(np.clip(rise / length, -1.0 + 1e-12, 1.0 - 1e-12)) - k  # argument of the cosh at A
    arc = np.sinh(start) + along / scale
    height = scale * (np.sqrt(1.0 + arc**2) - np.cosh(start))
    return (np.arcsinh(arc) - start) * scale / span, height, weight * scale * np.sqrt(1.0 + arc**2)


def _laid(plan, heights, length, along, weight):
    """The same for a line with ends at `heights` (2,) (m) above a bed that it lies on in between."""

    def hanging(scale):  # arc length of the two legs
        return np.sqrt(heights**2 + 2.0 * heights * scale)

    def covered(scale):
        legs = hanging(scale)
        return (scale * np.arcsinh(legs / scale)).sum() + length - legs.sum()

    if covered(NO_SCALE * length) >= plan:  # slack: legs straight down, the rest heaped evenly between
        scale, legs = 0.0, heights
        spans = np.zeros(2)
    else:
        longest = 1.0
        while covered(longest) < plan and hanging(longest).sum() < length:
            longest *= 2.0
        scale = brentq(lambda scale: covered(scale) - plan, NO_SCALE * length, longest) if covered(longest) > plan else longest
        legs = hanging(scale)
        spans = scale * np.arcsinh(legs / scale)
    on_bed = max(length - legs.sum(), NEARLY * length)
    leg_a, leg_b = np.maximum(legs[0] - along, 0.0), np.maximum(along - (length - legs[1]), 0.0)
    lying = np.clip(along - legs[0], 0.0, on_bed)
    if scale > 0.0:
        x = spans[0] - scale * np.arcsinh(leg_a / scale) + scale * np.arcsinh(leg_b / scale)
        up = np.sqrt(scale**2 + leg_a**2) - scale + np.sqrt(scale**2 + leg_b**2) - scale
    else:
        x, up = np.zeros(along.size), leg_a + leg_b
    x = x + lying / on_bed * max(plan - spans.sum(), 0.0)
    tension = weight * np.sqrt(scale**2 + np.maximum(leg_a, leg_b) ** 2)
    return x / max(plan, 1e-300), up - heights[0], tension
