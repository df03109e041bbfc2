"""Scene -> Model (constant arrays) and State (changing arrays).

All nodes of all lines stand one after the other in one structure of arrays, each line's end nodes its own; between lines lies a null
segment (no stiffness, not counted in tangents). Every internal point (layout.py) is a node as well. Those of a rod follow one another with
segments without stiffness between them, so that the same passes serve lines and rods; free points and those with a mass, volume or drag of
their own stand between null segments. Then come dummies that feel no force, up to a multiple of `LANES`: a pass is one plain loop over
range(size) without a remainder. Points that are merely held stand beyond it.

Segment i+1 joins nodes i and i+1; segment i is the one to the left of node i.
"""

from typing import NamedTuple

import numpy as np

from .clamps import Clamps, build_clamps
from .failures import Failures, build_failures, failure_rows
from .ground import NO_CONTACT, Ground, build_ground
from .hinges import Bending, build_bending
from .hulls import Hulls, build_hulls
from .layout import POINT_COUPLED, POINT_FREE, POINT_RIDING, Layout
from .packed import packed
from .ropes import Ropes, build_ropes, rope_damping
from .friction import NO_FRICTION, STICK
from .sea import Sea, build_sea, fastest_water
from .waves import WINDOW_ROWS, WORK_SIZE

LANES = 8  # nodes: a whole number of vectors
AXIAL_WORK = 12  # rows of work space of axial.py
MOST_JOINTS = 600  # free points that axial.py solves for together
LOOSE = -1  # an end that nothing holds any more


@packed
class Rigid(NamedTuple):
    """Rigid parts that move by themselves: B = parts, R = internal points that ride on them. Axes of the part about its origin unless said."""

    mass: np.ndarray  # (B,) kg, of what stands in `inertia`
    centre: np.ndarray  # (B, 3) m, of that mass
    inertia: np.ndarray  # (B, 3, 3) kg m^2
    added_surplus: np.ndarray  # (B, 3, 3) kg m^2: what lumps of added mass on rods have too much, when wet
    pin: np.ndarray  # (B,) internal point that carries the origin, or -1
    riding: np.ndarray  # (R,) internal points
    part: np.ndarray  # (P,) part of every internal point, or -1
    start: np.ndarray  # (B, 7) m and quaternion x, y, z, w, world: where the scene puts it


@packed
class Model(NamedTuple):
    """What does not change. n = all nodes and one more; E = 2 x lines (end A, end B of each in turn); P = internal points; O = outputs; M = platforms.
    World frame, SI."""

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
    natural_speed: float  # m/s that a sound mooring hardly passes while its ends stand still
    gentle: float  # m/s: least of the lines' weight over their impedance, sqrt(EA m), for axial waves
    reach: np.ndarray  # (M,) m from each platform's reference point to the farthest point that it carries
    bulk: float  # m, radius of the thickest of all
    # ends, (E,)
    end_node: np.ndarray  # index of the line's end node
    # points, (P,)
    point_node: np.ndarray  # index of the point's node
    point_kind: np.ndarray  # POINT_*
    point_platform: np.ndarray  # platform that carries a coupled one, or -1
    point_place: np.ndarray  # (P, 3), m: fixed: world; coupled: in its platform's frame; free: where it starts
    point_diameter: np.ndarray  # m, of the sphere of its volume
    free_points: np.ndarray  # indices of the free ones
    coupled_points: np.ndarray  # ... and of the coupled ones, platform by platform
    coupled_first: np.ndarray  # (M + 1,) where those of each platform begin among them
    free_index: np.ndarray  # row of a free point among the free ones, or -1
    output_of: np.ndarray  # the output that it belongs to, or -1
    # outputs: coupled points, rods and bodies, (O,)
    output_point: np.ndarray  # internal point at which its wrench is given
    output_inertia: np.ndarray  # (O, 3, 3) kg m^2, its platform's axes: what lumps of mass do not have
    output_surplus: np.ndarray  # (O, 3, 3) kg m^2: what lumps of added mass on rods have too much, when wet
    # lines, (lines,)
    first_node: np.ndarray
    segments: np.ndarray
    fairlead_end: np.ndarray  # 0 or 1: which end of the line is its fairlead
    rigid: Rigid
    hulls: Hulls
    ropes: Ropes
    failures: Failures
    bending: Bending
    clamps: Clamps
    ground: Ground
    sea: Sea


