"""What colcon builds and installs: package.xml, setup.py and the package itself say the same."""

import ast
import importlib
import re
import runpy
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
import setuptools

ROOT = Path(__file__).resolve().parents[2]
MANIFEST = ElementTree.parse(ROOT / "package.xml").getroot()

# Import name -> name in requirements/runtime.in, where they differ.
DISTRIBUTIONS = {"yaml": "PyYAML", "mcap_ros2": "mcap-ros2-support"}


@pytest.fixture
def setup_arguments(monkeypatch):
    """What setup.py hands to setuptools."""
    handed = {}
    monkeypatch.setattr(setuptools, "setup", lambda **arguments: handed.update(arguments))
    monkeypatch.chdir(ROOT)
    runpy.run_path("setup.py")
    return handed


def installed(arguments):
    """Target path -> source path of all data files."""
    return {f"{target}/{Path(source).name}": source for target, sources in arguments["data_files"] for source in sources}


def test_setup_and_manifest_name_the_same_package(setup_arguments):
    for field in ("name", "version", "license"):
        assert setup_arguments[field] == MANIFEST.findtext(field), field
    assert setup_arguments["maintainer"] == MANIFEST.findtext("maintainer")
    assert MANIFEST.get("format") == "3"
    assert MANIFEST.findtext("export/build_type") == "ament_python"


def test_every_scene_launch_and_parameter_file_is_installed(setup_arguments):
    targets = installed(setup_arguments)
    assert "share/ament_index/resource_index/packages/mooring_ros" in targets
    assert "share/mooring_ros/package.xml" in targets
    for folder, share in (("config", "config"), ("launch_scripts", "launch")):
        for path in (ROOT / folder).rglob("*"):
            if path.is_file() and "__pycache__" not in path.parts:
                assert f"share/mooring_ros/{share}/{path.relative_to(ROOT / folder)}" in targets
    assert any(target.startswith("share/mooring_ros/config/scenes/") for target in targets)
    assert "share/mooring_ros/launch/mooring.launch.py" in targets


def test_the_whole_package_and_nothing_else_is_installed(setup_arguments):
    folders = {path.parent for path in (ROOT / "mooring_ros").rglob("*.py")}
    assert set(setup_arguments["packages"]) == {".".join(folder.relative_to(ROOT).parts) for folder in folders}
    data = {path for path in (ROOT / "mooring_ros").rglob("*") if path.is_file() and path.suffix not in (".py", ".pyc")}
    assert {ROOT / "mooring_ros" / name for name in setup_arguments["package_data"]["mooring_ros"]} == data


@pytest.mark.parametrize("command", ("mooring_node", "mooring", "mooring_demo"))
def test_every_command_starts_something_that_is_there(setup_arguments, command):
    scripts = dict(re.fullmatch(r"(\w+) = (.+)", line).groups() for line in setup_arguments["entry_points"]["console_scripts"])
    module, function = scripts[command].split(":")
    assert callable(getattr(importlib.import_module(module), function))


def imports():
    """Top-level names of the other packages that mooring_ros imports."""
    names = set()
    for path in (ROOT / "mooring_ros").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                names.update(alias.name.split(".")[0] for alias in node.names)
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                names.add(node.module.split(".")[0])
    return names - set(sys.stdlib_module_names) - {"mooring_ros"}


def test_every_import_is_a_locked_requirement_or_a_ros_dependency():
    text = (ROOT / "requirements" / "runtime.in").read_text()
    required = set(re.findall(r"^[A-Za-z0-9-]+", text, re.MULTILINE))
    depends = {element.text for element in MANIFEST.findall("exec_depend")}
    missing = {name for name in imports() if DISTRIBUTIONS.get(name, name) not in required and name not in depends}
    assert not missing
