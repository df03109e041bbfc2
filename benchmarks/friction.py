"""Bed friction on the VolturnUS-S semi-taut mooring, as in Figures 5, 6 and 8 of Housner et al. (2022): the laws `saturated` and `stick` side by side.

Waves: tensions along the chain on the bed; the paper's law lets them even out, a law that sticks holds them.
Axial: the anchor fails and the platform drags the chain along itself; the tension is then the friction of what lies behind (closed form).
Transverse: the platform goes round the anchor; CableDyn, whose friction sticks, does the same.
"""

from dataclasses import dataclass, replace

import numpy as np

from mooring_ros.mooring import Mooring
from mooring_ros.scene import load_scene
from mooring_ros.scene.description import SATURATED, STICK

from . import bathymetry, cabledyn_peer, figures, tables
from .moordyn_history import SCENES
from .motions import poses_and_twists

LAWS = (SATURATED, STICK)
LOOKS = {code: {"linestyle": line, "linewidth": 1.4} for code, line in ((SATURATED, "--"), (STICK, "-"), ("CableDyn", ":"))}
WAVES_AT = (340, 360, 380, 400, 420, 440)  # m of chain from the anchor: nodes on the bed, on which the line lifts off beyond 440 m
AXIAL_AT = (50, 150, 250, 400)
TRANSVERSE_AT = (250, 330, 410, 490)
SAMPLE = 0.5  # s
LAST = 60.0  # s: tables show the means over them
GOAL_AXIAL = 0.01  # of the closed form
GOAL_TRANSVERSE = 0.05  # of CableDyn's; the paper's two codes are 5 to 15 % apart


@dataclass(frozen=True)
class Tow:
    """The platform goes along x at a constant speed, reached smoothly over ``ramp`` s."""

    speed: float = 0.2  # m/s
    end: float = 900.0  # s
    ramp: float = 10.0  # s

    def run(self, t):
        """Distance (n,) in m and speed (n,) in m/s."""
        s = np.clip(np.asarray(t, dtype=float) / self.ramp, 0.0, 1.0)
        gone = self.ramp * s**4 * (2.5 + s * (s - 3.0)) + np.maximum(np.asarray(t) - self.ramp, 0.0)
        return self.speed * gone, self.speed * s**3 * (10.0 + s * (6.0 * s - 15.0))

    def displacement(self, t):
        """Displacement (n, 3) in m and velocity (n, 3) in m/s at the times t (n,)."""
        gone, speed = self.run(t)
        return np.stack([gone, 0.0 * gone, 0.0 * gone], axis=1), np.stack([speed, 0.0 * speed, 0.0 * speed], axis=1)


@dataclass(frozen=True)
class RoundTheAnchor(Tow):
    """The fairlead goes round the anchor, which lies ``radius`` m from it toward -x."""

    speed: float = 0.9
    radius: float = 1072.0  # m

    def displacement(self, t):
        """The same."""
        gone, speed = self.run(t)
        angle = gone / self.radius
        place = self.radius * np.stack([np.cos(angle) - 1.0, np.sin(angle), 0.0 * angle], axis=1)
        return place, speed[:, None] * np.stack([-np.sin(angle), np.cos(angle), 0.0 * angle], axis=1)


@dataclass(frozen=True)
class Chain:
    """The chain in time, at the nodes from the anchor."""

    times: np.ndarray  # (samples,) s
    position: np.ndarray  # (samples, nodes, 3) m
    tension: np.ndarray  # (samples, nodes) N


