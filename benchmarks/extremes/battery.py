"""The battery of extremes: scenes and motions that break codes, each with what must come out of it."""

from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Callable

import numpy as np

from mooring_ros import Mooring
from mooring_ros.scene import COUPLED, FIXED, FREE, SATURATED, STICK, Failure, Friction, load_scene

from .judge import FINER, Track, claim, finer_step, ours, same_history, track_of
from .motions import jump, move, pull, sway
from .scenes import G, RHO, VACUUM, bridle, chain, kind, one_line, scene, three_chains, weight

EIGHTHS = 64  # samples of eight periods of 10 s
SCENES = Path(__file__).parents[2] / "config" / "scenes"


@dataclass(frozen=True)
class Case:
    """One extreme. `claims(scene, motion, track)` says what must come out; `refused`: what a refusal must say where one is right."""

    name: str
    item: str  # of the list of extremes
    scene: Callable
    motion: Callable
    claims: Callable | None
    refused: str = ""
    settings: dict | Callable = field(default_factory=dict)  # of Mooring, or a function of the scene
    prepare: Callable | None = None  # what is done to the mooring once it has settled
    time: float = 0.0  # s, of the start
    peer: bool = True  # whether MoorDyn can be given the same
    peer_claims: Callable | None = None  # what it is held to instead: its tensions stand half an internal step back, which jumps do not forgive


# -- what must come out ---------------------------------------------------------------------------------------------------------------


def converged(allowed=0.05, peak=None, floor=0.0, finer=FINER):
    """The same run with a step that is `finer` times finer."""

    def claims(scene, motion, track):
        _, truth = ours(scene, motion, dt=finer_step(scene, finer), solver="explicit")
        return same_history(track, track_of(truth), allowed, peak, floor)

    return claims


def rests(allowed=0.02, floor=1.0):
    """In the end every line carries what the statics at the last pose say (N, at least `floor` for the scale)."""

    def claims(scene, motion, track):
        still = Mooring(scene)
        still.settle(motion.poses[-1])
        return [
            claim(f"last tension of line {k + 1}", track.fairlead[-1, k], want, allowed, max(want, floor))
            for k, want in enumerate(still.fairlead_tension)
        ]

    return claims


def hangs(allowed=0.01):
    """T + T^2/(2 EA) grows by w dz along an elastic line, whatever its shape, on a smooth bed too: from middle to middle of its end segments."""

    def claims(scene, motion, track):
        line, env = scene.lines[0], scene.environment
        still = Mooring(scene)
        still.settle(motion.poses[-1])
        z = still.node_positions(line.name)[:, 2]
        rise = weight(line.type, env.water_density, env.gravity) * (0.5 * (z[-1] + z[-2]) - 0.5 * (z[0] + z[1]))
        low, ea = still.anchor_tension[0], line.type.stiffness
        square = (1.0 + low / ea) ** 2 + 2.0 * rise / ea  # (1 + T/EA)^2 at the top
        top = low + rise if ea > 1e6 * abs(rise) else ea * (np.sqrt(square) - 1.0)
        return [claim("tension at the top beside that at the bottom and the weight between", track.fairlead[-1, 0], top, allowed)]

    return claims


def carries(share=0.5, allowed=0.01):
    """A slack loop with its ends side by side hangs (or rises) with `share` of its weight on the fairlead, less half an end segment."""

    def claims(scene, motion, track):
        line = scene.lines[0]
        want = abs(weight(line.type)) * (share * line.length - 0.5 * line.length / line.segments)
        return [claim("last tension", track.fairlead[-1, 0], want, allowed)]

    return claims


def lies_slack(scene, motion, track):
    """A line that lies about carries next to nothing once it has come to rest."""
    return [claim("last tension over the line's weight", track.fairlead[-1, 0], 0.0, 0.01, weight(scene.lines[0].type) * scene.lines[0].length)]


def both(*several):
    return lambda scene, motion, track: [one for claims in several for one in claims(scene, motion, track)]


