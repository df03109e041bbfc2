"""Explicit schemes, and where they are stable.

A mode of the lines has lambda^2 + 2 zeta w lambda + w^2 = 0. Internal damping grows with w^2, so the modes of a line whose stiffest mode is
critically damped lie on a circle of the left half plane that touches the origin: the stability region of Euler steps.

`axial`: leapfrog with the axial forces taken implicitly (axial.py): stable for them at any step.

`leapfrog`: v += h a(x, v); x += h v. One evaluation a step; stable to h w = 2 (sqrt(1 + zeta^2) - zeta).

`ssp(s)`: s - 1 Euler steps of h/(s - 1), one more, and the mean of its result (weight 1 - 1/s) with the step's start (1/s): second order,
and the largest disc, radius (s - 1)/h, that s evaluations allow (the strong stability preserving schemes of Spiteri and Ruuth 2002).
Being a convex combination of Euler steps it keeps what one of them keeps, when segments go slack and nodes hit the bed too. Next to the
imaginary axis it grows by about 0.012 (h w)^4 a step: far below what water takes from the transverse modes that are there, but in a
vacuum leapfrog is the one to use.
"""

import math

import numpy as np

AXIAL, LEAPFROG = 0, 1  # the others are named by their number of evaluations a step
AXIAL_COST = 3.0  # of an evaluation: what one and the solve along the lines take together
SSP = tuple(range(2, 9))
SAFETY = 0.95  # of the stable step


def polynomial(stages):
    """Coefficients, ascending, of the stability polynomial of ssp(stages): (1 + (s - 1) (1 + z/(s - 1))^s) / s."""
    coefficients = np.polynomial.polynomial.polypow([1.0, 1.0 / (stages - 1)], stages) * (stages - 1) / stages
    coefficients[0] += 1.0 / stages
    return coefficients


def stable_step(scheme, omega, zeta):
    """Largest stable h (s) for the modes w s with damping ratio zeta s, s in (0, 1], where w = `omega` (rad/s)."""
    if scheme == LEAPFROG:
        return 2.0 * (math.sqrt(1.0 + zeta**2) - zeta) / omega
    # inside the disc |z + R| <= R, R = s - 1: |lambda|^2 h <= -2 R Re lambda, and h |lambda| <= 2 R where a mode is overdamped
    reach = 2.0 * (scheme - 1) / omega
    return reach * zeta if zeta <= 1.0 else reach / (zeta + math.sqrt(zeta**2 - 1.0))


def step_table(limits, largest_step):
    """(schemes, 4) table for the kernel: scheme, largest step (s), Euler steps in a step, cost in evaluations.

    `limits`: stable step (s) of each scheme that may be used; `largest_step` (s) caps them all.
    """
    return np.array(
        [
            (float(scheme), min(SAFETY * limit, largest_step), max(scheme - 1.0, 1.0), AXIAL_COST if scheme == AXIAL else float(scheme))
            for scheme, limit in sorted(limits.items())
        ]
    )
