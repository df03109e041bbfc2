"""config/mooring.yaml: all parameters of the node with their defaults, in a form that ROS reads."""

from pathlib import Path

import pytest
import rclpy
import yaml
from rclpy.context import Context
from rclpy.node import Node

from mooring_ros.node import parameters

FILE = Path(__file__).resolve().parents[2] / "config" / "mooring.yaml"


def flat(tree, stem=""):
    """{"a": {"b": 1}} -> {"a.b": 1}"""
    pairs = {}
    for name, value in tree.items():
        pairs.update(flat(value, f"{stem}{name}.") if isinstance(value, dict) else {stem + name: value})
    return pairs


@pytest.fixture
def node(monkeypatch):
    """A node that was started with the file, in a namespace and under a name of its own."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF")
    context = Context()
    rclpy.init(context=context)
    node = Node("another", namespace="tank", context=context, cli_args=["--ros-args", "--params-file", str(FILE)])
    yield node
    node.destroy_node()
    rclpy.try_shutdown(context=context)


def test_the_file_has_every_parameter_with_its_default():
    in_file = flat(yaml.safe_load(FILE.read_text())["/**"]["ros__parameters"])
    defaults = {entry.name: entry.default for entry in parameters.TABLE}
    assert in_file == defaults
    assert {name: type(value) for name, value in in_file.items()} == {name: type(value) for name, value in defaults.items()}


def test_a_node_of_any_name_accepts_the_file(node):
    parameters.declare(node, lambda: False)
    assert set(node._parameter_overrides) >= {entry.name for entry in parameters.TABLE}
    assert parameters.values(node) == {entry.name: entry.default for entry in parameters.TABLE}
