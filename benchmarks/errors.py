"""How far two tension histories are apart."""

import numpy as np
from scipy.interpolate import CubicSpline


def dynamic_difference(times, tension, reference_times, reference, start):
    """Rms difference after ``start`` over the reference's standard deviation, for each line.

    times (n,), tension (n, lines), reference_times (m,), reference (m, lines); the reference is interpolated to ``times``.
    """
    times, tension = np.asarray(times), np.asarray(tension)
    reference_times, reference = np.asarray(reference_times), np.asarray(reference)
    end = min(times[-1], reference_times[-1])
    keep = (times >= start) & (times <= end)
    if keep.sum() < 100:
        raise ValueError(f"only {keep.sum()} samples between {start} s and {end} s: the difference would say nothing")
    there = CubicSpline(reference_times, reference)(times[keep])
    deviation = reference[(reference_times >= start) & (reference_times <= end)].std(axis=0)
    return np.sqrt(((tension[keep] - there) ** 2).mean(axis=0)) / deviation
