"""Rigid parts at rest: on the bed, in the surface, between lines that bend, and what they hand to the platform and the ground."""

import dataclasses

import numpy as np
import pytest
from parts_in_code import G, RHO, mooring, rod_type, world
from scenes_in_code import COUPLED, FIXED, HERE, STILL, difference, line_type, same_bits, times_quaternion, turn
from scipy.spatial.transform import Rotation

from mooring_ros import Mooring, MooringError
from mooring_ros.scene.description import BODY, COUPLED_PINNED, FREE, PINNED, Friction, RodEnd

FEATHER = line_type(np.sqrt(4e-3 / (np.pi * RHO)), 1e-3, 1e5, name="feather")  # weighs nothing in water


def test_clump_weight_lies_as_deep_in_the_bed_as_its_weight_says():
    """Depth (m - rho V) g / (kBot pi d^2/4) below the bed, 1e-6, with the line's end beside it on the bed; the line to the platform is slack."""
    mass, volume = 2000.0, 0.3
    points = [(COUPLED, (0, 0, -60)), (BODY, (0, 0, 0), 0.0, 0.0, 0.0, 0.0, 1)]
    body = dict(kind=FREE, position=(0.0, 0.0, -99.0), mass=mass, volume=volume, inertia=(80.0,) * 3)
    clump = mooring(points, [(FEATHER, 1, 2, 50.0, 10)], bodies=[body], idle=False, depth=100.0)
    clump.settle(HERE)
    diameter = (6.0 * volume / np.pi) ** (1.0 / 3.0)
    depth = (mass - RHO * volume) * G / (3e6 * (0.25 * np.pi * diameter**2 + FEATHER.diameter * 2.5))
    assert -100.0 - clump.body_poses["body1"][2] == pytest.approx(depth, rel=1e-6)
    assert clump.fairlead_tension[0] < 2.0


def on_slope(rise):
    friction = Friction("stick", 0.6, 0.6, 0.5, 0.5)
    points = [(COUPLED, (0, 0, -60)), (BODY, (0, 0, 0), 0.0, 0.0, 0.0, 0.0, 1)]
    body = dict(kind=FREE, position=(0.0, 0.0, -100.0), mass=2000.0, volume=0.3, inertia=(80.0,) * 3)
    return world(points, [(FEATHER, 1, 2, 80.0, 4)], bodies=[body], idle=False, depth=100.0, bed_slope=(rise, 0.0), friction=friction)


def test_clump_weight_stays_on_a_slope_that_friction_holds():
    """Rise 0.3, static coefficient 0.6: it moves less than 1 mm in 20 s after the statics."""
    clump = Mooring(on_slope(0.3))
    clump.settle(HERE)
    before = clump.body_poses["body1"]
    for k in range(1, 41):
        clump.step(0.5 * k, HERE, STILL)
    assert np.linalg.norm(clump.body_poses["body1"][:3] - before[:3]) < 1e-3


def on_water(position_a, position_b, kind, segments):
    """A free rod with a slack line to the ground from its end A."""
    points = [(FIXED, (position_a[0], position_a[1], -60.0))]
    lines = [(FEATHER, 1, RodEnd(1, "A"), 100.0, 200)]
    return mooring(points, lines, [(kind, FREE, position_a, position_b, segments)], idle=False, depth=100.0)


@pytest.mark.parametrize("segments", [1, 8])
def test_rod_of_half_the_waters_density_lies_half_submerged(segments):
    """Both ends at the still water level, 1e-3 of the diameter."""
    diameter = 0.8
    kind = rod_type(diameter, 0.5 * RHO * 0.25 * np.pi * diameter**2)
    rod = on_water((0.0, 0.0, -0.1), (9.0, 0.0, -0.1), kind, segments)
    rod.settle(HERE)
    assert np.abs(rod.rod_positions("rod1")[:, 2]).max() < 1e-3 * diameter


