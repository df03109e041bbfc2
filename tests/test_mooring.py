"""The façade: shapes, refusals that leave everything as it was, the same bits by every way, violent inputs."""

import hashlib
import subprocess
import sys

import numpy as np
import pytest
from scenes_in_code import COUPLED, FIXED, FREE, HERE, SCENES, STILL, line_type, same_bits, scene, surge_heave, times_quaternion, turn

from mooring_ros import Mooring, MooringError

OC4 = SCENES / "oc4.txt"
TIMES = np.arange(1, 101) * 0.05
POSES, TWISTS = surge_heave(TIMES, pitch=0.1)


def settled(description=OC4, pose=HERE, **options):
    mooring = Mooring(description, **options)
    mooring.settle(pose)
    return mooring


# -- what it shows --------------------------------------------------------------------------------------------------------------------


def test_shapes_and_names():
    mooring = settled()
    assert mooring.line_names == ["line1", "line2", "line3"]
    assert mooring.coupled_names == ["point4", "point5", "point6"]
    assert mooring.wrench.shape == (6,) and mooring.coupled_wrenches.shape == (3, 6)
    assert mooring.fairlead_tension.shape == mooring.anchor_tension.shape == (3,)
    assert mooring.fairlead_end_force.shape == mooring.anchor_end_force.shape == (3, 3)
    assert mooring.stretched_length.shape == mooring.length_rate.shape == (3,)
    assert mooring.node_positions("line2").shape == (21, 3)
    assert mooring.node_tension("line2").shape == mooring.node_curvature("line2").shape == (21,)
    assert mooring.stiffness().shape == (6, 6)
    assert mooring.pose.shape == (7,) and mooring.twist.shape == (6,)
    assert mooring.static_result.converged and mooring.static_result.residual < 1.0
    assert mooring.step_limit.dt > 0.0 and mooring.step_limit.limited_by and mooring.step_limit.limits["axial"] > 0.0
    assert mooring.scene.lines[0].name == "line1"


def test_readings_are_copies():
    mooring = settled()
    for name in ("wrench", "fairlead_tension", "anchor_tension", "fairlead_end_force", "coupled_wrenches", "stretched_length", "pose", "twist"):
        before = getattr(mooring, name)
        getattr(mooring, name)[:] = 7.0
        np.testing.assert_array_equal(getattr(mooring, name), before)
    before = mooring.snapshot()
    mooring.node_positions("line1")[:] = 0.0
    mooring.node_tension("line1")[:] = 0.0
    assert same_bits(before, mooring.snapshot())


def test_end_segment_tension_differs_from_the_end_force_by_the_half_segment():
    """Statics: end force = end segment's pull + half segment's weight; norm of the node tension at the ends is that of the end force."""
    mooring = settled()
    force = np.linalg.norm(mooring.fairlead_end_force, axis=1)
    assert (force > mooring.fairlead_tension).all() and (force < 1.02 * mooring.fairlead_tension).all()
    assert mooring.node_tension("line1")[-1] == pytest.approx(force[0], rel=1e-12)


def test_length_rate_is_the_rate_of_the_stretched_length():
    """Against the difference of two lengths 10 us apart, 3 %: velocities inside the lines stand half a step behind."""
    poses, twists = surge_heave(np.append(TIMES, TIMES[-1] + 1e-5))
    mooring = settled()
    mooring.run(TIMES, poses[:-1], twists[:-1])
    before, rate = mooring.stretched_length, mooring.length_rate
    mooring.step(TIMES[-1] + 1e-5, poses[-1], twists[-1])
    difference = (mooring.stretched_length - before) / 1e-5
    np.testing.assert_allclose(difference, 0.5 * (rate + mooring.length_rate), rtol=3e-2, atol=1e-3)


def test_curvature_of_a_hanging_chain_is_that_of_the_catenary():
    """At the lowest point of a catenary the curvature is w/H, 1 %."""
    kind = line_type(0.1, 100.0, 1e9)
    description = scene([(FIXED, (0, 0, -10)), (COUPLED, (80, 0, -10))], [(kind, 1, 2, 100.0, 200)], depth=300.0)
    mooring = settled(description)
    weight = (100.0 - 1025.0 * 0.25 * np.pi * 0.01) * 9.80665
    assert mooring.node_curvature("line1")[100] == pytest.approx(weight / abs(mooring.fairlead_end_force[0, 0]), rel=0.01)


