"""What must hold for a run: claims of a case, and what holds for every run whatever the scene."""

import re
from dataclasses import dataclass

import numpy as np

from mooring_ros import Mooring, MooringError
from mooring_ros.scene import SceneError

RIGHT, REFUSED, WRONG, NOT_A_NUMBER = "right", "refused", "wrong", "NaN"
FINER = 4.0  # times smaller steps of the run that stands for the truth, unless a case asks for more


@dataclass(frozen=True)
class Claim:
    """One figure beside what it must be; `scale`: what the error is a share of."""

    what: str
    got: float
    want: float
    allowed: float  # of the scale
    scale: float

    @property
    def error(self):
        return abs(self.got - self.want) / self.scale if self.got != self.want else 0.0


@dataclass(frozen=True)
class Track:
    """Tensions of the end segments of a run, ours or a peer's."""

    times: np.ndarray  # (k,) s
    fairlead: np.ndarray  # (k, lines) N
    anchor: np.ndarray | None = None  # (k, lines) N; not every peer says
    solver: str = "auto"  # of ours; what a peer does is held against ours as it comes


@dataclass(frozen=True)
class Verdict:
    """How a run ended: right, refused, wrong or NaN; the worst claim, or the words of the refusal."""

    outcome: str
    words: str
    claims: tuple = ()


def claim(what, got, want, allowed, scale=None):
    """Claim that a number is another one within `allowed` of the scale (of itself unless given)."""
    return Claim(what, float(got), float(want), float(allowed), max(float(abs(want) if scale is None else scale), 1e-300))


def same_history(track, truth, allowed, peak=None, floor=0.0, level=1e-3):
    """Claims that all tensions follow those of another run: rms over their deviation (at least `level` of the largest, and `floor` N), and the
    largest with `peak`."""
    claims = []
    for line in range(track.fairlead.shape[1]):
        theirs = truth.fairlead[:, line]
        mine = np.interp(truth.times, track.times, track.fairlead[:, line])
        scale = max(theirs.std(), level * theirs.max(), floor)
        rms = np.sqrt(np.mean((mine - theirs) ** 2))
        claims.append(claim(f"rms difference of line {line + 1} over its deviation", rms / scale, 0.0, allowed, 1.0))
        if peak is not None:
            claims.append(claim(f"peak of line {line + 1}", mine.max(), theirs.max(), peak, max(theirs.max(), floor)))
    return claims


def from_claims(claims):
    """right, or wrong with the claim that is farthest off; a run that says no number is NaN."""
    worst = max(claims, key=lambda c: c.error / c.allowed if np.isfinite(c.error) else np.inf)
    if not np.isfinite(worst.got):
        return Verdict(NOT_A_NUMBER, worst.what, tuple(claims))
    words = f"{worst.what}: {worst.got:.4g}, must be {worst.want:.4g} within {worst.allowed * worst.scale:.2g}"
    return Verdict(RIGHT if worst.error <= worst.allowed else WRONG, words, tuple(claims))


def track_of(history, anchors=True, solver="auto"):
    return Track(history.time, history.fairlead_tension, history.anchor_tension if anchors else None, solver)


def finite(history):
    """Whether every reading of every sample is a finite number, and no line pushes."""
    arrays = [getattr(history, name) for name in history.__dataclass_fields__]
    return all(np.isfinite(array).all() for array in arrays) and (history.fairlead_tension >= 0.0).all() and (history.anchor_tension >= 0.0).all()


def action_and_reaction(mooring, history):
    """Claims that the wrench is the sum of what the coupled parts hand over, and of the lines' end forces where lines end at coupled points alone."""
    scene = mooring.scene
    handed_over = history.coupled_wrenches[:, :, :3]
    scale = np.abs(history.wrench[:, :3]).max() + np.abs(history.fairlead_end_force).max() + np.abs(handed_over).max(initial=0.0)
    missed = history.wrench[:, :3] - handed_over.sum(axis=1)
    claims = [claim("wrench less the sum of the coupled parts' forces", np.abs(missed).max(), 0.0, 1e-9, scale or 1.0)]
    coupled = {p.id for p in scene.points if p.kind == "coupled"}
    ends = [(line.end_a in coupled, line.end_b in coupled) for line in scene.lines]
    if not scene.rods and not scene.bodies and not any(a and b for a, b in ends) and not scene.failures:
        held = [k for k, (a, b) in enumerate(ends) if a or b]
        missed = history.wrench[:, :3] - history.fairlead_end_force[:, held].sum(axis=1)
        claims.append(claim("wrench less the sum of the end forces", np.abs(missed).max(), 0.0, 1e-9, scale or 1.0))
    return claims


def ours(scene, motion, prepare=None, time=0.0, **settings):
    """(Mooring, History) of a run from rest; `prepare(mooring)` after it has settled. Raises SceneError or MooringError where it is refused."""
    mooring = Mooring(scene, **settings)
    mooring.settle(motion.start, time)
    if prepare is not None:
        prepare(mooring)
    return mooring, mooring.run(motion.times + time, motion.poses, motion.twists)


def finer_step(scene, finer=FINER):
    """Step (s) of the run that stands for the truth: so many times finer than the largest that is stable."""
    return Mooring(scene).step_limit.dt / finer


def judge(case, solver="auto"):
    """Verdict on our run of a case."""
    scene = case.scene()
    motion = case.motion()
    settings = dict(case.settings(scene) if callable(case.settings) else case.settings)
    try:
        mooring, history = ours(scene, motion, case.prepare, case.time, solver=solver, **settings)
    except (SceneError, MooringError) as refusal:
        words = str(refusal)
        expected = case.refused and re.search(case.refused, words)
        return Verdict(REFUSED if expected else WRONG, words)
    if not finite(history):
        return Verdict(NOT_A_NUMBER, "a reading is not a finite number, or a line pushes")
    if case.refused and case.claims is None:
        return Verdict(WRONG, f"was not refused with {case.refused!r}")
    return from_claims([*action_and_reaction(mooring, history), *case.claims(scene, motion, track_of(history, solver=solver))])
