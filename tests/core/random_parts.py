"""Random scenes of one mooring line or more with rods, bodies, bending and a rough sloping bed: anything a file could say."""

import numpy as np
from scenes_in_code import COUPLED, FIXED, FREE

from mooring_ros.scene import STICK, Body, Environment, Friction, Line, LineType, Point, Rod, RodEnd, RodType, Scene

RHO = 1025.0


class Draft:
    """A scene while it is drawn up."""

    def __init__(self, rng):
        self.rng = rng
        self.depth = 10.0 ** rng.uniform(1.3, 2.6)
        self.slope = (float(rng.uniform(-0.2, 0.2)), float(rng.uniform(-0.2, 0.2))) if rng.random() < 0.3 else (0.0, 0.0)
        self.friction = None
        if rng.random() < 0.3:
            mu = float(rng.uniform(0.2, 1.0))
            self.friction = Friction(STICK, 1.2 * mu, 1.2 * mu, mu, mu)
        self.points, self.lines, self.rods, self.bodies = [], [], [], []
        mass = 10.0 ** rng.uniform(0.5, 2.5)
        diameter = np.sqrt(4.0 * mass / (np.pi * RHO * rng.uniform(1.5, 6.0)))
        stiffness = mass * 9.81 * self.depth * 10.0 ** rng.uniform(1.5, 4.0)
        bending = mass * 9.81 * self.depth * 10.0 ** rng.uniform(-2.0, 1.0) if rng.random() < 0.4 else 0.0
        self.kind = LineType("rope", diameter, mass, stiffness, -0.5, bending, drag_normal=1.2, added_mass_normal=1.0)
        self.line_weight = (mass - RHO * 0.25 * np.pi * diameter**2) * 9.81

    def bed(self, x, y):
        return -self.depth + self.slope[0] * x + self.slope[1] * y

    def point(self, kind, place, **own):
        self.points.append(Point(len(self.points) + 1, kind, tuple(float(x) for x in place), **own))
        return len(self.points)

    def anchor(self, angle, distance):
        x, y = distance * np.cos(angle), distance * np.sin(angle)
        return self.point(FIXED, (x, y, self.bed(x, y))), np.array([x, y, self.bed(x, y)])

    def line(self, a, b, place_a, place_b, slack=None):
        chord = float(np.linalg.norm(np.subtract(place_b, place_a)))
        slack = slack or self.rng.choice([1.005, 1.03, 1.1, 1.3])
        self.lines.append(Line(len(self.lines) + 1, self.kind, a, b, max(chord * slack, 1.0), int(self.rng.integers(3, 25))))

    def rod(self, kind, a, b, segments, diameter, mass, body=None):
        kind_of_rod = RodType(f"r{len(self.rods)}", float(diameter), float(mass), 0.8, 1.0)
        self.rods.append(Rod(len(self.rods) + 1, kind_of_rod, kind, tuple(map(float, a)), tuple(map(float, b)), segments, body))
        return len(self.rods)

    def scene(self):
        environment = Environment(depth=self.depth, bed_slope=self.slope, friction=self.friction)
        return Scene(
            path="", text="", line_types=(self.kind,), points=tuple(self.points), lines=tuple(self.lines), environment=environment,
            rods=tuple(self.rods), rod_types=tuple(rod.type for rod in self.rods), bodies=tuple(self.bodies),
        )  # fmt: skip


def buoy(draft):
    """A body with a hull of one rod on two to four legs, and perhaps a hawser to the platform; it may float or be drawn under."""
    rng = draft.rng
    length, diameter = rng.uniform(2.0, 10.0), rng.uniform(0.5, 5.0)
    full = RHO * 0.25 * np.pi * diameter**2 * length
    middle = np.array([rng.uniform(30.0, 100.0), 0.0, -0.2 * length])
    ballast = full * rng.uniform(0.05, 0.7)
    draft.bodies.append(
        Body(
            1,
            FREE,
            tuple(middle),
            mass=ballast,
            centre_of_gravity=(0.0, 0.0, -length * rng.uniform(0.2, 0.6)),
            inertia=(0.1 * ballast * length**2,) * 3,
        )
    )
    draft.rod("body", (0, 0, -0.5 * length), (0, 0, 0.5 * length), int(rng.integers(1, 9)), diameter, full * rng.uniform(0.05, 0.2) / length, 1)
    for k in range(int(rng.integers(2, 5))):
        angle = 2.0 * np.pi * k / 3.0 + rng.uniform(-0.4, 0.4)
        anchor, there = draft.anchor(angle, draft.depth * rng.uniform(0.8, 3.0))
        own = np.array([0.4 * diameter * np.cos(angle), 0.4 * diameter * np.sin(angle), -length * rng.uniform(0.0, 0.5)])
        draft.line(anchor, draft.point("body", own, body=1), there, middle + own)
    if rng.random() < 0.5:
        own = np.array([-0.4 * diameter, 0.0, 0.0])
        here = np.array([5.0, 0.0, 3.0])
        draft.line(draft.point("body", own, body=1), draft.point(COUPLED, here), middle + own, here)
    else:
        anchor, there = draft.anchor(np.pi, 1.5 * draft.depth)
        draft.line(anchor, draft.point(COUPLED, (0.0, 0.0, -2.0)), there, (0.0, 0.0, -2.0))


