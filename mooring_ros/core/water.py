"""Weight, buoyancy, added mass and Morison drag of the nodes in the water's stream, and what waves add."""

import numpy as np

from .cache import stage
from .tension import TINY


@stage
def water_loads(model, state, drag_time):
    """Add weight, buoyancy and drag to the nodes' force; set their inertia along and across the line.

    Drag is rho/2 d l Cd |u_n| u_n + rho/2 pi d l CdAx |u_a| u_a with u = water - node velocity, split at the node's tangent (the sum of the
    unit vectors on both sides; a point has none and takes all as normal). Where the drag would turn a velocity round within `drag_time`
    (s) the inertia is raised to drag x drag_time: the balance of forces is untouched, and a light part in a strong stream stays stable.
    """
    cx, cy, cz = state.stream[0], state.stream[1], state.stream[2]
    u, v, w = state.velocity[0], state.velocity[1], state.velocity[2]
    du, dv, dw = state.lead[0], state.lead[1], state.lead[2]
    qx, qy, qz = state.tangent[0], state.tangent[1], state.tangent[2]
    fx, fy, fz = state.force[0], state.force[1], state.force[2]
    wet, inertia_normal, inertia_axial = state.wet, state.inertia_normal, state.inertia_axial
    mass, added_normal, added_axial = model.mass, model.added_normal, model.added_axial
    weight, buoyancy = model.weight, model.buoyancy
    drag_normal, drag_axial = model.drag_normal, model.drag_axial
    for i in range(model.size):
        tx, ty, tz = qx[i] + qx[i + 1], qy[i] + qy[i + 1], qz[i] + qz[i + 1]
        inverse_square = 1.0 / max(tx * tx + ty * ty + tz * tz, TINY)
        rx, ry, rz = cx[i] - u[i] - du[i], cy[i] - v[i] - dv[i], cz[i] - w[i] - dw[i]
        along = (rx * tx + ry * ty + rz * tz) * inverse_square
        ax, ay, az = along * tx, along * ty, along * tz
        nx, ny, nz = rx - ax, ry - ay, rz - az
        resist_axial = wet[i] * drag_axial[i] * np.sqrt(ax * ax + ay * ay + az * az)
        resist_normal = wet[i] * drag_normal[i] * np.sqrt(nx * nx + ny * ny + nz * nz)
        fx[i] += resist_axial * ax + resist_normal * nx
        fy[i] += resist_axial * ay + resist_normal * ny
        fz[i] += resist_axial * az + resist_normal * nz + (wet[i] * buoyancy[i] - weight[i])
        inertia_normal[i] = max(mass[i] + wet[i] * added_normal[i], resist_normal * drag_time)
        inertia_axial[i] = max(mass[i] + wet[i] * added_axial[i], resist_axial * drag_time)


@stage
def add_swell_loads(model, gravity, state):
    """Add Froude-Krylov and inertia forces in the water's acceleration a: rho V [(1 + Ca)(a - t (t.a)) + (1 + CaAx) t (t.a)], what is wet of it.

    A point has no tangent t, and its coefficients are alike in all directions.
    """
    ax, ay, az = state.swell[0], state.swell[1], state.swell[2]
    qx, qy, qz = state.tangent[0], state.tangent[1], state.tangent[2]
    fx, fy, fz = state.force[0], state.force[1], state.force[2]
    wet, buoyancy, added_normal, added_axial = state.wet, model.buoyancy, model.added_normal, model.added_axial
    per_gravity = 1.0 / gravity
    for i in range(model.size):
        tx, ty, tz = qx[i] + qx[i + 1], qy[i] + qy[i + 1], qz[i] + qz[i + 1]
        inverse_square = 1.0 / max(tx * tx + ty * ty + tz * tz, TINY)
        across = wet[i] * (buoyancy[i] * per_gravity + added_normal[i])
        along = wet[i] * (added_axial[i] - added_normal[i]) * (ax[i] * tx + ay[i] * ty + az[i] * tz) * inverse_square
        fx[i] += across * ax[i] + along * tx
        fy[i] += across * ay[i] + along * ty
        fz[i] += across * az[i] + along * tz
