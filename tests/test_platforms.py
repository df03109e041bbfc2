"""Several coupled bodies that move by themselves, with lines between them."""

import dataclasses

import numpy as np
import pytest
from scenes_in_code import HERE, SCENES, same_bits, surge_heave, times_quaternion, turn
from scipy.optimize import fsolve

from mooring_ros import Mooring, MooringError
from mooring_ros.core.poses import moved
from mooring_ros.mooring import composed
from mooring_ros.scene import COUPLED, FIXED, load_scene, parse_scene

NAMES = ["body1", "body2"]
PAIR = SCENES / "oc4_pair.txt"
TIMES = np.arange(1, 61) * 0.1
OFF = np.array([3.0, -2.0, 1.0, 0.02, -0.03, 0.05, -4.0, 1.5, -0.5, -0.01, 0.04, -0.08])  # of both floaters, m and rad


def pair(names=NAMES, scene=PAIR, **settings):
    return Mooring(scene, platforms=names, **settings)


def settled(pose=None, **settings):
    mooring = pair(**settings)
    mooring.settle(mooring.pose_in_file if pose is None else pose)
    return mooring


def carried(poses, twists, at):
    """Poses (k, platforms, 7) and twists (k, platforms, 6) of bodies that stand at poses `at` on one platform that moves so."""
    own = np.array([[np.concatenate(composed(pose, body)) for body in at] for pose in poses])
    arms = own[:, :, :3] - poses[:, None, :3]
    rates = np.broadcast_to(twists[:, None, 3:], arms.shape)
    return own, np.concatenate([twists[:, None, :3] + np.cross(rates, arms), rates], axis=2)


def total(wrenches, poses, about):
    """Wrench (k, 6) of wrenches (k, platforms, 6) together, about the places (k, 3)."""
    moments = wrenches[:, :, 3:] + np.cross(poses[:, :, :3] - about[:, None], wrenches[:, :, :3])
    return np.concatenate([wrenches[:, :, :3], moments], axis=2).sum(axis=1)


def close(found, expected, share):
    assert np.abs(found - expected).max() <= share * np.abs(expected).max()


@pytest.mark.parametrize("settings", [{}, {"solver": "implicit", "dt": 0.05}, {"fidelity": "quasi_static"}], ids=["explicit", "implicit", "quasi_static"])
def test_platforms_that_move_alike_are_one_platform(settings):
    """Tensions 1e-11 (what rounding of places 500 m away makes in stiff lines) and the total wrench 1e-9 of those of the same scene on one platform: carried along, and in the statics turned as well."""
    pitch = 0.05 if "fidelity" in settings else 0.0  # between samples, places on a turning platform follow arcs, and poses of their own cubics
    poses, twists = surge_heave(TIMES[:20], pitch=pitch)
    one, two = Mooring(PAIR, **settings), settled(**settings)
    one.settle(HERE)
    single = one.run(TIMES[:20], poses, twists)
    both, rates = carried(poses, twists, two.pose_in_file)
    found = two.run(TIMES[:20], both, rates)
    assert found.wrench.shape == (20, 2, 6)
    close(found.fairlead_tension, single.fairlead_tension, 1e-11)
    close(found.anchor_end_force, single.anchor_end_force, 1e-11)
    close(total(found.wrench, both, poses[:, :3])[:, :3], single.wrench[:, :3], 1e-9)
    close(total(found.wrench, both, poses[:, :3])[:, 3:], single.wrench[:, 3:], 1e-9)


def test_turning_platforms_come_to_one_platform_as_samples_get_closer():
    """Arcs and cubics between samples differ by the fourth power of the interval, their accelerations by the second: 3 times less in half of it, at least."""
    off = []
    for count in (10, 20):
        times = np.arange(1, count + 1) * 4.0 / count
        poses, twists = surge_heave(times, pitch=0.1)
        one, two = Mooring(PAIR), settled()
        one.settle(HERE)
        single = one.run(times, poses, twists)
        found = two.run(times, *carried(poses, twists, two.pose_in_file))
        off.append(np.abs(found.fairlead_tension - single.fairlead_tension)[-1].max())
    assert off[1] < off[0] / 3.0


