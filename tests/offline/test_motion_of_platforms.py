"""The motion of several platforms from recordings and tables, and what `mooring replay` makes of it."""

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.serialization import serialize_message
from scipy.spatial.transform import Rotation

from mooring_ros.mooring import Mooring
from mooring_ros.offline.motion_file import load_motion
from mooring_ros.recording import schedule
from mooring_ros.recording.writer import RecordingWriter

NAMES = ("body1", "body2")
TIMES = np.arange(60) * 0.1
STAMPS = 1000 + np.rint(TIMES * 1e9).astype(np.int64)
PAIR = """\
Two small buoys with a chain to the ground each, and one that they share
--- LINE TYPES ---
Name  Diam  Mass/m  EA  BA/-zeta  EI  Cd  Ca  CdAx  CaAx
(-)  (m)  (kg/m)  (N)  (N-s/-)  (N-m2)  (-)  (-)  (-)  (-)
chain  0.05  50  2.0e7  -0.8  0  2.0  0.8  0.4  0.25
--- BODIES ---
ID  Attachment  X0  Y0  Z0  r0  p0  y0  Mass  CG  I  Volume  CdA  Ca
(-)  (-)  (m)  (m)  (m)  (deg)  (deg)  (deg)  (kg)  (m)  (kg-m2)  (m3)  (m2)  (-)
1  Coupled  -150  0  0  0  0  180  0  0  0  0  0  0
2  Coupled   150  0  0  0  0    0  0  0  0  0  0  0
--- POINTS ---
ID  Type  X  Y  Z  Mass  Volume  CdA  Ca
(-)  (-)  (m)  (m)  (m)  (kg)  (m3)  (m2)  (-)
1  Fixed  -450  0  -60  0  0  0  0
2  Fixed   450  0  -60  0  0  0  0
3  Body1    20  0   -5  0  0  0  0
4  Body1   -20  0   -5  0  0  0  0
5  Body2    20  0   -5  0  0  0  0
6  Body2   -20  0   -5  0  0  0  0
--- LINES ---
ID  LineType  AttachA  AttachB  UnstrLen  NumSegs  Outputs
(-)  (-)  (-)  (-)  (m)  (-)  (-)
1  chain  1  3  292  8  -
2  chain  2  5  292  8  -
3  chain  4  6  264  8  -
--- OPTIONS ---
60  WtrDpth
1025  rho
9.80665  g
"""


def motion(times):
    """Poses (k, 2, 7) and twists (k, 2, 6): surge and pitch of each, in world axes."""
    poses, twists = np.zeros((times.size, 2, 7)), np.zeros((times.size, 2, 6))
    for own, (place, turned, omega) in enumerate(((-150.0, np.pi, 1.0), (150.0, 0.0, 1.5))):
        poses[:, own, 0], twists[:, own, 0] = place + 1.0 - np.cos(omega * times), omega * np.sin(omega * times)
        pitch, twists[:, own, 4] = 0.02 * (1.0 - np.cos(omega * times)), 0.02 * omega * np.sin(omega * times)
        poses[:, own, 3:] = (Rotation.from_rotvec(np.outer(pitch, [0.0, 1.0, 0.0])) * Rotation.from_rotvec([0.0, 0.0, turned])).as_quat()
    return poses, twists


POSES, TWISTS = motion(TIMES)


@pytest.fixture
def pair(tmp_path):
    """Path of the scene."""
    path = tmp_path / "pair.txt"
    path.write_text(PAIR)
    return path


def odometry(stamp, pose, twist, name):
    message = Odometry(child_frame_id=name)
    message.header.frame_id = "world"
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(int(stamp), 1_000_000_000)
    fill(message.pose.pose, pose)
    back = Rotation.from_quat(pose[3:]).inv()
    fill_twist(message.twist.twist, np.concatenate([back.apply(twist[:3]), back.apply(twist[3:])]))
    return message


def fill(pose, values):
    pose.position.x, pose.position.y, pose.position.z = values[:3].tolist()
    pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w = values[3:].tolist()


def fill_twist(twist, values):
    twist.linear.x, twist.linear.y, twist.linear.z, twist.angular.x, twist.angular.y, twist.angular.z = values.tolist()


