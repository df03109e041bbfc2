"""The RM3 umbilical of Hall, Srinivas and Yu (2020) in waves, against MoorDyn with its step of 0.1 ms and against CableDyn.

All three get the same sea (the components of the scene's spectrum, summed at the nodes), the same motion of the converter and segments of 1 m.
Compared are means and standard deviations in time of tension and curvature along the cable, and snapshots of its shape, as in the paper's Figures 8 to 11.
"""

import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from mooring_ros.mooring import Mooring
from mooring_ros.scene import load_scene

from . import figures, tables
from .moordyn_deck import sea_components
from .moordyn_history import SCENES
from .motions import poses_and_twists
from .sea_motion import SeaMotion

SAMPLE = 0.1  # s
PEER_STEP = 1e-4  # s, that of the paper
CABLEDYN_STEP = 0.02  # s: half of it, or half the elements, changes no figure below by more than 0.3 %
PLACES = {  # unstretched arc length from the converter, m: nodes within a section
    "hanging, below the stiffener": 10.0,
    "sag bend": 45.0,
    "above the buoyant section": 56.0,
    "hog bend": 68.0,
    "below the buoyant section": 83.0,
    "falling to the bed": 95.0,
    "touchdown": 102.0,
    "on the bed": 125.0,
}
CURVED = ("sag bend", "hog bend", "falling to the bed", "touchdown")  # places where the curvature is more than a remainder
GOAL_MEAN, GOAL_DEVIATION = 0.02, 0.05
FILE = Path(__file__).parent / "data" / "rm3_peers.csv"


@dataclass(frozen=True)
class History:
    """The cable in time, at the nodes inside its sections."""

    times: np.ndarray  # (samples,) s
    arc: np.ndarray  # (nodes,) m, unstretched, from the converter
    position: np.ndarray  # (samples, nodes, 3) m
    tension: np.ndarray  # (samples, nodes) N: mean of the segments on both sides
    curvature: np.ndarray  # (samples, nodes) 1/m
    attachment: np.ndarray  # (samples,) N: tension of the first segment
    cost: float  # CPU s for a simulated s (CableDyn: wall)

    def after(self, start):
        """The same from ``start`` (s) on."""
        keep = self.times >= start - 1e-9
        return History(self.times[keep], self.arc, self.position[keep], self.tension[keep], self.curvature[keep], self.attachment[keep], self.cost)


def sections(scene):
    """(arc length (nodes,) of each line's nodes, in order from the converter, mask of those inside a section)."""
    arcs, start = [], 0.0
    for line in scene.lines:
        arcs.append(start + np.linspace(0.0, line.length, line.segments + 1))
        start += line.length
    inside = np.concatenate([np.r_[False, np.ones(len(a) - 2, dtype=bool), False] for a in arcs])
    return np.concatenate(arcs), inside


def of_moordyn(scene, motion, step=PEER_STEP):
    """MoorDyn's history."""
    import moordyn

    from . import moordyn_peer

    def probe(lines):
        rows = []
        for line in lines:
            for i in range(moordyn.GetLineN(line) + 1):
                rows.append((*moordyn.GetLineNodePos(line, i), np.linalg.norm(moordyn.GetLineNodeTen(line, i)), moordyn.GetLineNodeCurv(line, i)))
        return rows

    run = moordyn_peer.run(scene, motion, step, "RK2", sample=SAMPLE, options=("1 ICgenDynamic",), probe=probe)
    arc, inside = sections(scene)
    nodes = run.probed
    return History(run.times, arc[inside], nodes[:, inside, :3], nodes[:, inside, 3], nodes[:, inside, 4], nodes[:, 0, 3], run.cost)


def of_cabledyn(scene, motion, step=CABLEDYN_STEP):
    """CableDyn's history."""
    from . import cabledyn_peer

    (chain,) = cabledyn_peer.chains(scene)
    run = cabledyn_peer.run(scene, chain, motion, step, motion.end)
    arc, inside = sections(scene)
    nodes = np.rint(arc[inside]).astype(int)  # segments of 1 m: a node's arc length is its number
    every = round(SAMPLE / step)
    tension = 0.5 * (run.tension[:, nodes - 1] + run.tension[:, nodes])
    samples = slice(every, None, every)
    return History(
        run.times[samples], arc[inside], run.position[samples][:, nodes], tension[samples], run.curvature[samples][:, nodes],
        run.tension[samples, 0], run.wall / run.simulated,
    )  # fmt: skip