def test_line_between_two_fairleads_and_line_written_from_the_platform():
    """Fairlead is the coupled end, wherever the file has it; end B when both are."""
    kind = line_type(0.1, 100.0, 1e8)
    points = [(FIXED, (-100, 0, -50)), (COUPLED, (-10, 0, -5)), (COUPLED, (10, 0, -5))]
    one = settled(scene(points, [(kind, 1, 2, 110.0, 10), (kind, 2, 3, 25.0, 10)], depth=50.0))
    other = settled(scene(points, [(kind, 2, 1, 110.0, 10), (kind, 2, 3, 25.0, 10)], depth=50.0))
    np.testing.assert_allclose(one.fairlead_end_force, other.fairlead_end_force, rtol=1e-6)
    np.testing.assert_allclose(one.anchor_tension, other.anchor_tension, rtol=1e-6)
    np.testing.assert_allclose(one.node_positions("line1"), other.node_positions("line1")[::-1], atol=1e-6)
    np.testing.assert_allclose(one.node_tension("line1"), other.node_tension("line1")[::-1], rtol=1e-6)
    assert one.fairlead_end_force[1, 0] < 0.0 < one.anchor_end_force[1, 0]
    np.testing.assert_allclose(one.wrench[:3], one.coupled_wrenches[:, :3].sum(axis=0), rtol=1e-12)


def test_the_fairlead_of_a_line_that_no_platform_holds_is_the_end_that_is_not_fixed():
    """A line with a buoy on it, 50 m above its anchor: the upper end pulls harder, by the line's weight."""
    kind = line_type(0.1, 100.0, 1e8)
    points = [(FIXED, (0, 0, -50)), (FREE, (0, 0, -1), 0.0, 10.0), (COUPLED, (20, 0, -5))]
    for ends in ((1, 2), (2, 1)):
        mooring = settled(scene(points, [(kind, *ends, 49.0, 10), (kind, 2, 3, 25.0, 10)], depth=50.0))
        weight = 10.0 / 11.0 * (100.0 - 1025.0 * np.pi / 4.0 * 0.1**2) * 9.8 * 49.0  # between the middles of the end segments
        assert mooring.fairlead_tension[0] - mooring.anchor_tension[0] == pytest.approx(weight, rel=0.05)


def test_refine_scales_the_files_segments_of_each_line():
    path = SCENES / "rm3_cable.txt"
    in_file = [line.segments for line in Mooring(path).scene.lines]
    assert Mooring(path, refine=0.3).segments == [max(1, round(0.3 * count)) for count in in_file]
    assert settled(refine=1.5).segments == [30] * 3
    np.testing.assert_array_equal(settled(refine=1.5).wrench, settled(segments=30).wrench)


def test_segments_override_the_file():
    mooring = settled(segments=37)
    assert mooring.node_positions("line3").shape == (38, 3)
    assert mooring.fairlead_tension == pytest.approx(settled().fairlead_tension, rel=0.02)


# -- refusals -------------------------------------------------------------------------------------------------------------------------

BAD_STEPS = {
    "time stands still": (0.0, HERE, STILL),
    "time runs backwards": (-1.0, HERE, STILL),
    "time is NaN": (np.nan, HERE, STILL),
    "time is infinite": (np.inf, HERE, STILL),
    "pose is short": (0.1, HERE[:6], STILL),
    "pose is a row": (0.1, HERE[None], STILL),
    "pose holds NaN": (0.1, np.where(np.arange(7) == 1, np.nan, HERE), STILL),
    "pose holds inf": (0.1, np.where(np.arange(7) == 2, np.inf, HERE), STILL),
    "quaternion is zero": (0.1, np.zeros(7), STILL),
    "quaternion is long": (0.1, HERE * 2.0, STILL),
    "quaternion is off by 1 %": (0.1, HERE * 1.01, STILL),
    "twist is short": (0.1, HERE, STILL[:3]),
    "twist holds NaN": (0.1, HERE, np.full(6, np.nan)),
    "twist holds inf": (0.1, HERE, np.full(6, np.inf)),
    "pose is no number": (0.1, ["x"] * 7, STILL),
}


@pytest.mark.parametrize("name", BAD_STEPS)
@pytest.mark.parametrize("by", ["step", "run"])
def test_bad_input_is_a_value_error_and_changes_nothing(name, by):
    mooring = settled()
    mooring.settle(HERE, time=-0.05)
    mooring.step(0.0, HERE, np.array([0.1, 0, 0, 0, 0, 0]))
    before = mooring.snapshot()
    t, pose, twist = BAD_STEPS[name]
    with pytest.raises(ValueError):
        mooring.step(t, pose, twist) if by == "step" else mooring.run([t], [pose], [twist])
    assert same_bits(before, mooring.snapshot())


