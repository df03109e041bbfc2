"""What CableDyn gives and costs on a scene of chains: all lines in one deck, the forces at the fairleads, CPU time without initialisation.

Its driver moves no lines that meet in free points with a prescribed motion, and wants bending stiffness in buoyant lines.
Reading the motion and writing the forces, a row a step, are part of the cost: some hundredths of it.
"""

import os
import resource
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .cabledyn_peer import EXECUTABLE, ROOT, PeerError, chains, deck, depths, prescribed


@dataclass(frozen=True)
class CostRun:
    """Forces of the lines on the platform, and what they cost."""

    times: np.ndarray  # (samples,) s
    force: np.ndarray  # (samples, fairleads) N, size of the end force
    cpu: float  # s, user and system, of the process less that of one that only initialises
    simulated: float  # s

    @property
    def cost(self):
        """CPU time for one simulated second (s/s)."""
        return self.cpu / self.simulated


def run(scene, motion, step, segments=1.0, options=()):
    """Run from rest to the motion's end; ``segments``: elements for each segment of the scene. Raises PeerError when CableDyn fails."""
    steps = int(np.ceil(motion.end / step - 1e-9))
    lines = chains(scene)
    places = {2 * k + 1: chain.top for k, chain in enumerate(lines)}
    cpu = []
    with tempfile.TemporaryDirectory(prefix="cabledyn_") as folder:
        folder = Path(folder)
        if scene.environment.bathymetry is not None:
            (folder / "depths.txt").write_text(depths(scene.environment.bathymetry), encoding="utf-8")
        for count in (0, steps):
            (folder / "motion.txt").write_text(prescribed(step * np.arange(count + 1), places, motion), encoding="utf-8")
            text = deck(scene, lines, step, count * step, segments, friction=friction(scene), outputs="-", options=options)
            (folder / "deck.dat").write_text(text, encoding="utf-8")
            cpu.append(_execute(folder))
        main = np.loadtxt(folder / f"{ROOT}.out", skiprows=2, ndmin=2)
    return CostRun(main[:, 0], np.abs(main[:, 1:]), cpu[1] - cpu[0], steps * step)


def friction(scene):
    """(axial, transverse) coefficients of the bed, which sticks in CableDyn; None where there is none."""
    law = scene.environment.friction
    return law and (law.kinetic_axial, law.kinetic_transverse)


def _execute(folder):
    """CPU time (s) of one process, on one thread."""
    alone = {**os.environ, "OMP_NUM_THREADS": "1", "CABLEDYN_BLAS_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([EXECUTABLE, folder / "deck.dat", folder / ROOT], capture_output=True, text=True, check=False, env=alone)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        raise PeerError("CableDyn failed: " + " ".join((done.stdout + done.stderr).splitlines()[-4:]))
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
