"""What a simulated second costs beside MoorDyn and CableDyn, each code with its best setting at the same error.

Two comparisons. On one mesh: the error in time of the fairlead tension, against the same code's run with a much finer step; MoorDyn's best scheme and step
beside our best. In space and time: the error of the end force on the platform, against the same code's run that is converged in both; CableDyn's best
mesh and step, and MoorDyn's, that are as accurate as ours.
"""

import math
from dataclasses import asdict

from . import our_search, peer_search, tables
from .peer_cases import BY_NAME
from .peer_runs import error, of_cabledyn, of_moordyn, of_ours

NAMES = ("OC4 3 x 20", "OC4 3 x 40", "OC4 3 x 100", "VolturnUS-S semi-taut", "RM3 cable")
CABLE = "RM3 cable"
MANY = ("OC4 3 x 20", "OC4 3 x 40", "VolturnUS-S semi-taut")  # where all of MoorDyn's schemes are searched
GOAL = {"MoorDyn": 20.0, "CableDyn": 20.0}
GOAL_CABLE = 1.0  # of CableDyn on the RM3 cable
REAL_TIME = 200.0  # times, of the RM3 cable
TIMINGS = 3  # alternating runs of each code's best; the fastest of each counts
TOGETHER = 10  # steps in one call of MoorDyn, to see what a call costs
FINE = 4.0  # segments for each of the case in converged runs; half of that for the cable


def compare(case, timings=TIMINGS):
    """All figures of one case as a dictionary."""
    motion = case.platform()
    schemes = tuple(peer_search.SCHEMES) if case.name in MANY else peer_search.FEW
    theirs = peer_search.moordyn_reference(case)
    moordyn = peer_search.moordyn_settings(case, theirs, case.allowed, schemes)
    cable = case.name == CABLE
    known = our_search.reference(case, fine=4 if cable else 8)
    ours = our_search.settings(case, known, what="tension")
    chosen, rival = peer_search.best(ours, case.allowed), peer_search.best(moordyn, case.allowed)

    fine, coarser = (our_search.reference(case, x / 2.0 if cable else x, fine=1) for x in (FINE, FINE / 2.0))
    mine = of_ours(case, chosen.solver, chosen.dt, chosen.rate)
    total = error(mine, fine, motion)
    their_fine = peer_search.cabledyn_reference(case, FINE)
    cabledyn = peer_search.cabledyn_settings(case, their_fine)
    third = peer_search.best(cabledyn, max(total, case.allowed if cable else 0.0))

    costs = {"run": [], "step": [], "step at 20 Hz": [], "MoorDyn": [], "MoorDyn together": [], "CableDyn": []}
    for _ in range(timings):
        costs["run"].append(of_ours(case, chosen.solver, chosen.dt, chosen.rate).cost)
        costs["MoorDyn"].append(of_moordyn(case, rival.name, rival.dt, fresh=True).cost)
        if len(costs["MoorDyn together"]) < 2:
            costs["MoorDyn together"].append(of_moordyn(case, rival.name, rival.dt, steps_per_call=TOGETHER).cost)
        costs["step"].append(of_ours(case, chosen.solver, chosen.dt, chosen.rate, call="step").cost)
        costs["step at 20 Hz"].append(of_ours(case, chosen.solver, chosen.dt, 20.0, call="step").cost)
        if third:
            costs["CableDyn"].append(of_cabledyn(case, third.dt, third.refinement, fresh=True).cost)
    least = {name: min(values, default=math.inf) for name, values in costs.items()}
    called = max(0.0, (least["MoorDyn"] - least["MoorDyn together"]) * TOGETHER / (TOGETHER - 1.0))
    return {
        "case": case.name,
        "allowed": case.allowed,
        "ours": asdict(chosen) | {"label": chosen.label()},
        "moordyn": asdict(rival) | {"label": rival.label()},
        "cabledyn": (asdict(third) | {"label": third.label()}) if third else None,
        "total": total,
        "reference": error(coarser, fine, motion) / 3.0,
        "cabledyn_apart": error(their_fine, fine, motion),
        "moordyn_apart": error(theirs, known, motion, "tension"),
        "least": least,
        "called": called,
        "sweeps": {
            "ours": [asdict(s) | {"label": s.label()} for s in ours],
            "moordyn": [asdict(s) | {"label": s.label()} for s in moordyn],
            "cabledyn": [asdict(s) | {"label": s.label()} for s in cabledyn],
        },
    }


