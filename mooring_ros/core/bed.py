"""The bed of a scene: its shape, its normal and its roughness."""

from typing import NamedTuple

import numpy as np

from ..scene.description import SATURATED as SATURATED_LAW
from .bathymetry import Grid, build_grid, grid_under
from .cache import kernel, stage
from .friction import MODULUS, NO_FRICTION, SATURATED, STICK
from .packed import packed


@packed
class Ground(NamedTuple):
    """The bed of a scene."""

    on: bool  # whether the bed is other than flat and smooth
    grid: Grid
    level: float  # z at the origin of a plane bed, m
    slope: tuple  # its rise along x and along y
    law: int  # NO_FRICTION, SATURATED or STICK
    static_axial: float
    static_across: float
    kinetic_axial: float
    kinetic_across: float
    directional: float  # 1, or 0 where friction acts against the velocity as a whole
    ramp: float  # c_v, N s/m: below the speed N / c_v the saturated law creeps
    stiffness_ratio: float  # tangential over normal stiffness of `stick`
    damping_ratio: float  # ... and damping: of the same share of critical


def build_ground(environment):
    """Ground of a scene's Environment. Raises ValueError where it makes no sense."""
    slope = tuple(float(rise) for rise in environment.bed_slope)
    if environment.bathymetry is not None and slope != (0.0, 0.0):
        raise ValueError("bed: expected a bathymetry grid or a slope, got both")
    friction = environment.friction
    law, coefficients, ramp, directional = NO_FRICTION, (0.0, 0.0, 0.0, 0.0), 0.0, 1.0
    if friction is not None:
        law = SATURATED if friction.law == SATURATED_LAW else STICK
        coefficients = (friction.static_axial, friction.static_transverse, friction.kinetic_axial, friction.kinetic_transverse)
        if not all(0.0 <= kinetic <= static < np.inf for static, kinetic in zip(coefficients[:2], coefficients[2:])):
            raise ValueError(f"bed friction: expected static coefficients not below the kinetic ones and none negative, got {coefficients}")
        ramp = float(friction.ramp)
        directional = 0.0 if law == SATURATED and getattr(friction, "isotropic", False) else 1.0
    ratio = max(MODULUS / environment.bed_stiffness, 1.0) if environment.bed_stiffness > 0.0 else 1.0
    return Ground(
        law != NO_FRICTION or environment.bathymetry is not None or slope != (0.0, 0.0),
        build_grid(environment.bathymetry),
        -float(environment.depth),
        slope,
        law,
        *(float(value) for value in coefficients),
        directional,
        ramp,
        float(ratio),
        float(np.sqrt(ratio)),
    )


def bed_at(ground, x, y):
    """z (m) of the bed and its unit normal at x, y (m) of any one shape: an array (4, *shape)."""
    x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
    place, bed = np.zeros((3, x.size)), np.zeros((4, x.size))
    place[0], place[1], place[2] = x.ravel(), y.ravel(), -np.inf
    bed_under(ground, x.size, place, bed)
    return bed.reshape(4, *x.shape)


def bed_level(ground, x, y):
    """z (m) of the bed at x, y (m), of their shape."""
    return bed_at(ground, x, y)[0]


@stage
def unit_normal(slope_x, slope_y):
    up = 1.0 / np.sqrt(1.0 + slope_x * slope_x + slope_y * slope_y)
    return -slope_x * up, -slope_y * up, up


@kernel
def bed_under(ground, size, position, bed):
    """bed (4, n): z of the bed under each node (m) and its unit normal.

    Under a node above all of a grid: the grid's highest z and a vertical normal, which is enough to know that it does not touch.
    """
    x, y, place_z = position[0], position[1], position[2]
    level, nx, ny, nz = bed[0], bed[1], bed[2], bed[3]
    if ground.grid.x.size == 0:
        slope_x, slope_y = ground.slope
        normal_x, normal_y, normal_z = unit_normal(slope_x, slope_y)
        for i in range(size):
            level[i] = ground.level + slope_x * x[i] + slope_y * y[i]
            nx[i] = normal_x
            ny[i] = normal_y
            nz[i] = normal_z
    else:
        for i in range(size):
            z, slope_x, slope_y = ground.grid.top, 0.0, 0.0
            if not place_z[i] > z:
                z, slope_x, slope_y = grid_under(ground.grid, x[i], y[i])
            level[i] = z
            nx[i], ny[i], nz[i] = unit_normal(slope_x, slope_y)
