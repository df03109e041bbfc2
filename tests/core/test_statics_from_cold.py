"""Statics from a cold start: whatever the line is, equilibrium or MooringError, and one equilibrium only."""

import numpy as np
import pytest
from scenes_in_code import COUPLED, FIXED, FREE, HERE, anchored, line_type, refresh, scene, turn

from mooring_ros import Mooring

CHAIN = line_type(0.08, 110.0, 7e8)
ROPE = line_type(0.15, 20.0, 2e7)
FLOATING = line_type(0.2, 25.0, 2e7)


def out_of_balance(mooring):
    """Largest force (N) on any node that nothing holds, summed here from the parts that the nodes of free points move with."""
    model, state = mooring._model, mooring._state
    force = state.force.copy()
    held = np.ones(force.shape[1], dtype=bool)
    for first, count in zip(model.first_node, model.segments):
        held[first + 1 : first + count] = False
    for p in model.free_points:
        ends = {int(model.end_node[e]) for e, q in enumerate(state.end_point) if q == p}
        total = sum(state.force[:, i] for i in ends | {int(model.point_node[p])})
        force[:, model.point_node[p]] = total
        held[list(ends)] = True
        held[model.point_node[p]] = False
    return np.linalg.norm(force[:, ~held], axis=0).max(initial=0.0)


def settle(description, pose=HERE, segments=None):
    mooring = Mooring(description, segments=segments)
    mooring.settle(pose)
    assert mooring.static_result.converged
    assert out_of_balance(mooring) <= 1.01 * mooring.static_result.tolerance + 1e-12
    everything = [mooring.wrench, mooring.fairlead_tension, mooring.anchor_tension, mooring.node_positions("line1"), mooring.stretched_length]
    assert all(np.isfinite(x).all() for x in everything)
    return mooring


COLD = {
    "hanging": anchored(CHAIN, (0, 0, -100), (80, 0, 0), 150.0, 40, depth=200.0),
    "taut": anchored(ROPE, (0, 0, -100), (100, 0, 0), 130.0, 40, depth=100.0),
    "very taut": anchored(CHAIN, (0, 0, -100), (100, 0, 0), 141.0, 40, depth=100.0),
    "vertical and taut": anchored(ROPE, (0, 0, -100), (0, 0, 0), 99.0, 40, depth=100.0),
    "vertical and slack": anchored(CHAIN, (0, 0, -100), (0, 0, 0), 150.0, 40, depth=100.0),
    "vertical, of just its length": anchored(CHAIN, (0, 0, -100), (0, 0, 0), 100.0, 40, depth=100.0),
    "lying on the bed": anchored(CHAIN, (0, 0, -50), (90, 0, -50), 100.0, 40, depth=50.0),
    "lying on the bed, taut": anchored(CHAIN, (0, 0, -50), (100, 0, -50), 99.9, 40, depth=50.0),
    "fairlead just above the bed": anchored(CHAIN, (0, 0, -50), (90, 0, -49.9), 100.0, 40, depth=50.0),
    "ends above each other": anchored(CHAIN, (0, 0, -50), (0, 0, -10), 100.0, 40, depth=50.0),
    "ends in one place": anchored(CHAIN, (0, 0, -20), (0, 0, -20), 30.0, 40, depth=200.0),
    "ends in one place, long enough for the bed": anchored(CHAIN, (0, 0, -20), (0, 0, -20), 100.0, 40, depth=50.0),
    "ends at one height over the bed": anchored(CHAIN, (0, 0, -20), (80, 0, -20), 160.0, 40, depth=50.0),
    "ends at one height, free of the bed": anchored(CHAIN, (0, 0, -20), (80, 0, -20), 100.0, 40, depth=200.0),
    "much too long": anchored(CHAIN, (0, 0, -50), (30, 0, 0), 400.0, 60, depth=50.0),
    "floating rope under the surface": anchored(FLOATING, (0, 0, -50), (60, 0, -10), 75.0, 40, depth=50.0),
    "floating rope with both ends down": anchored(FLOATING, (0, 0, -50), (40, 0, -50), 60.0, 40, depth=50.0),
    "floating rope long enough for the surface": anchored(FLOATING, (0, 0, -50), (60, 0, -10), 150.0, 40, depth=50.0),
    "fairlead in the air": anchored(CHAIN, (0, 0, -50), (60, 0, 10), 100.0, 40, depth=50.0),
    "strong current across": anchored(ROPE, (0, 0, -100), (60, 0, 0), 130.0, 40, depth=100.0, current=(0.0, 2.0, 0.0)),
    "strong current along": anchored(ROPE, (0, 0, -100), (60, 0, 0), 130.0, 40, depth=100.0, current=(-2.0, 0.0, 0.0)),
    "weightless": anchored(line_type(0.1, 1025.0 * 0.25 * np.pi * 0.01, 1e7), (0, 0, -50), (60, 0, -10), 80.0, 20, depth=60.0),
    "no gravity, no water, slack": anchored(ROPE, (0, 0, -50), (60, 0, -10), 80.0, 20, depth=60.0, gravity=0.0, water_density=0.0),
}
for name in ("strong current across", "strong current along"):
    DRAGGED = line_type(0.15, 20.0, 2e7, drag=1.6, drag_axial=0.2)
    COLD[name] = anchored(DRAGGED, (0, 0, -100), (60, 0, 0), 130.0, 40, depth=100.0, current=COLD[name].environment.current)


