"""Statics against closed forms: end forces of elastic catenaries, their order in the mesh, and the stiffness of whole systems.

The tables are those that the tests hold the core to (tests/claims/test_statics.py, test_platform_stiffness.py); here they are shown.
"""

import sys
from pathlib import Path

import numpy as np

from mooring_ros import Mooring
from mooring_ros.scene import load_scene

from . import tables

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))  # as pytest does
from claims.test_platform_stiffness import CASES, closed_form, symmetric  # noqa: E402
from scenes_in_code import HERE, SCENES, catenary_scene, table  # noqa: E402

SEGMENTS = 200
MESHES = (25, 50, 100, 200, 400)
STIFFNESS_MESHES = (200, 400, 800, 1500)
GOAL_FORCE, GOAL_STIFFNESS = 1e-3, 1e-2


def force_errors(row, segments):
    """Relative errors of the sizes of the fairlead's and the anchor's end force, Newton iterations, residual over the line's weight."""
    mooring = Mooring(catenary_scene(row, segments))
    mooring.settle(HERE)
    fairlead = np.linalg.norm(mooring.fairlead_end_force[0]) / float(row["T_fair_N"]) - 1.0
    anchor = np.linalg.norm(mooring.anchor_end_force[0]) / float(row["T_anch_N"]) - 1.0
    weight = float(row["w_N_per_m"]) * float(row["L_m"])
    return fairlead, anchor, mooring.static_result.iterations, mooring.static_result.residual / weight


def stiffness_error(case, segments):
    """Largest relative error of a non-zero entry of the 6 x 6 stiffness."""
    mooring = Mooring(symmetric(load_scene(SCENES / CASES[case])), segments=segments)
    mooring.settle(HERE)
    want, _ = closed_form(case)
    size = np.sqrt(np.outer(np.diag(want), np.diag(want)))
    nonzero = np.abs(want) > 1e-9 * size
    return float(np.abs(mooring.stiffness()[nonzero] / want[nonzero] - 1.0).max())


def run(quick):
    """Tables ``closed_forms_statics``, ``closed_forms_order`` and ``closed_forms_stiffness``, and the goals that are missed."""
    failed = []
    rows = [row for row in table("catenary_static.csv") if float(row["CB"]) == 0.0]
    forces, orders = [], []
    for row in rows:
        fairlead, anchor, iterations, residual = force_errors(row, SEGMENTS)
        forces.append((row["case"], f"{100 * fairlead:+.4f} %", f"{100 * anchor:+.4f} %", iterations, f"{residual:.0e}"))
        if max(abs(fairlead), abs(anchor)) > GOAL_FORCE:
            failed.append(f"end forces of {row['case']} at {SEGMENTS} segments")
        errors = [abs(force_errors(row, n)[0]) for n in MESHES]
        slope = -np.polyfit(np.log(MESHES), np.log(errors), 1)[0]
        orders.append((row["case"], *(f"{100 * error:.4f} %" for error in errors), f"{slope:.2f}"))
    meshes = STIFFNESS_MESHES[:3] if quick else STIFFNESS_MESHES
    stiffness = []
    for case in CASES:
        errors = [stiffness_error(case, n) for n in meshes]
        stiffness.append((case, *(f"{100 * error:.2f} %" for error in errors)))
        if errors[-1] > GOAL_STIFFNESS:
            failed.append(f"stiffness of {case} at {meshes[-1]} segments")
    shown = {
        "closed_forms_statics": tables.table(("line", "fairlead end force", "anchor end force", "iterations", "residual / weight"), forces),
        "closed_forms_order": tables.table(("line", *(f"N = {n}" for n in MESHES), "order"), orders),
        "closed_forms_stiffness": tables.table(("system", *(f"N = {n}" for n in meshes)), stiffness),
    }
    for content in shown.values():
        print(content, "\n")
    return {"tables": shown, "failed": failed}
