"""Contact with the bed: a spring and a damper along the bed's normal, never adhesive."""

from .cache import stage


@stage
def bed_contact(model, state):
    """Add the bed's push [(z_b - z) k_b - w c_b] d l to the nodes' vertical force."""
    z, w, fz = state.position[2], state.velocity[2], state.force[2]
    stiffness, damping, level = model.bed_stiffness, model.bed_damping, model.bed_level
    for i in range(model.size):
        depth = level - z[i]
        push = max(stiffness[i] * depth - damping[i] * w[i], 0.0)
        fz[i] += push if depth > 0.0 else 0.0


@stage
def set_bed_relief(model, state, damping_time, stiffness_time_squared):
    """Factors that keep contact from limiting the step: mass over the mass at which a step resolves the contact.

    A node in contact has its vertical acceleration divided by max(1, (c damping_time + k stiffness_time^2) / m), as a linearly implicit
    step would do; the contact force itself, and so every equilibrium, is untouched.
    """
    relief, mass = state.bed_relief, model.mass
    stiffness, damping = model.bed_stiffness, model.bed_damping
    for i in range(model.size):
        resisted = damping[i] * damping_time + stiffness[i] * stiffness_time_squared
        relief[i] = mass[i] / max(max(mass[i], resisted), 1e-300)