def snaps(scene, motion, track):
    """Z v at the pulled end and 2 Z v at the held one, Z = sqrt(EA m), between the passages of the wave (Saint-Venant)."""
    line = scene.lines[0]
    front, speed = np.sqrt(line.type.stiffness * line.type.mass), motion.twists[-1, 0]
    lap = line.length * np.sqrt(line.type.mass / line.type.stiffness)

    def mean(tension, first, last):
        return tension[(track.times > first * lap) & (track.times < last * lap)].mean()

    found = [claim("front at the fairlead", mean(track.fairlead[:, 0], 0.2, 1.8), front * speed, 0.02)]
    if track.anchor is not None:
        found.append(claim("reflected front at the anchor", mean(track.anchor[:, 0], 1.2, 2.8), 2.0 * front * speed, 0.02))
    return found


def trails(scene, motion, track):
    """A line in a uniform current with a loose end hangs straight at the angle where drag across it balances its weight across it."""
    line, env = scene.lines[0], scene.environment
    load, across = weight(line.type), 0.5 * RHO * line.type.diameter * line.type.drag_normal * env.current[0] ** 2
    cosine = (np.sqrt(load**2 + 4.0 * across**2) - load) / (2.0 * across)  # across (1 - cos^2) = load cos, of the angle to the flow
    return [claim("last tension", track.fairlead[-1, 0], _towed_tension(line, load, cosine), 0.01)]


def _towed_tension(line, load, cosine):
    return load * (line.length - 0.5 * line.length / line.segments) * np.sqrt(1.0 - cosine**2)


def bobs(scene, motion, track):
    """A great mass on a line: its weight, all the time."""
    point = scene.points[1]
    want = (point.mass - RHO * point.volume) * G + weight(scene.lines[0].type) * 0.5 * scene.lines[0].length
    return [claim("mean tension", track.fairlead[:, 0].mean(), want, 0.02)]


def as_without(make, allowed=0.01):
    """The history of another scene, which must be the same."""

    def claims(scene, motion, track):
        _, other = ours(make(), motion)
        return same_history(track, track_of(other), allowed)

    return claims


def stays(scene, motion, track):
    """Period by period the tensions of the second hour: nothing drifts."""
    early = int(np.searchsorted(track.times, 7200.0 - 1e-6))
    then, now = track.fairlead[early - EIGHTHS + 1 : early + 1], track.fairlead[-EIGHTHS:]
    return [claim("largest difference from the second hour over the range", np.abs(now - then).max(), 0.0, 1e-6, np.ptp(then))]


def as_from_zero(scene, motion, track):
    """The same run with a clock that starts at 0."""
    _, history = ours(scene, motion, solver=track.solver)
    return same_history(Track(track.times - track.times[0] + motion.times[0], track.fairlead), track_of(history), 1e-4)


def as_evenly_sampled(scene, motion, track):
    even = sway((2.0, 0.0, 1.0), 6.0, 12.0)
    _, history = ours(scene, even)
    return same_history(Track(track.times, track.fairlead), track_of(history), 0.05)


def parted(scene, motion, track):
    """What is left carries on as a mooring that never had the lost leg."""
    still = Mooring(bridle(legs=1))
    still.settle(motion.poses[-1])
    return [claim(f"last tension of line {k + 1}", track.fairlead[-1, k], want, 0.02) for k, want in enumerate(still.fairlead_tension)]


def pulls_as_a_spring(scene, motion, track):
    """EA (chord / L - 1) at every instant."""
    line, (anchor, fairlead) = scene.lines[0], (np.array(p.position) for p in scene.points)
    chord = np.linalg.norm(fairlead + np.array([np.interp(track.times, motion.times, x) for x in motion.poses[:, :3].T]).T - anchor, axis=1)
    want = line.type.stiffness * (chord / line.length - 1.0)
    return [claim("largest difference over the largest tension", np.abs(track.fairlead[:, 0] - want).max(), 0.0, 0.05, want.max())]


def holds_by_friction(scene, motion, track):
    """A bar on a Coulomb bed: its end gives way by T^2 / (2 EA mu w), and the anchor does not feel it."""
    line, mu = scene.lines[0], scene.environment.friction.kinetic_axial
    want = np.sqrt(2.0 * line.type.stiffness * mu * weight(line.type) * -motion.poses[-1, 0])
    found = [claim("last tension at the fairlead", track.fairlead[-1, 0], want, 0.05)]
    if track.anchor is not None:
        found.append(claim("last tension at the anchor over that at the fairlead", track.anchor[-1, 0] / track.fairlead[-1, 0], 0.0, 1e-3, 1.0))
    return found


