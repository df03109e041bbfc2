"""A spring that answers late, and the motion predicted by the delay, known exactly or by cameras: what is lost of the damping."""

import math

import numpy as np

from mooring_ros.motion import Predictor
from mooring_ros.motion.gate import DEFAULT_BANDWIDTH
from mooring_ros.motion.tracking import PoseFilter

from . import tables
from .camera_frames import NOISE, RATE

STEP = 0.001  # s
OMEGAS = (0.444, 2.0, 2.0 * math.pi)  # rad/s: surge of a floater of 100 s at 1:50, and faster
DELAYS = (0.005, 0.02, 0.05)  # s
GOAL = 0.9
LEVEL = (0.0, 0.0, 0.0, 1.0)
AMPLITUDE = 0.04  # m, of which the cameras' noise is a share
BANDWIDTH = DEFAULT_BANDWIDTH * 50.0**0.5  # Hz, at 1:50
HELD = round(1.0 / RATE / STEP)  # steps between two frames: the force is held so long


class Cameras:
    """Frames with noise, filtered; between two of them the last answer stands. What the rest sees: the predicted place."""

    def __init__(self, lead):
        self._filter, self._predictor, self._noise = PoseFilter(1.0 / RATE, BANDWIDTH), Predictor(lead), np.random.default_rng(5)
        self._seen = 0.0

    def place(self, k, x, v):
        if k % HELD == 0:
            measured = x + NOISE / AMPLITUDE * self._noise.standard_normal()
            estimate = self._filter.propose(STEP * k, (measured, 0.0, 0.0, *LEVEL))
            self._filter.take(estimate)
            self._seen = self._predictor.predict(estimate.time, estimate.pose, estimate.twist, estimate.acceleration)[1][0]
        return self._seen


class Exact:
    """The motion as it is."""

    def __init__(self, lead):
        self._predictor = Predictor(lead)

    def place(self, k, x, v):
        return self._predictor.predict(STEP * k, (x, 0.0, 0.0, *LEVEL), (v, 0.0, 0.0, 0.0, 0.0, 0.0))[1][0]


def damping(omega, delay, source):
    """Damping ratio of x'' = -omega² x(t - delay) without any other, from its peaks over ten periods; the spring answers what the source sees."""
    late = round(delay / STEP)
    x, v, answers, peaks = 1.0, 0.0, [], []
    for k in range(round(20.0 * math.pi / (omega * STEP))):
        answers.append(-omega * omega * source.place(k, x, v))
        before = v
        v += STEP * (answers[k - late] if k >= late else -omega * omega * x)
        x += STEP * v
        if before > 0.0 >= v:
            peaks.append((k, x))
    (begin, first), (end, last) = peaks[0], peaks[-1]
    return math.log(first / last) / (omega * STEP * (end - begin))


def lost(omega, delay, predicted, cameras=False):
    """By how much the delay lowers the damping ratio, with the motion predicted by it or not; with cameras, by half of a hold more."""
    lead = delay + 0.5 * (HELD - 1) * STEP * cameras if predicted else 0.0
    return damping(omega, 0.0, Exact(0.0)) - damping(omega, delay, (Cameras if cameras else Exact)(lead))


def run(quick=False):
    """Prints the table."""
    rows, failed = [], []
    for omega in OMEGAS[1:2] if quick else OMEGAS:
        for delay in DELAYS:
            without, *left = lost(omega, delay, False), lost(omega, delay, True), lost(omega, delay, True, cameras=True)
            shares = [1.0 - abs(value / without) for value in left]
            removed = min(shares)
            rows.append([f"{omega:.3g} rad/s, {1e3 * delay:g} ms", f"{50 * omega * delay:.4f}", f"{100 * without:.4f}",
                         *(f"{100 * value:.4f} ({100 * share:.1f} %)" for value, share in zip(left, shares))])
            if shares[0] < GOAL or delay == 0.02 and removed < GOAL:
                failed.append(f"late_spring: {100 * removed:.0f} % removed at {omega:.3g} rad/s and {1e3 * delay:g} ms, goal {100 * GOAL:g} %")
    header = ["frequency and delay", "ω τ / 2 (%)", "lost (% of critical)", "predicted: lost (removed)", "by cameras: lost (removed)"]
    content = {"late_spring": tables.table(header, rows)}
    print(content["late_spring"], flush=True)
    return {"tables": content, "failed": failed}
