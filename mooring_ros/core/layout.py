"""Where everything of a scene stands in the arrays of the core: lines, rods, points, bodies.

Every place where something can be held is an internal point: the scene's points, the nodes of the rods, of each body one at its centre of
gravity (with its weight) and one at its origin (with its volume), and for each failure one that takes the ends it lets go.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from ..scene import BODY, COUPLED, COUPLED_PINNED, FIXED, FREE, PINNED, RodEnd

# kinds of internal points
POINT_FIXED, POINT_COUPLED, POINT_FREE, POINT_RIDING = 0, 1, 2, 3
NO_PART, NO_PIN, NO_PLATFORM = -1, -1, -1

_AT_ORIGIN = dict(position=(0.0, 0.0, 0.0), orientation=(0.0, 0.0, 0.0, 1.0))
_KINDS = {FIXED: POINT_FIXED, COUPLED: POINT_COUPLED, FREE: POINT_FREE}


@dataclass
class Place:
    """An internal point: its kind, its place (fixed: world; coupled: the platform's axes; free: where it starts; riding: its part's axes), and loads."""

    kind: int
    position: np.ndarray  # (3,) m
    part: int = NO_PART
    platform: int = NO_PLATFORM  # that carries a coupled one
    mass: float = 0.0  # kg
    weight: float = 0.0  # kg: what gravity pulls at
    volume: float = 0.0  # m^3
    drag_area: float = 0.0  # CdA, m^2
    added_mass: float = 0.0  # Ca
    attachment: int = -1  # of a coupled one: the output that it belongs to
    hull: bool = False  # whether a Hull stands there

    @property
    def loaded(self):
        return self.kind == POINT_FREE or self.hull or self.mass + self.weight + self.volume + self.drag_area > 0.0


@dataclass
class Part:
    """A rigid part that moves by itself: its frame starts at `position` (3,) m and `turn` (4,), x, y, z, w."""

    position: np.ndarray
    turn: np.ndarray
    pin: int = NO_PIN  # internal point that carries its origin
    mass: float = 0.0  # kg
    centre: np.ndarray = field(default_factory=lambda: np.zeros(3))  # (3,) m, its axes
    inertia: np.ndarray = field(default_factory=lambda: np.zeros((3, 3)))  # kg m^2 about its origin, its axes
    added_surplus: np.ndarray = field(default_factory=lambda: np.zeros((3, 3)))  # m^5: what lumps of added mass on its rods have too much, over rho

    def add(self, mass, centre, inertia):
        """Add a mass (kg) with its centre (3,) m and its inertia (3, 3) about it."""
        total = self.mass + mass
        if total > 0.0:
            self.centre = (self.mass * self.centre + mass * centre) / total
        self.mass = total
        self.inertia += inertia + mass * ((centre @ centre) * np.eye(3) - np.outer(centre, centre))


@dataclass
class Hull:
    """A body's own volume in the water, at the internal point of its origin."""

    point: int
    part: int  # that carries it, or NO_PART: the platform does
    output: int  # of a coupled body
    turn: tuple  # quaternion from the body's axes to those of the carrier
    drag_area: tuple  # CdA, m^2, m^5
    added_volume: tuple  # Ca V, m^3


@dataclass
class RodNodes:
    """A rod's internal points, end A first, and what stands between them; `axis` (3,) from A to B in the axes of what carries it."""

    type: object
    points: range
    length: float  # m
    axis: np.ndarray
    free_joint: bool  # of length zero and free to turn: it hands moments from line to line
    part: int  # that turns it, or NO_PART


