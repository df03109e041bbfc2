"""The demo as a user runs it: two ROS 2 processes, a recording, a report, a replay. And its ends before the end."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from benchmarks.domains import free_domain
from mcap_ros2.reader import read_ros2_messages

ROOT = Path(__file__).resolve().parents[2]


def variables():
    path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
    return {**os.environ, "PYTHONPATH": path, "ROS_DOMAIN_ID": str(free_domain()), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


def start(folder, *words):
    command = [sys.executable, "-m", "mooring_ros.demo", "--out", str(folder), *words]
    return subprocess.Popen(command, env=variables(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def processes_that_mention(text):
    found = []
    for entry in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if text.encode() in entry.read_bytes():
                found.append(int(entry.parent.name))
        except OSError:  # gone
            pass
    return found


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    folder = tmp_path_factory.mktemp("demo") / "results"
    process = start(folder, "--duration", "3", "--ramp", "1")
    out, err = process.communicate(timeout=600)
    return process.returncode, out, err, folder


def test_it_ends_well_and_says_where_everything_is(finished):
    status, out, err, folder = finished
    assert status == 0, err
    assert str(folder / "run.mcap") in out and str(folder / "report.html") in out
    for word in ("line1", "line2", "line3", "surge", "heave", "pitch", "times real time", "lost steps: 0 of 151"):
        assert word in out
    assert "bit-identical in all 151 samples" in out


def test_the_recording_is_read_by_an_ordinary_reader_and_holds_motion_and_answers(finished):
    stamps = {"/platform/odom": [], "/mooring/wrench": [], "/mooring/lines": []}
    for message in read_ros2_messages(str(finished[3] / "run.mcap")):
        if message.channel.topic in stamps:
            stamp = message.ros_msg.header.stamp
            stamps[message.channel.topic].append(stamp.sec * 1_000_000_000 + stamp.nanosec)
    assert len(stamps["/platform/odom"]) >= 151
    assert stamps["/platform/odom"] == stamps["/mooring/wrench"] == stamps["/mooring/lines"]
    assert (np.diff(stamps["/platform/odom"]) == 20_000_000).all()


def test_the_report_stands_alone_and_has_every_part(finished):
    report = (finished[3] / "report.html").read_text(encoding="utf-8")
    for heading in ("Waves and motion", "Tensions", "Mooring wrench", "Line shapes", "Numbers of the run", "Scene"):
        assert f"<h2>{heading}</h2>" in report
    assert report.count("<svg") >= 8 and "http://" not in report and "https://" not in report
    assert "bit-identical in all 151 samples" in report


def test_no_process_is_left(finished):
    assert processes_that_mention(str(finished[3])) == []


def test_ctrl_c_leaves_a_readable_recording_and_no_process(tmp_path):
    folder = tmp_path / "results"
    process = start(folder, "--duration", "600")
    try:
        deadline = time.monotonic() + 300
        while not (folder / "run.mcap").exists() or (folder / "run.mcap").stat().st_size < 300_000:
            assert process.poll() is None and time.monotonic() < deadline
            time.sleep(0.1)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 130 and "Traceback" not in err
    assert sum(1 for _ in read_ros2_messages(str(folder / "run.mcap"))) > 100
    assert processes_that_mention(str(folder)) == []


def test_a_node_that_dies_ends_the_demo_with_the_end_of_its_log(tmp_path):
    folder = tmp_path / "results"
    process = start(folder, "--duration", "600")
    try:
        deadline = time.monotonic() + 300
        while not (folder / "run.mcap").exists() or (folder / "run.mcap").stat().st_size < 100_000:
            assert process.poll() is None and time.monotonic() < deadline
            time.sleep(0.1)
        for pid in processes_that_mention(f"recording.path:=\"{folder / 'run.mcap'}\""):
            os.kill(pid, signal.SIGKILL)
        _, err = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 1
    assert "the mooring node ended with status -9" in err and "Traceback" not in err
    assert processes_that_mention(str(folder)) == []


def test_a_setting_that_the_node_refuses_ends_with_status_2_and_its_words(tmp_path):
    process = start(tmp_path / "results", "--segments", "100001")
    _, err = process.communicate(timeout=120)
    assert process.returncode == 2 and "segments" in err and "100001" in err and "Traceback" not in err