@pytest.mark.parametrize("segments", [1, 7])
def test_spar_floats_upright_at_its_draught(segments):
    """A rod of density 0.7 with a weight in its lower end: draught (m + m_w) / (rho A), upright, 1e-4 of its length, from 10 degrees off."""
    length, diameter, ballast = 12.0, 1.0, 3000.0
    area = 0.25 * np.pi * diameter**2
    kind = rod_type(diameter, 0.4 * RHO * area)
    bottom = np.array([0.0, 0.0, -8.0])
    top = bottom + length * np.array([np.sin(0.17), 0.0, np.cos(0.17)])
    points = [(FIXED, (0.0, 0.0, -60.0)), (BODY, (0.0, 0.0, 0.0), ballast, 0.0, 0.0, 0.0, 1)]
    body = dict(kind=FREE, position=tuple(bottom))
    rods = [(kind, BODY, (0.0, 0.0, 0.0), tuple(top - bottom), segments, 1)]
    spar = mooring(points, [(FEATHER, 1, 2, 100.0, 1)], rods, [body], idle=False, depth=100.0)
    spar.settle(HERE)
    a, b = spar.rod_positions("rod1")
    draught = (0.4 * RHO * area * length + ballast) / (RHO * area)
    assert -a[2] == pytest.approx(draught, abs=1e-4 * length)
    assert np.linalg.norm(b[:2] - a[:2]) < 1e-4 * length


def test_rod_lies_on_the_bed_as_deep_as_its_weight_says():
    """(m - rho A) g / (kBot d) at both ends, 0.5 %; beside end A the end of a line touches the bed."""
    kind = rod_type(0.4, 400.0)
    rod = on_water((0.0, 0.0, -99.0), (5.0, 0.0, -98.0), kind, 5)
    rod.settle(HERE)
    depth = (400.0 - RHO * 0.25 * np.pi * 0.4**2) * G / (3e6 * 0.4)
    np.testing.assert_allclose(-100.0 - rod.rod_positions("rod1")[:, 2], depth, rtol=5e-3)


# -- bending --------------------------------------------------------------------------------------------------------------------------


def bending_type(rigidity=2e4, mass=1e-3):
    return dataclasses.replace(line_type(0.05, mass, 1e9, name="beam"), bending_stiffness=rigidity)


DRY = dict(water_density=0.0, bed_stiffness=0.0, bed_damping=0.0)


@pytest.mark.parametrize("segments", [20])
def test_cantilever_with_a_rigid_middle_bends_like_two_beams_joined_by_it(segments):
    """Tip deflection by a small force P: P/3EI (L^3 - (L - a)^3 + c^3) with the first beam to a and the second of length c: 0.5 %."""
    a, rigid, c, rigidity, force = 4.0, 2.0, 3.0, 2e4, 5.0
    x = -50.0
    rods = [
        (rod_type(), FIXED, (-1.0, 0.0, x), (0.0, 0.0, x), 1),
        (rod_type(0.05, 1e-3), FREE, (a, 0.0, x), (a + rigid, 0.0, x), 2),
    ]
    kind, length = bending_type(mass=1e-6), a + rigid + c
    points = [("free", (length, 0.0, x), force / G)]
    lines = [(kind, RodEnd(1, "B"), RodEnd(2, "A"), a, segments), (kind, RodEnd(2, "B"), 1, c, segments)]
    beam = mooring(points, lines, rods, idle=True, **DRY)
    beam.settle(HERE)
    want = force / (3.0 * rigidity) * (length**3 - (length - a) ** 3 + c**3)
    assert x - beam.node_positions("line2")[-1, 2] == pytest.approx(want, rel=5e-3)


def test_free_joint_of_length_zero_makes_one_line_of_two():
    """A clamped line of 2 x 10 segments through a free joint and one of 20: shape within 1e-3 of the length."""
    kind, z = bending_type(mass=5.0), -50.0
    clamps = [(rod_type(), FIXED, (-1.0, 0.0, z), (0.0, 0.0, z), 1), (rod_type(), FIXED, (10.0, 0.0, z), (11.0, 0.0, z), 1)]
    joint = (rod_type(), FREE, (5.0, 0.0, z), (5.0, 0.0, z), 0)
    two = mooring([], [(kind, RodEnd(1, "B"), RodEnd(3, "A"), 5.0, 10), (kind, RodEnd(3, "B"), RodEnd(2, "A"), 5.0, 10)], [*clamps, joint], **DRY)
    one = mooring([], [(kind, RodEnd(1, "B"), RodEnd(2, "A"), 10.0, 20)], clamps, **DRY)
    two.settle(HERE)
    one.settle(HERE)
    joined = np.vstack([two.node_positions("line1"), two.node_positions("line2")[1:]])
    np.testing.assert_allclose(joined, one.node_positions("line1"), atol=1e-2 * np.ptp(one.node_positions("line1")[:, 2]))


# -- what is handed over --------------------------------------------------------------------------------------------------------------