@packed
class State(NamedTuple):
    """What changes, all of it: a snapshot is a copy of these arrays. Shapes as in Model."""

    clock: np.ndarray  # (1,), s
    pose: np.ndarray  # (M, 7) of the platforms, m and quaternion x, y, z, w
    twist: np.ndarray  # (M, 6), m/s, rad/s, world
    acceleration_of_platform: np.ndarray  # (M, 6), m/s^2, rad/s^2, world: mean over the last interval, or over a step where that is longer
    parts: np.ndarray  # (B, 13): place (m), quaternion, velocity (m/s) and spin (rad/s) of the rigid parts, world
    parts_acceleration: np.ndarray  # (B, 6), m/s^2, rad/s^2, world
    parts_reaction: np.ndarray  # (B, 6), N and N m of pinned parts on what carries their origin
    position: np.ndarray  # (3, n), m
    velocity: np.ndarray  # (3, n), m/s
    lead: np.ndarray  # (3, n), m/s: what velocities gain from the half step before the places to their time, where a scheme staggers them
    acceleration: np.ndarray  # (3, n), m/s^2
    filtered: np.ndarray  # (3, n), m/s^2: acceleration that carries the implicit steps (implicit_newton.py)
    parts_filtered: np.ndarray  # (B, 6), m/s^2, rad/s^2
    tension_rate: np.ndarray  # (n,), N/s: of the tensions over the last implicit step (implicit_control.py)
    force: np.ndarray  # (3, n), N: all forces on a node but inertia
    tangent: np.ndarray  # (3, n): unit vectors of the segments, null for null segments
    tension: np.ndarray  # (n,), N, of the segments
    strain_rate: np.ndarray  # (n,), m/s: rate of the segments' stretched length
    creep: np.ndarray  # (n,), strain of the slow elements of viscoelastic ropes; (0,) without any
    creep_rate: np.ndarray  # (n,), 1/s
    stream: np.ndarray  # (3, n), m/s: velocity of the water at the nodes
    swell: np.ndarray  # (4, n): its acceleration in waves (m/s^2) and their elevation (m); (4, 0) without waves
    wet: np.ndarray  # (n,), wet share of the nodes, 0..1
    inertia_normal: np.ndarray  # (n,), kg
    inertia_axial: np.ndarray  # (n,), kg
    bed_relief: np.ndarray  # (n,): factor on the vertical acceleration of a node that the bed pushes, 0..1 (seabed.py); ones on other beds
    clamp_axis: np.ndarray  # (C, 3), unit vectors from the clamps into their lines
    clamp_moment: np.ndarray  # (C, 3), N m on what holds the clamp
    grip: np.ndarray  # (4, n): what the friction law `stick` remembers (ground.py); (4, 0) without it
    expected: np.ndarray  # (3, n), m/s^2: acceleration of nodes that share their motion at the last step, none of others; (3, 0) without friction
    window: np.ndarray  # (2, rows, n): the waves at the nodes at two times (waves.py); (2, rows, 0) without any
    window_times: np.ndarray  # (2,), s
    slaved: np.ndarray  # (n,): whether the node shares its motion with others
    end_point: np.ndarray  # (E,) index of the point that holds the end, or LOOSE
    failed: np.ndarray  # (F,) 1 for a failure that has happened
    settings: np.ndarray  # (10,) drag time (s), Euler step of stiff local laws (s), 1 if wet shares are computed; refinement of the step, kept until (s); largest strain; time of the evaluation (s), 1 in the statics; time by which velocities stand back from places (s), and the same where the rates of length are taken as they are


