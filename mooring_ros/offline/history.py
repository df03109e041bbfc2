"""Named scalar histories, tensions and wrenches, from CSV and from MCAP."""

import os
from dataclasses import dataclass, field

import numpy as np

from mooring_ros.recording.records import is_mcap

from .number_table import read_table

EXPECTED = "time,NAME,NAME,…"
TIME_NAMES = ("time", "t")


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

    A table has a header whose first name is `time` (or `Time`, `t`), commas or blanks between its cells, and may have a row of units in parentheses.
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
    values = table.values[last_of_each]
    series = {name: values[:, column] for column, name in enumerate(table.names) if column}
    return History(str(path), values[:, 0], series, remarks)


def _check_header(place, names):
    if names[0].lower() not in TIME_NAMES:
        raise ValueError(f"{place}: the first column is {names[0]!r}, expected {EXPECTED}")
    if len(names) < 2:
        raise ValueError(f"{place}: no column beside the time, expected {EXPECTED}")
