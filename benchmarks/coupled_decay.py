"""A floater let go on its moorings, coupled in lockstep over DDS with the real node, against both integrated as one system; schemes, steps and scales."""

import time

import matplotlib.pyplot as plt
import numpy as np

from mooring_ros.coupling import SCHEMES
from mooring_ros.mooring import Mooring

from . import decay_floater as floaters
from . import decay_runs as runs
from .decay_measure import coordinate, measure
from .decay_whole import Whole
from .tables import table

SCALE = 50.0
STEP = 0.01  # s, at the model's scale as at full scale: 100 Hz
STEPS = (0.01, 0.02, 0.04, 0.08, 0.16)  # s at the model's scale
GOAL_PERIOD, GOAL_DAMPING = 1e-3, 5e-4
GOAL_SCALE = 1e-9
ORDERS = {"held": 1.0, "extrapolated": 2.0, "stiffness": 2.0}
NAMES = {"held": "held", "extrapolated": "extrapolated", "stiffness": "with the stiffness"}


def static_wrench(scale=1.0):
    """(6,) of the moorings at home, at this scale."""
    mooring = Mooring(floaters.SCENE)
    mooring.settle(floaters.HOME)
    return mooring.wrench / np.repeat([scale**3, scale**4], 3)


def whole(name, halves=None):
    """Times (n,), poses, twists of a release at full scale, integrated as one system."""
    release = floaters.RELEASES[name]
    times = np.arange(0.0, floaters.duration(name, 1.0, halves), 0.05)
    return times, *Whole(floaters.floater(static_wrench()), Mooring(floaters.SCENE)).run(release.pose(), times)


def run(quick=False):
    """Prints the tables. quick: heave alone, fewer steps, no full scale."""
    chosen = ("heave",) if quick else tuple(floaters.RELEASES)
    references = {}
    for name in chosen:
        began = time.monotonic()
        references[name] = whole(name)
        print(f"{name}: one system, {references[name][0][-1]:.0f} s in {time.monotonic() - began:.0f} s", flush=True)
    result = {"tables": {}, "figures": {}, "failed": []}
    body = floaters.floater(static_wrench(SCALE), SCALE)
    with runs.mooring_node(SCALE):
        _decays(result, chosen, references, body)
        traces = _orders(result, chosen[0], references, body, STEPS[1:] if quick else STEPS)
        model = runs.decay(body, floaters.RELEASES["heave"], SCALE, STEP, floaters.duration("heave", SCALE))[1]
    _scale(result, model, quick)
    result["figures"]["coupled_decay.png"] = _figure(chosen[0], references, result["order"], traces)
    for content in result["tables"].values():
        print(content, flush=True)
    return result


def _decays(result, chosen, references, body):
    """Period and damping of each release by each scheme at 100 Hz."""
    rows, result["decays"] = [], {}
    for name in chosen:
        release = floaters.RELEASES[name]
        reference = measure(*references[name], release.axis, release.halves)
        for scheme in SCHEMES:
            found = runs.decay_of(body, release, SCALE, STEP, floaters.duration(name, SCALE), scheme=scheme)
            longer = found.period * np.sqrt(SCALE) / reference.period - 1.0
            more = found.damping - reference.damping
            result["decays"][f"{name} {scheme}"] = {"period": longer, "damping": more}
            first = scheme == next(iter(SCHEMES))
            cells = [f"{name}, {reference.period / np.sqrt(SCALE):.2f} s" if first else "", f"{100 * reference.damping:.3f} %" if first else ""]
            rows.append([*cells, NAMES[scheme], f"{100 * longer:+.5f} %", f"{100 * more:+.5f} %"])
            if ORDERS[scheme] > 1.0 and (abs(longer) > GOAL_PERIOD or abs(more) > GOAL_DAMPING):
                result["failed"].append(f"{name}, {scheme}: period {100 * longer:+.4f} %, damping {100 * more:+.4f} % of critical, goals 0.1 and 0.05")
    header = ["release, period at 1:50", "damping as one system", "coupling at 100 Hz", "period", "damping, of critical"]
    result["tables"]["coupled_decay"] = table(header, rows)


