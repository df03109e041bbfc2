"""One run of one code on one of the twelve cases: forces on the platform, tensions, cost. The peers' runs are kept (`peer_cache`)."""

import time
from dataclasses import dataclass

import numpy as np

from mooring_ros.errors import MooringError
from mooring_ros.mooring import Mooring
from mooring_ros.scene.description import FREE

from . import moordyn_peer, peer_cache
from .errors import dynamic_difference
from .moordyn_deck import DeckError, files
from .moordyn_history import transit_time
from .ours import at_rest, samples
from .peer_cases import fairleads

SAMPLE = 0.05  # s, between what is compared of the peers; finer where the motion is quick


@dataclass(frozen=True)
class Outcome:
    """What a run gave; without times where it failed."""

    times: np.ndarray  # (samples,) s
    force: np.ndarray  # (samples, fairleads) N: size of the end force on the platform
    tension: np.ndarray  # (samples, fairleads) N: of the end segments; CableDyn: none
    cost: float  # CPU s for a simulated s, without initialisation
    failure: str = ""


FAILED = np.zeros(0)


def failed(reason):
    """The outcome of a run that failed."""
    return Outcome(FAILED, FAILED, FAILED, np.inf, str(reason))


def interval(motion):
    """Time (s) between the samples that are compared: at least some 100 in a period."""
    return min(SAMPLE, getattr(motion, "period", 10.0) / 100.0)


def initial(scene):
    """Options with which MoorDyn finds its initial state: its own is none where lines meet in free points or rods."""
    if not scene.rods and all(p.kind != FREE for p in scene.points):
        return ()
    short = any(n.type.bending_stiffness > 0.0 for n in scene.lines)  # cables: soon at rest, and slow to compute
    return ("1 ICgenDynamic", "30.0 TmaxIC") if short else ("1 ICgenDynamic",)


def of_moordyn(case, scheme, dt, refinement=1, fresh=False, steps_per_call=1):
    """MoorDyn with its internal step dt (s), called at every step, or at every so many, with the chord of the motion."""
    import moordyn

    scene, motion = case.scene(refinement), case.platform()
    ends = fairleads(scene)

    def forces(lines):
        return [float(np.linalg.norm(moordyn.GetLineNodeForce(lines[k], moordyn.GetLineN(lines[k]) if b else 0))) for k, b in ends] + [
            float(np.linalg.norm(moordyn.GetLineNodeTen(lines[k], moordyn.GetLineN(lines[k]) if b else 0))) for k, b in ends
        ]

    options = initial(scene)

    def make():
        try:
            run = moordyn_peer.run(scene, motion, dt, scheme, steps_per_call=steps_per_call, sample=interval(motion), options=options, probe=forces)
        except moordyn_peer.PeerError as error:
            return {"failure": np.array(str(error))}
        return {"times": run.times, "probed": run.probed, "cpu": run.cpu, "simulated": run.simulated}

    try:
        deck = moordyn_peer.deck(scene, dt, scheme)
    except DeckError as error:
        return failed(error)
    key = peer_cache.text_of(deck, motion, ends, interval(motion), "forces", *files(scene).values(), *options[1:])
    found = make() if fresh or steps_per_call > 1 else peer_cache.kept("moordyn", key, make)
    if "failure" in found:
        return failed(found["failure"])
    probed = found["probed"]
    return Outcome(found["times"], probed[:, : len(ends)], probed[:, len(ends) :], float(found["cpu"]) / float(found["simulated"]))


def of_cabledyn(case, dt, refinement=1, options=(), fresh=False):
    """CableDyn with its step dt (s)."""
    from . import cabledyn_cost, cabledyn_peer

    scene, motion = case.scene(refinement), case.platform()

    def make():
        try:
            run = cabledyn_cost.run(scene, motion, dt, options=options)
        except cabledyn_peer.PeerError as error:
            return {"failure": np.array(str(error))}
        return {"times": run.times[1:], "force": run.force[1:], "cost": run.cost}

    try:
        key = peer_cache.text_of(cabledyn_peer.deck(scene, cabledyn_peer.chains(scene), dt, motion.end, friction=cabledyn_cost.friction(scene), options=options), motion, "forces", *files(scene).values())
    except cabledyn_peer.PeerError as error:
        return failed(error)
    found = make() if fresh else peer_cache.kept("cabledyn", key, make)
    if "failure" in found:
        return failed(found["failure"])
    return Outcome(found["times"], found["force"], FAILED, float(found["cost"]))


def of_ours(case, solver="auto", dt=None, rate=20.0, refinement=1, call="run"):
    """Ours, with samples of the motion at ``rate`` (Hz), all in one ``run`` or by ``step``."""
    scene, motion = case.scene(refinement), case.platform()
    ends = [k for k, _ in fairleads(scene)]
    times, poses, twists = samples(motion, rate)
    try:
        mooring = Mooring(scene, solver=solver, dt=dt)
        mooring.settle(at_rest(motion))
        saved = mooring.snapshot()
        mooring.run(times[:1], poses[:1], twists[:1])  # compiles
        mooring.restore(saved)
        if call == "run":
            began = time.process_time()
            history = mooring.run(times, poses, twists)
            cpu = time.process_time() - began
            force, tension = np.array(history.fairlead_end_force)[:, ends], np.array(history.fairlead_tension)[:, ends]
        else:
            force, tension = np.empty((len(times), len(ends), 3)), np.empty((len(times), len(ends)))
            began = time.process_time()
            for k, (t, pose, twist) in enumerate(zip(times, poses, twists, strict=True)):
                mooring.step(t, pose, twist)
                force[k], tension[k] = mooring.fairlead_end_force[ends], mooring.fairlead_tension[ends]
            cpu = time.process_time() - began
    except (MooringError, ValueError) as error:
        return failed(error)
    return Outcome(times, np.linalg.norm(force, axis=2), tension, cpu / float(times[-1]))


def error(outcome, reference, motion, what="force"):
    """Largest over the fairleads of the rms difference after the ramp over the reference's standard deviation; inf of a run that failed."""
    if outcome.failure:
        return np.inf
    mine, theirs = getattr(outcome, what), getattr(reference, what)
    if not len(mine):
        return np.inf
    value = float(dynamic_difference(outcome.times, mine, reference.times, theirs, motion.start).max())
    return value if np.isfinite(value) else np.inf


def transit(case, refinement=1):
    """Time (s) in which an axial wave runs through the segment that it crosses soonest."""
    return float(transit_time(case.scene(refinement)))
