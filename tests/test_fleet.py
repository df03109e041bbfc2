"""A fleet does what its moorings would do by themselves, bit for bit, however many threads advance it."""

import numpy as np
import pytest
from scenes_in_code import COUPLED, FIXED, HERE, SCENES, anchored, line_type, scene, surge_heave

from mooring_ros import Fleet, Mooring, MooringError, blocks
from mooring_ros.scene import load_scene

CHAIN = line_type(0.1, 100.0, 1e8, -0.5, drag=1.6, added=1.0)
TIMES = np.arange(1, 61) * 0.1


def chain(length=220.0, segments=10):
    return anchored(CHAIN, (-200.0, 0.0, -60.0), (0.0, 0.0, -5.0), length, segments, depth=60.0)


def motions(count):
    """Poses (k, count, 7) and twists (k, count, 6), each platform with its own."""
    ways = [surge_heave(TIMES, surge=1.0 + 0.1 * m, heave=0.5, period=8.0 + m, pitch=0.01 * m) for m in range(count)]
    return np.stack([poses for poses, _ in ways], axis=1), np.stack([twists for _, twists in ways], axis=1)


def state_bits(mooring):
    return b"".join(array.tobytes() for array in (*mooring._state, *mooring._readings))


def everything():
    """Scenes of unlike shapes and effects: bending, waves, beds with friction, parts, and a plain chain."""
    names = ("rm3_cable", "iswec_c1", "volturnus_s_semi_taut_friction", "lazy_wave")
    return [*(load_scene(SCENES / f"{name}.txt") for name in names), chain()]


@pytest.mark.parametrize("threads", [1, 3])
def test_a_fleet_has_the_bits_of_single_moorings_in_steps_and_in_runs(threads):
    same = chain()
    scenes = [same, chain(segments=14), same, same, chain(length=230.0)]
    poses, twists = motions(len(scenes))
    fleet = Fleet(scenes, threads=threads)
    fleet.settle(HERE)
    for j in range(20):
        fleet.step(TIMES[j], poses[j], twists[j])
    history = fleet.run(TIMES[20:], poses[20:], twists[20:])
    for m, own in enumerate(scenes):
        single = Mooring(own)
        single.settle(HERE)
        alone = single.run(TIMES, poses[:, m].copy(), twists[:, m].copy())
        assert state_bits(single) == state_bits(fleet[m])
        assert (history.wrench[:, m] == alone.wrench[20:]).all()
        lines = slice(history.first_line[m], history.first_line[m + 1])
        assert (history.fairlead_tension[:, lines] == alone.fairlead_tension[20:]).all()
        assert (history.anchor_tension[:, lines] == alone.anchor_tension[20:]).all()
        assert (fleet.wrenches[m] == single.wrench).all()
        assert (fleet.fairlead_tension[lines] == single.fairlead_tension).all()
        assert (fleet.anchor_tension[lines] == single.anchor_tension).all()


def test_what_scenes_hold_does_not_leak_through_the_shared_work_space():
    scenes = everything()
    fleet = Fleet([*scenes, *scenes[::-1]], threads=1)
    fleet.settle(HERE)
    dt = np.array([0.05, 0.1, 0.15])
    poses, twists = np.tile(HERE, (3, len(fleet), 1)), np.zeros((3, len(fleet), 6))
    poses[:, :, 0] += 0.05 * dt[:, None] ** 2
    twists[:, :, 0] += 0.1 * dt[:, None]
    fleet.run(dt, poses, twists)
    for m, own in enumerate(scenes):
        single = Mooring(own)
        single.settle(HERE)
        single.run(dt, poses[:, 0].copy(), twists[:, 0].copy())
        assert state_bits(single) == state_bits(fleet[m]) == state_bits(fleet[len(fleet) - 1 - m]), own.path


def test_platforms_settle_where_they_are():
    away = HERE.copy()
    away[0] = 3.0
    fleet = Fleet([chain(), Mooring(chain())])
    fleet.settle(np.array([HERE, away]), time=5.0)
    for m, pose in enumerate((HERE, away)):
        single = Mooring(chain())
        single.settle(pose, time=5.0)
        assert state_bits(single) == state_bits(fleet[m])
        assert fleet[m].static_result == single.static_result


def test_twins_move_by_themselves():
    first = Mooring(chain())
    first.settle(HERE)
    other, before = first.twin(), state_bits(first)
    poses, twists = motions(1)
    other.run(TIMES, poses[:, 0].copy(), twists[:, 0].copy())
    assert state_bits(first) == before
    first.run(TIMES, poses[:, 0].copy(), twists[:, 0].copy())
    assert state_bits(first) == state_bits(other)
    other.settle(HERE)
    first.restore(other.snapshot())
    assert state_bits(first) == state_bits(other)


