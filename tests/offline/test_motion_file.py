import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.serialization import serialize_message
from scipy.spatial.transform import Rotation
from std_msgs.msg import Float64MultiArray, String

from mooring_ros.offline import __main__ as command_line  # noqa: F401 - the package as the command line loads it
from mooring_ros.offline.motion_file import load_motion
from mooring_ros.recording import schedule
from mooring_ros.recording.attached import AttachedScene
from mooring_ros.recording.writer import RecordingWriter

ODOMETRY, POSE, TWIST = "nav_msgs/msg/Odometry", "geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/TwistStamped"
EPOCH = 1_700_000_000_000_000_000


def swing(times):
    """A smooth motion: poses (n, 7), twists (n, 6) in world axes and in the platform's, exact."""
    w = 0.4
    position = np.column_stack([4 * np.sin(w * times), 2 * np.cos(w * times), 0.5 * np.sin(2 * w * times)])
    velocity = np.column_stack([4 * w * np.cos(w * times), -2 * w * np.sin(w * times), w * np.cos(2 * w * times)])
    axis = np.array([0.6, 0.0, 0.8])
    base = Rotation.from_euler("z", 40, degrees=True)
    turn = Rotation.from_rotvec(0.3 * np.sin(w * times)[:, None] * axis) * base
    rate = 0.3 * w * np.cos(w * times)[:, None] * axis
    world = np.hstack([velocity, rate])
    child = np.hstack([turn.inv().apply(velocity), turn.inv().apply(rate)])
    return np.hstack([position, turn.as_quat()]), world, child


def set_header(message, stamp, frame="world"):
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(int(stamp), 1_000_000_000)
    message.header.frame_id = frame


def pose_into(target, pose):
    target.position.x, target.position.y, target.position.z = map(float, pose[:3])
    target.orientation.x, target.orientation.y, target.orientation.z, target.orientation.w = map(float, pose[3:])


def twist_into(target, twist):
    target.linear.x, target.linear.y, target.linear.z = map(float, twist[:3])
    target.angular.x, target.angular.y, target.angular.z = map(float, twist[3:])


def odometry(stamp, pose, twist):
    message = Odometry(child_frame_id="platform")
    set_header(message, stamp)
    pose_into(message.pose.pose, pose)
    twist_into(message.twist.twist, twist)
    return message


def pose_stamped(stamp, pose):
    message = PoseStamped()
    set_header(message, stamp)
    pose_into(message.pose, pose)
    return message


def twist_stamped(stamp, twist, frame="world"):
    message = TwistStamped()
    set_header(message, stamp, frame)
    twist_into(message.twist, twist)
    return message


def write(path, messages, parameters=None):
    """messages: (topic, type name, message, log time)."""
    with RecordingWriter(path, parameters or {}) as writer:
        for topic, type_name, message, log_time in messages:
            writer.write(topic, type_name, serialize_message(message), log_time)
    return path


TIMES = np.arange(0, 20.0, 0.1)
POSES, WORLD, CHILD = swing(TIMES)
STAMPS = np.rint(TIMES * 1e9).astype(np.int64)


def foreign(path):
    """Take the node's own metadata record away: a file as another recorder writes it."""
    from mcap.reader import make_reader
    from mcap.writer import Writer

    with open(path, "rb") as file:
        reader = make_reader(file)
        with open(path.with_name("foreign.mcap"), "wb") as out:
            writer, channels = Writer(out), {}
            writer.start(profile="ros2", library="another")
            for schema, channel, message in reader.iter_messages(log_time_order=False):
                if channel.id not in channels:
                    channels[channel.id] = writer.register_channel(
                        channel.topic, "cdr", writer.register_schema(schema.name, schema.encoding, schema.data), channel.metadata)
                writer.add_message(channels[channel.id], message.log_time, message.data, message.publish_time)
            writer.finish()
    return path.with_name("foreign.mcap")


# --- CSV ---


