"""Ropes whose tension is not EA times the strain: load-strain curves, and the two-Kelvin form of viscoelastic ropes.

Two Kelvin elements in series, each a spring beside a damper: the slow one, EA_1 and BA_1, has the strain `creep`, and the fast one, EA_D
and BA_D, has the rest. Both carry the same tension, so that

    d creep/dt = (BA_D d strain/dt + EA_D strain - (EA_1 + EA_D) creep) / (BA_1 + BA_D),    T = EA_1 creep + BA_1 d creep/dt

(Hall et al., IOWTC2023-119374; MoorDyn's ElasticMod 2, where EA_S = EA_1 EA_D/(EA_1 + EA_D) and BA_S = BA_1 are what the file says).
MoorDyn lets the damper's part push and goes on with the slow strain as if the rope were taut. Here a rope pulls or is slack: it is
slack where the law would push, and where it would push if the ends stood still (dampers alone tighten nothing, as in a plain line). Only
the slow element's own spring then acts on the slow strain, which recovers: EA_1 creep + BA_1 d creep/dt = 0.
"""

from typing import NamedTuple

import numpy as np

from .cache import kernel, stage
from .packed import packed

SETTLED = 1e30  # s: the step of `rope_tensions` at which it is the law at rest
QUICKEST = 3.0  # shortest time constant BA_1/EA_1 of a slow element, over 1/w of the segment's own axial wave, w = (2/l) sqrt(EA_D/m)


@packed
class Ropes(NamedTuple):
    """The ropes of a mooring; every array has size 0 when there are none of its kind."""

    # lines with a load-strain curve, (c,)
    curve_first: np.ndarray  # first segment
    curve_count: np.ndarray  # segments
    curve_row: np.ndarray  # (c + 1,) first row of each in the table of all
    strain: np.ndarray  # (rows,) where the pieces begin
    load: np.ndarray  # (rows,) N, there
    slope: np.ndarray  # (rows,) N, of the piece that begins there; the last piece goes on
    # lines in two-Kelvin form, (k,)
    kelvin_first: np.ndarray
    kelvin_count: np.ndarray
    slow_stiffness: np.ndarray  # EA_1, N
    slow_damping: np.ndarray  # BA_1, N s
    fast_stiffness: np.ndarray  # EA_D, N
    fast_damping: np.ndarray  # BA_D, N s


def build_ropes(lines):
    """Ropes of `lines`, a list of (LineType, first node, segments, unstretched length of a segment in m)."""
    curves = [(kind, first, count) for kind, first, count, _ in lines if kind.curve]
    tables = [np.array(kind.curve, dtype=float) for kind, _, _ in curves]
    slopes = [np.diff(table[:, 1]) / np.diff(table[:, 0]) for table in tables]
    kelvin = [(kind, first, count, length) for kind, first, count, length in lines if kind.slow_stiffness > 0.0]
    return Ropes(
        curve_first=_integers(first + 1 for _, first, _ in curves),
        curve_count=_integers(count for _, _, count in curves),
        curve_row=_integers(np.cumsum([0] + [slope.size for slope in slopes])),
        strain=_joined(table[:-1, 0] for table in tables),
        load=_joined(table[:-1, 1] for table in tables),
        slope=_joined(slopes),
        kelvin_first=_integers(first + 1 for _, first, _, _ in kelvin),
        kelvin_count=_integers(count for _, _, count, _ in kelvin),
        slow_stiffness=_floats(kind.slow_stiffness for kind, *_ in kelvin),
        slow_damping=_floats(_slow_damping(kind, length) for kind, _, _, length in kelvin),
        fast_stiffness=_floats(kind.stiffness for kind, *_ in kelvin),
        fast_damping=_floats(rope_damping(kind, length) for kind, _, _, length in kelvin),
    )


def _integers(values):
    return np.array(list(values), dtype=np.int64)


def _floats(values):
    return np.array(list(values), dtype=float)


def _joined(arrays):
    return np.concatenate([np.zeros(0), *arrays])


def series_stiffness(kind):
    """EA at rest of a LineType in two-Kelvin form, N."""
    return kind.stiffness * kind.slow_stiffness / (kind.stiffness + kind.slow_stiffness)


def rope_damping(kind, length):
    """BA (N s) that goes with the rate of the strain, of a segment of `length` (m); of a two-Kelvin rope BA_D.

    A negative entry is the fraction of critical, by EA; with a curve, by the secant to its last row, as in MoorDyn.
    """
    if kind.damping >= 0.0:
        return kind.damping
    stiffness = kind.curve[-1][1] / kind.curve[-1][0] if kind.curve else kind.stiffness
    return -kind.damping * length * np.sqrt(stiffness * kind.mass)


def _slow_damping(kind, length):
    """BA_1 in N s; a negative entry is the fraction of critical, by EA_S, as in MoorDyn.

    At least QUICKEST: a slow element that follows the quickest waves of the mesh would take from them the fast element's damping, by which
    the explicit step is chosen, and one without a damper is not a differential equation. Slower motion does not notice.
    """
    damping = kind.slow_damping
    if damping < 0.0:
        damping *= -length * np.sqrt(series_stiffness(kind) * kind.mass)
    wave = 0.5 * length * np.sqrt(kind.mass / kind.stiffness)  # s
    return max(damping, QUICKEST * wave * kind.slow_stiffness)


