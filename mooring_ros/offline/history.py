"""Named scalar histories, tensions and wrenches, from CSV and from MCAP."""

import os
from dataclasses import dataclass, field

import numpy as np

from mooring_ros.recording.records import is_mcap

from .number_table import read_table

EXPECTED = "time,NAME,NAME,…"
TIME_NAMES = ("time", "t")
_FORCES = {"N": 1.0, "kN": 1e3, "MN": 1e6}
_OTHERS = ("lbf", "klbf", "kip", "kips", "kgf", "tf", "t", "te", "mt")  # forces that are not taken


@dataclass(frozen=True)
class History:
    """Series of one run, all at the same times.

    path: where from; times (n,) s, increasing; series: dict of name -> (n,), N and N·m for ours; remarks: str, what a user should know.
    """

    path: str
    times: np.ndarray
    series: dict
    remarks: tuple = field(default=())
    scale: str = ""  # in words, where the file says it


def load_history(path):
    """The History in a CSV file, a MoorDyn output table, or an MCAP recording of the node or of a replay.

    A table has a header whose first name is `time` (or `Time`, `t`), commas or blanks between its cells, and may have a row of units in parentheses: kN and
    MN, also times m, are turned into N; other units of force and of time are refused.
    Raises ValueError (FILE:LINE or FILE: what is wrong, what was expected) and OSError.
    """
    path = os.fspath(path)
    if os.path.isdir(path) or path.endswith((".mcap", ".db3")) or is_mcap(path):
        from .history_mcap import load_mcap_history

        return load_mcap_history(path)
    return _load_table(path)


def _load_table(path):
    table = read_table(path, EXPECTED, whitespace=True, units_row=True, check_header=_check_header)
    if len(table.lines) < 2:
        raise ValueError(f"{path}:{table.lines[-1] if table.lines else table.header_line}: "
                         f"{len(table.lines)} samples, expected at least 2")
    times = table.values[:, 0]
    steps = np.diff(times)
    if (steps < 0.0).any():
        row = int(np.argmax(steps < 0.0)) + 1
        raise ValueError(f"{path}:{table.lines[row]}: time {times[row]:.9g} s after {times[row - 1]:.9g} s, expected it to increase")
    last_of_each = np.append(steps > 0.0, True)         # of rows with the same time
    remarks = ()
    if not last_of_each.all():
        remarks = (f"{path}: {int((~last_of_each).sum())} rows whose time comes again in the next row were left out",)
    if last_of_each.sum() < 2:
        raise ValueError(f"{path}:{table.lines[-1]}: all samples at {times[0]:.9g} s, expected at least 2 times")
    factors, more = _factors(path, table)
    values, remarks = table.values[last_of_each] * factors, (*remarks, *more)
    series = {name: values[:, column] for column, name in enumerate(table.names) if column}
    return History(str(path), values[:, 0], series, remarks)


def _check_header(place, names):
    if names[0].lower() not in TIME_NAMES:
        raise ValueError(f"{place}: the first column is {names[0]!r}, expected {EXPECTED}")
    if len(names) < 2:
        raise ValueError(f"{place}: no column beside the time, expected {EXPECTED}")


def _factors(path, table):
    """(factors (columns,) that make SI units of the values, remarks)."""
    factors, taken = np.ones(len(table.names)), []
    if table.units is None:
        return factors, ()
    units, line = table.units
    for column, (name, unit) in enumerate(zip(table.names, units)):
        force = next((known for known in _FORCES if unit in (known, *(f"{known}{sign}m" for sign in ("", " ", "-", "*", "·")))), None)
        if column == 0 and unit.lower() not in ("s", "sec", "") or unit.lower() in _OTHERS:
            raise ValueError(f"{path}:{line}: column {name!r} is in ({unit}), expected {'(s)' if column == 0 else '(N), (kN) or (MN)'}")
        if force and _FORCES[force] != 1.0:
            factors[column] = _FORCES[force]
            taken.append(force)
    return factors, (f"{path}:{line}: {' and '.join(dict.fromkeys(taken))} were turned into N",) if taken else ()
