"""Random scenes with fixed seeds, anything that a file could say, and random motions of the platform, rough ones among them."""

import numpy as np

from mooring_ros.scene import (
    BODY,
    COUPLED,
    COUPLED_PINNED,
    FIXED,
    FREE,
    PINNED,
    SATURATED,
    STICK,
    Bathymetry,
    Body,
    Environment,
    Failure,
    Friction,
    Line,
    LineType,
    Point,
    Rod,
    RodEnd,
    RodType,
    Scene,
    Waves,
)

from .motions import Samples, jump, sway
from .scenes import G, RHO

SLACK = (0.99, 1.0, 1.003, 1.02, 1.1, 1.4)  # unstretched length over the chord
DURATION = 4.0  # s


class Draft:
    """A scene while it is drawn up."""

    def __init__(self, rng):
        self.rng = rng
        self.depth = 10.0 ** rng.uniform(1.0, 2.7)
        self.slope = tuple(float(s) for s in rng.uniform(-1.0, 1.0, 2) * rng.choice([0.1, 0.7])) if self.with_chance(0.2) else (0.0, 0.0)
        self.points, self.lines, self.rods, self.bodies, self.failures = [], [], [], [], []
        self.bends = self.with_chance(0.25)
        self.kinds = [self.line_type(k) for k in range(rng.integers(1, 4))]

    def with_chance(self, chance):
        return bool(self.rng.random() < chance)

    def between(self, low, high):
        return float(self.rng.uniform(low, high))

    def power(self, low, high):
        return float(10.0 ** self.rng.uniform(low, high))

    def line_type(self, k):
        """A line from a fishing net's to a chain that nobody could lift; buoyant ones, stiff ones, ropes and cables among them."""
        rng = self.rng
        mass = self.power(-0.5, 2.7)
        diameter = float(np.sqrt(4.0 * mass / (np.pi * RHO * rng.choice([self.between(0.6, 1.0), self.between(1.0, 7.0)], p=[0.15, 0.85]))))
        stiffness = mass * G * self.depth * self.power(1.0, 4.5)
        damping = float(rng.choice([0.0, -0.02, -0.5, -1.0, -1.5]))
        own = {"drag_normal": float(rng.choice([0.0, 1.2, 2.4], p=[0.05, 0.6, 0.35])), "added_mass_normal": 1.0, "drag_axial": self.between(0.0, 0.6)}
        if self.bends and self.with_chance(0.7):
            own["bending_stiffness"] = stiffness * diameter**2 / 16.0 * self.power(-3.0, 0.0)
        elif self.with_chance(0.1):
            own["curve"] = ((0.0, 0.0), (0.01, 0.002 * stiffness), (0.02, 0.012 * stiffness))
        elif self.with_chance(0.1):
            own["slow_stiffness"], own["slow_damping"] = stiffness * self.between(0.3, 2.0), stiffness * self.between(1.0, 30.0)
            damping = 1e-3 * stiffness
        return LineType(f"type{k}", diameter, mass, stiffness, damping, **own)

    def bed(self, x, y):
        return -self.depth + self.slope[0] * x + self.slope[1] * y

    def point(self, held, place, **own):
        self.points.append(Point(len(self.points) + 1, held, tuple(float(x) for x in place), **own))
        return len(self.points)

    def anchor(self, angle, distance):
        x, y = distance * np.cos(angle), distance * np.sin(angle)
        place = np.array([x, y, min(self.bed(x, y), -0.3 * self.depth)])
        return self.point(FIXED, place), place

    def fairlead(self, angle=0.0):
        place = np.array([*(self.between(0.0, 0.1 * self.depth) * np.array([np.cos(angle), np.sin(angle)])), self.between(-0.15, 0.03) * self.depth])
        return self.point(COUPLED, place), place

    def line(self, a, b, place_a, place_b, slack=None):
        chord = max(float(np.linalg.norm(np.subtract(place_b, place_a))), 0.5)
        slack = float(slack or self.rng.choice(SLACK))
        count = int(self.rng.choice([1, 2, 3, self.rng.integers(4, 12), self.rng.integers(12, 30)], p=[0.05, 0.05, 0.1, 0.5, 0.3]))
        self.lines.append(Line(len(self.lines) + 1, self.kinds[self.rng.integers(len(self.kinds))], a, b, chord * slack, count))

    def rod(self, held, a, b, segments, diameter, mass, body=None):
        kind = RodType(f"rod{len(self.rods)}", float(diameter), float(mass), 0.8, 1.0)
        self.rods.append(Rod(len(self.rods) + 1, kind, held, tuple(map(float, a)), tuple(map(float, b)), int(segments), body))
        return len(self.rods)

    def load(self):
        """kg: a mass of the order of the lines'."""
        return self.kinds[0].mass * self.depth * self.power(-3.0, 1.0)

    def environment(self):
        rng, own = self.rng, {}
        if self.with_chance(0.3):
            mu = float(rng.choice([0.1, 0.5, 1.0, 10.0]))
            law = STICK if self.with_chance(0.5) else SATURATED
            own["friction"] = Friction(law, mu, mu, mu * self.between(0.6, 1.0), mu * self.between(0.6, 1.0), self.power(3.0, 6.0))
        if self.slope == (0.0, 0.0) and self.with_chance(0.1):
            x = np.linspace(-3.0, 3.0, 7) * self.depth
            own["bathymetry"] = Bathymetry(
                tuple(map(float, x)), tuple(map(float, x)), tuple(tuple(map(float, row)) for row in self.depth * rng.uniform(0.95, 1.1, (7, 7)))
            )
        if self.with_chance(0.25):
            speed, heading = self.power(-1.0, 0.5), self.between(0.0, 2.0 * np.pi)
            along = speed * np.cos(heading), speed * np.sin(heading)
            if self.with_chance(0.5):
                own["current"] = (float(along[0]), float(along[1]), 0.0)
            else:
                own["current_profile"] = ((-self.depth, 0.0, 0.0, 0.0), (0.0, float(along[0]), float(along[1]), 0.0))
        if self.with_chance(0.2):
            period = self.between(4.0, 14.0)
            height = self.between(0.0, 0.04) * min(1.56 * period**2, 5.0 * self.depth)
            of, direction = str(rng.choice(["regular", "jonswap"])), self.between(0.0, 6.0)
            own["waves"] = Waves(of, height, period, direction, seed=int(rng.integers(1, 99)), components=20)
        if self.with_chance(0.03) and "waves" not in own:
            own["water_density"] = 0.0
        return Environment(depth=self.depth, bed_slope=self.slope, bed_stiffness=self.power(4.0, 7.5), bed_damping=self.power(3.0, 6.0), **own)

    def scene(self):
        if self.with_chance(0.1):
            line = self.lines[self.rng.integers(len(self.lines))]
            weight = line.type.mass * G * self.depth
            due = {"time": self.between(0.0, DURATION)} if self.with_chance(0.5) else {"tension": weight * self.power(-1.0, 1.0)}
            self.failures.append(Failure(1, line.end_b, (line.id,), **due))
        return Scene(
            path="", text="", line_types=tuple(self.kinds), points=tuple(self.points), lines=tuple(self.lines), environment=self.environment(),
            rods=tuple(self.rods), rod_types=tuple(rod.type for rod in self.rods), bodies=tuple(self.bodies), failures=tuple(self.failures),
        )  # fmt: skip


