"""Contact with a bed that is not flat, or that has friction: what the passes over all nodes do.

`contact` comes last of all forces, since what friction answers depends on them. Node tangents are the sum of the unit vectors of the
segments on both sides. bed (4, n) holds z of the bed under each node (m) and its unit normal; grip (4, n) what the law `stick` remembers:
the place where the node holds on (m), and -1 for no contact, 0 sticking, 1 sliding.
"""

import numpy as np

from .bathymetry import grid_under
from .bed import Ground, bed_at, bed_level, bed_under, build_ground, unit_normal
from .cache import kernel, stage
from .friction import LEAST, NO_FRICTION, ROUNDING, SATURATED, SMOOTHEST, STICK, return_to_ellipse, saturated_part
from .tension import TINY

__all__ = [  # the bed as the rest of the core knows it
    "NO_CONTACT",
    "SLIDING",
    "STICKING",
    "Ground",
    "bed_at",
    "bed_level",
    "bed_under",
    "build_ground",
    "commit_grip",
    "contact",
    "ground_blocks",
]

LIGHTEST = 1e-30  # kg: keeps a node without inertia from dividing by zero
UPRIGHT = 1e-24  # square of the tangent's part along the bed, below which a node has no direction there
TOGETHER = 8  # nodes: a whole number of vectors
NEAR = 1e-3  # m: over which the turning of a grid's normal is taken
NO_CONTACT, STICKING, SLIDING = -1.0, 0.0, 1.0


@stage
def _mobility(tx, ty, tz, normal, axial, slaved):
    """M^-1 = across I + surplus t t' of a node with tangent t of any length: (across, surplus). None where the motion is shared."""
    normal, axial = max(normal, LIGHTEST), max(axial, LIGHTEST)
    square = max(tx * tx + ty * ty + tz * tz, TINY)
    both = (0.0 if slaved else 1.0) / (normal * axial * square)
    across, surplus = axial * square * both, (normal - axial) * both
    return across, surplus


@stage
def _push(step, depth, speed, free_acceleration, mobility, stiffness, damping):
    """Reaction (N) along the normal, never adhesive: spring and damper at the place and speed after the Euler step."""
    resist = damping + step * stiffness
    push = (stiffness * depth - resist * (speed + step * free_acceleration)) / (1.0 + step * resist * mobility)
    return max(push, 0.0) if depth > 0.0 else 0.0


@kernel
def contact(
    ground, size, step, position, velocity, tangent, bed_stiffness, bed_damping, inertia_normal, inertia_axial, slaved, bed, grip, expected, force, hold
):
    """Add the bed's forces (N) to `force` (3, n), which holds all other forces on the nodes already.

    They are taken implicitly over the Euler step `step` (s), so that a = M^-1 F afterwards is the linearly implicit step; zero is the
    plain law. Nodes that are `slaved` (n,) share their motion with others: their forces are those of the law at their place and speed,
    and hold (3, n) is what their owner adds to the inertia (kg) along the normal, and in the bed's plane along the line and across it. Friction is then the law's secant
    at the speed that they will have with the acceleration `expected` (3, n): at the present speed alone, what starts to slide would hardly get going.
    """
    start = 0
    while start < size:  # the laws cost more than asking who needs them
        stop = start
        while stop < size and _touches(position, bed, stop, min(stop + TOGETHER, size)):
            stop = min(stop + TOGETHER, size)
        if stop == start:
            stop = min(start + TOGETHER, size)
            for i in range(start, stop):
                hold[0, i] = hold[1, i] = hold[2, i] = 0.0
        elif ground.law == NO_FRICTION:
            _smooth(
                start,
                stop,
                step,
                position,
                velocity,
                tangent,
                bed_stiffness,
                bed_damping,
                inertia_normal,
                inertia_axial,
                slaved,
                bed,
                force,
                hold,
            )
        elif ground.law == SATURATED:
            _saturated(
                ground,
                start,
                stop,
                step,
                position,
                velocity,
                tangent,
                bed_stiffness,
                bed_damping,
                inertia_normal,
                inertia_axial,
                slaved,
                bed,
                expected,
                force,
                hold,
            )
        else:
            _sticking(
                ground,
                start,
                stop,
                step,
                position,
                velocity,
                tangent,
                bed_stiffness,
                bed_damping,
                inertia_normal,
                inertia_axial,
                slaved,
                bed,
                grip,
                expected,
                force,
                hold,
            )
        start = stop


