"""The 33 m laboratory chain: computed against measured maxima of the upper end's tension.

Bergdahl, Eskilsson and Palm 2016 (JMSE 4(1):5, CC BY 4.0), Table 7, Lindahl's tests: the upper end runs clockwise on a circle in the vertical
plane of the line. Seen with the anchor on the left and z up it goes outward at the top. Measured: the mean of the maxima over the cycles, read to ±5 %.
"""

import csv
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from mooring_ros.scene import load_scene
from mooring_ros.scene.description import STICK

from . import figures, ours, tables
from .motions import Circle

SCENE = Path(__file__).parent.parent / "config" / "scenes" / "chalmers_33m.txt"
MEASURED = Path(__file__).parent / "data" / "bergdahl2016_chain_circular_motion.csv"
GOAL = 0.04
RATE = 500.0  # Hz, of the samples among which the maxima are looked for
STEP = 0.35e-3  # s: a quarter of a segment's axial transit time; the maxima need half of it or less


def measured():
    """{(period in s, radius in m): measured mean of the maxima in N}."""
    with open(MEASURED, encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    radii = [float(name[1:]) for name in rows[0][1:]]
    return {(float(row[0]), radius): float(value) for row in rows[1:] for radius, value in zip(radii, row[1:], strict=True)}


def maxima(scene, period, radius, segments=None, dt=STEP, clockwise=True, cycles=5):
    """Maxima (cycles,) in N of the upper end segment's tension over the cycles after the start has died out."""
    motion = Circle(radius, period, clockwise, measured_periods=cycles)
    run = ours.run(scene, motion, RATE, segments, dt)
    cycle = np.floor((run.times - motion.start) / period + 1e-9)
    return np.array([run.tension[cycle == k, 0].max() for k in range(cycles)])


def compute(scene, pairs, **settings):
    """Rows of period, radius, measured, computed, their relative error, and the scatter of the maxima."""
    found = measured()
    rows = []
    for period, radius in pairs:
        peaks = maxima(scene, period, radius, **settings)
        value = found[period, radius]
        rows.append(
            {
                "period": period,
                "radius": radius,
                "measured": value,
                "computed": float(peaks.mean()),
                "error": float(peaks.mean() / value - 1.0),
                "scatter": float(np.ptp(peaks)),
            }
        )
    return rows


def mean_error(rows):
    """Mean of the absolute relative errors."""
    return float(np.mean([abs(row["error"]) for row in rows]))


def bias(rows):
    """Mean of the relative errors."""
    return float(np.mean([row["error"] for row in rows]))


def spread():
    """Six of the thirty pairs: the corners, and two in the middle."""
    return [(1.25, 0.075), (1.25, 0.125), (1.25, 0.2), (2.0, 0.125), (3.5, 0.075), (3.5, 0.2)]


def convergence(scene, pairs, plain):
    """Rows of what was changed, mean absolute error, mean error, and the largest change of a maximum against ``plain``."""
    base = np.array([row["computed"] for row in plain])
    settings = {
        "half the step": {"dt": STEP / 2},
        "an eighth of the step": {"dt": STEP / 8},
        "33 segments": {"segments": 33},
        "132 segments, half the step": {"segments": 132, "dt": STEP / 2},
        "the solver's default step": {"dt": None},
        "the other sense": {"clockwise": False},
    }
    frictions = {"friction that sticks": replace(scene.environment.friction, law=STICK), "without friction": None}
    variants = {name: (scene, setting) for name, setting in settings.items()}
    variants |= {name: (replace(scene, environment=replace(scene.environment, friction=friction)), {}) for name, friction in frictions.items()}
    rows = [["as in the table", f"{100 * mean_error(plain):.1f} %", f"{100 * bias(plain):+.1f} %", ""]]
    for name, (variant, setting) in variants.items():
        changed = compute(variant, pairs, **setting)
        change = np.array([row["computed"] for row in changed]) / base - 1.0
        rows.append([name, f"{100 * mean_error(changed):.1f} %", f"{100 * bias(changed):+.1f} %", f"{100 * change[np.argmax(abs(change))]:+.1f} %"])
    return rows


def run(quick=False):
    """All 30 pairs (quick: six) and the convergence; prints the tables."""
    scene = load_scene(SCENE)
    pairs = spread() if quick else list(measured())
    maxima(scene, *pairs[0], cycles=1)  # compiles
    began = time.process_time()
    rows = compute(scene, pairs)
    cpu = time.process_time() - began
    error = mean_error(rows)
    body = [[f"{r['period']:.2f}", f"{r['radius']:.3f}", f"{r['measured']:.1f}", f"{r['computed']:.1f}", f"{100 * r['error']:+.1f} %"] for r in rows]
    main = tables.table(["period, s", "radius, m", "measured, N", "computed, N", "error"], body)
    main += f"\n\nMean absolute error {100 * error:.1f} %, mean error {100 * bias(rows):+.1f} %; {cpu:.1f} s of CPU time for these {len(rows)} runs."
    changes = tables.table(["setting", "mean absolute error", "mean error", "largest change"], convergence(scene, pairs, rows))
    content = {"bergdahl": main, "bergdahl_convergence": changes}
    print("\n\n".join(content.values()), flush=True)
    failed = [f"Bergdahl 2016: mean absolute error {100 * error:.1f} %, goal {100 * GOAL:.0f} %"] if error > GOAL else []
    pictures = {"bergdahl.png": picture(rows)}
    return {"rows": rows, "mean_absolute_error": error, "mean_error": bias(rows), "cpu": cpu, "tables": content, "failed": failed, "figures": pictures}


def picture(rows):
    """Computed over measured maxima, with the accuracy to which they were read."""
    figure, grid = figures.axes(height=4.2)
    ends = np.array([25.0, 75.0])
    grid[0, 0].fill_between(ends, 0.95 * ends, 1.05 * ends, color=figures.COLOURS[0], alpha=0.12, linewidth=0, label="read to 5 %")
    grid[0, 0].plot(ends, ends, color=figures.COLOURS[0], linewidth=0.8)
    for colour, period in zip(figures.COLOURS, sorted({row["period"] for row in rows}), strict=False):
        chosen = [row for row in rows if row["period"] == period]
        grid[0, 0].plot([r["measured"] for r in chosen], [r["computed"] for r in chosen], "o", color=colour, markersize=4.5, label=f"{period:g} s")
    grid[0, 0].set(xlabel="measured (N)", ylabel="computed (N)", xlim=ends, ylim=ends, aspect="equal")
    figures.legend(figure, grid[0, 0])
    return figure