def rod_between(draft):
    """A free rod in the middle of a line, clamped to it when the line has bending stiffness; heavy or buoyant."""
    rng = draft.rng
    anchor, there = draft.anchor(rng.uniform(0.0, 6.0), draft.depth * rng.uniform(0.5, 3.0))
    top = np.array([0.0, 0.0, -draft.depth * rng.uniform(0.0, 0.2)])
    share, length = rng.uniform(0.3, 0.7), rng.uniform(1.0, 0.2 * draft.depth)
    along = (top - there) / np.linalg.norm(top - there)
    a = there + share * (top - there)
    b = a + length * along
    diameter = draft.kind.diameter * rng.uniform(1.0, 5.0)
    mass = RHO * 0.25 * np.pi * diameter**2 * rng.choice([0.5, 1.0, 1.5, 3.0])
    rod = draft.rod(FREE, a, b, int(rng.integers(1, 6)), diameter, mass)
    draft.line(anchor, RodEnd(rod, "A"), there, a)
    draft.line(RodEnd(rod, "B"), draft.point(COUPLED, top), b, top)


def clump_on_bridle(draft):
    """A heavy body under two lines to the platform, on one leg to an anchor; on the bed where the lines are long."""
    rng = draft.rng
    anchor, there = draft.anchor(0.0, draft.depth * rng.uniform(1.0, 4.0))
    middle = np.array([draft.depth * rng.uniform(0.2, 0.8), 0.0, 0.0])
    middle[2] = draft.bed(middle[0], 0.0) * rng.uniform(0.3, 0.9)
    mass = draft.line_weight * draft.depth / 9.81 * 10.0 ** rng.uniform(-1.0, 1.0)
    volume = mass / RHO * rng.uniform(0.1, 0.9)
    draft.bodies.append(Body(1, FREE, tuple(middle), mass=mass, centre_of_gravity=(0, 0, -0.2), inertia=(mass,) * 3, volume=volume))
    draft.line(anchor, draft.point("body", (1.0, 0.0, 0.0), body=1), there, middle + [1.0, 0.0, 0.0])
    for side in (-1.0, 1.0):
        own, here = np.array([-1.0, side, 0.0]), np.array([0.0, 10.0 * side, -2.0])
        draft.line(draft.point("body", own, body=1), draft.point(COUPLED, here), middle + own, here)


def pinned_rods(draft):
    """A rod that leans from a pin on the bed and one that hangs from the platform, a line between their free ends."""
    rng = draft.rng
    x = draft.depth * rng.uniform(0.3, 1.5)
    foot = np.array([x, 0.0, draft.bed(x, 0.0)])
    high = foot + [-0.1 * draft.depth, 0.0, 0.2 * draft.depth]
    top, low = np.array([0.0, 0.0, -1.0]), np.array([0.02 * draft.depth, 0.0, -1.0 - 0.1 * draft.depth])
    area = 0.25 * np.pi * 0.5**2
    standing = draft.rod("pinned", foot, high, int(rng.integers(1, 6)), 0.5, RHO * area * rng.choice([0.3, 2.0]))
    hanging = draft.rod("coupled pinned", top, low, int(rng.integers(1, 6)), 0.5, RHO * area * rng.choice([0.8, 3.0]))
    draft.line(RodEnd(standing, "B"), RodEnd(hanging, "B"), high, low)


def jointed_cable(draft):
    """Two sections joined by a rod without length, hung off from a fixed rod without length."""
    rng = draft.rng
    anchor, there = draft.anchor(0.0, draft.depth * rng.uniform(0.5, 2.0))
    top = np.array([0.0, 0.0, -0.1 * draft.depth])
    middle = there + rng.uniform(0.3, 0.7) * (top - there)
    joint = draft.rod(FREE, middle, middle, 0, draft.kind.diameter, draft.kind.mass)
    hang_off = draft.rod(COUPLED, top, top + rng.normal(0.0, 1.0, 3), 0, draft.kind.diameter, draft.kind.mass)
    draft.line(anchor, RodEnd(joint, "A"), there, middle)
    draft.line(RodEnd(joint, "A"), RodEnd(hang_off, "A"), middle, top)


SCENES = {made.__name__: made for made in (buoy, rod_between, clump_on_bridle, pinned_rods, jointed_cable)}


def random_scene(name, seed):
    draft = Draft(np.random.default_rng([seed, sorted(SCENES).index(name)]))
    SCENES[name](draft)
    return draft.scene()
