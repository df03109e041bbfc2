"""What energy a mooring holds: for accounts of where it comes from and goes, not for stepping."""

from typing import NamedTuple

import numpy as np

from .bed import bed_at
from .bending_readings import bending_energy
from .platform import rotate
from .tension import TINY


class Energy(NamedTuple):
    """J. The potential is that of weight less buoyancy from the still surface, exact for what is wholly wet or wholly dry, and of the bed's springs.

    Strain is that of springs alone: of a rope in two-Kelvin form of both its springs.
    """

    kinetic: float
    strain: float
    bending: float
    potential: float

    @property
    def total(self):
        return self.kinetic + self.strain + self.bending + self.potential


def energy(model, state, lead=0.0):
    """Energy after an evaluation; `lead` (s): how far the parts' velocities stand behind, half a step of leapfrog."""
    return Energy(_kinetic(model, state, lead), _strain(model, state), _bending(model, state), _potential(model, state))


def _kinetic(model, state, lead):
    size = model.size
    velocity = state.velocity[:, :size] + state.lead[:, :size]
    tangent = state.tangent[:, :size] + state.tangent[:, 1 : size + 1]
    tangent = tangent / np.sqrt(np.maximum((tangent**2).sum(axis=0), TINY))
    normal = model.mass[:size] + state.wet[:size] * model.added_normal[:size]
    surplus = state.wet[:size] * (model.added_axial[:size] - model.added_normal[:size])
    nodes = 0.5 * (normal * (velocity**2).sum(axis=0) + surplus * (tangent * velocity).sum(axis=0) ** 2).sum()
    return float(nodes + sum(_kinetic_of_part(model, state, b, lead) for b in range(model.rigid.mass.size)))


def _kinetic_of_part(model, state, b, lead):
    """Of the part's own mass; what rides on it counts as nodes, but for the surplus of lumps."""
    rigid, part = model.rigid, state.parts[b]
    speed, spin = (part[k : k + 3] + lead * state.parts_acceleration[b, k - 7 : k - 4] for k in (7, 10))
    turn = np.array([rotate(part[3:7], axis) for axis in np.eye(3)]).T
    centre, inertia = turn @ rigid.centre[b], turn @ (rigid.inertia[b] - rigid.added_surplus[b]) @ turn.T
    total = 0.5 * rigid.mass[b] * speed @ speed + rigid.mass[b] * speed @ np.cross(spin, centre) + 0.5 * spin @ inertia @ spin
    if rigid.hull[b] >= 0:
        share = state.wet[model.point_node[rigid.hull[b]]]
        total += 0.5 * share * (rigid.hull_added[b] * (turn.T @ speed) ** 2).sum()
    return total


def _strain(model, state):
    ropes, size = model.ropes, model.size + 1
    span = np.diff(state.position[:, :size], axis=1)
    strain = np.sqrt((span**2).sum(axis=0)) * model.inverse_length[1:size] - 1.0
    taut = np.maximum(strain, 0.0)
    length = model.live[1:size] * model.length[1:size]
    stored = 0.5 * model.stiffness[1:size] * taut**2
    for k, (first, count) in enumerate(zip(ropes.curve_first, ropes.curve_count)):
        rows = slice(ropes.curve_row[k], ropes.curve_row[k + 1])
        begin, load, slope = ropes.strain[rows], ropes.load[rows], ropes.slope[rows]
        until = np.clip(taut[first - 1 : first - 1 + count, None], begin, np.append(begin[1:], np.inf)) - begin
        stored[first - 1 : first - 1 + count] = (load * until + 0.5 * slope * until**2).sum(axis=1)
    for k, (first, count) in enumerate(zip(ropes.kelvin_first, ropes.kelvin_count)):
        segments = slice(first - 1, first - 1 + count)
        creep = state.creep[first : first + count]
        quick = np.where(state.tension[first : first + count] > 0.0, strain[segments] - creep, 0.0)
        stored[segments] = 0.5 * (ropes.slow_stiffness[k] * creep**2 + ropes.fast_stiffness[k] * quick**2)
    return float((length * stored).sum())


def _bending(model, state):
    return float(bending_energy(model.bending, model.size, state.tangent, state.end_point, state.clamp_axis))


def _potential(model, state):
    size = model.size
    z = state.position[2, :size]
    weight = ((model.weight[:size] - state.wet[:size] * model.buoyancy[:size]) * z).sum()
    level, up = (model.bed_level, 1.0)
    if model.ground.on:
        bed = bed_at(model.ground, *state.position[:2, :size])
        level, up = bed[0], bed[3]
    depth = np.maximum((level - z) * up, 0.0)
    return float(weight + 0.5 * (model.bed_stiffness[:size] * depth**2).sum())
