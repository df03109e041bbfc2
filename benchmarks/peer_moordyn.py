"""Chains of OC4 and VolturnUS-S against MoorDyn: what a simulated second costs at 1 % error, and how far the converged runs are apart.

Both codes get the same scene, the same prescribed surge and heave and the same measure. The error of a run is the rms of its fairlead
tension against the same code's converged run, over the standard deviation of that run, the worst line counting; three periods
of ramp are left out. Each code is timed by its own CPU time in the step calls, in this one process, runs of the two alternating.
"""

from mooring_ros.scene import load_scene

from . import moordyn_peer, ours, tables
from .errors import dynamic_difference
from .moordyn_history import CASES, SCENES, transit_time
from .motions import SurgeHeave

# MoorDyn's scheme and its step as a multiple of a segment's axial transit time; each family up to where it blows up
PEER_SETTINGS = (
    *(("Euler", x) for x in (0.15, 0.3, 0.4, 0.6, 0.65)),
    *(("RK2", x) for x in (0.6, 0.8, 0.95, 1.0)),
    *(("RK4", x) for x in (0.9, 1.2)),
    *(("ACA3", x) for x in (0.7,)),
    *(("Midpoint3", x) for x in (1.2, 1.5)),
    *(("Midpoint4", x) for x in (1.8, 2.4)),
    *(("Midpoint5", x) for x in (2.4, 3.0)),
    *(("Midpoint6", x) for x in (3.0, 3.6)),
)
QUICK_PEER_SETTINGS = (("Euler", 0.6), ("RK2", 0.6), ("RK2", 0.95), ("Midpoint5", 3.0))
ALLOWED = 0.01  # error at which costs are compared
GOAL_RATIO = 10.0
GOAL_DIFFERENCE = 0.005
TIMINGS = 3  # alternating runs of each code's best; the fastest of each counts


def peer_sweep(scene, segments, motion, reference, settings):
    """One row for each setting: scheme, dt (s), error, cost (s/s); failed runs have error None."""
    rows = []
    for scheme, multiple in settings:
        dt = float(f"{multiple * transit_time(scene, segments):.2e}")
        row = {"scheme": scheme, "dt": dt, "error": None, "cost": None}
        try:
            run = moordyn_peer.run(scene, motion, dt, scheme, segments)
            row["error"] = worst(run, reference, motion)
            row["cost"] = run.cost
        except moordyn_peer.PeerError as error:
            row["failure"] = str(error)
        rows.append(row)
    return rows


def our_sweep(scene, segments, motion, reference, quick):
    """The same for ours: the default step and finer ones, by ``run`` at several sample rates and by ``step``."""
    limit = float(ours.Mooring(scene, solver="explicit", segments=segments).step_limit.dt)
    settings = [("run", 5.0, None), ("run", 10.0, None), ("run", 20.0, None), ("run", 100.0, None), ("step", 20.0, None), ("step", 100.0, None)]
    settings += [("run", 1.0 / (whole * limit), None) for whole in {1, max(1, round(0.1 / limit)), max(1, round(0.2 / limit))}]
    if not quick:
        settings += [("run", 20.0, limit * x) for x in (0.75, 0.5, 0.25)]
    rows = []
    for call, rate, dt in settings:
        run = ours.run(scene, motion, rate, segments, dt, call)
        rows.append({"call": call, "rate": rate, "dt": dt, "error": worst(run, reference, motion), "cost": run.cost})
    return rows


def worst(run, reference, motion):
    """Largest error over the lines."""
    return float(dynamic_difference(run.times, run.tension, reference.times, reference.tension, motion.start).max())


def best(rows):
    """The cheapest row within the allowed error."""
    good = [row for row in rows if row["error"] is not None and row["error"] <= ALLOWED]
    return min(good, key=lambda row: row["cost"])


