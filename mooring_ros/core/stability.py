"""The largest stable step of a scene, and what limits it.

Axial modes: every segment with half of its mass at each end bounds the frequencies of the assembled lines from above (Irons), whatever
hangs on them: w = (2/l) sqrt(EA/m), with m the dry mass (water only adds to it). Bending, bed contact and drag have limits of their own;
contact and drag are kept from limiting (seabed.py, water.py), so they are listed, not applied. Steps of many stages are also capped where
the first axial mode of a line, pi c / L, would no longer be followed to about 1 % of the dynamic tension, and those of the scheme `AXIAL`,
which axial waves do not limit, by the pace of the lines.
"""

import math
from dataclasses import dataclass

import numpy as np

from ..scene.grouping import group_of_each
from .friction import NO_FRICTION, STICK
from .hinges import stiffness_rows
from .layout import POINT_COUPLED, POINT_FIXED
from .model import LOOSE, MOST_JOINTS
from .ropes import rope_limits
from .schemes import AXIAL, AXIAL_COST, LEAPFROG, SAFETY, SSP, stable_step

REFERENCE_SPEED = 2.0  # m/s, at which the drag's own limit is stated
UNDAMPED = 0.15  # rad: undamped modes grow by 0.012 of its fourth power in a step of the schemes of several stages: 1e-5
LANDING, DEARER = 5.0, 1.7  # of the bed's damping time: steps in which nodes land softly; times the cost of the schemes of several stages that `AXIAL` may have then
LONGEST = 4.0  # times the step that is right for accuracy: the longest of the scheme `AXIAL` that is taken when it is asked for
PACE, PASSING = 0.004, 0.11  # of sqrt(L/g) and of L/c, for the scheme `AXIAL`: 0.2 % of the dynamic tension on the OC4 chains
STICKING = 0.5  # of the stable step, with the law `stick`: longer ones kick stiff lines that are held at their touchdown
ACCURACY = 0.66  # of count / w = L / (2 c): 0.3 % of the dynamic tension on the OC4 chains (docs/measurements.md)


@dataclass(frozen=True)
class StepLimit:
    """What an explicit step may be.

    dt: largest step taken (s); limited_by: what limits it, in words; limits: for each effect the step (s) at which a plain leapfrog would
    lose stability or accuracy through it, the smallest over the scene; axial: stable step (s) of each scheme that may be used, by its
    number of evaluations.
    """

    dt: float
    limited_by: str
    limits: dict
    axial: dict


def step_limit(scene, model, end_point, dt=None):
    """StepLimit of `scene` built as `model`; `dt` (s) caps the step."""
    axial = dict.fromkeys((LEAPFROG, *SSP), np.inf)
    slowest = np.inf
    limits = dict.fromkeys(("axial", "bending", "drag at 2 m/s", "bed stiffness", "bed damping", "axial accuracy"), np.inf)
    worst, bends = "", bending_frequencies(model, end_point)
    for k, line in enumerate(scene.lines):
        first, count = model.first_node[k], model.segments[k]
        length = float(model.length[first + 1])
        stiffness, damping = rope_limits(line.type, length)
        omega = 2.0 / length * math.sqrt(stiffness / line.type.mass)
        zeta = 0.5 * omega * damping / stiffness
        bend = float(bends[k])
        both = math.hypot(omega, bend)
        for scheme in axial:
            step = stable_step(scheme, both, zeta)
            if scheme != LEAPFROG and bend > 0.0:  # bending has no internal damping: its modes lie next to the imaginary axis
                step = min(step, UNDAMPED / bend)
            axial[scheme] = min(axial[scheme], step)
        if 2.0 / both < slowest:
            slowest, worst = 2.0 / both, line.name
        limits["axial"] = min(limits["axial"], 2.0 / omega)
        if bend > 0.0:
            limits["bending"] = min(limits["bending"], 2.0 / bend)
        limits["axial accuracy"] = min(limits["axial accuracy"], ACCURACY * int(count) / omega)
        for name, step in _node_limits(model, slice(first, first + count + 1)):
            limits[name] = min(limits[name], step)
    undamped = nothing_damps(scene)
    best_ssp = max(axial[s] / s for s in SSP)
    accuracy, by = limits["axial accuracy"], "accuracy of the first axial mode"
    stages = max(min(SAFETY * axial[s], accuracy) / s for s in SSP)  # s an evaluation
    pace, by_pace = np.inf, by
    if axial_waves_stand_alone(model):
        limits["pace of the lines"], limits["passing of an axial wave"] = paces(scene, model, end_point)
        pace, by_pace = min((limits[name], name) for name in ("pace of the lines", "passing of an axial wave"))
        if undamped or scene.environment.gravity == 0.0:
            pace, by_pace = 0.0, f"axial waves in {worst}, which nothing damps"
        landing = min(pace, SAFETY * limits["bending"], LANDING * limits["bed damping"])
    if pace < np.inf and (pace == 0.0 or DEARER * landing > AXIAL_COST * stages):
        usable = {AXIAL: limits["bending"], LEAPFROG: axial[LEAPFROG]}
        accuracy, by = pace, by_pace
    elif undamped or axial[LEAPFROG] >= best_ssp:
        usable = {LEAPFROG: axial[LEAPFROG]}
    else:
        usable = {s: axial[s] for s in SSP}
    stable = SAFETY * max(usable.values())
    few = LEAPFROG in usable and not undamped  # steps of a few segments may be stable and yet not follow their first mode
    accurate = accuracy if few and accuracy > 0.0 else max(accuracy, SAFETY * min(usable.values()))
    longest = min(stable, LONGEST * accurate if AXIAL in usable else accurate)
    if model.ground.law == STICK and STICKING * stable < accurate:
        accurate, by = STICKING * stable, "bed friction that sticks"
    if dt is not None and dt < longest:
        return StepLimit(float(dt), "dt", limits, usable)
    if dt is not None:
        accurate = longest
    if accurate < stable:
        return StepLimit(accurate, by, limits, usable)
    what = "bending" if limits["bending"] < limits["axial"] else "axial"
    return StepLimit(stable, f"stability of {what} waves in {worst}", limits, usable)


