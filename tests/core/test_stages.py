"""One evaluation of forces and accelerations against formulas written out node by node."""

import numpy as np
import pytest
from scenes_in_code import COUPLED, FIXED, FREE, line_type, scene

from mooring_ros.core.forces import evaluate_once
from mooring_ros.core.model import build, new_scratch, new_state

CURRENT = (0.7, -0.4, 0.1)
DEPTH = 50.0
POINT = dict(mass=300.0, volume=0.2, drag_area=0.5, added_mass=0.6)


def three_lines(damping=2e4, **water):
    """Three lines of two types that meet at a free point."""
    thick = line_type(0.12, 60.0, 3e6, damping, 1.3, 0.9, 0.3, 0.2, "thick")
    thin = line_type(0.05, 9.0, 4e5, -0.3, 1.1, 1.0, 0.2, 0.0, "thin")
    points = [(FIXED, (-60, 0, -50)), (FREE, (0, 0, -30), *POINT.values()), (COUPLED, (20, 5, -5)), (COUPLED, (20, -5, -5))]
    water = {"depth": DEPTH, "current": CURRENT, "bed_stiffness": 2e5, "bed_damping": 3e4, **water}
    return scene(points, [(thick, 1, 2, 64.0, 9), (thin, 2, 3, 31.0, 5), (thin, 4, 2, 33.0, 7)], **water)


def random_state(description, seed, spread=0.6, lift=0.0):
    """(model, state, scratch) with nodes thrown about the straight lines between their points, and random velocities, evaluated."""
    rng = np.random.default_rng(seed)
    model, ends = build(description)
    state, scratch = new_state(model, ends), new_scratch(model)
    state.velocity[:, : model.size] = rng.normal(0.0, 1.0, (3, model.size))
    for node, point in zip(model.point_node, description.points):
        state.position[:, node] = np.array(point.position) + rng.normal(0.0, spread, 3) + [0.0, 0.0, lift]
    for k, line in enumerate(description.lines):
        first, count = model.first_node[k], model.segments[k]
        a, b = (state.position[:, model.point_node[i - 1]] for i in (line.end_a, line.end_b))
        share = np.linspace(0.0, 1.0, count + 1)[:, None]
        nodes = a + (b - a) * share + rng.normal(0.0, spread, (count + 1, 3))
        state.position[:, first : first + count + 1] = nodes.T
    evaluate_once(model, state, scratch, 0.0, 0.0, True)
    return model, state, scratch


def node_formulas(description, line, position, velocity, dry=False):
    """(tension (N,), force (N+1, 3), inertia (N+1, 3, 3)) of one line from its nodes' position and velocity (N+1, 3)."""
    env, kind, count = description.environment, line.type, line.segments
    rho = 0.0 if dry else env.water_density
    length = line.length / count
    damping = kind.damping if kind.damping >= 0.0 else -kind.damping * length * np.sqrt(kind.stiffness * kind.mass)
    tension, q = np.zeros(count), np.zeros((count, 3))
    for i in range(count):
        span = position[i + 1] - position[i]
        stretched = np.linalg.norm(span)
        q[i] = span / stretched
        rate = q[i] @ (velocity[i + 1] - velocity[i])
        if stretched > length:
            tension[i] = max(kind.stiffness * (stretched / length - 1.0) + damping * rate / length, 0.0)
    force, inertia = np.zeros((count + 1, 3)), np.zeros((count + 1, 3, 3))
    for i in range(count + 1):
        halves = [j for j in (i - 1, i) if 0 <= j < count]
        lumped = 0.5 * length * len(halves)
        volume = 0.25 * np.pi * kind.diameter**2 * lumped
        t = sum(q[j] for j in halves)
        t = t / np.linalg.norm(t)
        force[i] += tension[i] * q[i] if i < count else 0.0
        force[i] -= tension[i - 1] * q[i - 1] if i > 0 else 0.0
        force[i, 2] += (rho * volume - kind.mass * lumped) * env.gravity
        u = np.array(env.current) - velocity[i]
        along = (u @ t) * t
        across = u - along
        force[i] += 0.5 * rho * kind.diameter * lumped * kind.drag_normal * np.linalg.norm(across) * across
        force[i] += 0.5 * rho * np.pi * kind.diameter * lumped * kind.drag_axial * np.linalg.norm(along) * along
        depth = -env.depth - position[i, 2]
        if depth > 0.0:
            force[i, 2] += max((env.bed_stiffness * depth - env.bed_damping * velocity[i, 2]) * kind.diameter * lumped, 0.0)
        added = kind.added_mass_normal * (np.eye(3) - np.outer(t, t)) + kind.added_mass_axial * np.outer(t, t)
        inertia[i] = kind.mass * lumped * np.eye(3) + rho * volume * added
    return tension, force, inertia


def point_formulas(description, position, velocity, dry=False):
    """(force (3,), inertia (3, 3)) of the free point alone."""
    env = description.environment
    rho = 0.0 if dry else env.water_density
    u = np.array(env.current) - velocity
    force = 0.5 * rho * POINT["drag_area"] * np.linalg.norm(u) * u
    force[2] += (rho * POINT["volume"] - POINT["mass"]) * env.gravity
    return force, (POINT["mass"] + rho * POINT["volume"] * POINT["added_mass"]) * np.eye(3)