def test_a_platform_at_rest_holds_lines_as_the_ground_does():
    """Tensions along the shared line and the other platform's wrench to 1e-12."""
    scene = load_scene(PAIR)
    grounded = dataclasses.replace(scene, bodies=tuple(dataclasses.replace(body, kind=FIXED) if body.id == 2 else body for body in scene.bodies))
    poses, twists = surge_heave(TIMES, surge=8.0, pitch=0.05)
    both, alone = settled(), settled(names=["body1"], scene=grounded)
    at_rest = np.tile(both.pose_in_file[1], (TIMES.size, 1))
    first, rates = carried(poses, twists, both.pose_in_file[:1])
    expected = alone.run(TIMES, first, rates)
    found = both.run(TIMES, np.stack([first[:, 0], at_rest], axis=1), np.stack([rates[:, 0], np.zeros((TIMES.size, 6))], axis=1))
    close(both.node_tension("line5"), alone.node_tension("line5"), 1e-12)
    close(found.wrench[:, 0], expected.wrench[:, 0], 1e-12)


def test_a_shared_line_pulls_its_ends_with_its_weight_and_momentum():
    """Third law: what both platforms feel of a line that hangs between them is its weight in water at rest, to 1e-9 of the forces, and moments about
    any place balance; in motion without water and gravity the impulse is the change of the line's momentum, 1e-3."""
    scene = load_scene(PAIR)
    only = dataclasses.replace(scene, lines=scene.lines[4:], points=tuple(point for point in scene.points if point.kind != FIXED))
    kind, line, env = scene.line_types[0], scene.lines[4], scene.environment
    mooring = settled(moved(pair().pose_in_file, OFF), scene=only)
    force = total(mooring.wrench[None], mooring.pose[None], np.zeros((1, 3)))[0]
    weight = (kind.mass - env.water_density * 0.25 * np.pi * kind.diameter**2) * env.gravity * line.length
    size = np.abs(mooring.wrench[:, :3]).max()
    np.testing.assert_allclose(force[:3], [0.0, 0.0, -weight], atol=1e-9 * size)
    nodes = mooring.node_positions("line5")
    share = np.full(len(nodes), 1.0)
    share[[0, -1]] = 0.5
    centre = (share[:, None] * nodes).sum(axis=0) / share.sum()
    np.testing.assert_allclose(force[3:], np.cross(centre, [0.0, 0.0, -weight]), atol=1e-9 * size * 500.0)

    empty = dataclasses.replace(only, environment=dataclasses.replace(env, gravity=0.0, water_density=0.0))
    mooring = settled(scene=empty, segments=10)
    poses, twists = surge_heave(np.arange(1, 1201) * 0.005, surge=2.0, period=4.0)
    both, rates = carried(poses, twists, mooring.pose_in_file)
    both[:, 1], rates[:, 1] = mooring.pose_in_file[1], 0.0
    history = mooring.run(np.arange(1, 1201) * 0.005, both, rates)
    lumps = np.full(11, kind.mass * line.length / 10.0)
    lumps[[0, -1]] *= 0.5
    velocity = (mooring._state.velocity + mooring._state.lead)[:, :11]
    impulse = 0.005 * history.wrench[:, :, :3].sum(axis=(0, 1))
    np.testing.assert_allclose(-impulse, velocity @ lumps, atol=1e-3 * np.abs(history.wrench[:, :, :3]).max())


def hanging(chord, length, stiffness, weight):
    """Forces (3,) at the ends A and B of an elastic catenary that touches nothing, on what holds them (Irvine, Cable Structures, 1981)."""
    span = np.hypot(*chord[:2])
    across = np.array([*chord[:2], 0.0]) / span

    def ends(forces):
        h, v = forces * weight * length  # v: vertical pull at B
        x = h / weight * (np.arcsinh(v / h) - np.arcsinh((v - weight * length) / h)) + h * length / stiffness
        z = (np.hypot(h, v) - np.hypot(h, v - weight * length)) / weight + length * (v - 0.5 * weight * length) / stiffness
        return x - span, z - chord[2]

    h, v = fsolve(ends, [0.9, 0.5], xtol=1e-13) * weight * length
    return h * across + [0.0, 0.0, v - weight * length], -h * across - [0.0, 0.0, v]


