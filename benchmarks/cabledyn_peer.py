"""CableDyn (Fortran, the Python package ``cabledyn``; cubic Hermite elements, implicit steps) on lines in series of one of our scenes.

What differs from MoorDyn, and what is done about it here:

- Lines in series through joints without length (or free points without mass) are the sections of one line; its tangent is continuous there,
  so a moment passes on.
- End A must be the upper one. A clamp is a direction (``END CONNECTIONS``); other ends are pinned.
- The platform's motion is a row a step with position, velocity and acceleration.
- Waves are the components of MoorDyn's ``wave_frequencies.txt`` (its WaveKin 7), exact at every node, with Wheeler stretching.
- ``FairTen`` is the end force; the tension of a segment is the mean axial force of an element (``.t.out``).
- Bed damping acts only while a node goes down.
- A grid of depths is a list of places; the contact is along the normal, and the depth beyond the grid is that of its edge.
"""

import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import cabledyn
import numpy as np

from mooring_ros.scene.description import COUPLED, FIXED, RodEnd

from .moordyn_deck import WAVES, files

EXECUTABLE = Path(cabledyn.__file__).parent / "bin" / "cabledyn"
ROOT = "run"  # stem of the files that it writes


class PeerError(RuntimeError):
    """CableDyn cannot carry the scene, or failed on the way."""


@dataclass(frozen=True)
class Run:
    """What a run gave, of one line from end A to end B."""

    times: np.ndarray  # (samples,) s
    position: np.ndarray  # (samples, nodes, 3) m
    tension: np.ndarray  # (samples, segments) N
    curvature: np.ndarray  # (samples, nodes) 1/m, nan where it was not asked for
    arc: np.ndarray  # (nodes,) m, unstretched, from end A
    wall: float  # s
    simulated: float  # s


@dataclass(frozen=True)
class Chain:
    """Lines in series from a coupled end A to a fixed end B."""

    sections: tuple  # of Line, from end A
    top: tuple  # (3,) m
    anchor: tuple  # (3,) m
    clamp: tuple | None  # direction into the line at end A, None where it is pinned

    def arc(self, segments):
        """Unstretched arc length (m) of the nodes, with ``segments`` elements to each segment of the scene."""
        pieces = [np.full(n.segments * segments, n.length / (n.segments * segments)) for n in self.sections]
        return np.concatenate([[0.0], np.cumsum(np.concatenate(pieces))])


def chains(scene):
    """The lines of the scene as chains, one from each coupled end; PeerError where they branch or end elsewhere."""
    rods = {rod.id: rod for rod in scene.rods}
    found = []
    for line in scene.lines:
        for end, other in ((line.end_a, line.end_b), (line.end_b, line.end_a)):
            if _kind(scene, rods, end) == COUPLED:
                found.append(_follow(scene, rods, line, end, other))
    return found


def _follow(scene, rods, line, end, other):
    top, clamp = _place(scene, rods, end), None
    if isinstance(end, RodEnd) and line.type.bending_stiffness > 0.0:
        axis = np.subtract(rods[end.rod].end_b, rods[end.rod].end_a) * (1.0 if end.end == "B" else -1.0)
        clamp = tuple(axis / np.linalg.norm(axis))
    sections = [line]
    while _kind(scene, rods, other) != FIXED:
        following = [n for n in scene.lines if n is not sections[-1] and _holder(other) in (_holder(n.end_a), _holder(n.end_b))]
        if len(following) != 1:
            raise PeerError(f"{len(following) + 1} lines meet after {sections[-1].name}; a line of CableDyn is a chain")
        line = following[0]
        other = line.end_b if _holder(line.end_a) == _holder(other) else line.end_a
        sections.append(line)
    return Chain(tuple(sections), top, _place(scene, rods, other), clamp)


def _holder(end):
    return ("rod", end.rod) if isinstance(end, RodEnd) else ("point", end)


def _kind(scene, rods, end):
    return rods[end.rod].kind if isinstance(end, RodEnd) else scene.point(end).kind


def _place(scene, rods, end):
    if isinstance(end, RodEnd):
        rod = rods[end.rod]
        return rod.end_b if end.end == "B" and rod.segments else rod.end_a
    return scene.point(end).position


def deck(scene, lines, step, duration, segments=1, curvature_at=(), friction=None, outputs="pt", options=()):
    """CableDyn's input text for chains, each a line with ends of its own.

    ``curvature_at``: indices of nodes of the first line whose curvature is wanted; ``friction``: (axial, transverse); ``outputs``: flags of its own files of
    each line; ``options``: further rows of OPTIONS.
    """
    rows = [*_heading(scene), "------- POINTS -------", "ID Type X Y Z", "(-) (-) (m) (m) (m)"]
    for k, chain in enumerate(lines):
        rows += [_row(2 * k + 1, "Coupled", *map(float, chain.top)), _row(2 * k + 2, "Fixed", *map(float, chain.anchor))]
    rows += ["------- LINES -------", "ID NodeA NodeB Outputs", "(-) (-) (-) (-)"]
    rows += [_row(k + 1, 2 * k + 1, 2 * k + 2, outputs) for k in range(len(lines))]
    rows += ["------- SECTIONS -------", "LineID LineType Length NumSegs", "(-) (-) (m) (-)"]
    rows += [_row(k + 1, n.type.name, float(n.length), _whole(n.segments * segments)) for k, chain in enumerate(lines) for n in chain.sections]
    clamped = [(k, chain.clamp) for k, chain in enumerate(lines) if chain.clamp is not None]
    if clamped:
        rows += ["------- END CONNECTIONS -------", "LineID End Stiffness EzX EzY EzZ", "(-) (-) (N-m/rad) (-) (-) (-)"]
        rows += [_row(k + 1, "A", "Rigid", *map(float, clamp)) for k, clamp in clamped]
    rows += _options(scene, step, duration, friction, options)
    rows += ["------- OUTPUTS -------", *(f'"FairTen{k + 1}"' for k in range(len(lines))), *(f'"Curv1N{k + 1}"' for k in curvature_at)]
    return "\n".join([*rows, "------- need this line -------", ""])


