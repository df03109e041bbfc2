"""Explicit schemes: their coefficients and where they are stable.

A mode of the lines has lambda^2 + 2 zeta w lambda + w^2 = 0. Internal damping grows with w^2, so the modes of a line whose stiffest mode is
critically damped fill a disc of the left half plane that touches the origin.

`leapfrog`: v += h a(x, v); x += h v. One evaluation a step; stable to h w = 2 (sqrt(1 + zeta^2) - zeta).

`stabilised(s)`: y_k = y_0 + alpha_k h f(y_{k-1}), k = 1..s, second order (alpha_{s-1} = 1/2, alpha_s = 1). The alphas make the disc on which
its polynomial is at most one as large as s stages allow, with damping, not growth, next to the imaginary axis (c_3 - c_4 > 1/8), where the
lightly damped transverse modes are. Found by linear programming over the polynomial's coefficients (benchmarks/stability_polynomials.py).
"""

import numpy as np

LEAPFROG = 1  # a "scheme" is its number of evaluations a step

# alpha_1 .. alpha_{s-1} and the radius of the stable disc; alpha_s = 1
_STABILISED = {
    3: ((0.256, 0.5), 1.5149),
    4: ((0.11629, 0.28969, 0.5), 2.387),
    5: ((0.0649, 0.16085, 0.30507, 0.5), 3.2753),
    6: ((0.0415, 0.09963, 0.18493, 0.31408, 0.5), 4.1746),
    7: ((0.02885, 0.06741, 0.12118, 0.19988, 0.31995, 0.5), 5.0811),
    8: ((0.02123, 0.04858, 0.08507, 0.13584, 0.21008, 0.32408, 0.5), 5.9925),
}
STAGES = tuple(_STABILISED)
SAFETY = 0.95  # of the stable step


def alphas():
    """(max stages + 1, max stages) table for the kernel: row s holds alpha_1 .. alpha_s."""
    most = max(STAGES)
    table = np.zeros((most + 1, most))
    for s, (inner, _) in _STABILISED.items():
        table[s, : s - 1] = inner
        table[s, s - 1] = 1.0
    return table


def polynomial(stages):
    """Coefficients c_0 .. c_s of the stability polynomial: c_{k+1} = c_k alpha_{s-k}."""
    inner, _ = _STABILISED[stages]
    coefficients = [1.0]
    for alpha in reversed((*inner, 1.0)):
        coefficients.append(coefficients[-1] * alpha)
    return np.array(coefficients)


def disc_radius(stages):
    """Radius R of the disc |z + R| <= R on which the scheme is stable."""
    return _STABILISED[stages][1]


def imaginary_extent(stages):
    """Largest y with the scheme stable on all of [0, iy]."""
    y = np.linspace(0.0, 1.2 * stages, 4000)
    unstable = np.abs(np.polyval(polynomial(stages)[::-1], 1j * y)) > 1.0 + 1e-12
    return float(y[np.argmax(unstable) - 1])


def stable_step(scheme, omega, zeta):
    """Largest stable h (s) for a family of modes w s, damping ratio zeta s, s in (0, 1], with w = `omega` (rad/s)."""
    if omega <= 0.0:
        return np.inf
    if scheme == LEAPFROG:
        return 2.0 * (np.sqrt(1.0 + zeta**2) - zeta) / omega
    share = np.linspace(0.02, 1.0, 100)
    ratio = zeta * share
    root = np.sqrt((ratio**2 - 1.0).astype(complex))
    modes = np.concatenate([share * (-ratio + root), share * (-ratio - root)])
    coefficients = polynomial(scheme)[::-1]
    # growing steps: the first one that leaves the stable region counts, not an island beyond it
    steps = np.linspace(0.0, 2.2 * disc_radius(scheme), 1200)[1:]
    unstable = (np.abs(np.polyval(coefficients, np.outer(steps, modes))) > 1.0 + 1e-9).any(axis=1)
    first = np.argmax(unstable) if unstable.any() else len(steps)
    return float(steps[first - 1] / omega) if first > 0 else 0.0


def step_table(axial_limits, largest_step=np.inf):
    """(schemes, 5) table for the kernel: evaluations, largest step (s), and the factors of `water_loads` and `set_bed_relief` on h, h, h^2.

    `axial_limits` maps schemes to their stable step. The factors leave the disc (or the leapfrog's budget of 4) room for the axial modes.
    """
    rows = []
    for scheme, limit in axial_limits.items():
        step = min(SAFETY * limit, largest_step)
        if scheme == LEAPFROG:
            rows.append((1.0, step, 1.0 / 0.9, 4.0, 2.0))
        else:
            radius = disc_radius(scheme)
            rows.append((float(scheme), step, 1.0 / (0.9 * radius), 1.0 / radius, imaginary_extent(scheme) ** -2))
    return np.array(rows)
