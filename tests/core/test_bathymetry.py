"""The bed's shape, and contact along its normal."""

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator

from mooring_ros.core.bed import bed_at, bed_level, bed_under, build_ground
from mooring_ros.scene import Environment
from mooring_ros.scene.description import Bathymetry, Friction

from .one_node import Nodes, norms

X = np.array([-400.0, -380.0, -150.0, -149.0, 20.0, 333.0])
Y = np.array([-90.0, 10.0, 200.0, 1000.0])
DEPTH = 200.0 + np.random.default_rng(4).normal(0.0, 20.0, (X.size, Y.size))


def grid(x=X, y=Y, depth=DEPTH, **more):
    shape = Bathymetry(tuple(x), tuple(y), tuple(map(tuple, np.asarray(depth))))
    return build_ground(Environment(depth=200.0, bathymetry=shape, **more))


def test_the_bed_is_bilinear_between_grid_points():
    rng = np.random.default_rng(1)
    x, y = rng.uniform(X[0], X[-1], 5000), rng.uniform(Y[0], Y[-1], 5000)
    reference = RegularGridInterpolator((X, Y), -DEPTH)(np.array([x, y]).T)
    assert np.abs(bed_level(grid(), x, y) - reference).max() < 1e-11


def test_grid_points_have_their_own_depth():
    x, y = np.meshgrid(X, Y, indexing="ij")
    assert np.abs(bed_level(grid(), x, y) + DEPTH).max() < 1e-11


def test_an_even_grid_of_many_lines_is_found_cell_by_cell():
    x, y = np.linspace(0.0, 1.0, 1001) * 700.0, np.linspace(-3.0, 5.0, 37)
    depth = np.random.default_rng(2).uniform(50.0, 60.0, (1001, 37))
    here, there = np.random.default_rng(3).uniform(0.0, 700.0, 3000), np.random.default_rng(5).uniform(-3.0, 5.0, 3000)
    reference = RegularGridInterpolator((x, y), -depth)(np.array([here, there]).T)
    assert np.abs(bed_level(grid(x, y, depth), here, there) - reference).max() < 1e-10


def test_normals_are_those_of_the_surface():
    rng = np.random.default_rng(6)
    x, y, h = rng.uniform(X[0] + 1, X[-1] - 1, 500), rng.uniform(Y[0] + 1, Y[-1] - 1, 500), 1e-4
    band = 0.02  # of the narrower cell: where slopes go over into each other
    far = np.ones(500, dtype=bool)
    for place, lines in ((x, X), (y, Y)):
        width = np.pad(np.diff(lines), 1, mode="edge")
        far &= (np.abs(place[:, None] - lines) > band * np.minimum(width[1:], width[:-1]) + h).all(axis=1)
    assert far.mean() > 0.8
    bed = grid()
    slope_x = (bed_level(bed, x + h, y) - bed_level(bed, x - h, y)) / (2.0 * h)
    slope_y = (bed_level(bed, x, y + h) - bed_level(bed, x, y - h)) / (2.0 * h)
    normal = np.array([-slope_x, -slope_y, np.ones(500)])
    assert np.abs((bed_at(bed, x, y)[1:] - normal / norms(normal))[:, far]).max() < 1e-7


def test_beyond_the_grid_the_depth_is_that_of_the_nearest_place_on_its_edge():
    rng = np.random.default_rng(7)
    x, y = rng.uniform(-2000.0, 2000.0, 2000), rng.uniform(-2000.0, 2000.0, 2000)
    nearest = np.clip(x, X[0], X[-1]), np.clip(y, Y[0], Y[-1])
    bed = bed_at(grid(), x, y)
    assert np.array_equal(bed[0], bed_level(grid(), *nearest))
    assert (bed[1][(x < X[0] - 1.0) | (x > X[-1] + 10.0)] == 0.0).all() and (bed[2][(y < Y[0] - 10.0) | (y > Y[-1] + 20.0)] == 0.0).all()


def test_normals_turn_without_a_jump_from_cell_to_cell_and_at_the_edge():
    ground, h = grid(), 1e-6
    for lines, axis in ((X, 0), (Y, 1)):
        for line in lines:
            for other in (-85.0, 55.0, 400.0):
                path = np.full((2, 2001), other)
                path[axis] = line + np.linspace(-20.0, 20.0, 2001)
                step = np.abs(np.diff(bed_at(ground, *path)[1:], axis=1)).max()
                path[axis] = np.repeat(line, 2001) + np.linspace(-h, h, 2001)
                assert np.abs(np.diff(bed_at(ground, *path)[1:], axis=1)).max() < 1e-6 * max(step, 1.0)


@pytest.mark.parametrize("wild", [np.nan, np.inf, -np.inf, 1e300, -1e300, 0.0])
def test_no_place_makes_the_bed_of_a_grid_anything_but_finite(wild):
    x, y = np.meshgrid(np.concatenate([X, np.nextafter(X, 1e9), np.nextafter(X, -1e9), [wild]]), np.concatenate([Y, [wild]]))
    bed = bed_at(grid(), x, y)
    assert np.isfinite(bed).all() and np.abs(norms(bed[1:]) - 1.0).max() < 1e-14


