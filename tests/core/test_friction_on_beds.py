"""Bars and lines on rough beds against closed forms."""

import numpy as np
import pytest
from scenes_in_code import COUPLED, FIXED, FREE, line_type, scene, table

from mooring_ros.core.laying import lay
from mooring_ros.core.model import LOOSE, build

from .bed_bar import Bar, ground

BARS = {}
for row in table("bar_on_coulomb_bed.csv"):
    BARS.setdefault(row["case"], []).append({k: float(v) for k, v in row.items() if v and k not in ("case", "phase")})

HOUSNER = BARS["Housner 120mm chain mu=1.0"]


def along(force):
    return np.array([force, 0.0, 0.0])


@pytest.mark.parametrize("case", BARS)
def test_a_bar_dragged_on_a_coulomb_bed_gives_way_and_dissipates_as_the_closed_form(case):
    """Load 0 -> F1, unload to each F2, back to F1: quasi-static, 200 segments."""
    first, *unloaded = BARS[case]
    load, slip = first["end_force_N"], first["slip_zone_length_m"]
    bed = 3e6 * (0.002 if load < 1e3 else 0.1)
    bar = Bar(ground("stick", first["mu"]), 200, 1.2 * slip, first["EA_N"], first["w_N_per_m"], bed_stiffness=bed)
    start = bar.position[0, 200]

    def pull(force):
        bar.settle(along(force))
        bar.commit()
        return bar.position[0, 200] - start

    for force in np.linspace(0.0, load, 6)[1:]:
        moved = pull(force)
    assert moved == pytest.approx(first["end_displacement_m"], rel=0.01)
    slipped = np.abs(bar.grip[0, :201] - bar.segment * np.arange(201)) > 0.0
    assert slipped.sum() * bar.segment == pytest.approx(slip, rel=0.02)
    path = [(load, moved)]
    for row in unloaded:
        for force in np.linspace(path[-1][0], row["end_force_N"], 5)[1:]:
            path.append((force, pull(force)))
        assert path[-1][1] == pytest.approx(row["end_displacement_m"], rel=0.01)
    for force in np.linspace(path[-1][0], load, 21)[1:]:
        path.append((force, pull(force)))
    assert path[-1][1] == pytest.approx(moved, rel=1e-6)  # the loop closes
    forces, moves = np.array(path).T
    assert abs(np.trapezoid(forces, moves)) == pytest.approx(unloaded[-1]["dissipated_per_full_cycle_F1_F2_J"], rel=0.01)


class Moving:
    """The Housner chain, dragged in time."""

    def __init__(self, law, segments=100, **friction):
        row = HOUSNER[0]
        self.load = row["end_force_N"]
        self.bar = Bar(ground(law, row["mu"], **friction), segments, 1.2 * row["slip_zone_length_m"], row["EA_N"], row["w_N_per_m"], bed_stiffness=3e5)
        bar = self.bar
        self.step = 0.9 * bar.segment / np.sqrt(row["EA_N"] / (bar.axial[1] / bar.segment))
        self.start = bar.position[0, segments]

    def run(self, duration, force):
        """`force` of the share of the duration that has gone."""
        steps = int(duration / self.step)
        for k in range(steps):
            self.bar.leap(along(force((k + 1) / steps)), self.step, 0.05 * self.bar.stiffness * self.step)
        return self.bar.position[0, self.bar.n - 1] - self.start


def smooth(share):
    return share * share * (3.0 - 2.0 * share)


def test_a_bar_dragged_in_time_gives_way_as_the_closed_form_and_keeps_its_tensions():
    moving = Moving("stick")
    moving.run(10.0, lambda s: moving.load * smooth(s))
    assert moving.run(1.0, lambda s: moving.load) == pytest.approx(HOUSNER[0]["end_displacement_m"], rel=0.01)
    bar = moving.bar
    tension = bar.tension[1 : bar.n].copy()
    slope = HOUSNER[0]["mu"] * HOUSNER[0]["w_N_per_m"]
    arc = bar.segment * (np.arange(100) + 0.5)
    expected = np.maximum(moving.load - slope * (bar.segment * 100 - arc), 0.0)
    assert np.abs(tension - expected).max() < 0.01 * moving.load
    moving.run(20.0, lambda s: moving.load)
    assert np.abs(bar.tension[1 : bar.n] - tension).max() < 1e-6 * moving.load
    moving.run(10.0, lambda s: moving.load * (1.0 - smooth(s)))
    assert moving.run(1.0, lambda s: 0.0) == pytest.approx(HOUSNER[-1]["end_displacement_m"], rel=0.01)


def test_saturated_friction_lets_tension_even_out_where_stick_holds_it():
    """Figure 8 of Housner et al. 2022: held at the same load for 20 s."""
    spread = {}
    for law in ("saturated", "stick"):
        moving = Moving(law, segments=40, ramp=1e5)
        moving.run(4.0, lambda s: 0.5 * moving.load * smooth(s))
        moving.run(20.0, lambda s: 0.5 * moving.load)
        spread[law] = 1.0 - moving.bar.tension[1] / (0.5 * moving.load)
    assert spread["saturated"] < 0.1
    assert spread["stick"] == pytest.approx(1.0, abs=0.01)


