"""One of our scenes as input for MoorDyn (C++): the deck and the files that stand beside it.

Our own options are turned into what MoorDyn reads: a sea into the components of ``wave_frequencies.txt`` (WaveKin 7, summed at the nodes themselves),
a grid of depths into ``seafloor.txt``. Decks are split at blanks only, so no tabs are written.
"""

from pathlib import Path

import numpy as np

from mooring_ros.core.sea import build_sea
from mooring_ros.scene.description import BODY, COUPLED, COUPLED_PINNED, FIXED, FREE, PINNED, RodEnd

KINDS = {FIXED: "Fixed", COUPLED: "Coupled", FREE: "Free", PINNED: "Pinned", COUPLED_PINNED: "CoupledPinned"}
SEAFLOOR = "seafloor.txt"
WAVES = "wave_frequencies.txt"
RELAXATION = {"dtIC": 2.0, "TmaxIC": 200.0, "threshIC": 1e-5, "CdScaleIC": 4.0}  # how MoorDyn finds its initial state


class DeckError(RuntimeError):
    """The scene holds what a deck for MoorDyn cannot carry."""


def deck(scene, dt, scheme="RK2", segments=None, damping=None, options=(), friction=True, folder="."):
    """The scene as MoorDyn's input text, with internal step dt (s); segments and damping (BA) override those of the file.

    ``folder``: where its `files` will stand; MoorDyn takes the grid of depths relative to the working directory, not to the deck.
    """
    env = scene.environment
    if any(env.current) or env.current_profile:
        raise DeckError("the peer deck does not carry a current")
    if scene.bodies:
        raise DeckError("the peer deck does not carry bodies")
    if any(env.bed_slope):
        raise DeckError("the peer has no plane slope: give a grid of depths")
    rows = ["mooring_ros benchmark", *_line_types(scene, damping), *_rods(scene)]
    rows += ["---- POINTS ----", "ID Type X Y Z M V CdA Ca", "(#) (-) (m) (m) (m) (kg) (m3) (m2) (-)"]
    for p in scene.points:
        rows.append(_row(p.id, _kind(p), *p.position, p.mass, p.volume, p.drag_area, p.added_mass))
    rows += ["---- LINES ----", "ID Type A B Len N Out", "(#) (-) (#) (#) (m) (-) (-)"]
    for n in scene.lines:
        rows.append(_row(n.id, n.type.name, _end(n.end_a), _end(n.end_b), float(n.length), segments or n.segments, "-"))
    rows += ["---- OPTIONS ----", f"{float(dt)!r} dtM", f"{scheme} tScheme"]
    rows += [f"{env.gravity!r} g", f"{env.water_density!r} WtrDnsty", f"{env.depth!r} WtrDpth"]
    rows += [f"{env.bed_stiffness!r} kBot", f"{env.bed_damping!r} cBot"]
    rows += [f"{value} {name}" for name, value in RELAXATION.items()]
    rows += ["0 writeLog", "1 disableOutput", "1 disableOutTime"]
    if env.bathymetry is not None:
        rows.append(f"{Path(folder, SEAFLOOR)} SeafloorFile")
    if env.waves is not None:
        rows.append("7 WaveKin")
    if env.friction is not None and friction:
        rows += _friction(env.friction)
    return "\n".join([*rows, *options, "---- END ----", ""])


def files(scene):
    """Names and texts of the files that the deck asks for."""
    env = scene.environment
    beside = {}
    if env.bathymetry is not None:
        beside[SEAFLOOR] = _seafloor(env.bathymetry)
    if env.waves is not None:
        beside[WAVES] = wave_frequencies(*sea_components(env))
    return beside


def sea_components(environment):
    """Frequencies (rad/s), amplitudes (m), phases (rad) and direction (rad) of the sea: elevation sum a cos(w t - k s - phase), s along the direction."""
    sea = build_sea(environment)
    if sea.ramp > 0.0:
        raise DeckError("the peer deck does not carry a ramp of the waves")
    return np.array(sea.frequency), np.array(sea.amplitude), np.array(sea.phase), environment.waves.direction


