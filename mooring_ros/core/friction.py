"""Laws of bed friction, for one node: the force on it in the bed's tangent plane.

Both are taken implicitly over the Euler step: the force is that of the law at the velocity which the node has after it, so that it stops
a node and never turns it round. `drift` is the velocity (m/s) that the node would have after the step without friction, split along the
line (axial) and across it; `yield_axial` = step / inertia along the line and `yield_across` (s/kg) turn a force into what it takes of it.
"""

import numpy as np

from .cache import stage

NO_FRICTION, SATURATED, STICK = 0, 1, 2  # laws

# Pa/m, of the bed's tangential stiffness, or its normal stiffness where that is more. Before a node slides it gives way elastically by
# mu w / (MODULUS d): 0.03 mm for a chain of 1 kN/m and 0.1 m, whatever the normal stiffness. Strains gather to millimetres in a segment of
# metres, so tensions see a bed that does not give way.
MODULUS = 3e8
ROUNDING = 1e-9  # of the limit: a trial force that passes it by less sticks again
SMALLEST = 1e-300
LEAST = 1e-60  # N, m/s: keeps what is at rest or without load from dividing by zero


@stage
def saturated_part(drift, speed, normal, static, kinetic, ramp, give):
    """(speed-proportional coefficient to apply to the drift, the law's secant) in N s/m for one direction, Housner et al. 2022, eq. 7-12.

    The force is mu_s c_v s while mu_s c_v s is at most mu_s N, and mu_k N beyond, at the speed s after the step: s = drift - give f(s).
    Where both branches hold (mu_s > mu_k), that of the present `speed` goes on.
    """
    sticky = static * ramp
    creep = drift / (1.0 + give * sticky)
    slide = ramp * (drift - give * kinetic * normal) > normal and (ramp * speed > normal or ramp * creep > normal)
    force = kinetic * normal if slide else sticky * creep
    secant = kinetic * normal / max(speed, LEAST) if ramp * speed > normal else sticky
    return force / max(drift, LEAST), secant


@stage
def return_to_ellipse(axial, across, limit_axial, limit_across, give_axial, give_across):
    """Elastic-plastic force for the trial force (axial, across >= 0; N) of a node that stays where it drifts to.

    `limit_*` (N) are the half axes of the ellipse of forces at which it slides, `give_*` how much of the trial force the node's own
    giving way within the step takes, in parts of it. Returns (factor on axial, factor on across, share): the part `share` <= 1 of the
    trial force at the place and velocity after the step, inside or on the ellipse. So friction acts against the slip, whatever the
    inertia in both directions.
    """
    a, b = axial / max(limit_axial, LEAST), across / max(limit_across, LEAST)
    a, b = a * a, b * b
    both = max(a + b, SMALLEST)
    inverse = max(np.sqrt(both) - (a * give_axial + b * give_across) / both, 1.0)  # 1/share if both gave way by their weighted mean
    inverse = _sharper(a, b, inverse, give_axial, give_across)
    p, q = _parts(inverse, give_axial, give_across)
    onto = np.sqrt(max(a * p * p + b * q * q, SMALLEST))
    onto = 1.0 / onto if inverse > 1.0 or onto > 1.0 else 1.0
    return p * onto, q * onto, 1.0 / inverse


@stage
def _parts(inverse, give_axial, give_across):
    axial, across = inverse + give_axial, inverse + give_across
    both = 1.0 / (axial * across)
    return across * both, axial * both


@stage
def _sharper(a, b, inverse, give_axial, give_across):
    """A Newton step for the load that reaches the ellipse, on its inverse root, which is almost linear in `inverse`."""
    p, q = _parts(inverse, give_axial, give_across)
    a, b = a * p * p, b * q * q
    load = a + b
    return max(inverse + load * (np.sqrt(load) - 1.0) / max(a * p + b * q, SMALLEST), 1.0)
