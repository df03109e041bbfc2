"""The moorings that all codes are run on, each with the motion of its platform; twelve of them have their trade of speed for accuracy shown."""

from dataclasses import dataclass, replace

from mooring_ros.scene import load_scene, parse_scene
from mooring_ros.scene.description import COUPLED, RodEnd
from mooring_ros.scene.grouping import times_segments

from .moordyn_deck import sea_components
from .moordyn_history import SCENES
from .motions import Circle, Sines, SurgeHeave
from .sea_motion import SeaMotion

OC4_MOTION = SurgeHeave(measured_periods=4.0)
SEMI_TAUT_MOTION = SurgeHeave(surge=3.5, heave=3.7, period=14.9, ramp_periods=2.0, measured_periods=4.0)


@dataclass(frozen=True)
class Case:
    """A scene, its mesh and a motion."""

    name: str
    file: str
    motion: object  # with displacement(t), start and end (s); None: that of the scene's own sea
    segments: int | None = None  # of every line, None for the file's
    allowed: float = 0.01  # error at which costs are compared

    def still(self):
        """The scene as it is read from its file without the rows of waves."""
        scene = load_scene(SCENES / self.file)
        if scene.environment.waves is None:
            return scene
        rows = [row for row in scene.text.splitlines(keepends=True) if not row.split()[1:2] or not row.split()[1].startswith("Wave")]
        return parse_scene("".join(rows), scene.path, scene.files)

    def scene(self, refinement=1):
        """The scene in still water, with ``refinement`` times the case's segments in every line."""
        scene = self.still()
        return replace(scene, lines=tuple(replace(n, segments=times_segments(refinement, self.segments or n.segments)) for n in scene.lines))

    def platform(self):
        """The motion."""
        if self.motion is not None:
            return self.motion
        return SeaMotion(*sea_components(load_scene(SCENES / self.file).environment), ramp=14.5, measured=43.5)


def fairleads(scene):
    """[(index of the line, whether its end B is coupled)] of the lines that end on the platform."""
    rods = {rod.id: rod.kind for rod in scene.rods}

    def coupled(end):
        return (rods[end.rod] if isinstance(end, RodEnd) else scene.point(end).kind) == COUPLED

    return [(k, coupled(line.end_b)) for k, line in enumerate(scene.lines) if coupled(line.end_a) or coupled(line.end_b)]


CASES = (
    Case("taut chain, 20 m", "taut_20m.txt", Sines(0.008, 0.0, 0.004, period=2.0, ramp_periods=2.0)),
    Case("laboratory chain, 33 m", "chalmers_33m.txt", Circle(0.2, 3.5, ramp_periods=2.0, measured_periods=4.0)),
    Case("OC3 Hywind", "oc3_spar.txt", Sines(4.0, 2.0, 2.0, period=12.0)),
    Case("OC4 3 x 20", "oc4.txt", OC4_MOTION, 20),
    Case("OC4 3 x 40", "oc4.txt", OC4_MOTION, 40),
    Case("OC4 3 x 100", "oc4.txt", OC4_MOTION, 100),
    Case("VolturnUS-S chain", "volturnus_s_chain.txt", Sines(4.0, 2.0, 3.0, period=14.0)),
    Case("VolturnUS-S semi-taut", "volturnus_s_semi_taut.txt", SEMI_TAUT_MOTION),
    Case("VolturnUS-S semi-taut, up a slope", "volturnus_s_semi_taut_upslope.txt", SEMI_TAUT_MOTION),
    Case("VolturnUS-S semi-taut, rough bed", "volturnus_s_semi_taut_friction.txt", SEMI_TAUT_MOTION),
    Case("RM3 cable", "rm3_cable.txt", None, allowed=0.03),
    Case("lazy wave", "lazy_wave.txt", Sines(4.0, 2.0, 3.0, period=12.0)),
    Case("ISWEC, bridles and clump weights", "iswec_c2a.txt", Sines(1.5, 0.5, 1.0, period=8.0)),
    Case("farm of 100 lines", "farm_100.txt", Sines(3.0, 2.0, 2.0, period=12.0, ramp_periods=2.0, measured_periods=3.0)),
)
TRADED = tuple(case.name for case in CASES if case.name not in ("OC4 3 x 40", "OC4 3 x 100"))  # whose meshes are among those of OC4 3 x 20
BY_NAME = {case.name: case for case in CASES}
