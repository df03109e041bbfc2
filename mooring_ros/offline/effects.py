"""Which effects a scene switches on, and why. A scene pays only for what it contains."""

import math

import numpy as np

from mooring_ros.scene import BODY, COMPONENTS, ELEVATION, FREE, PAPER, REGULAR, SATURATED, RodEnd, bed_level

from .bed_shape import depths
from .contents import end_name

_ON_THE_BED = 1e-3  # m above it


def effects(scene, mooring):
    """List of {"name", "on", "why"}, for a scene and its settled Mooring."""
    env, types = scene.environment, [line.type for line in scene.lines]
    nodes = np.concatenate([mooring.node_positions(name) for name in mooring.line_names])
    levels = np.array([bed_level(env, x, y) for x, y, _ in nodes.tolist()])
    on_bed = int(np.sum(nodes[:, 2] <= levels + _ON_THE_BED))
    plain = [kind.stiffness for kind in types if not kind.curve and not kind.slow_stiffness]
    curves = {kind.name: f"{kind.name} ({len(kind.curve)} points)" for kind in types if kind.curve}
    ropes = {kind.name: f"{kind.name} ({_rope(kind)})" for kind in types if kind.slow_stiffness}
    free = [point for point in scene.points if point.kind == FREE]
    return [
        _effect("axial elasticity", True, f"EA = {_span(plain)} N" if plain else "by curve or in two-Kelvin form in every line"),
        _effect("load-strain curves", curves, ", ".join(curves.values()) or "EA is a number in every line"),
        _effect("viscoelastic ropes", ropes, ", ".join(ropes.values()) or "no line in two-Kelvin form"),
        _effect("internal damping", any(kind.damping for kind in types), _damping(types)),
        _bending(scene),
        _effect("weight", env.gravity > 0.0, f"g = {env.gravity:g} m/s²"),
        _effect("buoyancy", env.gravity * env.water_density > 0.0, f"water of {env.water_density:g} kg/m³"),
        _of_water(scene, "added mass", (("Ca", "added_mass_normal"), ("CaAx", "added_mass_axial")), "added_mass", ("added_mass_normal", "added_mass_end")),
        _of_water(scene, "drag", (("Cd", "drag_normal"), ("CdAx", "drag_axial")), "drag_area", ("drag_normal", "drag_end")),
        _current(env),
        _waves(env),
        _effect(
            "bed contact",
            env.bed_stiffness > 0.0 or env.bed_damping > 0.0,
            f"kBot = {env.bed_stiffness:g} Pa/m, cBot = {env.bed_damping:g} Pa s/m; at the zero pose {on_bed} of {len(nodes)} nodes lie on it",
        ),
        _bathymetry(env, levels),
        _friction(env.friction),
        _surface(scene, nodes),
        _effect("free points", free, ", ".join(f"{point.name} ({point.mass:g} kg, {point.volume:g} m³)" for point in free) or "none"),
        _effect("rods", scene.rods, ", ".join(f"{rod.name} ({_held(rod)}, {_long(rod)})" for rod in scene.rods) or "none"),
        _effect("bodies", scene.bodies, ", ".join(f"{body.name} ({body.kind}, {body.mass:g} kg, {body.volume:g} m³)" for body in scene.bodies) or "none"),
        _effect("line failures", scene.failures, "; ".join(map(_failure, scene.failures)) or "none"),
    ]


def with_shares(switched, passes):
    """(effects, passes): each effect with "share" (0..1, None when off) and "share_with", all effects of its pass; what is off is in no pass."""
    on = [effect["name"] for effect in switched if effect["on"]]
    passes = [{**row, "effects": [name for name in row["effects"] if name in on], "what": row["what"] or ", ".join(row["effects"])} for row in passes]
    of = {name: row for row in passes for name in row["effects"]}
    nothing = {"share": 0.0, "effects": []}  # what only changes numbers that are there anyway
    shared = [of.get(effect["name"], nothing) if effect["on"] else None for effect in switched]
    found = [
        {**effect, "share": row and row["share"], "share_with": (row["effects"] or [effect["name"]]) if row else []}
        for effect, row in zip(switched, shared)
    ]
    return found, passes


def _effect(name, on, why):
    return {"name": name, "on": bool(on), "why": why}


def _damping(types):
    if not any(kind.damping for kind in types):
        return "BA = 0 in every line type"
    fractions = [-kind.damping for kind in types if kind.damping < 0.0]
    absolute = [kind.damping for kind in types if kind.damping > 0.0]
    parts = []
    if fractions:
        parts.append(f"{_span(fractions)} of critical")
    if absolute:
        parts.append(f"BA = {_span(absolute)} N s")
    return ", ".join(parts)


def _rope(kind):
    static = 1.0 / (1.0 / kind.stiffness + 1.0 / kind.slow_stiffness)
    return f"EA {static:.4g} N when slow, {kind.stiffness:.4g} N when quick"


