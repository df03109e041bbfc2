"""What the operating system gives a node that must be on time: SCHED_FIFO and locked memory, asked for and reported. Linux."""
import contextlib
import ctypes
import os
import resource
from typing import NamedTuple

_CURRENT, _FUTURE = 1, 2    # of mlockall
_CAP_IPC_LOCK = 14


class Granted(NamedTuple):
    """In words, for log and diagnostics; problems: what was asked for and not granted."""

    scheduling: str
    memory: str
    problems: tuple


def ask(priority, lock_memory):
    """Ask for SCHED_FIFO at this priority (0: not) and for locked memory; returns what was granted.

    The calling thread gets the priority, and all others of the process, those of the middleware and the recorder, get one less: a thread that
    holds the interpreter, or a lock of the middleware, and waits behind somebody's load would hold up the one that must be on time. Threads that are
    started later inherit it from theirs: the middleware starts some when it meets another process. So would processes: start those before.
    """
    problems = []
    scheduling, memory = "normal", "not locked"
    if priority:
        try:
            _schedule(os.SCHED_FIFO, priority, max(priority - 1, 1))
            scheduling = f"SCHED_FIFO {priority}"
        except OSError as error:
            give_back()
            problems.append(f"SCHED_FIFO {priority} was not granted: {error.strerror} (a limit rtprio of {priority} or CAP_SYS_NICE would do)")
    if lock_memory:
        everything = _may_lock_all()
        if _libc().mlockall(_CURRENT | _FUTURE if everything else _CURRENT) == 0:
            memory = "locked" if everything else "locked as it stands"
        else:
            problems.append(f"memory was not locked: {os.strerror(ctypes.get_errno())} (a limit memlock without bound or CAP_IPC_LOCK would do)")
    return Granted(scheduling, memory, tuple(problems))


def give_back():
    """Back to what an ordinary process has."""
    with contextlib.suppress(OSError):
        _schedule(os.SCHED_OTHER, 0, 0)
    _libc().munlockall()


def _schedule(policy, own, others):
    me = _libc().gettid()
    os.sched_setscheduler(me, policy, os.sched_param(own))
    for name in os.listdir("/proc/self/task"):
        if int(name) != me:
            with contextlib.suppress(ProcessLookupError):     # it ended just now
                os.sched_setscheduler(int(name), policy, os.sched_param(others))


def _may_lock_all():
    """Whether memory that is asked for later may be locked, too: with a bound on it, allocations would fail there."""
    if resource.getrlimit(resource.RLIMIT_MEMLOCK)[0] == resource.RLIM_INFINITY:
        return True
    with open("/proc/self/status", encoding="ascii") as file:
        effective = next((line for line in file if line.startswith("CapEff:")), "CapEff: 0")
    return bool(int(effective.split()[1], 16) >> _CAP_IPC_LOCK & 1)


def _libc():
    return ctypes.CDLL(None, use_errno=True)