@packed
class Scratch(NamedTuple):
    """Work space of a step; nothing in it outlives one."""

    position: np.ndarray  # (3, n), of a step's start
    velocity: np.ndarray  # (3, n)
    wet_segment: np.ndarray  # (n,)
    wet_moment: np.ndarray  # (n,)
    saved: np.ndarray  # (2, 9, n): position, velocity and lead at the start of the interval and of the chunk
    axial: np.ndarray  # (13, n): work of axial.py
    joints: np.ndarray  # (3 F, 3 F): joints.py, with F free points
    envelope: np.ndarray  # (3 F,)
    joint_change: np.ndarray  # (3 F,), m/s
    tension: np.ndarray  # (n,), before a step's last stage
    motion: np.ndarray  # (M, 8, 3): platforms.start_motions
    saved_platforms: np.ndarray  # (M, 6): their accelerations at the interval's start
    parts: np.ndarray  # (B, 13), of a step's start
    creep: np.ndarray  # as in State, of a step's start
    saved_parts: np.ndarray  # (2, B, 13), and so on: as `saved`
    saved_creep: np.ndarray
    saved_axes: np.ndarray  # (2, C, 3)
    saved_ends: np.ndarray  # (2, E)
    saved_failed: np.ndarray  # (2, F)
    saved_grip: np.ndarray  # (2, 4, n) or (2, 4, 0)
    saved_expected: np.ndarray  # (2, 3, n) or (2, 3, 0)
    saved_window: np.ndarray  # (2, rows, n): of the interval's start
    saved_window_times: np.ndarray  # (2,)
    bending: np.ndarray  # (5, n): work of bending.py
    bed: np.ndarray  # (4, n): level of the bed under the nodes (m) and its unit normal
    hold: np.ndarray  # (2, n), kg: inertia that stands for the bed's contact, along its normal and in its plane
    wave_work: np.ndarray  # (WORK_SIZE,): waves.refresh
    load: np.ndarray  # (P, 9): force (N) and inertia xx, yy, zz, xy, xz, yz (kg) of what moves with each point
    matrix: np.ndarray  # (6, 8): equations of motion of a part, and work of their solution


def with_segments(scene, segments):
    """Segments of each line: as in the file, or `segments` for all."""
    return [line.segments if segments is None else segments for line in scene.lines]


