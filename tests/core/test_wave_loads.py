"""What waves do to lines and points: Morison's equation in moving water, the moving surface, and whole runs."""

from dataclasses import replace

import numpy as np
import pytest
from scenes_in_code import COUPLED, FIXED, FREE, HERE, STILL, anchored, line_type, same_bits, scene

from mooring_ros import Mooring
from mooring_ros.core.forces import evaluate_once
from mooring_ros.core.model import build, new_scratch, new_state
from mooring_ros.core.sea import elevation
from mooring_ros.core.waves import refresh
from mooring_ros.scene.description import JONSWAP, REGULAR, Waves

WAVE = Waves(kind=REGULAR, height=4.0, period=8.0, direction=0.4)


def in_waves(waves, lift=0.0, **water):
    """A chain and a buoy: points, a slanting line through a free point, near the surface when lifted."""
    thick = line_type(0.3, 150.0, 3e6, 2e4, 1.3, 0.9, 0.3, 0.2, "thick")
    thin = line_type(0.1, 20.0, 4e5, 1e4, 1.1, 1.0, 0.2, 0.4, "thin")
    points = [(FIXED, (-30, 0, -40 + lift)), (FREE, (0, 0, -20 + lift), 300.0, 0.4, 0.5, 0.6), (COUPLED, (20, 5, -5 + lift))]
    return scene(points, [(thick, 1, 2, 35.0, 7), (thin, 2, 3, 25.0, 6)], depth=60.0, waves=waves, **water)


def evaluated(description, time, velocity=0.0):
    """(model, state) with the nodes on straight lines, at `time` (s) of the sea."""
    model, ends = build(description)
    state, scratch = new_state(model, ends), new_scratch(model)
    for node, point in zip(model.point_node, description.points):
        state.position[:, node] = point.position
    for k, line in enumerate(description.lines):
        first, count = model.first_node[k], model.segments[k]
        a, b = (np.array(description.points[i - 1].position) for i in (line.end_a, line.end_b))
        state.position[:, first : first + count + 1] = a[:, None] + (b - a)[:, None] * np.linspace(0.0, 1.0, count + 1)
    state.velocity[:, : model.size] = velocity
    refresh(model.sea, time, time, model.size, state.position, state.velocity, scratch.wave_work, state.window_times, state.window)
    state.settings[6] = time
    evaluate_once(model, state, scratch, 0.0, 0.0, True)
    return model, state


def test_swell_adds_froude_krylov_and_inertia_along_and_across_the_line():
    description = in_waves(WAVE)
    model, state = evaluated(description, 2.7)
    _, still = evaluated(in_waves(None), 2.7)
    rho = description.environment.water_density
    for k, line in enumerate(description.lines):
        first, count, kind = model.first_node[k], model.segments[k], line.type
        a, b = (np.array(description.points[i - 1].position) for i in (line.end_a, line.end_b))
        t = (b - a) / np.linalg.norm(b - a)
        for i in range(count + 1):
            node = first + i
            lumped = line.length / count * (0.5 if i in (0, count) else 1.0)
            volume, u, acceleration = 0.25 * np.pi * kind.diameter**2 * lumped, state.stream[:, node], state.swell[:3, node]
            along = (acceleration @ t) * t
            inertia = rho * volume * ((1.0 + kind.added_mass_normal) * (acceleration - along) + (1.0 + kind.added_mass_axial) * along)
            slip = (u @ t) * t
            drag = 0.5 * rho * kind.diameter * lumped * kind.drag_normal * np.linalg.norm(u - slip) * (u - slip)
            drag += 0.5 * rho * np.pi * kind.diameter * lumped * kind.drag_axial * np.linalg.norm(slip) * slip
            assert np.allclose(state.force[:, node] - still.force[:, node], inertia + drag, rtol=1e-9, atol=1e-6)
            assert np.linalg.norm(inertia) > 0.1 * np.linalg.norm(drag) > 0.0
    node, point = model.point_node[1], description.points[1]
    u, acceleration = state.stream[:, node], state.swell[:3, node]
    expected = rho * point.volume * (1.0 + point.added_mass) * acceleration + 0.5 * rho * point.drag_area * np.linalg.norm(u) * u
    assert np.allclose(state.force[:, node] - still.force[:, node], expected, rtol=1e-9)


def test_what_is_above_the_surface_feels_no_waves():
    """Lifted so that the upper line stands in the air at the crest: its nodes have their forces in still air."""
    description = in_waves(WAVE, lift=30.0)
    for time in (0.0, 4.0):
        model, state = evaluated(description, time)
        _, dry = evaluated(in_waves(None, lift=200.0), time)
        eta = elevation(model.sea, time, state.position[0], state.position[1])
        dry_nodes = [i for i in range(model.first_node[1], model.first_node[1] + 7) if state.position[2, i] - eta[i] > 3.0]
        assert len(dry_nodes) > 2
        assert np.all(state.wet[dry_nodes] == 0.0)
        assert np.allclose(state.force[:, dry_nodes], dry.force[:, dry_nodes], rtol=1e-9, atol=1e-6)


