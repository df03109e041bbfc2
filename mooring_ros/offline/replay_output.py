"""What a replay writes: an MCAP recording like the node's, and a CSV table. Readable at any end, also an early one."""

import contextlib
import os
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from geometry_msgs.msg import Point, Quaternion, Vector3
from nav_msgs.msg import Odometry
from std_msgs.msg import Float64MultiArray

from mooring_ros.motion import rotation
from mooring_ros.node import messages
from mooring_ros.node.template import Template, placeholder, placeholder_stamp
from mooring_ros.recording import schedule
from mooring_ros.recording.attached import AttachedScene
from mooring_ros.recording.writer import RecordingWriter

from .console import ComputationFailed, reading

NODE = "/mooring"
ODOMETRY_TOPIC, ODOMETRY, ODOMETRY_OF = "/platform/odom", "nav_msgs/msg/Odometry", "/platforms/{}/odom"
WORLD_FRAME, PLATFORM_FRAME = "world", "platform"
_WAITING_MESSAGES = 20_000  # for the disk: more than these and the replay waits for it
WRENCH_COLUMNS = ("fx", "fy", "fz", "mx", "my", "mz")


@dataclass(frozen=True)
class Answer:
    """What the mooring answers to one sample, as it goes out: the source's axes and scale. L lines, k coupled points."""

    stamp: int  # ns
    time: float  # s
    wrench: np.ndarray  # (6,) N, N·m; (platforms, 6) of platforms with names
    coupled_wrenches: np.ndarray  # (k, 6) N, N·m
    fairlead_tension: np.ndarray  # (L,) N
    anchor_tension: np.ndarray  # (L,) N


class CsvOutput:
    """A table that appears under its name when it is closed; until then it is NAME.part. Numbers read back to the same bits.

    Wrenches are in columns wrench.fx to wrench.mz, or NAME.fx and so on of platforms with names.
    """

    def __init__(self, path, line_names, platforms=None):
        self._path, self._part = Path(path), Path(f"{path}.part")
        with reading(self._part):
            self._file = open(self._part, "w", encoding="ascii", newline="\n")
        ends = [f"{name}.{end}_tension" for name in line_names for end in ("fairlead", "anchor")]
        wrenches = [f"{name}.{column}" for name in platforms or ("wrench",) for column in WRENCH_COLUMNS]
        self._file.write(",".join(["time", *ends, *wrenches]) + "\n")

    def write(self, answer):
        """One row. Raises ComputationFailed when the disk refuses it."""
        tensions = np.column_stack((answer.fairlead_tension, answer.anchor_tension)).ravel()
        row = ",".join(map(repr, [float(answer.time), *tensions.tolist(), *answer.wrench.ravel().tolist()]))
        with self._disk():
            self._file.write(row + "\n")

    def close(self):
        """Close the file and give it its name; of a full disk, with whole rows only. Raises ComputationFailed."""
        try:
            with self._disk():
                self._file.close()
        except ComputationFailed:
            _cut_to_whole_rows(self._part)
            raise
        finally:
            os.replace(self._part, self._path)

    @contextlib.contextmanager
    def _disk(self):
        try:
            yield
        except OSError as error:
            raise ComputationFailed(f"{self._path}: cannot be written: {error.strerror or error}") from error


