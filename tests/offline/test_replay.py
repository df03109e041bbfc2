"""`mooring replay`: the same bits as the façade by hand, files of the contract, and clean ends of every kind."""

import csv
import os
import re
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from motion_files import write_motion

from mooring_ros.mooring import Mooring, MooringError
from mooring_ros.offline.history import load_history
from mooring_ros.offline.motion_file import load_motion
from mooring_ros.offline.resample import resample
from mooring_ros.recording.reader import Recording

WRENCH = ["wrench.fx", "wrench.fy", "wrench.fz", "wrench.mx", "wrench.my", "wrench.mz"]


def table(path):
    """Header and rows (n, columns) of a CSV file."""
    with open(path, newline="") as file:
        header, *rows = csv.reader(file)
    return header, np.array(rows, dtype=float)


def by_hand(scene, times, poses, twists, **options):
    """Rows as in the CSV output, from the façade."""
    moored = Mooring(scene, **options)
    rows = []
    for row, instant in enumerate(times):
        moored.settle(poses[0], time=instant) if row == 0 else moored.step(instant, poses[row], twists[row])
        tensions = np.column_stack((moored.fairlead_tension, moored.anchor_tension)).ravel()
        rows.append([instant, *tensions, *moored.wrench])
    return np.array(rows)


def test_a_csv_motion_gives_the_bits_of_the_facade_stepped_by_hand(scene, motion, mooring, tmp_path):
    outcome = mooring("replay", scene, motion, "-o", tmp_path / "out.mcap", "--csv", tmp_path / "out.csv")
    assert outcome.status == 0, outcome.err
    header, rows = table(tmp_path / "out.csv")
    assert header == ["time", "line1.fairlead_tension", "line1.anchor_tension", "line2.fairlead_tension", "line2.anchor_tension", *WRENCH]
    given = load_motion(motion)
    assert np.array_equal(rows, by_hand(scene, given.times, given.poses, given.twists))


def test_the_recording_has_the_topics_of_the_node_and_the_stamps_of_the_source(scene, motion, mooring, tmp_path):
    assert mooring("replay", scene, motion, "-o", tmp_path / "out.mcap").status == 0
    recording = Recording(tmp_path / "out.mcap")
    kinds = {topic: kind.split("/")[-1] for topic, (kind, _) in recording.topics().items()}
    assert kinds == {
        "/mooring/wrench": "WrenchStamped",
        "/mooring/fairleads/point3/wrench": "WrenchStamped",
        "/mooring/fairleads/point4/wrench": "WrenchStamped",
        "/mooring/lines": "JointState",
        "/mooring/line_tensions": "Float64MultiArray",
        "/mooring/steps": "Float64MultiArray",
        "/platform/odom": "Odometry",
    }
    stamps = [entry.log_time for entry in recording.messages(["/mooring/wrench"])]
    assert stamps == [round(instant * 1e9) for instant in load_motion(motion).times]
    assert recording.scene == ("scene.txt", scene.read_text(), ())


def test_the_csv_and_the_recording_hold_the_same_bits(scene, motion, mooring, tmp_path):
    mooring("replay", scene, motion, "-o", tmp_path / "out.mcap", "--csv", tmp_path / "out.csv")
    header, rows = table(tmp_path / "out.csv")
    history = load_history(tmp_path / "out.mcap")
    for name, column in zip(header[1:], rows.T[1:]):
        assert np.array_equal(history.series[name], column)


def test_a_replay_replays_bit_for_bit_and_says_so(scene, motion, mooring, tmp_path):
    mooring("replay", scene, motion, "-o", tmp_path / "one.mcap", "--csv", tmp_path / "one.csv", "--segments", "5")
    found = mooring("replay", scene, tmp_path / "one.mcap", "-o", tmp_path / "two.mcap", "--csv", tmp_path / "two.csv", "--json")
    assert found.status == 0 and found.err == ""
    assert found.json()["identical"] == {"same": 61, "total": 61} and found.json()["scene_is_recorded"] is True
    assert (tmp_path / "one.csv").read_bytes() == (tmp_path / "two.csv").read_bytes()
    text = mooring("replay", scene, tmp_path / "one.mcap", "-o", tmp_path / "two.mcap").out
    assert "identical: 61 of 61" in text


def test_other_settings_than_the_recorded_ones_are_named_and_show_as_not_identical(scene, motion, mooring, tmp_path):
    mooring("replay", scene, motion, "-o", tmp_path / "one.mcap")
    outcome = mooring("replay", scene, tmp_path / "one.mcap", "-o", tmp_path / "two.mcap", "--segments", "5", "--json")
    assert outcome.status == 0 and "the tensions will differ" in outcome.err
    assert outcome.json()["identical"]["same"] < 61