def test_a_grid_of_one_line_is_even_along_it():
    bed = grid(x=[5.0], y=Y, depth=DEPTH[:1])
    assert np.abs(bed_level(bed, np.array([-30.0, 5.0, 5.5, 80.0]), np.full(4, 60.0)) - bed_level(bed, 5.0, 60.0)).max() < 1e-12


def test_a_slope_rises_from_its_level_at_the_origin():
    bed = build_ground(Environment(depth=100.0, bed_slope=(0.125, -0.05)))
    assert bed.on
    assert bed_level(bed, np.array([0.0, 400.0, 0.0]), np.array([0.0, 0.0, 100.0])) == pytest.approx([-100.0, -50.0, -105.0])
    assert bed_at(bed, 3.0, 4.0)[1:] * np.sqrt(1.0 + 0.125**2 + 0.05**2) == pytest.approx([-0.125, 0.05, 1.0])


def test_a_flat_smooth_bed_is_off():
    assert not build_ground(Environment(depth=100.0)).on


@pytest.mark.parametrize(
    "wrong",
    [
        dict(x=X[::-1]),
        dict(y=[0.0, 0.0, 1.0, 2.0]),
        dict(depth=DEPTH[1:]),
        dict(depth=np.where(DEPTH == DEPTH.max(), np.nan, DEPTH)),
        dict(x=[]),
        dict(bed_slope=(0.1, 0.0)),
        dict(x=[0.0, 1e-7, 1.0, 2.0, 3.0, 4.0]),
    ],
)
def test_what_is_no_grid_is_refused(wrong):
    with pytest.raises(ValueError, match="bathymetry"):
        grid(**wrong)


# -- contact ----------------------------------------------------------------------------------------------------------------------------

SLOPED = dict(bed_slope=(0.3, -0.2))


@pytest.mark.parametrize("step", [0.0, 1e-3, 0.1])
def test_contact_is_the_spring_and_damper_at_the_place_after_the_step(step):
    nodes = Nodes(build_ground(Environment(depth=100.0, **SLOPED)))
    force = nodes.forces(step)
    after = nodes.along_normal(nodes.velocity[:, : nodes.n]) + step * nodes.along_normal(nodes.accelerations(force))
    push = np.maximum(nodes.stiffness * (nodes.depth - step * after) - nodes.damping * after, 0.0)
    push[nodes.depth <= 0.0] = 0.0
    assert (push > 0.0).any() and (push == 0.0).any()
    assert np.abs(force - push * nodes.n_hat).max() < 1e-10 * push.max()


@pytest.mark.parametrize("law", [None, "saturated", "stick"])
@pytest.mark.parametrize("step", [0.0, 1e-3, 0.1])
def test_the_bed_never_pulls(law, step):
    friction = law and Friction(law, 1.0, 1.5, 0.8, 1.2)
    for depths in ({}, {"bathymetry": Bathymetry(tuple(X), tuple(Y), tuple(map(tuple, DEPTH)))}):
        nodes = Nodes(build_ground(Environment(depth=100.0, friction=friction, **depths)), deep=0.5, speed=1.0)
        force = nodes.forces(step)
        assert np.isfinite(force).all()
        assert nodes.along_normal(force).min() > -1e-9 * norms(force).max()
        assert not force[:, nodes.depth <= 0.0].any()


@pytest.mark.parametrize("law", [None, "saturated", "stick"])
@pytest.mark.parametrize("step", [0.0, 2e-3])
def test_a_flat_bed_turned_into_a_slope_gives_the_same_forces_turned(law, step):
    friction = law and Friction(law, 1.0, 1.5, 0.8, 1.2, ramp=1e5)
    slope = 0.125
    flat = Nodes(build_ground(Environment(depth=0.0, friction=friction)))
    flat.grip[3] = np.resize([0.0, 1.0, -1.0], flat.n + 1)
    flat.grip[:3] = flat.position + np.random.default_rng(8).normal(0.0, 1e-4, flat.position.shape)
    reference = flat.forces(step)
    up = np.arctan(slope)
    turn = np.array([[np.cos(up), 0.0, -np.sin(up)], [0.0, 1.0, 0.0], [np.sin(up), 0.0, np.cos(up)]])
    sloped = Nodes(build_ground(Environment(depth=0.0, friction=friction, bed_slope=(slope, 0.0))))
    for name in ("position", "velocity", "load", "direction"):
        setattr(sloped, name, turn @ getattr(flat, name))
    for name in ("stiffness", "damping", "normal", "axial"):
        setattr(sloped, name, getattr(flat, name))
    sloped.grip[:3], sloped.grip[3] = turn @ flat.grip[:3], flat.grip[3]
    # positions of 100 m are turned to the last bit only, and the stiffest spring is 100 times the bed's
    rounding = 1e-12 * norms(reference).max() + 1e-13 * 100.0 * flat.stiffness.max() * (100.0 if law == "stick" else 1.0)
    assert np.abs(sloped.forces(step) - turn @ reference).max() < rounding


def test_a_bed_under_many_nodes_is_that_under_each():
    bed, place = np.zeros((4, 200)), np.random.default_rng(9).uniform(-500.0, 500.0, (3, 200))
    ground = grid()
    bed_under(ground, 200, place, bed)
    low = place[2] <= -DEPTH.min()
    assert low.any() and not low.all()
    assert np.array_equal(bed[:, low], bed_at(ground, place[0], place[1])[:, low])
    assert (bed[0] < place[2])[~low].all()  # what is above all of the grid needs to know no more