def check(description, model, state, dry=False):
    ends = np.zeros(3)
    inertia_of_ends = np.zeros((3, 3))
    for k, line in enumerate(description.lines):
        nodes = slice(model.first_node[k], model.first_node[k] + model.segments[k] + 1)
        x, v = state.position[:, nodes].T, state.velocity[:, nodes].T
        tension, force, inertia = node_formulas(description, line, x, v, dry)
        scale = np.abs(force).max()
        np.testing.assert_allclose(state.tension[nodes.start + 1 : nodes.stop], tension, rtol=1e-9, atol=1e-9 * scale)
        np.testing.assert_allclose(state.force[:, nodes].T, force, rtol=1e-9, atol=1e-9 * scale)
        inner = slice(nodes.start + 1, nodes.stop - 1)
        want = np.array([np.linalg.solve(m, f) for m, f in zip(inertia[1:-1], force[1:-1])])
        np.testing.assert_allclose(state.acceleration[:, inner].T, want, rtol=1e-9, atol=1e-9 * np.abs(want).max())
        for id, i in ((line.end_a, 0), (line.end_b, -1)):
            if description.point(id).kind == FREE:
                ends, inertia_of_ends = ends + force[i], inertia_of_ends + inertia[i]
            else:
                np.testing.assert_array_equal(state.acceleration[:, nodes][:, i], 0.0)
    node = model.point_node[1]
    force, inertia = point_formulas(description, state.position[:, node], state.velocity[:, node], dry)
    want = np.linalg.solve(inertia + inertia_of_ends, force + ends)
    np.testing.assert_allclose(state.acceleration[:, node], want, rtol=1e-9, atol=1e-9 * np.abs(want).max())


@pytest.mark.parametrize("seed", range(20))
def test_forces_and_accelerations_of_random_states(seed):
    """All nodes under water, some of them in the bed, some segments slack: 1e-9 of the largest force."""
    description = three_lines()
    model, state, _ = random_state(description, seed, lift=-3.0)
    live = state.tension[model.live > 0.0]
    assert (live == 0.0).any() and (live > 0.0).any()
    assert (state.position[2, : model.size] < -DEPTH).any()
    check(description, model, state)


@pytest.mark.parametrize("seed", range(5))
def test_nothing_of_the_water_acts_in_the_air(seed):
    """All 70 m up: no buoyancy, drag or added mass; no bed."""
    description = three_lines()
    model, state, _ = random_state(description, seed, lift=70.0)
    check(description, model, state, dry=True)


def test_ends_have_the_motion_of_their_points():
    model, state, _ = random_state(three_lines(), 1)
    for e, p in enumerate(state.end_point):
        for row in (state.position, state.velocity):
            np.testing.assert_array_equal(row[:, model.end_node[e]], row[:, model.point_node[p]])


def test_slack_segment_carries_nothing_however_fast_it_stretches():
    """Damping included, up to the very length at which it is taut; and a taut one that shortens fast never pushes."""
    description = scene([(FIXED, (0, 0, -10)), (COUPLED, (10, 0, -10))], [(line_type(damping=1e7), 1, 2, 10.0, 1)])
    model, ends = build(description)
    state, scratch = new_state(model, ends), new_scratch(model)
    for stretched, speed, want in ((9.999999, 50.0, 0.0), (10.0, 50.0, 0.0), (10.01, 0.0, 1e5), (10.01, 1.0, 1.1e6), (10.01, -50.0, 0.0)):
        state.position[:, model.point_node] = [[0.0, stretched], [0.0, 0.0], [-10.0, -10.0]]
        state.velocity[0, model.point_node[1]] = speed
        evaluate_once(model, state, scratch, 0.0, 0.0, True)
        assert state.tension[1] == pytest.approx(want, rel=1e-9)


@pytest.mark.parametrize("step", [0.0, 0.01])
def test_bed_pushes_and_never_pulls(step):
    """Force of the bed at any depth and speed is upwards, and zero where it is not met within the step; leaving fast, the damper would pull: it must not."""
    description = scene(
        [(FIXED, (0, 0, -50)), (FIXED, (20, 0, -50))], [(line_type(0.1, 10.0, 1e3), 1, 2, 40.0, 2)], depth=50.0, gravity=0.0, water_density=0.0
    )
    model, ends = build(description)
    state, scratch = new_state(model, ends), new_scratch(model)
    state.position[:, model.point_node] = [[0.0, 20.0], [0.0, 0.0], [-50.0, -50.0]]
    rng = np.random.default_rng(5)
    pushed = 0
    for _ in range(300):
        depth, speed = rng.normal(0.0, 0.1), rng.normal(0.0, 0.5)
        state.position[:, 1] = [10.0, 0.0, -50.0 - depth]
        state.velocity[2, 1] = speed
        evaluate_once(model, state, scratch, 0.0, step, True)
        assert state.force[2, 1] >= 0.0
        assert (state.force[2, 1] > 0.0) == (depth - step * speed > 0.0) or depth > 0.0
        pushed += state.force[2, 1] > 0.0
        if step == 0.0 and depth > 0.0:
            plain = (3e6 * depth - 3e5 * speed) * 0.1 * 20.0
            assert state.force[2, 1] == pytest.approx(max(plain, 0.0), rel=1e-9, abs=1e-6)
    assert 50 < pushed < 250