def _bending(scene):
    bent = [line for line in scene.lines if line.type.bending_stiffness]
    if not bent:
        return _effect("bending stiffness", False, "EI = 0 in every line type")
    at_rods = sum(isinstance(end, RodEnd) for line in bent for end in (line.end_a, line.end_b))
    measure = "the paper's curvature" if scene.bending == PAPER else "curvature by the turning angle"
    why = f"EI = {_span([line.type.bending_stiffness for line in bent])} N m² in {len(bent)} of {len(scene.lines)} lines, "
    return _effect("bending stiffness", True, why + f"{measure}; {at_rods} of their {2 * len(bent)} ends at rods")


def _of_water(scene, name, of_lines, of_parts, of_rods):
    """Added mass or drag. of_lines: (symbol, attribute) of line types; of_parts: attribute of points and bodies; of_rods: attributes of rod types."""
    types = [line.type for line in scene.lines]
    why = ", ".join(f"{symbol} = {_span([getattr(kind, attribute) for kind in types])}" for symbol, attribute in of_lines)
    has = any(getattr(kind, attribute) for kind in types for _, attribute in of_lines)
    more = [part.name for part in (*scene.points, *scene.bodies) if np.any(getattr(part, of_parts))]
    more += [rod.name for rod in scene.rods if any(getattr(rod.type, attribute) for attribute in of_rods)]
    return _effect(name, scene.environment.water_density > 0.0 and (has or more), why + (f"; and of {', '.join(more)}" if more else ""))


def _current(env):
    speed, profile = float(np.linalg.norm(env.current)), env.current_profile
    parts = [f"{speed:g} m/s"] if speed else []
    if profile:
        fastest = max(math.hypot(*row[1:]) for row in profile)
        parts.append(f"a profile of {len(profile)} rows from z = {profile[0][0]:g} to {profile[-1][0]:g} m, up to {fastest:g} m/s")
    return _effect("current", parts, " and ".join(parts) or "CurrentX, CurrentY, CurrentZ are 0, no profile")


def _waves(env):
    waves = env.waves
    if waves is None:
        return _effect("waves on the lines", False, "still water")
    if waves.kind == REGULAR:
        why = f"regular, H = {waves.height:g} m, T = {waves.period:g} s, phase {math.degrees(waves.phase):g}°"
    elif waves.kind == ELEVATION:
        times, heights = np.array(waves.elevation).T
        why = f"a given elevation of {len(times)} samples each {times[1] - times[0]:g} s, Hs = {4.0 * heights.std():.4g} m"
    elif waves.kind == COMPONENTS:
        amplitudes = np.array(waves.spectrum)[:, 1]
        why = f"{len(amplitudes)} given components, Hs = {4.0 * math.sqrt(0.5 * float(amplitudes @ amplitudes)):.4g} m"
    else:
        why = f"{waves.kind}, Hs = {waves.height:g} m, Tp = {waves.period:g} s, gamma = {waves.peakedness:g}, {waves.components} components, seed {waves.seed}"
    why += f", running {math.degrees(waves.direction):g}° from x towards y"
    return _effect("waves on the lines", True, why + (f", growing over {waves.ramp:g} s" if waves.ramp else ""))


def _bathymetry(env, levels):
    if env.bathymetry is None and not any(env.bed_slope):
        return _effect("bathymetry", False, "the bed is flat")
    return _effect("bathymetry", True, f"{depths(env)}; under the lines at the zero pose {-levels.max():.4g} to {-levels.min():.4g} m")


def _friction(friction):
    if friction is None:
        return _effect("bed friction", False, "no friction coefficient in the file")
    if friction.isotropic:
        of = f"kinetic {friction.kinetic_axial:g}, static {friction.static_axial:g} in every direction"
    else:
        of = (f"kinetic {friction.kinetic_axial:g} along and {friction.kinetic_transverse:g} across the line, "
              f"static {friction.static_axial:g} and {friction.static_transverse:g}")
    ramp = f", ramp {friction.ramp:g} N s/m; by the speed, so none in the statics" if friction.law == SATURATED else "; statics as laid from the anchors"
    return _effect("bed friction", True, f"law {friction.law}, {of}{ramp}")


def _surface(scene, nodes):
    heights = [part.position[2] for part in (*scene.points, *scene.bodies) if part.kind != BODY]
    heights += [end[2] for rod in scene.rods if rod.kind != BODY for end in (rod.end_a, rod.end_b)]
    if np.any(nodes[:, 2] > 0.0) or max(heights, default=0.0) > 0.0:
        return _effect("free surface", True, "something stands above the water")
    if scene.environment.waves is not None:
        return _effect("free surface", True, "the waves' surface, looked at where something is near it")
    return _effect("free surface", False, "all is under water at the zero pose; looked at in every step all the same")


def _held(part):
    return f"on body{part.body}" if part.kind == BODY else part.kind


def _long(rod):
    return f"{rod.length:g} m" if rod.segments else "no length"


def _failure(failure):
    causes = [f"at {failure.time:g} s"] if math.isfinite(failure.time) else []
    causes += [f"beyond {failure.tension:g} N"] if math.isfinite(failure.tension) else []
    return f"{', '.join(f'line{line}' for line in failure.lines)} part from {end_name(failure.holder)} {' or '.join(causes)}"


def _span(values):
    low, high = min(values), max(values)
    return f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