@pytest.mark.parametrize("off", [0.0 * OFF, OFF, [20.0, 30.0, 5.0, 0.1, 0.0, 0.3, -10.0, -40.0, -3.0, 0.0, 0.2, 0.1]], ids=["in place", "near", "far"])
def test_a_shared_line_is_the_catenary_between_the_places_of_its_ends(off):
    """Both end forces at 400 segments within 1e-4."""
    mooring = pair(segments=400)
    mooring.settle(moved(mooring.pose_in_file, off))
    scene = mooring.scene
    kind, line, env = scene.line_types[0], scene.lines[4], scene.environment
    a, b = (np.concatenate(composed(pose, np.array([*scene.point(end).position, 0.0, 0.0, 0.0, 1.0])))[:3] for pose, end in zip(mooring.pose, (line.end_a, line.end_b)))
    np.testing.assert_allclose(mooring.node_positions("line5")[[0, -1]], [a, b], atol=1e-9)
    weight = (kind.mass - env.water_density * 0.25 * np.pi * kind.diameter**2) * env.gravity
    at_a, at_b = hanging(b - a, line.length, kind.stiffness, weight)
    close(mooring.anchor_end_force[4], at_a, 1e-4)
    close(mooring.fairlead_end_force[4], at_b, 1e-4)


def test_the_stiffness_of_two_platforms_is_that_of_differences():
    """(12, 12), each entry within 1e-6 of the largest of its block of forces or moments by places or turns, off the file's poses."""
    mooring = pair()
    place = moved(mooring.pose_in_file, 0.5 * OFF)
    mooring.settle(place)
    found, other = mooring.stiffness(), pair()
    expected = np.zeros((12, 12))
    for axis, step in enumerate(np.tile([2e-3] * 3 + [5e-5] * 3, 2)):
        for shift, weight in ((1, 8.0), (-1, -8.0), (2, -1.0), (-2, 1.0)):
            other.settle(moved(place, shift * step * np.eye(12)[axis]))
            expected[:, axis] -= weight * other.wrench.ravel() / (12.0 * step)
    for rows in np.arange(12).reshape(4, 3):
        for columns in np.arange(12).reshape(4, 3):
            block = np.ix_(rows, columns)
            assert np.abs(found[block] - expected[block]).max() < 1e-6 * np.abs(expected[np.ix_(rows, np.arange(columns[0] % 6, 12, 6))]).max() + 1e-3
    assert np.abs(found[:6, 6:]).max() > 1e3  # what one does to the other


def test_a_linear_mooring_of_two_platforms_follows_the_statics_nearby():
    """Moved by centimetres and a thousandth of a radian: wrenches within 1e-3 of their change."""
    linear, exact = settled(fidelity="linear"), settled(fidelity="quasi_static")
    start = exact.wrench
    pose = moved(linear.pose_in_file, 0.02 * OFF)
    for mooring in (linear, exact):
        mooring.step(1.0, pose, np.zeros((2, 6)))
    close(linear.wrench - start, exact.wrench - start, 1e-2)
    assert linear.error_estimate < 1e-3


def test_steps_and_runs_and_snapshots_and_twins_have_the_same_bits():
    poses, twists = surge_heave(TIMES, pitch=0.05)
    one = settled()
    both, rates = carried(poses, twists, one.pose_in_file)
    both[:, 1], rates[:, 1] = one.pose_in_file[1], 0.0
    other, saved = one.twin(), one.snapshot()
    history = one.run(TIMES, both, rates)
    for row, time in enumerate(TIMES):
        other.step(time, both[row], rates[row])
        assert (other.wrench == history.wrench[row]).all()
    assert same_bits(one.snapshot(), other.snapshot())
    one.restore(saved)
    assert (one.run(TIMES, both, rates).wrench == history.wrench).all()
    assert (one.pose == both[-1]).all() and (one.twist == rates[-1]).all() and (one.body_poses["body2"] == both[-1, 1]).all()