def test_roll_pitch_yaw_are_about_the_fixed_axes_in_degrees(tmp_path):
    path = tmp_path / "m.csv"
    path.write_text("t,x,y,z,roll,pitch,yaw\n0,1,2,3,10,20,30\n1,1,2,3,-40,50,160\n")
    motion = load_motion(path)
    expected = Rotation.from_euler("xyz", [[10, 20, 30], [-40, 50, 160]], degrees=True)
    assert (Rotation.from_quat(motion.poses[:, 3:]) * expected.inv()).magnitude() == pytest.approx([0, 0], abs=1e-12)
    assert motion.poses[:, :3].tolist() == [[1, 2, 3]] * 2 and motion.times.tolist() == [0, 1]
    assert motion.stamps.tolist() == [0, 1_000_000_000] and motion.start_ns == 0 and motion.schedule is None


def test_quaternion_and_twist_columns_are_taken_as_they_are_in_any_order(tmp_path):
    path = tmp_path / "m.csv"
    path.write_text("qx,qy,qz,qw,t,x,y,z,wx,wy,wz,vx,vy,vz\n0,0,0,1,5.5,1,2,3,.1,.2,.3,4,5,6\n0,0,0.6,0.8,5.6,1,2,3,.1,.2,.3,4,5,6\n")
    motion = load_motion(path)
    assert motion.poses[1].tolist() == [1, 2, 3, 0, 0, 0.6, 0.8]
    assert motion.twists.tolist() == [[4, 5, 6, 0.1, 0.2, 0.3]] * 2 and motion.times.tolist() == [5.5, 5.6]
    assert motion.stamps.tolist() == [5_500_000_000, 5_600_000_000]


def test_comments_blank_lines_byte_order_mark_and_crlf_are_welcome(tmp_path):
    path = tmp_path / "m.csv"
    path.write_bytes(b"\xef\xbb\xbf# surge\r\n\r\nt, x, y, z, roll, pitch, yaw\r\n0, 0,0,0,0,0,0 # start\r\n\r\n1,1e0,0,0,0,0,0")
    assert load_motion(path).poses[:, 0].tolist() == [0, 1]


def test_a_negative_start_keeps_its_times_and_has_stamps_from_zero(tmp_path):
    path = tmp_path / "m.csv"
    path.write_text("t,x,y,z,roll,pitch,yaw\n-2,0,0,0,0,0,0\n1,1,0,0,0,0,0\n")
    motion = load_motion(path)
    assert motion.times.tolist() == [-2, 1] and motion.stamps.tolist() == [0, 3_000_000_000]


def test_the_twist_is_differentiated_where_there_is_none(tmp_path):
    path = tmp_path / "m.csv"
    rows = [",".join(map(repr, [time, *pose])) for time, pose in zip(TIMES.tolist(), POSES.tolist())]
    path.write_text("t,x,y,z,qx,qy,qz,qw\n" + "\n".join(rows))
    assert np.abs(load_motion(path).twists - WORLD).max() < 1e-4


HEADER = "t,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n"
QUATERNION = "t,x,y,z,qx,qy,qz,qw\n"


