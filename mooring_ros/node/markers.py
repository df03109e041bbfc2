"""MarkerArray of the mooring: lines coloured by tension, the seabed, the anchors. Needs no ROS graph."""
import numpy as np
from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from mooring_ros.node.template import Template, placeholder, placeholder_stamp

MARKER_ARRAY = "visualization_msgs/msg/MarkerArray"

# Blue over green to red, from no tension to the highest seen so far.
_COLOURS = np.array([[0.10, 0.25, 0.85], [0.05, 0.70, 0.80], [0.25, 0.75, 0.25], [0.95, 0.75, 0.10], [0.85, 0.10, 0.10]])
_STEPS = np.linspace(0.0, 1.0, len(_COLOURS))
_SEABED = ColorRGBA(r=0.55, g=0.47, b=0.35, a=0.4)
_ANCHOR = ColorRGBA(r=0.20, g=0.20, b=0.20, a=1.0)
_UNDER = 0.002                  # how far the seabed's plane lies below it, over its width: no flicker with lines that lie on it


class Markers:
    """The markers of one mooring, serialized. adapter: see `Messages`; world_frame: frame id."""

    def __init__(self, mooring, adapter, world_frame="world"):
        self._adapter = adapter
        self._names = list(mooring.line_names)
        self._highest = 0.0
        points = np.concatenate([adapter.points_out(mooring.node_positions(name)) for name in self._names])
        self._width = float(np.ptp(points[:, :2], axis=0).max()) or 1.0
        message, slots = MarkerArray(), []
        for index, name in enumerate(self._names):
            count = len(mooring.node_tension(name))
            marker = self._marker("lines", index, Marker.LINE_STRIP, world_frame)
            marker.scale.x = 0.003 * self._width
            slots += [placeholder(3 * count), placeholder(4 * count, "<f4")]
            marker.points = [Point(x=x, y=y, z=z) for x, y, z in slots[-2].reshape(-1, 3).tolist()]
            marker.colors = [ColorRGBA(r=r, g=g, b=b, a=a) for r, g, b, a in slots[-1].reshape(-1, 4).tolist()]
            message.markers.append(marker)
        message.markers.append(self._seabed(mooring, points, world_frame))
        message.markers.append(self._anchors(mooring, world_frame))
        self._template = Template(message, slots)

    def markers(self, stamp, mooring):
        """The MarkerArray with this stamp (ns)."""
        tensions = [mooring.node_tension(name) for name in self._names]
        self._highest = max(self._highest, *(float(tension.max()) for tension in tensions))
        values = []
        for name, tension in zip(self._names, tensions):
            values.append(self._adapter.points_out(mooring.node_positions(name)).ravel())
            values.append(self._colours(tension).ravel())
        return self._template.fill(stamp, *values)

    def _colours(self, tension):
        share = np.clip(tension / (self._highest or 1.0), 0.0, 1.0)
        return np.column_stack([np.interp(share, _STEPS, channel) for channel in _COLOURS.T] + [np.ones_like(share)])

    def _marker(self, namespace, index, kind, frame):
        marker = Marker(ns=namespace, id=index, type=kind, action=Marker.ADD)
        marker.header.frame_id, marker.header.stamp = frame, placeholder_stamp()
        marker.pose.orientation.w = 1.0
        return marker

    def _seabed(self, mooring, points, frame):
        marker = self._marker("seabed", 0, Marker.CUBE, frame)
        depth = mooring.scene.environment.depth
        middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
        thickness = _UNDER * self._width
        bed = self._adapter.points_out(np.array([[0.0, 0.0, -depth]]))[0, 2]
        below = thickness if self._adapter.convention == "enu" else -thickness
        marker.pose.position.x, marker.pose.position.y, marker.pose.position.z = float(middle[0]), float(middle[1]), float(bed - below)
        marker.scale.x = marker.scale.y = 1.1 * self._width
        marker.scale.z = thickness
        marker.color = _SEABED
        return marker

    def _anchors(self, mooring, frame):
        marker = self._marker("anchors", 0, Marker.SPHERE_LIST, frame)
        marker.scale.x = marker.scale.y = marker.scale.z = 0.01 * self._width
        marker.color = _ANCHOR
        fixed = np.array([point.position for point in mooring.scene.points if point.kind == "fixed"], dtype=float).reshape(-1, 3)
        marker.points = [Point(x=x, y=y, z=z) for x, y, z in self._adapter.points_out(fixed).tolist()]
        return marker