def _heading(scene):
    rows = ["------- CableDyn Input File -------", "mooring_ros benchmark", "------- LINE TYPES -------"]
    rows += ["TypeName Diam MassDenInAir EA BA EI Cd_n Cd_t Ca_n Ca_t", "(-) (m) (kg/m) (N) (-) (N-m2) (-) (-) (-) (-)"]
    for k in {n.type.name: n.type for n in scene.lines}.values():
        if k.curve or k.slow_stiffness:
            raise PeerError(f"the peer deck does not carry the rope {k.name}")
        values = (k.diameter, k.mass, k.stiffness, k.damping, k.bending_stiffness, k.drag_normal, k.drag_axial, k.added_mass_normal, k.added_mass_axial)
        rows.append(_row(k.name, *map(float, values)))
    return rows


def _options(scene, step, duration, friction, options):
    env = scene.environment
    rows = ["------- OPTIONS -------", f"{env.gravity!r} g", f"{env.water_density!r} rhoW"]
    rows += [f"{env.bed_stiffness!r} kBot", f"{env.bed_damping!r} cBot"]
    rows.append("depths.txt bathymetryFile" if env.bathymetry else f"{float(env.depth)!r} WtrDpth")
    rows += [f"{float(step)!r} dtM", f"{float(duration)!r} TMax", "motion.txt motionFile"]
    if env.waves is not None:
        rows.append("7 WaveKin")
    if friction is not None:
        rows += [f"{friction[0]!r} frictionMuAxial", f"{friction[1]!r} frictionMuLateral"]
    return [*rows, *options]


def _whole(segments):
    return max(1, round(segments))


def run(scene, chain, motion, step, duration, segments=1, curvature=True, friction=None, folder=None):
    """Run one chain from its static state at the motion's start; a sample a step. Raises PeerError when CableDyn fails."""
    steps = round(duration / step)
    times = step * np.arange(steps + 1)
    arc = chain.arc(segments)
    wanted = range(len(arc)) if curvature else ()
    with tempfile.TemporaryDirectory(prefix="cabledyn_") as temporary:
        folder = Path(folder or temporary)
        texts = {name: text for name, text in files(scene).items() if name == WAVES}
        texts["deck.dat"] = deck(scene, [chain], step, steps * step, segments, wanted, friction)
        texts["motion.txt"] = prescribed(times, {1: chain.top}, motion)
        if scene.environment.bathymetry is not None:
            texts["depths.txt"] = depths(scene.environment.bathymetry)
        for name, text in texts.items():
            (folder / name).write_text(text, encoding="utf-8")
        began = time.perf_counter()
        done = subprocess.run([EXECUTABLE, folder / "deck.dat", folder / ROOT], capture_output=True, text=True, check=False)
        wall = time.perf_counter() - began
        if done.returncode != 0:
            raise PeerError("CableDyn failed: " + " ".join((done.stdout + done.stderr).splitlines()[-4:]))
        main = np.loadtxt(folder / f"{ROOT}.out", skiprows=2, ndmin=2)
        position = np.loadtxt(folder / f"{ROOT}.Line1.p.out", skiprows=2, ndmin=2)[:, 1:]
        tension = np.loadtxt(folder / f"{ROOT}.Line1.t.out", skiprows=2, ndmin=2)[:, 1:]
    bent = main[:, 2:] if curvature else np.full((len(main), len(arc)), np.nan)
    return Run(main[:, 0], position.reshape(len(main), len(arc), 3), tension, bent, arc, wall, steps * step)


def prescribed(times, places, motion):
    """Text of the motion file: each coupled point (id: place (3,) m) with position, velocity and acceleration at the times (n,)."""
    moved, velocity = motion.displacement(times)
    before, after = np.maximum(times - 1e-4, 0.0), times + 1e-4
    acceleration = (motion.displacement(after)[1] - motion.displacement(before)[1]) / (after - before)[:, None]
    rows = []
    for k, t in enumerate(times):
        rest = " ".join(f"{x:.12e}" for x in (*velocity[k], *acceleration[k]))
        rows += [f"{t:.12g} {which} " + " ".join(f"{x:.12e}" for x in np.add(place, moved[k])) + f" {rest}" for which, place in places.items()]
    return "\n".join(rows) + "\n"


def depths(grid):
    """Text of the file of depths of a grid."""
    rows = [f"{x!r} {y!r} {grid.depth[i][j]!r}" for i, x in enumerate(grid.x) for j, y in enumerate(grid.y)]
    return "\n".join([*rows, ""])


def _row(*cells):
    return " ".join(repr(float(c)) if isinstance(c, float) else str(c) for c in cells)
