import pytest
from geometry_msgs.msg import WrenchStamped
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, MultiArrayDimension, String

from mooring_ros.offline.history import load_history
from mooring_ros.recording.writer import RecordingWriter

FLOATS, JOINTS, WRENCH = "std_msgs/msg/Float64MultiArray", "sensor_msgs/msg/JointState", "geometry_msgs/msg/WrenchStamped"
EPOCH = 1_700_000_000_000_000_000


def test_csv_gives_time_and_named_series(tmp_path):
    path = tmp_path / "h.csv"
    path.write_bytes(b"# measured\r\ntime,line1.fairlead_tension,wrench.fx\r\n0,1,-2\r\n0.5,3,-4\r\n")
    history = load_history(path)
    assert history.times.tolist() == [0, 0.5]
    assert {name: values.tolist() for name, values in history.series.items()} == {"line1.fairlead_tension": [1, 3], "wrench.fx": [-2, -4]}


def test_a_moordyn_table_with_units_is_read(tmp_path):
    path = tmp_path / "Lines.out"
    path.write_text("Time  FairTen1\tAnchTen1\n (s)  (N)  (N)\n 0.0  1.0E+06 2e5\n 0.1\t1.1E+06 2e5\n")
    history = load_history(path)
    assert history.times.tolist() == [0, 0.1] and history.series["FairTen1"].tolist() == [1e6, 1.1e6]


def test_rows_of_the_same_time_count_once_and_are_said(tmp_path):
    path = tmp_path / "h.csv"
    path.write_text("time,a\n0,1\n0,2\n1,3\n")
    history = load_history(path)
    assert history.series["a"].tolist() == [2, 3] and "1 rows" in history.remarks[0]


@pytest.mark.parametrize("text, line, message", [
    ("time,a\n0,1\n-1,2\n", 3, "time -1 s after 0 s, expected it to increase"),
    ("time,a\n0,1\n1,x\n", 3, "'x' in column 'a', expected a number"),
    ("time,a\n0,1\n1,inf\n", 3, "expected a finite number"),
    ("time,a\n0,1\n1,2,3\n", 3, "3 columns, expected 2"),
    ("time,a\n0,1\n", 2, "1 samples, expected at least 2"),
    ("time,a\n0,1\n0,1\n", 3, "expected at least 2 times"),
    ("time,a\n", 1, "0 samples"),
    ("time\n0\n", 1, "no column beside the time"),
    ("tension,a\n", 1, "the first column is 'tension', expected time,NAME"),
    ("time,a,a\n", 1, "column 'a' is there twice"),
    ("0,1\n1,2\n", 1, "numbers where the header should be"),
    ("", 1, "the file is empty"),
])
def test_bad_tables_are_refused_with_file_and_line(tmp_path, text, line, message):
    path = tmp_path / "h.csv"
    path.write_text(text)
    with pytest.raises(ValueError) as raised:
        load_history(path)
    assert str(raised.value).startswith(f"{path}:{line}: ") and message in str(raised.value)


