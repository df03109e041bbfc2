"""What the demo says while it runs, where it puts its results, and which words are refused."""

import io
import os

import pytest

from mooring_ros.demo.__main__ import main
from mooring_ros.demo.places import default_scene, make_output
from mooring_ros.demo.progress import Progress


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_elsewhere_than_on_a_terminal_there_are_a_few_plain_lines():
    stream = io.StringIO()
    progress = Progress(60.0, stream)
    for _ in range(5):
        progress.state("waiting")
    for tenths in range(601):
        progress.run(tenths / 10)
    progress.close()
    lines = stream.getvalue().splitlines()
    assert lines[0] == "waiting" and len(lines) == 5
    assert all("\r" not in line and "\x1b" not in line for line in lines)
    assert "15.0 of 60 s" in lines[1] and "60.0 of 60 s" in lines[-1]


def test_a_terminal_has_one_line_that_is_rewritten():
    stream = Terminal()
    progress = Progress(10.0, stream)
    progress.state("waiting")
    for seconds in range(11):
        progress.run(float(seconds))
    progress.close()
    assert stream.getvalue().count("\n") == 1
    assert "100 %" in stream.getvalue().split("\r")[-1]


def test_results_go_to_a_new_folder_below_the_current_one(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    first, second = make_output(), make_output()
    assert first != second and first.parent == second.parent and str(first.parent) == "out"


def test_nothing_is_overwritten(tmp_path, capsys):
    (tmp_path / "run.mcap").write_bytes(b"precious")
    assert main(["--out", str(tmp_path)]) == 2
    assert f"{tmp_path}: the folder is not empty" in capsys.readouterr().err
    assert (tmp_path / "run.mcap").read_bytes() == b"precious"


def test_the_default_scene_is_there():
    assert default_scene().is_file()


@pytest.mark.parametrize(
    "words, complaint",
    [
        (["--duration", "-5"], "-5"),
        (["--duration", "nan"], "nan"),
        (["--rate", "0"], "'0'"),
        (["--seed", "-1"], "whole number"),
        (["--wave-height", "tall"], "tall"),
        (["--no-such-thing"], "--no-such-thing"),
    ],
)
def test_wrong_words_end_with_status_2_and_one_line(words, complaint, capsys):
    with pytest.raises(SystemExit) as stop:
        main(words)
    error = capsys.readouterr().err
    assert stop.value.code == 2 and complaint in error and error.count("\n") == 1


def test_a_wrong_scene_ends_with_status_2_and_names_the_line(tmp_path, capsys):
    scene = tmp_path / "scene.txt"
    scene.write_text(default_scene().read_text().replace("main      2         1         850.0", "main      2         1         -850.0"))
    assert main(["--scene", str(scene), "--out", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"{scene}:") and "-850" in error and error.count("\n") == 1
    assert not os.path.exists(tmp_path / "out")
