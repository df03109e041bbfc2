"""The table of failures: lines that part from a point or from the end of a rod, at a time or at a tension."""

import math

from .description import Failure, Line
from .rows import Row, parse_count
from .sections import Section
from .tables import new_id, read_holder

_COLUMNS = "FailureID Point Lines FailTime FailTen"


def read_failures(section: Section) -> tuple[tuple[Failure, Row], ...]:
    """The failures by the order of the file, each with its row. A time or a tension of 0 is none, as in MoorDyn."""
    failures: dict[int, tuple[Failure, Row]] = {}
    for row in section.rows:
        words = row.words
        if len(words) < 5:
            raise row.error(f"{len(words)} columns, expected 5: {_COLUMNS} (a comment begins with #)")
        id = new_id(row, "failure", {id: failure for id, (failure, _) in failures.items()})
        # the ids of lines may have spaces after their commas
        row = Row(row.file, row.line, (*words[:2], "".join(words[2:-2]), *words[-2:]))
        time = row.number(3, "time of failure", "s, or 0 for none", at_least=0)
        tension = row.number(4, "tension of failure", "N, or 0 for none", at_least=0)
        if time == tension == 0:
            raise row.error(f"failure {id} has neither a time nor a tension, expected one of them > 0")
        failures[id] = Failure(
            id=id,
            holder=read_holder(row, 1, "the failure is at"),
            lines=_lines(row),
            time=time or math.inf,
            tension=tension or math.inf,
            source_line=row.line,
        ), row
    return tuple(failures.values())


def _lines(row: Row) -> tuple[int, ...]:
    ids = [parse_count(word) for word in row.words[2].split(",")]
    if None in ids or len(set(ids)) < len(ids):
        raise row.error(f"the lines are '{row.words[2]}', expected the IDs of different lines separated by commas, such as 1,2")
    return tuple(ids)


def check_failures(rows: tuple[tuple[Failure, Row], ...], lines: tuple[Line, ...]) -> tuple[tuple[Failure, ...], list[str]]:
    """The failures that are different from each other, and warnings. SceneError for a line that does not end where it fails."""
    by_id = {line.id: line for line in lines}
    failures: dict[tuple, Failure] = {}
    warnings = []
    for failure, row in rows:
        for id in failure.lines:
            if id not in by_id:
                raise row.error(f"line {id} does not exist, expected IDs in the section LINES")
            if failure.holder not in (by_id[id].end_a, by_id[id].end_b):
                raise row.error(f"line {id} does not end at '{row.words[1]}', expected lines that do")
        same = (failure.holder, frozenset(failure.lines), failure.time, failure.tension)
        if same in failures:
            warnings.append(f"{row.file}:{row.line}: failure {failure.id} is not used: it is the same as failure {failures[same].id}")
        else:
            failures[same] = failure
    return tuple(failures.values()), warnings
