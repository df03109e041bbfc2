"""The implicit solver with everything a scene may contain, held against the explicit one."""

import dataclasses

import numpy as np
import pytest
from scenes_in_code import COUPLED, FIXED, FREE, HERE, SCENES, anchored, line_type, scene, surge_heave

from mooring_ros import Mooring
from mooring_ros.scene.description import Failure

from .random_parts import SCENES as KINDS
from .random_parts import random_scene


def both(made, times, poses, twists, dt):
    """{solver: (History, Mooring)}, the explicit one with the step of its own."""
    found = {}
    for solver in ("explicit", "implicit"):
        mooring = Mooring(made, solver=solver, dt=dt if solver == "implicit" else None)
        mooring.settle(HERE)
        found[solver] = mooring.run(times, poses, twists), mooring
    return found


def largest_difference(one, other):
    """Of the tensions at the fairleads, over the largest that they vary by or a hundredth of themselves."""
    variation = max((one.fairlead_tension.std(axis=0)).max(), 0.01 * np.abs(one.fairlead_tension).max())
    return np.sqrt(((one.fairlead_tension - other.fairlead_tension) ** 2).mean(axis=0)).max() / variation


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("kind", list(KINDS))
def test_parts_move_as_with_explicit_steps(kind, seed):
    made = random_scene(kind, seed)
    times = 0.05 * np.arange(1, 81)
    poses, twists = surge_heave(times, 0.3, 0.2, 4.0, pitch=0.03)
    found = both(made, times, poses, twists, 0.005)
    assert largest_difference(found["explicit"][0], found["implicit"][0]) < 0.05
    ours, theirs = found["implicit"][1], found["explicit"][1]
    for name, pose in ours.body_poses.items():
        assert pose == pytest.approx(theirs.body_poses[name], abs=0.01)


def test_a_rigid_pendulum_of_a_light_and_of_a_heavy_point():
    """A heavy point and a feather on one bridle swing as with explicit steps."""
    kind = line_type(0.02, 0.5, 1e5, -0.1)
    for mass in (1e-3, 1e7):
        points = [(FIXED, (-20, 0, -10)), (COUPLED, (20, 0, -10)), (FREE, (0, 0, -25), mass, mass / 1025.0, 1e-3, 0.5)]
        made = scene(points, [(kind, 1, 3, 25.0, 4), (kind, 2, 3, 25.0, 4)], depth=100.0)
        times = 0.1 * np.arange(1, 51)
        found = both(made, times, *surge_heave(times, 0.3, 0.2, 4.0), 0.005)
        assert largest_difference(found["explicit"][0], found["implicit"][0]) < 0.05


@pytest.mark.parametrize("file", ["volturnus_s_transverse_friction.txt", "volturnus_s_semi_taut_sideslope.txt"])
def test_friction_and_slopes(file):
    times = 0.1 * np.arange(1, 151)
    found = both(SCENES / file, times, *surge_heave(times), 0.01)
    assert largest_difference(found["explicit"][0], found["implicit"][0]) < 0.05


def test_lines_part_at_their_time_and_the_rest_goes_on():
    kind = line_type(0.1, 30.0, 2e6, -0.3, drag=1.2, added=1.0)
    points = [(FIXED, (-40, 0, -40)), (FIXED, (40, 0, -40)), (COUPLED, (0, 0, 0))]
    made = scene(points, [(kind, 1, 3, 60.0, 12), (kind, 2, 3, 60.0, 12)], depth=100.0)
    made = dataclasses.replace(made, failures=(Failure(1, 3, (1,), 1.03),))
    times = 0.25 * np.arange(1, 25)
    found = both(made, times, np.tile(HERE, (24, 1)), np.zeros((24, 6)), 0.02)
    mine, theirs = found["implicit"][0], found["explicit"][0]
    assert mine.fairlead_tension[3, 0] > 1e3 and mine.fairlead_tension[-1, 0] < 0.5 * mine.fairlead_tension[3, 0]
    places = [found[solver][1].node_positions("line1")[-1] for solver in ("implicit", "explicit")]
    assert places[0] == pytest.approx(places[1], abs=0.5)
    assert mine.fairlead_tension[-1, 1] == pytest.approx(theirs.fairlead_tension[-1, 1], rel=0.01)


def test_a_line_that_parts_with_a_sample_gives_the_same_bits_in_one_run_and_step_by_step():
    """What comes after the last step of an interval has other equations, too."""
    kind = line_type(0.1, 30.0, 2e6, -0.3, drag=1.2, added=1.0)
    points = [(FIXED, (-40, 0, -40)), (FIXED, (40, 0, -40)), (FREE, (0, 0, -15), 500.0), (COUPLED, (0, 0, 0))]
    made = scene(points, [(kind, 1, 3, 55.0, 8), (kind, 2, 3, 55.0, 8), (kind, 3, 4, 16.0, 4)], depth=100.0)
    made = dataclasses.replace(made, failures=(Failure(1, 3, (1,), 0.5),))
    times = 0.25 * np.arange(1, 9)
    poses, twists = surge_heave(times, 0.3, 0.2, 4.0)
    one, other = (Mooring(made, solver="implicit", dt=0.05) for _ in range(2))
    one.settle(HERE), other.settle(HERE)
    whole = one.run(times, poses, twists).fairlead_tension
    for k, sample in enumerate(zip(times, poses, twists)):
        other.step(*sample)
        assert (other.fairlead_tension == whole[k]).all()


def test_a_line_let_go_falls_as_with_explicit_steps():
    places = []
    for solver in ("implicit", "explicit"):
        mooring = Mooring(SCENES / "oc4.txt", solver=solver, dt=0.01 if solver == "implicit" else None)
        mooring.settle(HERE)
        mooring.release("line1")
        mooring.run(np.arange(1, 21) * 0.25, np.tile(HERE, (20, 1)), np.zeros((20, 6)))
        places.append(mooring.node_positions("line1")[-1])
    assert places[0] == pytest.approx(places[1], abs=0.2)


def test_the_rm3_cable_in_waves_keeps_its_deviations_in_steps_of_fifty_milliseconds():
    times = 0.1 * np.arange(1, 201)
    found = both(SCENES / "rm3_cable.txt", times, *surge_heave(times, 2.0, 2.0, 10.0), 0.05)
    mine, theirs = found["implicit"][0].fairlead_tension, found["explicit"][0].fairlead_tension
    assert mine.mean(axis=0) == pytest.approx(theirs.mean(axis=0), rel=0.01)
    assert mine.std(axis=0) == pytest.approx(theirs.std(axis=0), rel=0.03)


@pytest.mark.parametrize("law", [{"curve": ((0.0, 0.0), (0.1, 1e5))}, {"slow_stiffness": 1e6, "slow_damping": 1e6}])
def test_ropes_are_refused_by_name(law):
    kind = dataclasses.replace(line_type(name="stretchy"), **law)
    with pytest.raises(ValueError, match="stretchy"):
        Mooring(anchored(kind, (0, 0, -40), (30, 0, 0), 55.0, 5, depth=100.0), solver="implicit")
