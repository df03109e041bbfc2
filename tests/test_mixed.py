"""Fidelities line by line: each line as in a mooring of its fidelity alone, and together one mooring."""

from dataclasses import fields, replace

import numpy as np
import pytest
from parts_in_code import rod_type, world
from scenes_in_code import COUPLED, FIXED, FREE, HERE, SCENES, STILL, line_type, scene, surge_heave

from mooring_ros import Mooring, MooringError
from mooring_ros.fidelity import of_lines
from mooring_ros.mixed import MixedMooring
from mooring_ros.scene import BODY, Failure, RodEnd

MIX = {"line1": "dynamic", "line2": "quasi_static", "default": "linear"}
TIMES = np.arange(1, 41) * 0.25
MOTION = surge_heave(TIMES, 4.0, 2.0, 10.0, pitch=0.03)
ROPE = line_type(0.1, 100.0, 1e8, drag=1.0, added=1.0)


def settled(fidelity, file="oc4.txt", **settings):
    mooring = Mooring(SCENES / file, fidelity=fidelity, **settings)
    mooring.settle(HERE)
    return mooring


@pytest.fixture(scope="module")
def alone():
    """History of the whole mooring at each fidelity."""
    return {fidelity: settled(fidelity).run(TIMES, *MOTION) for fidelity in ("dynamic", "quasi_static", "linear")}


@pytest.fixture
def mixed():
    return settled(MIX)


def test_each_line_is_as_in_a_mooring_of_its_own_fidelity_and_the_wrench_is_their_sum(alone, mixed):
    history = mixed.run(TIMES, *MOTION)
    forces = np.zeros((TIMES.size, 3))
    for line, fidelity in enumerate(("dynamic", "quasi_static", "linear")):
        own = alone[fidelity]
        tolerance = 5e-3 if fidelity == "linear" else 2e-4  # a linear mooring of one line has ranges of its own; a dynamic one may take other steps
        for name in ("fairlead_tension", "anchor_tension", "fairlead_end_force", "stretched_length"):
            mine, theirs = getattr(history, name)[:, line], getattr(own, name)[:, line]
            np.testing.assert_allclose(mine, theirs, atol=tolerance * np.abs(theirs).max())
        forces += own.fairlead_end_force[:, line]
    np.testing.assert_allclose(history.wrench[:, :3], forces, atol=5e-3 * np.abs(forces).max())
    assert np.abs(alone["dynamic"].fairlead_tension[:, 1] - history.fairlead_tension[:, 1]).max() > 1e4  # the fidelities differ


def test_one_call_and_many_and_a_restored_snapshot_give_the_same_bits(mixed):
    single, twin = settled(MIX), mixed.twin()
    history = mixed.run(TIMES, *MOTION)
    for k in range(20):
        single.step(TIMES[k], MOTION[0][k], MOTION[1][k])
    saved = single.snapshot()
    single.run(TIMES[20:30], MOTION[0][20:30], MOTION[1][20:30])
    single.restore(saved)
    rest = single.run(TIMES[20:], MOTION[0][20:], MOTION[1][20:])
    for one in fields(history):
        np.testing.assert_array_equal(getattr(history, one.name)[20:], getattr(rest, one.name))
    np.testing.assert_array_equal(mixed.wrench, single.wrench)
    np.testing.assert_array_equal(twin.run(TIMES, *MOTION).wrench, history.wrench)


