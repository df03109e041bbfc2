"""What is moored: plain, immutable descriptions in the units of a MoorDyn file (SI).

Positions are in metres, z up from the still water level, at the platform's zero pose.
``source_line`` is the line of the file (from 1) that an object was read from, 0 when it came from no file.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

FIXED = "fixed"
COUPLED = "coupled"
FREE = "free"


@dataclass(frozen=True)
class LineType:
    """Properties of a line for each metre of its unstretched length."""

    name: str
    diameter: float  # m, volume-equivalent
    mass: float  # kg/m, in air
    stiffness: float  # EA, N
    damping: float  # BA as in the file: N s, or minus the fraction of critical damping
    bending_stiffness: float = 0.0  # EI, N m^2
    drag_normal: float = 0.0  # Cd, on the area d l
    added_mass_normal: float = 0.0  # Ca
    drag_axial: float = 0.0  # CdAx, on the area pi d l
    added_mass_axial: float = 0.0  # CaAx
    source_line: int = 0


@dataclass(frozen=True)
class Point:
    """A place where lines end: held by the ground, riding on the platform, or free with a mass and a volume of its own."""

    id: int
    kind: str  # "fixed", "coupled" or "free"
    position: tuple[float, float, float]  # m; of a free point: where the file says it starts
    mass: float = 0.0  # kg
    volume: float = 0.0  # m^3, displaced
    drag_area: float = 0.0  # CdA, m^2
    added_mass: float = 0.0  # Ca, on the volume
    source_line: int = 0

    @property
    def name(self) -> str:
        return f"point{self.id}"


@dataclass(frozen=True)
class Line:
    """A line between two points; end A is the first attachment in the file, end B the second."""

    id: int
    type: LineType
    end_a: int  # point id
    end_b: int  # point id
    length: float  # m, unstretched
    segments: int
    source_line: int = 0

    @property
    def name(self) -> str:
        return f"line{self.id}"


@dataclass(frozen=True)
class Environment:
    """Gravity, water and seabed. The water's surface is z = 0, the flat bed is z = -depth."""

    depth: float  # m
    gravity: float = 9.80665  # m/s^2
    water_density: float = 1025.0  # kg/m^3
    bed_stiffness: float = 3.0e6  # kBot, Pa/m
    bed_damping: float = 3.0e5  # cBot, Pa s/m
    current: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m/s, uniform and steady


@dataclass(frozen=True)
class Scene:
    """Everything a scene file says, checked. Equal when path, text and all parts are equal."""

    path: str
    text: str = field(repr=False)  # the file's exact content; text.encode("utf-8") gives its bytes back
    line_types: tuple[LineType, ...]
    points: tuple[Point, ...]
    lines: tuple[Line, ...]
    environment: Environment
    options: Mapping[str, object] = field(default_factory=dict, hash=False)  # everything else that was read, by its usual name
    warnings: tuple[str, ...] = ()  # what was read and is not used, and why

    def point(self, id: int) -> Point:
        """The point with this ID; KeyError when there is none."""
        for point in self.points:
            if point.id == id:
                return point
        raise KeyError(id)