@stage
def _touches(position, bed, start, stop):
    touches = False
    for i in range(start, stop):
        touches |= bed[0, i] > position[2, i]
    return touches


@stage
def _smooth(first, stop, step, position, velocity, tangent, bed_stiffness, bed_damping, inertia_normal, inertia_axial, slaved, bed, force, hold):
    z, u, v, w = position[2, first:stop], velocity[0, first:stop], velocity[1, first:stop], velocity[2, first:stop]
    qx, qy, qz = tangent[0, first : stop + 1], tangent[1, first : stop + 1], tangent[2, first : stop + 1]
    fx, fy, fz = force[0, first:stop], force[1, first:stop], force[2, first:stop]
    level, normal_x, normal_y, normal_z = bed[0, first:stop], bed[1, first:stop], bed[2, first:stop], bed[3, first:stop]
    hold_normal, hold_axial, hold_across = hold[0, first:stop], hold[1, first:stop], hold[2, first:stop]
    bed_stiffness, bed_damping, slaved = bed_stiffness[first:stop], bed_damping[first:stop], slaved[first:stop]
    inertia_normal, inertia_axial = inertia_normal[first:stop], inertia_axial[first:stop]
    for i in range(stop - first):
        nx, ny, nz = normal_x[i], normal_y[i], normal_z[i]
        tx, ty, tz = qx[i] + qx[i + 1], qy[i] + qy[i + 1], qz[i] + qz[i + 1]
        across, surplus = _mobility(tx, ty, tz, inertia_normal[i], inertia_axial[i], slaved[i])
        tn = tx * nx + ty * ny + tz * nz
        tf = surplus * (tx * fx[i] + ty * fy[i] + tz * fz[i])
        free = across * (nx * fx[i] + ny * fy[i] + nz * fz[i]) + tf * tn
        speed = u[i] * nx + v[i] * ny + w[i] * nz
        push = _push(step, (level[i] - z[i]) * nz, speed, free, across + surplus * tn * tn, bed_stiffness[i], bed_damping[i])
        fx[i] += push * nx
        fy[i] += push * ny
        fz[i] += push * nz
        hold_normal[i] = step * (bed_damping[i] + step * bed_stiffness[i]) if push > 0.0 else 0.0
        hold_axial[i] = hold_across[i] = 0.0


@stage
def in_plane(x, y, z, nx, ny, nz):
    """Part of a vector in the plane across the unit normal."""
    along = x * nx + y * ny + z * nz
    return x - along * nx, y - along * ny, z - along * nz


@stage
def along_bed(tx, ty, tz, nx, ny, nz):
    """(part of the tangent in the bed's plane (3,), its square, the square's inverse: zero for a node that stands upright)."""
    px, py, pz = in_plane(tx, ty, tz, nx, ny, nz)
    square = px * px + py * py + pz * pz
    inverse = 1.0 / max(square, UPRIGHT)
    return px, py, pz, square, inverse if square > UPRIGHT else 0.0