@pytest.mark.parametrize("name", COLD)
def test_single_line_settles_from_cold(name):
    settle(COLD[name])


@pytest.mark.parametrize("segments", [1, 2, 3, 5, 17, 100, 500])
@pytest.mark.parametrize("name", ["hanging", "taut", "vertical and slack", "lying on the bed", "ends at one height over the bed"])
def test_any_number_of_segments_settles(name, segments):
    settle(COLD[name], segments=segments)


@pytest.mark.parametrize("stiffness", 10.0 ** np.arange(5, 13))
@pytest.mark.parametrize("length", [105.0, 120.0, 160.0])
def test_any_stiffness_settles(length, stiffness):
    settle(anchored(line_type(0.08, 110.0, stiffness), (0, 0, -60), (80, 0, 0), length, 50, depth=60.0))


BRIDLE = scene(
    [(FIXED, (-400, 0, -100)), (FREE, (-60, 0, -30)), (COUPLED, (-20, 10, -5)), (COUPLED, (-20, -10, -5))],
    [(CHAIN, 1, 2, 360.0, 30), (ROPE, 2, 3, 48.0, 6), (ROPE, 2, 4, 48.0, 6)],
    depth=100.0,
)
CLUMP = scene(
    [(FIXED, (-400, 0, -100)), (FREE, (-200, 0, -60), 20000.0, 2.0), (COUPLED, (0, 0, -5))],
    [(ROPE, 1, 2, 220.0, 20), (ROPE, 2, 3, 215.0, 20)],
    depth=100.0,
)
LYING_CLUMP = scene(
    [(FIXED, (-400, 0, -100)), (FREE, (-300, 0, -60), 50000.0, 5.0), (COUPLED, (0, 0, -5))],
    [(CHAIN, 1, 2, 120.0, 12), (ROPE, 2, 3, 340.0, 30)],
    depth=100.0,
)
BUOY = scene(
    [(FIXED, (-400, 0, -100)), (FREE, (-200, 0, -30), 1000.0, 8.0), (COUPLED, (0, 0, -5))],
    [(CHAIN, 1, 2, 220.0, 20), (ROPE, 2, 3, 205.0, 20)],
    depth=100.0,
)
SURFACE_BUOY = scene(
    [(FIXED, (-400, 0, -100)), (FREE, (-200, 0, -5), 3000.0, 40.0), (COUPLED, (0, 0, -5))],
    [(CHAIN, 1, 2, 250.0, 20), (ROPE, 2, 3, 205.0, 20)],
    depth=100.0,
)
TWO_BUOYS = scene(
    [(FIXED, (-400, 0, -100)), (FREE, (-250, 20, -10), 500.0, 6.0), (FREE, (-100, -20, -90), 9000.0, 1.0), (COUPLED, (0, 0, -5))],
    [(CHAIN, 1, 2, 190.0, 15), (ROPE, 2, 3, 170.0, 15), (ROPE, 3, 4, 150.0, 15)],
    depth=100.0,
)
FREE_SCENES = {
    "bridle": BRIDLE,
    "clump weight": CLUMP,
    "clump weight on the bed": LYING_CLUMP,
    "buoy under water": BUOY,
    "buoy in the surface": SURFACE_BUOY,
    "buoy and clump in a chain": TWO_BUOYS,
}


@pytest.mark.parametrize("name", FREE_SCENES)
@pytest.mark.parametrize("pose", [HERE, np.concatenate([[10.0, -5.0, 2.0], turn([1, 1, 3], 0.2)])], ids=["at rest", "moved"])
def test_free_points_settle(name, pose):
    settle(FREE_SCENES[name], pose)


