"""The implicit solver: order, agreement with the explicit one, bits, steps far beyond the explicit limit."""

import numpy as np
import pytest
from scenes_in_code import HERE, SCENES, STILL, anchored, line_type, surge_heave

from mooring_ros import Mooring
from mooring_ros.errors import MooringError

PERIOD = 4.0


def hanging(stiffness=2e6, segments=12, **options):
    """A line that hangs free of the bed."""
    kind = line_type(0.1, 30.0, stiffness, -0.3, drag=1.2, added=1.0, drag_axial=0.1)
    return Mooring(anchored(kind, (0, 0, -40), (30, 0, 0), 55.0, segments, depth=100.0), solver="implicit", **options)


def rows(count, dt, amplitude=0.5):
    t = dt * np.arange(1, count + 1)
    w = 2.0 * np.pi / PERIOD
    poses, twists = np.zeros((count, 7)), np.zeros((count, 6))
    poses[:, 6] = 1.0
    poses[:, 0], twists[:, 0] = amplitude * (1.0 - np.cos(w * t)), amplitude * w * np.sin(w * t)
    poses[:, 2], twists[:, 2] = -0.3 * amplitude * (1.0 - np.cos(w * t)), -0.3 * amplitude * w * np.sin(w * t)
    return t, poses, twists


def tensions(mooring, sample=0.25, count=24):
    mooring.settle(HERE)
    return mooring.run(*rows(count, sample)).fairlead_tension[:, 0]


def test_second_order_in_the_step():
    finest = tensions(hanging(dt=0.25 / 320))
    errors = [np.sqrt(np.mean((tensions(hanging(dt=0.25 / n)) - finest) ** 2)) for n in (5, 10, 20, 40)]
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    assert slopes[-1] == pytest.approx(2.0, abs=0.25), (slopes, errors)
    assert (slopes > 1.5).all(), (slopes, errors)


@pytest.mark.parametrize("file", ["oc4.txt", "volturnus_s_chain.txt", "oc3_spar.txt"])
def test_tensions_are_those_of_the_explicit_solver(file):
    found = {}
    for solver in ("explicit", "implicit"):
        mooring = Mooring(SCENES / file, solver=solver)
        mooring.settle(HERE)
        times = 0.1 * np.arange(1, 201)
        found[solver] = mooring.run(times, *surge_heave(times))
    error = found["implicit"].fairlead_tension - found["explicit"].fairlead_tension
    assert (np.sqrt((error**2).mean(axis=0)) < 0.02 * found["explicit"].fairlead_tension.std(axis=0)).all()


def test_steps_a_thousand_times_the_explicit_limit_are_stable():
    stiff = hanging(stiffness=1e10, segments=20, dt=0.25)
    explicit = hanging(stiffness=1e10, segments=20).step_limit.limits["axial"]
    assert 0.25 > 500.0 * explicit
    soft = tensions(hanging(stiffness=1e10, segments=20, dt=0.02))
    assert tensions(stiff) == pytest.approx(soft, rel=0.2)


@pytest.mark.parametrize("blocks", [1, 3])
def test_run_in_blocks_and_step_by_step_give_the_same_bits(blocks):
    one, other = hanging(), hanging()
    one.settle(HERE), other.settle(HERE)
    t, poses, twists = rows(30, 0.1)
    whole = np.concatenate([one.run(*part).wrench for part in zip(*(np.array_split(a, blocks) for a in (t, poses, twists)))])
    for i in range(t.size):
        other.step(t[i], poses[i], twists[i])
        assert (other.wrench == whole[i]).all()


def test_restore_and_go_on_gives_the_same_bits():
    one, other = hanging(), hanging()
    one.settle(HERE)
    t, poses, twists = rows(30, 0.1)
    one.run(t[:11], poses[:11], twists[:11])
    saved = one.snapshot()
    first = one.run(t[11:], poses[11:], twists[11:]).wrench
    other.restore(saved)
    assert (other.run(t[11:], poses[11:], twists[11:]).wrench == first).all()


def test_a_refused_step_leaves_the_bits_as_they_were():
    mooring = hanging()
    mooring.settle(HERE)
    t, poses, twists = rows(10, 0.1)
    mooring.run(t, poses, twists)
    before = mooring.snapshot()
    far = poses[-1].copy()
    far[0] += 500.0
    with pytest.raises(MooringError):
        mooring.step(t[-1] + 0.1, far, STILL)
    for mine, theirs in zip(mooring.snapshot().state, before.state):
        assert (mine == theirs).all()


def test_what_lands_on_a_hard_bed_stays_down():
    """A blow is over within its step: nodes do not spring up by a share of the way that they fell."""
    kind = line_type(0.1, 100.0, 4e8, -0.5, drag=1.2, added=1.0, drag_axial=0.05)
    made = anchored(kind, (300, 0, -100), (0, 0, -10), 335.0, 20, depth=100.0, bed_stiffness=1e9, bed_damping=1e7)
    mooring = Mooring(made, solver="implicit", dt=0.05)
    mooring.settle(HERE)
    count = 160
    poses, twists = np.tile(HERE, (count, 1)), np.zeros((count, 6))
    poses[:, 2], twists[:, 2] = -2.0 * 0.05 * np.arange(1, count + 1), -2.0
    height = [mooring.node_positions("line1")[:, 2] + 100.0]
    for i in range(count):
        mooring.step(0.05 * (i + 1), poses[i], twists[i])
        height.append(mooring.node_positions("line1")[:, 2] + 100.0)
    height = np.array(height)[:, 1:-1]
    landed = (height[1:-1] < 0.002) & (height[:-2] > 0.01)
    assert landed.sum() >= 2
    fallen, risen = (height[:-2] - height[1:-1])[landed], (height[2:] - np.maximum(height[1:-1], 0.0))[landed]
    assert (risen < 0.1 * fallen).all(), (risen, fallen)


@pytest.mark.parametrize("radius", [-0.1, 1.1, np.nan])
def test_a_spectral_radius_out_of_range_is_refused(radius):
    with pytest.raises(ValueError, match="spectral_radius"):
        hanging(spectral_radius=radius)
