"""Recordings as a node writes them: another scale and other axes, a settle and a step at one stamp, a timer, releases."""

import numpy as np
import pytest
from rclpy.serialization import serialize_message
from std_msgs.msg import Float64MultiArray

from mooring_ros.mooring import Mooring
from mooring_ros.motion import Adapter
from mooring_ros.offline.history import load_history
from mooring_ros.offline.identical import Identical
from mooring_ros.recording import schedule
from mooring_ros.recording.attached import AttachedScene
from mooring_ros.recording.reader import Entry
from mooring_ros.recording.writer import RecordingWriter

TENSIONS = "/mooring/line_tensions"
KIND = "std_msgs/msg/Float64MultiArray"


def array_message(values):
    return serialize_message(Float64MultiArray(data=[float(value) for value in values]))


def entry(stamp, values):
    return Entry(TENSIONS, KIND, stamp, stamp, array_message(values))


def record(path, scene, parameters, records, stamps):
    """A node's recording with nothing but its schedule."""
    with RecordingWriter(path, parameters, AttachedScene(scene.name, scene.read_text())) as writer:
        for values, stamp in zip(records, stamps):
            writer.write("/mooring/steps", schedule.TYPE_NAME, array_message(values), stamp)


SURGE = np.array([2.0, 0.0, 0.0, 0.0, 0.0, 0.0])
POSES = np.array([[0.2 * k, 0.0, 0.0, 0.0, 0.0, np.sin(0.3), np.cos(0.3)] for k in range(6)])


def test_forces_go_out_at_the_recorded_scale_and_in_the_recorded_axes(scene, mooring, tmp_path):
    scale = {"scale": 36.0, "density_ratio": 1.025, "wrench_frame": "body", "convention": "ned"}
    adapter = Adapter(**scale)
    records = [schedule.encode_settle(0.0, POSES[0])] + [schedule.encode_step(0.6 * k, POSES[k], SURGE) for k in range(1, 6)]
    stamps = [5_000_000_000 + k * 100_000_000 for k in range(6)]  # 0.6 s at full scale is 0.1 s of the model
    record(tmp_path / "model.mcap", scene, {"fidelity": "dynamic", "dt": 0.0, "segments": 0, **scale}, records, stamps)
    outcome = mooring("replay", scene, tmp_path / "model.mcap", "-o", tmp_path / "out.mcap", "--json")
    assert outcome.status == 0, outcome.err
    assert outcome.json()["identical"] is None  # nothing to hold it against
    by_hand = Mooring(scene)
    by_hand.settle(POSES[0])
    for k in range(1, 6):
        by_hand.step(0.6 * k, POSES[k], SURGE)
    history = load_history(tmp_path / "out.mcap")
    assert history.times == pytest.approx(5.0 + 0.1 * np.arange(6))
    assert history.series["line1.fairlead_tension"][-1] == by_hand.fairlead_tension[0] * adapter.force_factor
    wrench = adapter.wrenches_out(by_hand.wrench[None], by_hand.pose)[0]
    assert [history.series[f"wrench.{axis}"][-1] for axis in ("fx", "fy", "fz", "mx", "my", "mz")] == wrench.tolist()


def test_a_release_and_a_second_settle_are_done_again_and_time_goes_on(scene, mooring, tmp_path):
    step = schedule.encode_step
    records = [
        schedule.encode_settle(0.0, POSES[0]),
        step(0.1, POSES[1], SURGE),
        schedule.encode_release(0.1, 1),
        step(0.2, POSES[2], SURGE),
        schedule.encode_settle(0.0, POSES[3]),  # the source's clock went on, the core's began anew
        step(0.1, POSES[4], SURGE),
    ]
    stamps = [stamp * 1_000_000 for stamp in (3000, 3100, 3100, 3200, 7000, 7100)]
    record(tmp_path / "run.mcap", scene, {"fidelity": "dynamic"}, records, stamps)
    outcome = mooring("replay", scene, tmp_path / "run.mcap", "-o", tmp_path / "out.mcap", "--csv", tmp_path / "out.csv")
    assert outcome.status == 0, outcome.err
    history = load_history(tmp_path / "out.csv")
    assert history.times == pytest.approx([3.0, 3.1, 3.2, 7.0, 7.1])
    by_hand = Mooring(scene)
    by_hand.settle(POSES[0])
    by_hand.step(0.1, POSES[1], SURGE)
    by_hand.release("line2")
    by_hand.step(0.2, POSES[2], SURGE)
    assert history.series["line2.anchor_tension"][2] == by_hand.anchor_tension[1]


def test_answers_at_one_stamp_are_looked_for_in_their_order():
    found = Identical([entry(1, [1.0, 2.0]), entry(1, [3.0, 4.0]), entry(2, [5.0, 6.0])])
    for stamp, anchor, fairlead in ((1, 1.0, 2.0), (1, 3.0, 4.0), (2, 5.0, 6.0)):
        found.add(stamp, np.array([anchor]), np.array([fairlead]))
    assert (found.same, found.total) == (3, 3)


def test_an_answer_that_went_out_again_counts_as_the_same():
    found = Identical([entry(1, [1.0, 2.0]), entry(1, [1.0, 2.0])])  # a timer's tick without a step
    found.add(1, np.array([1.0]), np.array([2.0]))
    assert (found.same, found.total) == (2, 2)


def test_a_difference_in_the_last_bit_is_not_identical():
    found = Identical([entry(1, [1.0, 2.0]), entry(2, [1.0, 2.0]), entry(3, [1.0, 2.0])])
    found.add(1, np.array([np.nextafter(1.0, 2.0)]), np.array([2.0]))
    found.add(2, np.array([1.0]), np.array([2.0]))
    assert (found.same, found.total) == (1, 3)


def test_a_release_of_a_line_that_the_scene_does_not_have_is_bad_input(scene, mooring, tmp_path):
    records = [schedule.encode_settle(0.0, POSES[0]), schedule.encode_release(0.0, 7)]
    record(tmp_path / "run.mcap", scene, {"fidelity": "dynamic", "dt": 0.0, "segments": 0}, records, [10**9, 10**9])
    outcome = mooring("replay", scene, tmp_path / "run.mcap", "-o", tmp_path / "out.mcap")
    assert outcome.status == 2 and "names line 8" in outcome.err and "Traceback" not in outcome.err