def _orders(result, name, references, body, steps):
    """How far the motion is off its reference, over the steps. Returns the coarsest held trace, for the figure."""
    release, (at, poses, _) = floaters.RELEASES[name], references[name]
    right = coordinate(poses, release.axis)
    rows, result["order"], trace = [], {"steps": list(steps), "release": name}, None
    for scheme in SCHEMES:
        errors = []
        for step in steps:
            times, coupled, _, _ = runs.decay(body, release, SCALE, step, floaters.duration(name, SCALE), scheme=scheme)
            size = SCALE if release.axis < 3 else 1.0
            motion = size * coordinate(coupled, release.axis)
            within = times * np.sqrt(SCALE) <= at[-1]
            errors.append(np.abs(motion[within] - np.interp(times[within] * np.sqrt(SCALE), at, right)).max() / release.size)
            trace = (times * np.sqrt(SCALE), motion) if scheme == "held" and step == steps[-1] else trace
        slope = np.polyfit(np.log(steps[-3:]), np.log(errors[-3:]), 1)[0]
        result["order"][scheme] = errors
        rows.append([NAMES[scheme], *(f"{100 * error:.4f} %" for error in errors), f"{slope:.2f}"])
        if abs(slope - ORDERS[scheme]) > 0.25:
            result["failed"].append(f"{scheme}: order {slope:.2f} in the coupling step, expected {ORDERS[scheme]:g}")
    header = [f"{name}, largest error over the release", *(f"{1e3 * step:g} ms" for step in steps), "order"]
    result["tables"]["coupled_order"] = table(header, rows)
    return trace


def _scale(result, model, quick):
    """The same decay at full scale, with steps of the same share of a period: equal after scaling. And at 100 Hz of full scale."""
    body, release = floaters.floater(static_wrench()), floaters.RELEASES["heave"]
    rows = []
    with runs.mooring_node(1.0):
        full = runs.decay(body, release, 1.0, STEP * np.sqrt(SCALE), floaters.duration("heave"))[1]
        several = min(len(full), len(model))
        apart = np.abs(full[:several, 2] - SCALE * model[:several, 2]).max() / release.size
        rows.append(["heave at 1:1 and 1:50, largest difference over the release", f"{apart:.1e}"])
        if apart > GOAL_SCALE:
            result["failed"].append(f"1:1 and 1:50 are {apart:.1e} apart after scaling, goal {GOAL_SCALE:g}")
        if not quick:
            reference = measure(*whole("heave"), release.axis, release.halves)
            longer, more = runs.decay_of(body, release, 1.0, STEP, floaters.duration("heave")).against(reference)
            rows.append(["heave at 1:1, 100 Hz, extrapolated: period", f"{100 * longer:+.5f} %"])
            rows.append(["damping, of critical", f"{100 * more:+.5f} %"])
    result["scale"] = apart
    result["tables"]["coupled_scale"] = table(["", ""], rows)


def _figure(name, references, order, trace):
    """The decay, and the errors over the step."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 3.6), layout="constrained")
    times, poses, _ = references[name]
    release = floaters.RELEASES[name]
    left.plot(times, coordinate(poses, release.axis), "k", lw=1.5, label="one system")
    left.plot(*trace, "C3--", lw=1.0, label=f"wrench held, {1e3 * order['steps'][-1]:g} ms at 1:50")
    left.set(xlabel="time, full scale (s)", ylabel=f"{name} ({'m' if release.axis < 3 else 'rad'})")
    left.legend()
    for scheme, mark in zip(SCHEMES, "os^"):
        right.loglog([1e3 * step for step in order["steps"]], order[scheme], mark + "-", label=NAMES[scheme])
    right.set(xlabel="coupling step at 1:50 (ms)", ylabel="largest error / release")
    right.grid(True, which="both", alpha=0.3)
    right.legend()
    return figure