def test_everything_of_the_facade_answers_for_all_lines(mixed):
    uniform = settled("dynamic")
    mixed.step(0.1, HERE, STILL)
    uniform.step(0.1, HERE, STILL)
    for name in dir(Mooring):
        if not name.startswith("_"):
            assert getattr(MixedMooring, name) is not getattr(Mooring, name), f"{name} is that of a mooring of one fidelity"
    for name in ("line_names", "segments", "coupled_names", "scene", "solver"):
        assert getattr(mixed, name) == getattr(uniform, name)
    for name in ("wrench", "coupled_wrenches", "fairlead_tension", "anchor_end_force", "unstretched_length", "pose", "twist"):
        value = getattr(uniform, name)
        np.testing.assert_allclose(getattr(mixed, name), value, rtol=1e-5, atol=1e-5 * np.abs(value).max())
    np.testing.assert_allclose(mixed.stiffness(), uniform.stiffness(), rtol=1e-7, atol=1e-7 * np.abs(uniform.stiffness()).max())
    for line in mixed.line_names:
        for read in ("node_positions", "node_tension", "node_curvature"):
            value = getattr(uniform, read)(line)
            np.testing.assert_allclose(getattr(mixed, read)(line), value, rtol=1e-5, atol=1e-5 * np.abs(value).max())
    assert mixed.time == 0.1 and mixed.static_result.converged and mixed.step_limit.dt > 0.0
    assert mixed.energy.total == pytest.approx(uniform.energy.total, rel=1e-6)
    assert 0.0 <= mixed.error_estimate < 1e-6
    with pytest.raises(ValueError, match="no line 'line9'"):
        mixed.node_positions("line9")


def test_a_winch_and_a_release_reach_their_line_alone(mixed):
    before = mixed.fairlead_tension
    mixed.set_unstretched_length("line2", mixed.unstretched_length[1] - 2.0)
    after = mixed.fairlead_tension
    mixed.step(1.0, HERE, STILL)
    assert mixed.fairlead_tension[1] > 1.02 * before[1]
    np.testing.assert_allclose(after[[0, 2]], before[[0, 2]], rtol=1e-9)
    mixed.release("line3")
    mixed.step(2.0, HERE, STILL)
    assert mixed.fairlead_tension[2] < 0.8 * before[2] and mixed.fairlead_tension[0] == pytest.approx(before[0], rel=1e-3)


def test_a_step_that_one_fidelity_refuses_changes_none(mixed):
    mixed.step(0.25, MOTION[0][0], MOTION[1][0])
    wrench, tensions = mixed.wrench, mixed.fairlead_tension
    away = HERE + np.array([5e4, 0, 0, 0, 0, 0, 0])
    with pytest.raises(MooringError):
        mixed.step(0.5, away, STILL)
    with pytest.raises(ValueError, match="after the present one"):
        mixed.step(0.1, HERE, STILL)
    np.testing.assert_array_equal(mixed.wrench, wrench)
    np.testing.assert_array_equal(mixed.fairlead_tension, tensions)
    assert {mooring.time for mooring in mixed._moorings} == {0.25}
    poses = np.vstack([MOTION[0][1:4], away])
    with pytest.raises(MooringError) as failure:
        mixed.run(TIMES[1:5], poses, np.zeros((4, 6)))
    assert len(failure.value.history.time) == 3 and failure.value.history.wrench.shape == (3, 6)
    assert {mooring.time for mooring in mixed._moorings} == {TIMES[3]}


def test_what_two_fidelities_hold_on_to_has_its_loads_once():
    points = [(FIXED, (300, 0, -100)), (FIXED, (-300, 0, -100)), (COUPLED, (0, 0, -10), 5e3, 2.0, 1.0, 1.0), (COUPLED, (0, 5, -10), 1e3)]
    shared = scene(points, [(ROPE, 1, 3, 330.0, 8), (ROPE, 2, 3, 330.0, 8)], depth=100.0)
    whole, parts = (Mooring(shared, fidelity=fidelity) for fidelity in ("quasi_static", {"line1": "linear", "default": "quasi_static"}))
    for one in (whole, parts):
        one.settle(HERE)
    assert parts.coupled_names == ["point3", "point4"]
    np.testing.assert_allclose(parts.coupled_wrenches, whole.coupled_wrenches, rtol=1e-6, atol=1e-3)
    np.testing.assert_allclose(parts.wrench, whole.wrench, rtol=1e-6, atol=1e-3)


