"""How far tension histories are apart, in the three numbers of the trade: mean, dynamic, peak."""

from dataclasses import asdict, dataclass

import numpy as np

SMALL = 0.01  # of the largest of all lines: a line with a smaller mean, peak or standard deviation is held against this
STILL = 1e-3  # of the mean: the least standard deviation


@dataclass(frozen=True)
class Errors:
    """Per cent, the worst line of each: difference of the means over the mean; standard deviation of the difference over the standard deviation;
    difference of the maxima over the maximum. line: index of the line with the largest of all."""

    mean: float
    dynamic: float
    peak: float
    line: int

    @property
    def worst(self):
        return max(self.mean, self.dynamic, self.peak)

    def parts(self):
        """(3,) mean, dynamic, peak."""
        return np.array([self.mean, self.dynamic, self.peak])

    def as_dict(self):
        return asdict(self)


def errors_between(tension, reference):
    """Errors of `tension` against `reference`, both (k, lines) N."""
    mean, spread, peak = reference.mean(axis=0), reference.std(axis=0), reference.max(axis=0)
    difference = tension - reference
    of_line = 100.0 * np.array([
        np.abs(difference.mean(axis=0)) / _scale(mean, 0.0),
        difference.std(axis=0) / _scale(spread, STILL * np.abs(mean)),
        np.abs(tension.max(axis=0) - peak) / _scale(peak, 0.0),
    ])
    return Errors(*of_line.max(axis=1).tolist(), int(of_line.max(axis=0).argmax()))


def _scale(values, least):
    return np.maximum(np.maximum(values, least), max(SMALL * values.max(), 1e-300))
