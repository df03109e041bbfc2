"""The two laws of bed friction, node by node."""

import numpy as np
import pytest

from mooring_ros.core.bed import build_ground
from mooring_ros.core.ground import commit_grip, ground_blocks
from mooring_ros.scene import Environment
from mooring_ros.scene.description import Friction

from .one_node import Nodes, norms

STATIC, KINETIC, RAMP = (0.92, 1.33), (0.69, 1.0), 3e4  # axial and transverse; N s/m
SLOPE = (0.2, -0.1)


def ground(law, static=STATIC, kinetic=KINETIC, **friction):
    return build_ground(Environment(depth=100.0, bed_slope=SLOPE, friction=Friction(law, *static, *kinetic, RAMP, **friction)))


def push_of(nodes, force):
    return nodes.along_normal(force)


# -- saturated --------------------------------------------------------------------------------------------------------------------------


def saturated(velocity, push, static, kinetic):
    """Equations 7 to 12 of Housner et al. 2022 for one direction: velocity (k, n), |F_n| (n,)."""
    speed = norms(velocity)
    sliding = static * RAMP * speed > static * push
    ramp = static * RAMP * velocity
    return -np.where(sliding, kinetic * push * velocity / np.maximum(speed, 1e-300), ramp), sliding


def test_saturated_friction_is_that_of_the_paper():
    nodes = Nodes(ground("saturated"), n=2000, speed=0.1)
    force = nodes.forces(0.0)
    push = push_of(nodes, force)
    axial, across = nodes.split(nodes.velocity[:, : nodes.n])
    expected_axial, slides_axially = saturated(axial[None], push, STATIC[0], KINETIC[0])
    expected_across, slides_across = saturated(across, push, STATIC[1], KINETIC[1])
    pressed = push > 0.0
    for sliding in (slides_axially[pressed], slides_across[pressed]):
        assert 0.02 < sliding.mean() < 0.98  # both branches are met
    expected = expected_axial * nodes.axial_direction() + expected_across
    assert np.abs(nodes.in_plane(force) - expected)[:, pressed].max() < 1e-10 * norms(force).max()
    assert not nodes.in_plane(force)[:, ~pressed].any()


def test_isotropic_saturated_friction_acts_against_the_whole_velocity():
    nodes = Nodes(ground("saturated", (0.8, 0.8), (0.6, 0.6), isotropic=True), n=1000)
    force = nodes.forces(0.0)
    push = push_of(nodes, force)
    expected, _ = saturated(nodes.in_plane(nodes.velocity[:, : nodes.n]), push, 0.8, 0.6)
    assert np.abs(nodes.in_plane(force) - expected)[:, push > 0.0].max() < 1e-10 * norms(force).max()


@pytest.mark.parametrize("step", [1e-4, 1e-3, 1e-1, 10.0])
def test_saturated_friction_is_that_of_the_velocity_after_the_step(step):
    nodes = Nodes(ground("saturated"), n=2000, speed=1.0, flat=True)
    force = nodes.forces(step)
    push = push_of(nodes, force)
    pressed = push > 0.0
    after = nodes.velocity[:, : nodes.n] + step * nodes.accelerations(force)
    friction = nodes.split(force)
    for part, speed, static, kinetic in zip(friction, nodes.split(after), STATIC, KINETIC):
        part, speed = np.atleast_2d(part)[:, pressed], np.atleast_2d(speed)[:, pressed]
        expected, sliding = saturated(speed, push[pressed], static, kinetic)
        # where the force drops from static to kinetic both branches may be right: never more than static, never with the slip
        either = np.abs(part - expected).max(axis=0) < 1e-9 * norms(force).max()
        assert either.mean() > 0.999
        assert (part * speed).sum(axis=0).max() < 1e-6
        assert (norms(part) <= static * push[pressed] * (1.0 + 1e-9)).all()


# -- stick ------------------------------------------------------------------------------------------------------------------------------


