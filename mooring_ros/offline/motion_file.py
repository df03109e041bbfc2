"""A platform's motion from a file: CSV, MCAP with Odometry or PoseStamped and TwistStamped, or a recording of the node itself."""

import os
from dataclasses import dataclass, field, replace

import numpy as np

from mooring_ros.recording.attached import AttachedScene
from mooring_ros.recording.records import is_mcap


_GAP = 10.0  # usual steps


@dataclass(frozen=True)
class Motion:
    """A recorded motion, in the inside convention: world ENU, SI units, full scale.

    For a recording of the node, times, poses and twists are those of the settles and steps in the schedule, as they were passed to
    `Mooring`; times may repeat there, at a settle.
    """

    path: str
    times: np.ndarray               # (n,) s; as in a CSV file; of MCAP see `motion_mcap`
    poses: np.ndarray               # (n, 7) m and unit quaternion x, y, z, w; (n, platforms, 7) of platforms with names
    twists: np.ndarray              # (n, 6) m/s and rad/s, world axes, or (n, platforms, 6)
    stamps: np.ndarray              # (n,) int ns, the stamps of the source
    source: str                     # in words: which topic or which columns
    schedule: list | None = None    # of recording.schedule.Action, for a recording of the node
    schedule_stamps: list | None = None     # ns, of each action
    parameters: dict | None = None  # of the node, for a recording of it
    scene: AttachedScene | None = None  # in the recording
    remarks: tuple = field(default=())      # str, what a user should know about how the file was read
    platforms: tuple = ()           # names of the platforms that it is of; empty for one without a name

    @property
    def start_ns(self):
        """Stamp of the first sample, ns."""
        return int(self.stamps[0])


def load_motion(path, topic=None, platforms=()):
    """The Motion in a file or bag folder, with a remark where samples are missing.

    topic: which one to take of an MCAP file that has several (`POSE_TOPIC,TWIST_TOPIC` for a pair); it also makes a recording of
    the node be read by its input instead of its schedule. platforms: names of those that the motion is of; recordings of the node and columns of a CSV file
    say so themselves.
    Raises ValueError (FILE:LINE or FILE: what is wrong, what was expected) and OSError.
    """
    motion = _load(os.fspath(path), topic, platforms)
    if motion.schedule is not None:
        return motion
    return replace(motion, remarks=(*motion.remarks, *_gaps(motion.times)))


def _load(path, topic, platforms):
    if os.path.isdir(path) or path.endswith((".mcap", ".db3")) or is_mcap(path):
        from .motion_mcap import load_mcap

        return load_mcap(path, topic, tuple(platforms))
    if topic is not None:
        raise ValueError(f"{path}: a topic was named ({topic}), expected an MCAP file for that")
    from .motion_csv import load_csv

    motion = load_csv(path)
    if platforms and motion.platforms != tuple(platforms):
        raise ValueError(f"{path}: columns of {', '.join(motion.platforms) or 'one platform without a name'}, expected those of {', '.join(platforms)}, as {platforms[0]}.x")
    return motion


def _gaps(times):
    """A remark where samples are far apart: what is between them is not known."""
    steps = np.diff(times)
    usual, longest = float(np.median(steps)), int(np.argmax(steps))
    count = int(np.sum(steps > _GAP * usual))
    if not count:
        return ()
    return (f"{count} {'gap is' if count == 1 else 'gaps are'} longer than {_GAP:g} usual steps of {usual:.4g} s, the longest from {times[longest]:.9g} to "
            f"{times[longest + 1]:.9g} s: a cubic curve stands in for what is missing",)
