"""The bed below a mooring as a marker: a plate where it is flat, triangles where it is not."""
import numpy as np
from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker

from mooring_ros.scene import bed_level

_COLOUR = ColorRGBA(r=0.55, g=0.47, b=0.35, a=0.4)
_UNDER = 0.002                  # how far it is shown below its place, over its width: no flicker with lines that lie on it
_CELLS = 16                     # of a side, on a grid of depths; a slope needs one
_EDGE = 1.1                     # its width over that of the mooring


def shape_bed(marker, scene, adapter, nodes):
    """Make a Marker the bed of a Scene below nodes (k, 3), m, inside."""
    env = scene.environment
    middle = 0.5 * (nodes.min(axis=0) + nodes.max(axis=0))
    width = _EDGE * (float(np.ptp(nodes[:, :2], axis=0).max()) or 1.0)
    marker.color = _COLOUR
    if env.bathymetry is None and not any(env.bed_slope):
        _plate(marker, adapter, middle, width, -env.depth)
    else:
        cells = _CELLS if env.bathymetry is not None else 1
        x, y = (place + width * np.linspace(-0.5, 0.5, cells + 1) for place in middle[:2])
        places = np.array([[(a, b, bed_level(env, a, b) - _UNDER * width) for b in y] for a in x])
        _triangles(marker, adapter.points_out(places.reshape(-1, 3)).reshape(places.shape))


def _plate(marker, adapter, middle, width, level):
    thickness = _UNDER * width
    (x, y, z), = adapter.points_out(np.array([[middle[0], middle[1], level - thickness]])).tolist()
    marker.type = Marker.CUBE
    marker.pose.position = Point(x=x, y=y, z=z)
    marker.scale.x = marker.scale.y = width * adapter.length_factor
    marker.scale.z = thickness * adapter.length_factor


def _triangles(marker, places):
    """places: (cells + 1, cells + 1, 3), out."""
    marker.type = Marker.TRIANGLE_LIST
    marker.scale.x = marker.scale.y = marker.scale.z = 1.0
    near_near, near_far, far_near, far_far = places[:-1, :-1], places[:-1, 1:], places[1:, :-1], places[1:, 1:]
    corners = np.stack([near_near, far_near, far_far, near_near, far_far, near_far], axis=2)
    marker.points = [Point(x=x, y=y, z=z) for x, y, z in corners.reshape(-1, 3).tolist()]