def legs(draft):
    """One to four lines from anchors all round to the platform."""
    count = draft.rng.integers(1, 5)
    for k in range(count):
        angle = 2.0 * np.pi * k / count + draft.between(-0.3, 0.3)
        anchor, there = draft.anchor(angle, draft.depth * draft.between(0.2, 4.0))
        top, here = draft.fairlead(angle)
        draft.line(anchor, top, there, here)


def sections(draft):
    """Lines of sections with clumps and buoys between them, or nothing."""
    for k in range(draft.rng.integers(1, 3)):
        angle = np.pi * k
        anchor, there = draft.anchor(angle, draft.depth * draft.between(0.5, 3.0))
        top, here = draft.fairlead(angle)
        last, place = anchor, there
        for share in sorted(draft.rng.uniform(0.2, 0.8, draft.rng.integers(1, 3))):
            middle = there + share * (here - there)
            middle[2] = max(middle[2] + 0.1 * draft.depth * draft.rng.normal(), draft.bed(*middle[:2]))
            last, place = draft_line_to(draft, last, place, middle)
        draft.line(last, top, place, here)


def draft_line_to(draft, last, place, middle):
    """One more section, to a free point of nothing, a clump or a buoy."""
    what = draft.rng.choice(["nothing", "clump", "buoy"])
    own = {}
    if what != "nothing":
        mass = draft.load()
        volume = mass / RHO * (draft.between(0.1, 0.9) if what == "clump" else draft.between(1.1, 5.0))
        own = {"mass": mass, "volume": volume, "drag_area": float(volume ** (2.0 / 3.0)), "added_mass": 0.5}
    joint = draft.point(FREE, middle, **own)
    draft.line(last, joint, place, middle)
    return joint, middle