@pytest.mark.parametrize("name", ["hanging", "taut", "vertical and slack", "ends at one height over the bed", "fairlead in the air"])
def test_a_disturbed_start_leads_to_the_same_tension(name):
    """Statics solved again from positions thrown about by metres: tensions of the cold start, 1e-6 of the line's weight."""
    mooring = settle(COLD[name])
    want = np.append(mooring.fairlead_end_force, mooring.anchor_end_force)
    rng = np.random.default_rng(0)
    state, model = mooring._state, mooring._model
    for spread in (0.01, 0.3, 3.0):
        nodes = slice(model.first_node[0] + 1, model.first_node[0] + model.segments[0])
        state.position[:, nodes] += rng.normal(0.0, spread, state.position[:, nodes].shape)
        assert mooring._statics.solve(state, mooring._scratch).converged
        refresh(mooring)
        got = np.append(mooring.fairlead_end_force, mooring.anchor_end_force)
        np.testing.assert_allclose(got, want, atol=1e-6 * max(np.abs(want).max(), mooring._statics.tolerance))


def random_scene(rng):
    """One to three lines between an anchor, perhaps a free point, and one or two fairleads; anything a file could say."""
    depth = 10.0 ** rng.uniform(0.5, 3.0)
    mass = 10.0 ** rng.uniform(-1.5, 3.0)
    diameter = np.sqrt(4.0 * mass / (np.pi * 1025.0)) * 10.0 ** rng.uniform(-0.5, 0.15)
    weight = abs(mass - 1025.0 * 0.25 * np.pi * diameter**2) * 9.81 + 1e-3 * mass
    stiffness = weight * depth * 10.0 ** rng.uniform(1.0, 5.0)
    kind = line_type(diameter, mass, stiffness, drag=1.5)
    current = tuple(rng.uniform(-2.0, 2.0, 2)) + (0.0,) if rng.random() < 0.3 else (0.0, 0.0, 0.0)
    anchor = np.array([0.0, 0.0, -depth * (1.0 if rng.random() < 0.8 else rng.uniform(0.3, 1.0))])
    fairlead = np.array([depth * rng.uniform(0.0, 5.0), 0.0, -depth * rng.uniform(-0.05, 0.9)])
    water = dict(depth=depth, current=current, bed_stiffness=10.0 ** rng.uniform(4.0, 8.0))
    chord = np.linalg.norm(fairlead - anchor)
    count = int(rng.integers(1, 60))
    if rng.random() < 0.6:
        length = max(chord * rng.choice([0.99, 1.001, 1.05, 1.3, 2.0]), 0.1 * depth)
        return anchored(kind, anchor, fairlead, length, count, **water)
    middle = anchor + (fairlead - anchor) * rng.uniform(0.2, 0.8) + rng.normal(0.0, 0.1 * depth, 3)
    middle[2] = np.clip(middle[2], -0.95 * depth, -0.05 * depth)
    own = weight * depth / 9.81 * 10.0 ** rng.uniform(-2.0, 1.0)
    points = [(FIXED, anchor), (FREE, middle, own, own / 1025.0 * rng.choice([0.0, 0.3, 2.0])), (COUPLED, fairlead)]
    slack = rng.choice([1.01, 1.1, 1.5])
    pieces = [np.linalg.norm(middle - anchor) * slack + 0.1, np.linalg.norm(fairlead - middle) * slack + 0.1]
    lines = [(kind, 1, 2, pieces[0], count), (kind, 2, 3, pieces[1], count)]
    return scene(points, lines, **water)


def kind_of(description):
    kind, env = description.line_types[0], description.environment
    heavy = kind.mass > env.water_density * 0.25 * np.pi * kind.diameter**2
    return ("heavy " if heavy else "light ") + ("line" if len(description.lines) == 1 else "lines with a free point")


@pytest.mark.parametrize("kind", ["heavy line", "heavy lines with a free point", "light line", "light lines with a free point"])
def test_random_scenes_settle(kind):
    """The first 50 random scenes of each kind, seeded: each in equilibrium."""
    tried, failed, seed = 0, {}, 0
    while tried < 50:
        description = random_scene(np.random.default_rng(seed))
        if kind_of(description) == kind:
            tried += 1
            try:
                settle(description)
            except Exception as error:
                failed[seed] = repr(error)
        seed += 1
    assert failed == {}