def test_a_line_pulled_at_a_quarter_of_its_limit_for_an_hour_stays():
    """50 m of soft line in two segments, steps of 50 ms, with a swell of 5 % on the pull: less than a millimetre, and none of it at the end."""
    weight, length = 1000.0, 50.0
    bar = Bar(ground("stick", 0.5, drop=1.3), 2, length, 1e6, weight, bed_stiffness=3e5, held=False)
    pull, step, trace = 0.25 * 0.5 * weight * length, 0.05, []
    for k in range(int(3600.0 / step)):
        bar.leap(along(pull * (1.0 + 0.05 * np.sin(0.6 * k * step))), step, 1e4)
        if k in (1200, 71999):  # after a minute, and an hour
            trace.append(bar.position[0, :3].copy())
    assert np.abs(bar.grip[0, :3] - np.array([0.0, 25.0, 50.0])).max() < 0.2  # the end slid as the line was stretched
    assert np.abs(trace[1] - trace[0]).max() < 1e-3
    assert np.abs(bar.velocity[0, :3]).max() < 1e-4


SLOPES = table("slope_friction.csv")


@pytest.mark.parametrize("heading", ["down", "across"])
def test_what_lies_free_on_a_slope_sticks_or_slides_as_it_should(heading):
    for row in SLOPES:
        slope, mu = np.tan(np.radians(float(row["slope_deg"]))), float(row["mu"])
        bed = ground("stick", mu, bed_slope=(slope, 0.0))
        bar = Bar(bed, 2, 10.0, 1e7, 1000.0, heading=(1.0, 0.0, slope) if heading == "down" else (0.0, 1.0, 0.0), bed_stiffness=3e5, held=False)
        start, step = bar.position.copy(), 0.002
        for _ in range(250):
            bar.leap(np.zeros(3), step)
        early = np.linalg.norm(bar.velocity[:, 1])
        for _ in range(250):
            bar.leap(np.zeros(3), step)
        gained = (np.linalg.norm(bar.velocity[:, 1]) - early) / (250 * step) / 9.80665
        if row["free_element_state"] == "slide":
            assert gained == pytest.approx(float(row["slide_accel_over_g_eff"]), rel=1e-3), row
        else:
            assert abs(gained) < 1e-9 and np.abs(bar.position - start).max() < 1e-3, row


@pytest.mark.parametrize("law", ["stick", "saturated"])
@pytest.mark.parametrize("step", [1e-3, 5e-2])
def test_what_slides_up_a_slope_is_slowed_by_kinetic_friction_and_stays(law, step):
    """2 m/s up a slope of 20 %, across the line, kinetic 0.5 and static 0.67: v^2/2a far, whatever the step."""
    weight, mass, added, angle = 1000.0, 1000.0 / 9.80665, 40.0, np.arctan(0.2)
    bar = Bar(ground(law, 0.5, drop=1.33, bed_slope=(0.2, 0.0)), 2, 10.0, 1e5, weight, (0, 1, 0), bed_stiffness=3e5, held=False, added=(added, 10.0))
    up = np.array([np.cos(angle), 0.0, np.sin(angle)])
    bar.velocity[:, :3] = 2.0 * up[:, None]
    start = bar.position[:, 1].copy()
    for _ in range(int(4.0 / step)):
        bar.leap(np.zeros(3), step)
    deceleration = weight * (np.sin(angle) + 0.5 * np.cos(angle)) / (mass + added)
    # half a step at 2 m/s is the scheme's own, and in the first one it has not begun to slide
    assert (bar.position[:, 1] - start) @ up == pytest.approx(2.0 / deceleration, abs=0.01 + 2.0 * step)
    assert np.linalg.norm(bar.velocity[:, 1]) < (1e-9 if law == "stick" else 2e-3)  # the saturated law creeps


@pytest.mark.parametrize("way,column", [(-1.0, "dT_ds_over_w_pulled_downslope(mu cos-sin)"), (1.0, "dT_ds_over_w_pulled_upslope(mu cos+sin)")])
def test_tension_along_a_line_pulled_up_or_down_a_slope_grows_as_it_should(way, column):
    for row in SLOPES:
        angle, mu, gradient = np.radians(float(row["slope_deg"])), float(row["mu"]), float(row[column])
        if mu == 0.0:
            continue
        bed = ground("stick", mu, bed_slope=(np.tan(angle), 0.0))
        heading = way * np.array([np.cos(angle), 0.0, np.sin(angle)])
        bar = Bar(bed, 20, 100.0, 1e8, 1000.0, heading=heading, bed_stiffness=3e5)
        bar.settle(4e5 * heading)
        growth = np.diff(bar.tension[1:21]) / bar.segment / 1000.0
        assert growth == pytest.approx(gradient, abs=2e-3), row


