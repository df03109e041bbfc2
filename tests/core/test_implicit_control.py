"""What tells an implicit step that it is too long, and leaves quiet motions alone."""

import numpy as np
import pytest
from scenes_in_code import HERE, SCENES, anchored, line_type, surge_heave

from benchmarks.extremes.random_judge import judge
from mooring_ros import Mooring


def hanging(**options):
    """A stiff line that hangs free of the bed from the platform to its anchor."""
    kind = line_type(0.1, 30.0, 4e7, -0.5, drag=1.2, added=1.0, drag_axial=0.1)
    return Mooring(anchored(kind, (0, 0, -40), (30, 0, 0), 55.0, 12, depth=100.0), solver="implicit", **options)


def run(mooring, times, poses, twists):
    """((k,) N at the fairlead of the first line, finer pieces taken again, steps)."""
    mooring.settle(HERE)
    tension, again, steps = [], 0, 0
    for sample in zip(times, poses, twists):
        mooring.step(*sample)
        tension.append(mooring.fairlead_tension[0])
        again, steps = again + mooring.last_step["retries"], steps + mooring.last_step["steps"]
    return np.array(tension), again, steps


def test_twists_that_are_differences_of_poses_are_followed_between_the_samples():
    """The platform's acceleration then swings once an interval, and looks the same at all samples: a step a sample would not see it."""
    times = 0.05 * np.arange(1, 81)
    poses, _ = surge_heave(times, 0.5, 0.5, 4.0)
    twists = np.zeros((80, 6))
    twists[:, :3] = np.diff(np.vstack([np.zeros(3), poses[:, :3]]), axis=0) / 0.05
    found, _, steps = run(hanging(dt=0.05), times, poses, twists)
    truth, _, _ = run(hanging(dt=0.05 / 64), times, poses, twists)
    assert steps > 2 * times.size
    assert np.sqrt(np.mean((found - truth) ** 2)) < 0.1 * truth.std()


def test_smooth_motions_take_no_finer_steps():
    times = 0.05 * np.arange(1, 201)
    _, again, steps = run(hanging(dt=0.05), times, *surge_heave(times, 0.5, 0.5, 10.0))
    assert (again, steps) == (0, 200)


@pytest.mark.parametrize("seed", [7, 191, 479])
def test_random_scenes_that_coarse_steps_got_wrong(seed):
    """A wave that the step puts into tune with the samples; twists that lag; waves whose phase is lost."""
    assert judge(seed, "implicit")[1] == "right"


@pytest.mark.parametrize("file", ["rm3_cable.txt", "lazy_wave.txt"])
def test_cables_that_snap_after_a_jerk_keep_their_peak(file):
    """Heave that starts at 2.5 m/s: the cable falls slack and snaps after a second."""
    times, w = 0.05 * np.arange(1, 31), 2.0 * np.pi / 10.0
    poses, twists = np.tile(HERE, (30, 1)), np.zeros((30, 6))
    poses[:, 2], twists[:, 2] = 4.0 * np.sin(w * times), 4.0 * w * np.cos(w * times)
    explicit = Mooring(SCENES / file, solver="explicit")
    truth, _, _ = run(Mooring(SCENES / file, solver="explicit", dt=explicit.step_limit.dt / 4.0), times, poses, twists)
    found, _, _ = run(Mooring(SCENES / file, solver="implicit"), times, poses, twists)
    assert found.max() == pytest.approx(truth.max(), rel=0.15)


def test_restored_runs_refine_their_steps_alike():
    """The rates that tensions change at are part of a snapshot."""
    times = 0.05 * np.arange(1, 41)
    poses, twists = surge_heave(times, 3.0, 3.0, 2.0)
    one, other = hanging(dt=0.05), hanging(dt=0.05)
    one.settle(HERE)
    one.run(times[:17], poses[:17], twists[:17])
    other.restore(one.snapshot())
    first, second = (m.run(times[17:], poses[17:], twists[17:]).fairlead_tension for m in (one, other))
    assert one.last_step["steps"] > 1
    assert (first == second).all()