def compare(name, file, segments, motion, quick):
    """All figures of one case as a dictionary."""
    scene = load_scene(SCENES / file)
    transit = transit_time(scene, segments)
    fine = 4 if quick else 10
    peer_reference = moordyn_peer.run(scene, motion, transit / fine, "RK2", segments)
    peer_coarser = moordyn_peer.run(scene, motion, 2.0 * transit / fine, "RK2", segments)
    our_reference = ours.run(scene, motion, 20.0, segments, transit / (2 * fine))
    our_coarser = ours.run(scene, motion, 20.0, segments, transit / fine)

    peer_rows = peer_sweep(scene, segments, motion, peer_reference, QUICK_PEER_SETTINGS if quick else PEER_SETTINGS)
    our_rows = our_sweep(scene, segments, motion, our_reference, quick)
    peer_best, our_best = best(peer_rows), best(our_rows)
    for _ in range(TIMINGS):
        again = ours.run(scene, motion, our_best["rate"], segments, our_best["dt"], our_best["call"])
        our_best["cost"] = min(our_best["cost"], again.cost)
        again = moordyn_peer.run(scene, motion, peer_best["dt"], peer_best["scheme"], segments)
        peer_best["cost"] = min(peer_best["cost"], again.cost)
    return {
        "case": name,
        "deviation": peer_reference.tension[peer_reference.times > motion.start].std(axis=0).tolist(),
        "difference": worst(our_reference, peer_reference, motion),
        "peer_convergence": worst(peer_coarser, peer_reference, motion),
        "our_convergence": worst(our_coarser, our_reference, motion),
        "peer": peer_best,
        "ours": our_best,
        "ratio": peer_best["cost"] / our_best["cost"],
        "peer_sweep": peer_rows,
        "our_sweep": our_rows,
    }


def run(quick=False):
    """All cases; prints the tables."""
    motion = SurgeHeave(measured_periods=2.0 if quick else 4.0)
    warm = load_scene(SCENES / CASES[0][1])
    ours.run(warm, SurgeHeave(ramp_periods=0.05, measured_periods=0.05), segments=CASES[0][2])  # compiles
    ours.run(warm, SurgeHeave(ramp_periods=0.05, measured_periods=0.05), segments=CASES[0][2], call="step")
    results = []
    for case in CASES:
        results.append(compare(*case, motion, quick))
        print(_summary(results[-1]), flush=True)
    content = {"peer_moordyn_cost": _cost_table(results), "peer_moordyn_difference": _difference_table(results), "peer_moordyn_sweep": _sweep_table(results)}
    print("\n" + "\n\n".join(content.values()), flush=True)
    failed = [f"{r['case']}: {r['ratio']:.1f} times less CPU than MoorDyn, goal {GOAL_RATIO:.0f}" for r in results if r["ratio"] < GOAL_RATIO]
    failed += [
        f"{r['case']}: converged runs differ by {100 * r['difference']:.2f} %, goal {100 * GOAL_DIFFERENCE} %" for r in results if r["difference"] > GOAL_DIFFERENCE
    ]
    return {"cases": results, "tables": content, "failed": failed}


def _peer_name(row):
    return f"{row['scheme']}, {1e3 * row['dt']:.2f} ms"


def _our_name(row):
    step = "default step" if row["dt"] is None else f"dt {1e3 * row['dt']:.2f} ms"
    return f"`{row['call']}` at {row['rate']:.3g} Hz, {step}"


def _summary(r):
    return (
        f"{r['case']}: MoorDyn {_peer_name(r['peer'])} {1e3 * r['peer']['cost']:.3f} ms/s, ours {_our_name(r['ours'])} {1e3 * r['ours']['cost']:.4f} ms/s, "
        f"ratio {r['ratio']:.1f}; converged runs differ by {100 * r['difference']:.3f} %"
    )


def _cost_table(results):
    header = ["scene", "MoorDyn's best", "error", "CPU ms per simulated s", "ours", "error", "CPU ms per simulated s", "ratio"]
    rows = []
    for r in results:
        peer, our = r["peer"], r["ours"]
        rows.append([r["case"], _peer_name(peer), f"{100 * peer['error']:.2f} %", f"{1e3 * peer['cost']:.2f}"])
        rows[-1] += [_our_name(our), f"{100 * our['error']:.2f} %", f"{1e3 * our['cost']:.4f}", f"{r['ratio']:.1f}"]
    return tables.table(header, rows)


def _difference_table(results):
    header = ["scene", "standard deviation, kN", "the two converged runs differ by", "MoorDyn's run changes at twice the step by", "ours by"]
    rows = []
    for r in results:
        deviation = ", ".join(f"{x / 1e3:.0f}" for x in r["deviation"])
        rows.append([r["case"], deviation, *(f"{100 * r[key]:.3f} %" for key in ("difference", "peer_convergence", "our_convergence"))])
    return tables.table(header, rows)


def _sweep_table(results):
    rows = []
    for r in results:
        for row in r["peer_sweep"]:
            error = "fails" if row["error"] is None else f"{100 * row['error']:.2f} %"
            cost = "" if row["cost"] is None else f"{1e3 * row['cost']:.3f}"
            rows.append([r["case"], "MoorDyn", _peer_name(row), error, cost])
        for row in r["our_sweep"]:
            rows.append([r["case"], "ours", _our_name(row), f"{100 * row['error']:.3f} %", f"{1e3 * row['cost']:.4f}"])
    return tables.table(["scene", "code", "setting", "error", "CPU ms per simulated s"], rows)
