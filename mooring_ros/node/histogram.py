"""Histograms of times, cheap enough for every cycle, fine enough for percentiles."""
import math

PER_DECADE = 20
DECADES = 7         # from 1 us to 10 s
BINS = PER_DECADE * DECADES + 2


class Histogram:
    """counts[k]: times above 10^((k − 1)/20) us and up to 10^(k/20) us; the first bin has all up to 1 us, the last all above 10 s. most: ns, exact."""

    def __init__(self):
        self.counts = [0] * BINS
        self.most = 0

    def add(self, time):
        """A time in ns."""
        self.counts[_bin(time)] += 1
        if time > self.most:
            self.most = time

    def quantile(self, share):
        """The upper edge (ns) of the bin in which this share of all times is reached, not above the largest; 0 when there are none."""
        return quantile(self.counts, share, self.most)


def edge(k):
    """Upper edge of bin k, ns."""
    return 1e3 * 10.0 ** (k / PER_DECADE)


def quantile(counts, share, most):
    """As Histogram.quantile, of its counts and its largest time (ns)."""
    wanted, reached = share * sum(counts), 0
    for k, count in enumerate(counts):
        reached += count
        if count and reached >= wanted:
            return min(edge(k), most) if k < BINS - 1 else most
    return 0


def _bin(time):
    return 0 if time <= 1000 else min(math.ceil(PER_DECADE * math.log10(1e-3 * time) - 1e-9), BINS - 1)
