"""Motion from a CSV file: `t,x,y,z,roll,pitch,yaw` (s, m, degrees) or `t,x,y,z,qx,qy,qz,qw[,vx,vy,vz,wx,wy,wz]`.

Of several platforms each has these columns with its name before them, `t,body1.x,body1.y,…,body2.x,…`.
"""

import math

import numpy as np

from mooring_ros.motion.frames import Adapter
from mooring_ros.motion.gate import UNIT_TOLERANCE
from mooring_ros.motion.velocity import twist_from_poses

from .angles import quaternion_from_degrees
from .motion_file import Motion
from .number_table import read_table
from .twist_check import twist_is_missing

POSITION = ["t", "x", "y", "z"]
ANGLES = ["roll", "pitch", "yaw"]
QUATERNION = ["qx", "qy", "qz", "qw"]
TWIST = ["vx", "vy", "vz", "wx", "wy", "wz"]
FORMS = (POSITION + ANGLES, POSITION + QUATERNION, POSITION + QUATERNION + TWIST)
_WORLD = Adapter(twist_frame="world")
EXPECTED = "t,x,y,z,roll,pitch,yaw (s, m, degrees) or t,x,y,z,qx,qy,qz,qw[,vx,vy,vz,wx,wy,wz]"


def load_csv(path):
    """The Motion in a CSV file; columns may stand in any order, twists are in world axes. Platforms with names are in the order of the header.

    Roll, pitch and yaw are about the fixed axes: R = Rz Ry Rx. Without a twist it is differentiated from the poses. A quaternion whose
    length is off by less than 1e-3 is normalised. Times are kept as they are; stamps are times in ns, counted from the first where that is negative.
    A twist that clearly does not move the pose is refused. Raises ValueError with FILE:LINE, OSError.
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
    stamps = np.rint((times - min(times[0], 0.0)) * 1e9).astype(np.int64)
    names, remarks = _platforms(table.names), []
    if not names:
        poses, twists, source = _motion(path, table, column, stamps, remarks)
        return Motion(str(path), times, poses, twists, stamps, source, remarks=tuple(remarks))
    each = [_motion(path, table, {"t": times} | {one.removeprefix(f"{name}."): own for one, own in column.items() if one.startswith(f"{name}.")}, stamps, remarks)
            for name in names]
    poses, twists, sources = zip(*each)
    return Motion(str(path), times, np.stack(poses, axis=1), np.stack(twists, axis=1), stamps, "; ".join(dict.fromkeys(sources)), platforms=names,
                  remarks=tuple(remarks))


def _motion(path, table, column, stamps, remarks):
    """(poses (n, 7), twists (n, 6), source in words) of one platform's columns, dict of name -> values (n,)."""
    times = column["t"]
    poses = np.empty((len(times), 7))
    poses[:, :3] = np.column_stack([column[name] for name in POSITION[1:]])
    if "roll" in column:
        poses[:, 3:] = [quaternion_from_degrees(*angles) for angles in zip(*(column[name] for name in ANGLES))]
    else:
        poses[:, 3:] = np.column_stack([column[name] for name in QUATERNION])
        _normalise(path, poses, table.lines)
    if "vx" in column:
        twists = np.column_stack([column[name] for name in TWIST])
        place, axes = f"{path}:{table.header_line}", ["world"] * len(times)
        if not twist_is_missing(place, "columns vx to wz", _WORLD, stamps, poses, twists.tolist(), axes, remarks):
            return poses, twists, "pose and twist"
    return poses, twist_from_poses(times, poses), "pose; twist differentiated from it"


def _platforms(names):
    """Names of the platforms that columns with these names are of; none where no column has one."""
    return tuple(dict.fromkeys(name.rpartition(".")[0] for name in names if "." in name))


def _check_form(place, names):
    platforms = _platforms(names)
    for own in platforms or ("",):
        before = f"{own}." if own else ""
        mine = [name for name in names if name.startswith(before) or name == "t"] if own else names
        bare = [name.removeprefix(before) for name in mine]
        if not any(sorted(bare) == sorted(form) for form in FORMS):
            unknown = [name for name, short in zip(mine, bare) if short not in POSITION + ANGLES + QUATERNION + TWIST]
            what = f"unknown column {unknown[0]!r}" if unknown else f"columns {','.join(mine)}"
            raise ValueError(f"{place}: {what}, expected {EXPECTED}{f', those of {own} with {before} before them' if own else ''}")
    strange = [name for name in names if platforms and "." not in name and name != "t"]
    if strange:
        raise ValueError(f"{place}: column {strange[0]!r} beside those of {', '.join(platforms)}, expected each but t to have a platform's name, as {platforms[0]}.x")


def _normalise(path, poses, lines):
    for row, line in enumerate(lines):
        length = math.hypot(*poses[row, 3:])
        if abs(length - 1.0) > UNIT_TOLERANCE:
            raise ValueError(f"{path}:{line}: quaternion of length {length:.6g}, expected 1 (within {UNIT_TOLERANCE:g})")
        if length != 1.0:
            poses[row, 3:] /= length