def bridle(draft):
    """Two or three legs and a pendant that meet at a free point."""
    middle = np.array([draft.depth * draft.between(0.1, 0.6), 0.0, -draft.depth * draft.between(0.2, 0.8)])
    mass = draft.load()
    joint = draft.point(FREE, middle, mass=mass, volume=mass / RHO * draft.between(0.0, 2.0))
    for angle in draft.rng.uniform(-1.0, 1.0, draft.rng.integers(2, 4)):
        anchor, there = draft.anchor(angle, draft.depth * draft.between(1.0, 3.0))
        draft.line(anchor, joint, there, middle)
    top, here = draft.fairlead()
    draft.line(joint, top, middle, here)


def buoy(draft):
    """A body with a hull on legs, and a hawser to the platform."""
    length, diameter = draft.between(2.0, 8.0), draft.between(0.5, 4.0)
    full = RHO * 0.25 * np.pi * diameter**2 * length
    middle = np.array([draft.depth * draft.between(0.3, 1.0) + 20.0, 0.0, -0.2 * length])
    ballast = full * draft.between(0.05, 0.7)
    low = (0.0, 0.0, -length * draft.between(0.2, 0.5))
    draft.bodies.append(Body(1, FREE, tuple(map(float, middle)), mass=ballast, centre_of_gravity=low, inertia=(0.1 * ballast * length**2,) * 3))
    draft.rod(BODY, (0, 0, -0.5 * length), (0, 0, 0.5 * length), draft.rng.integers(1, 6), diameter, full * draft.between(0.05, 0.2) / length, 1)
    for k in range(draft.rng.integers(2, 4)):
        angle = 2.0 * np.pi * k / 3.0 + draft.between(-0.4, 0.4)
        x, y = middle[0] + 2.0 * draft.depth * np.cos(angle), 2.0 * draft.depth * np.sin(angle)
        there = np.array([x, y, draft.bed(x, y)])
        own = np.array([0.4 * diameter * np.cos(angle), 0.4 * diameter * np.sin(angle), -length * draft.between(0.0, 0.5)])
        draft.line(draft.point(FIXED, there), draft.point(BODY, own, body=1), there, middle + own, draft.rng.choice(SLACK[3:]))
    top, here = draft.fairlead()
    own = np.array([-0.4 * diameter, 0.0, 0.0])
    draft.line(draft.point(BODY, own, body=1), top, middle + own, here, draft.rng.choice(SLACK[3:]))


def clump_body(draft):
    """A heavy body under two lines to the platform, on a leg to an anchor; on the bed where the lines are long."""
    anchor, there = draft.anchor(0.0, draft.depth * draft.between(1.0, 4.0))
    middle = np.array([draft.depth * draft.between(0.2, 0.8), 0.0, 0.0])
    middle[2] = draft.bed(middle[0], 0.0) * draft.between(0.3, 0.9)
    mass = draft.load()
    own = {"mass": mass, "centre_of_gravity": (0.0, 0.0, -0.2), "inertia": (mass,) * 3, "volume": mass / RHO * draft.between(0.1, 0.9)}
    draft.bodies.append(Body(1, FREE, tuple(map(float, middle)), **own))
    draft.line(anchor, draft.point(BODY, (1.0, 0.0, 0.0), body=1), there, middle + [1.0, 0.0, 0.0])
    for side in (-1.0, 1.0):
        own, here = np.array([-1.0, side, 0.0]), np.array([0.0, 0.1 * draft.depth * side, -0.02 * draft.depth])
        draft.line(draft.point(BODY, own, body=1), draft.point(COUPLED, here), middle + own, here)


def rod_between(draft):
    """A free rod in the middle of a line, heavy or buoyant."""
    anchor, there = draft.anchor(draft.between(0.0, 6.0), draft.depth * draft.between(0.5, 3.0))
    top, here = draft.fairlead()
    share, along = draft.between(0.3, 0.7), (here - there) / np.linalg.norm(here - there)
    a = there + share * (here - there)
    b = a + draft.between(0.02, 0.2) * draft.depth * along
    diameter = draft.kinds[0].diameter * draft.between(1.0, 5.0)
    rod = draft.rod(FREE, a, b, draft.rng.integers(1, 6), diameter, RHO * 0.25 * np.pi * diameter**2 * draft.rng.choice([0.5, 1.0, 1.5, 3.0]))
    draft.line(anchor, RodEnd(rod, "A"), there, a)
    draft.line(RodEnd(rod, "B"), top, b, here)


