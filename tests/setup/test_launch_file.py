"""launch_scripts/mooring.launch.py, on stand-ins for launch and launch_ros: which command it would start."""

import runpy
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest
import yaml

from mooring_ros.node import parameters

ROOT = Path(__file__).resolve().parents[2]
FILE = ROOT / "launch_scripts" / "mooring.launch.py"


class LaunchConfiguration:
    def __init__(self, name):
        self.name = name

    def perform(self, context):
        return context[self.name]


def recorder(**_):
    return lambda *positional, **named: SimpleNamespace(positional=positional, **named)


@pytest.fixture
def launch_file(monkeypatch):
    """The names that the file defines."""
    modules = {
        "launch": {"LaunchDescription": list},
        "launch.actions": {"DeclareLaunchArgument": recorder(), "OpaqueFunction": recorder()},
        "launch.substitutions": {"LaunchConfiguration": LaunchConfiguration},
        "launch_ros": {},
        "launch_ros.actions": {"Node": recorder()},
    }
    for name, contents in modules.items():
        module = ModuleType(name)
        vars(module).update(contents)
        monkeypatch.setitem(sys.modules, name, module)
    return runpy.run_path(str(FILE))


@pytest.fixture
def launch(launch_file):
    """launch(name=value, …) -> the node that `ros2 launch … name:=value` would start."""

    def start(**given):
        *arguments, function = launch_file["generate_launch_description"]()
        context = {argument.positional[0]: argument.default_value for argument in arguments}
        assert set(given) <= set(context)
        (node,) = function.function({**context, **given})
        return node

    return start


def test_every_argument_is_described(launch_file):
    *arguments, _ = launch_file["generate_launch_description"]()
    assert {argument.positional[0] for argument in arguments} >= {"scene", "params_file", "namespace", "autostart"}
    assert all(argument.description.endswith(".") for argument in arguments)


def test_without_arguments_the_defaults_and_a_scene_that_is_there(launch):
    node = launch()
    assert (node.package, node.executable, node.name, node.namespace) == ("mooring_ros", "mooring_node", "mooring", "")
    file, over = node.parameters
    assert Path(file) == ROOT / "config" / "mooring.yaml"
    assert set(over) == {"scene"} and Path(over["scene"]).is_file()


def test_a_parameter_file_alone_is_not_overridden(launch, tmp_path):
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump({"/**": {"ros__parameters": {"scene": "mine.txt"}}}))
    assert launch(params_file=str(tmp_path / "mine.yaml")).parameters == [str(tmp_path / "mine.yaml")]


def test_arguments_override_the_parameter_file(launch, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("mine.yaml", "mine.txt"):
        Path(name).write_text("")
    node = launch(params_file="mine.yaml", scene="mine.txt", autostart="False", recording="out.mcap", namespace="tank", name="lines")
    assert (node.namespace, node.name) == ("tank", "lines")
    expected = {"scene": str(tmp_path / "mine.txt"), "autostart": False, "recording.enabled": True, "recording.path": "out.mcap"}
    assert node.parameters == [str(tmp_path / "mine.yaml"), expected]


def test_every_override_is_a_parameter_of_the_node_in_its_type(launch, tmp_path):
    (tmp_path / "mine.txt").write_text("")
    node = launch(scene=str(tmp_path / "mine.txt"), autostart="true", recording="out.mcap")
    types = {entry.name: type(entry.default) for entry in parameters.TABLE}
    assert {name: type(value) for name, value in node.parameters[1].items()}.items() <= types.items()


@pytest.mark.parametrize("argument", ("scene", "params_file"))
def test_a_file_that_is_not_there_is_named(launch, argument, tmp_path):
    with pytest.raises(FileNotFoundError, match=f"{argument}:={tmp_path}/none: no such file"):
        launch(**{argument: str(tmp_path / "none")})


def test_autostart_is_true_or_false(launch):
    with pytest.raises(ValueError, match="autostart:=maybe: expected true or false"):
        launch(autostart="maybe")


def test_the_node_is_discovered_on_this_machine_alone_unless_shell_or_argument_say_otherwise(launch, monkeypatch):
    monkeypatch.delenv("ROS_AUTOMATIC_DISCOVERY_RANGE", raising=False)
    assert launch().additional_env == {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET")
    assert launch().additional_env == {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}
    assert launch(reach="OFF").additional_env == {"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}
    with pytest.raises(ValueError, match="reach:=everywhere: expected one of LOCALHOST"):
        launch(reach="everywhere")
