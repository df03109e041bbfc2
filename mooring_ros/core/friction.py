"""Laws of bed friction, for one node: the force on it in the bed's tangent plane.

Both are taken implicitly over the Euler step: the force is that of the law at the velocity which the node has after it, so that it stops
a node and never turns it round. `drift` is the velocity (m/s) that the node would have after the step without friction, split along the
line (axial) and across it; `give` (s/kg), the step over the inertia in a direction, turns a force into what it takes of the drift.
"""

import numpy as np

from .cache import stage

NO_FRICTION, SATURATED, STICK = 0, 1, 2  # laws

# Pa/m, of the bed's tangential stiffness, or its normal stiffness where that is more. Before a node slides it gives way elastically by
# mu w / (MODULUS d): 0.03 mm for a chain of 1 kN/m and 0.1 m, whatever the normal stiffness. Strains gather to millimetres in a segment of
# metres, so tensions see a bed that does not give way.
MODULUS = 3e8
ROUNDING = 1e-9  # of the limit: a trial force that passes it by less sticks again
LEAST = 1e-20  # N, m/s: keeps what is at rest or without load from dividing by zero
SMOOTHEST = 1e-12  # coefficient that stands for none
SMALLEST = 1e-300


@stage
def saturated_part(drift, speed, normal, static, kinetic, ramp, give):
    """Force (N) in one direction over the drift in it (m/s), Housner et al. 2022, eq. 7-12.

    The force f is mu_s c_v s while mu_s c_v s is at most mu_s N, and mu_k N beyond, at the speed s after the step: s = drift - give f(s).
    Where both branches hold (mu_s > mu_k), that of the present `speed` goes on.
    """
    sticky = static * ramp
    slower = 1.0 + give * sticky
    slide = ramp * (drift - give * kinetic * normal) > normal and (ramp * speed > normal or ramp * drift > normal * slower)
    return (kinetic * normal if slide else sticky) / (max(drift, LEAST) if slide else slower)


@stage
def return_to_ellipse(axial, across, give_axial, give_across):
    """Elastic-plastic force for the trial force of a node that stays where it drifts to: factors on its axial part and on that across.

    `axial`, `across`: squares of both parts over the forces at which each alone slides. `give_*`: how much of a force the node's own giving
    way within the step takes, in parts of it. The force is the share <= 1 of the trial force at the place and velocity after the step that
    lies inside the ellipse or on it. So friction acts against the slip, whatever the inertia in both directions.
    """
    both = max(axial + across, SMALLEST)
    inverse = max(np.sqrt(both) - (axial * give_axial + across * give_across) / both, 1.0)  # 1/share if both gave way by their weighted mean
    # one Newton step on the inverse root of the load, which is almost linear in 1/share
    p, q = inverse + give_axial, inverse + give_across
    a, b = axial * q * q, across * p * p
    inverse = max(inverse + (a + b) * (np.sqrt(a + b) - p * q) / max(a * q + b * p, SMALLEST), 1.0)
    p, q = inverse + give_axial, inverse + give_across
    load = np.sqrt(axial * q * q + across * p * p)
    scale = 1.0 / (load if inverse > 1.0 or load > p * q else p * q)
    return q * scale, p * scale