def of_ours(file, law, motion, sample=SAMPLE):
    """The first line (the chain of line 1, from the anchor) of a scene under one law."""
    scene = load_scene(SCENES / file)
    environment = replace(scene.environment, friction=replace(scene.environment.friction, law=law))
    mooring = Mooring(replace(scene, environment=environment))
    times = sample * np.arange(1, round(motion.end / sample) + 1)
    poses, twists = poses_and_twists(*motion.displacement(times))
    start, _ = poses_and_twists(*motion.displacement(np.zeros(1)))
    mooring.settle(start[0])
    name = mooring.line_names[0]
    position, tension = [mooring.node_positions(name)], [mooring.node_tension(name)]
    for t, pose, twist in zip(times, poses, twists, strict=True):
        mooring.step(t, pose, twist)
        position.append(mooring.node_positions(name))
        tension.append(mooring.node_tension(name))
    return Chain(np.r_[0.0, times], np.array(position), np.array(tension))


def of_cabledyn(file, motion, step=0.05):
    """The same of CableDyn, whose line runs from the fairlead: turned round, and cut to the chain."""
    scene = load_scene(SCENES / file)
    friction = scene.environment.friction
    (chain,) = cabledyn_peer.chains(scene)
    run = cabledyn_peer.run(scene, chain, motion, step, motion.end, curvature=False, friction=(friction.kinetic_axial, friction.kinetic_transverse))
    nodes, every = chain.sections[-1].segments + 1, round(SAMPLE / step)
    segments = run.tension[::every, ::-1]
    tension = np.concatenate([segments[:, :1], 0.5 * (segments[:, 1:nodes] + segments[:, : nodes - 1])], axis=1)
    return Chain(run.times[::every], run.position[::every, ::-1][:, :nodes], tension)


def waves(quick):
    """({law: Chain} in waves, table of mean tensions along the bed)."""
    motion = replace(bathymetry.MOTION, measured_periods=1.0 if quick else 6.0)
    found = {law: of_ours("volturnus_s_semi_taut_friction.txt", law, motion) for law in LAWS}
    rows = []
    for law, chain in found.items():
        mean = chain.tension[chain.times >= motion.start].mean(axis=0)
        last = chain.tension[chain.times >= motion.end - motion.period].mean(axis=0)
        at = [round(s / 10.0) for s in WAVES_AT]
        rows.append([law, *(f"{mean[k] / 1e3:.1f}" for k in at), f"{(last[at[-1]] - last[at[0]]) / 1e3:.1f}"])
    header = ["law", *(f"{s} m" for s in WAVES_AT), "rise from the first to the last, last period"]
    return found, tables.table(header, rows)


def axial(quick):
    """({law: Chain} dragged behind the platform, table against the friction of what lies behind, misses)."""
    motion = Tow(end=60.0 if quick else Tow.end)
    scene = load_scene(SCENES / "volturnus_s_axial_friction.txt")
    env, kind = scene.environment, scene.lines[0].type
    weight = (kind.mass - env.water_density * np.pi * kind.diameter**2 / 4.0) * env.gravity
    drag = 0.5 * env.water_density * np.pi * kind.diameter * kind.drag_axial * motion.speed**2
    found = {law: of_ours("volturnus_s_axial_friction.txt", law, motion) for law in LAWS}
    rows, failed = [], []
    for law, chain in found.items():
        last = chain.times >= motion.end - LAST
        for s in AXIAL_AT:
            k = round(s / 10.0)
            if chain.position[last, k + 1, 2].max() > -env.depth + 0.1:
                continue  # no longer on the bed
            closed = (env.friction.kinetic_axial * weight + drag) * s
            mean = chain.tension[last, k].mean()
            speed = np.polyfit(chain.times[last], chain.position[last, k, 0], 1)[0]
            rows.append([law, f"{s} m", f"{mean / 1e3:.2f}", f"{closed / 1e3:.2f}", f"{100 * (mean / closed - 1.0):+.2f} %", f"{speed:.4f}"])
            if not quick and abs(mean / closed - 1.0) > GOAL_AXIAL:
                failed.append(f"friction, axial, {law}: {s} m from the free end {100 * (mean / closed - 1.0):+.1f} %, goal {100 * GOAL_AXIAL:.0f} %")
    header = ["law", "chain behind it", "tension, kN", "friction and drag of what lies behind, kN", "difference", "speed, m/s"]
    return found, tables.table(header, rows), failed