@stage
def _saturated(
    ground, first, stop, step, position, velocity, tangent, bed_stiffness, bed_damping, inertia_normal, inertia_axial, slaved, bed, expected, force, hold
):
    z, u, v, w = position[2, first:stop], velocity[0, first:stop], velocity[1, first:stop], velocity[2, first:stop]
    qx, qy, qz = tangent[0, first : stop + 1], tangent[1, first : stop + 1], tangent[2, first : stop + 1]
    fx, fy, fz = force[0, first:stop], force[1, first:stop], force[2, first:stop]
    level, normal_x, normal_y, normal_z = bed[0, first:stop], bed[1, first:stop], bed[2, first:stop], bed[3, first:stop]
    hold_normal, hold_axial, hold_across = hold[0, first:stop], hold[1, first:stop], hold[2, first:stop]
    static_axial, static_across, kinetic_axial, kinetic_across = (
        ground.static_axial,
        ground.static_across,
        ground.kinetic_axial,
        ground.kinetic_across,
    )
    bed_stiffness, bed_damping, slaved = bed_stiffness[first:stop], bed_damping[first:stop], slaved[first:stop]
    inertia_normal, inertia_axial = inertia_normal[first:stop], inertia_axial[first:stop]
    directional, ramp = ground.directional, ground.ramp
    more_x, more_y, more_z = expected[0, first:stop], expected[1, first:stop], expected[2, first:stop]
    for i in range(stop - first):
        nx, ny, nz = normal_x[i], normal_y[i], normal_z[i]
        tx, ty, tz = qx[i] + qx[i + 1], qy[i] + qy[i + 1], qz[i] + qz[i + 1]
        across, surplus = _mobility(tx, ty, tz, inertia_normal[i], inertia_axial[i], slaved[i])
        tn = tx * nx + ty * ny + tz * nz
        tf = surplus * (tx * fx[i] + ty * fy[i] + tz * fz[i])
        free = across * (nx * fx[i] + ny * fy[i] + nz * fz[i]) + tf * tn
        speed = u[i] * nx + v[i] * ny + w[i] * nz
        push = _push(step, (level[i] - z[i]) * nz, speed, free, across + surplus * tn * tn, bed_stiffness[i], bed_damping[i])
        gx, gy, gz = fx[i] + push * nx, fy[i] + push * ny, fz[i] + push * nz
        # velocities in the plane, now (v) and after the step without friction (d), split along and across the line
        tf = surplus * (tx * gx + ty * gy + tz * gz)
        vx, vy, vz = in_plane(u[i], v[i], w[i], nx, ny, nz)
        dx, dy, dz = in_plane(across * gx + tf * tx + more_x[i], across * gy + tf * ty + more_y[i], across * gz + tf * tz + more_z[i], nx, ny, nz)
        dx, dy, dz = vx + step * dx, vy + step * dy, vz + step * dz
        px, py, pz, square, inverse = along_bed(tx, ty, tz, nx, ny, nz)
        inverse *= directional
        give_across = step * across
        give_axial = give_across + step * surplus * square
        give_across = give_across if directional > 0.0 else max(give_axial, give_across)
        now = inverse * (vx * px + vy * py + vz * pz)
        then = inverse * (dx * px + dy * py + dz * pz)
        vx, vy, vz = vx - now * px, vy - now * py, vz - now * pz
        dx, dy, dz = dx - then * px, dy - then * py, dz - then * pz
        length = np.sqrt(square)
        axial = saturated_part(abs(then) * length, abs(now) * length, push, static_axial, kinetic_axial, ramp, give_axial)
        drift, speed = np.sqrt(dx * dx + dy * dy + dz * dz), np.sqrt(vx * vx + vy * vy + vz * vz)
        side = saturated_part(drift, speed, push, static_across, kinetic_across, ramp, give_across)
        shared = slaved[i]
        dx, dy, dz = vx if shared else dx, vy if shared else dy, vz if shared else dz
        axial_force = axial * (now if shared else then)
        fx[i] = gx - axial_force * px - side * dx
        fy[i] = gy - axial_force * py - side * dy
        fz[i] = gz - axial_force * pz - side * dz
        hold_normal[i] = step * (bed_damping[i] + step * bed_stiffness[i]) if push > 0.0 else 0.0
        hold_axial[i] = step * axial if push > 0.0 else 0.0  # of a shared node: the law's secant at the speed that is expected of it
        hold_across[i] = step * side if push > 0.0 else 0.0