@pytest.mark.parametrize("text, line, message", [
    (HEADER + "1,0,abc,0,0,0,0", 3, "'abc' in column 'y', expected a number"),
    (HEADER + "1,0,nan,0,0,0,0", 3, "nan in column 'y', expected a finite number"),
    (HEADER + "1,0,1e999,0,0,0,0", 3, "expected a finite number"),
    (HEADER + "1,0,1_0,0,0,0,0", 3, "expected a number"),
    (HEADER + "1,0,,0,0,0,0", 3, "'' in column 'y', expected a number"),
    (HEADER + "1,0,0,0,0,0", 3, "6 columns, expected 7"),
    (HEADER + "1,0,0,0,0,0,0,0", 3, "8 columns, expected 7"),
    (HEADER + "\n# x\n1,0,0,0,0,0,0\n1,0,0,0,0,0,0", 6, "time 1 s after 1 s, expected it to increase"),
    (HEADER + "2,0,0,0,0,0,0\n1,0,0,0,0,0,0", 4, "time 1 s after 2 s"),
    (HEADER, 2, "1 samples, expected at least 2"),
    ("t,x,y,z,roll,pitch,yaw\n", 1, "0 samples, expected at least 2"),
    ("", 1, "the file is empty, expected a header t,x,y,z,roll,pitch,yaw"),
    ("# only\n", 1, "the file is empty"),
    ("0,0,0,0,0,0,0\n1,0,0,0,0,0,0\n", 1, "numbers where the header should be, expected t,x,y,z"),
    ("time,x,y,z,roll,pitch,yaw\n", 1, "unknown column 'time', expected t,x,y,z,roll,pitch,yaw"),
    ("t,x,y,z,roll,pitch\n", 1, "columns t,x,y,z,roll,pitch, expected"),
    ("t,x,y,z,roll,pitch,yaw,vx,vy,vz,wx,wy,wz\n", 1, "expected t,x,y,z,roll"),
    ("t,x,x,z,roll,pitch,yaw\n", 1, "column 'x' is there twice"),
    ("t;x;y;z\n", 1, "unknown column"),
    (QUATERNION + "0,0,0,0,0,0,0,1\n1,0,0,0,0,0,0,1.01", 3, "quaternion of length 1.01, expected 1"),
    (QUATERNION + "0,0,0,0,0,0,0,0\n1,0,0,0,0,0,0,1", 2, "quaternion of length 0"),
])
def test_bad_csv_is_refused_with_file_and_line(tmp_path, text, line, message):
    path = tmp_path / "m.csv"
    path.write_text(text)
    with pytest.raises(ValueError) as raised:
        load_motion(path)
    assert str(raised.value).startswith(f"{path}:{line}: ") and message in str(raised.value)


def test_a_quaternion_that_is_nearly_unit_is_normalised(tmp_path):
    path = tmp_path / "m.csv"
    path.write_text(QUATERNION + "0,0,0,0,0,0,0,1.0005\n1,0,0,0,0,0,0,1")
    assert load_motion(path).poses[0, 6] == 1.0


def test_bytes_that_are_no_text_are_refused(tmp_path):
    path = tmp_path / "m.csv"
    for content in (HEADER.encode() + b"\xff\xfe\n", b"t\0,x\n"):
        path.write_bytes(content)
        with pytest.raises(ValueError, match=r"m\.csv:\d: not text"):
            load_motion(path)
    with pytest.raises(FileNotFoundError):
        load_motion(tmp_path / "missing.csv")
    path.write_text(HEADER)
    with pytest.raises(ValueError, match="expected an MCAP file"):
        load_motion(path, topic="/a")


# --- MCAP ---


def test_odometry_gives_its_twist_in_world_axes(tmp_path):
    messages = [("/floater/odom", ODOMETRY, odometry(*row), row[0]) for row in zip(STAMPS, POSES, CHILD)]
    for path in (write(tmp_path / "m.mcap", messages), write(tmp_path / "bag", messages)):
        motion = load_motion(path)
        assert np.abs(motion.poses - POSES).max() < 1e-15 and np.array_equal(motion.stamps, STAMPS)
        assert np.abs(motion.twists - WORLD).max() < 1e-12 and np.abs(motion.times - TIMES).max() < 1e-12
        assert motion.source == "/floater/odom" and motion.remarks == ()
    foreign_motion = load_motion(foreign(tmp_path / "m.mcap"))
    assert np.array_equal(foreign_motion.twists, motion.twists) and foreign_motion.parameters is None


def test_times_of_a_wall_clock_count_from_the_first_sample(tmp_path):
    path = write(tmp_path / "m.mcap", [("/odom", ODOMETRY, odometry(EPOCH + stamp, *row), EPOCH)
                                       for stamp, *row in zip(STAMPS, POSES, CHILD)])
    motion = load_motion(path)
    assert motion.start_ns == EPOCH and motion.times[0] == 0.0 and np.abs(motion.times - TIMES).max() < 1e-12


