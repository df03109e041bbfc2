"""The node's side of its accuracy estimate: it keeps the last window of motion, and a process of its own (accuracy_worker) works on it.

On the way of a sample it costs one row written to an array. Everything else happens between samples, or in a thread that waits for pipes.
"""
import contextlib
import os
import queue
import select
import subprocess
import sys
import threading

import numpy as np

from mooring_ros.accuracy_worker import PROGRAM, Task, Window, packed, receive
from mooring_ros.recording import schedule

LOOK = 0.1              # s, how often the thread looks whether it is to end
ROWS = 4000             # samples kept of a window, at most; closer ones are thinned out
_COLUMNS = slice(1, None)  # of a schedule record: time, and pose and twist of each platform


class Companion:
    """Estimates the accuracy of a running mooring.

    mooring: as it runs; settings: arguments of its Mooring but the scene; share: of one processor; window: s of motion.
    latest: dict of the last estimate (see accuracy.Accuracy), None before the first; at: when it came, s of the clock that `poll` was given;
    ended: why there will be no other, or "".
    """

    def __init__(self, mooring, settings, share, window):
        self._mooring, self._settings, self._window = mooring, settings, window
        self._rows = np.empty((2 * ROWS, schedule.size(mooring.platforms) - 1))
        self._count, self._released, self._done_until = 0, [], None
        self.latest = self.at = None
        self.ended = ""
        self.busy = False
        self._closing = threading.Event()
        self._requests, self._answers = queue.SimpleQueue(), queue.SimpleQueue()
        self._process = subprocess.Popen(
            [sys.executable, "-c", PROGRAM], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"})
        self._requests.put(Task(mooring.scene, settings, share))
        self._thread = threading.Thread(target=self._serve, daemon=True, name="accuracy")
        self._thread.start()

    def note(self, actions):
        """What was done to the core: (stamp, schedule record) each, as `Session.actions` gives it."""
        for _, record in actions:
            if record[0] == schedule.STEP:
                if record[1] - self._rows[self._count - 1, 0] >= self._window / ROWS:
                    self._add(record)
            elif record[0] == schedule.SETTLE:
                self._count, self._done_until = 0, None
                self._add(record)
            elif record[0] == schedule.RELEASE:
                self._released.append(self._mooring.line_names[int(record[2])])

    def _add(self, record):
        if self._count == len(self._rows):
            self._rows[:ROWS] = self._rows[ROWS:]
            self._count = ROWS
        self._rows[self._count] = record[_COLUMNS]
        self._count += 1

    def poll(self, now):
        """Take up an estimate that is there, and ask for the next one when there is a new window. now: s of a steady clock. Called once a second."""
        if not self.ended and self._process.poll() is not None:
            self.ended = f"its process ended with status {self._process.returncode}"
        while not self._answers.empty():
            found = self._answers.get()
            self.busy = False
            if found is None:
                self.ended = self.ended or f"its process ended with status {self._process.returncode}"
            else:
                self.latest, self.at = found, now
        if self.busy or self.ended or not self._count:
            return
        times = self._rows[:self._count, 0]
        first = int(np.searchsorted(times, times[-1] - self._window, side="right")) - 1
        if first < 0 or self._done_until is not None and times[-1] < self._done_until + 0.5 * self._window:
            return
        self._done_until, self.busy = times[-1], True
        self._requests.put(Window(self._rows[first:self._count].copy(), self._mooring.unstretched_length, tuple(self._released)))

    @property
    def waits_for(self):
        """What is missing for the first estimate, in words."""
        if self.busy:
            return "the first estimate is being made"
        return f"no estimate yet: it takes {self._window:g} s of motion (core time)"

    def close(self):
        """End the process and the thread. The process may need a moment to be gone: it has the lowest priority."""
        self.ended = self.ended or "closed"
        self._process.kill()
        self._closing.set()
        self._requests.put(None)
        self._thread.join()

    def _serve(self):
        """The thread: requests into the one pipe, answers from the other; never blocked for longer than LOOK."""
        into, out = self._process.stdin.fileno(), self._process.stdout.fileno()
        os.set_blocking(into, False)
        try:
            self._write(into, packed(self._requests.get()))
            while (request := self._requests.get()) is not None and not self._closing.is_set():
                self._write(into, packed(request))
                answer = receive(lambda count: self._read(out, count))
                if answer is None:
                    break
                self._answers.put(answer)
        except OSError:
            pass        # the process is gone
        for stream in (self._process.stdin, self._process.stdout):
            with contextlib.suppress(OSError):
                stream.close()
        while self._process.poll() is None and not self._closing.wait(LOOK):
            pass
        self._answers.put(None)

    def _write(self, pipe, data):
        data = memoryview(data)
        while data and not self._closing.is_set():
            if select.select([], [pipe], [], LOOK)[1]:
                data = data[os.write(pipe, data):]

    def _read(self, pipe, count):
        """`count` bytes, fewer at the end or when closing."""
        data = b""
        while len(data) < count and not self._closing.is_set():
            if select.select([pipe], [], [], LOOK)[0]:
                part = os.read(pipe, count - len(data))
                if not part:
                    break
                data += part
        return data


def report(companion, pace, mooring, now):
    """(words, values) of the diagnostics: how accurate and how fast the mooring runs, and what limits it. companion: None when it is switched off."""
    limit, linear = mooring.step_limit, mooring.error_estimate
    values = {"real-time factor": _number(pace.real_time_factor)}
    if pace.uneven:
        values["answers with uneven steps"] = pace.uneven
    if pace.worst is not None:
        duration, at, evaluations, again = pace.worst
        values |= {"worst step (ms)": f"{1e-6 * duration:.3f}", "worst step at (s)": f"{at:.3f}", "worst step's evaluations": evaluations,
                   "worst step's parts taken again": again}
    dynamic = mooring.fidelity == "dynamic" or isinstance(mooring.fidelity, dict) and "dynamic" in mooring.fidelity.values()
    values |= {"solver": mooring.solver, "step (s)": f"{limit.dt:.4g}", "step limited by": limit.limited_by} if dynamic else {}
    if linear is not None:
        values["error of linearising now (%)"] = f"{100.0 * linear:.3g}"
    if companion is None:
        return "estimate switched off", values
    found = companion.latest
    if found is None:
        return companion.ended or companion.waits_for, values
    values["estimate's age (s)"] = f"{now - companion.at:.1f}"
    if found["why"]:
        return f"no estimate: {found['why']}", values
    values |= {"mean error (%)": _number(found["mean"]), "dynamic error (%)": _number(found["dynamic"]), "peak error (%)": _number(found["peak"]),
               "worst line": found["line"], "from (s)": f"{found['begin']:.3f}", "to (s)": f"{found['end']:.3f}", "compared": found["compared"],
               "orders observed": "" if found["orders"] is None else ", ".join(f"{order:.2f}" for order in found["orders"]),
               "estimate's CPU time (s)": f"{found['cpu']:.3g}"}
    words = f"tensions within {_number(found['mean'])} % in the mean, {_number(found['dynamic'])} % dynamic, {_number(found['peak'])} % at the peak"
    return words + (f"; {companion.ended}" if companion.ended else ""), values


def _number(value):
    return "" if value is None else f"{value:.3g}"
