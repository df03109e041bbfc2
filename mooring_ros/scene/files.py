"""Files that a scene is read from: regular files of bounded size, UTF-8 text."""

import os
from collections.abc import Iterable
from pathlib import Path

from .errors import SceneError
from .rows import Row, parse_number, read_rows

LARGEST_FILE = 16 * 1024 * 1024  # bytes
HEADING_LINES = 3  # of a table in a file of its own, as in MoorDyn
_QUOTES = "\"'"


def read_text(file: str, expected: str) -> str:
    """The content of a text file. SceneError when it cannot be read; ``expected`` ends its message."""
    try:
        if not os.path.exists(file):
            raise SceneError(file, 0, f"there is no such file, {expected}")
        if not os.path.isfile(file):  # reading a pipe or a device could last for ever
            raise SceneError(file, 0, f"is {'a directory' if os.path.isdir(file) else 'no regular file'}, {expected}")
        if os.path.getsize(file) > LARGEST_FILE:
            raise SceneError(file, 0, f"is larger than {LARGEST_FILE // 2**20} MiB, {expected}")
        content = Path(file).read_bytes()
    except OSError as error:
        raise SceneError(file, 0, f"cannot be read ({error.strerror}), {expected}") from None
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise SceneError(file, line, f"byte 0x{content[error.start]:02X} is not UTF-8 text, {expected} saved as UTF-8") from None
    refuse_binary(text, file, expected)
    return text


def refuse_binary(text: str, file: str, expected: str) -> None:
    if "\0" in text:
        raise SceneError(file, text.count("\n", 0, text.index("\0")) + 1, f"not a text file, {expected}")


def unquoted(word: str) -> str:
    return word.strip(_QUOTES)


def _below(path: str, folder: str) -> bool:
    return os.path.commonpath((os.path.realpath(path), folder)) == folder


class Files:
    """The files that a scene names, from beside the scene or from ``given`` content; keeps what was read."""

    def __init__(self, scene: str, given: Iterable[tuple[str, str]] | None = None, folders: Iterable[str] | None = None):
        self._folder = os.path.dirname(scene)
        self._given = None if given is None else dict(given)
        self._folders = None if folders is None else tuple(folders)
        self._read: dict[str, str] = {}
        self.warnings: list[str] = []

    @property
    def contents(self) -> tuple[tuple[str, str], ...]:
        """(name as written in the scene, content) in the order in which they were read."""
        return tuple(self._read.items())

    def rows(self, asked: Row, name: str, what: str) -> list[Row]:
        """The rows of the file that the row ``asked`` of the scene names. Commas separate words as spaces do."""
        name = unquoted(name)
        path = self._path(name)
        if name not in self._read:
            self._read[name] = self._text(asked, name, path, what)
        rows = read_rows(self._read[name].replace(",", " "), path)
        if not rows:
            raise SceneError(path, 0, f"the file is empty, expected {what}")
        return rows

    def table(self, asked: Row, name: str, what: str, columns: tuple[tuple[str, str], ...], skipped: int = 0) -> list[Row]:
        """Rows of as many words as there are ``columns`` (name, unit), below up to three lines of headings.

        A warning when numbers stand in the first lines that are ``skipped`` by MoorDyn.
        """
        rows = self.rows(asked, name, what)
        while rows and rows[0].line <= HEADING_LINES and parse_number(rows[0].words[0]) is None:
            rows = rows[1:]
        names = " ".join(f"{column} ({unit})" for column, unit in columns)
        if rows and rows[0].line <= skipped:
            self.warnings.append(f"{rows[0].file}:{rows[0].line}: numbers in the first {skipped} lines are read here, MoorDyn would skip them")
        for row in rows:
            if len(row.words) != len(columns):
                raise row.error(f"{len(row.words)} columns, expected {len(columns)}: {names}")
        if len(rows) < 2:
            raise SceneError(self._path(unquoted(name)), 0, f"{len(rows)} rows of numbers, expected two at least: {names}")
        return rows

    def _path(self, name: str) -> str:
        return os.path.join(self._folder, name.replace("\\", "/"))  # decks come from Windows, too

    def _text(self, asked: Row, name: str, path: str, what: str) -> str:
        if self._given is not None:
            if name not in self._given:
                raise asked.error(f"the file '{name}' is not among the recorded files, expected {what}")
            refuse_binary(self._given[name], path, f"expected {what}")
            return self._given[name]
        if self._folders is not None and not any(_below(path, folder) for folder in self._folders):
            raise asked.error(f"the file '{name}' lies outside of {', '.join(self._folders)}, expected it below")
        try:
            return read_text(path, f"expected {what}")
        except SceneError as error:
            if error.line:
                raise
            raise asked.error(f"the file '{name}': {error.message}") from None  # the scene's line says who asked for it
        except ValueError:  # a name that no file can have
            raise asked.error(f"'{name}' is no name of a file, expected {what}") from None
