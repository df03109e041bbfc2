"""What the commands say, and where: results on standard output, everything else on standard error."""

import contextlib
import json
import sys
import time


class UsageError(Exception):
    """Bad usage or bad input: one line that says what is wrong, where, and what was expected. Exit status 2."""


class ComputationFailed(Exception):
    """The computation could not be completed; the text says where and when. Exit status 1."""


@contextlib.contextmanager
def reading(path=None):
    """Turn what goes wrong while input is read (ValueError, OSError) into a UsageError; path names the input in OSErrors."""
    try:
        yield
    except OSError as error:
        raise UsageError(f"{error.filename or path}: {error.strerror or error}") from error
    except ValueError as error:
        raise UsageError(str(error)) from error


def complain(message):
    """One line on standard error."""
    print(message, file=sys.stderr, flush=True)


def print_json(value):
    """One strict JSON object on standard output (no NaN, no infinity)."""
    print(json.dumps(value, allow_nan=False, ensure_ascii=False))


def table(headers, rows):
    """Text of a table: the first column on the left, numbers aligned on the right, two spaces between."""
    cells = [[str(cell) for cell in row] for row in [headers, *rows]]
    widths = [max(len(row[column]) for row in cells) for column in range(len(headers))]
    lines = []
    for row in cells:
        aligned = [cell.ljust(width) if index == 0 else cell.rjust(width) for index, (cell, width) in enumerate(zip(row, widths))]
        lines.append("  ".join(aligned).rstrip())
    return "\n".join(lines)


class Preparing:
    """A line on standard error while work of unknown length goes on; silent when that is no terminal."""

    def __init__(self, what, stream=None):
        self._stream = sys.stderr if stream is None else stream
        self._what = what

    def __enter__(self):
        self._write(f"{self._what}: preparing (a new core is compiled first: a minute or more)")

    def __exit__(self, *_):
        self._write("\r\x1b[K")

    def _write(self, text):
        if self._stream.isatty():
            self._stream.write(text)
            self._stream.flush()


class Progress:
    """A line on standard error that says how far the work has come; silent when that is no terminal."""

    def __init__(self, what, total, stream=None):
        """what: the work, in a word; total: seconds of simulated time."""
        self._stream = sys.stderr if stream is None else stream
        self._shown = self._stream.isatty()
        self._what, self._total = what, total
        self._started = time.monotonic()
        self._next = self._started + 0.2

    def __enter__(self):
        if self._shown:
            self._stream.write(f"{self._what}: preparing")
            self._stream.flush()
        return self

    def update(self, done):
        """done: seconds of simulated time so far."""
        now = time.monotonic()
        if not self._shown or now < self._next:
            return
        self._next = now + 0.2
        share = 100.0 * done / self._total if self._total > 0 else 100.0
        speed = done / (now - self._started)
        self._stream.write(f"\r\x1b[K{self._what}: {done:.1f} of {self._total:.1f} s, {share:.0f} %, {speed:.0f} times real time")
        self._stream.flush()

    def __exit__(self, *_):
        if self._shown:
            self._stream.write("\r\x1b[K")
            self._stream.flush()