def wave_frequencies(frequency, amplitude, phase, direction):
    """Text of MoorDyn's ``wave_frequencies.txt``, whose elevation is the sum of ``|c| sin(w t - k s + arg c)``; it must begin at no frequency."""
    c = amplitude * np.exp(1j * (0.5 * np.pi - phase))
    rows = [_row(float(w), float(x.real), float(x.imag), float(direction)) for w, x in zip(frequency, c, strict=True)]
    return "\n".join(["0.0 0.0 0.0 0.0", *rows, ""])


def coupled_freedoms(scene):
    """(first freedom, position (3,)) of each coupled rod and point at the platform's zero pose, in MoorDyn's order, and the count of freedoms.

    A coupled rod has six: its end A's place and its turn from the file's direction.
    """
    places, count = [], 0
    for rod in scene.rods:
        if rod.kind == COUPLED:
            places.append((count, rod.end_a))
            count += 6
        elif rod.kind == COUPLED_PINNED:
            raise DeckError("the peer's driver does not carry coupled pinned rods")
    for point in scene.points:
        if point.kind == COUPLED:
            places.append((count, point.position))
            count += 3
    return places, count


def _line_types(scene, damping):
    rows = ["---- LINE TYPES ----", "Name Diam Mass EA BA EI Cd Ca CdAx CaAx", "(-) (m) (kg/m) (N) (N-s/-) (N-m2) (-) (-) (-) (-)"]
    for k in scene.line_types:
        if k.curve:
            raise DeckError(f"the peer deck does not carry the load-strain curve of {k.name}")
        stiffness, ba = repr(float(k.stiffness)), repr(float(k.damping if damping is None else damping))
        if k.slow_stiffness > 0.0:  # written as the static and the dynamic stiffness
            stiffness = f"{k.stiffness * k.slow_stiffness / (k.stiffness + k.slow_stiffness)!r}|{k.stiffness!r}"
            ba = f"{k.slow_damping!r}|{k.damping!r}"
        values = (k.bending_stiffness, k.drag_normal, k.added_mass_normal, k.drag_axial, k.added_mass_axial)
        rows.append(_row(k.name, float(k.diameter), float(k.mass), stiffness, ba, *map(float, values)))
    return rows


def _rods(scene):
    if not scene.rods:
        return []
    rows = ["---- ROD TYPES ----", "Name Diam Mass Cd Ca CdEnd CaEnd", "(-) (m) (kg/m) (-) (-) (-) (-)"]
    for k in scene.rod_types:
        rows.append(_row(k.name, k.diameter, k.mass, k.drag_normal, k.added_mass_normal, k.drag_end, k.added_mass_end))
    rows += ["---- RODS ----", "ID Type Attachment Xa Ya Za Xb Yb Zb N Out", "(#) (-) (-) (m) (m) (m) (m) (m) (m) (-) (-)"]
    for r in scene.rods:
        rows.append(_row(r.id, r.type.name, _kind(r), *r.end_a, *r.end_b, r.segments, "-"))
    return rows


def _friction(friction):
    if not friction.isotropic:
        raise DeckError("the peer's friction is the same in all directions")
    if friction.kinetic_axial == 0.0 == friction.static_axial:
        return []
    scale = friction.static_axial / friction.kinetic_axial
    return [f"{friction.kinetic_axial!r} FrictionCoefficient", f"{scale * friction.ramp!r} FricDamp", f"{scale!r} StatDynFricScale"]


def _seafloor(grid):
    """MoorDyn's grid: z of the bed at every x and y (it reads them in single precision)."""
    rows = [f"{len(grid.x)} {len(grid.y)}", " ".join(f"{x:.9g}" for x in grid.x), " ".join(f"{y:.9g}" for y in grid.y)]
    rows += [f"{x:.9g} {y:.9g} {-grid.depth[i][j]:.9g}" for i, x in enumerate(grid.x) for j, y in enumerate(grid.y)]
    return "\n".join([*rows, ""])


def _end(end):
    return f"R{end.rod}{end.end}" if isinstance(end, RodEnd) else str(end)


def _kind(part):
    return f"Body{part.body}" if part.kind == BODY else KINDS[part.kind]


def _row(*cells):
    return " ".join(repr(c) if isinstance(c, float) else str(c) for c in cells)