def gripping(seed=0, spread=2e-5, flat=True, state=(0.0, 1.0), **law):
    """Nodes that remember places up to some elastic slips away."""
    nodes = Nodes(ground("stick", **law), n=2000, seed=seed, speed=0.005, deep=0.01, flat=flat)
    rng = np.random.default_rng(seed + 1)
    nodes.grip[:3, : nodes.n] = nodes.position[:, : nodes.n] + nodes.in_plane(rng.normal(0.0, spread, (3, nodes.n)))
    nodes.grip[3] = np.resize(state, nodes.n + 1)
    return nodes


def load_of(nodes, friction, push):
    """1 where friction is on the ellipse of the node's state."""
    sliding = nodes.grip[3, : nodes.n] > 0.0
    axial, across = nodes.split(friction)
    mu_axial, mu_across = (np.where(sliding, k, s) for s, k in zip(STATIC, KINETIC))
    return np.hypot(axial / (mu_axial * push), norms(across) / (mu_across * push))


@pytest.mark.parametrize("step", [0.0, 1e-4, 1e-3, 1e-1])
def test_sticking_friction_is_elastic_inside_the_ellipse_and_against_the_slip_on_it(step):
    nodes = gripping()
    force = nodes.forces(step)
    push, friction = push_of(nodes, force), nodes.in_plane(force)
    pressed = push > 1.0
    load = load_of(nodes, friction, np.where(pressed, push, np.inf))[pressed]
    assert load.max() < 1.0 + 1e-12
    inside = load < 1.0 - 1e-9
    assert 0.05 < inside.mean() < 0.95
    velocity = nodes.velocity[:, : nodes.n] + step * nodes.accelerations(force)
    place = (nodes.position - nodes.grip[:3])[:, : nodes.n] + step * velocity
    ratio = nodes.ground.stiffness_ratio
    trial = -nodes.in_plane(ratio * nodes.stiffness * place + np.sqrt(ratio) * nodes.damping * velocity)[:, pressed]
    friction = friction[:, pressed]
    assert np.abs(friction - trial)[:, inside].max() < 1e-9 * norms(force).max()
    slip, against = trial[:, ~inside], friction[:, ~inside]
    across = norms(np.cross(slip.T, against.T).T) / (norms(slip) * norms(against))
    assert across.max() < 0.1 and np.median(across) < 1e-5  # one Newton step for the direction, whatever the ratio of the inertias
    assert (slip * against).sum(axis=0).min() > 0.0
    assert (norms(slip) >= norms(against) * (1.0 - 1e-6)).all()


def test_a_shared_node_gets_the_law_at_its_place_and_speed_and_what_it_adds_to_the_inertia():
    step = 1e-2
    for law in ("saturated", "stick"):
        nodes = Nodes(ground(law), n=500, flat=True)
        nodes.grip[:3], nodes.grip[3] = nodes.position, 0.0
        nodes.slaved[:] = True
        force = nodes.forces(step)
        velocity = nodes.velocity[:, : nodes.n]
        resist = nodes.damping + step * nodes.stiffness
        push = np.where(nodes.depth > 0.0, np.maximum(nodes.stiffness * nodes.depth - resist * nodes.along_normal(velocity), 0.0), 0.0)
        assert np.abs(push_of(nodes, force) - push).max() < 1e-9 * push.max()
        assert np.abs(nodes.hold[0, : nodes.n] - np.where(push > 0.0, step * resist, 0.0)).max() < 1e-9
        for held in nodes.hold[1:, : nodes.n]:
            assert (held[push > 0.0] > 0.0).all() and not held[push == 0.0].any()
        if law == "stick":  # inside the ellipse
            ratio = nodes.ground.stiffness_ratio
            stuck = (load_of(nodes, nodes.in_plane(force), np.where(push > 0.0, push, np.inf)) < 0.999) & (push > 0.0)
            assert stuck.any()
            for held in nodes.hold[1:, : nodes.n]:
                assert held[stuck] == pytest.approx((step * (np.sqrt(ratio) * nodes.damping + step * ratio * nodes.stiffness))[stuck])