def run(quick=False):
    """All cases; prints the tables."""
    results = []
    for name in NAMES[:1] if quick else NAMES:
        results.append(compare(BY_NAME[name], 2 if quick else TIMINGS))
        print(summary(results[-1]), flush=True)
    content = {"peer_cost_mesh": mesh_table(results), "peer_cost_total": total_table(results), "peer_cost_calls": call_table(results), "peer_cost_floor": floor_table(results)}
    print("\n" + "\n\n".join(content.values()), flush=True)
    return {"cases": results, "tables": content, "failed": [miss for r in results for miss in misses(r)]}


def misses(r):
    """What falls short of the goals."""
    least, failed = r["least"], []
    ratio = least["MoorDyn"] / least["run"]
    if ratio < GOAL["MoorDyn"]:
        failed.append(f"{r['case']}: {ratio:.1f} times less CPU than MoorDyn, goal {GOAL['MoorDyn']:.0f}")
    cable = r["case"] == CABLE
    ratio, goal = least["CableDyn"] / least["run"], GOAL_CABLE if cable else GOAL["CableDyn"]
    if ratio < goal:
        failed.append(f"{r['case']}: {ratio:.1f} times less CPU than CableDyn, goal {goal:.0f}")
    if cable and 1.0 / least["run"] < REAL_TIME:
        failed.append(f"{r['case']}: {1.0 / least['run']:.0f} times real time, goal {REAL_TIME:.0f}")
    return failed


def summary(r):
    """One line."""
    least = r["least"]
    return (
        f"{r['case']}: ours {r['ours']['label']} {1e3 * least['run']:.4f} ms/s; MoorDyn {r['moordyn']['label']} {1e3 * least['MoorDyn']:.3f} ms/s, "
        f"ratio {least['MoorDyn'] / least['run']:.1f}; CableDyn {r['cabledyn'] and r['cabledyn']['label']} {1e3 * least['CableDyn']:.3f} ms/s at a total error of "
        f"{percent(r['total'])}, ratio {least['CableDyn'] / least['run']:.1f}"
    )


def percent(x):
    """A fraction in % of two digits."""
    return f"{100 * x:.2g} %"


def ms(x):
    """Seconds in ms of three digits."""
    return f"{1e3 * x:.3g}"


def mesh_table(results):
    """Ours and MoorDyn's on one mesh."""
    header = ["scene", "MoorDyn's best", "error", "CPU ms per simulated s", "ours", "error", "CPU ms per simulated s", "ratio", "times real time"]
    rows = []
    for r in results:
        least, m, o = r["least"], r["moordyn"], r["ours"]
        rows.append([r["case"], m["label"], percent(m["error"]), ms(least["MoorDyn"]), o["label"], percent(o["error"]), ms(least["run"])])
        rows[-1] += [f"{least['MoorDyn'] / least['run']:.1f}", f"{1.0 / least['run']:.0f}"]
    return tables.table(header, rows)


def total_table(results):
    """Ours and CableDyn's at equal error in space and time."""
    header = ["scene", "our total error, as in the table above", "CableDyn's best that is as accurate", "its error", "CPU ms per simulated s", "ours", "ratio"]
    rows = []
    for r in results:
        least, c = r["least"], r["cabledyn"]
        theirs = [c["label"], percent(c["error"]), ms(least["CableDyn"])] if c else ["none", "", ""]
        rows.append([r["case"], percent(r["total"]), *theirs, ms(least["run"]), f"{least['CableDyn'] / least['run']:.1f}" if c else ""])
    return tables.table(header, rows)


def call_table(results):
    """What calls from Python cost both codes."""
    header = ["scene", "ours: `run`", "at 20 Hz, default step", "`step`, the same samples", "`step` at 20 Hz", "MoorDyn called at each step", "inside its compiled code", "ratio inside", "ratio called"]
    rows = []
    for r in results:
        least = r["least"]
        inside = least["MoorDyn"] - r["called"]
        usual = min(s["cost"] for s in r["sweeps"]["ours"] if s["dt"] is None and s["rate"] == 20.0)
        rows.append([r["case"], ms(least["run"]), ms(usual), *(ms(least[key]) for key in ("step", "step at 20 Hz", "MoorDyn")), ms(inside)])
        rows[-1] += [f"{inside / least['run']:.1f}", f"{least['MoorDyn'] / least['step']:.1f}"]
    return tables.table(header, rows)


def floor_table(results):
    """How far the codes' converged runs are apart, and how far our reference is from convergence."""
    header = ["scene", "ours, error of the reference", "MoorDyn's converged run from ours, same mesh", "CableDyn's converged run from ours"]
    rows = [[r["case"], percent(r["reference"]), percent(r["moordyn_apart"]), percent(r["cabledyn_apart"])] for r in results]
    return tables.table(header, rows)
