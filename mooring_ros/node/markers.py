"""MarkerArray of the mooring: lines coloured by tension, rods, bodies, the seabed, the anchors. Needs no ROS graph."""
import math

import numpy as np
from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from mooring_ros.node.bed_marker import shape_bed
from mooring_ros.node.template import Template, placeholder, placeholder_stamp
from mooring_ros.scene import FIXED

MARKER_ARRAY = "visualization_msgs/msg/MarkerArray"

# Blue over green to red, from no tension to the highest seen so far.
_COLOURS = np.array([[0.10, 0.25, 0.85], [0.05, 0.70, 0.80], [0.25, 0.75, 0.25], [0.95, 0.75, 0.10], [0.85, 0.10, 0.10]])
_STEPS = np.linspace(0.0, 1.0, len(_COLOURS))
_ANCHOR = ColorRGBA(r=0.20, g=0.20, b=0.20, a=1.0)
_PART = ColorRGBA(r=0.90, g=0.60, b=0.10, a=1.0)
_LEAST = 0.005                  # width over the mooring's at which a rod or a body can still be seen


class Markers:
    """The markers of one mooring, serialized. adapter: see `Messages`; world_frame: frame id."""

    def __init__(self, mooring, adapter, world_frame="world"):
        self._adapter = adapter
        self._frame = world_frame
        self._names = list(mooring.line_names)
        self._rods = [rod.name for rod in mooring.scene.rods if rod.length]
        self._bodies = [body.name for body in mooring.scene.bodies]
        self._highest = 0.0
        nodes = np.concatenate([mooring.node_positions(name) for name in self._names])
        self._width = (float(np.ptp(nodes[:, :2], axis=0).max()) or 1.0) * adapter.length_factor
        bed = self._marker("seabed", 0, Marker.CUBE)
        shape_bed(bed, mooring.scene, adapter, nodes)
        lines, slots = self._lines(mooring)
        parts, more = self._parts(mooring.scene)
        self._template = Template(MarkerArray(markers=[*lines, *parts, bed, self._anchors(mooring.scene)]), slots + more)

    def markers(self, stamp, mooring):
        """The MarkerArray with this stamp (ns)."""
        tensions = [mooring.node_tension(name) for name in self._names]
        self._highest = max(self._highest, *(float(tension.max()) for tension in tensions))
        values = []
        for name, tension in zip(self._names, tensions):
            values.append(self._adapter.points_out(mooring.node_positions(name)).ravel())
            values.append(self._colours(tension).ravel())
        values += [_middle_and_turn(self._adapter.points_out(mooring.rod_positions(name))) for name in self._rods]
        values += [self._adapter.points_out(mooring.body_poses[name][None, :3])[0] for name in self._bodies]
        return self._template.fill(stamp, *values)

    def _lines(self, mooring):
        markers, slots = [], []
        for index, name in enumerate(self._names):
            count = len(mooring.node_tension(name))
            marker = self._marker("lines", index, Marker.LINE_STRIP)
            marker.scale.x = 0.003 * self._width
            slots += [placeholder(3 * count), placeholder(4 * count, "<f4")]
            marker.points = [Point(x=x, y=y, z=z) for x, y, z in slots[-2].reshape(-1, 3).tolist()]
            marker.colors = [ColorRGBA(r=r, g=g, b=b, a=a) for r, g, b, a in slots[-1].reshape(-1, 4).tolist()]
            markers.append(marker)
        return markers, slots

    def _parts(self, scene):
        """Rods as cylinders; bodies as balls of their volume."""
        markers, slots = [], []
        for index, rod in enumerate(rod for rod in scene.rods if rod.length):
            marker = self._marker("rods", index, Marker.CYLINDER)
            slots.append(placeholder(7))
            x, y, z, *turn = slots[-1].tolist()
            marker.pose.position = Point(x=x, y=y, z=z)
            marker.pose.orientation.x, marker.pose.orientation.y, marker.pose.orientation.z, marker.pose.orientation.w = turn
            self._size(marker, rod.type.diameter, rod.length)
            markers.append(marker)
        for index, body in enumerate(scene.bodies):
            marker = self._marker("bodies", index, Marker.SPHERE)
            slots.append(placeholder(3))
            marker.pose.position = Point(**dict(zip("xyz", slots[-1].tolist())))
            diameter = (6.0 * body.volume / math.pi) ** (1.0 / 3.0)
            self._size(marker, diameter, diameter)
            markers.append(marker)
        return markers, slots

    def _size(self, marker, diameter, length):
        """Of a part, m inside."""
        least = _LEAST * self._width
        marker.scale.x = marker.scale.y = max(diameter * self._adapter.length_factor, least)
        marker.scale.z = max(length * self._adapter.length_factor, least)
        marker.color = _PART

    def _colours(self, tension):
        share = np.clip(tension / (self._highest or 1.0), 0.0, 1.0)
        return np.column_stack([np.interp(share, _STEPS, channel) for channel in _COLOURS.T] + [np.ones_like(share)])

    def _marker(self, namespace, index, kind):
        marker = Marker(ns=namespace, id=index, type=kind, action=Marker.ADD)
        marker.header.frame_id, marker.header.stamp = self._frame, placeholder_stamp()
        marker.pose.orientation.w = 1.0
        return marker

    def _anchors(self, scene):
        marker = self._marker("anchors", 0, Marker.SPHERE_LIST)
        marker.scale.x = marker.scale.y = marker.scale.z = 0.01 * self._width
        marker.color = _ANCHOR
        fixed = [point.position for point in scene.points if point.kind == FIXED]
        fixed += [rod.end_a for rod in scene.rods if rod.kind == FIXED and not rod.length]
        places = self._adapter.points_out(np.array(fixed, dtype=float).reshape(-1, 3))
        marker.points = [Point(x=x, y=y, z=z) for x, y, z in places.tolist()]
        return marker


def _middle_and_turn(ends):
    """Position (3,) of a rod with these ends (2, 3), and the quaternion (4,) that turns the z axis into its direction."""
    direction = ends[1] - ends[0]
    x, y, z = direction / np.linalg.norm(direction)
    # Half the angle between the axes, from their sum; a rod that points down has none: a half turn about x.
    turn = np.array([-y, x, 0.0, 1.0 + z]) if z > -1.0 + 1e-9 else np.array([1.0, 0.0, 0.0, 0.0])
    return np.concatenate([0.5 * (ends[0] + ends[1]), turn / np.linalg.norm(turn)])
