"""From a Mooring to the bytes of the messages that the node publishes and the offline replay writes. Needs no ROS graph."""
import array

import numpy as np
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState, PointCloud2, PointField
from std_msgs.msg import Float64MultiArray, MultiArrayDimension

from mooring_ros.node.template import Template, placeholder, placeholder_stamp

WRENCH, JOINT_STATE, FLOAT_ARRAY, POINT_CLOUD = (
    "geometry_msgs/msg/WrenchStamped", "sensor_msgs/msg/JointState", "std_msgs/msg/Float64MultiArray", "sensor_msgs/msg/PointCloud2")

NODE_FIELDS = ("x", "y", "z", "tension", "curvature", "line", "node")
_FLOAT_SIZE = 4


def topics(node, coupled_names, platforms=None):
    """Topic -> type of the answers of the node with this fully qualified name, "~" for names relative to it. platforms: their names, where they have any."""
    return {**dict.fromkeys(total_topics(node, platforms), WRENCH), **{fairlead_topic(node, name): WRENCH for name in coupled_names},
            f"{node}/lines": JOINT_STATE, f"{node}/line_tensions": FLOAT_ARRAY, f"{node}/nodes": POINT_CLOUD}


def total_topics(node, platforms):
    """Topics of the wrenches on the platforms, with their names, or of the one that has none."""
    return [f"{node}/wrench"] if platforms is None else [f"{node}/platforms/{name}/wrench" for name in platforms]


def fairlead_topic(node, coupled_name):
    """Topic of the wrench at a coupled point."""
    return f"{node}/fairleads/{coupled_name}/wrench"


def floats(values):
    """Numbers as the array that a float64[] field takes without a copy for each of them."""
    return array.array("d", np.ascontiguousarray(values, dtype=float).tobytes())


class Messages:
    """The answers of one mooring as serialized messages.

    mooring: a `Mooring`, for its names and numbers of nodes. wrench_frame, world_frame: frame ids of the wrenches and of the rest; of several platforms
    a wrench_frame for each. Rows of wrenches are those on the platforms, then those at what is coupled.
    adapter: a `motion.Adapter`; it turns what is inside into the source's axes, convention and scale.
    """

    def __init__(self, mooring, adapter, wrench_frame="world", world_frame="world"):
        self._adapter = adapter
        self._line_names = list(mooring.line_names)
        frames = [wrench_frame] if isinstance(wrench_frame, str) else wrench_frame
        self._wrench = [_wrench_template(frame) for frame in frames]
        self._platform_of = [*range(len(frames)), *mooring.platform_of_coupled] if len(frames) > 1 else None  # of each row of wrenches
        self._lines = _lines_template(self._line_names, world_frame)
        self._line_tensions = _line_tensions_template(len(self._line_names))
        sizes = [segments + 1 for segments in mooring.segments]
        self._nodes = _nodes_template(sum(sizes), world_frame)
        self._cloud = np.zeros((sum(sizes), len(NODE_FIELDS)), dtype="<f4")
        self._cloud[:, 5] = np.repeat(np.arange(len(sizes)), sizes)
        self._cloud[:, 6] = np.concatenate([np.arange(size) for size in sizes]) if sizes else []
        self._ends = np.cumsum([0, *sizes])

    def wrenches(self, wrenches, pose):
        """Wrenches (k, 6), inside and in world axes, as they go out: the source's axes, convention and scale. pose: inside, (7,) or (platforms, 7)."""
        if self._platform_of is None:
            return self._adapter.wrenches_out(wrenches, np.reshape(pose, 7))
        out = np.empty_like(wrenches)
        for platform, own in enumerate(pose):
            rows = np.equal(self._platform_of, platform)
            out[rows] = self._adapter.wrenches_out(wrenches[rows], own)
        return out

    def wrench(self, stamp, wrench, row=0):
        """WrenchStamped of a wrench (6,) as it goes out, that of this row."""
        return self._wrench[self._platform_of[row] if self._platform_of else 0].fill(stamp, wrench)

    def lines(self, stamp, mooring):
        """JointState: stretched length (m), its rate (m/s) and fairlead tension (N) of each line."""
        adapter = self._adapter
        return self._lines.fill(stamp, mooring.stretched_length * adapter.length_factor, mooring.length_rate * adapter.speed_factor,
                                mooring.fairlead_tension * adapter.force_factor)

    def line_tensions(self, mooring):
        """Float64MultiArray [line][end]: tension (N) at the anchor and at the fairlead."""
        tensions = np.column_stack((mooring.anchor_tension, mooring.fairlead_tension))
        return self._line_tensions.fill(0, tensions.ravel() * self._adapter.force_factor)

    def nodes(self, stamp, mooring):
        """PointCloud2 of all nodes: position (m), tension (N), curvature (1/m), index of the line, index of the node in it."""
        adapter = self._adapter
        for name, begin, end in zip(self._line_names, self._ends, self._ends[1:]):
            rows = self._cloud[begin:end]
            rows[:, :3] = adapter.points_out(mooring.node_positions(name))
            rows[:, 3] = mooring.node_tension(name) * adapter.force_factor
            rows[:, 4] = mooring.node_curvature(name) / adapter.length_factor
        return self._nodes.fill(stamp, self._cloud.ravel())


def _wrench_template(frame):
    slot = placeholder(6)
    message = WrenchStamped()
    message.header.stamp, message.header.frame_id = placeholder_stamp(), frame
    message.wrench.force.x, message.wrench.force.y, message.wrench.force.z = slot[:3].tolist()
    message.wrench.torque.x, message.wrench.torque.y, message.wrench.torque.z = slot[3:].tolist()
    return Template(message, [slot])


def _lines_template(names, frame):
    slots = [placeholder(len(names)) for _ in range(3)]
    message = JointState(name=names, position=floats(slots[0]), velocity=floats(slots[1]), effort=floats(slots[2]))
    message.header.stamp, message.header.frame_id = placeholder_stamp(), frame
    return Template(message, slots)


def _line_tensions_template(lines):
    slot = placeholder(2 * lines)
    message = Float64MultiArray(data=floats(slot))
    message.layout.dim = [MultiArrayDimension(label="line", size=lines, stride=2 * lines),
                          MultiArrayDimension(label="end", size=2, stride=2)]
    return Template(message, [slot])


def _nodes_template(count, frame):
    slot = placeholder(count * len(NODE_FIELDS), "<f4")
    step = _FLOAT_SIZE * len(NODE_FIELDS)
    message = PointCloud2(height=1, width=count, is_bigendian=False, point_step=step, row_step=step * count, is_dense=True,
                          data=array.array("B", slot.tobytes()))
    message.fields = [PointField(name=name, offset=_FLOAT_SIZE * k, datatype=PointField.FLOAT32, count=1)
                      for k, name in enumerate(NODE_FIELDS)]
    message.header.stamp, message.header.frame_id = placeholder_stamp(), frame
    return Template(message, [slot])