# -- scenes and motions of single cases -----------------------------------------------------------------------------------------------


def rough(path):
    """Two metres to and fro in four seconds, and ten degrees of pitch, for a scene of full size; less where the scene is small or reaches far."""
    size = 0.02 if "33m" in path.name or "iswec" in path.name else 0.05 if "cantilever" in path.name else 1.0
    reach = max((np.linalg.norm(p.position) for p in load_scene(path).points if p.kind == COUPLED), default=1.0)
    return sway((2.0 * size, 0.0, size), 4.0, 3.0, every=0.02, turn=(0.0, min(0.17, 5.0 * size / max(reach, 1e-3)), 0.0))


def cm_to_200_m():
    """Sections of 100 segments of 1 cm and of 4 of 200 m, one behind the other."""
    points = [(FIXED, (780.0, 0.0, -200.0)), (FREE, (0.95, 0.0, -10.3)), (COUPLED, (0.0, 0.0, -10.0))]
    return scene(points, [(kind(), 1, 2, 830.0, 4), (kind(), 2, 3, 1.0, 100)], depth=200.0)


def bob(mass, volume=0.0):
    """A mass under 50 m of chain from the platform, far above the bed."""
    return scene([(COUPLED, (0.0, 0.0, -10.0)), (FREE, (0.0, 0.0, -60.2), mass, volume)], [(kind(), 1, 2, 50.0, 5)], depth=1000.0)


def on_rough_bed(law, mu):
    """The same with friction."""
    return on_bed(Friction(law, mu, mu, mu, mu, isotropic=law == SATURATED))


def on_bed(friction=None):
    """A chain straight on the bed, 3 mm in it as its weight presses it."""
    return one_line(kind(), (100.0, 0.0, -100.003), (0.0, 0.0, -100.003), 100.0, 100, friction=friction)


def uneven_times(duration=12.0):
    """Intervals of 0.1 s and of 0.1 ms, one after the other."""
    steps = np.tile([0.1, 1e-4], int(duration / 0.1001) + 1)
    times = np.cumsum(steps)
    return times[times < duration]


def file_cases():
    """Default settings on every scene that comes with the package."""
    for path in sorted(SCENES.glob("*.txt")):
        yield Case(
            f"file {path.stem}", "default settings on any file", partial(load_scene, path), partial(rough, path), converged(0.1, 0.05)
        )


def too_large(factor):
    return lambda scene: {"dt": factor * Mooring(scene).step_limit.dt}


def stiffness_case(exponent):
    of = kind(stiffness=10.0**exponent)
    return Case(
        f"EA 1e{exponent} N",
        "EA from 1e3 to 1e13 N",
        partial(one_line, of, (40.0, 0.0, -50.0), (0.0, 0.0, 0.0), 66.0, 20, depth=20000.0),
        partial(sway, (0.5, 0.0, 0.5), 10.0, 5.0),
        both(hangs_at_start, converged(0.05)),
    )


def hangs_at_start(scene, motion, track):
    """`hangs` before it moves."""
    rest = move(over=0.1)
    _, history = ours(scene, rest)
    return hangs()(scene, rest, track_of(history))


def hangs_in_air(scene, motion, track):
    """`hangs`, with the weight in water up to the surface and that in air above it."""
    line = scene.lines[0]
    still = Mooring(scene)
    still.settle(motion.poses[-1])
    z, ea = still.node_positions(line.name)[:, 2], line.type.stiffness
    rise = weight(line.type) * -0.5 * (z[0] + z[1]) + weight(line.type, 0.0) * 0.5 * (z[-1] + z[-2])
    low = still.anchor_tension[0]
    return [claim("last tension", track.fairlead[-1, 0], ea * (np.sqrt((1.0 + low / ea) ** 2 + 2.0 * rise / ea) - 1.0), 0.02)]


def on_slope(rise):
    """An anchor up or down a slope of 45 degrees, the line lying on it for a part."""
    if rise > 0.0:
        return one_line(kind(), (80.0, 0.0, -20.0), (0.0, 0.0, -10.0), 115.0, 40, bed_slope=(1.0, 0.0))
    return one_line(kind(), (100.0, 0.0, -200.0), (0.0, 0.0, -10.0), 240.0, 40, bed_slope=(-1.0, 0.0))