@stage
def _sticking(
    ground, first, stop, step, position, velocity, tangent, bed_stiffness, bed_damping, inertia_normal, inertia_axial, slaved, bed, grip, expected, force, hold
):
    x, y, z = position[0, first:stop], position[1, first:stop], position[2, first:stop]
    u, v, w = velocity[0, first:stop], velocity[1, first:stop], velocity[2, first:stop]
    qx, qy, qz = tangent[0, first : stop + 1], tangent[1, first : stop + 1], tangent[2, first : stop + 1]
    fx, fy, fz = force[0, first:stop], force[1, first:stop], force[2, first:stop]
    level, normal_x, normal_y, normal_z = bed[0, first:stop], bed[1, first:stop], bed[2, first:stop], bed[3, first:stop]
    grip_x, grip_y, grip_z, state = grip[0, first:stop], grip[1, first:stop], grip[2, first:stop], grip[3, first:stop]
    hold_normal, hold_axial, hold_across = hold[0, first:stop], hold[1, first:stop], hold[2, first:stop]
    by_static_axial, by_static_across = 1.0 / max(ground.static_axial, SMOOTHEST), 1.0 / max(ground.static_across, SMOOTHEST)
    by_kinetic_axial, by_kinetic_across = 1.0 / max(ground.kinetic_axial, SMOOTHEST), 1.0 / max(ground.kinetic_across, SMOOTHEST)
    bed_stiffness, bed_damping, slaved = bed_stiffness[first:stop], bed_damping[first:stop], slaved[first:stop]
    inertia_normal, inertia_axial = inertia_normal[first:stop], inertia_axial[first:stop]
    stiffer, denser = ground.stiffness_ratio, ground.damping_ratio
    more_x, more_y, more_z = expected[0, first:stop], expected[1, first:stop], expected[2, first:stop]
    for i in range(stop - first):
        nx, ny, nz = normal_x[i], normal_y[i], normal_z[i]
        tx, ty, tz = qx[i] + qx[i + 1], qy[i] + qy[i + 1], qz[i] + qz[i + 1]
        across, surplus = _mobility(tx, ty, tz, inertia_normal[i], inertia_axial[i], slaved[i])
        tn = tx * nx + ty * ny + tz * nz
        tf = surplus * (tx * fx[i] + ty * fy[i] + tz * fz[i])
        free = across * (nx * fx[i] + ny * fy[i] + nz * fz[i]) + tf * tn
        speed = u[i] * nx + v[i] * ny + w[i] * nz
        push = _push(step, (level[i] - z[i]) * nz, speed, free, across + surplus * tn * tn, bed_stiffness[i], bed_damping[i])
        gx, gy, gz = fx[i] + push * nx, fy[i] + push * ny, fz[i] + push * nz
        # trial force k_t (x - grip) + (c_t + k_t step) (velocity after the step without friction), in the plane
        tf = surplus * (tx * gx + ty * gy + tz * gz)
        spring, resist = stiffer * bed_stiffness[i], denser * bed_damping[i] + step * stiffer * bed_stiffness[i]
        remembered = spring if state[i] >= 0.0 else 0.0
        dx, dy, dz = in_plane(
            remembered * (x[i] - grip_x[i]) + resist * (u[i] + step * (across * gx + tf * tx + more_x[i])),
            remembered * (y[i] - grip_y[i]) + resist * (v[i] + step * (across * gy + tf * ty + more_y[i])),
            remembered * (z[i] - grip_z[i]) + resist * (w[i] + step * (across * gz + tf * tz + more_z[i])),
            nx,
            ny,
            nz,
        )
        px, py, pz, square, inverse = along_bed(tx, ty, tz, nx, ny, nz)
        axial = inverse * (dx * px + dy * py + dz * pz)
        dx, dy, dz = dx - axial * px, dy - axial * py, dz - axial * pz
        lightly = 1.0 / max(push, LEAST)
        load_axial = axial * lightly * (by_kinetic_axial if state[i] > 0.0 else by_static_axial)
        load_across = lightly * (by_kinetic_across if state[i] > 0.0 else by_static_across)
        give = step * resist
        part, side = return_to_ellipse(
            load_axial * load_axial * square,
            load_across * load_across * (dx * dx + dy * dy + dz * dz),
            give * (across + surplus * square),
            give * across,
        )
        mx, my, mz = in_plane(more_x[i], more_y[i], more_z[i], nx, ny, nz)
        more = inverse * (mx * px + my * py + mz * pz)
        dx, dy, dz = dx - give * (mx - more * px), dy - give * (my - more * py), dz - give * (mz - more * pz)
        hold_axial[i] = part * give if push > 0.0 else 0.0  # of a shared node, which does not give way: its share
        hold_across[i] = side * give if push > 0.0 else 0.0
        part *= axial - give * more
        fx[i] = gx - part * px - side * dx
        fy[i] = gy - part * py - side * dy
        fz[i] = gz - part * pz - side * dz
    for i in range(stop - first):  # apart: one array more, and the compiler gives up proving that none overlap
        hold_normal[i] = step * (bed_damping[i] + step * bed_stiffness[i]) if hold_across[i] > 0.0 else 0.0


