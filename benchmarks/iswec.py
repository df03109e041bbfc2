"""Load and excursion of the two ISWEC moorings (Paduano et al., Figures 4 and 5): statics of lines, jumpers, clump weights and a swivel, against MoorPy.

The converter is moved along x and the tension of the load cell between swivel and bridles is read. MoorPy solves the same with elastic catenaries.
"""

from dataclasses import replace

import numpy as np

from mooring_ros.mooring import Mooring
from mooring_ros.scene import load_scene

from . import figures, tables
from .moordyn_history import SCENES

SYSTEMS = {"C2a": ("iswec_c2a.txt", -22.0, 24.0), "C1": ("iswec_c1.txt", -17.0, 22.0)}  # scene; excursions (m) to where the lines are taut
STEP = 1.0  # m
LOAD_CELL = "line3"
FINER = 8  # times the scene's segments: with 2.5 m the place of the touchdown moves the load by 2 %
GOAL = 0.01


def of_ours(scene, excursions):
    """Tension (n,) N in the load cell."""
    finer = tuple(replace(line, segments=FINER * line.segments) for line in scene.lines)
    mooring = Mooring(replace(scene, lines=finer), fidelity="quasi_static")
    found = []
    for x in excursions:
        mooring.settle(np.array([x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]))
        found.append(np.mean(mooring.node_tension(LOAD_CELL)))
    return np.array(found)


def of_moorpy(scene, excursions):
    """The same; each line as one elastic catenary."""
    import moorpy

    env = scene.environment
    system = moorpy.System(depth=env.depth, rho=env.water_density, g=env.gravity)
    for kind in scene.line_types:
        weight = (kind.mass - env.water_density * np.pi / 4.0 * kind.diameter**2) * env.gravity
        system.lineTypes[kind.name] = {
            "name": kind.name, "d_vol": kind.diameter, "m": kind.mass, "w": weight, "EA": kind.stiffness, "input_d": kind.diameter, "material": "chain",
        }  # fmt: skip
    for point in scene.points:
        system.addPoint({"fixed": 1, "coupled": -1, "free": 0}[point.kind], np.array(point.position), m=point.mass, v=point.volume)
    for line in scene.lines:
        system.addLine(line.length, line.type.name, pointA=line.end_a, pointB=line.end_b)
    coupled = [k for k, point in enumerate(scene.points) if point.kind == "coupled"]
    cell = [k for k, line in enumerate(scene.lines) if line.name == LOAD_CELL][0]
    system.initialize()
    found = []
    for x in excursions:
        for k in coupled:
            system.pointList[k].setPosition(np.array(scene.points[k].position) + [x, 0.0, 0.0])
        system.solveEquilibrium(DOFtype="free", tol=1e-6, maxIter=5000)
        found.append(0.5 * (system.lineList[cell].TA + system.lineList[cell].TB))
    return np.array(found)


def run(quick=False):
    """Both systems; prints the table."""
    curves, rows, failed = {}, [], []
    for name, (file, least, most) in SYSTEMS.items():
        scene = load_scene(SCENES / file)
        step = 5.0 * STEP if quick else STEP
        sides = np.arange(0.0, most + 0.5 * step, step), -np.arange(step, 0.5 * step - least, step)  # outward: each from its neighbour
        order = np.argsort(np.concatenate(sides))
        excursions = np.concatenate(sides)[order]
        ours, peer = (np.concatenate([solve(scene, side) for side in sides])[order] for solve in (of_ours, of_moorpy))
        curves[name] = {"excursions": excursions, "ours": ours, "MoorPy": peer}
        worst = np.max(np.abs(ours / peer - 1.0))
        for x, a, b in list(zip(excursions, ours, peer, strict=True))[:: 1 if quick else 4]:
            rows.append([f"{name}, {x:+.0f} m", f"{a / 1e3:.2f}", f"{b / 1e3:.2f}", f"{100 * (a / b - 1.0):+.2f} %"])
        rows.append([f"{name}, largest difference", "", "", f"{100 * worst:.2f} %"])
        if worst > GOAL:
            failed.append(f"ISWEC {name}: load cell up to {100 * worst:.1f} % from MoorPy, goal {100 * GOAL:.0f} %")
    content = {"iswec_excursion": tables.table(["excursion", "ours, kN", "MoorPy, kN", "difference"], rows)}
    print(content["iswec_excursion"], flush=True)
    return {"tables": content, "failed": failed, "figures": {"iswec_excursion.png": picture(curves)}}


def picture(curves):
    """Load over excursion."""
    figure, grid = figures.axes(1, len(curves), height=3.4)
    for axis, (name, codes) in zip(grid[0], curves.items(), strict=True):
        axis.plot(codes["excursions"], codes["MoorPy"] / 1e3, "o", color=figures.COLOURS[1], markersize=4, label="MoorPy")
        axis.plot(codes["excursions"], codes["ours"] / 1e3, label="ours", **figures.STYLES["ours"])
        axis.set_title(name, loc="left", fontsize=10)
        axis.set(xlabel="excursion along x (m)", ylabel="load cell (kN)")
    figures.legend(figure, grid[0, 0])
    return figure