def of_ours(scene, motion):
    """Ours."""
    mooring = Mooring(scene)
    times = SAMPLE * np.arange(1, round(motion.end / SAMPLE) + 1)
    poses, twists = poses_and_twists(*motion.displacement(times))
    start, _ = poses_and_twists(*motion.displacement(np.zeros(1)))
    mooring.settle(start[0])
    position, tension, curvature, attachment, cpu = [], [], [], [], 0.0
    for t, pose, twist in zip(times, poses, twists, strict=True):
        began = time.process_time()
        mooring.step(t, pose, twist)
        cpu += time.process_time() - began
        position.append(np.concatenate([mooring.node_positions(name) for name in mooring.line_names]))
        tension.append(np.concatenate([mooring.node_tension(name) for name in mooring.line_names]))
        curvature.append(np.concatenate([mooring.node_curvature(name) for name in mooring.line_names]))
        attachment.append(mooring.fairlead_tension[0])
    arc, inside = sections(scene)
    return History(
        times, arc[inside], np.array(position)[:, inside], np.array(tension)[:, inside], np.array(curvature)[:, inside],
        np.array(attachment), cpu / times[-1],
    )  # fmt: skip


def statistics(history):
    """{row name: (mean, standard deviation)} of tension (N) at all places and of curvature (1/m) where the cable is curved."""
    rows = {"tension, attachment": history.attachment}
    for place, arc in PLACES.items():
        rows[f"tension, {place}"] = history.tension[:, np.argmin(np.abs(history.arc - arc))]
    for place in CURVED:
        rows[f"curvature, {place}"] = history.curvature[:, np.argmin(np.abs(history.arc - PLACES[place]))]
    return {name: (float(values.mean()), float(values.std())) for name, values in rows.items()}


def load_peers():
    """{row name: ((mean, deviation) of MoorDyn, (mean, deviation) of CableDyn)} from the file."""
    with open(FILE, encoding="utf-8") as file:
        rows = [line.rstrip("\n").rsplit(",", 4) for line in file if not line.startswith("#")][1:]
    return {name.strip('"'): ((float(a), float(b)), (float(c), float(d))) for name, a, b, c, d in rows}


def write_peers(histories):
    """Keep the peers' statistics in the file, so that the tests can hold ours against them without the peers."""
    found = {code: statistics(histories[code]) for code in ("MoorDyn", "CableDyn")}
    with open(FILE, "w", encoding="utf-8") as file:
        file.write("# RM3 umbilical in waves, benchmarks/rm3_cable.py: mean and standard deviation in time of tension [N] and curvature [1/m]\n")
        file.write(f"# MoorDyn 2.7.2, RK2, step {PEER_STEP:g} s; CableDyn 0.3.0, step {CABLEDYN_STEP:g} s\n")
        file.write("place,MoorDyn mean,MoorDyn deviation,CableDyn mean,CableDyn deviation\n")
        for name in found["MoorDyn"]:
            values = (*found["MoorDyn"][name], *found["CableDyn"][name])
            file.write(",".join([f'"{name}"', *(f"{x:.6g}" for x in values)]) + "\n")


def run(quick=False):
    """All three codes; prints the table."""
    scene = load_scene(SCENES / "rm3_cable.txt")
    sea = sea_components(scene.environment)
    of_ours(scene, SeaMotion(*sea, ramp=0.2, measured=0.2))  # compiles
    motion = SeaMotion(*sea, **({"ramp": 14.5, "measured": 14.5} if quick else {}))
    histories = {"ours": of_ours(scene, motion), "CableDyn": of_cabledyn(scene, motion), "MoorDyn": of_moordyn(scene, motion)}
    histories = {name: history.after(motion.start) for name, history in histories.items()}
    if not quick:
        write_peers(histories)
    return report(histories, costs_without_waves(scene, motion))


def costs_without_waves(scene, motion):
    """{code: CPU s for a simulated s} of the lumped-mass codes in still water, where the waves' share is gone; of MoorDyn over a short run."""
    from . import moordyn_peer

    still = replace(scene, environment=replace(scene.environment, waves=None))
    short = moordyn_peer.run(still, motion, PEER_STEP, "RK2", options=("1 ICgenDynamic", "1.0 TmaxIC"), until=5.0)
    return {"ours": of_ours(still, motion).cost, "MoorDyn": short.cost}