@kernel
def commit_grip(ground, size, position, velocity, tangent, bed_stiffness, bed_damping, bed, grip):
    """Bring the memory of `stick` to the state after a step; `bed` must be that of the positions.

    A node that touches the bed for the first time holds on where it is. One whose trial force, spring and damper, passes the limit slides:
    it takes its hold along so that the spring's force is kinetic friction at most. It sticks again as soon as the limit is not passed.
    """
    for i in range(size):
        nx, ny, nz = bed[1, i], bed[2, i], bed[3, i]
        depth = (bed[0, i] - position[2, i]) * nz
        if not depth > 0.0:
            grip[3, i] = NO_CONTACT
            continue
        if grip[3, i] < 0.0:
            grip[0, i], grip[1, i], grip[2, i], grip[3, i] = position[0, i], position[1, i], position[2, i], STICKING
        speed = velocity[0, i] * nx + velocity[1, i] * ny + velocity[2, i] * nz
        push = max(bed_stiffness[i] * depth - bed_damping[i] * speed, LEAST)
        rx, ry, rz = in_plane(position[0, i] - grip[0, i], position[1, i] - grip[1, i], position[2, i] - grip[2, i], nx, ny, nz)
        vx, vy, vz = in_plane(velocity[0, i], velocity[1, i], velocity[2, i], nx, ny, nz)
        t = (tangent[0, i] + tangent[0, i + 1], tangent[1, i] + tangent[1, i + 1], tangent[2, i] + tangent[2, i + 1])
        px, py, pz, _, inverse = along_bed(t[0], t[1], t[2], nx, ny, nz)
        scale = np.sqrt(inverse)
        ex, ey, ez = scale * px, scale * py, scale * pz
        spring, damper = ground.stiffness_ratio * bed_stiffness[i], ground.damping_ratio * bed_damping[i]
        static = (max(ground.static_axial * push, LEAST), max(ground.static_across * push, LEAST))
        kinetic = (max(ground.kinetic_axial * push, LEAST), max(ground.kinetic_across * push, LEAST))
        limit = kinetic if grip[3, i] > 0.0 else static
        trial = _ellipse(spring * rx + damper * vx, spring * ry + damper * vy, spring * rz + damper * vz, ex, ey, ez, limit)
        if trial <= 1.0 + ROUNDING:
            grip[3, i] = STICKING
            continue
        grip[3, i] = SLIDING
        kept = 1.0 / max(_ellipse(spring * rx, spring * ry, spring * rz, ex, ey, ez, kinetic), 1.0)
        grip[0, i] = position[0, i] - kept * rx
        grip[1, i] = position[1, i] - kept * ry
        grip[2, i] = position[2, i] - kept * rz


