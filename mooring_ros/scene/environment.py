"""The environment that the options of a file describe: water, waves, current, bed and its friction."""

import math
from dataclasses import replace

from .bed import depth_at_origin, read_bathymetry
from .description import ELEVATION, JONSWAP, REGULAR, SATURATED, STICK, Environment, Friction, Waves
from .files import Files
from .options import Options
from .water import Profile, read_current_profile, read_elevation, read_frequencies, read_water_file

_PLAIN = {"g": "gravity", "rho": "water_density", "kBot": "bed_stiffness", "cBot": "bed_damping"}
_FRICTION = ("FrictionModel", "mc", "cv", "mu_kA", "mu_kT", "FrictionCoefficient")
_USUAL_RAMP = 200.0  # N s/m, MoorDyn's cv
_USUAL_WAVE_STEP = 0.25  # s, MoorDyn-C's dtWave

# Our own seas: the options that each needs, and those that it may have besides
_SEAS = {
    REGULAR: (("WaveHeight", "WavePeriod"), ("WavePhase",)),
    JONSWAP: (("WaveHeight", "WavePeriod"), ("WaveGamma", "WaveSeed", "WaveComponents")),
    ELEVATION: (("WaveElevationFile",), ()),
}
_FIELDS = {
    "WaveHeight": "height",
    "WavePeriod": "period",
    "WavePhase": "phase",
    "WaveGamma": "peakedness",
    "WaveSeed": "seed",
    "WaveComponents": "components",
    "WaveElevationFile": "elevation",
}
_OWN_WAVES = (*_FIELDS, "WaveDirection")


def build_environment(options: Options, files: Files) -> tuple[Environment, list[str]]:
    """The environment, and warnings. Takes what it uses out of ``options``."""
    warnings: list[str] = []
    bed = _bed(options, files, warnings)
    friction = _friction(options, warnings)
    plain = {field: options.take(name) for name, field in _PLAIN.items() if options.get(name) is not None}
    current = tuple(options.take(f"Current{axis}", 0.0) for axis in "XYZ")
    waves, profile = _water(options, files, warnings)
    environment = Environment(**bed, **plain, current=current, current_profile=profile, friction=friction, waves=waves)
    return environment, [*warnings, *_breaking(options, environment)]


def _breaking(options: Options, environment: Environment) -> list[str]:
    """A warning for waves that no sea has: steeper than 1 to 7 (Michell's limit), or higher than 0.78 of the depth (McCowan's)."""
    waves, depth = environment.waves, environment.depth
    if waves is None or waves.kind not in (REGULAR, JONSWAP):
        return []
    highest = min(environment.gravity * waves.period**2 / (14.0 * math.pi), 0.78 * depth)
    if waves.height <= highest:
        return []
    row = options.row("WaveHeight")
    return [
        f"{row.file}:{row.line}: waves of {waves.height:g} m and {waves.period:g} s in {depth:g} m of water would break, about {highest:.2g} m is the most; "
        "linear theory is used beyond it"
    ]


def _bed(options: Options, files: Files, warnings: list[str]) -> dict[str, object]:
    depth, file, row = options.take("WtrDpth"), options.take("SeafloorFile", ""), options.row("SeafloorFile")
    if isinstance(depth, str):
        if file:
            raise row.error(f"a second bathymetry file (the first is in line {options.row('WtrDpth').line}), expected one")
        depth, file, row = None, depth, options.row("WtrDpth")
    slope = tuple(options.take(f"BedSlope{axis}", 0.0) for axis in "XY")
    if file:
        for axis, rise in zip("XY", slope):
            if rise:
                raise options.row(f"BedSlope{axis}").error(f"BedSlope{axis} is {rise:g} beside a bathymetry file, expected one of them")
        grid = read_bathymetry(files, row, file)
        if depth is not None:
            given = options.row("WtrDpth")
            warnings.append(f"{given.file}:{given.line}: the option {given.words[1]} is not used: the depth is that of the bathymetry file")
        return {"depth": depth_at_origin(grid), "bathymetry": grid}
    if depth is None:
        raise options.row("WtrDpth").error("the water depth is missing, expected an option like '200 WtrDpth' (m): it has no default")
    return {"depth": depth, "bed_slope": slope}


