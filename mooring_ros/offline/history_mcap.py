"""Tensions and wrenches from a recording of the node, or of a replay."""

import numpy as np
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

from mooring_ros.motion.frames import FULL_SCALE, scale_in_words
from mooring_ros.node.full_scale import PREFIX
from mooring_ros.recording.reader import Recording

from .decoded import decoded
from .history import History
from .stamps import times_of

TENSIONS, NAMES, WRENCH, FAIRLEADS = "/line_tensions", "/lines", "/wrench", "/fairleads/"
ENDS = ("anchor_tension", "fairlead_tension")
AXES = ("fx", "fy", "fz", "mx", "my", "mz")
TYPES = {TENSIONS: "std_msgs/msg/Float64MultiArray", NAMES: "sensor_msgs/msg/JointState", WRENCH: "geometry_msgs/msg/WrenchStamped"}


def load_mcap_history(path):
    """The History in an MCAP file or bag folder with the node's topics, whatever the node's name and namespace.

    Series: `LINE.fairlead_tension`, `LINE.anchor_tension`, `wrench.fx` to `wrench.mz` and `POINT.fx` to `POINT.mz` for each fairlead's wrench.
    Times are those of the tensions, in s; counted from the first where the stamps are of a wall clock.
    What has other stamps is interpolated linearly, with a remark. Raises ValueError.
    """
    recording = Recording(path)
    found = {topic: type_name for topic, (type_name, count) in recording.topics().items() if count}
    node = _node(path, found)
    wrenches = {topic: _wrench_name(topic, node) for topic, type_name in found.items()
                if type_name == TYPES[WRENCH] and (topic == node + WRENCH or topic.startswith(node + FAIRLEADS))}
    if node + NAMES not in found:
        raise ValueError(f"{path}: no topic {node}{NAMES} (JointState), expected it to name the lines of {node}{TENSIONS}")
    rows = {topic: ([], []) for topic in (node + TENSIONS, *wrenches)}
    names = None
    for entry in recording.messages([node + TENSIONS, node + NAMES, *wrenches]):
        if entry.topic == node + NAMES:
            names = names or _line_names(path, entry)
            continue
        stamp, values = (_tensions if entry.topic == node + TENSIONS else _wrench)(path, entry)
        rows[entry.topic][0].append(stamp)
        rows[entry.topic][1].append(values)
    columns = [f"{name}.{end}" for name in names for end in ENDS]
    stamps, tensions = _table(path, node + TENSIONS, rows[node + TENSIONS], len(columns))
    series, remarks = dict(zip(columns, tensions.T)), [recording.cut] if recording.cut else []
    for topic, name in wrenches.items():
        values = _at(path, topic, rows[topic], stamps, remarks)
        series.update({f"{name}.{axis}": column for axis, column in zip(AXES, values.T)})
    given = recording.parameters or {}
    scale = scale_in_words(given["scale"], given.get("density_ratio", 1.0)) if "scale" in given else ""
    if scale not in ("", FULL_SCALE):
        remarks.append(f"{path}: forces and times are at {scale}")
    return History(str(path), times_of(stamps), series, (*remarks, *recording.damage), scale)


def _node(path, found):
    """The node's name, with its namespace: what stands before /line_tensions. What it tells of full scale beside a model is left out: times are the model's."""
    nodes = [topic[:-len(TENSIONS)] for topic, type_name in found.items()
             if topic.endswith(TENSIONS) and not topic.endswith(f"/{PREFIX}{TENSIONS}") and type_name == TYPES[TENSIONS]]
    if len(nodes) != 1:
        raise ValueError(f"{path}: {len(nodes)} topics end in {TENSIONS} (Float64MultiArray), expected one; "
                         f"it has {', '.join(sorted(found)) or 'no messages'}")
    return nodes[0]


def _wrench_name(topic, node):
    return "wrench" if topic == node + WRENCH else topic[len(node + FAIRLEADS):-len(WRENCH)]


def _line_names(path, entry):
    names = list(decoded(entry, JointState, path).name)
    if not names or len(set(names)) != len(names):
        raise ValueError(f"{path}: topic {entry.topic}: names {names}, expected one for each line")
    return names


def _tensions(path, entry):
    message = decoded(entry, Float64MultiArray, path)
    labels = [(dimension.label, dimension.size) for dimension in message.layout.dim]
    if [label for label, _ in labels] != ["line", "end"] or labels[1][1] != 2:
        raise ValueError(f"{path}: topic {entry.topic}: layout {labels}, expected [line][end] with 2 ends")
    return entry.publish_time, np.array(message.data)


def _wrench(path, entry):
    message = decoded(entry, WrenchStamped, path)
    force, torque, stamp = message.wrench.force, message.wrench.torque, message.header.stamp
    return stamp.sec * 1_000_000_000 + stamp.nanosec, np.array([force.x, force.y, force.z, torque.x, torque.y, torque.z])


def _table(path, topic, rows, width):
    """Stamps (n,) and values (n, width) of a topic, checked; of equal stamps (a settle, then a step), the last counts."""
    stamps, values = np.array(rows[0], dtype=np.int64), rows[1]
    for row, value in enumerate(values):
        if len(value) != width:
            raise ValueError(f"{path}: topic {topic}: message {row + 1} has {len(value)} numbers, expected {width}")
    values = np.array(values)
    if not np.isfinite(values).all():
        raise ValueError(f"{path}: topic {topic}: message {int(np.argmin(np.isfinite(values).all(axis=1))) + 1}: "
                         "a number that is not finite, expected finite numbers")
    if (np.diff(stamps) < 0).any():
        raise ValueError(f"{path}: topic {topic}: message {int(np.argmax(np.diff(stamps) < 0)) + 2}: the stamp runs backwards, "
                         "expected it to increase")
    last_of_each = np.append(np.diff(stamps) > 0, True)
    if last_of_each.sum() < 2:
        raise ValueError(f"{path}: topic {topic}: {int(last_of_each.sum())} samples, expected at least 2")
    return stamps[last_of_each], values[last_of_each]


def _at(path, topic, rows, stamps, remarks):
    """Values (n, 6) of a wrench topic at the stamps of the tensions."""
    own, values = _table(path, topic, rows, len(AXES))
    if np.array_equal(own, stamps):
        return values
    remarks.append(f"{topic}: stamps differ from those of the tensions, interpolated linearly and held at the ends")
    at, given = (stamps - own[0]).astype(float), (own - own[0]).astype(float)
    return np.column_stack([np.interp(at, given, values[:, column]) for column in range(values.shape[1])])
