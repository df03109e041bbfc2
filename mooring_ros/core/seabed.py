"""Contact with the bed: a spring and a damper along the bed's normal, never adhesive."""

from .cache import stage


@stage
def bed_contact(model, state, step):
    """Add the bed's push [(z_b - z) k_b - w c_b] d l to the nodes' vertical force.

    `step` (s) is the Euler step that the contact must survive: its spring acts on the depth that the node will have then, which adds
    k step to the damping; with `set_bed_relief` this is the linearly implicit Euler step of the contact alone. Zero: the plain law.
    """
    z, w, fz = state.position[2], state.velocity[2], state.force[2]
    stiffness, damping, level = model.bed_stiffness, model.bed_damping, model.bed_level
    for i in range(model.size):
        depth = level - z[i]
        push = max(stiffness[i] * (depth - step * w[i]) - damping[i] * w[i], 0.0)
        fz[i] += push if depth > 0.0 else 0.0


@stage
def set_bed_relief(model, state, step):
    """Factors m / (m + c step + k step^2) on the vertical acceleration of nodes in contact (see `bed_contact`), added mass included."""
    relief, mass, added = state.bed_relief, model.mass, model.added_normal
    stiffness, damping = model.bed_stiffness, model.bed_damping
    for i in range(model.size):
        inertia = mass[i] + added[i]
        relief[i] = inertia / max(inertia + step * (damping[i] + step * stiffness[i]), 1e-300)
