"""MoorDyn (C++, the Python package ``moordyn``) on one of our scenes with a prescribed motion of the coupled points.

What its users run into, and what is done about it here:

- ``dtM`` is always written: the step it chooses by itself blows up on chains.
- A coupled point moves as ``x + v t`` within one call. Fed the chord of the motion, its position is right at both ends
  of each call and its velocity in the middle.
- Tensions are those of the last evaluation of the derivatives, which for most schemes is not the end of the step
  (``EVALUATED_AT``).
- ``GetLineFairTen`` is the tension of the end segment, damping included; no weight, drag or inertia of the half segment.
- A rod without segments takes its direction from its lines, also when it is coupled: an end that is to be clamped needs a rod with a length.
- The initial state that it finds by itself (from 2.7 on) need not be one: of the RM3 cable it is 8 m off. ``ICgenDynamic`` lets the lines swing
  out instead.
- Output files and the time on the console are switched off.
"""

import os
import sys
import tempfile
import time
from dataclasses import dataclass

import moordyn
import numpy as np

from .moordyn_deck import DeckError, coupled_freedoms, deck, files

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
    probed: np.ndarray  # (samples, ...) what the probe gave

    @property
    def cost(self) -> float:
        """CPU time for one simulated second (s/s)."""
        return self.cpu / self.simulated


def run(scene, motion, dt, scheme="RK2", segments=None, damping=None, steps_per_call=1, sample=0.05, options=(), until=None, probe=None, friction=True):
    """Run MoorDyn from rest to the motion's end; tensions every ``sample`` s, rounded to whole calls.

    ``motion.displacement(t)`` moves all coupled points and rods alike. ``probe(lines)`` is called with MoorDyn's line objects at each sample.
    Raises PeerError when MoorDyn fails or returns no number.
    """
    end = until or motion.end
    dt = float(dt)
    call = dt * steps_per_call
    calls = int(np.ceil(end / call - 1e-9))
    every = max(1, round(sample / call))

    with tempfile.TemporaryDirectory(prefix="moordyn_") as folder, silence():
        try:
            texts = {"lines.txt": deck(scene, dt, scheme, segments, damping, options, friction, folder), **files(scene)}
            drive = _Drive(scene, motion, call, calls)
        except DeckError as error:
            raise PeerError(str(error)) from None
        for name, text in texts.items():
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        system = moordyn.Create(os.path.join(folder, "lines.txt"))
        if system is None:
            raise PeerError("MoorDyn refused the deck")
        try:
            moordyn.SetVerbosity(system, moordyn.LEVEL_NONE)
            if moordyn.Init(system, drive.start, [0.0] * len(drive.start)) != 0:
                raise PeerError("MoorDyn found no initial state")
            lines = [moordyn.GetLine(system, n.id) for n in scene.lines]
            return _advance(system, lines, drive, dt, scheme, every, probe)
        finally:
            moordyn.Close(system)


class _Drive:
    """Where the coupled points and rods stand at the edges of the calls, and the chords between them, block by block."""

    BLOCK = 20000  # calls

    def __init__(self, scene, motion, call, calls):
        self.motion, self.call, self.calls = motion, call, calls
        places, self.freedoms = coupled_freedoms(scene)
        self.columns = np.array([first + k for first, _ in places for k in range(3)], dtype=int)
        self.zero = np.zeros(self.freedoms)
        self.zero[self.columns] = np.array([place for _, place in places]).ravel()
        self.start = self.at(np.zeros(1))[0].tolist()

    def at(self, times):
        """Freedoms (times, freedoms); only the first three of a rod move."""
        moved, _ = self.motion.displacement(times)
        values = np.repeat(self.zero[None], len(times), axis=0)
        values[:, self.columns] += np.tile(moved, len(self.columns) // 3)
        return values

    def blocks(self):
        """Lists of (time, freedoms, their rates) of the calls, a block at a time."""
        for first in range(0, self.calls, self.BLOCK):
            edges = self.call * np.arange(first, min(first + self.BLOCK, self.calls) + 1)
            at = self.at(edges)
            yield list(zip(edges[:-1].tolist(), at[:-1].tolist(), (np.diff(at, axis=0) / self.call).tolist(), strict=True))


def _advance(system, lines, drive, dt, scheme, every, probe):
    times, tensions, probed = [], [], []
    step, tension = moordyn.Step, moordyn.GetLineFairTen
    late = (1.0 - EVALUATED_AT.get(scheme.lower(), 1.0)) * dt
    done, cpu, now, clock = 0, 0.0, 0.0, time.process_time
    try:
        for block in drive.blocks():
            began = clock()
            for now, position, velocity in block:
                step(system, position, velocity, now, drive.call)
                done += 1
                if done % every == 0:
                    paused = clock()
                    times.append(now + drive.call - late)
                    tensions.append([tension(n) for n in lines])
                    if probe is not None:
                        probed.append(probe(lines))
                    began += clock() - paused
            cpu += clock() - began
    except (RuntimeError, ValueError) as error:
        raise PeerError(f"MoorDyn stopped at {now:.3f} s: {error}") from None
    tensions = np.array(tensions)
    if not np.all(np.isfinite(tensions)):
        raise PeerError("MoorDyn returned no number")
    simulated = drive.calls * drive.call
    return PeerRun(np.array(times), tensions, cpu, simulated, round(simulated / dt), np.array(probed))


class silence:
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
