"""What a recorded motion is looked through for: a twist that does not move the pose, gaps, damage; and forms of CSV that programs write."""

import math

import pytest

from mooring_ros.offline.motion_file import load_motion

HEADER = "t,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz\n"
YAW = 0.6


def rows(factor=1.0, yaw=YAW, child=False, count=100, step=0.1):
    """Surge of 2 m in 10 s at a yaw, as lines of CSV; factor: of the twist; child: the twist in the platform's axes."""
    for k in range(count):
        t = k * step
        phase = 2.0 * math.pi * t / 10.0
        x, v = 2.0 * (1.0 - math.cos(phase)), factor * 0.4 * math.pi * math.sin(phase)
        vx, vy = (v * math.cos(yaw), -v * math.sin(yaw)) if child else (v, 0.0)
        yield f"{t:.3f},{x!r},0,0,0,0,{math.sin(yaw / 2)!r},{math.cos(yaw / 2)!r},{vx!r},{vy!r},0,0,0,0\n"


@pytest.fixture
def written(tmp_path):
    """`written(text)`: a path of a CSV file that holds it."""

    def write(text):
        path = tmp_path / "m.csv"
        path.write_bytes(text.encode())
        return path

    return write


def test_a_twist_in_world_axes_is_taken_without_a_word(written):
    motion = load_motion(written(HEADER + "".join(rows())))
    assert motion.source == "pose and twist" and motion.remarks == ()


def test_a_csv_twist_in_the_platforms_axes_is_refused(written):
    path = written(HEADER + "".join(rows(child=True)))
    with pytest.raises(ValueError, match="does not move the pose, expected it in the world's axes; it fits as twist_frame child in ENU") as raised:
        load_motion(path)
    assert str(raised.value).startswith(f"{path}:1: ")


@pytest.mark.parametrize("factor", [1000.0, -1.0, 180.0 / math.pi, 1e-3])
def test_a_twist_in_a_wrong_unit_is_used_and_said(written, factor):
    motion = load_motion(written(HEADER + "".join(rows(factor, yaw=0.0))))
    assert motion.source == "pose and twist" and "in no convention" in motion.remarks[0] and "wrong unit" in motion.remarks[0]


def test_twist_columns_of_zeros_are_differentiated_and_said(written):
    motion = load_motion(written(HEADER + "".join(rows(0.0))))
    assert "differentiated" in motion.source and "twist is zero though the pose moves" in motion.remarks[0]
    assert motion.twists[25, 0] == pytest.approx(0.4 * math.pi, rel=1e-3)


def test_a_gap_is_said_with_its_place(written):
    lines = list(rows())
    motion = load_motion(written(HEADER + "".join(lines[:20] + lines[50:])))
    assert len(motion.remarks) == 1 and "1 gap is longer than 10 usual steps of 0.1 s, the longest from 1.9 to 5 s" in motion.remarks[0]
    assert load_motion(written(HEADER + "".join(lines[:20] + lines[28:]))).remarks == ()


def test_lines_that_end_in_a_carriage_return_alone_count_as_lines(written):
    text = HEADER + "".join(rows())
    plain = load_motion(written(text))
    assert (load_motion(written(text.replace("\n", "\r"))).poses == plain.poses).all()
    with pytest.raises(ValueError, match=r"m\.csv:3: "):
        load_motion(written("\r".join(["t,x,y,z,roll,pitch,yaw", "0,0,0,0,0,0,0", "1,0,0,0,0,0,abc"])))


def test_cells_in_quotes_are_read(written):
    motion = load_motion(written('"t","x","y","z","roll","pitch","yaw"\n"0","1","0","0","0","0","0"\n1,2,0,0,0,0,0\n'))
    assert motion.poses[:, 0].tolist() == [1.0, 2.0]


def test_a_recording_whose_messages_are_damaged_says_so(tmp_path):
    from mcap.writer import CompressionType, Writer

    path = tmp_path / "m.mcap"
    with open(path, "wb") as file:
        writer = Writer(file, compression=CompressionType.ZSTD)
        writer.start(profile="ros2")
        channel = writer.register_channel("/odom", "cdr", writer.register_schema("nav_msgs/msg/Odometry", "ros2msg", b"float64 x\n"))
        for k in range(50):
            writer.add_message(channel, k, bytes(k % 7 for k in range(900)), k)
        writer.finish()
    broken = bytearray(path.read_bytes())
    place = broken.index(b"\x28\xb5\x2f\xfd")  # where zstd begins
    broken[place] ^= 0xFF
    path.write_bytes(broken)
    with pytest.raises(ValueError, match=r"0 samples, expected at least 2; .*damaged at byte"):
        load_motion(path)


def test_a_rate_that_would_fill_the_memory_is_refused(mooring, scene, motion, tmp_path):
    found = mooring("replay", scene, motion, "-o", tmp_path / "out.mcap", "--rate", "1e9")
    assert found.status == 2 and "--rate 1e+09: 6e+09 samples of this motion, expected at most 1e+07" in found.err
    assert not (tmp_path / "out.mcap").exists()
