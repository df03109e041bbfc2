"""The bed's shape: depths over a rectangular grid, bilinear between.

Beyond the grid the depth is that of the nearest place on its edge: another ring of cells says so, level outwards. Depths are bilinear to
the bit; slopes, which jump from cell to cell, go over into each other within 2 % of a cell on both sides of a grid line, so that what lies
in a crease finds a place to rest. Grid lines may stand at any distances: evenly spaced bins, each with one grid line at most, find the cell
of a place in a fixed number of operations.
"""

from typing import NamedTuple

import numpy as np

from .cache import stage
from .packed import packed

ROUNDED = 0.02  # of the narrower cell
MOST_BINS = 1_000_000


@packed
class Grid(NamedTuple):
    """Bed over X x Y grid lines, the ring beyond the given ones included; all arrays of size 0 when there is none."""

    x: np.ndarray  # (X,), m, growing
    y: np.ndarray  # (Y,), m, growing
    z: np.ndarray  # ((X-1)(Y-1),), m, at the first corner of each cell; cells of one x follow each other
    slope_x: np.ndarray  # ... slope along x there
    slope_y: np.ndarray  # ... slope along y
    twist: np.ndarray  # ... 1/m: change of the slope along x with y
    round_x: np.ndarray  # (X,), m on both sides of each line over which slopes go over
    round_y: np.ndarray  # (Y,)
    bins_x: np.ndarray  # cell in which a bin begins
    bins_y: np.ndarray
    per_x: float  # bins a metre
    per_y: float
    top: float  # highest z, m


def build_grid(bathymetry):
    """Grid of a scene's Bathymetry, or an empty one for None. Raises ValueError for what is not a grid."""
    if bathymetry is None:
        none, empty = np.zeros(0), np.zeros(0, dtype=np.int64)
        return Grid(none, none, none, none, none, none, none, none, empty, empty, 0.0, 0.0, 0.0)
    x, y = _grid_lines(bathymetry.x, "x"), _grid_lines(bathymetry.y, "y")
    z = -np.array(bathymetry.depth, dtype=float)
    if z.shape != (len(bathymetry.x), len(bathymetry.y)) or not np.isfinite(z).all():
        raise ValueError(f"bathymetry: expected a finite depth at each of {len(bathymetry.x)} x {len(bathymetry.y)} grid points, got {z.shape}")
    z = np.pad(z, 1, mode="edge")
    wide, long = np.diff(x)[:, None], np.diff(y)[None, :]
    corner = z[:-1, :-1]
    by_x, by_y = (z[1:, :-1] - corner) / wide, (z[:-1, 1:] - corner) / long
    twist = (z[1:, 1:] - z[1:, :-1] - z[:-1, 1:] + corner) / (wide * long)
    cells = (part.ravel() for part in (corner, by_x, by_y, twist))
    bins_x, per_x = _bins(x, "x")
    bins_y, per_y = _bins(y, "y")
    return Grid(x, y, *cells, _rounding(x), _rounding(y), bins_x, bins_y, per_x, per_y, float(z.max()))


def _grid_lines(values, name):
    """(X,) grid lines, with one more on each side."""
    lines = np.array(values, dtype=float)
    if lines.ndim != 1 or lines.size == 0 or not np.isfinite(lines).all() or (np.diff(lines) <= 0.0).any():
        raise ValueError(f"bathymetry: expected growing {name}, got {values}")
    first, last = (1.0, 1.0) if lines.size == 1 else (lines[1] - lines[0], lines[-1] - lines[-2])
    return np.concatenate([[lines[0] - first], lines, [lines[-1] + last]])


def _rounding(lines):
    width = np.diff(lines)
    return np.concatenate([[0.0], ROUNDED * np.minimum(width[1:], width[:-1]), [0.0]])


def _bins(lines, name):
    """(cell in which each bin begins, bins a metre). One bin more than fit takes the place on the last grid line itself."""
    span = lines[-1] - lines[0]
    count = int(np.ceil(span / np.diff(lines).min() * (1.0 + 1e-9))) + 1
    if count > MOST_BINS:
        raise ValueError(f"bathymetry: {name} has grid lines closer than a {MOST_BINS}th of its width of {span:g} m")
    begin = lines[0] + span / count * np.arange(count + 1)
    cells = np.searchsorted(lines, begin, side="right") - 1
    return np.clip(cells, 0, lines.size - 2), count / span


@stage
def _cell_along(lines, bins, per, place):
    """(cell, m from its first line); beyond the grid the middle of the last cell."""
    last = lines.size - 2
    least, most = 0.5 * (lines[0] + lines[1]), 0.5 * (lines[last] + lines[last + 1])
    held = place if place > least else least  # in this order what is not a number becomes the first
    held = held if held < most else most
    cell = bins[np.int64((held - lines[0]) * per)]
    cell += 1 if held >= lines[cell + 1] else 0
    return cell, held - lines[cell]


@stage
def _mixed(lines, rounding, cell, within, slopes, twist, at, stride, across):
    """Slope in cell `at`, mixed with that of the neighbour `stride` before or after it near the grid line between them."""
    slope = slopes[at] + twist[at] * across
    width = lines[cell + 1] - lines[cell]
    first = within < 0.5 * width
    distance = within if first else width - within
    band = rounding[cell] if first else rounding[cell + 1]
    if distance < band:
        other = at - stride if first else at + stride
        slope += (0.5 - 0.5 * distance / band) * (slopes[other] + twist[other] * across - slope)
    return slope


@stage
def grid_under(grid, x, y):
    """(z of the bed, its slopes along x and y) at x, y (m)."""
    i, u = _cell_along(grid.x, grid.bins_x, grid.per_x, x)
    j, v = _cell_along(grid.y, grid.bins_y, grid.per_y, y)
    row = grid.y.size - 1
    at = i * row + j
    z = grid.z[at] + u * (grid.slope_x[at] + grid.twist[at] * v) + v * grid.slope_y[at]
    slope_x = _mixed(grid.x, grid.round_x, i, u, grid.slope_x, grid.twist, at, row, v)
    slope_y = _mixed(grid.y, grid.round_y, j, v, grid.slope_y, grid.twist, at, 1, u)
    return z, slope_x, slope_y
