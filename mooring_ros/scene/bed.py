"""The shape of the bed: MoorDyn's bathymetry files, and the level of the bed at a place."""

from bisect import bisect_right

from .description import Bathymetry, Environment
from .files import Files
from .rows import Row, parse_count, parse_number

_WHAT = "a bathymetry file as MoorDyn-C or MoorDyn-F reads it"
_MOST_NODES = 1_000_000


def bed_level(environment: Environment, x: float, y: float) -> float:
    """z of the bed (m), bilinear on a grid; beyond it that of the nearest place on its edge."""
    grid = environment.bathymetry
    if grid is None:
        return -environment.depth + environment.bed_slope[0] * x + environment.bed_slope[1] * y
    return -_depth(grid, x, y)


def depth_at_origin(grid: Bathymetry) -> float:
    return _depth(grid, 0.0, 0.0)


def _depth(grid: Bathymetry, x: float, y: float) -> float:
    i, s = _cell(grid.x, x)
    j, t = _cell(grid.y, y)
    near, far = ((1 - t) * row[j] + t * row[j + 1] for row in grid.depth[i : i + 2])
    return (1 - s) * near + s * far


def _cell(ticks: tuple[float, ...], value: float) -> tuple[int, float]:
    """The interval of a place and where in it (0 to 1) the place is."""
    index = min(max(bisect_right(ticks, value) - 1, 0), len(ticks) - 2)
    return index, min(max((value - ticks[index]) / (ticks[index + 1] - ticks[index]), 0.0), 1.0)


def read_bathymetry(files: Files, asked: Row, name: str) -> Bathymetry:
    """The grid of a file; its first rows say which of MoorDyn's two forms it has."""
    rows = files.rows(asked, name, _WHAT)
    if all(parse_count(word) is not None for word in rows[0].words[:2]) and len(rows[0].words) >= 2:
        return _of_places(rows)
    keys = [row.words[0].upper() for row in rows[:3]]
    for first in (0, 1):  # the title may be blank
        if keys[first : first + 2] == ["NGRIDX", "NGRIDY"]:
            return _of_rows(rows[first:])
    raise rows[0].error(
        f"'{' '.join(rows[0].words)[:40]}', expected the numbers of x and y (MoorDyn-C), or a title above rows of nGridX and nGridY (MoorDyn-F)"
    )


def _of_places(rows: list[Row]) -> Bathymetry:
    """MoorDyn-C: numbers of x and y, the x, the y, then a row (x, y, z up) for each place of the grid."""
    first = rows[0]
    sizes = [_size(first, index, name) for index, name in enumerate("xy")]
    if len(rows) < 3:
        raise rows[-1].error("the file ends here, expected a row of x and a row of y")
    x, y = (_ticks(row, row.words, size, name) for row, size, name in zip(rows[1:3], sizes, "xy"))
    index_x, index_y = ({value: index for index, value in enumerate(ticks)} for ticks in (x, y))
    depth: list[list[float | None]] = [[None] * len(y) for _ in x]
    for row in rows[3:]:
        if len(row.words) != 3:
            raise row.error(f"{len(row.words)} columns, expected 3: x y z")
        i, j = index_x.get(row.number(0, "x", "m")), index_y.get(row.number(1, "y", "m"))
        if i is None or j is None:
            name, value, line = ("x", row.words[0], rows[1].line) if i is None else ("y", row.words[1], rows[2].line)
            raise row.error(f"{name} = {value} is no place of the grid, expected one of those in line {line}")
        if depth[i][j] is not None:
            raise row.error(f"a second z at x = {row.words[0]}, y = {row.words[1]}, expected one")
        z = row.number(2, "z of the bed", "m")
        if z >= 0:
            raise row.error(f"z of the bed is {row.words[2]}, expected a number < 0 (m): z is up, as MoorDyn-C reads it")
        depth[i][j] = -z
    for i, column in enumerate(depth):
        if None in column:
            raise first.error(f"there is no z at x = {x[i]:g}, y = {y[column.index(None)]:g}, expected one for each place of the grid")
    return Bathymetry(x, y, tuple(map(tuple, depth)))


def _of_rows(rows: list[Row]) -> Bathymetry:
    """MoorDyn-F: nGridX, nGridY, a row of x, then for each y a row: y and the depths (m, down) along x."""
    sizes = []
    for row, axis in zip(rows, "xy"):
        if len(row.words) < 2:
            raise row.error(f"the number of {axis} is missing, expected nGrid{axis.upper()} and a whole number")
        sizes.append(_size(row, 1, axis))
    if len(rows) < 3:
        raise rows[-1].error("the file ends here, expected a row of x")
    x = _ticks(rows[2], rows[2].words, sizes[0], "x")
    table = rows[3:]
    if len(table) != sizes[1]:
        raise rows[-1].error(f"{len(table)} rows of depths, expected {sizes[1]} (nGridY in line {rows[1].line})")
    for row in table:
        if len(row.words) != sizes[0] + 1:
            raise row.error(f"{len(row.words)} columns, expected {sizes[0] + 1}: y and {sizes[0]} depths")
    y = tuple(row.number(0, "y", "m") for row in table)
    for row, before, value in zip(table[1:], y, y[1:]):
        _check_growing(row, "y", before, value)
    depths = [[row.number(1 + i, "depth", "m", above=0) for i in range(sizes[0])] for row in table]
    return Bathymetry(x, y, tuple(zip(*depths)))


def _size(row: Row, index: int, name: str) -> int:
    size = parse_count(row.words[index])
    if size is None or not 2 <= size <= _MOST_NODES:
        raise row.error(f"the number of {name} is '{row.words[index]}', expected a whole number from 2 to {_MOST_NODES}")
    return size


def _ticks(row: Row, words: tuple[str, ...], size: int, name: str) -> tuple[float, ...]:
    if len(words) != size or any(parse_number(word) is None for word in words[:1]):
        raise row.error(f"{len(words)} columns, expected {size} numbers: the {name} of the grid (m)")
    ticks = tuple(row.number(index, name, "m") for index in range(size))
    for before, value in zip(ticks, ticks[1:]):
        _check_growing(row, name, before, value)
    return ticks


def _check_growing(row: Row, name: str, before: float, value: float) -> None:
    if value <= before:
        raise row.error(f"{name} = {value:g} follows {before:g}, expected growing numbers")
