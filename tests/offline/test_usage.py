"""Exit status and message for bad usage and bad input: 2, one line that says what is wrong and what was expected, no traceback."""

import os
import subprocess
import sys

import numpy as np
import pytest

from mooring_ros.offline.angles import quaternion_from_degrees
from mooring_ros.offline.arguments import pose

HISTORY = "time,line1.fairlead_tension\n0,1\n1,2\n2,1\n"


@pytest.fixture
def files(tmp_path, scene, motion):
    """Names for the table below."""
    (tmp_path / "history.csv").write_text(HISTORY)
    (tmp_path / "later.csv").write_text(HISTORY.replace("\n0,", "\n10,").replace("\n1,", "\n11,").replace("\n2,", "\n12,"))
    (tmp_path / "others.csv").write_text(HISTORY.replace("line1", "rope"))
    (tmp_path / "broken.txt").write_text(scene.read_text().replace("292  8", "-292  8"))
    (tmp_path / "backwards.csv").write_text("t,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n1,0,0,0,0,0,0\n0.5,0,0,0,0,0,0\n")
    (tmp_path / "empty.mcap").write_bytes(b"")
    return {
        "{scene}": scene,
        "{motion}": motion,
        "{dir}": tmp_path,
        "{out}": tmp_path / "out.mcap",
        "{history}": tmp_path / "history.csv",
    }


BAD = [
    ([], "required: COMMAND"),
    (["swim"], "invalid choice: 'swim'"),
    (["static"], "required: SCENE"),
    (["static", "{dir}/none.txt"], "none.txt"),
    (["static", "{dir}"], "{dir}"),
    (["static", "{dir}/broken.txt"], "broken.txt:16: "),
    (["static", "{scene}", "--pose", "1,2,3"], "'1,2,3': expected six numbers"),
    (["static", "{scene}", "--pose", "0,0,nan,0,0,0"], "'nan': expected a finite number"),
    (["static", "{scene}", "--pose", "0,0,zero,0,0,0"], "'zero': expected a finite number"),
    (["static", "{scene}", "--pos", "0,0,0,0,0,0"], "unrecognized arguments"),
    (["static", "{scene}", "--pose"], "--pose"),
    (["check", "{dir}/broken.txt", "--json"], "broken.txt:16: "),
    (["replay", "{scene}", "{motion}"], "required: -o"),
    (["replay", "{scene}", "{motion}", "-o", "{dir}/out.bag"], "expected a name that ends in .mcap"),
    (["replay", "{scene}", "{motion}", "-o", "{dir}/nowhere/out.mcap"], "nowhere does not exist, expected an existing folder"),
    (["replay", "{scene}", "{motion}", "-o", "{out}", "--csv", "{motion}"], "the output is an input as well, expected another name"),
    (["replay", "{scene}", "{motion}", "-o", "{out}", "--csv", "{out}"], "both outputs have this name, expected two names"),
    (["replay", "{scene}", "{motion}", "-o", "{out}", "--csv", "{dir}"], "is a folder, expected a file name"),
    (["replay", "{scene}", "{motion}", "-o", "{out}", "--fidelity", "perfect"], "'perfect' is not built; expected one of dynamic"),
    (["replay", "{scene}", "{motion}", "-o", "{out}", "--solver", "magic"], "'magic' is not there, expected one of auto, explicit"),
    (["replay", "{scene}", "{motion}", "-o", "{out}", "--dt", "0"], "'0': expected a positive number"),
    (["replay", "{scene}", "{motion}", "-o", "{out}", "--dt", "-0.1"], "expected a positive number"),
    (["replay", "{scene}", "{motion}", "-o", "{out}", "--rate", "nan"], "expected a finite number"),
    (["replay", "{scene}", "{motion}", "-o", "{out}", "--segments", "2.5"], "expected a whole number of at least 1"),
    (["replay", "{scene}", "{motion}", "-o", "{out}", "--segments", "0"], "expected a whole number of at least 1"),
    (["replay", "{scene}", "{motion}", "-o", "{out}", "--topic", "/odom"], "expected an MCAP file"),
    (["replay", "{scene}", "{dir}/none.csv", "-o", "{out}"], "none.csv"),
    (["replay", "{scene}", "{dir}/backwards.csv", "-o", "{out}"], "backwards.csv:4: time 0.5 s after 1 s, expected it to increase"),
    (["replay", "{scene}", "{dir}/empty.mcap", "-o", "{out}"], "empty.mcap: the file is empty"),
    (["replay", "{dir}/broken.txt", "{motion}", "-o", "{out}"], "broken.txt:16: "),
    (["validate", "{history}"], "required: REFERENCE"),
    (["validate", "{history}", "{dir}/none.csv"], "none.csv"),
    (["validate", "{history}", "{dir}/later.csv"], "no overlap in time: the result spans 0 to 2 s, the reference 10 to 12 s"),
    (["validate", "{history}", "{dir}/others.csv"], "no names in common"),
    (["validate", "{history}", "{history}", "--map", "line1"], "'line1': expected A=B"),
    (["validate", "{history}", "{history}", "--map", "line9=line1"], "the result has no 'line9'"),
    (["validate", "{history}", "{history}", "-o", "{history}"], "the output is an input as well"),
    (["validate", "{history}", "{history}", "-o", "{dir}/nowhere/report.html"], "expected an existing folder"),
    (["validate", "{scene}", "{history}"], "scene.txt"),
    (["recover", "{dir}/none.mcap", "-o", "{out}"], "none.mcap"),
]


