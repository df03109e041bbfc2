"""Scene -> Model (constant arrays) and State (changing arrays).

All nodes of all lines stand one after the other in one structure of arrays, each line's end nodes its own; between lines lies a null
segment (no stiffness, not counted in tangents). Every point of the scene is a node as well. Free points and those with a mass, volume or
drag of their own stand after the lines, between null segments, and the same passes serve them. Then come dummies that feel no force, up to
a multiple of `LANES`: a pass is one plain loop over range(size) without a remainder. Points that are merely held stand beyond it.

Segment i+1 joins nodes i and i+1; segment i is the one to the left of node i.
"""

from typing import NamedTuple

import numpy as np

from ..scene import COUPLED, FIXED

LANES = 8  # nodes: a whole number of vectors

# kinds of points
POINT_FIXED, POINT_COUPLED, POINT_FREE = 0, 1, 2
LOOSE = -1  # an end that nothing holds any more


class Model(NamedTuple):
    """What does not change. n = all nodes and one more; E = 2 x lines (end A, end B of each in turn); P = points. World frame, SI."""

    size: int  # nodes a pass runs over: a multiple of LANES
    # segments, (n,)
    stiffness: np.ndarray  # EA, N
    damping: np.ndarray  # BA/l, N s/m
    inverse_length: np.ndarray  # 1/l, 1/m
    length: np.ndarray  # l unstretched, m
    live: np.ndarray  # 1 for a real segment, 0 for a null one
    diameter: np.ndarray  # m
    tension_scale: np.ndarray  # N: the line's submerged weight, or a small share of EA where it has none
    # nodes, (n,)
    share_left: np.ndarray  # share of the node's volume in the segment to its left, 0..1
    share_right: np.ndarray  # ... and to its right
    mass: np.ndarray  # kg, dry
    added_normal: np.ndarray  # rho V Ca, kg
    added_axial: np.ndarray  # rho V CaAx, kg
    weight: np.ndarray  # m g, N downwards
    buoyancy: np.ndarray  # rho g V, N upwards when wet
    drag_normal: np.ndarray  # rho/2 d l Cd, kg/m
    drag_axial: np.ndarray  # rho/2 pi d l CdAx, kg/m
    bed_stiffness: np.ndarray  # kBot d l, N/m
    bed_damping: np.ndarray  # cBot d l, N s/m
    # environment
    bed_level: float  # z of the bed, m
    current: np.ndarray  # (3,), m/s
    natural_speed: float  # m/s that a sound mooring hardly passes while its ends stand still
    reach: float  # m from the platform's reference point to the farthest coupled point
    # ends, (E,)
    end_node: np.ndarray  # index of the line's end node
    # points, (P,)
    point_node: np.ndarray  # index of the point's node
    point_kind: np.ndarray  # POINT_*
    point_place: np.ndarray  # (P, 3), m: fixed: world; coupled: in the platform's frame; free: where it starts
    point_diameter: np.ndarray  # m, of the sphere of its volume
    free_points: np.ndarray  # indices of the free ones
    coupled_points: np.ndarray  # ... and of the coupled ones
    # lines, (lines,)
    first_node: np.ndarray
    segments: np.ndarray
    fairlead_end: np.ndarray  # 0 or 1: which end of the line is its fairlead


class State(NamedTuple):
    """What changes, all of it: a snapshot is a copy of these arrays. Shapes as in Model."""

    clock: np.ndarray  # (1,), s
    pose: np.ndarray  # (7,), m and quaternion x, y, z, w
    twist: np.ndarray  # (6,), m/s, rad/s, world
    acceleration_of_platform: np.ndarray  # (6,), m/s^2, rad/s^2, world: mean over the last interval, or over a step where that is longer
    position: np.ndarray  # (3, n), m
    velocity: np.ndarray  # (3, n), m/s
    acceleration: np.ndarray  # (3, n), m/s^2
    force: np.ndarray  # (3, n), N: all forces on a node but inertia
    tangent: np.ndarray  # (3, n): unit vectors of the segments, null for null segments
    tension: np.ndarray  # (n,), N, of the segments
    strain_rate: np.ndarray  # (n,), m/s: rate of the segments' stretched length
    wet: np.ndarray  # (n,), wet share of the nodes, 0..1
    inertia_normal: np.ndarray  # (n,), kg
    inertia_axial: np.ndarray  # (n,), kg
    bed_relief: np.ndarray  # (n,): factor on the vertical acceleration of a node in contact, 0..1
    end_point: np.ndarray  # (E,) index of the point that holds the end, or LOOSE
    settings: np.ndarray  # (6,) drag time (s), Euler step of the bed (s), 1 if wet shares are computed; refinement of the step, kept until (s); largest strain