@pytest.mark.parametrize("row", [0, 3, 9])
def test_run_checks_every_row_before_it_starts(row):
    for spoil in (0, 1, 2, 3):
        mooring = settled()
        times, poses, twists = TIMES[:10].copy(), POSES[:10].copy(), TWISTS[:10].copy()
        if spoil == 0:
            times[row] = times[row - 1] if row else 0.0
        elif spoil == 1:
            poses[row, 4] = np.nan
        elif spoil == 2:
            poses[row, 3:] *= 1.1
        else:
            twists[row, 1] = np.inf
        before = mooring.snapshot()
        with pytest.raises(ValueError):
            mooring.run(times, poses, twists)
        assert same_bits(before, mooring.snapshot())


@pytest.mark.parametrize("pose", [HERE[:6], np.full(7, np.nan), np.zeros(7), [0, 0, 0, 0, 0, 0, 2.0]])
def test_settle_refuses_bad_poses_and_changes_nothing(pose):
    mooring = settled()
    before = mooring.snapshot()
    with pytest.raises(ValueError):
        mooring.settle(pose)
    with pytest.raises(ValueError):
        mooring.settle(HERE, time=np.nan)
    assert same_bits(before, mooring.snapshot())


@pytest.mark.parametrize(
    "options",
    [{"fidelity": "magic"}, {"solver": "magic"}, {"dt": 0.0}, {"dt": -1.0}, {"dt": np.nan}, {"segments": 0}, {"segments": 2.5}, {"segments": -3}, {"refine": 0.0}, {"refine": np.inf},
     {"refine": 1e9}, {"refine": 2.0, "segments": 20}],
)
def test_bad_options_are_value_errors(options):
    with pytest.raises(ValueError):
        Mooring(OC4, **options)


@pytest.mark.parametrize("segments", ["many", np.nan])
def test_segments_that_are_no_number_are_refused(segments):
    with pytest.raises((ValueError, TypeError)):
        Mooring(OC4, segments=segments)


def test_nothing_runs_before_it_is_settled():
    mooring = Mooring(OC4)
    with pytest.raises(ValueError, match="settle"):
        mooring.step(0.1, HERE, STILL)
    with pytest.raises(ValueError, match="settle"):
        mooring.stiffness()


@pytest.mark.parametrize("fidelity", ["dynamic", "line1=linear,dynamic"])
def test_a_rod_of_a_scene_without_rods_is_a_value_error_that_says_so(fidelity):
    mooring = Mooring(OC4, fidelity=fidelity)
    mooring.settle([0, 0, 0, 0, 0, 0, 1])
    with pytest.raises(ValueError, match="no rod 'rod1'; expected one of none: the scene has no rods"):
        mooring.rod_positions("rod1")



@pytest.mark.parametrize("reader", ["node_positions", "node_tension", "node_curvature", "release"])
def test_unknown_lines_are_value_errors(reader):
    with pytest.raises(ValueError, match="line1"):
        getattr(settled(), reader)("line9")


def test_snapshot_of_another_mooring_is_refused():
    mooring = settled()
    with pytest.raises(ValueError):
        mooring.restore(settled(segments=50).snapshot())
    with pytest.raises(ValueError):
        mooring.restore(None)


def test_snapshot_of_another_scene_of_the_same_size_is_refused():
    """VolturnUS-S with the segments of OC4 has arrays of the same shapes; its state is still not one of OC4."""
    mooring = settled()
    with pytest.raises(ValueError):
        mooring.restore(settled(SCENES / "volturnus_s_chain.txt", segments=20).snapshot())


def test_mooring_without_a_platform_has_no_wrench_and_no_stiffness():
    """Nothing coupled: still a mooring that can be settled and stepped; wrench and stiffness are zero or refused, never a crash."""
    kind = line_type(0.1, 100.0, 1e8)
    mooring = settled(scene([(FIXED, (0, 0, -50)), (FREE, (10, 0, -20), 100.0, 0.5)], [(kind, 1, 2, 40.0, 5)], depth=50.0))
    mooring.step(0.1, HERE, STILL)
    assert not mooring.wrench.any()
    try:
        assert not mooring.stiffness().any()
    except (ValueError, MooringError):
        pass


