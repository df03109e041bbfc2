"""The process that estimates a running node's accuracy: windows of motion in, estimates out, over pipes, when nobody else wants the processor.

Messages both ways are a length (8 bytes, little endian) and a pickle: first a `Task`, then `Window`s, each answered by the dict of an `Accuracy`.
It ends when its input ends, whatever it is doing: with the node, however that ends.
"""

import os
import pickle
import queue
import signal
import struct
import sys
import threading
import time
from dataclasses import dataclass, field

import numpy as np

from .accuracy import estimate, motion_in

_LENGTH = struct.Struct("<Q")
# Stands back for everything else before anything is imported: that alone takes seconds.
PROGRAM = """
import os
for stand_back in (lambda: os.nice(19), lambda: os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))):
    try:
        stand_back()
    except (OSError, AttributeError):
        pass
from mooring_ros.accuracy_worker import main
main()
"""
MOST_CPU = 60.0  # s of CPU time of an estimate, about: 20 minutes at a share of 5 %
BURST = 1.0  # s of CPU time that may be spent at once, so that the first estimate comes soon


@dataclass(frozen=True)
class Task:
    """What is solved: a Scene, the arguments of its Mooring, and the share of one processor that may be taken."""

    scene: object
    settings: dict
    share: float


@dataclass(frozen=True)
class Window:
    """motion (k, 14 or more): see accuracy.motion_in; lengths (lines,) m unstretched; released: names of lines."""

    motion: np.ndarray = field(repr=False)
    lengths: np.ndarray
    released: tuple = ()


def packed(message):
    """The bytes of one message."""
    data = pickle.dumps(message)
    return _LENGTH.pack(len(data)) + data


def receive(read):
    """The next message, from read(count), which gives `count` bytes, or fewer where the stream ends; None at its end."""
    head = read(_LENGTH.size)
    if len(head) < _LENGTH.size:
        return None
    (length,) = _LENGTH.unpack(head)
    data = read(length)
    return pickle.loads(data) if len(data) == length else None  # between the node and the process that it has started, nobody else


class Throttle:
    """Sleeps so that no more than a share of one processor is taken over the long run."""

    def __init__(self, share, sleep=time.sleep, clock=time.monotonic):
        self._share, self._sleep, self._clock = share, sleep, clock
        self._credit, self._at = BURST, clock()

    def __call__(self, cpu):
        """Account for s of CPU time spent."""
        now = self._clock()
        self._credit = min(self._credit + self._share * (now - self._at), BURST) - cpu
        self._at = now
        if self._credit < 0.0:
            self._sleep(-self._credit / self._share)


def main():
    """Serve until the input ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # of a terminal it goes to the node, too, which ends this process by closing the pipe
    messages = queue.SimpleQueue()

    def listen():
        while (message := receive(sys.stdin.buffer.read)) is not None:
            messages.put(message)
        os._exit(0)  # at once, also in the middle of a computation

    threading.Thread(target=listen, daemon=True).start()
    task = messages.get()
    warm, throttle = False, None
    while True:
        window = messages.get()
        times, poses, twists = motion_in(window.motion, task.settings.get("platforms"))
        motion = times, poses, twists, window.lengths, window.released
        try:
            if not warm:
                estimate(task.scene, task.settings, *_beginning(times, poses, twists))  # what is not compiled yet does not count
                warm, throttle = True, Throttle(task.share)
            found = estimate(task.scene, task.settings, *motion, pause=throttle, most_cpu=MOST_CPU).as_dict()
        except Exception as error:  # noqa: BLE001  (whatever it is, the node says it and goes on)
            found = {"why": f"{type(error).__name__}: {error}"}
        try:
            sys.stdout.buffer.write(packed(found))
            sys.stdout.buffer.flush()
        except OSError:
            return


def _beginning(times, poses, twists, samples=32):
    return times[:samples], poses[:samples], twists[:samples]