def test_one_named_platform_has_the_pose_of_its_body():
    """Wrench about the body's origin: that of the unnamed platform, moved there."""
    scene = dataclasses.replace(load_scene(PAIR))
    scene = dataclasses.replace(scene, bodies=tuple(dataclasses.replace(body, kind=FIXED) if body.id == 1 else body for body in scene.bodies))
    named, plain = settled(names=["body2"], scene=scene), Mooring(scene)
    plain.settle(HERE)
    assert named.pose.shape == (1, 7) and named.stiffness().shape == (6, 6) and named.platforms == ("body2",)
    np.testing.assert_allclose(named.pose_in_file, [[500.0, 0, 0, 0, 0, 0, 1]])
    close(total(named.wrench[None], named.pose[None], np.zeros((1, 3)))[0], plain.wrench, 1e-12)
    assert plain.platforms is None and (plain.pose_in_file == HERE).all()


@pytest.mark.parametrize(
    ("names", "said"),
    [
        (["body1"], "body2: coupled, but to none of body1"),
        (["body1", "body3"], "no coupled body 'body3'; expected names of its coupled bodies (body1, body2)"),
        (["body1", "body2", "body1"], "each once"),
        ([], "each once"),
        ("body1", "expected a list of names"),
        ([1, 2], "expected a list of names"),
    ],
)
def test_names_that_cannot_be_platforms_are_refused(names, said):
    with pytest.raises(ValueError) as refused:
        pair(names)
    assert said in str(refused.value)


def test_what_is_coupled_to_no_platform_is_refused():
    scene = load_scene(PAIR)
    points = tuple(dataclasses.replace(point, kind=COUPLED, body=None) if point.id == 5 else point for point in scene.points)
    with pytest.raises(ValueError, match="point5: coupled, but to none of body1, body2; expected"):
        pair(scene=dataclasses.replace(scene, points=points))


def test_poses_of_another_shape_and_steps_that_cannot_be_done_leave_it_as_it_was():
    mooring = settled()
    saved, pose = mooring.snapshot(), mooring.pose_in_file
    for wrong in (HERE, pose[:1], np.vstack([pose, pose])):
        with pytest.raises(ValueError, match=r"expected \(2, 7\): a row x, y, z, qx, qy, qz, qw for each of body1, body2"):
            mooring.step(0.1, wrong, np.zeros((2, 6)))
    with pytest.raises(ValueError, match=r"expected \(k,\), \(k, 2, 7\), \(k, 2, 6\)"):
        mooring.run(TIMES[:1], pose[None, :1], np.zeros((1, 2, 6)))
    bad = pose.copy()
    bad[1, 2] = np.nan
    with pytest.raises(ValueError, match="not finite"):
        mooring.step(0.1, bad, np.zeros((2, 6)))
    torn = pose.copy()
    torn[1, 0] += 2000.0
    with pytest.raises(MooringError):
        mooring.step(5.0, torn, np.zeros((2, 6)))
    assert same_bits(mooring.snapshot(), saved)


def test_turned_platforms_give_turned_wrenches():
    """Both floaters swapped by half a turn of all about z: each gives the other's wrench, turned; 1e-6."""
    mooring = settled(moved(pair().pose_in_file, OFF))
    half = turn([0, 0, 1], np.pi)
    swapped = np.array([np.concatenate([pose[:3] * [-1, -1, 1], times_quaternion(half, pose[3:])]) for pose in mooring.pose[::-1]])
    other = settled(swapped)
    close(other.wrench[::-1] * [-1, -1, 1, -1, -1, 1], mooring.wrench, 1e-6)