@stage
def _ellipse(fx, fy, fz, ex, ey, ez, limit):
    """Load of the force f in the plane, 1 on the ellipse with half axes limit = (along e, across)."""
    axial = fx * ex + fy * ey + fz * ez
    fx, fy, fz = fx - axial * ex, fy - axial * ey, fz - axial * ez
    a, b = axial / limit[0], np.sqrt(fx * fx + fy * fy + fz * fz) / limit[1]
    return np.sqrt(a * a + b * b)


@kernel
def ground_blocks(ground, size, position, tangent, bed_stiffness, bed, grip, diagonal):
    """Add -dF/dx of contact and of `stick` friction to diagonal (n, 3, 3), at rest and for step 0, the nodes' tangents held.

    Sliding friction is perfectly plastic along the slip and turns with it across; its limit grows with the depth. The turning of the bed's
    normal counts for the contact, not for friction.
    """
    for i in range(size):
        n = (bed[1, i], bed[2, i], bed[3, i])
        depth = (bed[0, i] - position[2, i]) * n[2]
        stiffness = bed_stiffness[i]
        if not depth * stiffness > 0.0:  # in the air, or a mere point
            continue
        for a in range(3):
            for b in range(3):
                diagonal[i, a, b] += stiffness * n[a] * n[b]
        if ground.grid.x.size > 0:
            x, y = position[0, i], position[1, i]
            for b in range(2):
                dx, dy = (NEAR, 0.0) if b == 0 else (0.0, NEAR)
                _, slope_x, slope_y = grid_under(ground.grid, x - dx, y - dy)
                before = unit_normal(slope_x, slope_y)
                _, slope_x, slope_y = grid_under(ground.grid, x + dx, y + dy)
                after = unit_normal(slope_x, slope_y)
                for a in range(3):
                    diagonal[i, a, b] -= stiffness * depth * (after[a] - before[a]) / (2.0 * NEAR)
        if ground.law != STICK or grip[3, i] < 0.0:
            continue
        e = in_plane(position[0, i] - grip[0, i], position[1, i] - grip[1, i], position[2, i] - grip[2, i], n[0], n[1], n[2])
        t = (tangent[0, i] + tangent[0, i + 1], tangent[1, i] + tangent[1, i + 1], tangent[2, i] + tangent[2, i + 1])
        px, py, pz, _, inverse = along_bed(t[0], t[1], t[2], n[0], n[1], n[2])
        scale = np.sqrt(inverse)
        d = (scale * px, scale * py, scale * pz)
        sliding = grip[3, i] > 0.0
        mu_axial = max(ground.kinetic_axial if sliding else ground.static_axial, LEAST)
        mu_across = max(ground.kinetic_across if sliding else ground.static_across, LEAST)
        spring = ground.stiffness_ratio * stiffness
        load = spring * _ellipse(e[0], e[1], e[2], d[0], d[1], d[2], (mu_axial, mu_across))  # N of the normal force that carries it
        push = stiffness * depth
        share = min(push / max(load, LEAST), 1.0)
        along = e[0] * d[0] + e[1] * d[1] + e[2] * d[2]
        for a in range(3):
            for b in range(3):
                k = share * spring * ((1.0 if a == b else 0.0) - n[a] * n[b])
                if share < 1.0:
                    # F = -push spring e / load; d load / dx = spring^2 (E e) / load with E = d d' / mu_a^2 + (P - d d') / mu_t^2
                    gradient = along * d[b] / mu_axial**2 + (e[b] - along * d[b]) / mu_across**2
                    k -= share * spring * e[a] * gradient * (spring / load) ** 2
                    k -= spring / load * e[a] * stiffness * n[b]
                diagonal[i, a, b] += k
