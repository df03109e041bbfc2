"""What the node recorded of a demo run, as arrays."""

from dataclasses import dataclass

import numpy as np
from geometry_msgs.msg import WrenchStamped
from nav_msgs.msg import Odometry
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState, PointCloud2
from std_msgs.msg import Float64MultiArray

from mooring_ros.recording.reader import Recording

_TYPES = {
    "/platform/odom": Odometry, "/mooring/wrench": WrenchStamped, "/mooring/lines": JointState,
    "/mooring/line_tensions": Float64MultiArray, "/mooring/nodes": PointCloud2,
}  # fmt: skip


@dataclass(frozen=True)
class History:
    """A recorded run; times in s from the start of the coupled motion.

    times (n,) s, poses (n, 7): as sent. answer_times (m,) s, wrenches (m, 6) N, N·m, fairlead_tension, anchor_tension (m, lines) N: as answered.
    shapes: list of (time (s), dict of line name -> (positions (nodes, 3) m, tension (nodes,) N)).
    """

    times: np.ndarray
    poses: np.ndarray
    answer_times: np.ndarray
    wrenches: np.ndarray
    line_names: tuple
    fairlead_tension: np.ndarray
    anchor_tension: np.ndarray
    shapes: list

    def shape_at(self, time):
        """(time, shapes) of the recorded line shapes nearest to a time (s)."""
        return min(self.shapes, key=lambda entry: abs(entry[0] - time))


def read_history(path, start_stamp):
    """The History of a recording; start_stamp: ns, simulated time 0, what came before is left out.

    Raises RecordingError when the file cannot be read, ValueError when it does not hold a whole run.
    """
    found = {topic: [] for topic in _TYPES}
    for entry in Recording(path).messages(set(_TYPES)):
        found[entry.topic].append(deserialize_message(entry.data, _TYPES[entry.topic]))
    for topic, messages in found.items():
        if not messages:
            raise ValueError(f"{path}: no message of {topic}, expected a recorded run")
    names = tuple(found["/mooring/lines"][0].name)
    sent = [message for message in found["/platform/odom"] if _stamp(message) >= start_stamp]
    wrenches, lines, tensions = found["/mooring/wrench"], found["/mooring/lines"], found["/mooring/line_tensions"]
    if not len(wrenches) == len(lines) == len(tensions):
        raise ValueError(f"{path}: {len(wrenches)} wrenches, {len(lines)} lines and {len(tensions)} line_tensions, expected as many of each")
    answers = [answer for answer in zip(wrenches, lines, tensions) if _stamp(answer[0]) >= start_stamp]
    if not sent or not answers:
        raise ValueError(f"{path}: no motion after the start, expected a recorded run")
    clouds = found["/mooring/nodes"]
    clouds = [cloud for cloud in clouds if _stamp(cloud) >= start_stamp] or clouds[-1:]
    return History(
        times=np.array([_time(message, start_stamp) for message in sent]),
        poses=np.array([_pose(message) for message in sent]),
        answer_times=np.array([_time(wrench, start_stamp) for wrench, _, _ in answers]),
        wrenches=np.array([_wrench(wrench) for wrench, _, _ in answers]),
        line_names=names,
        fairlead_tension=np.array([line.effort for _, line, _ in answers]),
        anchor_tension=np.array([tension.data for _, _, tension in answers]).reshape(len(answers), len(names), 2)[:, :, 0],
        shapes=[(_time(cloud, start_stamp), _shapes(cloud, names)) for cloud in clouds],
    )


def _stamp(message):
    return message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec


def _time(message, start_stamp):
    return (_stamp(message) - start_stamp) * 1e-9


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