class Layout:
    """Internal points, parts, rods and outputs of a scene, whose coupled things ride on one platform, or on several.

    platforms: names of coupled bodies, each a platform of its own: its axes are the body's, and what is coupled rides on one of them
    (`platforms.checked_platforms`). Without any there is one platform, whose axes at its zero pose are the world's.
    points, parts, hulls: lists of Place, Part and Hull. rods: dict of rod id -> RodNodes. body_parts: dict of body id -> part of the free ones.
    outputs: names of the coupled points, rods and bodies.
    """

    def __init__(self, scene, platforms=()):
        self.points, self.parts, self.hulls, self.rods, self.outputs = [], [], [], {}, []
        self.output_point, self.output_inertia, self.output_surplus = [], [], []  # of each output: see _output
        numbers = {name: number for number, name in enumerate(platforms)}
        self.platform_count = max(len(platforms), 1)
        self.platforms = {body.id: numbers.get(body.name, 0) for body in scene.bodies if body.kind == COUPLED}
        self._bodies = {body.id: replace(body, **_AT_ORIGIN) if body.name in numbers else body for body in scene.bodies}
        self.body_parts = {}
        for body in scene.bodies:
            if body.kind == FREE:
                self.body_parts[body.id] = len(self.parts)
                self.parts.append(Part(np.array(body.position), np.array(body.orientation)))
        for point in scene.points:
            self._add_scene_point(point)
        for rod in scene.rods:
            self._add_rod(rod)
        for body in self._bodies.values():
            self._add_body(body)
        self.failure_points = range(len(self.points), len(self.points) + len(scene.failures))
        self.points += [Place(POINT_FREE, np.zeros(3)) for _ in scene.failures]
        self._point_index = {point.id: i for i, point in enumerate(scene.points)}

    def holder(self, end):
        """Internal point of a line's end: a point id or a RodEnd."""
        if isinstance(end, RodEnd):
            points = self.rods[end.rod].points
            return points[0] if end.end == "A" else points[-1]
        return self._point_index[end]

    def rank(self, end):
        """Of the two ends of a line the one with the higher rank is its fairlead: coupled ones before those that move by themselves, these before fixed ones."""
        kind = self.points[self.holder(end)].kind
        return 2 if kind == POINT_COUPLED else 0 if kind == POINT_FIXED else 1

    def clamps(self, scene):
        """[(line end, internal point, axis (3,) into the line in the axes of what turns it, part or NO_PART)] of all lines that bend at rods."""
        found = []
        for end, at in _bending_ends(scene):
            rod = self.rods[at.rod]
            if rod.axis.any() and not rod.free_joint:
                found.append((end, self.holder(at), rod.axis if at.end == "B" else -rod.axis, rod.part))
        return found

    def joints(self, scene):
        """[(internal point, [(line end, 1.0 or -1.0: the line leaves on the side of end B or of end A)])] of rods of length zero that may turn."""
        members = {}
        for end, at in _bending_ends(scene):
            if self.rods[at.rod].free_joint:
                members.setdefault(self.holder(at), []).append((end, 1.0 if at.end == "B" else -1.0))
        return list(members.items())

    # -- carriers ---------------------------------------------------------------------------------------------------------------------

    def _carried(self, kind, body_id, position):
        """(kind, place, part, platform) of something at `position` (3,) in the axes that the file gives it in."""
        position = np.array(position, dtype=float)
        if kind != BODY:
            return _KINDS[kind], position, NO_PART, 0 if kind == COUPLED else NO_PLATFORM
        body = self._bodies[body_id]
        if body.kind == FREE:
            return POINT_RIDING, position, self.body_parts[body_id], NO_PLATFORM
        place = np.array(body.position) + turned(body.orientation, position)
        return _KINDS[body.kind], place, NO_PART, self.platforms.get(body_id, NO_PLATFORM)

    def _output(self, name, point, inertia=0.0, surplus=0.0):
        """Add an output: its internal point, the inertia (3, 3) that its lumps of mass do not have (kg m^2), and what those of added mass have too much (m^5)."""
        self.outputs.append(name)
        self.output_point.append(point)
        self.output_inertia.append(inertia + np.zeros((3, 3)))
        self.output_surplus.append(surplus + np.zeros((3, 3)))
        return len(self.outputs) - 1

    def _add_scene_point(self, point):
        kind, place, part, platform = self._carried(point.kind, point.body, point.position)
        own = Place(kind, place, part, platform, point.mass, point.mass, point.volume, point.drag_area, point.added_mass)
        if kind == POINT_COUPLED:
            own.attachment = self._output(point.name, len(self.points))
        if kind == POINT_RIDING:
            self.parts[part].add(point.mass, place, np.zeros((3, 3)))
            own.mass = 0.0
        self.points.append(own)

    # -- rods -------------------------------------------------------------------------------------------------------------------------

    def _add_rod(self, rod):
        a, b = np.array(rod.end_a, dtype=float), np.array(rod.end_b, dtype=float)
        span = b - a
        length = float(np.linalg.norm(span)) if rod.segments else 0.0
        axis = span / np.linalg.norm(span) if np.linalg.norm(span) > 0.0 else np.zeros(3)
        first = len(self.points)
        places = [a + s * span for s in np.linspace(0.0, 1.0, rod.segments + 1)] if length > 0.0 else [a]
        free_joint = length == 0.0 and rod.kind in (FREE, PINNED, COUPLED_PINNED)
        if length == 0.0:
            kind = {PINNED: FIXED, COUPLED_PINNED: COUPLED}.get(rod.kind, rod.kind)
            carried = [self._carried(kind, rod.body, a)]
        elif rod.kind in (FREE, PINNED, COUPLED_PINNED):
            carried = self._free_rod(rod, a, span, places)
        else:
            carried = [self._carried(rod.kind, rod.body, place) for place in places]
            if carried[0][0] == POINT_RIDING:
                self._add_rod_mass(self.parts[carried[0][2]], rod, 0.5 * (a + b), axis, length)
        if rod.kind == BODY and carried[0][0] != POINT_RIDING:
            axis = turned(self._bodies[rod.body].orientation, axis)
        output = -1
        if carried[0][0] == POINT_COUPLED:
            lumped = carried[-1][0] == POINT_COUPLED and length > 0.0  # not those of a pinned one
            output = self._output(rod.name, first, *(_beside_lumps(rod, axis, length) if lumped else ()))
        for *carrier, platform in carried:
            self.points.append(Place(*carrier, platform, attachment=output if platform != NO_PLATFORM else -1))
        self.rods[rod.id] = RodNodes(rod.type, range(first, len(self.points)), length, axis, free_joint, carried[-1][2])

    def _free_rod(self, rod, a, span, places):
        """The nodes of a rod that is a part of its own; a pinned one keeps its end A on a fixed or coupled point."""
        pinned = rod.kind != FREE
        origin = a if pinned else a + 0.5 * span
        part = Part(origin, np.array([0.0, 0.0, 0.0, 1.0]))
        length = float(np.linalg.norm(span))
        self._add_rod_mass(part, rod, a + 0.5 * span - origin, span / length, length)
        index = len(self.parts)
        self.parts.append(part)
        carried = [(POINT_RIDING, place - origin, index, NO_PLATFORM) for place in places]
        if pinned:
            part.pin = len(self.points)
            carried[0] = (POINT_FIXED, a, NO_PART, NO_PLATFORM) if rod.kind == PINNED else (POINT_COUPLED, a, NO_PART, 0)
        return carried

    @staticmethod
    def _add_rod_mass(part, rod, centre, axis, length):
        """Mass of a cylinder, and the surplus of its lumped added mass."""
        beside, surplus = _beside_lumps(rod, axis, length)
        mass = rod.type.mass * length
        lumped = mass * length**2 * (1.0 / 12.0 + 1.0 / (6.0 * rod.segments**2)) * (np.eye(3) - np.outer(axis, axis))
        part.add(mass, centre, lumped + beside)
        part.added_surplus += surplus

    # -- bodies -----------------------------------------------------------------------------------------------------------------------

    def _add_body(self, body):
        gravity = self._carried(BODY, body.id, body.centre_of_gravity)
        origin = self._carried(BODY, body.id, (0.0, 0.0, 0.0))
        rotation = np.array([turned(body.orientation, axis) for axis in np.eye(3)]).T
        inertia = np.diag(body.inertia).astype(float)
        first = len(self.points)
        weight, volume = Place(*gravity, weight=body.mass), Place(*origin, volume=body.volume)
        if body.kind == FREE:
            part = self.parts[self.body_parts[body.id]]
            part.add(body.mass, np.array(body.centre_of_gravity, dtype=float), inertia)
        else:
            weight.mass = body.mass
        output, turn = -1, (0.0, 0.0, 0.0, 1.0)
        if body.kind == COUPLED:
            output, turn = self._output(body.name, first + 1, rotation @ inertia @ rotation.T), body.orientation
        if body.kind != FIXED:
            weight.attachment = volume.attachment = output
            volume.hull = True
            added = tuple(ca * body.volume for ca in body.added_mass)
            self.hulls.append(Hull(first + 1, self.body_parts.get(body.id, NO_PART), output, turn, body.drag_area, added))
        self.points += [weight, volume]