def test_saturated_friction_of_a_shared_node_is_that_of_the_speed_expected_of_it_in_each_direction():
    """Whatever it now has: what starts to slide along the line is not held by what sticks across it."""
    step = 1e-2
    nodes = Nodes(ground("saturated"), n=2000, speed=0.01, flat=True)
    nodes.slaved[:] = True
    nodes.expected[:, : nodes.n] = np.random.default_rng(5).normal(0.0, 10.0, (3, nodes.n))
    force = nodes.forces(step)
    push = push_of(nodes, force)
    pressed = push > 0.0
    after = nodes.in_plane(nodes.velocity[:, : nodes.n] + step * nodes.expected[:, : nodes.n])
    gains = nodes.split(nodes.in_plane(nodes.expected[:, : nodes.n]))
    holds = nodes.hold[1, : nodes.n], nodes.hold[2, : nodes.n]
    for part, gain, hold, speed, static, kinetic in zip(nodes.split(nodes.in_plane(force)), gains, holds, nodes.split(after), STATIC, KINETIC):
        friction = np.atleast_2d(part - hold * gain)[:, pressed]
        expected, sliding = saturated(np.atleast_2d(speed)[:, pressed], push[pressed], static, kinetic)
        either = np.abs(friction - expected).max(axis=0) < 1e-9 * norms(force).max()
        assert either[sliding].mean() > 0.99 and sliding.mean() > 0.3


def pulled(nodes, place, push):
    """Axial friction of one node moved along the line to `place` (m), committed; the bed pushes with `push` (N)."""
    depth = push / nodes.stiffness[0]
    e = nodes.axial_direction()
    nodes.position[:, :1] = nodes.start + place * e
    nodes.position[2, 0] = -100.0 + SLOPE[0] * nodes.position[0, 0] + SLOPE[1] * nodes.position[1, 0] - depth / nodes.n_hat[2, 0]
    force = nodes.forces(0.0)
    tangent = np.zeros((3, 2))
    tangent[:, 0] = nodes.direction[:, 0]
    commit_grip(nodes.ground, 1, nodes.position, nodes.velocity, tangent, nodes.stiffness, nodes.damping, nodes.bed, nodes.grip)
    return float((force * e).sum()), nodes.grip[3, 0]


def test_a_node_sticks_up_to_static_friction_slides_with_kinetic_and_sticks_again():
    nodes = Nodes(ground("stick"), n=1, flat=True)
    nodes.velocity[:] = 0.0
    nodes.start = np.array([[3.0], [4.0], [0.0]])
    push = 1000.0
    elastic = push / (nodes.ground.stiffness_ratio * nodes.stiffness[0])  # m for a friction of N
    assert pulled(nodes, 0.0, push) == pytest.approx((0.0, 0.0), abs=1e-9)  # touches down and holds on here
    force, state = pulled(nodes, 0.8 * elastic, push)
    assert force == pytest.approx(-0.8 * push, rel=1e-6) and state == 0.0
    force, state = pulled(nodes, 0.91 * elastic, push)
    assert force == pytest.approx(-0.91 * push, rel=1e-6) and state == 0.0  # above kinetic, below static
    force, state = pulled(nodes, 1.2 * elastic, push)
    assert force == pytest.approx(-STATIC[0] * push) and state == 1.0
    for place in (3.0, 4.0, 5.0):
        force, state = pulled(nodes, place * elastic, push)
        assert force == pytest.approx(-KINETIC[0] * push, rel=1e-6) and state == 1.0
    force, state = pulled(nodes, 5.0 * elastic, push)
    assert force == pytest.approx(-KINETIC[0] * push, rel=1e-6) and state == 0.0  # at rest: sticks
    force, state = pulled(nodes, (5.0 - 0.69 - 0.5) * elastic, push)
    assert force == pytest.approx(0.5 * push, rel=1e-6) and state == 0.0  # and holds the other way
    nodes.position[2, 0] += 1.0
    nodes.forces(0.0)
    commit_grip(nodes.ground, 1, nodes.position, nodes.velocity, np.zeros((3, 2)), nodes.stiffness, nodes.damping, nodes.bed, nodes.grip)
    assert nodes.grip[3, 0] == -1.0  # forgets where it lay


