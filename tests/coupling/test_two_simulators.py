"""Two simulators, each with its own floater, one mooring node between them."""

import os
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

from mooring_ros import Mooring
from mooring_ros.coupling import Coupling

ROOT = Path(__file__).parents[2]
SCENE = ROOT / "config" / "scenes" / "oc4_pair.txt"
NAMES = ["body1", "body2"]
STEP, MOVES, END = 0.05, 6.0, 9.0  # s
PLACES = Mooring(SCENE, platforms=NAMES).pose_in_file


def motion(number, time):
    """Pose (7,) and twist (6,): at rest until MOVES, then in surge, each at a frequency of its own."""
    w, t = 0.5 + 0.2 * number, max(time - MOVES, 0.0)
    pose, twist = PLACES[number].copy(), np.zeros(6)
    pose[0] += 2.0 * (1.0 - np.cos(w * t))
    twist[0] = 2.0 * w * np.sin(w * t)
    return pose, twist


@pytest.fixture
def node(domain):
    command = [sys.executable, "-m", "mooring_ros.node", "--ros-args", "-p", f"scene:={SCENE}", "-p", "platforms:=[body1, body2]", "-p", "accuracy.enabled:=false"]
    process = subprocess.Popen(command, cwd=ROOT, env=os.environ.copy())
    yield process
    process.terminate()
    process.wait(20.0)


def test_two_simulators_in_lockstep_each_get_the_wrench_of_the_motion_of_both(node):
    """1e-6 of the mooring stepped by hand; nothing lost, doubled or late."""
    answers, counts = [{}, {}], [None, None]

    def simulate(number):
        with Coupling(step=STEP, scheme="held", timeout=400.0, patience=60.0, body=NAMES[number], name=f"simulator{number}") as mooring:
            mooring.begin(motion(number, 0.0)[0])
            while mooring.time < END:
                mooring.exchange(*motion(number, mooring.time + STEP))
                answers[number][round(mooring.time / STEP)] = mooring.wrench
            counts[number] = mooring.counts

    threads = [threading.Thread(target=simulate, args=(number,), daemon=True) for number in (0, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(450.0)
    assert all(own is not None and own.lost == own.doubled == own.late == 0 for own in counts)
    by_hand = Mooring(SCENE, platforms=NAMES)
    by_hand.settle(PLACES, time=MOVES)
    for k in range(round(MOVES / STEP) + 1, round(END / STEP) + 1):
        poses, twists = zip(*(motion(number, k * STEP) for number in (0, 1)))
        by_hand.step(k * STEP, poses, twists)
        for number in (0, 1):
            np.testing.assert_allclose(answers[number][k], by_hand.wrench[number], rtol=1e-6, atol=1e-6 * np.abs(by_hand.wrench[number]).max())


def test_the_scheme_that_needs_the_stiffness_is_refused_for_one_of_several():
    with pytest.raises(ValueError, match="for one platform, expected another one for body1"):
        Coupling(step=STEP, scheme="stiffness", body="body1")
