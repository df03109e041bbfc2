"""What a delay of the wrench does to the damping of a floater on its moorings at 1:50, and what prediction in the node gives back."""

import matplotlib.pyplot as plt
import numpy as np

from . import decay_floater as floaters
from . import decay_runs as runs
from .coupled_decay import SCALE, static_wrench
from .decay_floater import Release
from .tables import table

STEP = 0.005  # s at the model's scale
DELAYS = (0.005, 0.02, 0.05)  # s
# Small, so that the drag of the lines, which grows with the motion, does not make up for what is lost.
RELEASE = Release(0, 0.5, 4)
GOAL_PREDICTED, GOAL_REMOVED = 0.1, 0.9


def run(quick=False):
    """Prints the table. quick: one delay."""
    body = floaters.floater(static_wrench(SCALE), SCALE)
    seconds = floaters.duration("surge", SCALE, RELEASE.halves)

    def decay(delay, compensated):
        with runs.mooring_node(SCALE, delay if compensated else 0.0):
            return runs.decay_of(body, RELEASE, SCALE, STEP, seconds, lag=round(delay / STEP))

    none = decay(0.0, False)
    omega = 2.0 * np.pi / none.period
    rows, failed, found = [], [], {}
    for delay in DELAYS[1:2] if quick else DELAYS:
        predicted = 0.5 * omega * delay
        late, compensated = decay(delay, False), decay(delay, True)
        lost, left = none.damping - late.damping, none.damping - compensated.damping
        removed = 1.0 - abs(left) / lost
        found[f"{delay:g}"] = {"predicted": predicted, "lost": lost, "left": left, "removed": removed}
        rows.append([f"{1e3 * delay:g} ms", *(f"{100 * value:.4f} %" for value in (predicted, lost, left)), f"{100 * removed:.1f} %"])
        if abs(lost / predicted - 1.0) > GOAL_PREDICTED:
            failed.append(f"{1e3 * delay:g} ms cost {100 * lost:.3f} % of critical damping, expected {100 * predicted:.3f} %")
        if delay == 0.02 and removed < GOAL_REMOVED:
            failed.append(f"compensation removes {100 * removed:.0f} % of the loss at 20 ms, goal {100 * GOAL_REMOVED:g} %")
    header = ["delay at 1:50", "lost by ω τ / 2", "lost, measured", "lost, with prediction in the node", "removed"]
    content = {"coupled_delay": table(header, rows)}
    print(f"without delay: period {none.period:.3f} s, damping {100 * none.damping:.3f} % of critical")
    print(content["coupled_delay"], flush=True)
    return {"none": vars(none), "delays": found, "tables": content, "figures": {"coupled_delay.png": _figure(found)}, "failed": failed}


def _figure(found):
    """Losses over the delay."""
    figure, axes = plt.subplots(figsize=(5.0, 3.4), layout="constrained")
    delays = [1e3 * float(delay) for delay in found]
    for key, style, label in (("predicted", "k-", "ω τ / 2"), ("lost", "oC3", "measured"), ("left", "sC0", "with prediction")):
        axes.plot(delays, [100 * values[key] for values in found.values()], style, label=label)
    axes.set(xlabel="delay at 1:50 (ms)", ylabel="damping lost (% of critical)")
    axes.legend()
    return figure