def test_another_scene_than_the_recorded_one_is_named(scene, motion, mooring, tmp_path):
    mooring("replay", scene, motion, "-o", tmp_path / "one.mcap")
    scene.write_text(scene.read_text().replace("2.0e7", "3.0e7"))
    outcome = mooring("replay", scene, tmp_path / "one.mcap", "-o", tmp_path / "two.mcap", "--json")
    assert outcome.status == 0 and "differs from the scene in the recording" in outcome.err
    assert outcome.json()["scene_is_recorded"] is False and outcome.json()["identical"]["same"] < 61


def test_a_release_in_the_schedule_is_replayed(scene, motion, mooring, tmp_path):
    from mooring_ros.offline.replay_run import run_schedule
    from mooring_ros.recording import schedule

    given = load_motion(motion)
    actions = [schedule.Action(schedule.SETTLE, 0.0, pose=given.poses[0]), schedule.Action(schedule.RELEASE, 0.0, line=1)]
    actions += [schedule.Action(schedule.STEP, given.times[row], pose=given.poses[row], twist=given.twists[row]) for row in range(1, 10)]
    replayed, by_hand = Mooring(scene), Mooring(scene)
    kinds = [done.kind for done in run_schedule(replayed, actions, list(range(len(actions))), 1.0)]
    by_hand.settle(given.poses[0])
    by_hand.release("line2")
    for row in range(1, 10):
        by_hand.step(given.times[row], given.poses[row], given.twists[row])
    assert kinds == [schedule.SETTLE, schedule.RELEASE] + 9 * [schedule.STEP]
    assert np.array_equal(replayed.wrench, by_hand.wrench) and np.array_equal(replayed.fairlead_tension, by_hand.fairlead_tension)


def test_a_rate_steps_at_its_multiples_with_the_resampled_motion(scene, motion, mooring, tmp_path):
    assert mooring("replay", scene, motion, "-o", tmp_path / "out.mcap", "--csv", tmp_path / "out.csv", "--rate", "25").status == 0
    _, rows = table(tmp_path / "out.csv")
    given = load_motion(motion)
    assert np.allclose(rows[:, 0], np.arange(151) / 25.0, rtol=0.0, atol=1e-12)
    assert np.array_equal(rows, by_hand(scene, *resample(given.times, given.poses, given.twists, 25.0)))


def test_the_rate_of_the_source_changes_nothing(scene, motion, mooring, tmp_path):
    for name, words in (("a", []), ("b", ["--rate", "10"])):
        assert mooring("replay", scene, motion, "-o", tmp_path / f"{name}.mcap", "--csv", tmp_path / f"{name}.csv", *words).status == 0
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()


def test_a_rate_on_the_nodes_own_recording_asks_for_a_topic(scene, motion, mooring, tmp_path):
    mooring("replay", scene, motion, "-o", tmp_path / "one.mcap")
    refused = mooring("replay", scene, tmp_path / "one.mcap", "-o", tmp_path / "two.mcap", "--rate", "25")
    assert refused.status == 2 and "--topic NAME" in refused.err
    taken = mooring("replay", scene, tmp_path / "one.mcap", "-o", tmp_path / "two.mcap", "--rate", "25", "--topic", "/platform/odom", "--json")
    assert taken.status == 0 and taken.json()["answers"] == 151


def test_resampling_follows_a_cubic_exactly():
    times = np.array([0.0, 0.5, 1.3, 2.0])
    poses, twists = np.zeros((4, 7)), np.zeros((4, 6))
    poses[:, 0], twists[:, 0] = 1.0 + 2.0 * times - times**3, 2.0 - 3.0 * times**2
    poses[:, 5], poses[:, 6] = np.sin(0.2 * times), np.cos(0.2 * times)  # 0.4 rad/s about z
    twists[:, 5] = 0.4
    new_times, new_poses, new_twists = resample(times, poses, twists, 20.0)
    assert len(new_times) == 41
    assert new_poses[:, 0] == pytest.approx(1.0 + 2.0 * new_times - new_times**3, abs=1e-13)
    assert new_twists[:, 0] == pytest.approx(2.0 - 3.0 * new_times**2, abs=1e-12)
    assert new_poses[:, 5] == pytest.approx(np.sin(0.2 * new_times), abs=1e-14)
    assert new_twists[:, 5] == pytest.approx(0.4, abs=1e-13)


def test_a_step_that_cannot_be_completed_keeps_what_came_before(scene, motion, mooring, tmp_path, monkeypatch):
    step = Mooring.step

    def fails_at_three(self, t, pose, twist):
        if t > 3.0:
            raise MooringError("line1 blew up")
        step(self, t, pose, twist)

    monkeypatch.setattr(Mooring, "step", fails_at_three)
    outcome = mooring("replay", scene, motion, "-o", tmp_path / "out.mcap", "--csv", tmp_path / "out.csv")
    assert outcome.status == 1 and "after the answer at 3 s: line1 blew up" in outcome.err
    assert table(tmp_path / "out.csv")[1][-1, 0] == pytest.approx(3.0)
    assert load_history(tmp_path / "out.mcap").times[-1] == pytest.approx(3.0)
    assert sorted(path.name for path in tmp_path.glob("out.*")) == ["out.csv", "out.mcap"]


