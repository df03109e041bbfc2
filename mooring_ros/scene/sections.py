"""Sections of a MoorDyn file: where they begin and end, and which of their rows are headings."""

import difflib
import re
from dataclasses import dataclass, field

from .rows import Row, parse_number

LINE_TYPES = "LINE TYPES"
POINTS = "POINTS"
LINES = "LINES"
OPTIONS = "OPTIONS"
OUTPUTS = "OUTPUTS"
ROD_TYPES = "ROD TYPES"
BODIES = "BODIES"
RODS = "RODS"
FAILURE = "FAILURE"
CONTROL = "CONTROL"

# What MoorDyn-C and MoorDyn-F look for in a heading, and the section it opens.
TITLES = {
    "LINE TYPES": LINE_TYPES,
    "LINE DICTIONARY": LINE_TYPES,
    "POINTS": POINTS,
    "POINT LIST": POINTS,
    "POINT PROPERTIES": POINTS,
    "CONNECTIONS": POINTS,
    "CONNECTION PROPERTIES": POINTS,
    "NODE PROPERTIES": POINTS,
    "LINES": LINES,
    "LINE LIST": LINES,
    "LINE PROPERTIES": LINES,
    "OPTIONS": OPTIONS,
    "OUTPUT": OUTPUTS,
    "OUTPUTS": OUTPUTS,
    "ROD TYPES": ROD_TYPES,
    "ROD DICTIONARY": ROD_TYPES,
    "BODIES": BODIES,
    "BODY LIST": BODIES,
    "BODY PROPERTIES": BODIES,
    "RODS": RODS,
    "ROD LIST": RODS,
    "ROD PROPERTIES": RODS,
    "FAILURE": FAILURE,
    "FAILURES": FAILURE,
    "CONTROL": CONTROL,
    "EXTERNAL LOADS": "EXTERNAL LOADS",
    "SYROPE": "SYROPE",
}
NOT_MODELLED = {
    "EXTERNAL LOADS": "constant and damping loads on points, rods and bodies",
    "SYROPE": "Syrope working curves",
}
WITHOUT_COLUMN_NAMES = (OPTIONS, OUTPUTS)
_CLOSING = ("NEED THIS LINE", "END", "")
_FILE_TITLE = re.compile(r"\b(MOORDYN|MOORING|INPUT|FILE)\b")


@dataclass
class Section:
    """One section: its kind (a value of TITLES), the row of its heading, the row of column names if any, and its rows of data."""

    kind: str
    heading: Row
    names: Row | None = None
    rows: list[Row] = field(default_factory=list)


def split_sections(rows: list[Row]) -> tuple[dict[str, Section], list[str]]:
    """The sections of a file by kind, and warnings. What stands before the first section is free text, as in MoorDyn."""
    sections: dict[str, Section] = {}
    warnings: list[str] = []
    kind = None  # of the open section; None before the first and after a closing line
    contents: dict[str, list[Row]] = {}
    for index, row in enumerate(rows):
        if _is_heading(row):
            kind = _kind_of(row, before_first=not sections, first_row=index == 0)
            if kind is not None:
                if kind in sections:
                    raise row.error(f"a second section {kind} (the first is in line {sections[kind].heading.line}), expected one")
                sections[kind] = Section(kind, row)
                contents[kind] = []
        elif kind is not None:
            if [word.upper() for word in row.words] == ["END"]:
                kind = None
            else:
                contents[kind].append(row)
        elif sections:
            expected = "expected a section heading (--- TITLE ---), a comment (# ...) or the end of the file"
            raise row.error(f"'{row.words[0]}' stands after the end of a section, {expected}")
    for kind, section in sections.items():
        _set_rows(section, contents[kind], warnings)
        if kind in NOT_MODELLED and section.rows:
            raise section.rows[0].error(f"the section {kind} has rows, expected none: {NOT_MODELLED[kind]} are not modelled")
    return sections, warnings


def _is_heading(row: Row) -> bool:
    return any("---" in word for word in row.words)


def _kind_of(row: Row, before_first: bool, first_row: bool) -> str | None:
    title = " ".join(" ".join(row.words).replace("-", " ").replace("=", " ").upper().split())
    kinds = {kind for name, kind in TITLES.items() if re.search(rf"\b{name}\b", title)}
    if len(kinds) == 1:
        return kinds.pop()
    known = ", ".join(dict.fromkeys(TITLES.values()))
    if kinds:
        raise row.error(f"the heading '{title}' names several sections ({', '.join(sorted(kinds))}), expected one")
    if title in _CLOSING or "NEED THIS LINE" in title:
        return None
    near = difflib.get_close_matches(title, TITLES, n=1, cutoff=0.7)
    if before_first and not near and (first_row or _FILE_TITLE.search(title)):
        return None
    raise row.error(f"unknown section '{title}', expected {near[0] if near else 'one of ' + known}")


def _set_rows(section: Section, rows: list[Row], warnings: list[str]) -> None:
    """Takes the rows of column names and units off. MoorDyn takes two rows blindly; here no row with a number in it is lost."""
    if section.kind not in WITHOUT_COLUMN_NAMES:
        headings = 0
        while headings < min(2, len(rows)) and all(parse_number(word) is None for word in rows[headings].words):
            headings += 1
        if headings and not rows[0].words[0].startswith("("):
            section.names = rows[0]
        if rows and headings < 2:
            warnings.append(
                f"{section.heading.file}:{section.heading.line}: the section {section.kind} has {headings} instead of 2 rows"
                " of column names and units; all its rows are read here, MoorDyn would skip two"
            )
        rows = rows[headings:]
    section.rows = rows