def test_an_odometry_whose_twist_is_in_world_axes_is_refused(tmp_path):
    path = write(tmp_path / "m.mcap", [("/odom", ODOMETRY, odometry(*row), row[0]) for row in zip(STAMPS, POSES, WORLD)])
    with pytest.raises(ValueError, match="does not move the pose, expected it in the platform's axes"):
        load_motion(path)


def test_recorded_parameters_say_how_the_input_is_meant(tmp_path):
    path = write(tmp_path / "m.mcap", [("/odom", ODOMETRY, odometry(*row), row[0]) for row in zip(STAMPS, POSES, WORLD)],
                 {"twist_frame": "world"})
    motion = load_motion(path)
    assert np.array_equal(motion.twists, WORLD) and "twist_frame: world" in motion.remarks[0]


def test_an_odometry_without_twist_is_differentiated_and_said(tmp_path):
    path = write(tmp_path / "m.mcap", [("/odom", ODOMETRY, odometry(stamp, pose, np.zeros(6)), stamp) for stamp, pose in zip(STAMPS, POSES)])
    motion = load_motion(path)
    assert np.abs(motion.twists - WORLD).max() < 1e-4 and "twist is zero though the pose moves" in motion.remarks[0]


def pairs(twist_stamps=STAMPS, twists=WORLD, frame="world"):
    return ([("/tank/pose", POSE, pose_stamped(*row), row[0]) for row in zip(STAMPS, POSES)]
            + [("/tank/twist", TWIST, twist_stamped(*row, frame), row[0]) for row in zip(twist_stamps, twists)])


def test_pose_and_twist_of_the_same_stamps_go_together(tmp_path):
    motion = load_motion(write(tmp_path / "m.mcap", pairs()))
    assert np.abs(motion.poses - POSES).max() < 1e-15 and np.array_equal(motion.twists, WORLD) and motion.remarks == ()


def test_a_twist_in_the_platforms_frame_is_turned_into_world_axes(tmp_path):
    motion = load_motion(foreign(write(tmp_path / "m.mcap", pairs(twists=CHILD, frame="platform"))))
    assert np.abs(motion.twists - WORLD).max() < 1e-12


def test_twists_of_other_stamps_are_interpolated_and_said(tmp_path):
    times = np.arange(0.52, 19.5, 0.05)
    motion = load_motion(write(tmp_path / "m.mcap", pairs(np.rint(times * 1e9).astype(np.int64), swing(times)[1])))
    rows = np.searchsorted(STAMPS, motion.stamps)
    assert (TIMES[rows[0]], TIMES[rows[-1]]) == (pytest.approx(0.6), pytest.approx(19.4))
    assert np.abs(motion.poses - POSES[rows]).max() < 1e-15 and np.abs(motion.twists - WORLD[rows]).max() < 1e-3
    assert "interpolated linearly" in motion.remarks[0] and "11 poses before" in motion.remarks[1]


def test_poses_alone_are_differentiated(tmp_path):
    motion = load_motion(write(tmp_path / "m.mcap", pairs()[:len(TIMES)]))
    assert np.abs(motion.twists - WORLD).max() < 1e-4 and "differentiated" in motion.source


def test_several_candidates_are_listed_and_chosen_by_topic(tmp_path):
    messages = [("/odom", ODOMETRY, odometry(*row), row[0]) for row in zip(STAMPS, POSES, CHILD)] + pairs()
    messages += [("/other/twist", TWIST, twist_stamped(*row), row[0]) for row in zip(STAMPS, WORLD * 0)]
    path = write(tmp_path / "m.mcap", messages)
    with pytest.raises(ValueError, match=r"several topics .*--topic NAME.*/odom \(Odometry\), .*/tank/pose \(PoseStamped\)"):
        load_motion(path)
    assert load_motion(path, "/odom").source == "/odom"
    assert load_motion(path, "/tank/pose").source == "/tank/pose and /tank/twist"
    assert "twist is zero" in load_motion(path, "/tank/pose,/other/twist").remarks[0]
    for wrong in ("/nothing", "/tank/twist", "/odom,/tank/twist", "/tank/pose,/odom", "a,b,c"):
        with pytest.raises(ValueError, match="it has /odom"):
            load_motion(path, wrong)