def pinned_rods(draft):
    """A rod that leans from a pin on the bed and one that hangs from the platform, a line between their free ends."""
    x = draft.depth * draft.between(0.3, 1.5)
    foot = np.array([x, 0.0, draft.bed(x, 0.0)])
    high = foot + np.array([-0.1, 0.0, 0.2]) * draft.depth
    top, low = np.array([0.0, 0.0, -1.0]), np.array([0.02 * draft.depth, 0.0, -1.0 - 0.1 * draft.depth])
    area = 0.25 * np.pi * 0.5**2
    standing = draft.rod(PINNED, foot, high, draft.rng.integers(1, 6), 0.5, RHO * area * draft.rng.choice([0.3, 2.0]))
    hanging = draft.rod(COUPLED_PINNED, top, low, draft.rng.integers(1, 6), 0.5, RHO * area * draft.rng.choice([0.8, 3.0]))
    draft.line(RodEnd(standing, "B"), RodEnd(hanging, "B"), high, low)


def clamped_cable(draft):
    """Two sections joined by a rod without length, hung off from a rod of the platform."""
    anchor, there = draft.anchor(0.0, draft.depth * draft.between(0.5, 2.0))
    here = np.array([0.0, 0.0, -0.1 * draft.depth])
    middle = there + draft.between(0.3, 0.7) * (here - there)
    kind = draft.kinds[0]
    joint = draft.rod(FREE, middle, middle, 0, kind.diameter, kind.mass)
    down = here + np.array([draft.between(-1.0, 1.0), draft.between(-1.0, 1.0), -1.0])
    hang_off = draft.rod(COUPLED, here, down, 1, kind.diameter, kind.mass)
    draft.line(anchor, RodEnd(joint, "A"), there, middle)
    draft.line(RodEnd(joint, "A"), RodEnd(hang_off, "B"), middle, down)


def coupled_body(draft):
    """Points on a body of the platform and on one in the ground."""
    draft.bodies.append(Body(1, COUPLED, (0.0, 0.0, -2.0)))
    x = draft.depth * draft.between(0.5, 3.0)
    ground = np.array([x, 0.0, draft.bed(x, 0.0)])
    draft.bodies.append(Body(2, FIXED, tuple(map(float, ground))))
    for side in (-1.0, 1.0):
        foot, head = np.array([0.0, side, 0.0]), np.array([0.5, 0.5 * side, -0.5])
        draft.line(draft.point(BODY, foot, body=2), draft.point(BODY, head, body=1), ground + foot, head + [0.0, 0.0, -2.0])


LAYOUTS = (legs, legs, legs, sections, sections, bridle, bridle, buoy, clump_body, rod_between, pinned_rods, clamped_cable, coupled_body)


def random_motion(rng, depth):
    """Sways, jumps, random walks, and poses that somebody has differenced for the twists."""
    size = min(depth, 100.0) * 10.0 ** rng.uniform(-3.0, -1.0)
    way = rng.normal(size=3)
    turn = rng.normal(size=3) * rng.choice([0.0, 0.02, 0.2])
    every = float(rng.choice([0.02, 0.05, 0.1]))
    what = rng.choice(["sway", "jump", "walk", "poses alone", "rest"], p=[0.55, 0.15, 0.1, 0.1, 0.1])
    if what == "rest":
        return sway(0.0 * way, 1.0, DURATION, every=every)
    if what == "jump":
        return jump(size * way, turn, within=float(rng.choice([0.05, 0.2, 1.0])), hold=DURATION - 1.0)
    moved = sway(size * way, float(rng.uniform(1.5, 12.0)), DURATION, every=every, turn=turn)
    if what == "poses alone":
        twists = np.zeros_like(moved.twists)  # differences of the positions, half a sample late; none of the turn
        twists[:, :3] = np.diff(moved.poses[:, :3], axis=0, prepend=0.0) / moved.times[0]
        return Samples(moved.start, moved.times, moved.poses, twists)
    if what == "walk":
        steps = np.cumsum(rng.normal(size=(moved.times.size, 3)), axis=0) * 0.1 * size
        moved.poses[:, :3] += steps
        moved.twists[:, :3] += np.gradient(steps, moved.times, axis=0)
    return moved


def random_case(seed):
    """(what it is, Scene, Samples) of a seed."""
    rng = np.random.default_rng([4, seed])
    layout = LAYOUTS[rng.integers(len(LAYOUTS))]
    draft = Draft(rng)
    layout(draft)
    return layout.__name__, draft.scene(), random_motion(rng, draft.depth)
