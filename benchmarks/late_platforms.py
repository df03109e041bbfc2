"""Two floaters on moorings that they share, whose forces come late: what each mode loses of its damping, and what the node's prediction gives back.

A session of the node answers their surge; the lines are linear and nothing else damps, so that the modes are exact and lose ω τ / 2.
"""

import math
from pathlib import Path

import numpy as np

from mooring_ros.mooring import Mooring
from mooring_ros.motion import Adapter, Sample
from mooring_ros.motion.ensemble import Ensemble, OfPlatform
from mooring_ros.node.output import Output
from mooring_ros.node.session import Session

from . import tables

SCENE = Path(__file__).parents[1] / "config" / "scenes" / "oc4_pair.txt"
NAMES = ("body1", "body2")
STEP = 0.02  # s
DELAYS = (0.04, 0.14, 0.36)  # s at full scale: 5, 20 and 50 ms at 1:50
OMEGA = 0.6  # rad/s of one floater while the other is held
AMPLITUDE = 0.05  # m
PERIODS = 4
GOAL = 0.9


class LatePair:
    """Both floaters, free in surge on linear lines. omegas (2,) rad/s, shapes (2, 2) in rows: of their modes."""

    def __init__(self):
        self._mooring = Mooring(SCENE, "linear", platforms=NAMES)
        self._home = self._mooring.pose_in_file
        self._mooring.settle(self._home)
        self._still = self._mooring.wrench[:, 0]
        stiffness = self._mooring.stiffness()[::6, ::6]
        self._mass = stiffness[0, 0] / OMEGA**2
        squares, shapes = np.linalg.eigh(stiffness / self._mass)
        self.omegas, self.shapes = np.sqrt(squares), shapes.T

    def damping(self, mode, delay, compensate):
        """Damping ratio of a mode (0, 1) when the forces act `delay` s late; compensate: as the node's parameter, off or given."""
        session = Session(self._mooring.twin(), Ensemble(NAMES, Adapter()), Output(totals=2), clock=lambda: 0)
        session.delay.mode, session.delay.seconds = compensate, delay
        omega, shape, late = self.omegas[mode], self.shapes[mode], round(delay / STEP)
        x, v, forces, peaks = AMPLITUDE * shape, np.zeros(2), [], []
        for k in range(round(2.0 * PERIODS * math.pi / (omega * STEP))):
            forces.append(self._answer(session, k, x, v) - self._still)
            before = shape @ v
            v = v + STEP * forces[max(k - late, 0)] / self._mass
            x = x + STEP * v
            if before > 0.0 >= shape @ v:
                peaks.append((k, shape @ x))
        (begin, high), (end, low) = peaks[0], peaks[-1]
        return math.log(high / low) / (omega * STEP * (end - begin))

    def _answer(self, session, k, x, v):
        """Surge forces (2,) N of the session's answer to step k."""
        for own, home in enumerate(self._home):
            pose, twist = (home[0] + x[own], *home[1:]), (v[own], 0.0, 0.0, 0.0, 0.0, 0.0)
            session.take(OfPlatform(own, Sample(round(1e9 * STEP * k), pose, twist, "", "", "world")), None)
        return session.wrenches[:2, 0]


def run(quick=False):
    """Prints the table."""
    pair, rows, failed = LatePair(), [], []
    for delay in DELAYS[1:2] if quick else DELAYS:
        for mode, omega in enumerate(pair.omegas):
            lost, left = (-pair.damping(mode, delay, compensate) for compensate in ("off", "given"))
            removed = 1.0 - abs(left / lost)
            case = f"{omega:.3f} rad/s, {1e3 * delay:g} ms"
            rows.append([case, f"{50 * omega * delay:.3f}", f"{100 * lost:.3f}", f"{100 * left:.4f} ({100 * removed:.1f} %)"])
            if removed < GOAL:
                failed.append(f"late_platforms: {100 * removed:.0f} % removed at {case}, goal {100 * GOAL:g} %")
    content = {"late_platforms": tables.table(["mode and delay", "ω τ / 2 (%)", "lost (% of critical)", "predicted: lost (removed)"], rows)}
    print(content["late_platforms"], flush=True)
    return {"tables": content, "failed": failed}
