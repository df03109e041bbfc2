"""Reads MoorDyn v2 input files."""

import os
from collections.abc import Iterable

from .description import ANGLE, Scene
from .environment import build_environment
from .errors import SceneError
from .failures import check_failures, read_failures
from .files import Files, read_text, refuse_binary
from .line_types import read_line_types
from .options import read_options
from .parts import read_bodies, read_rod_types, read_rods
from .placement import check_bodies, place_points, place_rods
from .references import check_carriers, check_holding, check_masses, resolve_lines
from .rows import read_rows
from .sections import BODIES, CONTROL, FAILURE, LINE_TYPES, LINES, OPTIONS, OUTPUTS, POINTS, ROD_TYPES, RODS, Section, split_sections
from .tables import read_lines, read_points

_EXPECTED = "expected a MoorDyn v2 input file"
_UNUSED = {
    OUTPUTS: "every tension is published and recorded",
    CONTROL: "unstretched lengths are changed while running with Mooring.set_unstretched_length",
}


def load_scene(path: str | os.PathLike, folders: Iterable[str] | None = None) -> Scene:
    """Reads and checks a MoorDyn v2 input file and the files that it names. SceneError when one cannot be read or used.

    folders: whole paths below which a file that it names must lie, links followed; None for anywhere.
    """
    file = os.fsdecode(path)
    return parse_scene(read_text(file, _EXPECTED), file, folders=folders)


def parse_scene(text: str, path: str | os.PathLike = "scene", files: Iterable[tuple[str, str]] | None = None,
                folders: Iterable[str] | None = None) -> Scene:
    """Checks the content of a MoorDyn v2 input file.

    The files that it names are read from beside ``path``; with ``files`` (name as written, content; such as Scene.files) from there alone;
    with ``folders`` from below these alone.
    """
    file = os.fsdecode(path)
    refuse_binary(text, file, _EXPECTED)
    rows = read_rows(text, file)
    if not rows:
        raise SceneError(file, 0, f"the file is empty, {_EXPECTED}")
    sections, warnings = split_sections(rows)
    needed = (LINE_TYPES, LINES, OPTIONS) if RODS in sections else (LINE_TYPES, POINTS, LINES, OPTIONS)
    for kind in needed:
        if kind not in sections:
            raise SceneError(file, 0, f"no section {kind}, {_EXPECTED} with the sections LINE TYPES, POINTS, LINES and OPTIONS")

    others = Files(file, files, folders)
    read = _read_sections(sections, others)
    line_types, bodies, rods, rod_types = (read.get(kind, ()) for kind in (LINE_TYPES, BODIES, RODS, ROD_TYPES))
    points, on_the_bed = read.get(POINTS, ((), frozenset()))
    options, unused = read[OPTIONS]
    warnings += unused
    for kind, why in _UNUSED.items():
        if kind in sections and sections[kind].rows:
            warnings.append(f"{file}:{sections[kind].heading.line}: the section {kind} is not used: {why}")
    if not read[LINES]:
        raise SceneError(file, sections[LINES].heading.line, "the section LINES has no rows, expected one line at least")
    lines = resolve_lines(read[LINES], line_types, points, rods)
    check_carriers(file, points, rods, bodies)
    failures, more = check_failures(read.get(FAILURE, ()), lines)
    warnings += more
    environment, more = build_environment(options, others)
    warnings += more

    warnings += check_bodies(file, bodies, environment)
    points, more = place_points(file, points, on_the_bed, bodies, environment)
    warnings += more
    rods, more = place_rods(file, rods, bodies, environment)
    warnings += more
    warnings += check_holding(file, points, rods, bodies, lines)
    check_masses(file, points, rods, bodies)
    if not any(line.type.bending_stiffness for line in lines):
        warnings += options.unused("no line has bending stiffness", "BendingModel")
    bending = options.take("BendingModel", ANGLE)
    return Scene(
        path=file,
        text=text,
        line_types=line_types,
        points=points,
        lines=lines,
        environment=environment,
        rod_types=rod_types,
        rods=rods,
        bodies=bodies,
        failures=failures,
        bending=bending,
        options=options.left(),
        warnings=(*warnings, *others.warnings),
        files=others.contents,
    )


def _read_sections(sections: dict[str, Section], files: Files) -> dict[str, object]:
    """What stands in each section, read in the order of the file, so that the first thing that is wrong is the one reported."""
    readers = {
        LINE_TYPES: lambda section: read_line_types(section, files),
        ROD_TYPES: read_rod_types,
        BODIES: read_bodies,
        POINTS: read_points,
        LINES: read_lines,
        FAILURE: read_failures,
        OPTIONS: read_options,
    }
    read: dict[str, object] = {}
    for kind, section in sections.items():
        if kind == RODS:
            if ROD_TYPES in sections and ROD_TYPES not in read:
                read[ROD_TYPES] = read_rod_types(sections[ROD_TYPES])
            read[RODS] = read_rods(section, read.get(ROD_TYPES, ()))
        elif kind in readers:
            read[kind] = readers[kind](section)
    return read