def transverse(quick):
    """({law or code: Chain} round the anchor, table against CableDyn at the end, misses)."""
    motion = RoundTheAnchor(end=60.0 if quick else 1200.0)
    found = {law: of_ours("volturnus_s_transverse_friction.txt", law, motion) for law in LAWS}
    found["CableDyn"] = of_cabledyn("volturnus_s_transverse_friction.txt", motion)
    rows, failed = [], []
    for s in TRANSVERSE_AT:
        k = round(s / 10.0)
        across = {code: chain.position[-1, k, 1] for code, chain in found.items()}
        tension = {code: chain.tension[chain.times >= motion.end - LAST, k].mean() for code, chain in found.items()}
        change = {law: tension[law] / tension["CableDyn"] - 1.0 for law in LAWS}
        cells = [f"{s} m", f"{across['CableDyn']:.1f}", f"{tension['CableDyn'] / 1e3:.1f}"]
        rows.append(cells + [cell for law in LAWS for cell in (f"{across[law]:.1f}", f"{100 * change[law]:+.1f} %")])
        if not quick and abs(change[STICK]) > GOAL_TRANSVERSE:
            failed.append(f"friction, transverse: {s} m from the anchor {100 * change[STICK]:+.1f} % of CableDyn's, goal {100 * GOAL_TRANSVERSE:.0f} %")
    header = ["from the anchor", "CableDyn: y, m", "tension, kN", "saturated: y, m", "tension", "stick: y, m", "tension"]
    return found, tables.table(header, rows), failed


def run(quick=False):
    """All three cases; prints the tables."""
    in_waves, waves_table = waves(quick)
    print(waves_table, flush=True)
    dragged, axial_table, failed = axial(quick)
    print(axial_table, flush=True)
    turned, transverse_table, missed = transverse(quick)
    failed += missed
    print(transverse_table, flush=True)
    pictures = {"friction_waves.png": waves_figure(in_waves), "friction_axial.png": nodes_figure(dragged, AXIAL_AT, 0, "x (m)")}
    pictures["friction_transverse.png"] = nodes_figure(turned, TRANSVERSE_AT, 1, "y (m)")
    content = {"friction_waves": waves_table, "friction_axial": axial_table, "friction_transverse": transverse_table}
    return {"tables": content, "failed": failed, "figures": pictures}


def waves_figure(found):
    """Tension of nodes on the bed in time, one panel a law: the paper's Figure 8."""
    figure, grid = figures.axes(1, len(found), height=3.6, sharey=True)
    for axis, (law, chain) in zip(grid[0], found.items(), strict=True):
        for colour, s in zip(figures.COLOURS, WAVES_AT, strict=False):
            axis.plot(chain.times, chain.tension[:, round(s / 10.0)] / 1e3, color=colour, linewidth=1.2, label=f"{s} m")
        axis.set_title(law, loc="left", fontsize=10)
        axis.set_xlabel("time (s)")
    grid[0, 0].set_ylabel("tension, at so far from the anchor (kN)")
    figures.legend(figure, grid[0, 0])
    return figure


def nodes_figure(found, places, direction, name):
    """Place and tension of some nodes in time: the paper's Figures 5 and 6."""
    figure, grid = figures.axes(1, 2, height=3.8)
    for law, chain in found.items():
        for colour, s in zip(figures.COLOURS, places, strict=False):
            k = round(s / 10.0)
            label = f"{s} m, {law}"
            grid[0, 0].plot(chain.times, chain.position[:, k, direction], color=colour, label=label, **LOOKS[law])
            grid[0, 1].plot(chain.times, chain.tension[:, k] / 1e3, color=colour, **LOOKS[law])
    grid[0, 0].set(xlabel="time (s)", ylabel=name)
    grid[0, 1].set(xlabel="time (s)", ylabel="tension (kN)")
    figures.legend(figure, grid[0, 0])
    return figure
