"""Rows of a scene file: words with their line number, and numbers read strictly."""

import re
from dataclasses import dataclass

from .errors import SceneError

# A comment begins a word: "(#)" in a row of units is none.
_COMMENT = re.compile(r"(?:^|(?<=\s))(?:[#!%]|//).*")
# Fortran's exponent letter d is MoorDyn-F's; anything else float() would take (nan, inf, 1_000, hex) is refused.
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?", re.ASCII)
_INTEGER = re.compile(r"[+]?\d{1,9}", re.ASCII)

# Far outside of anything moored, near enough that no product of a few such numbers leaves the range of a float.
LARGEST = 1e18
SMALLEST = 1e-18


def parse_number(word: str) -> float | None:
    """The float that a word stands for, or None."""
    if not _NUMBER.fullmatch(word):
        return None
    return float(word.translate({ord("d"): "e", ord("D"): "e"}))


def parse_count(word: str) -> int | None:
    """The whole number >= 0 that a word stands for, or None."""
    return int(word) if _INTEGER.fullmatch(word) else None


@dataclass(frozen=True)
class Row:
    """The words of one line of a file, comments removed."""

    file: str
    line: int
    words: tuple[str, ...]

    def error(self, message: str) -> SceneError:
        return SceneError(self.file, self.line, message)

    def number(self, index: int, what: str, unit: str = "", *, above: float | None = None, at_least: float | None = None) -> float:
        """The number in column ``index``; SceneError when it is none, is out of range, or is not ``above``/``at_least`` its bound."""
        word = self.words[index]
        bound = f" > {above:g}" if above is not None else f" >= {at_least:g}" if at_least is not None else ""
        expected = f"expected a number{bound}{f' ({unit})' if unit else ''}"
        value = parse_number(word)
        if value is None:
            raise self.error(f"{what} is '{word}', {expected}")
        if value != 0.0 and not SMALLEST <= abs(value) <= LARGEST:
            raise self.error(f"{what} is {word}, {expected} with a magnitude between {SMALLEST:g} and {LARGEST:g}")
        if (above is not None and value <= above) or (at_least is not None and value < at_least):
            raise self.error(f"{what} is {word}, {expected}")
        return value + 0.0  # -0.0 becomes 0.0

    def count(self, index: int, what: str, largest: int) -> int:
        """The whole number from 1 to ``largest`` in column ``index``."""
        value = parse_count(self.words[index])
        if value is None or not 1 <= value <= largest:
            raise self.error(f"{what} is '{self.words[index]}', expected a whole number from 1 to {largest}")
        return value

    def parts(self, index: int) -> "Row":
        """The parts of a word that are separated by bars, as a row of their own."""
        return Row(self.file, self.line, tuple(self.words[index].split("|")))

    def numbers(self, index: int, what: str, counts: tuple[int, ...], unit: str = "", *, at_least: float | None = None) -> tuple[float, ...]:
        """The numbers separated by bars in column ``index``; SceneError when there are not as many as one of ``counts``."""
        parts = self.parts(index)
        if len(parts.words) not in counts:
            *most, last = map(str, counts)
            raise self.error(f"{what} is '{self.words[index]}', expected {', '.join(most)} or {last} numbers separated by |")
        return tuple(parts.number(part, what, unit, at_least=at_least) for part in range(len(parts.words)))


def read_rows(text: str, file: str) -> list[Row]:
    """All rows that hold words, in the order of the file. Lines end as in text editors: LF, CRLF or CR."""
    rows = []
    for line, content in enumerate(re.split(r"\r\n|\r|\n", text.removeprefix("\ufeff")), start=1):
        words = tuple(_COMMENT.sub("", content).split())
        if words:
            rows.append(Row(file, line, words))
    return rows
