"""Reads MoorDyn v2 input files."""

import os
from pathlib import Path

from .checks import check_points, resolve_lines
from .description import Environment, Scene
from .errors import SceneError
from .options import read_options
from .rows import read_rows
from .sections import LINE_TYPES, LINES, OPTIONS, OUTPUTS, POINTS, split_sections
from .tables import read_line_types, read_lines, read_points

_READERS = {LINE_TYPES: read_line_types, POINTS: read_points, LINES: read_lines, OPTIONS: read_options}
_EXPECTED = "expected a MoorDyn v2 input file"
_LARGEST_FILE = 16 * 1024 * 1024  # bytes


def load_scene(path: str | os.PathLike) -> Scene:
    """Reads and checks a MoorDyn v2 input file. SceneError when it cannot be read or used."""
    file = os.fsdecode(path)
    return parse_scene(_read_text(file), file)


def parse_scene(text: str, path: str | os.PathLike = "scene") -> Scene:
    """Checks the content of a MoorDyn v2 input file; ``path`` is only for messages and for Scene.path."""
    file = os.fsdecode(path)
    if "\0" in text:
        raise SceneError(file, text.count("\n", 0, text.index("\0")) + 1, f"not a text file, {_EXPECTED}")
    rows = read_rows(text, file)
    if not rows:
        raise SceneError(file, 0, f"the file is empty, {_EXPECTED}")
    sections, warnings = split_sections(rows)
    for kind in (LINE_TYPES, POINTS, LINES, OPTIONS):
        if kind not in sections:
            raise SceneError(file, 0, f"no section {kind}, {_EXPECTED} with the sections LINE TYPES, POINTS, LINES and OPTIONS")

    # In the order of the file, so that the first thing that is wrong is the one reported.
    read = {kind: _READERS[kind](section) for kind, section in sections.items() if kind in _READERS}
    line_types, points = read[LINE_TYPES], read[POINTS]
    options, option_lines, unused = read[OPTIONS]
    warnings += unused
    if OUTPUTS in sections and sections[OUTPUTS].rows:
        warnings.append(f"{file}:{sections[OUTPUTS].heading.line}: the section OUTPUTS is not used: every tension is published and recorded")
    if not read[LINES]:
        raise SceneError(file, sections[LINES].heading.line, "the section LINES has no rows, expected one line at least")
    lines = resolve_lines(read[LINES], line_types, points)
    if "WtrDpth" not in options:
        line = option_lines.get("WtrDpth", sections[OPTIONS].heading.line)
        raise SceneError(file, line, "the water depth is missing, expected an option like '200 WtrDpth' (m): it has no default")
    environment = _environment(options)
    warnings += check_points(file, points, lines, environment.depth)
    return Scene(file, text, line_types, points, lines, environment, options=options, warnings=tuple(warnings))


def _read_text(file: str) -> str:
    try:
        if not os.path.exists(file):
            raise SceneError(file, 0, f"there is no such file, {_EXPECTED}")
        if not os.path.isfile(file):  # reading a pipe or a device could last for ever
            raise SceneError(file, 0, f"is {'a directory' if os.path.isdir(file) else 'no regular file'}, {_EXPECTED}")
        if os.path.getsize(file) > _LARGEST_FILE:
            raise SceneError(file, 0, f"is larger than {_LARGEST_FILE // 2**20} MiB, {_EXPECTED}")
        content = Path(file).read_bytes()
    except OSError as error:
        raise SceneError(file, 0, f"cannot be read ({error.strerror}), {_EXPECTED}") from None
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise SceneError(file, line, f"byte 0x{content[error.start]:02X} is not UTF-8 text, {_EXPECTED} saved as UTF-8") from None


def _environment(options: dict[str, object]) -> Environment:
    """Takes out of ``options`` what the environment holds."""
    fields = {"WtrDpth": "depth", "g": "gravity", "rho": "water_density", "kBot": "bed_stiffness", "cBot": "bed_damping"}
    given = {field: options.pop(name) for name, field in fields.items() if name in options}
    current = tuple(options.pop(f"Current{axis}", 0.0) for axis in "XYZ")
    return Environment(current=current, **given)
