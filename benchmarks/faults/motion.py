"""The platform's motion that every fault is put into, and its samples as messages."""
import math
from typing import NamedTuple

PERIOD = 14.5                   # s
SURGE, HEAVE, PITCH = 3.0, 1.5, 0.05   # m, m, rad


class State(NamedTuple):
    """pose (7,): m, unit quaternion (x, y, z, w); twist (6,): m/s, rad/s; world frame."""

    pose: tuple
    twist: tuple


def at(t):
    """The State at time t (s): surge, heave and pitch."""
    rate = 2.0 * math.pi / PERIOD
    s, c = math.sin(rate * t), math.cos(rate * t)
    half = 0.5 * PITCH * s
    return State((SURGE * s, 0.0, HEAVE * c, 0.0, math.sin(half), 0.0, math.cos(half)),
                 (SURGE * rate * c, 0.0, -HEAVE * rate * s, 0.0, PITCH * rate * c, 0.0))


def odometry(stamp, state, frame="world", child="platform"):
    """nav_msgs/Odometry as a dictionary. stamp: ns. The twist goes out in the platform's frame, which is pitched by a rotation about y."""
    x, y, z, w = state.pose[3:]
    sine, cosine = 2.0 * (w * y), w * w - y * y      # of the pitch
    vx, vy, vz, *turn = state.twist
    return {
        "header": header(stamp, frame), "child_frame_id": child,
        "pose": {"pose": {"position": dict(zip("xyz", state.pose)), "orientation": {"x": x, "y": y, "z": z, "w": w}}},
        "twist": {"twist": {"linear": {"x": cosine * vx - sine * vz, "y": vy, "z": sine * vx + cosine * vz}, "angular": dict(zip("xyz", turn))}},
    }


def header(stamp, frame):
    """std_msgs/Header as a dictionary."""
    seconds, nanoseconds = divmod(stamp, 1_000_000_000)
    return {"stamp": {"sec": seconds, "nanosec": nanoseconds}, "frame_id": frame}


def stamp_of(message):
    """ns of a message with a header."""
    return message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec
