"""The largest stable step of a scene, and what limits it.

Axial modes: every segment with half of its mass at each end bounds the frequencies of the assembled lines from above (Irons), whatever
hangs on them: w = (2/l) sqrt(EA/m), with m the dry mass (water only adds to it). Bending, bed contact and drag have limits of their own;
contact and drag are kept from limiting by the relief and the drag time (seabed.py, water.py), so they are listed, not applied.
"""

from dataclasses import dataclass

import numpy as np

from .schemes import LEAPFROG, SAFETY, STAGES, stable_step

REFERENCE_SPEED = 2.0  # m/s, at which the drag's own limit is stated


@dataclass(frozen=True)
class StepLimit:
    """What an explicit step may be.

    dt: largest step taken (s); limited_by: which line and effect, or "dt"; scheme: evaluations a step; limits: for each effect the step (s)
    at which a plain leapfrog would lose stability through it, the smallest over the scene; axial: stable step for each scheme (s).
    """

    dt: float
    limited_by: str
    scheme: int
    limits: dict
    axial: dict


def step_limit(scene, model, dt=None):
    """StepLimit of `scene` built as `model`; `dt` (s) caps the step."""
    axial = dict.fromkeys((LEAPFROG, *STAGES), np.inf)
    limits = {"axial": np.inf, "drag at 2 m/s": np.inf, "bed stiffness": np.inf, "bed damping": np.inf}
    worst = ""
    for k, line in enumerate(scene.lines):
        first, count = model.first_node[k], model.segments[k]
        segment = first + 1
        mass = line.type.mass * model.length[segment]
        omega = 2.0 * np.sqrt(model.stiffness[segment] * model.inverse_length[segment] / mass)
        zeta = 0.5 * omega * model.damping[segment] * model.length[segment] / model.stiffness[segment]
        for scheme in axial:
            axial[scheme] = min(axial[scheme], stable_step(scheme, omega, zeta))
        if 2.0 / omega < limits["axial"]:
            limits["axial"] = 2.0 / omega
            worst = f"axial waves in {line.name}"
        nodes = slice(first, first + count + 1)
        with np.errstate(divide="ignore"):
            masses = model.mass[nodes]
            limits["bed stiffness"] = min(limits["bed stiffness"], np.min(2.0 / np.sqrt(model.bed_stiffness[nodes] / masses)))
            limits["bed damping"] = min(limits["bed damping"], np.min(2.0 * masses / model.bed_damping[nodes]))
            drag = np.maximum(model.drag_normal[nodes], model.drag_axial[nodes])
            wet_mass = masses + model.added_normal[nodes]
            limits["drag at 2 m/s"] = min(limits["drag at 2 m/s"], np.min(wet_mass / (drag * REFERENCE_SPEED)))
    cheapest = max(axial, key=lambda scheme: axial[scheme] / scheme)
    family = {LEAPFROG: axial[LEAPFROG]} if cheapest == LEAPFROG else {s: axial[s] for s in STAGES}
    largest = max(SAFETY * step for step in family.values())
    if dt is not None and dt < largest:
        return StepLimit(dt, "dt", cheapest, limits, family)
    return StepLimit(largest, worst, cheapest, limits, family)