def build(scene, segments=None, layout=None):
    """(Model, end_point (E,)) of `scene`; `segments` (int) overrides every line's number of segments, `layout` is its Layout if there is one already."""
    counts = with_segments(scene, segments)
    layout = layout or Layout(scene)
    line_nodes = sum(counts) + len(counts)
    in_rods = [p for rod in layout.rods.values() if rod.length > 0.0 for p in rod.points]
    inside = in_rods + [p for p, place in enumerate(layout.points) if place.loaded and p not in set(in_rods)]
    size = -(-(line_nodes + len(inside)) // LANES) * LANES
    point_node = np.full(len(layout.points), -1, dtype=np.int64)
    point_node[inside] = line_nodes + np.arange(len(inside))
    beyond = np.flatnonzero(point_node < 0)
    point_node[beyond] = size + 1 + np.arange(beyond.size)
    n = size + 2 + beyond.size
    env = scene.environment
    rows = {
        name: np.zeros(n)
        for name in Model._fields[Model._fields.index("stiffness") : Model._fields.index("bed_damping") + 1]
    }
    rows["inverse_length"][:] = 1.0
    rows["length"][:] = 1.0
    rows["mass"][line_nodes + len(inside) : size + 1] = 1.0

    end_node, end_point, first_node, fairlead_end = [], [], [], []
    start = 0
    for line, count in zip(scene.lines, counts):
        _place_line(rows, line, start, count, env)
        first_node.append(start)
        end_node += [start, start + count]
        end_point += [layout.holder(line.end_a), layout.holder(line.end_b)]
        fairlead_end.append(0 if layout.rank(line.end_a) > layout.rank(line.end_b) else 1)
        start += count + 1
    for rod in layout.rods.values():
        if rod.length > 0.0:
            riding = [layout.points[p].kind == POINT_RIDING for p in rod.points]
            _place_rod(rows, rod, point_node[rod.points[0]], any(riding), env)
    diameters = [_place_point(rows, place, node, env) for place, node in zip(layout.points, point_node)]

    kinds = np.array([place.kind for place in layout.points], dtype=np.int64)
    platforms = np.array([place.platform for place in layout.points], dtype=np.int64)
    coupled = np.flatnonzero(kinds == POINT_COUPLED)
    coupled = coupled[np.argsort(platforms[coupled], kind="stable")]
    coupled_first = np.searchsorted(platforms[coupled], np.arange(layout.platform_count + 1))
    places = np.array([place.position for place in layout.points], dtype=float).reshape(-1, 3)
    model = Model(
        size=size,
        **rows,
        bed_level=-float(env.depth),
        natural_speed=natural_speed(scene),
        gentle=_gentle(scene, rows, first_node),
        reach=np.array([np.linalg.norm(places[platforms == m], axis=1).max(initial=0.0) for m in range(layout.platform_count)]),
        bulk=0.5 * max(rows["diameter"].max(), *diameters),
        end_node=np.array(end_node, dtype=np.int64),
        point_node=point_node,
        point_kind=kinds,
        point_platform=platforms,
        point_place=places,
        point_diameter=np.array(diameters, dtype=float),
        free_points=np.flatnonzero(kinds == POINT_FREE),
        coupled_points=coupled,
        coupled_first=coupled_first,
        free_index=np.where(kinds == POINT_FREE, np.cumsum(kinds == POINT_FREE) - 1, -1),
        output_of=np.array([place.attachment for place in layout.points], dtype=np.int64),
        output_point=np.array(layout.output_point, dtype=np.int64),
        output_inertia=np.array(layout.output_inertia, dtype=float).reshape(-1, 3, 3),
        output_surplus=env.water_density * np.array(layout.output_surplus, dtype=float).reshape(-1, 3, 3),
        first_node=np.array(first_node, dtype=np.int64),
        segments=np.array(counts, dtype=np.int64),
        fairlead_end=np.array(fairlead_end, dtype=np.int64),
        rigid=_rigid(layout, kinds, env),
        hulls=build_hulls(layout.hulls, env.water_density),
        ropes=build_ropes([(line.type, start, count, line.length / count) for line, start, count in zip(scene.lines, first_node, counts)]),
        failures=_failures(scene, layout),
        bending=_bending(scene, layout, first_node, counts, n),
        clamps=build_clamps(layout.clamps(scene), platforms),
        ground=build_ground(env),
        sea=build_sea(env),
    )
    return model, np.array(end_point, dtype=np.int64)


def _rigid(layout, kinds, env):
    parts, density = layout.parts, env.water_density

    def rows(values, *shape, dtype=float):
        return np.array(values, dtype=dtype).reshape(-1, *shape)

    return Rigid(
        mass=rows([part.mass for part in parts]),
        centre=rows([part.centre for part in parts], 3),
        inertia=rows([part.inertia for part in parts], 3, 3),
        added_surplus=rows([density * part.added_surplus for part in parts], 3, 3),
        pin=rows([part.pin for part in parts], dtype=np.int64),
        riding=np.flatnonzero(kinds == POINT_RIDING),
        part=np.array([place.part for place in layout.points], dtype=np.int64),
        start=rows([np.concatenate([part.position, part.turn]) for part in parts], 7),
    )


def _bending(scene, layout, first_node, counts, n):
    lines = [
        (first, count, line.length / count, line.type.bending_stiffness) for line, first, count in zip(scene.lines, first_node, counts)
    ]
    return build_bending(lines, [(end, point) for end, point, *_ in layout.clamps(scene)], layout.joints(scene), n, scene.bending)


def _failures(scene, layout):
    holders = {failure.holder: layout.holder(failure.holder) for failure in scene.failures}
    return build_failures(failure_rows(scene.failures, scene.lines, holders, layout.failure_points.start))


def natural_speed(scene):
    """Free fall through the mooring's height, current and waves, and 5 % of strain let loose, m/s."""
    env = scene.environment
    fall = np.sqrt(2.0 * env.gravity * (env.depth + max(line.length for line in scene.lines)))
    recoil = 0.05 * max(np.sqrt(line.type.stiffness / line.type.mass) for line in scene.lines)
    return float(fall + fastest_water(env) + recoil)


def _gentle(scene, rows, first_node):
    scales = (rows["tension_scale"][first + 1] for first in first_node)
    return float(min(scale / np.sqrt(line.type.stiffness * line.type.mass) for scale, line in zip(scales, scene.lines)))


def _place_line(rows, line, start, count, env):
    kind = line.type
    length = line.length / count
    segments = slice(start + 1, start + count + 1)
    rows["stiffness"][segments] = kind.stiffness
    rows["damping"][segments] = rope_damping(kind, length) / length
    rows["inverse_length"][segments] = 1.0 / length
    rows["length"][segments] = length
    rows["live"][segments] = 1.0
    rows["diameter"][segments] = kind.diameter
    submerged = (kind.mass - env.water_density * 0.25 * np.pi * kind.diameter**2) * env.gravity * line.length
    rows["tension_scale"][segments] = max(abs(submerged), 1e-5 * kind.stiffness)

    nodes = slice(start, start + count + 1)
    lumped = _lumps(rows, start, count, length)
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


def _place_rod(rows, rod, start, rides, env):
    """A rod's nodes, like those of a line without stiffness; one that rides on a part leaves its mass (not its weight) to the part."""
    kind, count = rod.type, len(rod.points) - 1
    length = rod.length / count
    segments, nodes = slice(start + 1, start + count + 1), slice(start, start + count + 1)
    rows["inverse_length"][segments] = 1.0 / length
    rows["length"][segments] = length
    rows["live"][segments] = 1.0
    rows["diameter"][segments] = kind.diameter
    lumped = _lumps(rows, start, count, length)
    area = 0.25 * np.pi * kind.diameter**2
    displaced = env.water_density * area * lumped
    rows["mass"][nodes] = 0.0 if rides else kind.mass * lumped
    rows["weight"][nodes] = kind.mass * env.gravity * lumped
    rows["buoyancy"][nodes] = displaced * env.gravity
    rows["added_normal"][nodes] = displaced * kind.added_mass_normal
    rows["drag_normal"][nodes] = 0.5 * env.water_density * kind.diameter * lumped * kind.drag_normal
    rows["bed_stiffness"][nodes] = env.bed_stiffness * kind.diameter * lumped
    rows["bed_damping"][nodes] = env.bed_damping * kind.diameter * lumped
    for end in (start, start + count):
        rows["drag_axial"][end] = 0.5 * env.water_density * area * kind.drag_end
        rows["added_axial"][end] = env.water_density * np.pi * kind.diameter**3 / 12.0 * kind.added_mass_end  # on a half sphere


def _lumps(rows, start, count, length):
    """Unstretched length (count + 1,) that each node carries, and whose share is whose."""
    nodes = slice(start, start + count + 1)
    lumped = np.full(count + 1, length)
    lumped[[0, -1]] *= 0.5
    rows["share_left"][nodes] = 0.5
    rows["share_right"][nodes] = 0.5
    rows["share_left"][start], rows["share_right"][start] = 0.0, 1.0
    rows["share_left"][start + count], rows["share_right"][start + count] = 1.0, 0.0
    return lumped


def _place_point(rows, place, node, env):
    """A point is a sphere of its volume; drag and added mass act alike in all directions. Returns its diameter."""
    diameter = (6.0 * place.volume / np.pi) ** (1.0 / 3.0)
    contact = 0.25 * np.pi * diameter**2
    displaced = env.water_density * place.volume
    rows["mass"][node] += place.mass
    rows["added_normal"][node] += displaced * place.added_mass
    rows["added_axial"][node] += displaced * place.added_mass
    rows["weight"][node] += place.weight * env.gravity
    rows["buoyancy"][node] += displaced * env.gravity
    rows["drag_normal"][node] += 0.5 * env.water_density * place.drag_area
    rows["bed_stiffness"][node] += env.bed_stiffness * contact
    rows["bed_damping"][node] += env.bed_damping * contact
    return diameter


def _sizes(model):
    """Nodes of which the state holds slow strains, grips, expected accelerations and waves: all or none."""
    n = model.mass.size
    needed = (model.ropes.kelvin_first.size, model.ground.law == STICK, model.ground.law != NO_FRICTION, model.sea.frequency.size)
    return tuple(n if need else 0 for need in needed)


def new_state(model, end_point):
    """State at rest, everything at the origin; `statics.settle` places it."""
    n, parts, clamps = model.mass.size, model.rigid.mass.size, model.clamps.part.size
    creeping, gripping, rubbing, waving = _sizes(model)
    slaved = np.zeros(n, dtype=bool)
    slaved[model.end_node] = slaved[model.point_node] = True
    position = np.zeros((3, n))
    position[2] = 2.0 * model.bed_level - 100.0  # dummies stay where they are, far below the surface
    stream = np.zeros((3, n))
    stream[:] = model.sea.current[:, None]
    return State(
        clock=np.zeros(1),
        pose=np.tile([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], (model.reach.size, 1)),
        twist=np.zeros((model.reach.size, 6)),
        acceleration_of_platform=np.zeros((model.reach.size, 6)),
        parts=np.hstack([model.rigid.start, np.zeros((parts, 6))]),
        parts_acceleration=np.zeros((parts, 6)),
        parts_reaction=np.zeros((parts, 6)),
        position=position,
        velocity=np.zeros((3, n)),
        lead=np.zeros((3, n)),
        acceleration=np.zeros((3, n)),
        force=np.zeros((3, n)),
        filtered=np.zeros((3, n)),
        parts_filtered=np.zeros((parts, 6)),
        tension_rate=np.zeros(n),
        tangent=np.zeros((3, n)),
        tension=np.zeros(n),
        strain_rate=np.zeros(n),
        creep=np.zeros(creeping),
        creep_rate=np.zeros(creeping),
        stream=stream,
        swell=np.zeros((4, waving)),
        wet=np.ones(n),
        inertia_normal=np.zeros(n),
        inertia_axial=np.zeros(n),
        bed_relief=np.ones(n),
        clamp_axis=model.clamps.axis.copy(),
        clamp_moment=np.zeros((clamps, 3)),
        grip=np.full((4, gripping), NO_CONTACT),
        expected=np.zeros((3, rubbing)),
        window=np.zeros((2, WINDOW_ROWS, waving)),
        window_times=np.array([0.0, -1.0]),
        slaved=slaved,
        end_point=end_point.copy(),
        failed=np.zeros(model.failures.point.size, dtype=np.int64),
        settings=np.array([0.0, 0.0, 0.0, 1.0, 0.0, np.inf, 0.0, 0.0, 0.0, 0.0]),
    )


def new_scratch(model):
    n, parts = model.mass.size, model.rigid.mass.size
    creeping, gripping, rubbing, waving = _sizes(model)
    joints = 3 * model.free_points.size if model.free_points.size <= MOST_JOINTS else 0
    return Scratch(
        position=np.zeros((3, n)),
        velocity=np.zeros((3, n)),
        wet_segment=np.ones(n),
        wet_moment=np.zeros(n),
        saved=np.zeros((2, 9, n)),
        axial=np.zeros((AXIAL_WORK, n)),
        joints=np.zeros((joints, joints)),
        envelope=np.zeros(joints, dtype=np.int64),
        joint_change=np.zeros(joints),
        tension=np.zeros(n),
        motion=np.zeros((model.reach.size, 8, 3)),
        saved_platforms=np.zeros((model.reach.size, 6)),
        parts=np.zeros((parts, 13)),
        creep=np.zeros(creeping),
        saved_parts=np.zeros((2, parts, 13)),
        saved_creep=np.zeros((2, creeping)),
        saved_axes=np.zeros((2, model.clamps.part.size, 3)),
        saved_ends=np.zeros((2, model.end_node.size), dtype=np.int64),
        saved_failed=np.zeros((2, model.failures.point.size), dtype=np.int64),
        saved_grip=np.zeros((2, 4, gripping)),
        saved_expected=np.zeros((2, 3, rubbing)),
        saved_window=np.zeros((2, WINDOW_ROWS, waving)),
        saved_window_times=np.zeros(2),
        bending=np.zeros((5, n if model.bending.stiffness.size else 0)),
        bed=np.zeros((4, n if model.ground.on else 0)),
        hold=np.zeros((3, n if model.ground.on else 0)),
        wave_work=np.zeros(WORK_SIZE if waving else 0),
        load=np.zeros((model.point_node.size, 9)),
        matrix=np.zeros((6, 8)),
    )