@pytest.mark.parametrize("words,expected", BAD, ids=[" ".join(words) or "nothing" for words, _ in BAD])
def test_bad_usage_is_status_2_and_one_line_that_says_what_was_expected(words, expected, files, mooring):
    def named(text):
        for name, value in files.items():
            text = text.replace(name, str(value))
        return text

    outcome = mooring(*map(named, words))
    assert outcome.status == 2
    assert outcome.out == ""
    assert len(outcome.err.splitlines()) == 1
    assert named(expected) in outcome.err
    assert not files["{out}"].exists()


def test_bad_input_leaves_an_older_output_as_it_was(files, mooring):
    files["{out}"].write_bytes(b"older")
    assert mooring("replay", files["{scene}"], files["{dir}"] / "backwards.csv", "-o", files["{out}"]).status == 2
    assert files["{out}"].read_bytes() == b"older"


def test_help_is_status_0(mooring):
    outcome = mooring("--help")
    assert outcome.status == 0 and "validate" in outcome.out and outcome.err == ""


def process(*words, **options):
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    return subprocess.run(
        [sys.executable, "-m", "mooring_ros.offline", *map(str, words)],
        **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "env": environment, "timeout": 120, **options},
    )


def test_as_a_process_bad_input_is_status_2_without_a_traceback(files):
    done = process("static", files["{dir}"] / "broken.txt")
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.count("\n") == 1 and "broken.txt:16: " in done.stderr


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no device that is always full")
def test_as_a_process_a_full_disk_under_its_output_is_status_1_without_a_traceback(scene):
    with open("/dev/full", "w") as full:
        done = process("static", scene, stdout=full)
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1 and "No space left on device" in done.stderr


def test_as_a_process_json_is_one_object_and_nothing_else(scene):
    done = process("static", scene, "--pose", "-1,0,0,0,0,0", "--json")
    assert done.returncode == 0 and done.stderr == ""
    assert done.stdout.startswith("{") and done.stdout.endswith("}\n") and done.stdout.count("\n") == 1


def test_roll_pitch_yaw_are_about_the_fixed_axes_in_that_order():
    def turn(axis, degrees):
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        i, j = [(1, 2), (2, 0), (0, 1)][axis]
        matrix = np.eye(3)
        matrix[[i, i, j, j], [i, j, i, j]] = c, -s, s, c
        return matrix

    x, y, z, w = quaternion_from_degrees(10.0, -25.0, 70.0)
    from_quaternion = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    assert from_quaternion == pytest.approx(turn(2, 70.0) @ turn(1, -25.0) @ turn(0, 10.0), abs=1e-15)


def test_a_pose_is_metres_and_then_a_unit_quaternion():
    given = pose("1,-2,3,0,0,180")
    assert given[:3].tolist() == [1.0, -2.0, 3.0]
    assert given[3:] == pytest.approx([0.0, 0.0, 1.0, 0.0], abs=1e-15)
