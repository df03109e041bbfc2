"""Motion from a CSV file: `t,x,y,z,roll,pitch,yaw` (s, m, degrees) or `t,x,y,z,qx,qy,qz,qw[,vx,vy,vz,wx,wy,wz]`."""

import math

import numpy as np

from mooring_ros.motion.gate import UNIT_TOLERANCE
from mooring_ros.motion.velocity import twist_from_poses

from .angles import quaternion_from_degrees
from .motion_file import Motion
from .number_table import read_table

POSITION = ["t", "x", "y", "z"]
ANGLES = ["roll", "pitch", "yaw"]
QUATERNION = ["qx", "qy", "qz", "qw"]
TWIST = ["vx", "vy", "vz", "wx", "wy", "wz"]
FORMS = (POSITION + ANGLES, POSITION + QUATERNION, POSITION + QUATERNION + TWIST)
EXPECTED = "t,x,y,z,roll,pitch,yaw (s, m, degrees) or t,x,y,z,qx,qy,qz,qw[,vx,vy,vz,wx,wy,wz]"


def load_csv(path):
    """The Motion in a CSV file; columns may stand in any order.

    Roll, pitch and yaw are about the fixed axes: R = Rz Ry Rx. Without a twist it is differentiated from the poses. A quaternion whose
    length is off by less than 1e-3 is normalised. Times are kept as they are; stamps are times in ns, counted from the first where that is negative.
    Raises ValueError with FILE:LINE, OSError.
    """
    table = read_table(path, EXPECTED, check_header=_check_form)
    if len(table.lines) < 2:
        raise ValueError(f"{path}:{table.lines[-1] if table.lines else table.header_line}: "
                         f"{len(table.lines)} samples, expected at least 2")
    column = {name: table.values[:, index] for index, name in enumerate(table.names)}
    times = column["t"]
    late = np.flatnonzero(np.diff(times) <= 0.0)
    if late.size:
        row = int(late[0]) + 1
        raise ValueError(f"{path}:{table.lines[row]}: time {times[row]:.9g} s after {times[row - 1]:.9g} s, expected it to increase")
    poses = np.empty((len(times), 7))
    poses[:, :3] = np.column_stack([column[name] for name in POSITION[1:]])
    if "roll" in column:
        poses[:, 3:] = [quaternion_from_degrees(*angles) for angles in zip(*(column[name] for name in ANGLES))]
    else:
        poses[:, 3:] = np.column_stack([column[name] for name in QUATERNION])
        _normalise(path, poses, table.lines)
    if "vx" in column:
        twists, source = np.column_stack([column[name] for name in TWIST]), "pose and twist"
    else:
        twists, source = twist_from_poses(times, poses), "pose; twist differentiated from it"
    stamps = np.rint((times - min(times[0], 0.0)) * 1e9).astype(np.int64)
    return Motion(str(path), times, poses, twists, stamps, source)


def _check_form(place, names):
    if not any(sorted(names) == sorted(form) for form in FORMS):
        unknown = [name for name in names if name not in POSITION + ANGLES + QUATERNION + TWIST]
        what = f"unknown column {unknown[0]!r}" if unknown else f"columns {','.join(names)}"
        raise ValueError(f"{place}: {what}, expected {EXPECTED}")


def _normalise(path, poses, lines):
    for row, line in enumerate(lines):
        length = math.hypot(*poses[row, 3:])
        if abs(length - 1.0) > UNIT_TOLERANCE:
            raise ValueError(f"{path}:{line}: quaternion of length {length:.6g}, expected 1 (within {UNIT_TOLERANCE:g})")
        if length != 1.0:
            poses[row, 3:] /= length
