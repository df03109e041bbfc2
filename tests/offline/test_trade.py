"""`mooring trade`: a small scene traded through the command line."""

import pytest
import rclpy
import yaml
from rclpy.context import Context
from rclpy.node import Node

from mooring_ros.mooring import Mooring
from mooring_ros.node import parameters
from mooring_ros.offline import trade_runner

ERROR = 4.0  # per cent that the small scene reaches in a moment


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """An empty cache and a working directory of its own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)


def test_the_setting_for_an_error_is_found_written_and_found_again_in_the_cache(scene, motion, mooring, tmp_path):
    words = ["trade", scene, motion, "--error", ERROR, "--json"]
    first = mooring(*words)
    found = first.json()
    assert first.status == 0 and found["from_cache"] < found["runs"]
    chosen = found["chosen"]
    assert chosen["errors"]["worst"] <= ERROR and chosen["errors"]["worst_line"] in ("line1", "line2") and chosen["measured"]
    cheaper = [s for s in found["settings"] if s["measured"] and not s["refused"] and s["cost"] < chosen["cost"]]
    assert all(setting["errors"]["worst"] > ERROR for setting in cheaper)
    assert {setting["fidelity"] for setting in found["settings"]} == {"dynamic", "quasi_static", "linear"}
    assert found["reference"]["error"]["dynamic"] < 0.5 * ERROR and found["reference"]["order_space"]["dynamic"] is not None

    again = mooring(*words).json()
    assert again["from_cache"] == again["runs"] == found["runs"] and again["chosen"] == chosen
    fresh = mooring(*words, "--fresh").json()
    assert fresh["from_cache"] == 0

    values = yaml.safe_load((tmp_path / "trade_parameters.yaml").read_text())["/**"]["ros__parameters"]
    assert {name: values[name] or None for name in ("fidelity", "solver", "dt", "segments")} == {
        name: fresh["chosen"][name] for name in ("fidelity", "solver", "dt", "segments")}
    assert f"--segments {fresh['chosen']['segments']}" in fresh["replay"]
    replayed = [str(tmp_path / "out.mcap") if word == "out.mcap" else word for word in fresh["replay"].split()[1:]]
    assert mooring(*replayed).status == 0


def test_the_parameter_file_configures_the_node(scene, motion, mooring, tmp_path, monkeypatch):
    assert mooring("trade", scene, motion, "--budget", 100, "--time", 5, "-o", tmp_path / "report.html").status == 0
    report = (tmp_path / "report.html").read_text()
    assert "<svg" in report and "http://" not in report and "https://" not in report and "The setting to use" in report
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF")
    context = Context()
    rclpy.init(context=context)
    node = Node("mooring", context=context, cli_args=["--ros-args", "--params-file", str(tmp_path / "report.yaml")])
    parameters.declare(node, lambda: False)
    values = parameters.values(node)
    unknown = parameters.unknown(node)
    node.destroy_node()
    rclpy.try_shutdown(context=context)
    assert values["scene"] == str(scene) and not unknown
    Mooring(values["scene"], values["fidelity"], values["solver"], values["dt"] or None, values["segments"] or None, values["refine"])


def test_what_cannot_be_had_fails_and_says_what_comes_nearest(scene, motion, mooring, tmp_path):
    outcome = mooring("trade", scene, motion, "--error", ERROR, "--budget", 1e9, "--json")
    assert outcome.status == 1 and outcome.json()["chosen"] is None
    assert "no setting is within an error of 4 % and 1e+09 times real time" in outcome.err and "times real time" in outcome.err.splitlines()[-1]
    assert not (tmp_path / "trade_parameters.yaml").exists()


def test_ctrl_c_keeps_what_was_measured(scene, motion, mooring, monkeypatch):
    measure, runs = trade_runner.measure, []

    def interrupted(*arguments):
        if len(runs) == 4:
            raise KeyboardInterrupt
        runs.append(1)
        return measure(*arguments)

    monkeypatch.setattr(trade_runner, "measure", interrupted)
    stopped = mooring("trade", scene, motion, "--time", 5, "--json")
    assert stopped.status == 130 and "goes on from there" in stopped.err and not stopped.out
    monkeypatch.setattr(trade_runner, "measure", measure)
    assert mooring("trade", scene, motion, "--time", 5, "--json").json()["from_cache"] == 4


@pytest.mark.parametrize(
    "words, told",
    [
        (["--error", "0"], "expected a positive number"),
        (["--budget", "fast"], "expected a finite number"),
        (["--of", "wrench"], "tension"),
        (["-o", "report.pdf"], "expected a name that ends in .html"),
        (["-o", "nowhere/report.html"], "does not exist"),
    ],
)
def test_bad_usage_is_told_in_one_line(scene, motion, mooring, words, told):
    outcome = mooring("trade", scene, motion, *words)
    assert outcome.status == 2 and told in outcome.err and len(outcome.err.splitlines()) == 1 and not outcome.out


def test_a_motion_that_is_too_short_is_refused(scene, mooring, tmp_path):
    (tmp_path / "short.csv").write_text("t,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n1,1,0,0,0,0,0\n")
    outcome = mooring("trade", scene, tmp_path / "short.csv")
    assert outcome.status == 2 and "2 samples, expected at least 20" in outcome.err
