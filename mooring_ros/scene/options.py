"""The options of a MoorDyn file: each one known has a fate in one table, none is skipped."""

import difflib
from collections.abc import Callable
from dataclasses import dataclass

from .rows import Row, parse_number
from .sections import Section

DEFAULT = "default"


@dataclass(frozen=True)
class Fate:
    """What becomes of an option: how its value is read, and why it is not used (then a warning says so)."""

    name: str  # as in Scene.options
    read: Callable[[Row, str], object]
    unused: str = ""


def _number(unit: str = "", above: float | None = None, at_least: float | None = None):
    return lambda row, name: row.number(0, name, unit, above=above, at_least=at_least)


def _flag(row: Row, name: str) -> float:
    word = row.words[0].lower()
    if word in ("true", "t", "false", "f"):
        return float(word in ("true", "t"))
    return row.number(0, name)


def _word(row: Row, name: str) -> str:
    return row.words[0]


def _one_of(*choices: str):
    def read(row: Row, name: str) -> str:
        word = row.words[0].lower()
        if word not in choices:
            raise row.error(f"{name} is '{row.words[0]}', expected {' or '.join(choices)}")
        return word

    return read


def _off(what: str, expected: str = "0"):
    """Accepts only values that switch the effect off."""

    def read(row: Row, name: str) -> float:
        word = row.words[0].strip("\"'")
        value = parse_number(word)
        if value == 0.0 or word.lower() in ("", "-", "none", "null", "false", "f", "unused"):
            return 0.0
        raise row.error(f"{name} is '{row.words[0]}', expected {expected}: {what} not built yet")

    return read


def _depth(row: Row, name: str) -> float:
    if parse_number(row.words[0]) is None and any(mark in row.words[0] for mark in "./\\\"'"):
        raise row.error(f"{name} is the file '{row.words[0]}', expected a number > 0 (m): bathymetry from a file is not built yet")
    return row.number(0, name, "m", above=0)


_STEP = "the step is chosen from the stability limits of the scene, or given to the solver"
_STATICS = "the initial state comes from a static solution, not from dynamic relaxation"
_OUTPUT = "what is written is decided by the node and the command line"
_NO_WAVES = "there are no waves and no current grids in this scene"
_NO_FRICTION = "the bed has no friction in this scene"
_FRICTION = "bed friction is"
_WAVES = "waves and current grids are"

# By the upper-case name; the aliases are those of MoorDyn-C and MoorDyn-F.
FATES: dict[str, Fate] = {}


def _option(fate: Fate, *aliases: str) -> None:
    for alias in (fate.name, *aliases):
        FATES[alias.upper()] = fate


_option(Fate("g", _number("m/s^2", at_least=0)), "gravity")
_option(Fate("rho", _number("kg/m^3", at_least=0)), "rhoW", "WtrDnsty")
_option(Fate("WtrDpth", _depth), "depth", "WaterDepth")
_option(Fate("kBot", _number("Pa/m", at_least=0)), "kb")
_option(Fate("cBot", _number("Pa s/m", at_least=0)), "cb")
for _axis in "XYZ":
    _option(Fate(f"Current{_axis}", _number("m/s")))

_option(Fate("FrictionCoefficient", _off(_FRICTION)))
_option(Fate("mu_kT", _off(_FRICTION)))
_option(Fate("mu_kA", _off(_FRICTION)))
_option(Fate("WaveKin", _off(_WAVES)))
_option(Fate("Currents", _off(_WAVES)))
_option(Fate("WaterKin", _off(_WAVES)))
_option(Fate("SeafloorFile", _off("bathymetry from a file is", "no file")), "SeafloorPath")

_option(Fate("FrictionModel", _one_of("saturated", "stick"), _NO_FRICTION))
_option(Fate("mc", _number(at_least=0), _NO_FRICTION), "StatDynFricScale")
_option(Fate("cv", _number(at_least=0), _NO_FRICTION), "FricDamp")
_option(Fate("dtWave", _number("s"), _NO_WAVES))
_option(Fate("waveKin_rampT", _number("s"), _NO_WAVES))
_option(Fate("UnifyCurrentGrid", _flag, _NO_WAVES))
_option(Fate("inertialF", _number(), "there are no coupled bodies or rods in this scene"))
_option(Fate("inertialF_rampT", _number("s"), "there are no coupled bodies or rods in this scene"))
_option(Fate("dtM", _number("s"), _STEP), "DT")
_option(Fate("CFL", _number(), _STEP))
_option(Fate("tScheme", _word, "the solver is chosen when the scene is loaded, not by the file"))
_option(Fate("dtIC", _number("s"), _STATICS), "ICdt")
_option(Fate("TmaxIC", _number("s"), _STATICS), "ICTmax")
_option(Fate("CdScaleIC", _number(), _STATICS), "ICDfac")
_option(Fate("threshIC", _number(), _STATICS), "ICthresh")
_option(Fate("ICgenDynamic", _flag, _STATICS))
_option(Fate("fileIC", _word, _STATICS))
for _name in ("writeLog", "writeUnits", "disableOutput", "disableOutTime", "OutSwitch", "Echo"):
    _option(Fate(_name, _flag, _OUTPUT))
_option(Fate("dtOut", _number("s"), _OUTPUT))


def read_options(section: Section) -> tuple[dict[str, object], dict[str, int], list[str]]:
    """The values by their usual names, the lines they stand in, and a warning for each that is not used.

    ``default`` as a value is the same as leaving the option out.
    """
    values: dict[str, object] = {}
    lines: dict[str, int] = {}
    warnings: list[str] = []
    for row in section.rows:
        if len(row.words) < 2:
            raise row.error(f"'{row.words[0]}' stands alone, expected a value and the name of an option")
        given = row.words[1]
        fate = FATES.get(given.upper())
        if fate is None:
            raise row.error(_unknown(row))
        if fate.name in lines:
            raise row.error(f"a second value for {fate.name} (the first is in line {lines[fate.name]}), expected one")
        lines[fate.name] = row.line
        if row.words[0].strip("\"'").lower() == DEFAULT:
            continue
        values[fate.name] = fate.read(row, given)
        if fate.unused:
            warnings.append(f"{row.file}:{row.line}: the option {given} is not used: {fate.unused}")
    return values, lines, warnings


def _unknown(row: Row) -> str:
    value, name = row.words[:2]
    if value.upper() in FATES and parse_number(name) is not None:
        return f"'{value}' stands before its value, expected '{name} {value}': the value comes first"
    usual = {fate.name.upper(): fate.name for fate in FATES.values()}
    near = difflib.get_close_matches(name.upper(), FATES, n=1, cutoff=0.5)
    expected = f"{FATES[near[0]].name} or another option of MoorDyn" if near else "one of " + ", ".join(usual.values())
    return f"unknown option '{name}', expected {expected}"