def test_a_mooring_that_cannot_go_on_stays_and_is_named_while_the_others_go_on():
    same = chain()
    fleet = Fleet([same] * 4, threads=2)
    fleet.settle(HERE)
    poses, twists = motions(4)
    poses[30:, 2, 0] += 1e4
    single = Mooring(same)
    single.settle(HERE)
    with pytest.raises(MooringError) as alone:
        single.run(TIMES, poses[:, 2].copy(), twists[:, 2].copy())
    with pytest.raises(MooringError, match=r"1 of 4 moorings could not be advanced\. Mooring 2: the step to t = 3\.1 s") as raised:
        fleet.run(TIMES, poses, twists)
    assert raised.value.failed == {2: str(alone.value)}
    assert len(raised.value.history.time) == 30
    assert (raised.value.history.wrench[:, 2] == alone.value.history.wrench).all()
    assert [mooring.time for mooring in fleet.moorings] == [TIMES[-1], TIMES[-1], TIMES[29], TIMES[-1]]
    assert state_bits(fleet[2]) == state_bits(single)


def test_bad_input_leaves_all_as_they_were():
    fleet = Fleet([chain()] * 3)
    still = np.zeros((3, 6))
    here = np.tile(HERE, (3, 1))
    with pytest.raises(ValueError, match="moorings 0, 1, 2 have not been settled"):
        fleet.step(1.0, here, still)
    fleet.settle(HERE)
    fleet[1].step(2.0, HERE, np.zeros(6))
    before = [state_bits(mooring) for mooring in fleet.moorings]
    for t, poses, twists in ((1.0, here, still), (np.nan, here, still), (3.0, here[:2], still), (3.0, 2.0 * here, still), (3.0, here, still * np.nan)):
        with pytest.raises(ValueError):
            fleet.step(t, poses, twists)
    with pytest.raises(ValueError):
        fleet.run([3.0, 2.5], np.tile(here, (2, 1, 1)), np.zeros((2, 3, 6)))
    assert [state_bits(mooring) for mooring in fleet.moorings] == before
    for members, options in (([], {}), ([chain()], {"threads": 0}), ([Mooring(chain())], {"segments": 5})):
        with pytest.raises(ValueError):
            Fleet(members, **options)


def test_winches_and_releases_of_members_act_in_the_fleet():
    same = chain()
    fleet, single = Fleet([same] * 2), Mooring(same)
    fleet.settle(HERE)
    single.settle(HERE)
    for mooring in (fleet[1], single):
        mooring.set_unstretched_length("line1", 215.0)
    poses, twists = motions(2)
    fleet.run(TIMES[:10], poses[:10], twists[:10])
    single.run(TIMES[:10], poses[:10, 1].copy(), twists[:10, 1].copy())
    for mooring in (fleet[1], single):
        mooring.release("line1")
    fleet.run(TIMES[10:20], poses[10:20], twists[10:20])
    single.run(TIMES[10:20], poses[10:20, 1].copy(), twists[10:20, 1].copy())
    assert state_bits(fleet[1]) == state_bits(single)
    assert fleet[0].unstretched_length == 220.0


def test_moorings_that_are_not_stepped_by_the_kernel_go_along(monkeypatch):
    monkeypatch.setattr(blocks, "LARGE", 30)
    monkeypatch.setattr(blocks, "BLOCK", 10)
    two = scene([(FIXED, (-200.0, 0.0, -60.0)), (COUPLED, (0.0, 0.0, -5.0))] * 2, [(CHAIN, 1, 2, 220.0, 15), (CHAIN, 3, 4, 225.0, 15)], depth=60.0)
    kinds = [{}, {"fidelity": "quasi_static"}, {"fidelity": "linear"}, {"solver": "implicit"}]
    members = [lambda kind=kind: Mooring(chain(), **kind) for kind in kinds] + [lambda: Mooring(two)]
    fleet = Fleet([make() for make in members], threads=2)
    assert [type(mooring) for mooring in fleet.moorings] == [Mooring] * 4 + [blocks.BlockMooring]
    with pytest.raises(ValueError, match="settle"):
        fleet.step(TIMES[0], np.tile(HERE, (5, 1)), np.zeros((5, 6)))
    fleet.settle(HERE)
    poses, twists = motions(5)
    history = fleet.run(TIMES[:5], poses[:5], twists[:5])
    for m, make in enumerate(members):
        single = make()
        single.settle(HERE)
        lines = slice(fleet.first_line[m], fleet.first_line[m + 1])
        for j in range(5):
            single.step(TIMES[j], poses[j, m], twists[j, m])
            assert (history.wrench[j, m] == single.wrench).all()
            assert (history.fairlead_tension[j, lines] == single.fairlead_tension).all()
        assert (fleet.wrenches[m] == single.wrench).all()
        assert (fleet.anchor_tension[lines] == single.anchor_tension).all()
    with pytest.raises(ValueError, match="after the present one"):
        fleet.step(TIMES[2], poses[2], twists[2])
