"""Chains of OC4 and VolturnUS-S against MoorDyn: how far the converged runs of both codes are apart.

Both get the same scene, the same prescribed surge and heave and the same measure: the rms difference of the tensions of the end segments at the fairleads over
the standard deviation of MoorDyn's, the worst line counting; three periods of ramp are left out. What they cost is in `peer_cost`.
"""

from mooring_ros.scene import load_scene

from . import moordyn_peer, ours, tables
from .errors import dynamic_difference
from .moordyn_history import CASES, SCENES, transit_time
from .motions import SurgeHeave

GOAL_DIFFERENCE = 0.005


def worst(run, reference, motion):
    """Largest difference over the lines."""
    return float(dynamic_difference(run.times, run.tension, reference.times, reference.tension, motion.start).max())


def compare(name, file, segments, motion, quick):
    """All figures of one case as a dictionary."""
    scene = load_scene(SCENES / file)
    transit = transit_time(scene, segments)
    fine = 4 if quick else 10
    peer_reference = moordyn_peer.run(scene, motion, transit / fine, "RK2", segments)
    peer_coarser = moordyn_peer.run(scene, motion, 2.0 * transit / fine, "RK2", segments)
    our_reference = ours.run(scene, motion, 20.0, segments, transit / (2 * fine))
    our_coarser = ours.run(scene, motion, 20.0, segments, transit / fine)
    return {
        "case": name,
        "deviation": peer_reference.tension[peer_reference.times > motion.start].std(axis=0).tolist(),
        "difference": worst(our_reference, peer_reference, motion),
        "peer_convergence": worst(peer_coarser, peer_reference, motion),
        "our_convergence": worst(our_coarser, our_reference, motion),
    }


def run(quick=False):
    """All cases; prints the table."""
    motion = SurgeHeave(measured_periods=2.0 if quick else 4.0)
    results = [compare(*case, motion, quick) for case in CASES]
    header = ["scene", "standard deviation, kN", "the two converged runs differ by", "MoorDyn's run changes at twice the step by", "ours by"]
    rows = []
    for r in results:
        deviation = ", ".join(f"{x / 1e3:.0f}" for x in r["deviation"])
        rows.append([r["case"], deviation, *(f"{100 * r[key]:.3f} %" for key in ("difference", "peer_convergence", "our_convergence"))])
    content = {"peer_moordyn_difference": tables.table(header, rows)}
    print(content["peer_moordyn_difference"], flush=True)
    failed = [
        f"{r['case']}: converged runs differ by {100 * r['difference']:.2f} %, goal {100 * GOAL_DIFFERENCE} %" for r in results if r["difference"] > GOAL_DIFFERENCE
    ]
    return {"cases": results, "tables": content, "failed": failed}