def _friction(options: Options, warnings: list[str]) -> Friction | None:
    """MoorDyn's laws, with the static coefficients as the paper has them: below the static limit the force in MoorDyn is the kinetic
    coefficient times cv times the speed, so that the ramp is cv over mc."""
    isotropic = options.get("FrictionCoefficient", 0.0) > 0
    axial, transverse = (options.get("FrictionCoefficient" if isotropic else name, 0.0) for name in ("mu_kA", "mu_kT"))
    if not axial and not transverse:
        warnings += options.unused("the bed has no friction in this scene", *_FRICTION[:3])
        return None
    if isotropic:
        for name in ("mu_kA", "mu_kT"):
            if options.get(name):
                raise options.row(name).error(f"{name} is {options.get(name):g} beside FrictionCoefficient, expected either that or mu_kT and mu_kA")
    law = options.get("FrictionModel", SATURATED)
    scale, damping = options.get("mc", 1.0), options.get("cv", _USUAL_RAMP)
    if scale < 1:
        raise options.row("mc").error(f"{options.row('mc').words[1]} is {scale:g}, expected a number >= 1: static over kinetic friction")
    if damping <= 0 and law == SATURATED:
        raise options.row("cv").error(f"{options.row('cv').words[1]} is {damping:g}, expected a number > 0 (N s/m): friction grows with it from rest")
    if law == STICK:
        warnings += options.unused("the friction model stick goes by displacements, not by speeds", "cv")
        damping = damping or _USUAL_RAMP
    for name in _FRICTION:
        options.take(name)
    return Friction(
        law=law,
        static_axial=scale * axial,
        static_transverse=scale * transverse,
        kinetic_axial=axial,
        kinetic_transverse=transverse,
        ramp=damping / scale,
        isotropic=isotropic,
    )


def _water(options: Options, files: Files, warnings: list[str]) -> tuple[Waves | None, Profile]:
    model, mode, file = options.take("WaveModel", "none"), options.take("WaveKin", 0), options.take("WaterKin", "")
    waves, profile = read_water_file(files, options.row("WaterKin"), file) if file else (None, ())
    given = {"WaterKin": waves is not None, "WaveKin": mode > 0, "WaveModel": model != "none"}
    sources = [name for name, is_given in given.items() if is_given]
    if len(sources) > 1:
        row = options.row(sources[1])
        raise row.error(f"{row.words[1]} gives waves beside {sources[0]} (line {options.row(sources[0]).line}), expected one of them")
    if mode == 3:
        waves = Waves(ELEVATION, elevation=_moordyn_elevation(options, files, warnings))
    elif mode == 7:
        waves = read_frequencies(files, options.row("WaveKin"), "wave_frequencies.txt")
    elif model != "none":
        waves = _own_waves(options, files, model)
    else:
        for name in _OWN_WAVES:
            if options.get(name, "") != "":
                raise options.row(name).error(f"{name} stands without WaveModel, expected an option like 'jonswap WaveModel'")
    warnings += options.unused("it does not belong to the waves of this scene", "dtWave", *_OWN_WAVES)
    if waves is None:
        warnings += options.unused("there are no waves in this scene", "WaveRamp")
    else:
        waves = replace(waves, ramp=options.take("WaveRamp", 0.0))
    if options.take("Currents", 0):
        if profile:
            raise options.row("Currents").error("Currents is 1 beside the current of WaterKin, expected one of them")
        profile = read_current_profile(files, options.row("Currents"), "current_profile.txt")
    return waves, profile


def _moordyn_elevation(options: Options, files: Files, warnings: list[str]) -> tuple[tuple[float, float], ...]:
    """WaveKin 3 of MoorDyn-C: it reads wave_elevation.txt off in steps of dtWave, and then interpolates on the grid of water_grid.txt."""
    row, step = options.row("WaveKin"), options.take("dtWave", _USUAL_WAVE_STEP)
    if step <= 0:
        raise options.row("dtWave").error(f"dtWave is {step:g}, expected a number > 0 (s)")
    warnings.append(f"{row.file}:{row.line}: water_grid.txt is not used: the water's motion is computed at the nodes themselves")
    return read_elevation(files, row, "wave_elevation.txt", step)


def _own_waves(options: Options, files: Files, model: str) -> Waves:
    needed, besides = _SEAS[model]
    for name in needed:
        if not options.get(name):
            example = "eta.txt" if name == "WaveElevationFile" else "8"
            raise options.row("WaveModel").error(f"the sea is {model} without {name}, expected an option like '{example} {name}'")
    fields = {_FIELDS[name]: options.take(name) for name in (*needed, *besides) if options.get(name) is not None}
    if "phase" in fields:
        fields["phase"] = math.radians(fields["phase"])
    if "elevation" in fields:
        fields["elevation"] = read_elevation(files, options.row("WaveElevationFile"), fields["elevation"])
    return Waves(model, direction=math.radians(options.take("WaveDirection", 0.0)), **fields)