# -- the same bits --------------------------------------------------------------------------------------------------------------------


def test_restore_and_go_on_gives_the_same_bits():
    mooring = settled()
    mooring.run(TIMES[:40], POSES[:40], TWISTS[:40])
    saved = mooring.snapshot()
    mooring.run(TIMES[40:], POSES[40:], TWISTS[40:])
    first = mooring.snapshot()
    mooring.restore(saved)
    assert same_bits(saved, mooring.snapshot())
    mooring.run(TIMES[40:], POSES[40:], TWISTS[40:])
    assert same_bits(first, mooring.snapshot())


def test_snapshot_goes_into_a_fresh_mooring():
    mooring, other = settled(), Mooring(OC4)
    mooring.run(TIMES[:40], POSES[:40], TWISTS[:40])
    other.restore(mooring.snapshot())
    for one in (mooring, other):
        one.run(TIMES[40:], POSES[40:], TWISTS[40:])
    assert same_bits(mooring.snapshot(), other.snapshot())
    np.testing.assert_array_equal(mooring.node_tension("line2"), other.node_tension("line2"))


def test_a_snapshot_does_not_change_with_its_mooring():
    mooring = settled()
    saved, copy = mooring.snapshot(), mooring.snapshot()
    mooring.run(TIMES, POSES, TWISTS)
    assert same_bits(saved, copy)


@pytest.mark.parametrize("blocks", [[100], [1] * 100, [7, 13, 1, 29, 50], [99, 1]])
def test_run_in_blocks_and_step_by_step_give_the_same_bits(blocks):
    mooring, other = settled(), settled()
    whole = other.run(TIMES, POSES, TWISTS)
    tensions, begin = [], 0
    for count in blocks:
        rows = slice(begin, begin + count)
        if count == 1:
            mooring.step(TIMES[begin], POSES[begin], TWISTS[begin])
            tensions.append(mooring.fairlead_tension[None])
        else:
            tensions.append(mooring.run(TIMES[rows], POSES[rows], TWISTS[rows]).fairlead_tension)
        begin += count
    assert np.concatenate(tensions).tobytes() == np.ascontiguousarray(whole.fairlead_tension).tobytes()
    assert same_bits(mooring.snapshot(), other.snapshot())


def test_stiffness_and_readings_between_steps_change_no_bit():
    mooring, other = settled(), settled()
    for k in range(40):
        mooring.step(TIMES[k], POSES[k], TWISTS[k])
        if k % 5 == 0:
            mooring.stiffness(), mooring.wrench, mooring.node_curvature("line1"), mooring.snapshot()
    other.run(TIMES[:40], POSES[:40], TWISTS[:40])
    assert same_bits(mooring.snapshot(), other.snapshot())


def test_settling_again_gives_the_bits_of_a_fresh_mooring():
    mooring = settled()
    mooring.run(TIMES, POSES, TWISTS)
    mooring.settle(HERE)
    mooring.run(TIMES[:20], POSES[:20], TWISTS[:20])
    other = settled()
    other.run(TIMES[:20], POSES[:20], TWISTS[:20])
    assert same_bits(mooring.snapshot(), other.snapshot())


SCRIPT = """
import hashlib, sys
import numpy as np
sys.path[:0] = [{root!r}, {tests!r}]
from test_mooring import OC4, POSES, TIMES, TWISTS, settled
run = settled().run(TIMES, POSES, TWISTS)
print(hashlib.sha256(b"".join(np.ascontiguousarray(row).tobytes() for row in (run.wrench, run.fairlead_tension, run.anchor_end_force))).hexdigest())
"""


def test_two_processes_give_the_same_bits():
    root = SCENES.parent.parent
    script = SCRIPT.format(root=str(root), tests=str(root / "tests"))
    other = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=300, check=True).stdout.strip()
    run = settled().run(TIMES, POSES, TWISTS)
    parts = (run.wrench, run.fairlead_tension, run.anchor_end_force)
    assert other == hashlib.sha256(b"".join(np.ascontiguousarray(row).tobytes() for row in parts)).hexdigest()


def test_first_step_at_rest_changes_nothing_that_matters():
    """From the statics with the platform still: tensions stay within 1e-6, in any scene."""
    for file in ("oc3_spar.txt", "oc4.txt", "volturnus_s_chain.txt", "chalmers_33m.txt"):
        mooring = settled(SCENES / file)
        want = mooring.fairlead_tension
        for t in (0.05, 0.5, 5.0):
            mooring.step(t, HERE, STILL)
            np.testing.assert_allclose(mooring.fairlead_tension, want, rtol=1e-6)


