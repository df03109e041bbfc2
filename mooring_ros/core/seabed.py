"""Contact with a flat bed without friction: a spring and a damper, never adhesive."""

from .cache import stage


@stage
def bed_contact(model, state, step):
    """Add the bed's push [(z_b - z) k_b - w c_b] d l to the nodes' vertical force, of which it must be the last part.

    `step` (s) is the Euler step that the contact must survive: spring and damper act at the depth and speed that the node will have then, where
    that is a push. The force gets what depends on the present speed, and the factor m / (m + c step + k step^2) in state.bed_relief the rest: together
    they are the linearly implicit Euler step of the contact alone, added mass included. A node that meets the bed within the step gets this over the
    rest of the step, so that it does not fall through by step x speed. Zero: the plain law, and no relief. A node that shares its motion
    with others is judged by its speed alone.
    """
    z, w, fz, relief, slaved = state.position[2], state.velocity[2], state.force[2], state.bed_relief, state.slaved
    stiffness, damping, level = model.bed_stiffness, model.bed_damping, model.bed_level
    mass, added = model.mass, model.added_normal
    for i in range(model.size):
        depth = level - z[i]
        inertia = max(mass[i] + added[i], 1e-300)
        fall = -step * (w[i] + (0.0 if slaved[i] else step * fz[i] / inertia))  # in the step, if nothing pushes
        share = 1.0 if depth > 0.0 else max(depth + fall, 0.0) / max(fall, 1e-300)
        resist = share * (damping[i] + share * step * stiffness[i])
        pushed = (stiffness[i] * step * depth > -resist * fall) | ((step == 0.0) & (stiffness[i] * depth > damping[i] * w[i]))
        pushed = pushed & (depth > 0.0) | (depth <= 0.0) & (depth + fall > 0.0)
        fz[i] += stiffness[i] * max(depth, 0.0) - resist * w[i] if pushed else 0.0
        relief[i] = inertia / (inertia + step * resist) if pushed else 1.0
