"""What the node recorded of a demo run, as arrays."""

from dataclasses import dataclass

import numpy as np
from geometry_msgs.msg import WrenchStamped
from nav_msgs.msg import Odometry
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState, PointCloud2
from std_msgs.msg import Float64MultiArray

from mooring_ros.coupling.channel import stamp_of
from mooring_ros.recording.reader import Recording

_MOTION, _WRENCH, _LINES, _TENSIONS, _NODES = (
    "/platform/odom", "/mooring/wrench", "/mooring/lines", "/mooring/line_tensions", "/mooring/nodes",
)  # fmt: skip
_TYPES = {_MOTION: Odometry, _WRENCH: WrenchStamped, _LINES: JointState, _TENSIONS: Float64MultiArray, _NODES: PointCloud2}


@dataclass(frozen=True)
class Answers:
    """What the moorings answered. times (n,) s; wrenches (n, 6) N, N·m; line_names; fairlead_tension, anchor_tension (n, lines) N."""

    times: np.ndarray
    wrenches: np.ndarray
    line_names: tuple
    fairlead_tension: np.ndarray
    anchor_tension: np.ndarray


@dataclass(frozen=True)
class History:
    """A recorded run; times in s from the start of the coupled motion.

    times (n,) s, poses (n, 7): the motion as sent. answers: Answers.
    shapes: list of (time (s), dict of line name -> (positions (nodes, 3) m, tension (nodes,) N)).
    """

    times: np.ndarray
    poses: np.ndarray
    answers: Answers
    shapes: list

    def shape_at(self, time):
        """(time, shapes) of the recorded line shapes nearest to a time (s)."""
        return min(self.shapes, key=lambda entry: abs(entry[0] - time))


def read_history(path, start_stamp):
    """The History of a recording; start_stamp: ns, simulated time 0, what came before is left out.

    Raises RecordingError when the file cannot be read, ValueError when it does not hold a whole run.
    """
    found = _read(path, (_MOTION, _WRENCH, _LINES, _TENSIONS, _NODES), start_stamp)
    return History(
        times=np.array([_time(message, start_stamp) for message in found[_MOTION]]),
        poses=np.array([_pose(message) for message in found[_MOTION]]),
        answers=_answers(path, found, start_stamp),
        shapes=[(_time(cloud, start_stamp), _shapes(cloud, found[_LINES][0].name)) for cloud in found[_NODES]],
    )


def read_answers(path, start_stamp):
    """The Answers alone, also of a replay's recording; as read_history otherwise."""
    return _answers(path, _read(path, (_WRENCH, _LINES, _TENSIONS), start_stamp), start_stamp)


def _read(path, topics, start_stamp):
    """Dict of topic -> messages from start_stamp on; none is empty."""
    found = {topic: [] for topic in topics}
    for entry in Recording(path).messages(set(topics)):
        message = deserialize_message(entry.data, _TYPES[entry.topic])
        # A message without a header goes by the time of the log, which is that of its input.
        if (stamp_of(message) if hasattr(message, "header") else entry.log_time) >= start_stamp:
            found[entry.topic].append(message)
    for topic, messages in found.items():
        if not messages:
            raise ValueError(f"{path}: no message of {topic} in the run, expected a recorded run")
    return found


def _answers(path, found, start_stamp):
    wrenches, lines, tensions = found[_WRENCH], found[_LINES], found[_TENSIONS]
    if not len(wrenches) == len(lines) == len(tensions):
        counts = f"{len(wrenches)} wrenches, {len(lines)} lines and {len(tensions)} line_tensions"
        raise ValueError(f"{path}: {counts}, expected as many of each")
    names = tuple(lines[0].name)
    return Answers(
        times=np.array([_time(wrench, start_stamp) for wrench in wrenches]),
        wrenches=np.array([_wrench(wrench) for wrench in wrenches]),
        line_names=names,
        fairlead_tension=np.array([line.effort for line in lines]),
        anchor_tension=np.array([tension.data for tension in tensions]).reshape(len(tensions), len(names), 2)[:, :, 0],
    )


def _time(message, start_stamp):
    return (stamp_of(message) - start_stamp) * 1e-9


def _pose(message):
    position, orientation = message.pose.pose.position, message.pose.pose.orientation
    return [position.x, position.y, position.z, orientation.x, orientation.y, orientation.z, orientation.w]


def _wrench(message):
    force, torque = message.wrench.force, message.wrench.torque
    return [force.x, force.y, force.z, torque.x, torque.y, torque.z]


def _shapes(cloud, names):
    """Dict of line name -> (positions, tension) of a PointCloud2 with the fields x, y, z, tension and line."""
    layout = np.dtype({
        "names": [field.name for field in cloud.fields],
        "formats": ["<f4"] * len(cloud.fields),
        "offsets": [field.offset for field in cloud.fields],
        "itemsize": cloud.point_step,
    })  # fmt: skip
    nodes = np.frombuffer(bytes(cloud.data), layout)
    shapes = {}
    for index, name in enumerate(names):
        rows = nodes[nodes["line"] == index]
        shapes[name] = np.stack([rows["x"], rows["y"], rows["z"]], axis=1).astype(float), rows["tension"].astype(float)
    return shapes
