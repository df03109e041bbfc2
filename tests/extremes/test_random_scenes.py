"""Random scenes and motions, by the dozen; ten thousand more with `./run bench extremes`."""

import numpy as np
import pytest

from benchmarks.extremes import random_judge, random_scenes
from benchmarks.extremes.judge import NOT_A_NUMBER, REFUSED, RIGHT, WRONG
from mooring_ros import Mooring
from scenes_in_code import HERE, SCENES, surge_heave

SEEDS = range(100)
AS_LONG = 10  # seeds in a test


@pytest.mark.parametrize("first", SEEDS[::AS_LONG])
def test_random_scenes_end_right_or_in_a_refusal_that_says_why(first):
    """Ten seeds each. Chaotic: finer and finer steps come to different forces; then peaks are bounded."""
    ended = {seed: random_judge.judge(seed) for seed in range(first, first + AS_LONG)}
    wrong = {seed: ending.words for seed, ending in ended.items() if ending.outcome in (WRONG, NOT_A_NUMBER)}
    assert not wrong
    for ending in ended.values():
        assert ending.outcome != REFUSED or ";" in ending.words or "expected" in ending.words, ending.words


def test_a_run_whose_lines_snap_tells_so_and_a_smooth_one_does_not():
    """Two lines of seed 238 snap for four seconds: no two fine steps agree on single peaks."""
    _, scene, motion = random_scenes.random_case(238)
    snapping = Mooring(scene)
    snapping.settle(motion.start)
    told = snapping.run(motion.times, motion.poses, motion.twists).uneven
    assert np.mean(told > 0) > 0.5
    assert snapping.last_step["uneven"] == told[-1]
    smooth = Mooring(SCENES / "oc4.txt")
    smooth.settle(HERE)
    times = np.arange(1, 81) * 0.1
    assert not smooth.run(times, *surge_heave(times)).uneven.any()


def test_the_same_seed_makes_the_same_scene():
    for seed in (3, 14):
        one, other = random_scenes.random_case(seed), random_scenes.random_case(seed)
        assert one[:2] == other[:2]
        np.testing.assert_array_equal(one[2].poses, other[2].poses)


def test_a_tension_that_leaves_the_band_is_seen():
    """The judge itself: late by a sample is in the band; ten percent too high in the mean, or a spike of its own, is not."""
    t = np.linspace(0.0, 10.0, 401)
    truth = (1e5 + 2e4 * np.sin(3.0 * t))[:, None]

    def outcome(tension):
        return random_judge.from_claims(random_judge.alike(tension, truth, random_judge.STATED, 1.0)).outcome

    assert outcome(np.roll(truth, 1, axis=0)) == RIGHT
    assert outcome(truth + 3e3) == WRONG
    spike = truth.copy()
    spike[200] *= 1.5
    assert outcome(spike) == WRONG
