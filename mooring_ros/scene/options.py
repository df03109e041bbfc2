"""The options of a MoorDyn file: each one known has a fate in one table, none is skipped."""

import difflib
from collections.abc import Callable
from dataclasses import dataclass

from .files import unquoted
from .rows import Row, parse_count, parse_number
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


def _count(least: int, largest: int):
    def read(row: Row, name: str) -> int:
        value = parse_count(row.words[0])
        if value is None or not least <= value <= largest:
            raise row.error(f"{name} is '{row.words[0]}', expected a whole number from {least} to {largest}")
        return value

    return read


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


def _mode(*built: int, **refused: str):
    """A switch with numbers; 0 and words for nothing are off. ``refused`` says by name (such as m2) what other numbers would be."""

    def read(row: Row, name: str) -> int:
        value = 0 if _is_off(row.words[0]) else parse_count(row.words[0])
        if value == 0 or value in built:
            return value
        expected = " or ".join(str(mode) for mode in (0, *built))
        why = f": {refused[f'm{value}']}" if value is not None and f"m{value}" in refused else ""
        raise row.error(f"{name} is '{row.words[0]}', expected {expected}{why}")

    return read


def _is_off(word: str) -> bool:
    word = unquoted(word)
    return parse_number(word) == 0.0 or word.lower() in ("", "-", "none", "null", "false", "f", "unused")


def _file(row: Row, name: str) -> str:
    """The name of a file, or "" for none."""
    return "" if _is_off(row.words[0]) else unquoted(row.words[0])


def _water_file(row: Row, name: str) -> str:
    if unquoted(row.words[0]).upper() == "SEASTATE":
        raise row.error(f"{name} is '{row.words[0]}', expected the name of a file or nothing: SeaState is not there")
    return _file(row, name)


def _depth(row: Row, name: str) -> float | str:
    """The depth, or the name of a bathymetry file as in MoorDyn-F."""
    if parse_number(row.words[0]) is None and any(letter.isalpha() for letter in row.words[0]):
        return unquoted(row.words[0])
    return row.number(0, name, "m", above=0)


_STEP = "the step is chosen from the stability limits of the scene, or given to the solver"
_STATICS = "the initial state comes from a static solution, not from dynamic relaxation"
_OUTPUT = "what is written is decided by the node and the command line"
_GRIDS = "the water's motion is computed at the nodes themselves"
_INERTIA = "coupled bodies and rods always return the forces of their inertia"

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

_option(Fate("SeafloorFile", _file), "SeafloorPath")
for _axis in "XY":
    _option(Fate(f"BedSlope{_axis}", _number("rise over run")))

_option(Fate("FrictionModel", _one_of("saturated", "stick")))
_option(Fate("FrictionCoefficient", _number(at_least=0)))
_option(Fate("mu_kT", _number(at_least=0)))
_option(Fate("mu_kA", _number(at_least=0)))
_option(Fate("mc", _number(at_least=0)), "StatDynFricScale")
_option(Fate("cv", _number("N s/m", at_least=0)), "FricDamp")

_option(Fate("BendingModel", _one_of("angle", "paper")))

_option(Fate("WaveModel", _one_of("regular", "jonswap", "elevation", "none")))
_option(Fate("WaveHeight", _number("m", above=0)))
_option(Fate("WavePeriod", _number("s", above=0)))
_option(Fate("WaveDirection", _number("degrees")))
_option(Fate("WaveGamma", _number(at_least=1)))
_option(Fate("WaveSeed", _count(0, 999_999_999)))
_option(Fate("WaveComponents", _count(1, 10_000)))
_option(Fate("WavePhase", _number("degrees")))
_option(Fate("WaveElevationFile", _file))
_option(Fate("WaveRamp", _number("s", at_least=0)), "waveKin_rampT")
_GRID = "kinematics from a grid of frequencies are not modelled"
_AT_NODES = "MoorDyn has not built it either"
_option(Fate("WaveKin", _mode(3, 7, m1="waves set from outside are not modelled", m2=_GRID, m4=_AT_NODES, m5=_AT_NODES, m6=_AT_NODES)))
_UNSTEADY = "currents that change in time are not modelled"
_option(Fate("Currents", _mode(1, m2=_UNSTEADY, m3=_AT_NODES, m4=_AT_NODES, m5=_UNSTEADY)))
_option(Fate("WaterKin", _water_file))
_option(Fate("dtWave", _number("s", at_least=0)))
_option(Fate("UnifyCurrentGrid", _flag, _GRIDS))

_option(Fate("inertialF", _number(), _INERTIA))
_option(Fate("inertialF_rampT", _number("s"), _INERTIA))
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


class Options:
    """The options of a file: each is taken by what uses it, what nobody takes is left."""

    def __init__(self, values: dict[str, object], rows: dict[str, Row], heading: Row):
        self._values = values
        self._rows = rows
        self._heading = heading

    def take(self, name: str, otherwise: object = None) -> object:
        """The value of an option, which is then no longer left."""
        return self._values.pop(name, otherwise)

    def get(self, name: str, otherwise: object = None) -> object:
        return self._values.get(name, otherwise)

    def row(self, name: str) -> Row:
        """The row of an option; that of the section's heading when it is not in the file."""
        return self._rows.get(name, self._heading)

    def left(self) -> dict[str, object]:
        return dict(self._values)

    def unused(self, why: str, *names: str) -> list[str]:
        """A warning for each of the options that is still left, whose row it names."""
        rows = [self._rows[name] for name in names if name in self._values]
        return [_unused(why, [row]) for row in rows]


def read_options(section: Section) -> tuple[Options, list[str]]:
    """The options by their usual names, and a warning for each reason why some are never used.

    ``default`` as a value is the same as leaving the option out.
    """
    values: dict[str, object] = {}
    rows: dict[str, Row] = {}
    never_used: dict[str, list[Row]] = {}
    for row in section.rows:
        if len(row.words) < 2:
            raise row.error(f"'{row.words[0]}' stands alone, expected a value and the name of an option")
        given = row.words[1]
        fate = FATES.get(given.upper())
        if fate is None:
            raise row.error(_unknown(row))
        if fate.name in rows:
            raise row.error(f"a second value for {fate.name} (the first is in line {rows[fate.name].line}), expected one")
        rows[fate.name] = row
        if unquoted(row.words[0]).lower() == DEFAULT:
            continue
        values[fate.name] = fate.read(row, given)
        if fate.unused:
            never_used.setdefault(fate.unused, []).append(row)
    return Options(values, rows, section.heading), [_unused(why, options) for why, options in never_used.items()]


def _unused(why: str, rows: list[Row]) -> str:
    first, *others = rows
    place, name = f"{first.file}:{first.line}", first.words[1]
    if not others:
        return f"{place}: the option {name} is not used: {why}"
    return f"{place}: the options {name}, {', '.join(f'{row.words[1]} (line {row.line})' for row in others)} are not used: {why}"


def _unknown(row: Row) -> str:
    value, name = row.words[:2]
    if value.upper() in FATES and parse_number(name) is not None:
        return f"'{value}' stands before its value, expected '{name} {value}': the value comes first"
    usual = {fate.name.upper(): fate.name for fate in FATES.values()}
    near = difflib.get_close_matches(name.upper(), FATES, n=1, cutoff=0.6)
    expected = f"{FATES[near[0]].name} or another option of MoorDyn" if near else "one of " + ", ".join(usual.values())
    return f"unknown option '{name}', expected {expected}"