def test_a_coupled_body_may_hold_lines_of_several_fidelities():
    body = dict(kind=COUPLED, position=(0.0, 0.0, -10.0), mass=4e3, inertia=(1e3, 1e3, 1e3), volume=3.0, drag_area=(1.0,) * 6, added_mass=(1.0,) * 3)
    points = [(FIXED, (300, 0, -100)), (FIXED, (-300, 0, -100)), (BODY, (2, 0, 0), 0, 0, 0, 0, 1), (BODY, (-2, 0, 0), 0, 0, 0, 0, 1)]
    moored = world(points, [(ROPE, 1, 3, 330.0, 8), (ROPE, 2, 4, 330.0, 8)], bodies=[body], idle=False, depth=100.0)
    whole, parts = (Mooring(moored, fidelity=fidelity) for fidelity in ("dynamic", "line1=quasi_static,dynamic"))
    for one in (whole, parts):
        one.settle(HERE)
        one.step(0.1, HERE, STILL)
    assert parts.coupled_names == whole.coupled_names
    np.testing.assert_allclose(parts.coupled_wrenches, whole.coupled_wrenches, rtol=1e-5, atol=1.0)
    np.testing.assert_allclose(parts.body_poses["body1"], whole.body_poses["body1"])


@pytest.mark.parametrize("joint", ["point3", "rod1", "body1", "failure 1"])
def test_lines_that_something_joins_share_one_fidelity(joint):
    bridle = [(FIXED, (300, 0, -100)), (COUPLED, (0, 0, -10)), (FREE, (100, 0, -50), 100.0)]
    if joint == "point3":
        moored = scene(bridle, [(ROPE, 1, 3, 240.0, 8), (ROPE, 3, 2, 120.0, 8)], depth=100.0)
    elif joint == "rod1":
        rod = (rod_type(), FREE, (100.0, 0.0, -50.0), (99.0, 0.0, -50.0), 2)
        moored = world(bridle[:2], [(ROPE, 1, RodEnd(1, "A"), 240.0, 8), (ROPE, RodEnd(1, "B"), 2, 120.0, 8)], rods=[rod], idle=False, depth=100.0)
    elif joint == "body1":
        body = dict(kind=FREE, position=(100.0, 0.0, -50.0), mass=4e3, inertia=(1e3, 1e3, 1e3), volume=3.0)
        points = [*bridle[:2], (BODY, (1, 0, 0), 0, 0, 0, 0, 1), (BODY, (-1, 0, 0), 0, 0, 0, 0, 1)]
        moored = world(points, [(ROPE, 1, 3, 240.0, 8), (ROPE, 4, 2, 120.0, 8)], bodies=[body], idle=False, depth=100.0)
    else:
        moored = scene([*bridle[:2], (FIXED, (-300, 0, -100))], [(ROPE, 1, 2, 330.0, 8), (ROPE, 3, 2, 330.0, 8)], depth=100.0)
        moored = replace(moored, failures=(Failure(1, 2, (1, 2), time=5.0),))
    with pytest.raises(ValueError, match=f"{joint} joins lines of different fidelities .line1 dynamic, line2 linear."):
        Mooring(moored, fidelity="line1=dynamic,line2=linear")
    assert Mooring(moored, fidelity="line1=linear,line2=linear").fidelity == {"line1": "linear", "line2": "linear"}


@pytest.mark.parametrize(("fidelity", "words"), [
    ("line1=quick", "'quick'"), ("line9=linear", "line9"), ("line1=linear,line1=dynamic", "twice"), ("linear,dynamic", "twice"),
    ({"line1": "magic"}, "'magic'"), ("line1", "'line1' is not built"), ("", "'' is not built"),
])  # fmt: skip
def test_what_is_no_fidelity_is_refused_in_words(fidelity, words):
    with pytest.raises(ValueError, match=f"{words}.*expected"):
        Mooring(SCENES / "oc4.txt", fidelity=fidelity)


def test_a_text_and_a_mapping_say_the_same_and_lines_not_named_are_dynamic():
    names = ["line1", "line2", "line3"]
    assert of_lines(" line1 = linear, quasi_static", names) == {"line1": "linear", "line2": "quasi_static", "line3": "quasi_static"}
    assert of_lines({"line1": "linear", "default": "quasi_static"}, names) == of_lines("default=quasi_static,line1=linear", names)
    assert of_lines("line2=linear", names) == {"line1": "dynamic", "line2": "linear", "line3": "dynamic"}