def recorded(path, topic="/tank/{}/odom", left_out=(), parameters=None):
    """An MCAP of both platforms; left_out: (name, row) of samples that are missing."""
    with RecordingWriter(path, parameters or {"platforms": list(NAMES)}) as writer:
        for row, stamp in enumerate(STAMPS):
            for own, name in enumerate(NAMES):
                if (name, row) not in left_out:
                    message = odometry(stamp, POSES[row, own], TWISTS[row, own], name)
                    writer.write(topic.format(name), "nav_msgs/msg/Odometry", serialize_message(message), int(stamp))
    return path


def table(path, columns="x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz"):
    header = ["t", *(f"{name}.{column}" for name in NAMES for column in columns.split(","))]
    rows = [[time, *np.concatenate([pose, twist], axis=1)[:, : len(columns.split(","))].ravel().tolist()] for time, pose, twist in zip(TIMES.tolist(), POSES, TWISTS)]
    path.write_text("\n".join([",".join(header), *(",".join(map(repr, row)) for row in rows)]) + "\n")
    return path


@pytest.mark.parametrize("topic", [None, "/tank/body1/odom", "/tank/body2/odom"])
def test_each_platform_has_the_topic_with_its_name(tmp_path, topic):
    found = load_motion(recorded(tmp_path / "m.mcap"), topic)
    assert found.platforms == NAMES and found.source == "/tank/body1/odom; /tank/body2/odom" and (found.stamps == STAMPS).all()
    np.testing.assert_allclose(found.poses, POSES, atol=1e-12)
    np.testing.assert_allclose(found.twists, TWISTS, atol=1e-12)


def test_only_stamps_that_all_have_are_taken_and_what_is_left_out_is_said(tmp_path):
    found = load_motion(recorded(tmp_path / "m.mcap", left_out={("body1", 7), ("body2", 0), ("body2", 30)}))
    assert found.stamps.tolist() == [stamp for row, stamp in enumerate(STAMPS.tolist()) if row not in (0, 7, 30)]
    np.testing.assert_allclose(found.poses, np.delete(POSES, (0, 7, 30), axis=0), atol=1e-12)
    assert [remark.split(",")[0] for remark in found.remarks] == ["body1: 2 of 59 samples have a stamp that not all platforms have",
                                                                  "body2: 1 of 58 samples have a stamp that not all platforms have"]


def test_pairs_of_pose_and_twist_go_by_the_name_too(tmp_path):
    with RecordingWriter(tmp_path / "m.mcap", {"platforms": list(NAMES)}) as writer:
        for row, stamp in enumerate(STAMPS):
            for own, name in enumerate(NAMES):
                for message, part, kind in ((PoseStamped(), "pose", "PoseStamped"), (TwistStamped(), "twist", "TwistStamped")):
                    message.header.frame_id = "world"
                    message.header.stamp.sec, message.header.stamp.nanosec = divmod(int(stamp), 1_000_000_000)
                    fill(message.pose, POSES[row, own]) if part == "pose" else fill_twist(message.twist, TWISTS[row, own])
                    writer.write(f"/{name}/{part}", f"geometry_msgs/msg/{kind}", serialize_message(message), int(stamp))
    for topic in (None, "/body2/pose", "/body2/pose,/body2/twist"):
        found = load_motion(tmp_path / "m.mcap", topic)
        assert found.source == "/body1/pose and /body1/twist; /body2/pose and /body2/twist"
        np.testing.assert_allclose(found.twists, TWISTS, atol=1e-12)


@pytest.mark.parametrize("topic, left_out, words", [
    ("/other/odom", (), "topic /other/odom of platforms body1, body2, expected a topic of one of them with its name as a part of it, as /platforms/body1/odom"),
    ("/tank/body1/pose", (), "topic /tank/body1/pose is no Odometry or PoseStamped"),
    (None, {("body2", row) for row in range(60)}, "no topic is a motion"),
    (None, {(NAMES[row % 2], row) for row in range(60)}, "0 stamps that all of body1, body2 have, expected at least 2"),
])  # fmt: skip
def test_what_does_not_say_where_all_are_is_refused(tmp_path, topic, left_out, words):
    with pytest.raises(ValueError, match=words):
        load_motion(recorded(tmp_path / "m.mcap", left_out=left_out), topic)


