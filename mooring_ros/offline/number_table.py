"""Text tables of numbers: a header, then rows. Every complaint names file, line and what was expected."""

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class NumberTable:
    """names: of the columns, as in the header; values (rows, columns); lines: the line of each row in the file; header_line.

    units: of the columns, without their parentheses, and the line they stand in; None where there is no such row.
    """

    names: list
    values: np.ndarray
    lines: list
    header_line: int
    units: tuple | None = None


def read_table(path, expected, whitespace=False, units_row=False, check_header=None):
    """Read a table. expected: what the header should be, for messages.

    Cells stand between commas, in quotes or not; with `whitespace`, a header without a comma means cells between blanks or tabs. Blank lines and what
    follows `#` are left out. With `units_row`, a row of units such as `(s) (N)` may follow the header. check_header(place, names) may raise.
    Raises ValueError with FILE:LINE: not text, no header, a wrong count of columns, not a number, not finite; OSError.
    """
    names, rows, lines, header_line, units = None, [], [], 0, None
    separator = ","
    for number, cells_text in _rows(path):
        place = f"{path}:{number}"
        if names is None:
            separator = "," if "," in cells_text or not whitespace else None
            names, header_line = _cells(cells_text, separator), number
            _check_names(place, names, expected)
            if check_header:
                check_header(place, names)
            continue
        cells = _cells(cells_text, separator)
        if units_row and not rows and number_of(cells[0]) is None and _is_units(cells):
            units = [cell[1:-1].strip() for cell in cells], number
            continue
        if len(cells) != len(names):
            raise ValueError(f"{place}: {len(cells)} columns, expected {len(names)} as in the header: {','.join(names)}")
        rows.append([_number(place, cell, name) for cell, name in zip(cells, names)])
        lines.append(number)
    if names is None:
        raise ValueError(f"{path}:1: the file is empty, expected a header {expected}")
    return NumberTable(names, np.array(rows, dtype=float).reshape(len(rows), len(names)), lines, header_line, units)


def _rows(path):
    """Yield (line number, text) of the lines with something on them."""
    with open(path, "rb") as file:
        lines = (line for ended in file for line in ended.splitlines())  # also those that end in a carriage return alone
        for number, raw in enumerate(lines, start=1):
            try:
                text = raw.decode("utf-8-sig" if number == 1 else "utf-8")
            except UnicodeDecodeError:
                raise ValueError(f"{path}:{number}: not text, expected a table of numbers in UTF-8") from None
            if "\0" in text:
                raise ValueError(f"{path}:{number}: not text, expected a table of numbers")
            text = text.split("#", 1)[0].strip()
            if text:
                yield number, text


def _cells(text, separator):
    return [cell.strip().strip('"') for cell in text.split(separator)]


def _check_names(place, names, expected):
    if all(number_of(name) is not None for name in names):
        raise ValueError(f"{place}: numbers where the header should be, expected {expected}")
    for name in names:
        if not name:
            raise ValueError(f"{place}: a column without a name, expected {expected}")
        if names.count(name) > 1:
            raise ValueError(f"{place}: column {name!r} is there twice, expected every name once")


def _is_units(cells):
    return all(cell.startswith("(") and cell.endswith(")") for cell in cells)


def number_of(text):
    """The float that a cell holds, or None."""
    try:
        return None if "_" in text else float(text)
    except ValueError:
        return None


def _number(place, cell, name):
    value = number_of(cell)
    if value is None:
        raise ValueError(f"{place}: {cell!r} in column {name!r}, expected a number")
    if not math.isfinite(value):
        raise ValueError(f"{place}: {cell} in column {name!r}, expected a finite number")
    return value