def test_ctrl_c_leaves_both_files_closed_and_readable(scene, tmp_path):
    motion = write_motion(tmp_path / "long.csv", duration=1500.0, step=0.02)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    words = ["replay", scene, motion, "-o", tmp_path / "out.mcap", "--csv", tmp_path / "out.csv"]
    running = subprocess.Popen(
        [sys.executable, "-m", "mooring_ros.offline", *map(str, words)], env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        part = tmp_path / "out.csv.part"
        deadline = time.monotonic() + 60.0
        while not (part.exists() and part.stat().st_size > 20_000):
            assert running.poll() is None and time.monotonic() < deadline
            time.sleep(0.01)
        running.send_signal(signal.SIGINT)
        out, err = running.communicate(timeout=30)
    finally:
        running.kill()
    assert running.returncode == 130 and out == "" and err == "mooring: interrupted\n"
    _, rows = table(tmp_path / "out.csv")
    history = load_history(tmp_path / "out.mcap")
    assert 0 < len(rows) < 75_000
    assert np.array_equal(history.series["line1.fairlead_tension"], rows[:, 1])
    assert Recording(tmp_path / "out.mcap").cut is None
    assert not list(tmp_path.glob("*.part*"))


def test_fidelities_line_by_line_are_replayed_and_recorded(scene, motion, mooring, tmp_path):
    words = ["--fidelity", "line1=quasi_static,default=linear"]
    assert mooring("replay", scene, motion, "-o", tmp_path / "one.mcap", "--csv", tmp_path / "one.csv", *words).status == 0
    given = load_motion(motion)
    assert np.array_equal(table(tmp_path / "one.csv")[1], by_hand(scene, given.times, given.poses, given.twists, fidelity={"line1": "quasi_static", "line2": "linear"}))
    found = mooring("replay", scene, tmp_path / "one.mcap", "-o", tmp_path / "two.mcap", "--json").json()
    assert found["identical"] == {"same": 61, "total": 61} and found["settings"]["fidelity"] == "line1=quasi_static,default=linear"
    refused = mooring("replay", scene, motion, "-o", tmp_path / "three.mcap", "--fidelity", "line9=linear")
    assert refused.status == 2 and "line9" in refused.err and "expected line1, line2" in refused.err


def test_lines_that_snap_are_told_of(scene, motion, mooring, tmp_path):
    """The platform is thrown by 20 m and back every two seconds."""
    t = np.arange(0, 81) * 0.05
    moves = np.zeros((81, 14))
    moves[:, 0], moves[:, 1], moves[:, 7] = t, 10.0 * (1.0 - np.cos(np.pi * t)), 1.0
    moves[:, 8] = 10.0 * np.pi * np.sin(np.pi * t)
    thrown = tmp_path / "thrown.csv"
    np.savetxt(thrown, moves, delimiter=",", header="t,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz", comments="")
    told = mooring("replay", scene, thrown, "-o", tmp_path / "one.mcap")
    assert told.status == 0 and re.search(r"uneven: in \d+ of 81 answers", told.out) and "lines snap taut" in told.out
    smooth = mooring("replay", scene, motion, "-o", tmp_path / "two.mcap", "--json").json()
    assert smooth["uneven"] == {"answers": 0, "first": None}


def test_accuracy_is_estimated_around_the_highest_tension(scene, motion, mooring, tmp_path):
    found = mooring("replay", scene, motion, "-o", tmp_path / "one.mcap", "--csv", tmp_path / "one.csv", "--accuracy", "--json")
    accuracy = found.json()["accuracy"]
    assert found.status == 0 and not accuracy["why"] and 0.0 < accuracy["mean"] < 10.0 and accuracy["line"] in ("line1", "line2")
    assert accuracy["begin"] == pytest.approx(2.0) and accuracy["end"] == pytest.approx(6.0)  # all of 6 s but the first third
    plain = mooring("replay", scene, motion, "-o", tmp_path / "two.mcap", "--csv", tmp_path / "two.csv", "--json")
    assert plain.json()["accuracy"] is None and (tmp_path / "one.csv").read_bytes() == (tmp_path / "two.csv").read_bytes()
    again = mooring("replay", scene, tmp_path / "one.mcap", "-o", tmp_path / "three.mcap", "--accuracy")
    assert f"within {accuracy['mean']:.2g} % in the mean" in again.out and "twice the segments" in again.out
