"""What is moored: plain, immutable descriptions in the units of a MoorDyn file (SI).

Positions are in metres, z up from the still water level, at the platform's zero pose.
``source_line`` is the line of the file (from 1) that an object was read from, 0 when it came from no file.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

# How points, rods and bodies are held
FIXED = "fixed"  # in the ground
COUPLED = "coupled"  # on the platform
FREE = "free"
BODY = "body"  # points and rods: on a body
PINNED = "pinned"  # rods: end A fixed in place, free to turn
COUPLED_PINNED = "coupled pinned"  # rods: end A on the platform, free to turn

# Laws of bed friction
SATURATED = "saturated"  # by the speed, Housner et al. 2022
STICK = "stick"  # by the displacement: elastic-plastic, with a remembered contact point

# Measures of curvature
ANGLE = "angle"  # turning angle over length, with corrected end conditions
PAPER = "paper"  # 2/l sin of half the turning angle, twice that at clamped ends (Hall, Srinivas and Yu 2020)

# Waves
REGULAR = "regular"
JONSWAP = "jonswap"
ELEVATION = "elevation"  # components of a given surface elevation
COMPONENTS = "components"  # given components


@dataclass(frozen=True)
class LineType:
    """Properties of a line for each metre of its unstretched length."""

    name: str
    diameter: float  # m, volume-equivalent
    mass: float  # kg/m, in air
    stiffness: float  # EA, N; of a load-strain curve its steepest slope; of a rope in two-Kelvin form EA_D
    damping: float  # BA as in the file: N s, or minus the fraction of critical damping; of a rope in two-Kelvin form: BA_D
    bending_stiffness: float = 0.0  # EI, N m^2
    drag_normal: float = 0.0  # Cd, on the area d l
    added_mass_normal: float = 0.0  # Ca
    drag_axial: float = 0.0  # CdAx, on the area pi d l
    added_mass_axial: float = 0.0  # CaAx
    curve: tuple[tuple[float, float], ...] = ()  # load-strain curve: (strain, tension in N) from (0, 0), both growing; goes on as its last piece
    slow_stiffness: float = 0.0  # EA of the slow Kelvin element, EA_D EA_S / (EA_D - EA_S), N; 0: the line is not viscoelastic
    slow_damping: float = 0.0  # BA of the slow Kelvin element, N s
    source_line: int = 0


@dataclass(frozen=True)
class RodType:
    """Properties of a rod for each metre of its length, and of its ends."""

    name: str
    diameter: float  # m
    mass: float  # kg/m, in air
    drag_normal: float = 0.0  # Cd, on the area d l
    added_mass_normal: float = 0.0  # Ca
    drag_end: float = 0.0  # CdEnd, on the area of an end
    added_mass_end: float = 0.0  # CaEnd, on the volume of a half sphere
    source_line: int = 0


@dataclass(frozen=True)
class Body:
    """A rigid body: an origin with mass, volume and drag of its own, on which points and rods ride."""

    id: int
    kind: str  # "fixed", "coupled" or "free"
    position: tuple[float, float, float]  # m, of its origin
    orientation: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)  # quaternion x, y, z, w from its axes to the world's
    mass: float = 0.0  # kg
    centre_of_gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m, its axes
    inertia: tuple[float, float, float] = (0.0, 0.0, 0.0)  # kg m^2, about the centre of gravity, its axes
    volume: float = 0.0  # m^3, displaced, centred at the origin
    drag_area: tuple[float, ...] = (0.0,) * 6  # CdA along its axes, m^2, and about them, m^5
    added_mass: tuple[float, float, float] = (0.0, 0.0, 0.0)  # Ca along its axes, on the volume
    source_line: int = 0

    @property
    def name(self) -> str:
        return f"body{self.id}"


@dataclass(frozen=True)
class Rod:
    """A rigid rod from end A to end B. Without segments it has no length and stands at end A, where it passes moments on:
    fixed it holds lines in the direction from end A to end B, free it is a joint whose direction comes from its lines."""

    id: int
    type: RodType
    kind: str  # "fixed", "coupled", "free", "body", "pinned" or "coupled pinned"
    end_a: tuple[float, float, float]  # m; on a body: in its axes
    end_b: tuple[float, float, float]
    segments: int  # 0 when it has no length
    body: int | None = None  # id of the body that it rides on
    source_line: int = 0

    @property
    def name(self) -> str:
        return f"rod{self.id}"

    @property
    def length(self) -> float:  # m
        return math.dist(self.end_a, self.end_b) if self.segments else 0.0


@dataclass(frozen=True)
class RodEnd:
    """Where a line ends at a rod, clamped when the line has bending stiffness."""

    rod: int  # id
    end: str  # "A" or "B"


@dataclass(frozen=True)
class Point:
    """A place where lines end: held by the ground, riding on the platform or a body, or free with a mass and a volume of its own."""

    id: int
    kind: str  # "fixed", "coupled", "free" or "body"
    position: tuple[float, float, float]  # m; of a free point: where the file says it starts; on a body: in its axes
    mass: float = 0.0  # kg
    volume: float = 0.0  # m^3, displaced
    drag_area: float = 0.0  # CdA, m^2
    added_mass: float = 0.0  # Ca, on the volume
    body: int | None = None  # id of the body that it rides on
    source_line: int = 0

    @property
    def name(self) -> str:
        return f"point{self.id}"


@dataclass(frozen=True)
class Line:
    """A line between points or ends of rods; end A is the first attachment in the file, end B the second."""

    id: int
    type: LineType
    end_a: int | RodEnd  # point id, or a rod's end
    end_b: int | RodEnd
    length: float  # m, unstretched
    segments: int
    source_line: int = 0

    @property
    def name(self) -> str:
        return f"line{self.id}"


@dataclass(frozen=True)
class Failure:
    """Lines that part from what holds them, and stay together, at a time or at a tension, whichever comes first."""

    id: int
    holder: int | RodEnd  # point id, or a rod's end
    lines: tuple[int, ...]  # ids
    time: float = float("inf")  # s
    tension: float = float("inf")  # N, in any of the lines at that end
    source_line: int = 0


@dataclass(frozen=True)
class Bathymetry:
    """Depths over a rectangular grid, bilinear between. Beyond the grid the depth is that of the nearest place on its edge."""

    x: tuple[float, ...]  # m, growing
    y: tuple[float, ...]  # m, growing
    depth: tuple[tuple[float, ...], ...]  # m, depth[i][j] at x[i], y[j]


@dataclass(frozen=True)
class Friction:
    """Bed friction: coefficients on the normal force, along the line (axial) and across it (transverse)."""

    law: str  # "saturated" or "stick"
    static_axial: float
    static_transverse: float
    kinetic_axial: float
    kinetic_transverse: float
    ramp: float = 1e6  # c_v of the saturated law, N s/m: force = static coefficient times ramp times speed, up to the static limit
    isotropic: bool = False  # the saturated law takes the velocity along the bed as a whole, as MoorDyn-C does


@dataclass(frozen=True)
class Waves:
    """A sea of linear waves in one direction."""

    kind: str  # "regular", "jonswap", "elevation" or "components"
    height: float = 0.0  # m: H of a regular wave, Hs of a spectrum
    period: float = 0.0  # s: T or Tp
    direction: float = 0.0  # rad: where the waves run, from x towards y
    peakedness: float = 3.3  # gamma of the JONSWAP spectrum
    seed: int = 1  # of the phases
    components: int = 100  # of the spectrum
    phase: float = 0.0  # rad, of a regular wave: elevation H/2 cos(w t - k x - phase)
    elevation: tuple[tuple[float, float], ...] = ()  # (s, m) at the origin, evenly spaced from 0 s
    spectrum: tuple[tuple[float, float, float], ...] = ()  # components (rad/s, m, rad): elevation = sum of a cos(w t - k x - phase)
    ramp: float = 0.0  # s, over which the waves grow from nothing


@dataclass(frozen=True)
class Environment:
    """Gravity, water and seabed. The still water's surface is z = 0, a flat bed is z = -depth."""

    depth: float  # m, at the origin
    gravity: float = 9.80665  # m/s^2
    water_density: float = 1025.0  # kg/m^3
    bed_stiffness: float = 3.0e6  # kBot, Pa/m
    bed_damping: float = 3.0e5  # cBot, Pa s/m
    current: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m/s, uniform and steady
    current_profile: tuple[tuple[float, float, float, float], ...] = ()  # (z, vx, vy, vz), z growing, m and m/s, added to `current`
    bathymetry: Bathymetry | None = None
    bed_slope: tuple[float, float] = (0.0, 0.0)  # rise of the bed along x and y; -depth is its level at the origin
    friction: Friction | None = None
    waves: Waves | None = None


@dataclass(frozen=True)
class Scene:
    """Everything a scene file says, checked. Equal when path, text and all parts are equal."""

    path: str
    text: str = field(repr=False)  # the file's exact content; text.encode("utf-8") gives its bytes back
    line_types: tuple[LineType, ...]
    points: tuple[Point, ...]
    lines: tuple[Line, ...]
    environment: Environment
    rod_types: tuple[RodType, ...] = ()
    rods: tuple[Rod, ...] = ()
    bodies: tuple[Body, ...] = ()
    failures: tuple[Failure, ...] = ()
    bending: str = ANGLE  # measure of curvature: "angle" or "paper"
    options: Mapping[str, object] = field(default_factory=dict, hash=False)  # everything else that was read, by its usual name
    warnings: tuple[str, ...] = ()  # what was read and is not used, and why
    files: tuple[tuple[str, str], ...] = ()  # the other files that it was read from: name as written in the scene, content

    def point(self, id: int) -> Point:
        """The point with this ID; KeyError when there is none."""
        for point in self.points:
            if point.id == id:
                return point
        raise KeyError(id)