def test_a_file_without_motion_says_what_it_has(tmp_path):
    with pytest.raises(ValueError, match=r"no topic is a motion, .*/note \(String\)"):
        load_motion(write(tmp_path / "m.mcap", [("/note", "std_msgs/msg/String", String(), 0)]))
    with pytest.raises(ValueError, match="no messages"):
        load_motion(write(tmp_path / "n.mcap", []))


def odometry_rows(stamps, poses=POSES):
    return [("/odom", ODOMETRY, odometry(stamp, pose, twist), 5 + number)
            for number, (stamp, pose, twist) in enumerate(zip(stamps, poses, CHILD))]


@pytest.mark.parametrize("stamps, message", [
    ([1, 2, 4, 3], r"message 4: stamp 0.000000003 s runs backwards"),
    ([1, 2, 2, 3], "message 3: stamp 0.000000002 s comes again with other content"),
    ([0, 0, 5, 6], "2 of 4 header stamps are zero, expected all or none"),
    ([0, EPOCH, EPOCH + 1], "1 of 3 header stamps are zero"),
    ([7], "1 samples, expected at least 2"),
])
def test_bad_stamps_are_refused(tmp_path, stamps, message):
    with pytest.raises(ValueError, match=message):
        load_motion(write(tmp_path / "m.mcap", odometry_rows(stamps)))


def test_stamps_that_are_all_zero_give_way_to_the_log_times(tmp_path):
    motion = load_motion(write(tmp_path / "m.mcap", odometry_rows([0, 0, 0])))
    assert motion.stamps.tolist() == [5, 6, 7] and "every header stamp is zero" in motion.remarks[0]


def test_a_message_that_came_twice_counts_once(tmp_path):
    rows = odometry_rows([1, 2, 3])
    motion = load_motion(write(tmp_path / "m.mcap", [rows[0], rows[1], rows[1], rows[2]]))
    assert motion.stamps.tolist() == [1, 2, 3] and "came twice" in motion.remarks[0]


def test_numbers_that_are_none_are_refused_with_the_message(tmp_path):
    bad = POSES.copy()
    bad[2, 1] = np.nan
    with pytest.raises(ValueError, match="topic /odom: message 3: a number that is not finite"):
        load_motion(write(tmp_path / "m.mcap", odometry_rows(STAMPS, bad)))
    bad = POSES.copy()
    bad[4, 3:] *= 1.1
    with pytest.raises(ValueError, match=r"topic /odom: sample 5: quaternion of length 1\.1"):
        load_motion(write(tmp_path / "n.mcap", odometry_rows(STAMPS, bad)))


def test_a_message_that_is_cut_short_is_refused(tmp_path):
    with RecordingWriter(tmp_path / "m.mcap", {}) as writer:
        writer.write("/odom", ODOMETRY, b"\0\1\0\0\1\0\0\0", 0)
    with pytest.raises(ValueError, match="/odom: message 1: .* no Odometry"):
        load_motion(tmp_path / "m.mcap")


# --- recordings of the node ---


def node_recording(path, leave_out=None):
    messages = [("/platform/odom", ODOMETRY, odometry(*row), row[0]) for row in zip(STAMPS, POSES, CHILD)]
    records = [schedule.encode_settle(0.0, POSES[0])] + [schedule.encode_step(*row) for row in zip(TIMES[1:], POSES[1:], WORLD[1:])]
    records.insert(50, schedule.encode_release(TIMES[49], 1))
    with RecordingWriter(path, {"dt": 0.01, "scene": "chain.txt"}, AttachedScene("chain.txt", "SCENE")) as writer:
        for topic, type_name, message, log_time in messages:
            writer.write(topic, type_name, serialize_message(message), log_time)
        for number, record in enumerate(records):
            if number == leave_out:
                writer._given["/ns/mooring/steps"] += 1         # as when the queue was full
                continue
            stamp = 1000 + round(record[1] * 1e9)
            writer.write("/ns/mooring/steps", schedule.TYPE_NAME, serialize_message(Float64MultiArray(data=record)), stamp)
    return path