class McapOutput:
    """A recording with the node's topics, that itself replays bit for bit. It appears under its name when it is closed."""

    def __init__(self, path, parameters, scene, coupled_names, full_scale=None, platforms=None):
        """parameters: dict as the node's; scene: the Scene, kept in the recording; full_scale: a node.full_scale.FullScale, or None; platforms: names, or None."""
        self._path = Path(path)
        self._part = self._path.with_suffix(".part.mcap")
        with reading(path):
            self._part.unlink(missing_ok=True)
            self._writer = RecordingWriter(self._part, parameters, AttachedScene(os.path.basename(scene.path), scene.text, scene.files))
        self._wrench_topics = [*messages.total_topics(NODE, platforms), *(messages.fairlead_topic(NODE, name) for name in coupled_names)]
        motions = {ODOMETRY_OF.format(name): name for name in platforms} if platforms else {ODOMETRY_TOPIC: PLATFORM_FRAME}
        self._motions = [(topic, _MotionTemplate(WORLD_FRAME, frame)) for topic, frame in motions.items()]
        self._step = _step_template(schedule.size(platforms))
        self._full_scale = full_scale
        self._sent = 0

    def write(self, answer, sample, composed):
        """The answer to one sample. sample: Mooring (or like it) as it stands; composed: its node.messages.Messages."""
        stamp = answer.stamp
        wrenches = np.vstack((answer.wrench, answer.coupled_wrenches))
        for row, (topic, wrench) in enumerate(zip(self._wrench_topics, wrenches)):
            self._put(topic, messages.WRENCH, composed.wrench(stamp, wrench, row), stamp)
        self._put(f"{NODE}/lines", messages.JOINT_STATE, composed.lines(stamp, sample), stamp)
        self._put(f"{NODE}/line_tensions", messages.FLOAT_ARRAY, composed.line_tensions(sample), stamp)
        if self._full_scale is not None:
            for name, type_name, data in (*self._full_scale.wrenches(stamp, wrenches), *self._full_scale.lines(stamp, sample)):
                self._put(f"{NODE}/{name}", type_name, data, stamp)
        self._wait_for_the_disk()

    def write_step(self, stamp, record):
        """One record (15 floats) of the step schedule."""
        self._put(NODE + schedule.TOPIC_SUFFIX, schedule.TYPE_NAME, self._step.fill(0, record), stamp)

    def write_motion(self, stamp, pose, twist):
        """The motion as Odometry. pose (7,), twist (6,), or a row for each platform with a name, in world axes, SI units."""
        for (topic, template), own_pose, own_twist in zip(self._motions, pose.reshape(-1, 7), twist.reshape(-1, 6)):
            self._put(topic, ODOMETRY, template.fill(stamp, own_pose, own_twist), stamp)

    def write_entry(self, entry):
        """A message of another recording, unchanged."""
        self._put(entry.topic, entry.type_name, entry.data, entry.log_time, entry.publish_time)

    def close(self):
        """Close the file and give it its name. Raises ComputationFailed when messages were lost to the disk."""
        self._writer.close()
        os.replace(self._part, self._path)
        if self._writer.error or self._writer.lost:
            raise ComputationFailed(f"{self._path}: {self._writer.lost} messages could not be written: {self._writer.error or 'lost'}")

    def _put(self, topic, type_name, data, stamp, publish=None):
        self._writer.write(topic, type_name, data, stamp, publish)
        self._sent += 1

    def _wait_for_the_disk(self):
        while self._sent - self._writer.written - self._writer.lost > _WAITING_MESSAGES:
            if self._writer.error:
                raise ComputationFailed(f"{self._path}: {self._writer.error}")
            time.sleep(0.005)


class _MotionTemplate:
    """nav_msgs/Odometry of a pose (7,) and a twist (6,) in world axes; its own twist is in the platform's axes, as ROS has it."""

    def __init__(self, world, platform):
        pose, twist = placeholder(7), placeholder(6)
        message = Odometry(child_frame_id=platform)
        message.header.stamp, message.header.frame_id = placeholder_stamp(), world
        x, y, z, *quaternion = pose.tolist()
        message.pose.pose.position = Point(x=x, y=y, z=z)
        message.pose.pose.orientation = Quaternion(**dict(zip("xyzw", quaternion)))
        message.twist.twist.linear = Vector3(**dict(zip("xyz", twist[:3].tolist())))
        message.twist.twist.angular = Vector3(**dict(zip("xyz", twist[3:].tolist())))
        self._template = Template(message, [pose, twist])

    def fill(self, stamp, pose, twist):
        back, twist = rotation.conjugate(pose[3:].tolist()), twist.tolist()
        return self._template.fill(stamp, pose, [*rotation.rotate(back, twist[:3]), *rotation.rotate(back, twist[3:])])


def _cut_to_whole_rows(path):
    with open(path, "r+b") as file:
        file.truncate(file.read().rfind(b"\n") + 1)


def _step_template(length):
    slot = placeholder(length)
    return Template(Float64MultiArray(data=messages.floats(slot)), [slot])