def rope_limits(kind, length):
    """(EA in N, BA in N s) of the line without creep whose axial limit of the explicit step holds for a segment of `length` (m) of `kind`.

    The steepest piece of a curve; the fast element of a two-Kelvin rope, because the slow one in series only takes from it.
    """
    steepest = max((t1 - t0) / (e1 - e0) for (e0, t0), (e1, t1) in zip(kind.curve, kind.curve[1:])) if kind.curve else kind.stiffness
    return steepest, rope_damping(kind, length)


@stage
def _piece(table, first, last, value):
    """The row of rows first..last, growing, at or below `value`; the first for what is below them all."""
    low, high = first, last + 1
    while high - low > 1:
        middle = (low + high) // 2
        if table[middle] <= value:
            low = middle
        else:
            high = middle
    return low


@stage
def _stretched(x, y, z, i):
    dx, dy, dz = x[i + 1] - x[i], y[i + 1] - y[i], z[i + 1] - z[i]
    return np.sqrt(dx * dx + dy * dy + dz * dz)


@kernel
def rope_tensions(ropes, step, position, inverse_length, damping, length_rate, tension, creep, creep_rate):
    """Overwrite the tension (n,) of the ropes' segments, and give the rate of their slow strain (1/s).

    `step` (s) is the Euler step that will be taken with `creep_rate` (n,). The slow strain relaxes at the rate w = (EA_1 + EA_D)/(BA_1 +
    BA_D), and is taken linearly implicitly over the share z/(1 + z) of the step, z = w step: an Euler step then multiplies its distance
    from rest by 1/(1 + z + z^2), which is 1 - z but for z^3, so that schemes made of Euler steps keep their second order, and which
    is in 0..1 for every z. Zero: the plain law; SETTLED: the law at rest, whatever `creep` is. `position` (3, n), m; `inverse_length` (n,),
    1/m; `damping` (n,): BA/l, N s/m; `length_rate` (n,), m/s; `creep` (n,).
    """
    x, y, z = position[0], position[1], position[2]
    for c in range(ropes.curve_first.size):
        first = ropes.curve_first[c]
        for i in range(first, first + ropes.curve_count[c]):
            strain = _stretched(x, y, z, i - 1) * inverse_length[i] - 1.0
            row = _piece(ropes.strain, ropes.curve_row[c], ropes.curve_row[c + 1] - 1, strain)
            pull = ropes.load[row] + ropes.slope[row] * (strain - ropes.strain[row]) + damping[i] * length_rate[i]
            tension[i] = max(pull, 0.0) if strain > 0.0 else 0.0
    for k in range(ropes.kelvin_first.size):
        slow, slow_damper = ropes.slow_stiffness[k], ropes.slow_damping[k]
        fast, fast_damper = ropes.fast_stiffness[k], ropes.fast_damping[k]
        stiffness, damper = slow + fast, slow_damper + fast_damper
        taut_ahead = step * (step * stiffness / (damper + step * stiffness))
        slack_ahead = step * (step * slow / (slow_damper + step * slow))
        taut = 1.0 / (damper + taut_ahead * stiffness)
        share = (slow_damper + taut_ahead * slow) * taut  # of the fast element's force that the slow one lets through
        slack = slow / (slow_damper + slack_ahead * slow)
        first, last = ropes.kelvin_first[k], ropes.kelvin_first[k] + ropes.kelvin_count[k]
        # views from the first segment on: without an offset in the index the loop is vectorized
        x, y, z = position[0, first - 1 : last], position[1, first - 1 : last], position[2, first - 1 : last]
        inverse, stretching = inverse_length[first:last], length_rate[first:last]
        pulls, strain_1, rate_1 = tension[first:last], creep[first:last], creep_rate[first:last]
        for i in range(last - first):
            strain = _stretched(x, y, z, i) * inverse[i] - 1.0
            damping_force = fast_damper * inverse[i] * stretching[i]
            rate = taut * (damping_force + fast * strain - stiffness * strain_1[i])
            pull = slow * (strain_1[i] + taut_ahead * rate) + slow_damper * rate
            tight = (pull > max(share * damping_force, 0.0)) & (strain > 0.0)
            pulls[i] = pull if tight else 0.0
            rate_1[i] = rate if tight else -slack * strain_1[i]


@kernel
def rope_statics(ropes, tension, stiffness, slack_strain):
    """The law at rest about the given `tension` (n,) as T = stiffness (strain - slack_strain): fills both (n,; N and 1) for the ropes' segments."""
    for c in range(ropes.curve_first.size):
        first = ropes.curve_first[c]
        for i in range(first, first + ropes.curve_count[c]):
            row = _piece(ropes.load, ropes.curve_row[c], ropes.curve_row[c + 1] - 1, tension[i])
            stiffness[i] = ropes.slope[row]
            slack_strain[i] = ropes.strain[row] - ropes.load[row] / ropes.slope[row]
    for k in range(ropes.kelvin_first.size):
        slow, fast = ropes.slow_stiffness[k], ropes.fast_stiffness[k]
        first = ropes.kelvin_first[k]
        for i in range(first, first + ropes.kelvin_count[k]):
            stiffness[i] = slow * fast / (slow + fast)
            slack_strain[i] = 0.0


@kernel
def settle_creep(ropes, tension, creep):
    """The slow strain (n,) that has come to rest under `tension` (n,)."""
    for k in range(ropes.kelvin_first.size):
        first = ropes.kelvin_first[k]
        for i in range(first, first + ropes.kelvin_count[k]):
            creep[i] = tension[i] / ropes.slow_stiffness[k]