def test_the_memory_of_a_sliding_node_keeps_kinetic_friction():
    nodes = gripping(spread=2e-4)
    force = nodes.forces(0.0)
    tangent = np.zeros((3, nodes.n + 1))
    for parity in (0, 1):
        tangent[:] = 0.0
        tangent[:, parity : nodes.n : 2] = nodes.direction[:, parity::2]
        chosen = np.arange(parity, nodes.n, 2)
        grip = nodes.grip.copy()
        commit_grip(nodes.ground, nodes.n, nodes.position, nodes.velocity, tangent, nodes.stiffness, nodes.damping, nodes.bed, grip)
        nodes.grip[:, chosen] = grip[:, chosen]
    nodes.velocity[:] = 0.0
    force = nodes.forces(0.0)
    push = push_of(nodes, force)
    slides = (nodes.grip[3, : nodes.n] > 0.0) & (push > 0.0)
    assert slides.any()
    assert load_of(nodes, nodes.in_plane(force), np.where(push > 0.0, push, np.inf))[slides].max() < 1.0 + 1e-9


@pytest.mark.parametrize("state", [0.0, 1.0])
@pytest.mark.parametrize("spread", [2e-6, 2e-4])
def test_blocks_for_newton_are_the_derivatives_of_the_forces(state, spread):
    nodes = gripping(spread=spread, state=(state,))
    nodes.velocity[:] = 0.0
    n = nodes.n
    base = nodes.position.copy()
    load = nodes.in_plane(nodes.forces(0.0))
    blocks = np.zeros((n, 3, 3))
    for parity in (0, 1):
        tangent, part = np.zeros((3, n + 1)), np.zeros((n, 3, 3))
        tangent[:, parity:n:2] = nodes.direction[:, parity::2]
        ground_blocks(nodes.ground, n, nodes.position, tangent, nodes.stiffness, nodes.bed, nodes.grip, part)
        blocks[parity::2] = part[parity::2]
    h = 1e-9
    difference = np.zeros((n, 3, 3))
    for k in range(3):
        for sign in (-1.0, 1.0):
            nodes.position[:] = base
            nodes.position[k] += sign * h
            difference[:, :, k] -= sign * nodes.forces(0.0).T / (2.0 * h)
    nodes.position[:] = base
    scale = nodes.ground.stiffness_ratio * nodes.stiffness.max()
    push = push_of(nodes, nodes.forces(0.0))
    ratio = load_of(nodes, load, np.where(push > 0.0, push, np.inf))
    trial = nodes.in_plane(nodes.ground.stiffness_ratio * nodes.stiffness * (base - nodes.grip[:3])[:, :n])
    limit = load_of(nodes, trial, np.where(push > 0.0, push, np.inf))
    smooth = (np.abs(limit - 1.0) > 1e-3) & (np.abs(nodes.depth) > 1e-6) & ((push > 50.0) | (push == 0.0))
    assert smooth.mean() > 0.5 and ratio.max() < 1.0 + 1e-9
    assert np.abs(blocks - difference)[smooth].max() < 1e-4 * scale


@pytest.mark.parametrize("wrong", [dict(static=(0.5, 1.33)), dict(kinetic=(-0.1, 1.0)), dict(static=(np.inf, 2.0))])
def test_coefficients_without_sense_are_refused(wrong):
    with pytest.raises(ValueError, match="friction"):
        ground("stick", **wrong)