def nothing_damps(scene):
    """Whether there are lines whose transverse waves no drag takes away."""
    return scene.environment.water_density == 0.0 or any(line.type.drag_normal == 0.0 for line in scene.lines)


def axial_waves_stand_alone(model):
    """Whether the axial forces of the lines move nothing but their nodes and free points, and are those of EA and BA: what the scheme `AXIAL` needs.

    Friction answers to what pulls on a node within the step, and is not part of the solve.
    """
    many = model.free_points.size > MOST_JOINTS
    joined_on_ground = model.ground.on and model.free_points.size > 0
    other_laws = model.ropes.curve_first.size + model.ropes.kelvin_first.size > 0
    return not (model.ground.law != NO_FRICTION or joined_on_ground or many or model.rigid.mass.size > 0 or other_laws)


def paces(scene, model, end_point):
    """Steps (s) of the scheme `AXIAL` that follow the lines: PACE sqrt(L/g), and PASSING of the time in which an axial wave passes through them.

    The least of the groups of lines that are joined; L is the length of the longest of a group, the time the sum over its lines.
    """
    owner, links = {}, []
    for k in range(len(scene.lines)):
        for p in end_point[2 * k : 2 * k + 2]:
            if p != LOOSE and model.point_kind[p] not in (POINT_FIXED, POINT_COUPLED):
                holder = ("part", int(model.rigid.part[p])) if model.rigid.part[p] >= 0 else ("point", int(p))
                links.append((k, owner.setdefault(holder, k)))
    longest, passing, gravity = {}, {}, scene.environment.gravity
    for line, g in zip(scene.lines, group_of_each(len(scene.lines), links)):
        longest[g] = max(longest.get(g, 0.0), line.length)
        passing[g] = passing.get(g, 0.0) + line.length * math.sqrt(line.type.mass / line.type.stiffness)
    pace = PACE * math.sqrt(min(longest.values()) / gravity) if gravity > 0.0 else math.inf
    return pace, PASSING * min(passing.values())


def bending_frequencies(model, end_point):
    """(lines,) rad/s that the bending modes of each line do not pass: row sums over masses, clamps on parts with the parts' inertia."""
    bending, rigid = model.bending, model.rigid
    if not bending.stiffness.size:
        return np.zeros(model.first_node.size)
    rows, mass = stiffness_rows(bending, model.length), model.mass.copy()
    for quantity in (rows, mass):  # what ends at the same point moves with it
        at = np.zeros(model.point_node.size)
        held = end_point != LOOSE
        np.add.at(at, end_point[held], quantity[model.end_node[held]])
        at += quantity[model.point_node] if quantity is mass else 0.0
        quantity[model.end_node[held]] = at[end_point[held]]
    square = rows / np.maximum(mass, 1e-300)
    for c, b in enumerate(model.clamps.part):
        if b >= 0:
            axis = model.clamps.axis[c]
            across = np.linalg.svd(axis[None, :])[2][1:]
            slowness = np.linalg.inv(rigid.inertia[b] + 1e-12 * np.trace(rigid.inertia[b]) * np.eye(3))
            turning = bending.clamp_stiffness[c] * np.linalg.eigvalsh(across @ slowness @ across.T).max()
            segment = bending.clamp_segment[c]
            square[segment - 1 : segment + 1] += turning
    prescribed = (end_point != LOOSE) & np.isin(model.point_kind[end_point], (POINT_FIXED, POINT_COUPLED))
    square[model.end_node[prescribed]] = 0.0
    return np.array([math.sqrt(square[first : first + count + 1].max()) for first, count in zip(model.first_node, model.segments)])


def _node_limits(model, nodes):
    """(effect, step in s) of the stages that act on single nodes."""
    mass = model.mass[nodes]
    drag = np.maximum(model.drag_normal[nodes], model.drag_axial[nodes])
    with np.errstate(divide="ignore"):
        yield "bed stiffness", float(np.min(2.0 / np.sqrt(model.bed_stiffness[nodes] / mass)))
        yield "bed damping", float(np.min(2.0 * mass / model.bed_damping[nodes]))
        yield "drag at 2 m/s", float(np.min((mass + model.added_normal[nodes]) / (drag * REFERENCE_SPEED)))