def test_time_far_from_zero_gives_the_same_motion():
    """Seconds of an epoch clock: the platform's motion is relative, only the clock's own rounding (2e-7 s) is felt."""
    mooring, other = settled(), settled()
    mooring.settle(HERE, time=1.7e9)
    run, want = mooring.run(1.7e9 + TIMES, POSES, TWISTS), other.run(TIMES, POSES, TWISTS)
    np.testing.assert_allclose(run.fairlead_tension, want.fairlead_tension, rtol=1e-3)


# -- letting go -----------------------------------------------------------------------------------------------------------------------


def test_released_line_pulls_no_more_and_falls_to_the_bed():
    mooring = settled()
    mooring.run(TIMES[:10], POSES[:10], TWISTS[:10])
    others = mooring.coupled_wrenches[:2].copy()
    mooring.release("line3")
    assert not mooring.fairlead_end_force[2].any()
    assert mooring.coupled_wrenches[2, :3] == pytest.approx(np.zeros(3), abs=1e-6)
    np.testing.assert_allclose(mooring.coupled_wrenches[:2], others, rtol=1e-9)
    still = np.concatenate([POSES[9, :3], POSES[9, 3:]])
    for t in (5.0, 60.0, 400.0):
        mooring.step(t, still, STILL)
        assert np.isfinite(mooring.node_positions("line3")).all()
        assert not mooring.fairlead_end_force[2].any()
    assert mooring.node_positions("line3")[-1, 2] < -199.0
    assert mooring.fairlead_tension[2] < 2e4
    with pytest.raises(ValueError):
        mooring.release("line3")
    assert np.isfinite(mooring.stiffness()).all()


def test_release_is_undone_by_restore_and_kept_by_settle():
    mooring = settled()
    saved = mooring.snapshot()
    mooring.release("line1")
    mooring.restore(saved)
    mooring.step(0.1, HERE, STILL)
    assert mooring.fairlead_end_force[0].any()
    mooring.release("line1")
    mooring.settle(HERE)
    assert not mooring.fairlead_end_force[0].any()
    assert mooring.fairlead_tension[1] > 1e5


# -- violent inputs -------------------------------------------------------------------------------------------------------------------


def at(x=0.0, y=0.0, z=0.0, rotation=HERE[3:]):
    return np.concatenate([[x, y, z], rotation])


VIOLENT = {
    "jump of 1 m in 0.05 s": [(0.05, at(1.0), STILL), (1.0, at(1.0), STILL), (3.0, at(1.0), STILL)],
    "jump of 5 m up in 0.05 s": [(0.05, at(z=5.0), STILL), (1.0, at(z=5.0), STILL), (3.0, at(z=5.0), STILL)],
    "jump of 100 m in 0.05 s": [(0.05, at(100.0), STILL), (1.0, at(100.0), STILL), (3.0, at(100.0), STILL)],
    "jump of 1 km": [(0.1, at(1000.0), STILL), (1.0, at(1000.0), STILL)],
    "half a turn about x": [(2.0, at(rotation=turn([1, 0, 0], np.pi)), STILL), (4.0, at(rotation=turn([1, 0, 0], np.pi)), STILL)],
    "half a turn about z": [(0.5, at(rotation=turn([0, 0, 1], np.pi)), STILL), (2.0, at(rotation=turn([0, 0, 1], np.pi)), STILL)],
    "platform driven below the bed": [(5.0, at(z=-195.0), STILL), (10.0, at(z=-195.0), STILL)],
    "platform lifted out of the water": [(5.0, at(z=40.0), STILL), (10.0, at(z=40.0), STILL)],
    "twist that contradicts the poses": [(0.1, at(), np.array([50.0, 0, -30.0, 1.0, 0, 2.0])), (0.2, at(), STILL), (1.0, at(), STILL)],
    "one very long interval": [(60.0, at(3.0), STILL)],
    "one very short interval": [(1e-9, at(1e-9), STILL), (0.1, at(), STILL)],
    "platform dropped": [(3.0, at(z=-40.0), np.array([0, 0, -25.0, 0, 0, 0])), (5.0, at(z=-60.0), STILL)],
}


