"""A recorded motion as one stretch of time, which a trade can run again and again."""

from dataclasses import replace

import numpy as np

from mooring_ros.recording import schedule

FEWEST = 20  # samples


def one_stretch(motion):
    """The longest part of a motion_file.Motion in which time goes forward: a recording of the node starts anew at every settle.

    Raises ValueError when it is too short to tell anything from.
    """
    breaks = np.flatnonzero(np.diff(motion.times) <= 0.0) + 1
    parts = [slice(first, last) for first, last in zip((0, *breaks), (*breaks, len(motion.times)))]
    part = max(parts, key=lambda rows: motion.times[rows.stop - 1] - motion.times[rows.start])
    remarks = motion.remarks
    if len(parts) > 1:
        remarks += (f"{motion.path}: settled {len(parts)} times; the trade is of the longest stretch, from {motion.times[part.start]:.6g} s",)
    if any(action.kind not in schedule.MOVES for action in motion.schedule or ()):
        remarks += (f"{motion.path}: lines were let go or wound in the recording; the trade is of the scene as it is written",)
    if part.stop - part.start < FEWEST:
        raise ValueError(f"{motion.path}: {part.stop - part.start} samples, expected at least {FEWEST} for a trade")
    return replace(motion, times=motion.times[part], poses=motion.poses[part], twists=motion.twists[part], stamps=motion.stamps[part],
                   schedule=None, schedule_stamps=None, remarks=remarks)