def report(histories, without_waves):
    """Tables, figures and misses of {code: History after the ramp}; costs in still water by code."""
    found = {name: statistics(history) for name, history in histories.items()}
    reference = found["MoorDyn"]
    rows, failed = [], []
    for name, (mean, deviation) in reference.items():
        force = name.startswith("tension")
        shown = [f"{mean / 1e3:.2f} kN", f"{deviation / 1e3:.3f} kN"] if force else [f"{mean:.4f} /m", f"{deviation:.4f} /m"]
        changes = [(found[code][name][0] / mean - 1.0, found[code][name][1] / deviation - 1.0) for code in ("ours", "CableDyn")]
        rows.append([name, *shown, *(f"{100 * x:+.2f} %" for change in changes for x in change)])
        if abs(changes[0][0]) > GOAL_MEAN:
            failed.append(f"RM3 {name}: mean {100 * changes[0][0]:+.2f} % of MoorDyn's, goal {100 * GOAL_MEAN:.0f} %")
        if abs(changes[0][1]) > GOAL_DEVIATION:
            failed.append(f"RM3 {name}: standard deviation {100 * changes[0][1]:+.2f} % of MoorDyn's, goal {100 * GOAL_DEVIATION:.0f} %")
    header = ["", "MoorDyn: mean", "deviation", "ours: mean", "deviation", "CableDyn: mean", "deviation"]
    costs = [[name, *(f"{1e3 * x:.1f}" if x else "" for x in (history.cost, without_waves.get(name)))] for name, history in histories.items()]
    content = {"rm3_statistics": tables.table(header, rows), "rm3_cost": tables.table(["CPU ms per simulated s", "in waves", "without"], costs)}
    print("\n\n".join(content.values()), flush=True)
    makers = {"snapshots": snapshot_figure, "attachment": attachment_figure, "statistics": statistics_figure}
    pictures = {f"rm3_{name}.png": make(histories) for name, make in makers.items()}
    return {"statistics": found, "tables": content, "failed": failed, "figures": pictures}


def snapshot_figure(histories):
    """Shape, tension and curvature when the attachment's tension is greatest, near its mean and least (of MoorDyn)."""
    reference = histories["MoorDyn"]
    pull = reference.attachment
    instants = {"greatest": pull.argmax(), "mean": np.abs(pull - pull.mean()).argmin(), "least": pull.argmin()}
    figure, grid = figures.axes(3, 3, height=8.0)
    for column, (what, k) in enumerate(instants.items()):
        moment = reference.times[k]
        for name, history in histories.items():
            i = np.argmin(np.abs(history.times - moment))
            style = {**figures.STYLES[name], "label": name}
            grid[0, column].plot(history.position[i, :, 0], history.position[i, :, 2], **style)
            grid[1, column].plot(history.arc, history.tension[i] / 1e3, **style)
            grid[2, column].plot(history.arc, history.curvature[i], **style)
        grid[0, column].set_title(f"{moment:.1f} s: {what} pull", loc="left", fontsize=10)
        grid[0, column].set(xlabel="x (m)", ylabel="z (m)")
        grid[1, column].set(xlabel="arc length (m)", ylabel="tension (kN)")
        grid[2, column].set(xlabel="arc length (m)", ylabel="curvature (1/m)")
    figures.legend(figure, grid[0, 0])
    return figure


def attachment_figure(histories):
    """Tension at the converter in time."""
    figure, grid = figures.axes(height=3.0)
    for name, history in histories.items():
        grid[0, 0].plot(history.times, history.attachment / 1e3, label=name, **figures.STYLES[name])
    grid[0, 0].set(xlabel="time (s)", ylabel="tension at the converter (kN)")
    figures.legend(figure, grid[0, 0])
    return figure


def statistics_figure(histories):
    """Mean and standard deviation in time along the cable."""
    figure, grid = figures.axes(2, 2, height=5.2, sharex=True)
    for name, history in histories.items():
        style = {**figures.STYLES[name], "label": name}
        for row, (values, unit) in enumerate(((history.tension / 1e3, "tension (kN)"), (history.curvature, "curvature (1/m)"))):
            grid[row, 0].plot(history.arc, values.mean(axis=0), **style)
            grid[row, 1].plot(history.arc, values.std(axis=0), **style)
            grid[row, 0].set_ylabel(f"mean {unit}")
            grid[row, 1].set_ylabel(f"deviation of {unit}")
    for axis in grid[1]:
        axis.set_xlabel("arc length (m)")
    figures.legend(figure, grid[0, 0])
    return figure
