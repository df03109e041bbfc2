"""What a trade has measured, kept on disk: a trade that was stopped goes on where it was, and one that is asked again answers at once."""

import hashlib
import json
import os
import platform
from dataclasses import asdict, replace
from pathlib import Path

import numba
import numpy as np

import mooring_ros

from .trade_measure import Measured

ARRAYS = ("tension", "force")
MEASURING = ("trade_measure.py", "trade_window.py")


class Cache:
    """Runs of one scene, motion, version and machine. `fresh`: nothing is read."""

    def __init__(self, scene, motion, fresh=False):
        self.folder = _root() / "trade" / _digest(_scene_bytes(scene), *_motion_bytes(motion), _version(), machine_text().encode())
        self.folder.mkdir(parents=True, exist_ok=True)
        self._fresh = fresh
        self.read = 0  # runs that were there already

    def recall(self, name, again=False):
        """The Measured of an earlier run by its `name`, None when there is none; again: of a run of this trade."""
        path = self.folder / f"{name}.npz"
        if (self._fresh and not again) or not path.is_file():
            return None
        try:
            with np.load(path, allow_pickle=False) as stored:
                fields = json.loads(str(stored["fields"]))
                measured = Measured(**{name: stored[name] for name in ARRAYS}, **fields)
        except (OSError, ValueError, KeyError, TypeError):  # cut off, or of another version
            return None
        self.read += not again
        return measured

    def keep(self, name, measured):
        """Write a run, in one move."""
        path = self.folder / f"{name}.npz"
        fields = {name: value for name, value in asdict(measured).items() if name not in ARRAYS}
        part = path.with_suffix(f".{os.getpid()}.part")
        with open(part, "wb") as file:
            np.savez(file, fields=json.dumps(fields), **{name: getattr(measured, name) for name in ARRAYS})
        os.replace(part, path)

    @staticmethod
    def name(setting, window, timed):
        """What a run is kept under."""
        return _digest(json.dumps(asdict(setting)).encode(), window.times.tobytes(), window.poses.tobytes(), window.twists.tobytes(), bytes([timed]))


def machine_text():
    """Processor and cores, in words."""
    name = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            name = next((line.partition(":")[2].strip() for line in file if line.startswith("model name")), name)
    except OSError:
        pass
    return f"{name}, {os.cpu_count()} cores"


def _root():
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "mooring_ros"


def _digest(*parts):
    digest = hashlib.sha256()
    for part in parts:
        digest.update(len(part).to_bytes(8, "little"))
        digest.update(part)
    return digest.hexdigest()[:24]


def _scene_bytes(scene):
    """Of what was read, and of what it is now: a Scene may have been changed since."""
    return json.dumps([scene.text, *([name, text] for name, text in scene.files), repr(replace(scene, path="", text="", files=()))]).encode()


def _motion_bytes(motion):
    return [repr(motion.platforms).encode(), *(np.ascontiguousarray(values).tobytes() for values in (motion.times, motion.poses, motion.twists))]


def _version():
    """A digest of all sources whose change could change a force or a time."""
    package = Path(mooring_ros.__file__).parent
    sources = [*package.glob("*.py"), *package.glob("core/*.py"), *package.glob("scene/*.py"), *(Path(__file__).parent / name for name in MEASURING)]
    return _digest(numba.__version__.encode(), np.__version__.encode(), *(path.read_bytes() for path in sorted(sources))).encode()