class Scratch(NamedTuple):
    """Work space of a step; nothing in it outlives one."""

    position: np.ndarray  # (3, n), of a step's start
    velocity: np.ndarray  # (3, n)
    wet_segment: np.ndarray  # (n,)
    saved: np.ndarray  # (2, 6, n): position and velocity at the start of the interval and of the chunk
    tension: np.ndarray  # (n,), before a step's last stage
    motion: np.ndarray  # (8, 3): platform.start_motion


def with_segments(scene, segments):
    """Segments of each line: as in the file, or `segments` for all."""
    return [line.segments if segments is None else segments for line in scene.lines]


def build(scene, segments=None):
    """Model of `scene`; `segments` (int) overrides every line's number of segments."""
    counts = with_segments(scene, segments)
    line_nodes = sum(counts) + len(counts)
    loaded = [point.kind not in _KINDS or point.mass + point.volume + point.drag_area > 0.0 for point in scene.points]
    size = -(-(line_nodes + sum(loaded)) // LANES) * LANES
    inside, beyond = iter(range(line_nodes, size)), iter(range(size + 1, size + 1 + len(loaded)))
    point_nodes = [next(inside) if own else next(beyond) for own in loaded]
    n = size + 2 + len(loaded) - sum(loaded)
    env = scene.environment
    rows = {
        name: np.zeros(n)
        for name in Model._fields[Model._fields.index("stiffness") : Model._fields.index("bed_damping") + 1]
    }
    rows["inverse_length"][:] = 1.0
    rows["length"][:] = 1.0
    rows["mass"][line_nodes + sum(loaded) : size + 1] = 1.0

    point_index = {point.id: i for i, point in enumerate(scene.points)}
    end_node, end_point, first_node, fairlead_end = [], [], [], []
    start = 0
    for line, count in zip(scene.lines, counts):
        _place_line(rows, line, start, count, env)
        first_node.append(start)
        end_node += [start, start + count]
        end_point += [point_index[line.end_a], point_index[line.end_b]]
        kinds = [scene.point(id).kind for id in (line.end_a, line.end_b)]
        fairlead_end.append(0 if kinds[0] == COUPLED and kinds[1] != COUPLED else 1)
        start += count + 1
    diameters = [_place_point(rows, point, node, env) for point, node in zip(scene.points, point_nodes)]

    kinds = np.array([_KINDS.get(point.kind, POINT_FREE) for point in scene.points], dtype=np.int64)
    model = Model(
        size=size,
        **rows,
        bed_level=-float(env.depth),
        current=np.array(env.current, dtype=float),
        natural_speed=natural_speed(scene),
        reach=max((np.linalg.norm(point.position) for point in scene.points if point.kind == COUPLED), default=0.0),
        end_node=np.array(end_node, dtype=np.int64),
        point_node=np.array(point_nodes, dtype=np.int64),
        point_kind=kinds,
        point_place=np.array([point.position for point in scene.points], dtype=float).reshape(-1, 3),
        point_diameter=np.array(diameters, dtype=float),
        free_points=np.flatnonzero(kinds == POINT_FREE),
        coupled_points=np.flatnonzero(kinds == POINT_COUPLED),
        first_node=np.array(first_node, dtype=np.int64),
        segments=np.array(counts, dtype=np.int64),
        fairlead_end=np.array(fairlead_end, dtype=np.int64),
    )
    return model, np.array(end_point, dtype=np.int64)


_KINDS = {FIXED: POINT_FIXED, COUPLED: POINT_COUPLED}


def natural_speed(scene):
    """Free fall through the mooring's height, the current, and 5 % of strain let loose, m/s."""
    env = scene.environment
    fall = np.sqrt(2.0 * env.gravity * (env.depth + max(line.length for line in scene.lines)))
    recoil = 0.05 * max(np.sqrt(line.type.stiffness / line.type.mass) for line in scene.lines)
    return float(fall + np.linalg.norm(env.current) + recoil)


def internal_damping(line_type, segment_length):
    """BA in N s; a negative entry is the fraction of critical of a segment: zeta l sqrt(EA m)."""
    if line_type.damping >= 0.0:
        return line_type.damping
    return -line_type.damping * segment_length * np.sqrt(line_type.stiffness * line_type.mass)


def _place_line(rows, line, start, count, env):
    kind = line.type
    length = line.length / count
    segments = slice(start + 1, start + count + 1)
    rows["stiffness"][segments] = kind.stiffness
    rows["damping"][segments] = internal_damping(kind, length) / length
    rows["inverse_length"][segments] = 1.0 / length
    rows["length"][segments] = length
    rows["live"][segments] = 1.0
    rows["diameter"][segments] = kind.diameter
    submerged = (kind.mass - env.water_density * 0.25 * np.pi * kind.diameter**2) * env.gravity * line.length
    rows["tension_scale"][segments] = max(abs(submerged), 1e-5 * kind.stiffness)

    nodes = slice(start, start + count + 1)
    lumped = np.full(count + 1, length)  # unstretched length that a node carries
    lumped[[0, -1]] *= 0.5
    rows["share_left"][nodes] = 0.5
    rows["share_right"][nodes] = 0.5
    rows["share_left"][start], rows["share_right"][start] = 0.0, 1.0
    rows["share_left"][start + count], rows["share_right"][start + count] = 1.0, 0.0
    area = 0.25 * np.pi * kind.diameter**2
    displaced = env.water_density * area * lumped
    rows["mass"][nodes] = kind.mass * lumped
    rows["added_normal"][nodes] = displaced * kind.added_mass_normal
    rows["added_axial"][nodes] = displaced * kind.added_mass_axial
    rows["weight"][nodes] = kind.mass * env.gravity * lumped
    rows["buoyancy"][nodes] = displaced * env.gravity
    half_density = 0.5 * env.water_density
    rows["drag_normal"][nodes] = half_density * kind.diameter * lumped * kind.drag_normal
    rows["drag_axial"][nodes] = half_density * np.pi * kind.diameter * lumped * kind.drag_axial
    rows["bed_stiffness"][nodes] = env.bed_stiffness * kind.diameter * lumped
    rows["bed_damping"][nodes] = env.bed_damping * kind.diameter * lumped


def _place_point(rows, point, node, env):
    """A point is a sphere of its volume; drag and added mass act alike in all directions. Returns its diameter."""
    diameter = (6.0 * point.volume / np.pi) ** (1.0 / 3.0)
    contact = 0.25 * np.pi * diameter**2
    displaced = env.water_density * point.volume
    rows["mass"][node] = point.mass
    rows["added_normal"][node] = rows["added_axial"][node] = displaced * point.added_mass
    rows["weight"][node] = point.mass * env.gravity
    rows["buoyancy"][node] = displaced * env.gravity
    rows["drag_normal"][node] = 0.5 * env.water_density * point.drag_area
    rows["bed_stiffness"][node] = env.bed_stiffness * contact
    rows["bed_damping"][node] = env.bed_damping * contact
    return diameter


def new_state(model, end_point):
    """State at rest, everything at the origin; `statics.settle` places it."""
    n = model.mass.size
    position = np.zeros((3, n))
    position[2] = 2.0 * model.bed_level - 100.0  # dummies stay where they are, far below the surface
    return State(
        clock=np.zeros(1),
        pose=np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]),
        twist=np.zeros(6),
        acceleration_of_platform=np.zeros(6),
        position=position,
        velocity=np.zeros((3, n)),
        acceleration=np.zeros((3, n)),
        force=np.zeros((3, n)),
        tangent=np.zeros((3, n)),
        tension=np.zeros(n),
        strain_rate=np.zeros(n),
        wet=np.ones(n),
        inertia_normal=np.zeros(n),
        inertia_axial=np.zeros(n),
        bed_relief=np.ones(n),
        end_point=end_point.copy(),
        settings=np.array([0.0, 0.0, 0.0, 1.0, 0.0, np.inf]),
    )


def new_scratch(model):
    n = model.mass.size
    return Scratch(np.zeros((3, n)), np.zeros((3, n)), np.ones(n), np.zeros((2, 6, n)), np.zeros(n), np.zeros((8, 3)))