def test_the_surface_that_counts_is_the_waves():
    """A node 1 m above still water is wet under a crest of 2 m, and one 1 m below is dry over a trough."""
    for height, time, wet in ((1.0, 0.0, 1.0), (-1.0, 4.0, 0.0)):
        points = [(FIXED, (0, 0, height)), (COUPLED, (0.5, 0, height))]
        wave = replace(WAVE, direction=0.0)
        model, state = evaluated(scene(points, [(line_type(), 1, 2, 0.5, 2)], depth=60.0, waves=wave), time)
        assert np.all(state.wet[:3] == wet)


def test_a_stiff_upright_line_hands_the_wave_force_on_to_its_ends():
    """Sum of both end forces over two periods: Morison's equation integrated over the depth, to 2 % of its amplitude."""
    kind = line_type(0.5, 0.25 * np.pi * 0.25 * 1025.0, 1e10, -0.5, 1.0, 1.0)  # neutrally buoyant
    wave = Waves(kind=REGULAR, height=2.0, period=9.0, ramp=18.0)
    mooring = Mooring(anchored(kind, (0, 0, -60), (0, 0, -6), 53.9, 30, depth=60.0, waves=wave))
    mooring.settle(HERE)
    times = np.arange(1, 721) * 0.05
    history = mooring.run(times, np.tile(HERE, (720, 1)), np.zeros((720, 6)))
    force = (history.fairlead_end_force + history.anchor_end_force)[:, 0, 0]
    sea, z = mooring._model.sea, np.linspace(-60.0, -6.0, 541)
    w, k = sea.frequency[0], sea.wave_number[0]
    late = times > 18.0
    expected = []
    for t in times[late]:
        eta = np.cos(w * t)
        profile = w * np.cosh(k * ((z - eta) * 60.0 / (60.0 + eta) + 60.0)) / np.sinh(k * 60.0)
        u, du = profile * np.cos(w * t), -w * profile * np.sin(w * t)
        per_metre = 1025.0 * 0.25 * np.pi * 0.25 * 2.0 * du + 0.5 * 1025.0 * 0.5 * np.abs(u) * u
        expected.append(np.sum(0.5 * (per_metre[1:] + per_metre[:-1])) * (z[1] - z[0]))
    wrong = force[late] - np.array(expected)
    assert np.max(np.abs(wrong)) < 0.02 * np.max(np.abs(expected))


STORM = Waves(kind=JONSWAP, height=5.0, period=10.0, ramp=5.0)


def swaying(mooring, count=40, dt=0.1):
    times = mooring.time + dt * np.arange(1, count + 1)
    poses = np.tile(HERE, (count, 1))
    poses[:, 0] = 0.5 * np.sin(0.6 * times)
    twists = np.zeros((count, 6))
    twists[:, 0] = 0.3 * np.cos(0.6 * times)
    return times, poses, twists


def test_steps_and_runs_and_restored_runs_in_waves_have_the_same_bits():
    description = in_waves(STORM, lift=4.0)
    one, many = Mooring(description), Mooring(description)
    for mooring in (one, many):
        mooring.settle(HERE)
    samples = swaying(one)
    many.run(*samples)
    for t, pose, twist in zip(*samples):
        one.step(t, pose, twist)
    assert same_bits(one.snapshot(), many.snapshot())
    saved, more = one.snapshot(), swaying(one)
    one.run(*more)
    after = one.snapshot()
    one.restore(saved)
    one.run(*more)
    assert same_bits(after, one.snapshot())


def test_a_refused_step_in_waves_leaves_the_bits_as_they_were():
    mooring = Mooring(in_waves(STORM, lift=4.0))
    mooring.settle(HERE)
    mooring.run(*swaying(mooring))
    before = mooring.snapshot()
    far = HERE.copy()
    far[0] = 60.0
    with pytest.raises(Exception, match="stretch|run"):
        mooring.step(mooring.time + 1.0, far, STILL)
    assert same_bits(before, mooring.snapshot())


def test_settling_is_in_still_water_and_the_waves_start_at_the_clocks_time():
    still, waves = Mooring(in_waves(None)), Mooring(in_waves(replace(STORM, ramp=0.0)))
    for mooring in (still, waves):
        mooring.settle(HERE, time=123.0)
    assert np.array_equal(still.fairlead_tension, waves.fairlead_tension)
    waves.step(123.1, HERE, STILL)
    node = waves._model.point_node[1]
    expected = elevation(waves._model.sea, waves._state.settings[6], *waves._state.position[:2, node])
    assert waves._state.swell[3, node] == pytest.approx(expected, abs=1e-3)
