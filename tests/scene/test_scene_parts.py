"""Bodies, rods, ropes, failures: every column of a file lands where it belongs, and what does not fit is refused."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mooring_ros.scene import (
    BODY,
    COUPLED,
    COUPLED_PINNED,
    FIXED,
    FREE,
    JONSWAP,
    PAPER,
    PINNED,
    SATURATED,
    STICK,
    Failure,
    Friction,
    RodEnd,
    RodType,
    SceneError,
    Waves,
    bed_level,
    parse_scene,
)

from .decks import FILES, FULL, line_of, swap

INFINITY = math.inf


def scene_of(text=FULL, files=FILES):
    return parse_scene(text, "deck.txt", files.items())


def error_of(text, files=FILES):
    with pytest.raises(SceneError) as caught:
        scene_of(text, files)
    assert "expected" in caught.value.message and "\n" not in str(caught.value)
    return caught.value


def test_bodies_are_read():
    one, two, three = scene_of().bodies
    assert [body.kind for body in (one, two, three)] == [FREE, COUPLED, FIXED]
    assert [body.name for body in (one, two, three)] == ["body1", "body2", "body3"]
    assert (one.position, one.mass, one.centre_of_gravity) == ((50.0, 0.0, -20.0), 5000.0, (0.0, 0.1, -1.0))
    assert (one.inertia, one.volume) == ((2e4, 3e4, 4e4), 6.0)
    assert one.drag_area == (5.0, 5.0, 5.0, 40.0, 40.0, 40.0)
    assert one.added_mass == (1.0, 1.0, 2.0)
    assert three.drag_area == (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
    assert two.centre_of_gravity == (0.0, 0.0, 0.0)
    assert one.source_line == line_of(FULL, "1  Free       50")


def test_angles_of_bodies_are_intrinsic_turns_about_x_then_y_then_z():
    body = scene_of().bodies[0]
    turned = Rotation.from_euler("XYZ", [10, 20, 30], degrees=True).as_matrix()
    assert Rotation.from_quat(body.orientation).as_matrix() == pytest.approx(turned, abs=1e-15)
    assert np.linalg.norm(body.orientation) == pytest.approx(1.0, abs=1e-15)


@pytest.mark.parametrize(
    "given, drag_area",
    [("7", (7,) * 6), ("1|2", (1, 1, 1, 2, 2, 2)), ("1|2|3", (1, 2, 3, 1, 2, 3)), ("1|2|3|4|5|6", (1, 2, 3, 4, 5, 6))],
)
def test_drag_areas_of_bodies_are_for_all_axes_or_each(given, drag_area):
    assert scene_of(swap("5|40 ", f"{given} ", FULL)).bodies[0].drag_area == drag_area


def test_one_number_is_the_centre_of_gravity_along_z_and_inertia_and_added_mass_for_all_axes():
    body = scene_of(swap("0|0.1|-1  2e4|3e4|4e4 6      5|40    1|1|2", "-2 3e4 6 5|40 0.5", FULL)).bodies[0]
    assert (body.centre_of_gravity, body.inertia, body.added_mass) == ((0.0, 0.0, -2.0), (3e4,) * 3, (0.5,) * 3)


def test_rods_are_read():
    scene = scene_of()
    spar, joint = scene.rod_types
    assert spar == RodType("spar", 2.0, 500.0, 0.6, 1.0, 1.2, 0.8, source_line=line_of(FULL, "spar"))
    kinds = [BODY, FREE, COUPLED, PINNED, BODY, COUPLED_PINNED, FREE, FIXED]
    types = [spar, joint, joint, spar, joint, spar, spar, joint]
    assert [(rod.id, rod.kind, rod.type) for rod in scene.rods] == list(zip(range(1, 9), kinds, types))
    assert [rod.body for rod in scene.rods] == [1, None, None, None, 3, None, None, None]
    first, fourth = scene.rods[0], scene.rods[3]
    assert (first.end_a, first.end_b, first.segments, first.length) == ((0.0, 0.0, -3.0), (0.0, 0.0, 3.0), 6, 6.0)
    assert (fourth.end_a, fourth.end_b) == ((90.0, 0.0, -98.0), (90.0, 0.0, -92.0))


def test_a_rod_without_segments_has_no_length_and_a_direction():
    rod = scene_of().rods[2]
    assert rod.segments == 0 and rod.length == 0.0
    assert np.subtract(rod.end_b, rod.end_a) == pytest.approx([1.0, 0.0, -1.0])


def test_points_on_bodies_and_line_ends_at_rods_are_read():
    scene = scene_of()
    assert (scene.point(2).kind, scene.point(2).body, scene.point(2).position) == (BODY, 1, (0.0, 0.0, 3.0))
    ends = [(line.end_a, line.end_b) for line in scene.lines]
    assert ends[:4] == [(1, RodEnd(1, "B")), (RodEnd(4, "B"), RodEnd(1, "A")), (RodEnd(5, "B"), RodEnd(2, "A")), (RodEnd(2, "B"), RodEnd(3, "A"))]


def test_a_rope_in_two_kelvin_form_is_as_stiff_as_the_file_says_at_rest_and_when_quick():
    rope = scene_of().line_types[2]
    assert rope.stiffness == 1.586e8 and rope.damping == 11e6 and rope.slow_damping == 4e9
    assert 1 / (1 / rope.stiffness + 1 / rope.slow_stiffness) == pytest.approx(1.424e8, rel=1e-14)
    assert scene_of(swap("4e9|11e6 0 ", "4e9 0 ", FULL)).line_types[2].damping == 0.0


def test_a_load_strain_curve_comes_from_its_file():
    nylon = scene_of().line_types[3]
    assert nylon.curve == ((0.0, 0.0), (0.05, 2e5), (0.1, 8e5), (0.2, 3e6))
    assert nylon.stiffness == pytest.approx(2.2e7)  # its steepest piece
    assert nylon.damping == 2e4


def test_a_curve_that_begins_above_zero_begins_at_zero():
    assert scene_of(files=FILES | {"nylon.txt": "a\nb\nc\n0.05 2.0e5\n0.10 8.0e5\n"}).line_types[3].curve == ((0.0, 0.0), (0.05, 2e5), (0.1, 8e5))


def test_bending_stiffness_and_its_measure_are_read():
    scene = scene_of()
    assert [line_type.bending_stiffness for line_type in scene.line_types] == [0.0, 1e4, 0.0, 0.0]
    assert scene.bending == PAPER
    unused = scene_of(swap("cable 0.2  40.0   7.0e8       -0.5      1e4", "cable 0.2  40.0   7.0e8       -0.5      0", FULL))
    assert any("BendingModel is not used: no line has bending stiffness" in warning for warning in unused.warnings)


def test_failures_are_read():
    first = line_of(FULL, "1         R1A")
    assert scene_of().failures == (
        Failure(1, RodEnd(1, "A"), (2,), INFINITY, 2e6, first),
        Failure(2, 4, (5,), 12.5, INFINITY, first + 1),
        Failure(3, 3, (5, 8), INFINITY, 1e6, first + 2),
    )


def test_a_failure_given_twice_counts_once_and_is_said():
    scene = scene_of(swap("2         P4    5     12.5     0\n", "2         P4    5     12.5     0\n9  4 5 12.5 0\n", FULL))
    assert [failure.id for failure in scene.failures] == [1, 2, 3]
    assert any("failure 9 is not used: it is the same as failure 2" in warning for warning in scene.warnings)


def test_options_of_the_full_deck_are_read():
    environment = scene_of().environment
    assert environment.friction == Friction(STICK, 0.5, 0.625, 0.4, 0.5, ramp=environment.friction.ramp)
    assert environment.waves == Waves(JONSWAP, 8.25, 14.5, math.radians(30), 2.5, 7, 200, ramp=20.0)
    assert environment.current == (0.0, 0.2, 0.0)
    assert environment.current_profile == ((-100.0, 0.1, 0.0, 0.0), (-50.0, 0.3, 0.1, 0.0), (0.0, 0.8, 0.2, 0.0))
    assert environment.bed_slope == (0.01, 0.0)


def test_what_the_full_deck_does_not_use_is_said():
    text = " ".join(scene_of().warnings)
    assert "the section CONTROL is not used: unstretched lengths are changed while running with Mooring.set_unstretched_length" in text
    assert "cv is not used: the friction model stick goes by displacements" in text


def test_places_on_the_seabed_are_found_on_its_slope():
    scene = scene_of(swap("0      -300  seabed", "-300   20    GROUND", FULL))
    assert scene.point(3).position == pytest.approx((-300.0, 20.0, -103.0))
    assert scene.point(3).position[2] == bed_level(scene.environment, -300.0, 20.0)


def test_fixed_points_and_joints_below_the_bed_are_set_on_it_and_what_is_above_stays():
    scene = scene_of(swap("400    0     -100 ", "400    0     -120 ", FULL))
    assert scene.point(1).position == (400.0, 0.0, -96.0)
    assert any("point 1 at z = -120 m is below the bed, it is set on it (z = -96 m)" in warning for warning in scene.warnings)
    assert scene.rods[7].end_a == pytest.approx((60.0, 90.0, -99.4))
    assert np.subtract(scene.rods[7].end_b, scene.rods[7].end_a) == pytest.approx([-1.0, 0.0, 0.0])
    assert scene_of(swap("400    0     -100 ", "400    0     -20 ", FULL)).point(1).position == (400.0, 0.0, -20.0)


def test_rods_may_stand_before_their_types_and_without_points():
    rods = FULL[FULL.index("--- RODS") : FULL.index("--- POINTS")]
    assert scene_of(FULL.replace(rods, "").replace("--- LINE TYPES", rods + "--- LINE TYPES")).rods[1].kind == FREE
    text = FULL[: FULL.index("--- POINTS")] + FULL[FULL.index("--- LINES") :]
    for start in ("1  chain    1 ", "5  nylon ", "6  chain ", "8  cable ", "2         P4", "3         3 "):
        text = text.replace(text[text.index(start) : text.index("\n", text.index(start)) + 1], "", 1)
    text = text.replace("7  chain    R6B     R7B", "7  chain    R6B     R7A")
    scene = scene_of(text)
    assert scene.points == () and [line.id for line in scene.lines] == [2, 3, 4, 7]


CHANGES = [
    # bodies
    ("1  Free       50", "1  Fre       50", "body type is 'Fre', expected Fixed, Coupled or Free (did you mean Free?)"),
    ("1  Free       50", "1  Pinned       50", "body type is 'Pinned', expected Fixed, Coupled or Free: pinned bodies are not modelled"),
    ("1  Free       50", "1  VesselPinned       50", "pinned bodies are not modelled"),
    ("1  Free       50", "1  Turbine2       50", "body type is 'Turbine2', expected Fixed, Coupled or Free: several turbines are not modelled"),
    ("2  Coupled    -5", "1  Coupled    -5", "a second body 1 (the first is in line"),
    ("10 20 30 5000", "10 20 x 5000", "yaw is 'x', expected a number (degrees)"),
    ("10 20 30 5000", "10 20 30 -5", "mass is -5, expected a number >= 0 (kg)"),
    ("0|0.1|-1 ", "0|0.1 ", "centre of gravity CG is '0|0.1', expected 1 or 3 numbers separated by |"),
    ("2e4|3e4|4e4", "2e4|-3e4|4e4", "moment of inertia I is -3e4, expected a number >= 0 (kg m^2)"),
    ("2e4|3e4|4e4", "2e4||4e4", "moment of inertia I is '', expected a number >= 0"),
    ("5|40 ", "1|2|3|4 ", "drag area CdA is '1|2|3|4', expected 1, 2, 3 or 6 numbers separated by |"),
    ("1|1|2\n", "1|1\n", "added mass coefficient Ca is '1|1', expected 1 or 3 numbers"),
    ("1|1|2\n", "\n", "13 columns, expected 14: ID Attachment X0"),
    ("50   0  -20 10", "50   0  -200 10", "free body1 at z = -200 m is below the bed, expected z >= -99.5 m there"),
    # rods
    ("1  spar    Body1 ", "1  spr    Body1 ", "unknown rod type 'spr', expected spar"),
    ("1  spar    Body1 ", "1  spar    Body9 ", "rod1 is attached to body 9, which does not exist, expected one of the IDs in the section BODIES"),
    ("1  spar    Body1 ", "1  spar    Body1Pinned ", "the rod is attached to 'Body1Pinned', expected Body1: rods pinned to bodies are not modelled"),
    ("1  spar    Body1 ", "1  spar    Turbine1 ", "rod type is 'Turbine1', expected Fixed"),
    ("1  spar    Body1 ", "1  spar    Glued ", "rod type is 'Glued', expected Fixed, Coupled, Free, Pinned, CoupledPinned or Body1"),
    ("2  joint   Free ", "1  joint   Free ", "a second rod 1 (the first is in line"),
    ("0   0  3   6       p", "0   0  3   six       p", "number of segments (or 0 for a rod without length) is 'six', expected a whole number"),
    ("0   0  3   6       p", "0   0  -3   6       p", "both ends of rod 1 are at the same place, expected a length > 0 m"),
    ("6   0  -9  0", "5   0  -8  0", "both ends of the coupled rod 3 are at the same place, expected another end B: it gives the direction"),
    ("0   0  3   6       p", "0   0  3", "9 columns, expected 11: ID RodType"),
    ("20  20 -20 4", "20  20 -120 4", "free rod7 at z = -120 m is below the bed, expected z >= -99.8 m there"),
    ("90  0  -98 90  0  -92", "90  0  -102 90  0  -92", "pinned rod4 at z = -102 m is below the bed"),
    ("spar     2.0  500.0 ", "spar     2.0  0 ", "rod4 moves freely and its type 'spar' has no mass, expected one > 0 kg/m"),
    ("spar     2.0  500.0 ", "spar     0  500.0 ", "diameter is 0, expected a number > 0 (m)"),
    ("joint    0.2  0 ", "spar    0.2  0 ", "a second rod type 'spar' (the first is in line"),
    # points and lines
    ("0      0     3      10 ", "0      0     -800      10 ", "point 2 of the free body 1 at z = -"),
    ("R1B     380", "R9B     380", "end B is attached to rod 9, which does not exist"),
    ("R1B     380", "R1     380", "end B is attached to 'R1', expected R1A or R1B: the end of the rod is missing"),
    ("R1B     380", "R1C     380", "end B is attached to 'R1C', expected a point ID such as 3 or Point3, or the end of a rod such as R1A"),
    ("R4B     Rod1A", "Rod1A     R1A", "both ends are attached to end A of rod 1, expected two different places"),
    # failures
    ("1         R1A ", "1         R1B ", "line 2 does not end at 'R1B', expected lines that do"),
    ("P4    5     12.5", "P4    55     12.5", "line 55 does not exist, expected IDs in the section LINES"),
    ("P4    5     12.5", "P4    5,5     12.5", "the lines are '5,5', expected the IDs of different lines separated by commas"),
    ("P4    5     12.5     0", "P4    5     0     0", "failure 2 has neither a time nor a tension, expected one of them > 0"),
    ("P4    5     12.5     0", "P4    5     -1     0", "time of failure is -1, expected a number >= 0 (s, or 0 for none)"),
    ("P4    5     12.5     0", "P4    5     12.5", "4 columns, expected 5: FailureID Point Lines FailTime FailTen"),
    ("2         P4 ", "1         P4 ", "a second failure 1 (the first is in line"),
    # options
    ("0.01     BedSlopeX", "x     BedSlopeX", "BedSlopeX is 'x', expected a number (rise over run)"),
    ("1.25     mc", "0.5     mc", "mc is 0.5, expected a number >= 1: static over kinetic friction"),
    ("0.5      mu_kT", "0.5      FrictionCoefficient", "mu_kA is 0.4 beside FrictionCoefficient, expected either that or mu_kT and mu_kA"),
    ("jonswap  WaveModel", "3  WaveKin", "the file 'wave_elevation.txt' is not among the recorded files, expected a wave elevation"),
]


@pytest.mark.parametrize("old, new, message", CHANGES, ids=lambda value: str(value)[:40])
def test_an_error_names_its_line_and_what_was_expected(old, new, message):
    error = error_of(swap(old, new, FULL))
    # what refers to another line is wrong where the reference, the mass or the second value is
    moved = {"mu_kA is": "0.4      mu_kA", "rod4 moves": "4  spar"}
    where = next((text for start, text in moved.items() if message.startswith(start)), old)
    assert (error.file, error.line) == ("deck.txt", FULL[: FULL.index(where)].count("\n") + 1), str(error)
    assert message in error.message


@pytest.mark.parametrize(
    "lines, message",
    [
        (("1  chain    1       R1B", "2  rope     R4B     Rod1A", "6  chain    2 "), "free body1 is held by nothing"),
        (("3  cable    R5B", "4  cable    r2b"), "free rod2 is held by nothing"),
        (("6  chain    2 ", "7  chain    R6B"), "free rod7 is held by nothing"),
    ],
)
def test_free_parts_that_nothing_holds_are_refused(lines, message):
    text = FULL.replace("1         R1A   2     0        2e6\n", "")
    for start in lines:
        text = text.replace(text[text.index(start) : text.index("\n", text.index(start)) + 1], "")
    error = error_of(text)
    assert message in error.message and "expected lines to lead to something fixed or coupled" in error.message


def test_a_free_body_needs_mass_and_inertia():
    bare = swap("1  spar    Body1         0   0  -3  0   0  3 ", "1  spar    Fixed         0   0  -3  0   0  3 ", FULL)
    bare = swap("3      10    0.1", "3      0    0.1", bare)
    assert "free body1 has no mass" in error_of(swap("30 5000 ", "30 0 ", bare)).message
    assert "free body1 has no moment of inertia about some axis" in error_of(swap("2e4|3e4|4e4", "2e4|3e4|0", bare)).message
    scene_of(swap("2e4|3e4|4e4", "0", FULL))  # a rod on it has some


def test_friction_in_the_way_of_moordyn_c_is_isotropic_with_its_default_ramp():
    fortran = "0.5      mu_kT\n0.4      mu_kA\n1.25     mc\n1e6      cv\nstick    FrictionModel\n"
    law = scene_of(swap(fortran, "0.7  FrictionCoefficient\n2 StatDynFricScale\n", FULL)).environment.friction
    assert (law.law, law.isotropic) == (SATURATED, True)
    assert (law.kinetic_axial, law.kinetic_transverse, law.static_axial, law.static_transverse) == (0.7, 0.7, 1.4, 1.4)
    assert law.static_axial * law.ramp == pytest.approx(0.7 * 200.0)  # the slope is the kinetic coefficient times FricDamp there


def test_the_ramp_of_saturated_friction_is_that_of_moordyn():
    law = scene_of(swap("stick    FrictionModel\n", "", FULL)).environment.friction
    assert not law.isotropic
    assert law.static_transverse * law.ramp == pytest.approx(0.5 * 1e6)
    assert law.static_axial * law.ramp == pytest.approx(0.4 * 1e6)
