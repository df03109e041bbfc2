"""The bed's shape: a plane, or depths over a rectangular grid, bilinear between.

Beyond the grid the depth is that of the nearest place on its edge. Grid lines may stand at any distances: evenly spaced bins, each with
one grid line at most, find the cell of a place in a fixed number of operations.
"""

from typing import NamedTuple

import numpy as np

from .cache import stage

MOST_BINS = 1_000_000


class Grid(NamedTuple):
    """Bed over X x Y grid lines; all arrays of size 0 when there is none."""

    x: np.ndarray  # (X,), m, growing
    y: np.ndarray  # (Y,), m, growing
    cells: np.ndarray  # (4, (X-1)(Y-1)): z at the cell's first corner (m), slopes along x and along y there, twist (1/m)
    bins_x: np.ndarray  # cell in which a bin begins
    bins_y: np.ndarray
    per_x: float  # bins a metre
    per_y: float


def build_grid(bathymetry):
    """Grid of a scene's Bathymetry, or an empty one for None. Raises ValueError for what is not a grid."""
    if bathymetry is None:
        none, empty = np.zeros(0), np.zeros(0, dtype=np.int64)
        return Grid(none, none, np.zeros((4, 0)), empty, empty, 0.0, 0.0)
    x, y = _grid_lines(bathymetry.x, "x"), _grid_lines(bathymetry.y, "y")
    z = -np.array(bathymetry.depth, dtype=float)
    if z.shape != (len(bathymetry.x), len(bathymetry.y)) or not np.isfinite(z).all():
        raise ValueError(f"bathymetry: expected a finite depth at each of {len(bathymetry.x)} x {len(bathymetry.y)} grid points, got {z.shape}")
    if len(bathymetry.x) == 1:
        z = np.vstack([z, z])
    if len(bathymetry.y) == 1:
        z = np.hstack([z, z])
    wide, long = np.diff(x)[:, None], np.diff(y)[None, :]
    corner = z[:-1, :-1]
    by_x, by_y = (z[1:, :-1] - corner) / wide, (z[:-1, 1:] - corner) / long
    twist = (z[1:, 1:] - z[1:, :-1] - z[:-1, 1:] + corner) / (wide * long)
    cells = np.array([part.ravel() for part in (corner, by_x, by_y, twist)])
    bins_x, per_x = _bins(x, "x")
    bins_y, per_y = _bins(y, "y")
    return Grid(x, y, cells, bins_x, bins_y, per_x, per_y)


def _grid_lines(values, name):
    lines = np.array(values, dtype=float)
    if lines.ndim != 1 or lines.size == 0 or not np.isfinite(lines).all() or (np.diff(lines) <= 0.0).any():
        raise ValueError(f"bathymetry: expected growing {name}, got {values}")
    return np.array([lines[0], lines[0] + 1.0]) if lines.size == 1 else lines


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
    first, last = lines[0], lines[lines.size - 1]
    held = place if place > first else first  # in this order what is not a number becomes the first line
    held = held if held < last else last
    cell = bins[np.int64((held - first) * per)]
    cell += 1 if held >= lines[cell + 1] and cell < lines.size - 2 else 0
    within = 1.0 if first <= place <= last else 0.0
    return cell, held - lines[cell], within


@stage
def grid_under(grid, x, y):
    """(z of the bed, its slopes along x and y) at x, y (m)."""
    i, u, within_x = _cell_along(grid.x, grid.bins_x, grid.per_x, x)
    j, v, within_y = _cell_along(grid.y, grid.bins_y, grid.per_y, y)
    cell = i * (grid.y.size - 1) + j
    by_x, by_y, twist = grid.cells[1, cell], grid.cells[2, cell], grid.cells[3, cell]
    slope_x, slope_y = by_x + twist * v, by_y + twist * u
    return grid.cells[0, cell] + u * slope_x + v * by_y, slope_x * within_x, slope_y * within_y