def trailing():
    """A light cable from the platform in a stream of 5 m/s, its other end loose."""
    cable = kind("cable", 0.05, 4.0, 1e8, drag_axial=0.0)
    return scene([(COUPLED, (0.0, 0.0, -10.0)), (FREE, (90.0, 0.0, -40.0))], [(cable, 2, 1, 100.0, 20)], depth=200.0, current=(5.0, 0.0, 0.0))


def friction_case(law, mu):
    rest = as_without(on_bed, 0.01) if mu == 0.0 else holds_by_friction if law == STICK else converged(0.05)
    motion = partial(move, (-0.02, 0.0, 0.0), over=5.0, hold=1.0)
    return Case(f"friction {mu:g}, {law}", "bed friction 0 and 10", partial(on_rough_bed, law, mu), motion, rest, peer=law == SATURATED)


def cases():
    """All of them, in the order of the list."""
    yield from file_cases()
    for factor in (10, 1000):
        yield Case(f"dt {factor} times too large", "steps up to 1000 times too large", chain, partial(sway, (2, 0, 1), 6.0, 12.0),
                   converged(0.05), settings=too_large(factor))  # fmt: skip
    yield Case("snap in vacuum", "slack then snap at 10 m/s", partial(one_line, kind(damping=-0.3), (-100, 0, 0), (0, 0, 0), 100.0, 100, **VACUUM),
               partial(pull, (10, 0, 0), 0.16, every=5e-4, start=1e-4), snaps)  # fmt: skip
    yield Case("slack, then snap", "slack then snap at 10 m/s", partial(chain, length=360.0), partial(pull, (-10, 0, 0), 6.0), converged(0.05, 0.05))
    yield Case("jump by 1 m", "teleport by 1 m", chain, partial(jump, (-1, 0, 0)), both(rests(), converged(0.2, 0.05, finer=16)),
               peer_claims=rests())  # fmt: skip
    for shift, where in ((100, "slack"), (-100, "taut")):
        move_it = partial(jump, (shift, 0, 0), within=1.0, hold=59.0)
        yield Case(f"100 m in 1 s, {where}", "teleport by 100 m", chain, move_it, both(rests(), converged(0.15, 0.05, finer=16)), peer_claims=rests())
        yield Case(f"100 m in 50 ms, {where}", "teleport by 100 m", chain, partial(jump, (shift, 0, 0)), None,
                   refused="stretches a line by more than .*; settle")  # fmt: skip
    yield Case("100 km in 50 ms", "teleport by 100 m", chain, partial(jump, (-1e5, 0, 0), hold=1.0), None,
               refused="moves the platform faster than .*; settle")  # fmt: skip
    yield Case("half a turn in 50 ms", "rotation by 180°", three_chains, partial(jump, turn=(0, 0, np.pi), hold=120.0), rests())
    yield Case("half a turn in 10 s", "rotation by 180°", three_chains, partial(move, turn=(0, 0, np.pi), over=10.0, hold=110.0), rests())
    yield Case("overturned", "rotation by 180°", three_chains, partial(jump, turn=(np.pi, 0, 0), hold=120.0), rests())
    yield Case("fairlead below the bed", "fairlead pulled below the bed", chain, partial(move, (0, 0, -110), over=5.0, hold=115.0), rests(0.02, 1e4))
    yield Case("fairlead into the air", "fairlead into the air", chain, partial(move, (0, 0, 60), over=5.0, hold=115.0), both(rests(), hangs_in_air))
    yield Case("fairlead onto the anchor", "fairlead onto the anchor", chain, partial(move, (300, 0, -90), over=10.0, hold=170.0), lies_slack)
    for rise, where in ((1.0, "uphill"), (-1.0, "downhill")):
        yield Case(f"anchor {where} on a 45° slope", "anchor on a 45° slope", partial(on_slope, rise), partial(sway, (1, 0, 0.5), 8.0, 8.0),
                   both(hangs_at_start, converged(0.05)))  # fmt: skip
    loop = partial(one_line, kind(), (0.2, 0, -10), (0, 0, -10), 100.0, 20, depth=1000.0)
    yield Case("vertical slack loop", "vertical slack loop", loop, partial(move, (0, 0, 1), over=2.0, hold=58.0), rests())
    yield Case("coincident ends", "coincident ends", partial(one_line, kind(), (0, 0, -10), (0, 0, -10), 100.0, 20, depth=1000.0),
               partial(move, over=2.0, hold=58.0), carries())  # fmt: skip
    yield Case("all on the bed", "all on the bed", partial(one_line, kind(), (300, 0, -100), (0, 0, -100), 301.0, 20),
               partial(move, (0, 1, 0), over=2.0, hold=118.0), lies_slack)  # fmt: skip
    hose = kind("hose", mass=5.0, stiffness=1e7)
    yield Case("buoyant line pushed together", "buoyant line pushed together", partial(one_line, hose, (55, 0, -60), (0, 0, -60), 60.0, 20),
               partial(move, (55, 0, 0), over=10.0, hold=80.0), carries())  # fmt: skip
    yield from map(stiffness_case, (3, 5, 7, 9, 11, 13))
    yield Case("one segment", "one segment and 5000", partial(chain, 1, 312.0), partial(sway, (0.5, 0, 0.5), 6.0, 12.0), pulls_as_a_spring)
    yield Case("5000 segments", "one segment and 5000", partial(chain, 5000), partial(sway, (2, 0, 1), 2.0, 0.5), converged(0.05))
    yield Case("1 cm to 200 m", "segments from 1 cm to 200 m in one line", cm_to_200_m, partial(sway, (2, 0, 1), 6.0, 3.0), converged(0.05))
    yield Case("bed of 1e9 Pa/m", "kBot 1e9, cBot 1e7", partial(chain, bed_stiffness=1e9, bed_damping=1e7), partial(sway, (2, 0, 5), 8.0, 16.0),
               converged(0.05))  # fmt: skip
    yield Case("current of 5 m/s", "current 5 m/s", trailing, partial(move, over=1.0, hold=99.0), trails)
    failure = (Failure(1, 2, (3,), time=1.0),)
    yield Case("a leg parts", "a breaking line next to taut ones", partial(bridle, failures=failure),
               partial(move, (-5, 0, 0), over=5.0, hold=175.0), parted, peer=False)  # fmt: skip
    yield Case("free point of 1 g", "free points of 1 g and of 1e7 kg", partial(bridle, 1e-3), partial(sway, (2, 0, 1), 6.0, 12.0),
               as_without(bridle))  # fmt: skip
    yield Case("free point of 1e7 kg", "free points of 1 g and of 1e7 kg", partial(bridle, 1e7, 1e7 / RHO), partial(sway, (2, 0, 1), 6.0, 12.0),
               converged(0.05))  # fmt: skip
    yield Case("1e7 kg on a line", "free points of 1 g and of 1e7 kg", partial(bob, 1e7), partial(move, (0, 0, 0.1), over=2.0, hold=28.0),
               both(bobs, converged(0.05)))  # fmt: skip
    for law in (SATURATED, STICK):
        yield friction_case(law, 0.0)
        yield friction_case(law, 10.0)
    yield Case("no water", "no water, no gravity", partial(chain, water_density=0.0), partial(sway, (2, 0, 1), 6.0, 12.0), converged(0.05))
    yield Case("no gravity", "no water, no gravity", partial(chain, length=312.0, gravity=0.0), partial(sway, (1, 0, 0.5), 6.0, 12.0),
               converged(0.05))  # fmt: skip
    yield Case("no gravity, slack", "no water, no gravity", partial(chain, length=315.0, gravity=0.0), partial(sway, (2, 0, 1), 6.0, 12.0),
               converged(0.4, 0.25, finer=16))  # fmt: skip
    yield Case("neither", "no water, no gravity", partial(one_line, kind(), (-100, 0, 0), (0, 0, 0), 99.9, 10, **VACUUM),
               partial(sway, (0.05, 0, 0.1), 2.0, 6.0), converged(0.05))  # fmt: skip
    yield Case("uneven samples", "time steps that vary by 1000 from one to the next", chain,
               lambda: sway((2, 0, 1), 6.0, 0, times=uneven_times()), as_evenly_sampled)  # fmt: skip
    yield Case("three days", "days of simulated time", partial(chain, 5), partial(sway, (2, 0, 1), 10.0, 3 * 86400.0, every=1.25), stays)
    yield Case("clock of the epoch", "days of simulated time", chain, partial(sway, (2, 0, 1), 6.0, 12.0, every=0.0625), as_from_zero, time=1.7e9)