@pytest.mark.parametrize(
    ("low", "high", "want"), [(-20.0, -10.0, 1.0), (10.0, 20.0, 0.0), (-5.0, 5.0, 0.5), (-2.5, 7.5, 0.25), (-7.5, 2.5, 0.75), (0.0, 0.0, 0.5)]
)
def test_wet_share_of_a_line_through_the_surface(low, high, want):
    """Buoyancy of a 10 m line of one segment, upright through the surface or lying in it: the wet share of its length, 0.5 %."""
    plan = np.sqrt(100.0 - (high - low) ** 2)
    description = scene([(FIXED, (0, 0, low)), (COUPLED, (plan, 0, high))], [(line_type(0.05), 1, 2, 10.0, 1)])
    model, ends = build(description)
    state, scratch = new_state(model, ends), new_scratch(model)
    state.position[:, model.point_node] = [[0.0, plan], [0.0, 0.0], [low, high]]
    evaluate_once(model, state, scratch, 0.0, 0.0, True)
    lift = state.force[2, :2].sum() + model.weight[:2].sum()
    assert lift / model.buoyancy[:2].sum() == pytest.approx(want, abs=5e-3)


@pytest.mark.parametrize("share", [-0.7, -0.3, 0.0, 0.2, 0.45, 0.7])
def test_sphere_displaces_its_cap(share):
    """Buoyancy of a free point with its centre at share x diameter: volume of the spherical cap below the surface, exact."""
    volume = 0.8
    diameter = (6.0 * volume / np.pi) ** (1.0 / 3.0)
    description = scene([(FIXED, (0, 0, -30)), (FREE, (0, 0, 0), 400.0, volume)], [(line_type(0.0), 1, 2, 40.0, 1)])
    model, ends = build(description)
    state, scratch = new_state(model, ends), new_scratch(model)
    state.position[:, model.point_node] = [[0.0, 0.0], [0.0, 0.0], [-30.0, share * diameter]]
    evaluate_once(model, state, scratch, 0.0, 0.0, True)
    h = np.clip(0.5 * diameter - share * diameter, 0.0, diameter)
    cap = np.pi * h**2 * (0.5 * diameter - h / 3.0)
    node = model.point_node[1]
    assert (state.force[2, node] + model.weight[node]) == pytest.approx(1025.0 * 9.80665 * cap, rel=1e-9, abs=1e-9)


def test_padding_and_points_never_disturb_a_line():
    """The same line alone and among others, so at other places in the rows: the same forces to the last bit."""
    kind = line_type(0.1, 50.0, 1e6, 1e4, 1.0, 1.0, 0.1, 0.1)
    ends = [(FIXED, (-30, 0, -50)), (COUPLED, (10, 0, -5))]
    alone = scene(ends, [(kind, 1, 2, 62.0, 11)], depth=DEPTH, current=CURRENT)
    among = scene(ends * 3, [(kind, 3, 4, 62.0, 11), (kind, 5, 6, 62.0, 4), (kind, 1, 2, 62.0, 11)], depth=DEPTH, current=CURRENT)
    rng = np.random.default_rng(3)
    x, v = rng.normal(0.0, 5.0, (3, 12)) + [[0.0], [0.0], [-30.0]], rng.normal(0.0, 1.0, (3, 12))
    forces = []
    for description, line in ((alone, 0), (among, 2)):
        model, end_point = build(description)
        state, scratch = new_state(model, end_point), new_scratch(model)
        first = model.first_node[line]
        for e, column in ((2 * line, 0), (2 * line + 1, 11)):
            state.position[:, model.point_node[end_point[e]]] = x[:, column]
            state.velocity[:, model.point_node[end_point[e]]] = v[:, column]
        state.position[:, first : first + 12], state.velocity[:, first : first + 12] = x, v
        evaluate_once(model, state, scratch, 0.0, 0.0, True)
        forces.append(state.force[:, first : first + 12].copy())
    np.testing.assert_array_equal(forces[0], forces[1])




def test_turning_is_no_rate_of_length_where_velocities_stand_half_a_step_behind():
    step, angle = 0.02, 0.01
    model, state, scratch = random_state(three_lines(), seed=3)
    live = np.flatnonzero(model.live[: model.size])
    c, s = np.cos(angle), np.sin(angle)
    before = state.position.copy()
    state.position[:2] = np.array([[c, -s], [s, c]]) @ before[:2]
    state.velocity[:] = (state.position - before) / step
    rates = []
    for back in (0.0, 0.5 * step):
        state.settings[9] = back
        evaluate_once(model, state, scratch, 0.0, 0.0, True)
        rates.append(np.abs(state.strain_rate[live]).max())
    assert rates[1] < 1e-4 * rates[0]
