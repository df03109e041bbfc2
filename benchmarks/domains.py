"""ROS domains of which no two processes on this machine have the same one: a node that hears somebody else's platform answers that, too."""

import fcntl
import itertools
import os
import tempfile
from pathlib import Path

FIRST, COUNT = 102, 130  # ROS_DOMAIN_ID: those below are for people and for the demo, 232 is the last one that there can be
MOST = 12  # of one process, taken in turns: a node that has just ended is not heard by the next one

_held = []  # (domain, file that is locked as long as the process lives)
_turns = itertools.count()


def free_domain():
    """A domain that no other process has got from here. RuntimeError when all are taken."""
    if len(_held) < MOST:
        for k in range(COUNT):
            domain = FIRST + (7 * os.getpid() + k) % COUNT
            file = _locked(Path(tempfile.gettempdir()) / f"mooring_ros_domain_{domain}")
            if file is not None:
                _held.append((domain, file))
                return domain
    if not _held:
        raise RuntimeError(f"ROS domains {FIRST} to {FIRST + COUNT - 1} are all taken by other processes; expected one that is free")
    return _held[next(_turns) % len(_held)][0]


def _locked(path):
    """The file, locked for this process; None where another one has it."""
    try:
        file = open(path, "w")  # noqa: SIM115  (open for as long as the process lives)
    except OSError:
        return None
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        file.close()
        return None
    return file