def test_a_table_has_the_columns_of_each_with_its_name(tmp_path):
    found = load_motion(table(tmp_path / "m.csv"))
    assert found.platforms == NAMES and np.array_equal(found.poses, POSES) and np.array_equal(found.twists, TWISTS)
    differentiated = load_motion(table(tmp_path / "poses.csv", "x,y,z,qx,qy,qz,qw"))
    np.testing.assert_allclose(differentiated.twists, TWISTS, atol=2e-2)


@pytest.mark.parametrize("header, words", [
    ("t,body1.x,body1.y,body1.z,body1.roll,body1.pitch,body1.yaw,body2.x", "m.csv:1: columns t,body2.x, expected t,x,y,z.*those of body2 with body2. before them"),
    ("t,body1.x,body1.y,body1.z,body1.roll,body1.pitch,body1.yaw,x", "m.csv:1: column 'x' beside those of body1"),
    ("t,body1.x,body1.y,body1.z,body1.roll,body1.pitch,body1.yaw,body1.w", "m.csv:1: unknown column 'body1.w'"),
])  # fmt: skip
def test_a_table_with_columns_that_are_nobodys_is_refused(tmp_path, header, words):
    (tmp_path / "m.csv").write_text(header + "\n" + ",".join("0" * len(header.split(","))) + "\n")
    with pytest.raises(ValueError, match=words):
        load_motion(tmp_path / "m.csv")


def test_names_are_asked_for_where_the_file_has_none_and_may_not_contradict_it(tmp_path):
    from test_motion_file import foreign

    unnamed = foreign(recorded(tmp_path / "m.mcap"))
    assert load_motion(unnamed, None, NAMES).poses.shape == (60, 2, 7)
    with pytest.raises(ValueError, match="several topics could be the motion"):
        load_motion(unnamed)
    with pytest.raises(ValueError, match="recorded with platforms body1, body2, expected the same as in --platforms"):
        load_motion(tmp_path / "m.mcap", None, ("body1",))
    with pytest.raises(ValueError, match="columns of body1, body2, expected those of body2, body1, as body2.x"):
        load_motion(table(tmp_path / "m.csv"), None, NAMES[::-1])


def rows(path):
    header, *lines = path.read_text().splitlines()
    return header.split(","), np.array([[float(cell) for cell in line.split(",")] for line in lines])


@pytest.mark.parametrize("made, words", [(recorded, ("--topic", "/tank/body1/odom")), (table, ())], ids=["topic", "table"])
def test_a_replay_of_all_platforms_is_the_facade_and_its_own_recording_replays_bit_for_bit(pair, tmp_path, mooring, made, words):
    path = made(tmp_path / ("m.mcap" if made is recorded else "m.csv"))
    given = load_motion(path)
    found = mooring("replay", pair, path, "-o", tmp_path / "out.mcap", "--csv", tmp_path / "out.csv", *words, "--json")
    assert found.status == 0 and found.json()["answers"] == 60, found.err
    header, values = rows(tmp_path / "out.csv")
    own = Mooring(pair, platforms=NAMES)
    own.settle(given.poses[0], time=given.times[0])
    history = own.run(given.times[1:], given.poses[1:], given.twists[1:])
    assert np.array_equal(values[1:, header.index("body1.fx") :].reshape(-1, 2, 6), history.wrench)
    again = mooring("replay", pair, tmp_path / "out.mcap", "-o", tmp_path / "again.mcap", "--json").json()
    assert again["identical"] == {"same": 60, "total": 60} and again["motion"].startswith("step schedule")
    by_topic = load_motion(tmp_path / "out.mcap", "/platforms/body2/odom")
    np.testing.assert_allclose(by_topic.poses, given.poses, atol=1e-12)
    np.testing.assert_allclose(by_topic.twists, given.twists, atol=1e-12)


def test_a_replay_at_another_rate_runs_along_the_curve_of_each(pair, tmp_path, mooring):
    assert mooring("replay", pair, table(tmp_path / "m.csv"), "-o", tmp_path / "out.mcap", "--rate", 25, "--json").json()["answers"] == 148
    found = load_motion(tmp_path / "out.mcap")
    np.testing.assert_allclose(found.poses, motion(found.times)[0], atol=1e-5)
    assert found.schedule[0].kind == schedule.SETTLE
