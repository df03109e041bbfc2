"""How a random scene ended: beside the same run with half the step, and, where the two differ, beside much finer ones.

What is stated of default settings in any motion, jumps and snapping lines among them: mean tensions within `STATED` of their deviation, peaks within
`PEAK`, and every sample within what the tension is from the sample before to the one after it, as rms within `STATED` of the deviation.
"""

from typing import NamedTuple

import numpy as np

from mooring_ros import Mooring, MooringError
from mooring_ros.scene import SceneError

from .judge import NOT_A_NUMBER, REFUSED, RIGHT, WRONG, Track, action_and_reaction, claim, finite, from_claims
from .motions import Samples
from .random_scenes import random_case
from .scenes import G

STATED = 0.1  # of the deviation
PEAK = 0.15  # of the largest tension: a line that snaps does so within less than a sample
LEVEL = 0.05  # of the largest tension: counts as the deviation where there is less, so that half a percent of the tension is always allowed
PARTING = 2.0  # times what is stated where lines part: they do at the end of a step, and a sample falls before or after
FINER = (2.0, 8.0, 16.0)  # times smaller steps: the next ones where one says something else
PROBE, NUDGE = 12.0, 1e-6  # another fine step, and a shift of the whole motion (of the depth): where these change the force, chance decides it
AGREED = 0.5  # of what is stated: finest runs that differ by more say no truth to hold others to
BOUND = 1.5  # of the finest runs' peaks, where even those differ: no more than chance may make of it
CHAOTIC = "chaotic"  # finer and finer steps come to different forces: held to bounds


class Ending(NamedTuple):
    """How a seed's scene ended; uneven: share of the samples to which tensions jumped in the finest steps (`Mooring.last_step`)."""

    layout: str
    outcome: str
    words: str
    uneven: float = 0.0


def judge(seed, solver="auto", settings=None):
    """The Ending of a seed."""
    layout, scene, motion = random_case(seed)
    try:
        mooring = Mooring(scene, solver=solver, **(settings or {}))
        mooring.settle(motion.start)
        start = mooring.snapshot()
        step = mooring.step_limit.dt
        history = mooring.run(motion.times, motion.poses, motion.twists)
    except (SceneError, MooringError) as refusal:
        return Ending(layout, REFUSED, str(refusal))
    if not finite(history):
        return Ending(layout, NOT_A_NUMBER, "a reading is not a finite number, or a line pushes")
    verdict = from_claims(action_and_reaction(mooring, history))
    if verdict.outcome != RIGHT:
        return Ending(layout, verdict.outcome, verdict.words)
    return Ending(layout, *_beside_finer(scene, motion, history, step, start, mooring.solver), float(np.mean(history.uneven > 0)))


def _beside_finer(scene, motion, history, step, start, solver):
    track = _staying(scene, history)
    floor = 1e-3 * max(line.type.mass * line.length for line in scene.lines) * G
    stated = STATED * (PARTING if scene.failures else 1.0)

    def beside(one, other, share=1.0):
        return from_claims(alike(one.fairlead, other.fairlead, share * stated, floor))

    runs = []
    for finer in FINER:
        runs.append(_run(scene, motion, step / finer, start, solver))
        if runs[-1] is None:
            return WRONG, f"was refused with a step {finer:g} times finer"
        verdict = beside(track, runs[-1])
        if verdict.outcome == RIGHT:
            return RIGHT, verdict.words
    shift = np.array([NUDGE, NUDGE, -NUDGE, 0.0, 0.0, 0.0, 0.0]) * scene.environment.depth
    nudged = Samples(motion.start, motion.times, motion.poses + shift, motion.twists)
    fine = [*runs[1:], _run(scene, motion, step / PROBE, start, solver), _run(scene, nudged, step / FINER[-1], start, solver)]
    fine = [run for run in fine if run is not None]
    if all(beside(one, fine[1], AGREED).outcome == RIGHT for one in fine):
        return WRONG, verdict.words
    peak = np.max([run.fairlead.max(axis=0) for run in fine], axis=0) + floor
    over = (track.fairlead.max(axis=0) / peak).max()
    return (CHAOTIC if over <= BOUND else WRONG), f"{verdict.words}; peak {over:.2f} times that of the finest runs, which differ among themselves"


def alike(tension, truth, stated, floor):
    """Claims on tensions (k, lines) beside finer ones: means, peaks, and how far they leave the band of three samples."""
    padded = np.pad(truth, ((1, 1), (0, 0)), mode="edge")
    band = np.stack([padded[:-2], padded[1:-1], padded[2:]])
    outside = np.maximum(tension - band.max(axis=0), 0.0) + np.maximum(band.min(axis=0) - tension, 0.0)
    claims = []
    for line in range(truth.shape[1]):
        highest = truth[:, line].max()
        scale = max(truth[:, line].std(), LEVEL * highest, floor)
        rms = np.sqrt(np.mean(outside[:, line] ** 2))
        claims.append(claim(f"rms of line {line + 1} outside the band over its deviation", rms / scale, 0.0, stated, 1.0))
        claims.append(claim(f"mean of line {line + 1}", tension[:, line].mean(), truth[:, line].mean(), stated, scale))
        claims.append(claim(f"peak of line {line + 1}", tension[:, line].max(), highest, PEAK / STATED * stated, max(highest, floor / LEVEL)))
    return claims


def _staying(scene, history):
    """Tensions of the lines that no failure names: what parts is the scene's business, and when to within a step."""
    parting = {line for failure in scene.failures for line in failure.lines}
    stays = [k for k, line in enumerate(scene.lines) if line.id not in parting] or [0]
    return Track(history.time, history.fairlead_tension[:, stays])


def _run(scene, motion, dt, start, solver):
    """Track of the same with another step, from the same state; None where it is refused."""
    mooring = Mooring(scene, dt=dt, solver=solver)
    mooring.restore(start)
    try:
        return _staying(scene, mooring.run(motion.times, motion.poses, motion.twists))
    except MooringError:
        return None
