"""A spring that answers late, and the motion predicted by the delay: what is lost of the damping, and what is left of the loss."""

import math

from mooring_ros.motion import Predictor

from . import tables

STEP = 0.001  # s
OMEGAS = (0.444, 2.0, 2.0 * math.pi)  # rad/s: surge of a floater of 100 s at 1:50, and faster
DELAYS = (0.005, 0.02, 0.05)  # s
GOAL = 0.9


def damping(omega, delay, predictor):
    """Damping ratio of x'' = -omega² x(t - delay) without any other, from its peaks over ten periods; the spring answers the predicted samples."""
    late = round(delay / STEP)
    x, v, answers, peaks = 1.0, 0.0, [], []
    for k in range(round(20.0 * math.pi / (omega * STEP))):
        _, pose, _ = predictor.predict(STEP * k, (x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0), (v, 0.0, 0.0, 0.0, 0.0, 0.0))
        answers.append(-omega * omega * pose[0])
        before = v
        v += STEP * (answers[k - late] if k >= late else -omega * omega * x)
        x += STEP * v
        if before > 0.0 >= v:
            peaks.append((k, x))
    (begin, first), (end, last) = peaks[0], peaks[-1]
    return math.log(first / last) / (omega * STEP * (end - begin))


def lost(omega, delay, predicted):
    """By how much the delay lowers the damping ratio, with the motion predicted by it or not."""
    return damping(omega, 0.0, Predictor()) - damping(omega, delay, Predictor(delay if predicted else 0.0))


def run(quick=False):
    """Prints the table."""
    rows, failed = [], []
    for omega in OMEGAS[1:2] if quick else OMEGAS:
        for delay in DELAYS:
            without, left = lost(omega, delay, False), lost(omega, delay, True)
            removed = 1.0 - abs(left / without)
            rows.append([f"{omega:.3g} rad/s, {1e3 * delay:g} ms", *(f"{100 * value:.4f}" for value in (0.5 * omega * delay, without, left)), f"{100 * removed:.1f}"])
            if removed < GOAL:
                failed.append(f"late_spring: prediction removes {100 * removed:.0f} % at {omega:.3g} rad/s and {1e3 * delay:g} ms, goal {100 * GOAL:g} %")
    content = {"late_spring": tables.table(["frequency and delay", "ω τ / 2 (%)", "lost (% of critical)", "lost, predicted", "removed (%)"], rows)}
    print(content["late_spring"], flush=True)
    return {"tables": content, "failed": failed}
