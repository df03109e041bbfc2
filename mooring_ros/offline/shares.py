"""What each effect costs of a step on this machine.

An evaluation of the forces is timed with all effects of the scene, and again with the arrays of one effect after the other emptied, as if the scene
did not have it; the differences add up to the whole. What every mooring has (tension, water, a flat bed, inertia) is timed pass by pass, and
what is left of the evaluation is shared in these proportions. The cost of a whole step, and how many evaluations it takes, come from a run.
"""

import time
from functools import partial

import numpy as np

from mooring_ros.core import costs
from mooring_ros.core.friction import NO_FRICTION
from mooring_ros.core.model import State
from mooring_ros.core.waves import refresh

from .mild import MildMotion

ROUNDS, ROUND = 5, 4e-3  # how often each is timed, and for about how long (s of CPU time)
RUN = 0.15  # s of CPU time that the run takes at least
REST = "time integration, guard and readings"
# passes that every mooring has, with the effects that share them
COMMON = {
    "tension": ("axial elasticity", "internal damping"),
    "water": ("weight", "buoyancy", "added mass", "drag"),
    "bed": ("bed contact",),
}
WAVES = ("waves on the lines",)
MOTION = "inertia of the nodes"


def cost_shares(mooring):
    """[{"effects": those that share a pass, "what": what it is where no effect has it, "share": of the CPU time of steps, 0..1}] of a settled Mooring.

    The shares add up to 1. The mooring is left as it was. Raises MooringError.
    """
    mooring = getattr(mooring, "_fullest", mooring)  # of one that is cut into several, one that is like the others
    saved = mooring.snapshot()
    try:
        whole, evaluations, steps = _of_a_run(mooring)  # s of CPU time, and numbers, for one simulated second
        state = State(*(array.copy() for array in mooring._state))
    finally:
        mooring.restore(saved)
    model = mooring._model
    found = _differences(model, state, mooring._scratch, steps / evaluations)
    seconds = {names: taken * evaluations for names, taken in found}
    if model.sea.frequency.size:
        seconds[WAVES] += _refresh(model, state, mooring._scratch) / model.sea.refresh
    total = max(whole, sum(seconds.values()))
    rows = [{"effects": list(names), "what": "", "share": taken / total} for names, taken in seconds.items()]
    rows[-1].update(effects=[], what=MOTION)
    return [*rows, {"effects": [], "what": REST, "share": 1.0 - sum(seconds.values()) / total}]


def _of_a_run(mooring):
    """(s of CPU time, evaluations, steps) for one simulated second of a mild surge."""
    motion, done, evaluations, steps, taken = MildMotion(mooring), 0, 0, 0, 0.0
    while taken < RUN and done < 20000:
        count = 10 if done == 0 else 50
        samples = motion.next(count)
        before = time.process_time()
        mooring.run(*samples)
        if done:  # the first ones compile, and fill the caches
            taken += time.process_time() - before
            evaluations += mooring.last_step["evaluations"] * count
            steps += mooring.last_step["steps"] * count
        done += count
    simulated = (done - 10) * motion.sample
    return taken / simulated, evaluations / simulated, steps / simulated


def _differences(model, state, scratch, flowing):
    """[(names, s for one evaluation)]: of effects that a scene may have, in the order of `_without`, then of the passes that all have.

    The water's stream is that of a step: `flowing` of the evaluations compute it.
    """
    surfaced = state.settings[2] != 0.0
    variants = list(_without(model, state, surfaced))
    settings = [((), model, state, surfaced), *variants]
    plain, still = settings[-1][1:3]
    kernels = {"tension": costs.repeat_tension, "water": costs.repeat_water, "bed": costs.repeat_bed, "inertia": costs.repeat_inertia}
    times = _fastest(
        [
            *(partial(costs.repeat_evaluation, without, stripped, scratch, above) for _, without, stripped, above in settings),
            *(partial(costs.repeat_streams, without, stripped) for _, without, stripped, _ in settings),
            *(partial(kernel, plain, still) for kernel in kernels.values()),
        ]
    )
    count = len(settings)
    nested = [whole - (1.0 - flowing) * streams for whole, streams in zip(times[:count], times[count:])]
    passes = dict(zip(kernels, times[2 * count :]))
    found = [(names, max(before - after, 0.0)) for (names, *_), before, after in zip(variants, nested, nested[1:])]
    scale = nested[-1] / sum(passes.values())
    found += [(names, passes[key] * scale) for key, names in COMMON.items()]
    return found + [((MOTION,), passes["inertia"] * scale)]


def _without(model, state, surfaced):
    """(effects, model, state, surfaced) as they would be without it and those before it, for every effect that is there."""
    none = np.zeros(0, dtype=np.int64)
    if state.swell.shape[1]:
        state = state._replace(swell=np.zeros((4, 0)), window=np.zeros((*state.window.shape[:2], 0)))
        yield WAVES, model, state, surfaced
    if model.sea.layer_bottom.size:
        model = model._replace(sea=model.sea._replace(layer_bottom=np.zeros(0)))
        yield ("current",), model, state, surfaced
    flat = model.ground.grid.x.size == 0 and model.ground.slope == (0.0, 0.0)
    if model.ground.law != NO_FRICTION:
        model = model._replace(ground=model.ground._replace(law=NO_FRICTION, on=not flat))
        yield ("bed friction",), model, state, surfaced
    if model.ground.on:
        model = model._replace(ground=model.ground._replace(on=False))
        yield ("bathymetry",), model, state, surfaced
    if surfaced:
        surfaced = False
        yield ("free surface",), model, state, surfaced
    if model.bending.stiffness.size:
        model = model._replace(bending=model.bending._replace(stiffness=np.zeros(0)))
        yield ("bending stiffness",), model, state, surfaced
    for name, first in (("viscoelastic ropes", "kelvin_first"), ("load-strain curves", "curve_first")):
        if getattr(model.ropes, first).size:
            model = model._replace(ropes=model.ropes._replace(**{first: none}))
            yield (name,), model, state, surfaced
    if model.rigid.mass.size or model.hulls.point.size or model.free_points.size:
        parts = model.rigid._replace(mass=np.zeros(0)), model.hulls._replace(point=none)
        model = model._replace(rigid=parts[0], hulls=parts[1], free_points=none)
        yield ("free points", "rods", "bodies", "line failures"), model, state, surfaced


def _fastest(calls):
    """Least CPU time (s) of one repetition of each call, rounds alternating; a call gets the number of repetitions."""
    counts = []
    for call in calls:
        call(1)  # compiled from here on
        count, took = 1, _timed(call, 1)
        while took < 0.2 * ROUND:
            count *= 4
            took = _timed(call, count)
        counts.append(max(1, round(count * ROUND / took)))
    return [min(times) for times in zip(*([_timed(call, count) / count for call, count in zip(calls, counts)] for _ in range(ROUNDS)))]


def _timed(call, count):
    before = time.process_time()
    call(count)
    return time.process_time() - before


def _refresh(model, state, scratch):
    """Time (s) that it takes to look ahead at the waves once more."""

    def ahead(count):
        for _ in range(count):
            now = state.window_times[1] if np.isfinite(state.window_times).all() else 0.0
            refresh(model.sea, now, now + model.sea.refresh, model.size, state.position, state.velocity, scratch.wave_work, state.window_times, state.window)

    return _fastest([ahead])[0]
