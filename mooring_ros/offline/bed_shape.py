"""The depth of the water, in words."""

import itertools


def depths(environment):
    """One phrase: depth, and what the bed is like where it is not flat."""
    grid, (slope_x, slope_y) = environment.bathymetry, environment.bed_slope
    if grid is not None:
        values = list(itertools.chain.from_iterable(grid.depth))
        return (
            f"depth {min(values):.4g} to {max(values):.4g} m on a grid of {len(grid.x)} × {len(grid.y)}, "
            f"x {grid.x[0]:.4g} to {grid.x[-1]:.4g} m, y {grid.y[0]:.4g} to {grid.y[-1]:.4g} m"
        )
    if slope_x or slope_y:
        return f"depth {environment.depth:.4g} m at the origin, the bed rises by {slope_x:.4g} along x and {slope_y:.4g} along y"
    return f"depth {environment.depth:.4g} m"
