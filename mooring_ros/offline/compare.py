"""Two histories of one quantity side by side: means, spreads, differences, lag and correlation. Arrays in, numbers out."""

from dataclasses import dataclass

import numpy as np

# A periodic history fits itself again one period later. Among lags that fit this nearly as well as the best, the shortest is meant.
_AS_GOOD = 5e-3
_SAME_TIME = 1e-9  # s
_LONGEST_LAG = 0.25  # of the common span


@dataclass(frozen=True)
class Common:
    """Two histories at the same instants: times (n,) s; result, reference (n,); how they got there, in words."""

    times: np.ndarray
    result: np.ndarray
    reference: np.ndarray
    method: str


@dataclass(frozen=True)
class Comparison:
    """How a result differs from its reference. None stands for what is not defined: a share of zero, the lag of a constant."""

    mean_result: float
    mean_reference: float
    mean_difference_percent: float | None  # 100 (μ_result − μ_reference) / μ_reference
    std_result: float
    std_reference: float
    std_difference_percent: float | None  # 100 (σ_result − σ_reference) / σ_reference
    rms_difference: float
    rms_percent_of_std: float | None  # of the reference's standard deviation
    peak_difference: float  # the largest absolute difference
    peak_difference_time: float  # s, when that is
    lag: float | None  # s, positive when the result comes later
    correlation: float | None  # at no lag


def common_base(times_result, result, times_reference, reference):
    """Both histories at the sample times of the coarser one within their common span; the finer one interpolated linearly.

    times (n,) s, increasing; values (n,). Raises ValueError when fewer than two samples are common.
    """
    start, end = max(times_result[0], times_reference[0]), min(times_result[-1], times_reference[-1])
    if not end > start:
        raise ValueError(
            f"no overlap in time: the result spans {times_result[0]:.6g} to {times_result[-1]:.6g} s, "
            f"the reference {times_reference[0]:.6g} to {times_reference[-1]:.6g} s"
        )
    if len(times_result) == len(times_reference) and np.all(np.abs(times_result - times_reference) <= _SAME_TIME):
        return Common(times_reference, result, reference, "same sample times, nothing interpolated")
    reference_is_coarser = _typical_step(times_reference) >= _typical_step(times_result)
    times = times_reference if reference_is_coarser else times_result
    times = times[(times >= start) & (times <= end)]
    if len(times) < 2:
        raise ValueError(f"the histories share only {len(times)} sample times between {start:.6g} and {end:.6g} s, expected at least 2")
    finer, coarser = ("result", "reference") if reference_is_coarser else ("reference", "result")
    return Common(
        times,
        np.interp(times, times_result, result),
        np.interp(times, times_reference, reference),
        f"at the sample times of the {coarser} within the common span, the {finer} interpolated linearly",
    )


def compare(common):
    """Comparison of the two histories of a Common."""
    result, reference = common.result, common.reference
    difference = result - reference
    peak = int(np.argmax(np.abs(difference)))
    rms = float(np.sqrt(np.mean(difference**2)))
    std_result, std_reference = _spread(result), _spread(reference)
    return Comparison(
        mean_result=float(result.mean()),
        mean_reference=float(reference.mean()),
        mean_difference_percent=_percent(result.mean() - reference.mean(), reference.mean()),
        std_result=std_result,
        std_reference=std_reference,
        std_difference_percent=_percent(std_result - std_reference, std_reference),
        rms_difference=rms,
        rms_percent_of_std=_percent(rms, std_reference),
        peak_difference=float(abs(difference[peak])),
        peak_difference_time=float(common.times[peak]),
        lag=lag(common.times, result, reference),
        correlation=_correlation(result, reference),
    )


def lag(times, result, reference):
    """By how many seconds the result comes after the reference, from the best correlation of their overlapping parts.

    Looked for up to a quarter of the span either way, between samples by a parabola; None when there is no best one
    (a constant, a fit that is as good everywhere, or best at the end of the range). times (n,) s, increasing; values (n,).
    """
    if _spread(result) == 0.0 or _spread(reference) == 0.0 or len(times) < 8:
        return None
    even = np.linspace(times[0], times[-1], len(times))
    step = even[1] - even[0]
    later, earlier = np.interp(even, times, result), np.interp(even, times, reference)
    longest = max(2, int(_LONGEST_LAG * len(even)))
    shifts = np.arange(-longest, longest + 1)
    fit = _correlation_at(shifts, later - later.mean(), earlier - earlier.mean())
    inner = np.flatnonzero((fit[1:-1] >= fit[:-2]) & (fit[1:-1] >= fit[2:])) + 1
    if np.ptp(fit) < _AS_GOOD or len(inner) == 0 or fit[inner].max() < fit.max() - _AS_GOOD:
        return None
    candidates = inner[fit[inner] >= fit.max() - _AS_GOOD]
    best = candidates[np.argmin(np.abs(shifts[candidates]))]
    before, here, after = fit[best - 1 : best + 2]
    bend = before - 2.0 * here + after
    offset = 0.5 * (before - after) / bend if bend < 0.0 else 0.0
    return float((shifts[best] + offset) * step)


def _correlation_at(shifts, later, earlier):
    """Pearson's correlation of later[i + shift] with earlier[i] over the samples that both have, for each shift (0 if undefined)."""
    n = len(later)
    size = 1 << (2 * n - 1).bit_length()
    products = np.fft.irfft(np.fft.rfft(later, size) * np.conj(np.fft.rfft(earlier, size)), size)[shifts]
    first_later, first_earlier = np.maximum(shifts, 0), np.maximum(-shifts, 0)
    samples = n - np.abs(shifts)
    sum_later, squares_later = (_window_sums(values, first_later, samples) for values in (later, later**2))
    sum_earlier, squares_earlier = (_window_sums(values, first_earlier, samples) for values in (earlier, earlier**2))
    covariance = products - sum_later * sum_earlier / samples
    spread = (squares_later - sum_later**2 / samples) * (squares_earlier - sum_earlier**2 / samples)
    smallest = 1e-20 * (later @ later) * (earlier @ earlier)
    return np.where(spread > smallest, covariance / np.sqrt(np.maximum(spread, smallest)), 0.0)


def _window_sums(values, first, samples):
    total = np.concatenate([[0.0], np.cumsum(values)])
    return total[first + samples] - total[first]


def _correlation(result, reference):
    if _spread(result) == 0.0 or _spread(reference) == 0.0:
        return None
    a, b = result - result.mean(), reference - reference.mean()
    return float(np.clip(a @ b / np.sqrt((a @ a) * (b @ b)), -1.0, 1.0))


def _spread(values):
    """Standard deviation; exactly zero for a constant, whatever rounding makes of its mean."""
    return 0.0 if np.ptp(values) == 0.0 else float(values.std())


def _percent(part, whole):
    return float(100.0 * part / whole) if whole != 0.0 else None


def _typical_step(times):
    return float(np.median(np.diff(times))) if len(times) > 1 else np.inf
