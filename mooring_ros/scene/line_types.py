"""The table of line types: linear, with a load-strain curve from a file, or viscoelastic in MoorDyn's two-Kelvin form."""

import re

from .description import LineType
from .files import HEADING_LINES, Files
from .rows import Row, parse_number
from .sections import Section

_FILE = re.compile(r"[\\/]|\.(?:txt|dat|csv|inp)$", re.IGNORECASE)
_COLUMNS = "Name Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx"
_LIFT = ("lift coefficient Cl", "dF", "cF")


def read_line_types(section: Section, files: Files) -> tuple[LineType, ...]:
    """The line types by the order of the file."""
    _refuse_version_1(section)
    types: dict[str, LineType] = {}
    for row in section.rows:
        if len(row.words) not in (10, 11, 12, 13):
            raise row.error(f"{len(row.words)} columns, expected 10: {_COLUMNS} (a comment begins with #)")
        name = row.words[0]
        if name in types:
            raise row.error(f"a second line type '{name}' (the first is in line {types[name].source_line}), expected another name")
        types[name] = LineType(
            name=name,
            diameter=row.number(1, "diameter", "m", above=0),
            mass=row.number(2, "mass", "kg/m", above=0),
            **_elasticity(row, files),
            bending_stiffness=_bending_stiffness(row),
            drag_normal=row.number(6, "drag coefficient Cd", at_least=0),
            added_mass_normal=row.number(7, "added mass coefficient Ca", at_least=0),
            drag_axial=row.number(8, "axial drag coefficient CdAx", at_least=0),
            added_mass_axial=row.number(9, "axial added mass coefficient CaAx", at_least=0),
            source_line=row.line,
        )
        for index in range(10, len(row.words)):
            value = row.number(index, _LIFT[index - 10], at_least=0)
            if index == 10 and value > 0:
                raise row.error(f"lift coefficient Cl is {row.words[10]}, expected 0: vortex-induced vibration is not modelled")
    return tuple(types.values())


def _refuse_version_1(section: Section) -> None:
    names = [word.upper() for word in section.names.words] if section.names else []
    added_mass = [i for i, name in enumerate(names) if name.startswith("CA")]
    drag = [i for i, name in enumerate(names) if name.startswith("CD")]
    if added_mass and drag and added_mass[0] < drag[0]:
        raise section.names.error(f"columns in the order of MoorDyn v1 (added mass before drag), expected those of v2: {_COLUMNS}")


def _elasticity(row: Row, files: Files) -> dict[str, object]:
    """The fields of LineType that the columns EA and BA give."""
    stiffness, damping = row.words[3:5]
    if _is_file(damping):
        raise row.error(f"damping BA is the file '{damping}', expected a number: damping curves are not modelled")
    if stiffness.upper().startswith("SYROPE"):
        raise row.error(f"stiffness EA is '{stiffness}', expected a number, a file or EA_S|EA_D: Syrope working curves are not modelled")
    if "|" in stiffness:
        return _two_kelvin(row)
    if "|" in damping:
        raise row.error(f"damping BA is '{damping}', expected one number, because the stiffness EA is not given as EA_S|EA_D")
    given = row.number(4, "damping BA/-zeta", "N s, or minus the fraction of critical damping")
    if parse_number(stiffness) is not None:
        return {"stiffness": row.number(3, "stiffness EA", "N", above=0), "damping": given}
    if not _is_file(stiffness):
        raise row.error(f"stiffness EA is '{stiffness}', expected a number > 0 (N) or the name of a file such as curve.txt")
    curve = _load_strain_curve(row, files)
    steepest = max((b - a) / (y - x) for (x, a), (y, b) in zip(curve, curve[1:]))
    return {"stiffness": steepest, "damping": given, "curve": curve}


def _is_file(word: str) -> bool:
    return parse_number(word) is None and _FILE.search(word) is not None


def _two_kelvin(row: Row) -> dict[str, float]:
    """``EA_S|EA_D`` and ``BA_S|BA_D``: in MoorDyn EA_D and BA_D are those of the quick element, BA_S is that of the slow one in series,
    whose stiffness makes the series as stiff as EA_S."""
    if len(row.words[3].split("|")) == 3:
        raise row.error(f"stiffness EA is '{row.words[3]}', expected EA_S|EA_D: a stiffness that depends on the load (EA_S|a|b) is not modelled")
    static, dynamic = row.numbers(3, "stiffness EA", (1, 2), "N", at_least=0)
    if not 0 < static < dynamic:
        raise row.error(f"stiffness EA is '{row.words[3]}', expected EA_S|EA_D with 0 < EA_S < EA_D (N)")
    slow_damping, damping = (*row.numbers(4, "damping BA of a viscoelastic line", (1, 2), "N s", at_least=0), 0.0)[:2]
    if slow_damping + damping <= 0:
        raise row.error(f"damping BA is '{row.words[4]}', expected BA_S|BA_D (N s), one of them > 0: nothing else rules how the line creeps")
    return {
        "stiffness": dynamic,
        "damping": damping,
        "slow_stiffness": dynamic * static / (dynamic - static),
        "slow_damping": slow_damping,
    }


def _load_strain_curve(row: Row, files: Files) -> tuple[tuple[float, float], ...]:
    """(strain, tension in N) from (0, 0). Beyond the last point the last piece goes on (MoorDyn holds the last tension there)."""
    curve = [(0.0, 0.0)]
    rows = files.table(row, row.words[3], "a load-strain curve", (("strain", "-"), ("tension", "N")), HEADING_LINES)
    for index, point in enumerate(rows):
        strain, tension = point.number(0, "strain", at_least=0), point.number(1, "tension", "N", at_least=0)
        if index == 0 and strain == tension == 0:
            continue
        if not (strain > curve[-1][0] and tension > curve[-1][1]):
            raise point.error(
                f"strain {point.words[0]} with tension {point.words[1]} N follows {curve[-1][0]:g} with {curve[-1][1]:g} N, expected both to grow"
            )
        curve.append((strain, tension))
    return tuple(curve)


def _bending_stiffness(row: Row) -> float:
    word = row.words[5]
    if "|" in word or _is_file(word):
        raise row.error(f"bending stiffness EI is '{word}', expected a number >= 0 (N m^2): moment-curvature curves are not modelled")
    return row.number(5, "bending stiffness EI", "N m^2", at_least=0)