# -- as laid ----------------------------------------------------------------------------------------------------------------------------


def laid(points, lines, bed=None, loosen=()):
    """(grip (4, n), model) of points (kind, place) and lines (a, b, length, segments)."""
    model, ends = build(scene(points, [(line_type(), *line) for line in lines], depth=100.0))
    for end in loosen:
        ends[end] = LOOSE
    position, grip = np.zeros((3, model.mass.size)), np.zeros((4, model.mass.size))
    for p, node in enumerate(model.point_node):
        position[:, node] = model.point_place[p]
    for e, node in enumerate(model.end_node):
        position[:, node] = position[:, model.point_node[ends[e]]] if ends[e] != LOOSE else [50.0, 0.0, -100.0]
    lay(bed or ground("stick", 1.0), model, ends, position, grip)
    return grip, model


def test_a_line_is_laid_straight_from_its_anchor_at_its_unstretched_length():
    grip, _ = laid([(COUPLED, (300.0, 400.0, 0.0)), (FIXED, (0.0, 0.0, -100.0))], [(1, 2, 520.0, 13)])
    arc = 40.0 * np.arange(13, -1, -1)
    assert grip[:3, :14] == pytest.approx(np.array([0.6 * arc, 0.8 * arc, np.full(14, -100.0)]))
    assert (grip[3, :14] == 1.0).all() and (grip[3, 14:] == -1.0).all()


def test_lines_in_series_are_laid_in_a_row():
    points = [(FIXED, (0.0, 0.0, -100.0)), (FREE, (200.0, 30.0, -50.0)), (COUPLED, (500.0, 0.0, 0.0))]
    grip, model = laid(points, [(1, 2, 200.0, 4), (2, 3, 400.0, 4)])
    assert grip[0, :10] == pytest.approx([0.0, 50.0, 100.0, 150.0, 200.0, 200.0, 300.0, 400.0, 500.0, 600.0])
    assert not grip[1, :10].any()
    assert grip[0, model.point_node[1]] == pytest.approx(200.0)


def test_a_line_between_two_anchors_is_laid_from_both():
    grip, _ = laid([(FIXED, (0.0, 0.0, -100.0)), (FIXED, (100.0, 0.0, -100.0))], [(1, 2, 120.0, 4)])
    assert grip[0, :5] == pytest.approx([0.0, 30.0, 60.0, 70.0, 100.0])


def test_a_line_is_laid_along_the_slope():
    grip, _ = laid(
        [(FIXED, (0.0, 0.0, -100.0)), (COUPLED, (400.0, 0.0, 0.0))], [(1, 2, 500.0, 5)], ground("stick", 1.0, bed_slope=(0.75, 0.0))
    )
    assert grip[:3, :6] == pytest.approx(np.array([80.0 * np.arange(6), np.zeros(6), -100.0 + 60.0 * np.arange(6)]))


def test_what_hangs_between_platforms_or_straight_above_its_anchor_is_not_laid():
    grip, _ = laid([(COUPLED, (0.0, 0.0, 0.0)), (COUPLED, (100.0, 0.0, 0.0))], [(1, 2, 120.0, 4)])
    assert (grip[3] == -1.0).all()
    grip, _ = laid([(FIXED, (0.0, 0.0, -100.0)), (COUPLED, (0.0, 0.0, 0.0))], [(1, 2, 120.0, 4)])
    assert (grip[3] == -1.0).all()


def test_a_line_whose_end_is_loose_is_laid_towards_it():
    grip, _ = laid([(FIXED, (0.0, 0.0, -100.0)), (COUPLED, (0.0, 0.0, 0.0))], [(1, 2, 60.0, 4)], loosen=[1])
    assert grip[0, :5] == pytest.approx([0.0, 15.0, 30.0, 45.0, 60.0])


@pytest.mark.parametrize("pull", [5e4, 2e5, 5e5])
def test_pulling_a_laid_line_mobilises_friction_towards_the_anchor(pull):
    """Tension falls along the bed by mu w per metre; what is left at the anchor is max(H - mu w L, 0)."""
    weight, length, mu, count = 1000.0, 300.0, 0.8, 100
    bar = Bar(ground("stick", mu), count, length, 4e8, weight, bed_stiffness=3e5)
    grip, _ = laid([(FIXED, (0.0, 0.0, -100.0)), (COUPLED, (400.0, 0.0, 0.0))], [(1, 2, length, count)])
    bar.grip[:, : count + 1] = grip[:, : count + 1]
    bar.settle(along(pull))
    arc = bar.segment * (np.arange(count) + 0.5)
    expected = np.maximum(pull - mu * weight * (length - arc), 0.0)
    assert np.abs(bar.tension[1 : count + 1] - expected).max() < 0.5 * mu * weight * bar.segment  # where sliding ends, within a node's share