def test_a_recording_of_the_node_gives_its_schedule_bit_for_bit(tmp_path):
    motion = load_motion(node_recording(tmp_path / "run"))
    assert motion.source == "step schedule /ns/mooring/steps"
    assert len(motion.schedule) == len(TIMES) + 1 and len(motion.schedule_stamps) == len(motion.schedule)
    assert [action.kind for action in motion.schedule[:2]] == [schedule.SETTLE, schedule.STEP]
    assert (motion.schedule[50].kind, motion.schedule[50].line) == (schedule.RELEASE, 1)
    assert motion.times.tobytes() == TIMES.tobytes() and motion.poses.tobytes() == POSES.tobytes()
    assert motion.twists[1:].tobytes() == WORLD[1:].tobytes()
    assert motion.stamps[3] == 1000 + STAMPS[3] and motion.schedule_stamps[0] == 1000
    assert motion.parameters == {"dt": 0.01, "scene": "chain.txt"} and motion.scene == ("chain.txt", "SCENE", ())


def test_a_topic_replays_the_input_of_a_recording_instead(tmp_path):
    motion = load_motion(node_recording(tmp_path / "run.mcap"), "/platform/odom")
    assert motion.schedule is None and motion.source == "/platform/odom"


def test_a_hole_in_the_schedule_is_refused(tmp_path):
    with pytest.raises(ValueError, match="1 records of the step schedule /ns/mooring/steps are missing after 20"):
        load_motion(node_recording(tmp_path / "run.mcap", leave_out=20))


def test_a_cut_recording_is_read_up_to_the_cut_and_says_so(tmp_path):
    path = node_recording(tmp_path / "run.mcap")
    path.write_bytes(path.read_bytes()[:-200])
    motion = load_motion(path)
    assert len(motion.times) == len(TIMES) and "cut off at byte" in motion.remarks[0]


def test_the_schedule_of_another_recorder_is_not_trusted(tmp_path):
    assert load_motion(foreign(node_recording(tmp_path / "run.mcap"))).source == "/platform/odom"


@pytest.mark.parametrize("platforms", ["body1", {"body1": 1}, [1, 2], 7])
def test_platforms_that_are_no_list_of_names_are_refused(tmp_path, platforms):
    with RecordingWriter(tmp_path / "m.mcap", {"platforms": platforms}) as writer:
        writer.write("/platform/odom", ODOMETRY, serialize_message(odometry(STAMPS[0], POSES[0], CHILD[0])), 0)
    with pytest.raises(ValueError, match="recorded parameter platforms is .*, expected a list of names"):
        load_motion(tmp_path / "m.mcap")


def test_a_recording_with_platforms_has_a_pose_for_each(tmp_path):
    poses = np.stack([POSES[:5], POSES[5:10]], axis=1)
    records = [schedule.encode_settle(0.0, poses[0])] + [schedule.encode_step(0.1 * k, poses[k], np.full((2, 6), 0.1 * k)) for k in range(1, 5)]
    with RecordingWriter(tmp_path / "m.mcap", {"platforms": ["body1", "body2"]}) as writer:
        for k, record in enumerate(records):
            writer.write("/mooring/steps", schedule.TYPE_NAME, serialize_message(Float64MultiArray(data=record)), k)
    motion = load_motion(tmp_path / "m.mcap")
    assert motion.platforms == ("body1", "body2") and np.array_equal(motion.poses, poses) and motion.twists.shape == (5, 2, 6)
    with RecordingWriter(tmp_path / "short.mcap", {"platforms": ["body1", "body2", "body3"]}) as writer:
        writer.write("/mooring/steps", schedule.TYPE_NAME, serialize_message(Float64MultiArray(data=records[0])), 0)
    with pytest.raises(ValueError, match="28 numbers: expected 41"):
        load_motion(tmp_path / "short.mcap")
