"""Runs of the peers, kept outside the repository: they do not change while ours do.

A run is found again by everything that it depends on: the deck, the motion, the code's version and the machine.
"""

import hashlib
import json
import os
from importlib.metadata import version
from pathlib import Path

import numpy as np

from . import machine

FOLDER = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "mooring_ros" / "bench"


def kept(code, key, make):
    """What ``make()`` gives, a dictionary of arrays and numbers, from the cache where the same has run before.

    ``code``: the peer's package; ``key``: text of everything else that the run depends on.
    """
    facts = machine.describe()
    whole = "\n".join([code, version(code), facts["processor"], facts["cores"], key])
    file = FOLDER / f"{code}_{hashlib.sha256(whole.encode()).hexdigest()[:32]}.npz"
    if file.exists():
        with np.load(file) as found:
            return {name: found[name] for name in found.files}
    values = make()
    FOLDER.mkdir(parents=True, exist_ok=True)
    partial = file.with_suffix(f".{os.getpid()}.npz")
    np.savez_compressed(partial, **values)
    partial.replace(file)
    return values


def text_of(*parts):
    """A key of JSON, numbers to their last digit."""
    return json.dumps([repr(p) for p in parts])
