"""MoorDyn (C++, the Python package ``moordyn``) on one of our scenes with a prescribed motion of the coupled points.

What its users run into, and what is done about it here:

- ``dtM`` is always written: the step it chooses by itself blows up on chains.
- A coupled point moves as ``x + v t`` within one call. Fed the chord of the motion, its position is right at both ends
  of each call and its velocity in the middle.
- Tensions are those of the last evaluation of the derivatives, which for most schemes is not the end of the step
  (``EVALUATED_AT``).
- ``GetLineFairTen`` is the tension of the end segment, damping included; no weight, drag or inertia of the half segment.
- Decks are split at blanks only, so no tabs are written. Output files and the time on the console are switched off.
"""

import os
import sys
import tempfile
import time
from dataclasses import dataclass

import moordyn
import numpy as np

# where in the last internal step the reported tension belongs, as a fraction of that step
EVALUATED_AT = {"euler": 0.0, "leuler": 0.0, "heun": 0.0, "rk2": 0.5, "rk4": 1.0}

SCHEMES = ("Euler", "LEuler", "Heun", "RK2", "RK4", "AB2", "AB3", "AB4", "BEuler3", "Midpoint3", "Midpoint5", "ACA3", "ACA5", "Wilson3")


class PeerError(RuntimeError):
    """MoorDyn refused the scene or failed on the way."""


@dataclass(frozen=True)
class PeerRun:
    """What a run gave: tensions of the end segments at the samples, and what it cost."""

    times: np.ndarray  # (samples,) s, when the tensions were evaluated
    tension: np.ndarray  # (samples, lines) N
    cpu: float  # s of CPU time in the step calls alone
    simulated: float  # s
    steps: int  # internal time steps

    @property
    def cost(self) -> float:
        """CPU time for one simulated second (s/s)."""
        return self.cpu / self.simulated


def deck(scene, dt, scheme="RK2", segments=None, damping=None, options=()):
    """The scene as MoorDyn's input text, with internal step dt (s); segments and damping (BA) override those of the file."""
    env = scene.environment
    if any(env.current):
        raise PeerError("the peer deck does not carry a current")
    rows = ["mooring_ros benchmark", "---- LINE TYPES ----"]
    rows += ["Name Diam Mass EA BA EI Cd Ca CdAx CaAx", "(-) (m) (kg/m) (N) (N-s/-) (N-m2) (-) (-) (-) (-)"]
    for k in scene.line_types:
        ba = k.damping if damping is None else damping
        values = (k.diameter, k.mass, k.stiffness, ba, k.bending_stiffness, k.drag_normal, k.added_mass_normal, k.drag_axial, k.added_mass_axial)
        rows.append(" ".join([k.name, *map(repr, map(float, values))]))
    rows += ["---- POINTS ----", "ID Type X Y Z M V CdA Ca", "(#) (-) (m) (m) (m) (kg) (m3) (m2) (-)"]
    for p in scene.points:
        values = (*p.position, p.mass, p.volume, p.drag_area, p.added_mass)
        rows.append(" ".join([str(p.id), p.kind.capitalize(), *map(repr, map(float, values))]))
    rows += ["---- LINES ----", "ID Type A B Len N Out", "(#) (-) (#) (#) (m) (-) (-)"]
    for n in scene.lines:
        rows.append(f"{n.id} {n.type.name} {n.end_a} {n.end_b} {float(n.length)!r} {segments or n.segments} -")
    rows += ["---- OPTIONS ----", f"{float(dt)!r} dtM", f"{scheme} tScheme"]
    rows += [f"{env.gravity!r} g", f"{env.water_density!r} WtrDnsty", f"{env.depth!r} WtrDpth"]
    rows += [f"{env.bed_stiffness!r} kBot", f"{env.bed_damping!r} cBot"]
    rows += ["2.0 dtIC", "200 TmaxIC", "1e-5 threshIC", "4 CdScaleIC", "0 writeLog", "1 disableOutput", "1 disableOutTime"]
    rows += [*options, "---- END ----", ""]
    return "\n".join(rows)


def coupled_positions(scene):
    """Positions (points, 3) in m of the coupled points at the platform's zero pose, in the file's order."""
    return np.array([p.position for p in scene.points if p.kind == "coupled"])


def run(scene, motion, dt, scheme="RK2", segments=None, damping=None, steps_per_call=1, sample=0.05, options=(), until=None):
    """Run MoorDyn from rest to the motion's end; tensions every ``sample`` s, rounded to whole calls.

    ``motion.displacement(t)`` moves all coupled points alike. Raises PeerError when MoorDyn fails or returns no number.
    """
    end = until or motion.end
    dt = float(dt)
    call = dt * steps_per_call
    calls = int(np.ceil(end / call - 1e-9))
    edges = call * np.arange(calls + 1)
    moved, _ = motion.displacement(edges)
    at = (coupled_positions(scene)[None] + moved[:, None]).reshape(calls + 1, -1)
    chord = np.diff(at, axis=0) / call
    positions, velocities = at[:-1].tolist(), chord.tolist()  # ready before the clock starts
    every = max(1, round(sample / call))

    with tempfile.TemporaryDirectory(prefix="moordyn_") as folder, _silence():
        path = os.path.join(folder, "lines.txt")
        with open(path, "w", encoding="utf-8") as file:
            file.write(deck(scene, dt, scheme, segments, damping, options))
        system = moordyn.Create(path)
        if system is None:
            raise PeerError("MoorDyn refused the deck")
        try:
            moordyn.SetVerbosity(system, moordyn.LEVEL_NONE)
            if moordyn.Init(system, at[0].tolist(), [0.0] * at.shape[1]) != 0:
                raise PeerError("MoorDyn found no initial state")
            lines = [moordyn.GetLine(system, n.id) for n in scene.lines]
            return _advance(system, lines, positions, velocities, edges, call, dt, scheme, every)
        finally:
            moordyn.Close(system)


def _advance(system, lines, positions, velocities, edges, call, dt, scheme, every):
    times, tensions = [], []
    step, tension = moordyn.Step, moordyn.GetLineFairTen
    late = (1.0 - EVALUATED_AT.get(scheme.lower(), 1.0)) * dt
    began = time.process_time()
    try:
        for k in range(len(positions)):
            step(system, positions[k], velocities[k], edges[k], call)
            if (k + 1) % every == 0:
                times.append(edges[k + 1] - late)
                tensions.append([tension(n) for n in lines])
    except (RuntimeError, ValueError) as error:
        raise PeerError(f"MoorDyn stopped at {edges[k]:.3f} s: {error}") from None
    cpu = time.process_time() - began
    tensions = np.array(tensions)
    if not np.all(np.isfinite(tensions)):
        raise PeerError("MoorDyn returned no number")
    return PeerRun(np.array(times), tensions, cpu, float(edges[-1]), round(edges[-1] / dt))


class _silence:
    """Keep what MoorDyn's library writes to the console (it does so below Python) out of our tables."""

    def __enter__(self):
        sys.stdout.flush()
        sys.stderr.flush()
        self.null = os.open(os.devnull, os.O_WRONLY)
        self.kept = [os.dup(1), os.dup(2)]
        os.dup2(self.null, 1)
        os.dup2(self.null, 2)

    def __exit__(self, *_):
        for number, kept in zip((1, 2), self.kept, strict=True):
            os.dup2(kept, number)
            os.close(kept)
        os.close(self.null)