def _bending_ends(scene):
    """(line end, RodEnd) of every end of a line with bending stiffness that is held by a rod."""
    for index, line in enumerate(scene.lines):
        for side, at in enumerate((line.end_a, line.end_b)):
            if line.type.bending_stiffness > 0.0 and isinstance(at, RodEnd):
                yield 2 * index + side, at


def _beside_lumps(rod, axis, length):
    """A cylinder's inertia (3, 3) less that of its lumps (kg m^2), and what lumps of added mass have too much (m^5): m L^2/6N^2 about axes across it."""
    mass, across = rod.type.mass * length, np.eye(3) - np.outer(axis, axis)
    square = (0.5 * rod.type.diameter) ** 2
    thick = mass * square * (0.25 * across + 0.5 * np.outer(axis, axis))
    surplus = length**2 / (6.0 * rod.segments**2) * across
    return thick - mass * surplus, 0.25 * np.pi * rod.type.diameter**2 * length * rod.type.added_mass_normal * surplus


def turned(quaternion, vector):
    """The vector (3,) turned by a unit quaternion x, y, z, w."""
    q, v = np.array(quaternion[:3], dtype=float), np.array(vector, dtype=float)
    t = 2.0 * np.cross(q, v)
    return v + quaternion[3] * t + np.cross(q, t)
