"""How far the run has come: one line that is rewritten on a terminal, a few plain lines elsewhere."""

import sys
import time


class Progress:
    """total: s of simulated time. stream: where to write (standard error)."""

    def __init__(self, total, stream=None):
        self._stream = stream or sys.stderr
        self._terminal = self._stream.isatty()
        self._total = total
        self._started = None
        self._state, self._waiting_since, self._written = "", 0.0, False
        self._next = 0.25  # share of the run after which the next plain line is due
        self._last_shown = 0.0

    def state(self, text):
        """What is being waited for, in words, and on a terminal for how long; elsewhere it is said once. Call it again and again."""
        changed, self._state = text != self._state, text
        if changed:
            self._waiting_since = time.monotonic()
        if self._terminal:
            waited = time.monotonic() - self._waiting_since
            self._rewrite(f"{text} … {waited:.0f} s" if waited >= 1.0 else text)
        elif changed:
            print(text, file=self._stream, flush=True)

    def run(self, done):
        """done: s of simulated time."""
        now = time.monotonic()
        self._started = self._started or now
        share = done / self._total
        speed = done / (now - self._started) if now > self._started else 0.0
        text = f"{done:6.1f} of {self._total:g} s simulated, {100 * share:3.0f} %, {speed:.1f} times real time"
        if self._terminal and (now > self._last_shown + 0.1 or share >= 1.0):
            self._last_shown = now
            filled = round(30 * share)
            self._rewrite(f"[{'#' * filled}{'.' * (30 - filled)}] {text.strip()}")
        elif not self._terminal and share >= self._next:
            self._next = 0.25 * (int(4 * share) + 1)
            print(text, file=self._stream, flush=True)

    def close(self):
        """Leave the terminal's line."""
        if self._terminal and self._written:
            print(file=self._stream, flush=True)

    def _rewrite(self, text):
        self._written = True
        self._stream.write(f"\r\x1b[K{text}")
        self._stream.flush()
