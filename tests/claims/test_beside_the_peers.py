"""Cables in waves and lines on slopes, beside MoorDyn and CableDyn, whose figures are kept in benchmarks/data/ (docs/physics.md shows them all)."""

import pytest

from benchmarks import bathymetry, rm3_cable
from benchmarks.moordyn_deck import sea_components
from benchmarks.sea_motion import SeaMotion
from mooring_ros.scene import load_scene


@pytest.fixture(scope="module")
def umbilical():
    """{row: (mean, standard deviation)} of the RM3 umbilical in waves."""
    scene = load_scene(rm3_cable.SCENES / "rm3_cable.txt")
    motion = SeaMotion(*sea_components(scene.environment))
    return rm3_cable.statistics(rm3_cable.of_ours(scene, motion).after(motion.start))


@pytest.mark.parametrize("row", rm3_cable.load_peers())
def test_the_umbilical_in_waves_is_that_of_both_peers(umbilical, row):
    mean, deviation = umbilical[row]
    for peer_mean, peer_deviation in rm3_cable.load_peers()[row]:
        assert mean == pytest.approx(peer_mean, rel=rm3_cable.GOAL_MEAN)
        assert deviation == pytest.approx(peer_deviation, rel=rm3_cable.GOAL_DEVIATION)


@pytest.mark.parametrize("bed", bathymetry.BEDS)
def test_static_tensions_on_four_beds_are_those_of_the_peers(bed):
    for line, tension in enumerate(bathymetry.statics(bathymetry.scenes()[bed])):
        moordyn, cabledyn = bathymetry.load_statics()[bed, line]
        assert tension == pytest.approx(cabledyn, rel=2e-3)
        if line in bathymetry.SAME_LAW[bed]:
            assert tension == pytest.approx(moordyn, rel=2e-3)
