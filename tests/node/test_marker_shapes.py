"""Markers of rods, bodies and of a bed that is not flat, with a mooring that says where they are."""
import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from scipy.spatial.transform import Rotation
from visualization_msgs.msg import Marker, MarkerArray

from mooring_ros.motion import Adapter
from mooring_ros.node.markers import Markers
from mooring_ros.scene import bed_level, parse_scene

TEXT = """\
--- LINE TYPES ---
Name  Diam  Mass/m  EA  BA/-zeta  EI  Cd  Ca  CdAx  CaAx
chain  0.05  50  2.0e7  -0.8  0  2.0  0.8  0.4  0.25
--- ROD TYPES ---
Name  Diam  Mass/m  Cd  Ca  CdEnd  CaEnd
pipe  2.0  120  0.6  1.0  1.0  1.0
--- BODIES ---
ID  Attachment  X  Y  Z  r  p  y  Mass  CG  I  Volume  CdA  Ca
1  Free  100  0  -20  0  0  0  2e4  0  1e4  30  5  0.5
--- RODS ---
ID  Type  Attachment  Xa  Ya  Za  Xb  Yb  Zb  NumSegs  Outputs
1  pipe  Free  20  0  -5  20  4  -8  2  -
2  pipe  Fixed  -200  0  -60  -199  0  -60  0  -
--- POINTS ---
ID  Type  X  Y  Z  Mass  Volume  CdA  Ca
1  Fixed    200  100  -60  0  0  0  0
2  Body1   0  0  -1  0  0  0  0
--- LINES ---
ID  LineType  AttachA  AttachB  UnstrLen  NumSegs  Outputs
1  chain  1  2  220  8  -
2  chain  R2A  R1A  190  8  -
--- OPTIONS ---
"""
SLOPE = "60 WtrDpth\n0.05 BedSlopeX\n"
GRID = "2 2\n-400 400\n-400 400\n-400 -400 -50\n-400 400 -90\n400 -400 -70\n400 400 -70\n"


class Posed:
    """A settled mooring of two straight lines, a rod and a body."""

    line_names = ["line1", "line2"]
    body_poses = {"body1": np.array([101.0, 2.0, -19.0, 0.0, 0.0, 0.0, 1.0])}
    rod = np.array([[20.0, 1.0, -5.0], [20.0, 5.0, -8.0]])

    def __init__(self, options, files=()):
        self.scene = parse_scene(TEXT + options, "scene.txt", files)

    def node_positions(self, name):
        ends = [(200.0, 100.0, -60.0), (101.0, 2.0, -20.0)] if name == "line1" else [(-200.0, 0.0, -60.0), tuple(self.rod[0])]
        return np.linspace(*ends, 9)

    def node_tension(self, _):
        return np.linspace(1e3, 2e3, 9)

    def rod_positions(self, _):
        return self.rod


def shown(mooring, adapter):
    array = deserialize_message(Markers(mooring, adapter, "map").markers(5, mooring), MarkerArray)
    return {marker.ns: marker for marker in array.markers}


def xyz(point):
    return [point.x, point.y, point.z]


@pytest.mark.parametrize("adapter", [Adapter(), Adapter(convention="ned", scale=25.0)], ids=["enu", "ned at 1:25"])
@pytest.mark.parametrize("down", [False, True])
def test_a_rod_is_a_cylinder_from_its_end_a_to_its_end_b(adapter, down):
    mooring = Posed("60 WtrDpth\n")
    if down:
        mooring.rod = np.array([[20.0, 1.0, -5.0], [20.0, 1.0, -10.0]])
    marker = shown(mooring, adapter)["rods"]
    turn = Rotation.from_quat([*xyz(marker.pose.orientation), marker.pose.orientation.w])
    length = 5.0 * adapter.length_factor
    ends = [turn.apply([0.0, 0.0, side * 0.5 * length]) + xyz(marker.pose.position) for side in (-1, 1)]
    np.testing.assert_allclose(ends, adapter.points_out(mooring.rod), atol=1e-9)
    assert marker.type == Marker.CYLINDER and marker.scale.x == pytest.approx(2.0 * adapter.length_factor)
    assert marker.scale.z == pytest.approx(length if not down else length * np.linalg.norm([3.0, 4.0]) / 5.0)


def test_a_body_is_a_ball_of_its_volume_where_it_is_and_a_fixed_rod_without_length_an_anchor():
    markers = shown(Posed("60 WtrDpth\n"), Adapter())
    assert xyz(markers["bodies"].pose.position) == [101.0, 2.0, -19.0]
    assert np.pi / 6.0 * markers["bodies"].scale.x ** 3 == pytest.approx(30.0)
    assert [xyz(point) for point in markers["anchors"].points] == [[200.0, 100.0, -60.0], [-200.0, 0.0, -60.0]]


@pytest.mark.parametrize("options, files, triangles", [(SLOPE, (), 2), ("depths.txt WtrDpth\n", (("depths.txt", GRID),), 2 * 16 * 16)])
@pytest.mark.parametrize("adapter", [Adapter(), Adapter(convention="ned", scale=25.0)], ids=["enu", "ned at 1:25"])
def test_a_bed_that_is_not_flat_is_a_mesh_just_below_it_and_wider_than_the_mooring(options, files, triangles, adapter):
    mooring = Posed(options, files)
    marker = shown(mooring, adapter)["seabed"]
    assert marker.type == Marker.TRIANGLE_LIST and len(marker.points) == 3 * triangles
    corners = np.array([xyz(point) for point in marker.points]) / adapter.length_factor
    if adapter.convention == "ned":
        corners = corners[:, [1, 0, 2]] * (1.0, 1.0, -1.0)
    under = [bed_level(mooring.scene.environment, x, y) - z for x, y, z in corners]
    assert 0.0 < min(under) and max(under) < 1.0
    assert corners[:, 0].min() < -200.0 and corners[:, 0].max() > 200.0
    sides = np.diff(corners.reshape(-1, 3, 3)[:, :, :2], axis=1)
    area = 0.5 * np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]).sum()
    assert area == pytest.approx((1.1 * 400.0) ** 2)  # every place once