def test_moment_of_a_cantilever_on_a_coupled_rod_is_force_times_arm():
    """Wrench of rod and clamp at end A: all weights, each times its arm, 1e-8."""
    kind, z, tip = bending_type(mass=5.0), -50.0, 20.0
    rods = [(rod_type(0.2, 10.0), COUPLED, (-1.0, 0.0, z), (0.0, 0.0, z), 2)]
    beam = mooring([("free", (6.0, 0.0, z), tip)], [(kind, RodEnd(1, "B"), 1, 6.0, 12)], rods, **DRY)
    beam.settle(HERE)
    at, nodes = beam.coupled_names.index("rod1"), beam.node_positions("line1")
    weights = np.full(13, 5.0 * 0.5 * G)
    weights[[0, -1]] *= 0.5
    weights[-1] += tip * G
    moment = (weights * (nodes[:, 0] + 1.0)).sum() + 10.0 * G * 0.5
    force = weights.sum() + 10.0 * G
    np.testing.assert_allclose(beam.coupled_wrenches[at], [0.0, 0.0, -force, 0.0, moment, 0.0], atol=1e-8 * moment)


def everything(yaw=0.0, rigidity=3e4, **water):
    """Bridle with a body, clamped lines, free, pinned and coupled rods, a coupled body, points; anchors turned by `yaw`."""
    turned = Rotation.from_euler("z", yaw)

    def at(x, y, z):
        return tuple(turned.apply([x, y, z]))

    chain, rope = line_type(0.1, 60.0, 3e7, name="chain"), dataclasses.replace(line_type(0.08, 12.0, 2e7, name="cable"), bending_stiffness=rigidity)
    points = [
        (FIXED, at(-250.0, 10.0, -100.0)),
        (BODY, (-1.0, 0.0, 0.3), 50.0, 0.0, 0.0, 0.0, 1),
        (BODY, (1.0, 0.8, 0.2), 0.0, 0.0, 0.0, 0.0, 1),
        (BODY, (1.0, -0.8, 0.2), 0.0, 0.0, 0.0, 0.0, 1),
        (COUPLED, (-20.0, 12.0, -6.0)),
        (COUPLED, (-20.0, -12.0, -6.0), 100.0, 0.05),
        (FIXED, at(200.0, 60.0, -100.0)),
        (BODY, (0.5, 0.2, -1.0), 20.0, 0.01, 0.0, 0.0, 2),
    ]
    bodies = [
        dict(kind=FREE, position=at(-70.0, 5.0, -40.0), orientation=tuple(turned.as_quat()), mass=1500.0, centre_of_gravity=(0.1, 0.0, -0.4), inertia=(300.0, 400.0, 500.0), volume=0.8),
        dict(kind=COUPLED, position=(20.0, 5.0, -8.0), orientation=tuple(turn([1, 2, 3], 0.4)), mass=900.0, centre_of_gravity=(0.2, 0.1, -0.3), inertia=(90.0, 70.0, 50.0), volume=0.4),
    ]
    rods = [
        (rod_type(0.3, 150.0), FREE, at(90.0, 30.0, -60.0), at(84.0, 28.0, -58.0), 3),
        (rod_type(0.3, 80.0), COUPLED, (22.0, -6.0, -5.0), (23.0, -6.5, -7.0), 2),
        (rod_type(0.3, 80.0), COUPLED_PINNED, (5.0, 20.0, -9.0), (5.0, 20.0, -14.0), 2),
        (rod_type(0.2, 90.0), PINNED, at(-10.0, -80.0, -99.0), at(-10.0, -78.0, -93.0), 2),
    ]
    lines = [
        (chain, 1, 2, 198.0, 20),
        (chain, 3, 5, 70.0, 8),
        (chain, 4, 6, 70.0, 8),
        (rope, 7, RodEnd(1, "A"), 118.0, 15),
        (rope, RodEnd(1, "B"), RodEnd(2, "B"), 92.0, 15),
        (rope, RodEnd(4, "B"), RodEnd(3, "B"), 126.0, 15),
        (chain, 1, 8, 300.0, 20),
    ]
    return world(points, lines, rods, bodies, idle=False, depth=100.0, **water)


TILTED = np.concatenate([[3.0, -2.0, 1.0], times_quaternion(turn([0, 0, 1], 0.2), turn([1, 2, 0], 0.05))])