def tensions(values):
    message = Float64MultiArray(data=[float(value) for value in values])
    message.layout.dim = [MultiArrayDimension(label="line", size=len(values) // 2), MultiArrayDimension(label="end", size=2)]
    return message


def wrench(stamp, force):
    message = WrenchStamped()
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 1_000_000_000)
    message.wrench.force.x = float(force)
    return message


def run(path, node="/mooring", start=0, count=5, wrench_every=1, names=("line1", "line2"), spoil=None, parameters=None):
    with RecordingWriter(path, parameters or {}) as writer:
        def put(topic, type_name, message, stamp):
            writer.write(topic, type_name, serialize_message(message), stamp)
        for number in range(count):
            stamp = start + number * 500_000_000
            put(f"{node}/lines", JOINTS, JointState(name=list(names), position=[1.0], velocity=[1.0], effort=[1.0]), stamp)
            put(f"{node}/line_tensions", FLOATS, spoil if spoil and number == 2 else tensions([number, 10 + number, 20 + number, 30 + number]), stamp)
            if number % wrench_every == 0:
                put(f"{node}/wrench", WRENCH, wrench(stamp, 100 * number), stamp)
                put(f"{node}/fairleads/point4/wrench", WRENCH, wrench(stamp, -number), stamp)
    return path


@pytest.mark.parametrize("node", ["/mooring", "/tank/floater/my_mooring"])
def test_a_recording_gives_tensions_and_wrenches_whatever_the_nodes_name(tmp_path, node):
    history = load_history(run(tmp_path / "run", node))
    assert history.times.tolist() == [0, 0.5, 1, 1.5, 2] and history.remarks == ()
    assert history.series["line1.anchor_tension"].tolist() == [0, 1, 2, 3, 4]
    assert history.series["line1.fairlead_tension"].tolist() == [10, 11, 12, 13, 14]
    assert history.series["line2.anchor_tension"].tolist() == [20, 21, 22, 23, 24]
    assert history.series["line2.fairlead_tension"].tolist() == [30, 31, 32, 33, 34]
    assert history.series["wrench.fx"].tolist() == [0, 100, 200, 300, 400]
    assert history.series["point4.fx"].tolist() == [0, -1, -2, -3, -4]
    assert len(history.series) == 4 + 12


def test_times_of_a_wall_clock_count_from_the_first_sample(tmp_path):
    assert load_history(run(tmp_path / "run.mcap", start=EPOCH)).times.tolist() == [0, 0.5, 1, 1.5, 2]


def test_wrenches_of_other_stamps_are_interpolated_and_said(tmp_path):
    history = load_history(run(tmp_path / "run.mcap", wrench_every=2))
    assert history.series["wrench.fx"].tolist() == [0, 100, 200, 300, 400]
    assert "interpolated linearly" in history.remarks[0]


def test_a_cut_recording_is_read_up_to_the_cut_and_says_so(tmp_path):
    path = run(tmp_path / "run.mcap")
    path.write_bytes(path.read_bytes()[:-50])
    history = load_history(path)
    assert len(history.times) == 5 and "cut off" in history.remarks[0]


@pytest.mark.parametrize("options, message", [
    ({"spoil": Float64MultiArray(data=[1.0])}, r"layout \[\], expected \[line\]\[end\]"),
    ({"spoil": tensions([1, 2])}, "message 3 has 2 numbers, expected 4"),
    ({"spoil": tensions([1, 2, float("nan"), 4])}, "message 3: a number that is not finite"),
    ({"names": ("line1", "line1")}, "expected one for each line"),
    ({"count": 1}, "1 samples, expected at least 2"),
])
def test_bad_recordings_are_refused(tmp_path, options, message):
    with pytest.raises(ValueError, match=message):
        load_history(run(tmp_path / "run.mcap", **options))


def test_a_recording_without_tensions_says_what_it_has(tmp_path):
    with RecordingWriter(tmp_path / "x.mcap", {}) as writer:
        writer.write("/note", "std_msgs/msg/String", serialize_message(String(data="a")), 0)
    with pytest.raises(ValueError, match="0 topics end in /line_tensions .*it has /note"):
        load_history(tmp_path / "x.mcap")


def test_recordings_of_different_scales_are_not_compared(tmp_path, mooring):
    model = run(tmp_path / "model.mcap", parameters={"scale": 50.0, "density_ratio": 1.025})
    full = run(tmp_path / "full.mcap", parameters={"scale": 1.0, "density_ratio": 1.0})
    history = load_history(model)
    assert history.scale.startswith("model scale 1:50") and "forces and times are at model scale 1:50" in history.remarks[0]
    assert load_history(full).scale == "full scale" and not load_history(full).remarks
    outcome = mooring("validate", model, full)
    assert outcome.status == 2 and "expected two recordings at the same scale" in outcome.err
    assert mooring("validate", model, model).status == 0


@pytest.mark.parametrize("unit, factor", [("N", 1.0), ("kN", 1e3), ("MN", 1e6), ("kN-m", 1e3), ("kN m", 1e3), ("m", 1.0), ("-", 1.0)])
def test_forces_in_other_units_become_newtons(tmp_path, unit, factor):
    path = tmp_path / "h.csv"
    path.write_text(f"time,line1.fairlead_tension,other\n(s),({unit}),(N)\n0,1.5,2\n1,2.5,3\n")
    history = load_history(path)
    assert history.series["line1.fairlead_tension"].tolist() == [1.5 * factor, 2.5 * factor]
    assert history.series["other"].tolist() == [2.0, 3.0] and history.times.tolist() == [0.0, 1.0]
    assert ("turned into N" in "".join(history.remarks)) == (factor != 1.0)


@pytest.mark.parametrize("units, words", [("(ms),(N)", "column 'time' is in (ms), expected (s)"), ("(s),(kip)", "column 'a' is in (kip), expected (N), (kN) or (MN)")])
def test_units_that_are_not_known_are_refused(tmp_path, units, words):
    path = tmp_path / "h.csv"
    path.write_text(f"time,a\n{units}\n0,1\n1,2\n")
    with pytest.raises(ValueError) as raised:
        load_history(path)
    assert str(raised.value) == f"{path}:2: {words}"