REFUSABLE = ("jump of 1 km", "jump of 100 m in 0.05 s", "twist that contradicts the poses", "half a turn about z")


def tension_peaks(mooring, samples):
    """(samples, lines): fairlead tensions at the samples."""
    rows = []
    for t, pose, twist in samples:
        mooring.step(t, pose, twist)
        readings = (mooring.wrench, mooring.fairlead_tension, mooring.anchor_tension, mooring.fairlead_end_force, mooring.length_rate)
        assert all(np.isfinite(row).all() for row in readings)
        assert all(np.isfinite(mooring.node_positions(name)).all() for name in mooring.line_names)
        rows.append(mooring.fairlead_tension)
    return np.array(rows)


@pytest.mark.parametrize("file", ["oc4.txt", "chalmers_33m.txt"])
@pytest.mark.parametrize("name", VIOLENT)
def test_violent_input_is_answered_rightly_or_refused(name, file):
    """Finite and within 5 % of the largest tension (or the line's weight) of a run with steps 20 times finer; or MooringError, with every
    bit as before.

    The laboratory chain gets the motions at 1:60, times at 1:sqrt(60).
    """
    scale = 1.0 if file == "oc4.txt" else 60.0
    samples = [
        (t / np.sqrt(scale), np.append(pose[:3] / scale, pose[3:]), twist * np.repeat([np.sqrt(scale) / scale, np.sqrt(scale)], 3))
        for t, pose, twist in VIOLENT[name]
    ]
    mooring = settled(SCENES / file)
    finer = settled(SCENES / file, dt=mooring._table[:, 1].min() / 20.0)
    rows = []
    for one in (mooring, finer):
        got = []
        for sample in samples:
            before = one.snapshot()
            try:
                got.append(tension_peaks(one, [sample]))
            except MooringError:
                assert same_bits(before, one.snapshot())
                assert name in REFUSABLE
                return
        rows.append(np.concatenate(got))
    got, want = rows
    weight = np.abs(mooring._model.weight - mooring._model.buoyancy).sum() / len(mooring.line_names)
    assert np.abs(got - want).max() < 0.05 * max(want.max(), weight), (got, want)


def test_settling_in_impossible_places_is_right_or_refused():
    mooring = settled()
    for pose in (at(1000.0), at(z=-300.0), at(z=500.0), at(rotation=turn([1, 0, 0], np.pi)), at(1e6)):
        before = mooring.snapshot()
        try:
            mooring.settle(pose)
            assert np.isfinite(mooring.wrench).all() and mooring.static_result.converged
        except MooringError:
            assert same_bits(before, mooring.snapshot())


def test_a_whole_turn_of_the_platform_brings_the_tensions_back():
    """Slowly once round by 5 degrees in yaw and back: the tension at the end is that of the start, 0.5 %."""
    mooring = settled()
    want = mooring.fairlead_tension
    times = np.arange(1, 401) * 0.25
    angle = np.radians(5.0) * np.sin(np.pi * times / 100.0) ** 2
    rate = np.radians(5.0) * np.pi / 100.0 * np.sin(2.0 * np.pi * times / 100.0)
    poses = np.array([np.append(np.zeros(3), times_quaternion(turn([0, 0, 1], a), HERE[3:])) for a in angle])
    twists = np.zeros((400, 6))
    twists[:, 5] = rate
    run = mooring.run(times, poses, twists)
    assert np.abs(run.wrench[200, 5]) > 1e6
    np.testing.assert_allclose(run.fairlead_tension[-1], want, rtol=5e-3)


def test_a_place_that_the_lines_do_not_reach_is_refused_and_named():
    """A kilometre away in a tenth of a second would double the lines' length: MooringError that says so, every bit as before."""
    mooring = settled()
    before = mooring.snapshot()
    with pytest.raises(MooringError, match="stretches a line by more than 100 %"):
        mooring.step(0.1, at(1000.0), STILL)
    assert same_bits(before, mooring.snapshot())


@pytest.mark.parametrize("name", ["wrench", "fairlead_tension", "coupled_wrenches", "length_rate"])
def test_nothing_is_read_before_the_first_settle(name):
    with pytest.raises(ValueError, match="settle"):
        getattr(Mooring(SCENES / "oc4.txt"), name)


def test_a_step_beyond_the_largest_is_said():
    mooring = Mooring(SCENES / "oc4.txt", dt=5.0)
    assert "dt = 5 s is more than the largest step" in mooring.warnings[-1]