def test_anchors_platform_and_weights_are_in_balance():
    """Newton's third law: forces on anchors, bed and platform carry all that weighs, moments too: 1e-9 of the weight (times 100 m)."""
    all_of_it = Mooring(everything())
    all_of_it.settle(TILTED)
    model, state = all_of_it._model, all_of_it._state
    x, last = state.position[:, : model.size], model.size
    loads = np.zeros((3, last))
    loads[2] = (state.wet * model.buoyancy - model.weight)[:last] + (model.bed_stiffness * np.maximum(model.bed_level - state.position[2], 0.0))[:last]
    taken, moments = all_of_it.wrench[:3].copy(), all_of_it.wrench[3:] + np.cross(TILTED[:3], all_of_it.wrench[:3])
    fixed = [p for p in range(model.point_kind.size) if model.point_kind[p] == 0]
    for node in [model.point_node[p] for p in fixed] + [n for n, p in zip(model.end_node, state.end_point) if p in fixed]:
        taken += state.force[:, node]
        moments += np.cross(state.position[:, node], state.force[:, node])
    pins = [b for b in range(model.rigid.mass.size) if model.rigid.pin[b] in fixed]
    for b in pins:
        taken += state.parts_reaction[b, :3]
        moments += np.cross(state.parts[b, :3], state.parts_reaction[b, :3])
    weight = np.abs(loads).sum()
    np.testing.assert_allclose(taken, loads.sum(axis=1), atol=1e-8 * weight)
    np.testing.assert_allclose(moments, np.cross(x.T, loads.T).sum(axis=0), atol=1e-8 * weight * 100.0)


def test_everything_turned_about_the_vertical_gives_turned_wrenches():
    """Scene and platform turned by 50 degrees: 1e-6 of the largest force and moment, at rest and after 2 s of motion."""
    yaw = np.radians(50.0)
    turned, spun = Rotation.from_euler("z", yaw), turn([0, 0, 1], yaw)
    here, there = Mooring(everything(), dt=0.01), Mooring(everything(yaw), dt=0.01)
    twist = np.array([0.3, -0.2, 0.1, 0.01, 0.02, 0.03])
    pairs = []
    for mooring_, change in ((here, False), (there, True)):
        def pose(values):
            return np.concatenate([turned.apply(values[:3]), times_quaternion(spun, values[3:])]) if change else values

        mooring_.settle(pose(TILTED))
        rows = [mooring_.coupled_wrenches]
        speed = np.concatenate([turned.apply(twist[:3]), turned.apply(twist[3:])]) if change else twist
        for k in range(1, 21):
            t = 0.1 * k
            moved = np.concatenate([TILTED[:3] + twist[:3] * t, times_quaternion(turn(twist[3:], np.linalg.norm(twist[3:]) * t), TILTED[3:])])
            mooring_.step(t, pose(moved), speed)
            rows.append(mooring_.coupled_wrenches)
        pairs.append(np.array(rows))
    a, b = pairs
    size = np.abs(a).max(axis=(0, 1)).reshape(2, 3).max(axis=1).repeat(3)
    for row in (0, -1):
        for part in (slice(0, 3), slice(3, 6)):
            np.testing.assert_allclose(b[row][:, part], turned.apply(a[row][:, part]), atol=1e-6 * size[part.start])


@pytest.mark.parametrize("pose", [HERE, TILTED], ids=["at rest", "moved and turned"])
@pytest.mark.parametrize("rigidity", [0.0, 3e4])
def test_stiffness_with_rods_and_bodies_is_the_derivative_of_the_settled_wrench(pose, rigidity):
    """Free, pinned and coupled rods, bodies with arms, lines clamped to rods: 1e-6 of the matrix's scale; without a bed, whose contact has kinks."""
    all_of_it = Mooring(everything(rigidity=rigidity, bed_stiffness=0.0, bed_damping=0.0))
    want = difference(all_of_it, pose, [1e-3] * 3 + [4e-5] * 3)
    all_of_it.settle(pose)
    scale = np.sqrt(np.outer(np.abs(np.diag(want)), np.abs(np.diag(want))))
    assert (np.abs(all_of_it.stiffness() - want) / scale).max() < 1e-6


def test_refused_step_and_restored_snapshot_leave_every_bit_of_the_parts():
    """A step that stretches lines beyond what is plausible is refused; the same step after a restore has the same bits."""
    all_of_it = Mooring(everything())
    all_of_it.settle(TILTED)
    all_of_it.step(0.1, TILTED, STILL)
    before, far = all_of_it.snapshot(), TILTED + np.array([5000.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    with pytest.raises(MooringError):
        all_of_it.step(0.2, far, STILL)
    assert same_bits(before, all_of_it.snapshot())
    all_of_it.step(0.2, TILTED, STILL)
    after = all_of_it.snapshot()
    all_of_it.restore(before)
    all_of_it.step(0.2, TILTED, STILL)
    assert same_bits(after, all_of_it.snapshot())
