"""Which effects a scene switches on, and why. A scene pays only for what it contains."""

import numpy as np


def effects(scene, mooring):
    """List of {"name", "on", "why"}, for a scene and its settled Mooring."""
    env, types = scene.environment, [line.type for line in scene.lines]
    nodes = np.concatenate([mooring.node_positions(name) for name in mooring.line_names])
    heights = [point.position[2] for point in scene.points]
    free = [point for point in scene.points if point.kind == "free"]
    on_bed = int(np.sum(nodes[:, 2] <= -env.depth + 1e-3))
    surfaced = bool(np.any(nodes[:, 2] > 0.0) or max(heights) > 0.0)
    speed = float(np.linalg.norm(env.current))
    return [
        _effect("axial elasticity", True, f"EA = {_span([kind.stiffness for kind in types])} N"),
        _effect("internal damping", any(kind.damping for kind in types), _damping(types)),
        _effect("bending stiffness", False, "EI = 0 in every line type"),
        _effect("weight", env.gravity > 0.0, f"g = {env.gravity:g} m/s²"),
        _effect("buoyancy", env.gravity * env.water_density > 0.0, f"water of {env.water_density:g} kg/m³"),
        _effect(
            "added mass",
            env.water_density > 0.0 and any(kind.added_mass_normal or kind.added_mass_axial for kind in types),
            f"Ca = {_span([kind.added_mass_normal for kind in types])}, CaAx = {_span([kind.added_mass_axial for kind in types])}",
        ),
        _effect(
            "drag",
            env.water_density > 0.0 and any(kind.drag_normal or kind.drag_axial for kind in types),
            f"Cd = {_span([kind.drag_normal for kind in types])}, CdAx = {_span([kind.drag_axial for kind in types])}",
        ),
        _effect("current", speed > 0.0, f"{speed:g} m/s" if speed else "CurrentX, CurrentY, CurrentZ are 0"),
        _effect("waves on the lines", False, "WaveKin is 0: still water"),
        _effect(
            "bed contact",
            env.bed_stiffness > 0.0 or env.bed_damping > 0.0,
            f"kBot = {env.bed_stiffness:g} Pa/m, cBot = {env.bed_damping:g} Pa s/m; at the zero pose {on_bed} of {len(nodes)} nodes lie on it",
        ),
        _effect("bed friction", False, "no friction coefficient in the file"),
        _effect(
            "free surface",
            surfaced,
            "something stands above the water" if surfaced else "all is under water at the zero pose; looked at in every step all the same",
        ),
        _effect("free points", bool(free), ", ".join(f"{point.name} ({point.mass:g} kg, {point.volume:g} m³)" for point in free) or "none"),
    ]


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


def _span(values):
    low, high = min(values), max(values)
    return f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
