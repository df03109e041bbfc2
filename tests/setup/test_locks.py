"""The locked requirements: ROS is Jazzy, everything has a hash, nothing names an address."""

import re
from pathlib import Path

import pytest

REQUIREMENTS = Path(__file__).resolve().parents[2] / "requirements"
LOCKS = ("wheels", "sourced", "test", "bench")
PIN = re.compile(r"^([a-z0-9._-]+)==([^ ;\\]+)(?: ; (.+?))? \\$")

# Release series of Jazzy, by package, or by the stem of a family.
JAZZY = {
    "ros-jazzy-rclpy": "7.1", "ros-jazzy-common-interfaces": "5.3", "ros-rclpy": "7.1", "ros-common-interfaces": "5.3",
    "ros-action-msgs": "2.0", "ros-builtin-interfaces": "2.0", "ros-lifecycle-msgs": "2.0", "ros-rcl-interfaces": "2.0",
    "ros-rosgraph-msgs": "2.0", "ros-service-msgs": "2.0", "ros-type-description-interfaces": "2.0", "ros-unique-identifier-msgs": "2.5",
    "ros-actionlib-msgs": "5.3", "ros-diagnostic-msgs": "5.3", "ros-geometry-msgs": "5.3", "ros-nav-msgs": "5.3", "ros-sensor-msgs": "5.3",
    "ros-shape-msgs": "5.3", "ros-std-msgs": "5.3", "ros-std-srvs": "5.3", "ros-stereo-msgs": "5.3", "ros-trajectory-msgs": "5.3",
    "ros-visualization-msgs": "5.3", "ros-rmw-dds-common": "3.1", "ros-ament-index-cpp": "1.8", "ros-ament-index-python": "1.8",
    "ros-fastcdr": "2.2", "ros-fastrtps": "2.14", "ros-fastrtps-cmake-module": "3.6", "ros-foonathan-memory-vendor": "1.3",
    "ros-libyaml-vendor": "1.6", "ros-spdlog-vendor": "1.6", "ros-rcl": "9.2", "ros-rcl-action": "9.2", "ros-rcl-lifecycle": "9.2",
    "ros-rcl-yaml-param-parser": "9.2", "ros-rcl-logging-interface": "3.1", "ros-rcl-logging-spdlog": "3.1", "ros-rcpputils": "2.11",
    "ros-rcutils": "6.7", "ros-rmw": "7.3", "ros-rmw-fastrtps-cpp": "8.4", "ros-rmw-fastrtps-shared-cpp": "8.4",
    "ros-rmw-implementation": "2.15", "ros-rmw-implementation-cmake": "7.3", "ros-rpyutils": "0.4", "ros-tracetools": "8.2",
    "ros-rosidl-core-runtime": "0.2", "ros-rosidl-default-runtime": "1.6", "ros-rosidl-generator-py": "0.22",
    "ros-rosidl-dynamic-typesupport": "0.1", "ros-rosidl-dynamic-typesupport-fastrtps": "0.1", "ros-rosidl-typesupport-c": "3.2",
    "ros-rosidl-typesupport-cpp": "3.2", "ros-rosidl-typesupport-fastrtps-c": "3.6", "ros-rosidl-typesupport-fastrtps-cpp": "3.6",
    "ros-wheels-bootstrapper": "0.1",
}  # fmt: skip
FAMILIES = {"ros-rosidl-": "4.6", "ros-ament-cmake-": "0.17"}


def pins(name):
    """(package, version, marker or None) of each requirement in a lock."""
    lines = (REQUIREMENTS / f"{name}.txt").read_text().splitlines()
    return [PIN.match(line).groups() for line in lines if line and line[0] not in " #"]


def jazzy_series(package):
    families = [series for stem, series in FAMILIES.items() if package.startswith(stem)]
    return JAZZY.get(package) or (families[0] if families else None)


@pytest.mark.parametrize("lock", LOCKS)
def test_a_lock_names_no_address(lock):
    text = (REQUIREMENTS / f"{lock}.txt").read_text()
    assert not re.search(r"://|--(extra-)?index-url|--find-links|@ ", text)


@pytest.mark.parametrize("lock", LOCKS)
def test_every_requirement_is_pinned_and_has_a_hash(lock):
    requirements = re.split(r"\n(?=[a-z])", (REQUIREMENTS / f"{lock}.txt").read_text().split("\n", 2)[2])
    for requirement in requirements:
        assert PIN.match(requirement.splitlines()[0]), requirement.splitlines()[0]
        assert re.search(r"--hash=sha256:[0-9a-f]{64}", requirement), requirement.splitlines()[0]


def test_every_ros_wheel_is_of_a_jazzy_series():
    wheels = [(package, version) for package, version, _ in pins("wheels") if package.startswith("ros-")]
    assert {"ros-jazzy-rclpy", "ros-jazzy-common-interfaces", "ros-rmw-fastrtps-cpp"} <= {package for package, _ in wheels}
    for package, version in wheels:
        series = jazzy_series(package)
        assert series, f"{package}: no series of Jazzy known"
        assert version.startswith(f"{series}."), f"{package}=={version}: expected {series}.*"


@pytest.mark.parametrize("lock", ("sourced", "test", "bench"))
def test_no_other_lock_brings_ros(lock):
    assert not [package for package, _, _ in pins(lock) if package.startswith(("ros-", "rclpy"))]


def test_a_sourced_ros_keeps_the_numpy_it_was_built_for():
    versions = {marker: version for package, version, marker in pins("sourced") if package == "numpy"}
    assert versions["python_full_version < '3.13'"].startswith("1.26.")


@pytest.mark.parametrize("base", ("wheels", "sourced"))
@pytest.mark.parametrize("extra", ("test", "bench"))
def test_an_extra_changes_no_version_of_the_base(base, extra):
    there = {}
    for package, version, _ in pins(base):
        there.setdefault(package, set()).add(version)
    for package, version, _ in pins(extra):
        assert version in there.get(package, {version}), package


@pytest.mark.parametrize("lock", LOCKS)
def test_a_lock_holds_what_its_input_asks_for(lock):
    asked, files = set(), [f"{lock}.in"]
    while files:
        for line in (REQUIREMENTS / files.pop()).read_text().splitlines():
            if line.startswith("-r "):
                files.append(line.split()[1])
            elif line and not line.startswith("#"):
                asked.add(re.match(r"[A-Za-z0-9._-]+", line).group().lower())
    assert asked <= {package for package, _, _ in pins(lock)}
