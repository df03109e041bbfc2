"""Recordings and scenes of strangers: nothing outside is read or written, and nothing is executed."""
import os
import struct
import subprocess
import sys
from pathlib import Path

import pytest
from graph import ROOT
from mcap.writer import Writer
from mcap.well_known import Profile
from test_folders import SCENE

from mooring_ros.recording import schedule
from mooring_ros.recording.attached import OTHER_MEDIA_TYPE, SCENE_MEDIA_TYPE
from mooring_ros.recording.recover import recover
from mooring_ros.recording.schema import schema_text
from mooring_ros.scene import SceneError, parse_scene

SECRET = "secret words"


@pytest.fixture
def places(tmp_path):
    """A folder to work in, and a file beside it that is none of anybody's business."""
    (tmp_path / "work").mkdir()
    (tmp_path / "depths.txt").write_text(SECRET + "\n")
    return tmp_path


def files_of(folder):
    return {path.relative_to(folder): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def hostile_recording(path, scene, attachments, encode=None):
    """A recording of one settle and ten steps, whose names of attachments, topics and metadata lead out of its folder."""
    with open(path, "wb") as stream:
        writer = Writer(stream)
        writer.start(profile=Profile.ROS2)
        writer.add_metadata("mooring_ros", {"recording.path": '"../../evil.mcap"', "scene": '"../depths.txt"',
                                            "solver": '"__import__(\'os\').system(\'id\')"'})
        writer.add_attachment(create_time=0, log_time=0, name="../../evil_scene.txt", media_type=SCENE_MEDIA_TYPE, data=scene.encode())
        for name, text in attachments:
            writer.add_attachment(create_time=0, log_time=0, name=name, media_type=OTHER_MEDIA_TYPE, data=text.encode())
        kind = writer.register_schema(schedule.TYPE_NAME, "ros2msg", schema_text(schedule.TYPE_NAME).encode())
        for topic in ("/mooring/steps", "../../../evil"):
            channel = writer.register_channel(topic, "cdr", kind, {"offered_qos_profiles": "!!python/object/apply:os.system ['touch evil_yaml']"})
            for k in range(11):
                pose = (0.01 * k, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
                record = schedule.encode_settle(0.0, pose) if k == 0 else schedule.encode_step(0.1 * k, pose, (0.1, 0.0, 0.0, 0.0, 0.0, 0.0))
                writer.add_message(channel, k * 100_000_000, (encode or cdr)(record), k * 100_000_000)
        writer.finish()


def cdr(record):
    """Float64MultiArray without a layout."""
    return b"\0\1\0\0" + struct.pack(f"<III4x{len(record)}d", 0, 0, len(record), *record)


def mooring(folder, *arguments):
    return subprocess.run([sys.executable, "-m", "mooring_ros.offline", *arguments], cwd=folder, capture_output=True, text=True, timeout=240,
                          env={**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])})


def test_a_recording_whose_scene_names_a_file_outside_is_refused_without_reading_it(places):
    hostile_recording(places / "work" / "a.mcap", SCENE.format("../depths.txt"), [])
    before = files_of(places)
    done = mooring(places / "work", "check", "a.mcap")
    assert done.returncode == 2 and "not among the recorded files" in done.stderr and SECRET not in done.stdout + done.stderr
    assert files_of(places) == before


def test_attachments_topics_and_parameters_that_lead_out_write_nothing_outside_and_run_nothing(places):
    hostile_recording(places / "work" / "a.mcap", SCENE.format("60 WtrDpth").replace(" SeafloorFile", ""),
                      [("../depths.txt", "60\n"), ("/etc/evil.txt", "x"), ("../../evil.txt", "x")])
    before = files_of(places)
    for arguments in (["check", "a.mcap"], ["replay", "a.mcap", "a.mcap", "-o", "out.mcap"], ["recover", "a.mcap", "-o", "whole.mcap"],
                      ["recover", "a.mcap", "-o", "whole"]):
        done = mooring(places / "work", *arguments)
        assert done.returncode in (0, 1, 2) and "Traceback" not in done.stderr, done.stderr
        assert "uid=" not in done.stdout + done.stderr and SECRET not in done.stdout + done.stderr
    after = files_of(places)
    expected = {Path("work") / name for name in ("out.mcap", "whole.mcap", "whole/whole_0.mcap", "whole/metadata.yaml")}
    assert set(after) - set(before) <= expected and Path("work/whole.mcap") in after
    assert {name: after[name] for name in before} == before
    assert not Path("/etc/evil.txt").exists()


def test_metadata_of_a_bag_that_names_files_outside_reads_none_of_them(places):
    bag = places / "work" / "bag"
    bag.mkdir()
    hostile_recording(bag / "bag_0.mcap", SCENE.format("60 WtrDpth"), [])
    hostile_recording(places / "bag_1.mcap", SCENE.format("60 WtrDpth"), [])
    (bag / "metadata.yaml").write_text("rosbag2_bagfile_information:\n  storage_identifier: mcap\n"
                                       "  relative_file_paths: [bag_0.mcap, ../../bag_1.mcap]\n")
    with pytest.raises(ValueError, match="bag_1.mcap.*not there"):
        recover(bag, places / "work" / "out.mcap")
    assert not (places / "work" / "out.mcap").exists()


def test_bytes_that_are_no_message_end_a_replay_with_a_line_that_names_them(places):
    path = places / "work" / "a.mcap"
    hostile_recording(path, SCENE.format("60 WtrDpth").replace(" SeafloorFile", ""), [], lambda record: b"\0\1\0\0" + b"\xff" * 40)
    done = mooring(places / "work", "replay", "a.mcap", "a.mcap", "-o", "out.mcap")
    # The DDS library has words of its own on standard error.
    assert done.returncode == 2 and done.stderr.splitlines()[-1] == "a.mcap: topic /mooring/steps: 44 bytes are no Float64MultiArray"
    assert "Traceback" not in done.stderr
    assert not (places / "work" / "out.mcap").exists()


@pytest.mark.parametrize("identifier", ["../x", "1;id", "$(id)", "~/a", "1/release", "-1", "1e99"])
def test_a_line_whose_number_is_none_names_no_topic(identifier):
    text = SCENE.format("60 WtrDpth").replace(" SeafloorFile", "").replace("1  chain  1  2", f"{identifier}  chain  1  2")
    with pytest.raises(SceneError, match="scene:14: "):
        parse_scene(text)