# Coupled bodies with weight, volume and drag, a rod on each, a line that bends clamped to either, a free clump between them, and a body that hangs from both.
PARTS = """\
two floaters that share a line
---------------------- LINE TYPES -----------------------------------
Name Diam MassDen EA BA/-zeta EI Cd Ca CdAx CaAx
(-) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
chain 0.10 113.35 7.536E8 -0.8 0 2.0 0.8 0.4 0.25
beam 0.10 20.0 1e8 -0.8 1e5 1.2 1.0 0.1 0.0
---------------------- ROD TYPES -----------------------------------
Name Diam Mass/m Cd Ca CdEnd CaEnd
(-) (m) (kg/m) (-) (-) (-) (-)
stick 0.5 300 1.0 1.0 0.5 0.3
---------------------- BODIES -----------------------------------
ID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG I Volume CdA Ca
(#) (-) (m) (m) (m) (deg) (deg) (deg) (kg) (m) (kg-m^2) (m^3) (m^2) (-)
1 Coupled 5 3 -10 2 5 30 1e5 1|0|-2 1e6|2e6|3e6 80 40|50|60|700|800|900 0.5|0.6|0.7
2 Coupled -400 -10 -8 0 -4 170 1e5 1|0|-2 1e6|2e6|3e6 80 40|50|60|700|800|900 0.5|0.6|0.7
---------------------- RODS -----------------------------------
ID RodType Attachment Xa Ya Za Xb Yb Zb NumSegs RodOutputs
(#) (name) (#/key) (m) (m) (m) (m) (m) (m) (-) (-)
1 stick Body1 1 0 -2 1 0 -8 3 -
2 stick Body2 1 0 -2 1 0 -8 3 -
---------------------- POINTS -----------------------------------
ID Attachment X Y Z M V CdA CA
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Fixed 350 50 -100 0 0 0 0
2 Body1 3 0 -3 100 0.1 0.2 1.0
3 Fixed 300 -80 -100 0 0 0 0
4 Fixed -750 0 -100 0 0 0 0
8 Free -200 0 -60 3000 0.2 0.5 0.8
5 Body2 3 0 -3 100 0.1 0.2 1.0
6 Body1 -5 0 -3 0 0 0 0
7 Body2 -5 1 -3 0 0 0 0
---------------------- LINES -----------------------------------
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name) (#) (#) (m) (-) (-)
1 chain 1 2 370 10 -
2 beam 3 R1B 330 30 -
3 chain 4 5 360 10 -
4 beam 6 7 410 20 -
5 chain R1A 8 220 10 -
6 chain 8 R2A 220 10 -
7 beam R1B R2B 420 20 -
---------------------- OPTIONS -----------------------------------
100 WtrDpth
3e6 kBot
3e5 cBot
---------------------- need this line -----------------------------------
"""


@pytest.mark.parametrize("settings", [{}, {"solver": "implicit", "dt": 0.02}, {"fidelity": "quasi_static"}], ids=["explicit", "implicit", "quasi_static"])
def test_rods_clamps_volumes_and_free_points_between_platforms_are_those_of_one_platform(settings):
    """Tensions and what each coupled thing hands over, 1e-9; in the statics turned as well."""
    scene = parse_scene(PARTS, "parts.txt", {})
    times = np.arange(1, 11) * 0.1
    poses, twists = surge_heave(times, pitch=0.05 if "fidelity" in settings else 0.0, period=4.0)
    one, two = Mooring(scene, **settings), settled(scene=scene, **settings)
    one.settle(HERE)
    both, rates = carried(poses, twists, two.pose_in_file)
    expected, found = one.run(times, poses, twists), two.run(times, both, rates)
    assert two.coupled_names == one.coupled_names and two.platform_of_coupled == [0, 1, 0, 1, 0, 1, 0, 1][: len(one.coupled_names)]
    close(found.fairlead_tension, expected.fairlead_tension, 1e-9)
    close(found.coupled_wrenches, expected.coupled_wrenches, 1e-9)
    close(total(found.wrench, both, poses[:, :3]), expected.wrench, 1e-9)
    close(two.node_curvature("line7"), one.node_curvature("line7"), 1e-7)
