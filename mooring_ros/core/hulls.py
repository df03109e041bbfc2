"""Hulls: what water does to the volumes of bodies, with coefficients along and about their own axes.

Weight is at the body's centre of gravity and buoyancy at its origin, as everywhere by nodes; here are drag and the water's acceleration.
Fixed bodies need none of it.
"""

from typing import NamedTuple

import numpy as np

from .cache import stage
from .packed import packed
from .platform import dot, rotate


@packed
class Hulls(NamedTuple):
    """H hulls of free bodies, then of coupled ones."""

    point: np.ndarray  # (H,) internal point at the body's origin
    part: np.ndarray  # (H,) rigid part that carries it, or -1: the platform does
    output: np.ndarray  # (H,) output of a coupled one, or -1
    turn: np.ndarray  # (H, 4) quaternion from the body's axes to those of the carrier
    drag: np.ndarray  # (H, 6) rho/2 CdA, kg/m and kg m^2
    added: np.ndarray  # (H, 3) rho V Ca, kg


def build_hulls(hulls, density):
    """Hulls from those of the Layout, in water of `density` (kg/m^3)."""
    return Hulls(
        point=np.array([hull.point for hull in hulls], dtype=np.int64),
        part=np.array([hull.part for hull in hulls], dtype=np.int64),
        output=np.array([hull.output for hull in hulls], dtype=np.int64),
        turn=np.array([hull.turn for hull in hulls], dtype=float).reshape(-1, 4),
        drag=np.array([0.5 * density * np.array(hull.drag_area) for hull in hulls], dtype=float).reshape(-1, 6),
        added=np.array([density * np.array(hull.added_volume) for hull in hulls], dtype=float).reshape(-1, 3),
    )


@stage
def hull_axis(hulls, h, quaternion, k):
    """Axis k of hull h in the world, its carrier turned by `quaternion`."""
    e = (1.0 if k == 0 else 0.0, 1.0 if k == 1 else 0.0, 1.0 if k == 2 else 0.0)
    return rotate(quaternion, rotate((hulls.turn[h, 0], hulls.turn[h, 1], hulls.turn[h, 2], hulls.turn[h, 3]), e))


@stage
def hull_load(model, state, h, quaternion, omega):
    """Force (3,) and moment (3,) of drag and of the water's acceleration on hull h, whose carrier spins at `omega`."""
    hulls = model.hulls
    node = model.point_node[hulls.point[h]]
    share, waves = state.wet[node], state.swell.shape[1] > 0
    fx, fy, fz, mx, my, mz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        e = hull_axis(hulls, h, quaternion, k)
        speed, surge, spin = 0.0, 0.0, dot(e, omega)
        for j in range(3):
            speed += e[j] * (state.stream[j, node] - state.velocity[j, node])
            surge += e[j] * state.swell[j, node] if waves else 0.0
        push = share * (hulls.drag[h, k] * abs(speed) * speed + hulls.added[h, k] * surge)
        twist = -share * hulls.drag[h, 3 + k] * abs(spin) * spin
        fx, fy, fz = fx + push * e[0], fy + push * e[1], fz + push * e[2]
        mx, my, mz = mx + twist * e[0], my + twist * e[1], mz + twist * e[2]
    return (fx, fy, fz), (mx, my, mz)


@stage
def load_free_hulls(model, state):
    """Add the forces on the hulls of free bodies to those of their nodes; their moments are added by `add_hull`."""
    hulls = model.hulls
    for h in range(hulls.point.size):
        b = hulls.part[h]
        if b >= 0:
            parts, node = state.parts, model.point_node[hulls.point[h]]
            quaternion = (parts[b, 3], parts[b, 4], parts[b, 5], parts[b, 6])
            force, _ = hull_load(model, state, h, quaternion, (parts[b, 10], parts[b, 11], parts[b, 12]))
            for k in range(3):
                state.force[k, node] += force[k]


@stage
def add_hulls(model, state, b, quaternion, omega, mass, matrix):
    """Add to the equations of motion (6, 7) of part b, of `mass` (kg): the added mass of its hull and the moment of its drag.

    As in `water_loads`, inertia is raised where drag would turn a velocity round within a step.
    """
    hulls, drag_time = model.hulls, state.settings[0]
    for h in range(hulls.point.size):
        if hulls.part[h] != b:
            continue
        node = model.point_node[hulls.point[h]]
        share = state.wet[node]
        _, moment = hull_load(model, state, h, quaternion, omega)
        for k in range(3):
            e = hull_axis(hulls, h, quaternion, k)
            speed, about = 0.0, 0.0
            for i in range(3):
                speed += e[i] * (state.stream[i, node] - state.velocity[i, node])
                for j in range(3):
                    about += e[i] * matrix[3 + i, 3 + j] * e[j]
            held = max(share * hulls.added[h, k], share * hulls.drag[h, k] * abs(speed) * drag_time - mass)
            slow = max(share * hulls.drag[h, 3 + k] * abs(dot(e, omega)) * drag_time - about, 0.0)
            matrix[3 + k, 6] += moment[k]
            for i in range(3):
                for j in range(3):
                    matrix[i, j] += held * e[i] * e[j]
                    matrix[3 + i, 3 + j] += slow * e[i] * e[j]


@stage
def coupled_hull_load(model, state, h, acceleration):
    """(force (3,), moment (3,)) of hull h on the platform that carries it, whose own place has `acceleration` (3,): see `hull_load`, less its added mass."""
    m = model.point_platform[model.hulls.point[h]]
    quaternion = (state.pose[m, 3], state.pose[m, 4], state.pose[m, 5], state.pose[m, 6])
    force, moment = hull_load(model, state, h, quaternion, (state.twist[m, 3], state.twist[m, 4], state.twist[m, 5]))
    share = state.wet[model.point_node[model.hulls.point[h]]]
    fx, fy, fz = force
    for k in range(3):
        e = hull_axis(model.hulls, h, quaternion, k)
        slow = share * model.hulls.added[h, k] * dot(e, acceleration)
        fx, fy, fz = fx - slow * e[0], fy - slow * e[1], fz - slow * e[2]
    return (fx, fy, fz), moment
