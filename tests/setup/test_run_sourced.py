"""./run where a ROS is sourced."""

import pytest
from checkouts import checkout  # noqa: F401, a fixture


@pytest.fixture
def jazzy(checkout, tmp_path):
    """A prefix like that of an installed Jazzy, sourced; its rclpy is a stand-in."""
    prefix = tmp_path / "opt" / "jazzy"
    packages = prefix / "lib" / "python3" / "site-packages"
    packages.mkdir(parents=True)
    (packages / "rclpy.py").write_text("")
    marker = prefix / "share" / "ament_index" / "resource_index" / "packages" / "rclpy"
    marker.parent.mkdir(parents=True)
    marker.touch()
    checkout.environment.update(ROS_DISTRO="jazzy", AMENT_PREFIX_PATH=f"{tmp_path}/overlay:{prefix}", PYTHONPATH=str(packages))
    return prefix


def test_another_distribution_is_refused(checkout):
    checkout.environment.update(ROS_DISTRO="humble", AMENT_PREFIX_PATH="/opt/ros/humble")
    status, out, err = checkout.run("python", "-c", "")
    assert (status, out) == (2, "")
    assert "humble" in err and "Jazzy" in err and err.count("\n") == 1
    assert not checkout.venv.exists()


def test_a_sourced_jazzy_is_used(checkout, jazzy):
    status, out, err = checkout.run("python", "-c", "import rclpy, os; print(rclpy.__file__, os.environ['AMENT_PREFIX_PATH'], os.environ.get('LD_LIBRARY_PATH'))")
    assert (status, out) == (0, f"{jazzy}/lib/python3/site-packages/rclpy.py {jazzy.parents[1]}/overlay:{jazzy} None\n")
    assert f"ROS 2 Jazzy from {jazzy}" in err
    assert checkout.installed() == ["sourced"]
    assert "include-system-site-packages = true" in (checkout.venv / "pyvenv.cfg").read_text()
    assert checkout.run("python", "-c", "")[2] == ""


def test_another_workspace_over_the_same_jazzy_needs_nothing_new(checkout, jazzy):
    checkout.run("python", "-c", "")
    checkout.environment["AMENT_PREFIX_PATH"] = f"/another/workspace:{jazzy}"
    assert checkout.run("python", "-c", "") == (0, "", "")


def test_a_package_of_a_sourced_workspace_does_not_hide_the_checkout(checkout, jazzy):
    other = jazzy / "lib" / "python3" / "site-packages" / "mooring_ros"
    other.mkdir()
    (other / "__init__.py").write_text("")
    assert checkout.run("python", "-c", "import mooring_ros; print(mooring_ros.__file__)")[1] == f"{checkout.root}/mooring_ros/__init__.py\n"


def test_a_sourced_jazzy_whose_rclpy_no_python_imports_is_an_error(checkout, jazzy):
    (jazzy / "lib" / "python3" / "site-packages" / "rclpy.py").write_text("raise ImportError('built for another Python')")
    status, out, err = checkout.run("python", "-c", "")
    assert (status, out) == (1, "")
    assert str(jazzy) in err and "rclpy" in err


def test_an_unsourced_shell_of_a_ros_image_uses_the_wheels(checkout):
    checkout.environment["ROS_DISTRO"] = "jazzy"
    assert checkout.run("python", "-c", "")[0] == 0
    assert checkout.installed() == ["wheels"]
    # and so does a ./run from within it, which sees .venv in AMENT_PREFIX_PATH
    nested = "import os, subprocess; raise SystemExit(subprocess.run([os.environ['RUN'], 'python', '-c', '']).returncode)"
    checkout.environment["RUN"] = str(checkout.root / "run")
    assert checkout.run("python", "-c", nested) == (0, "", "")


def test_wheels_find_their_libraries_and_shares_in_the_environment(checkout):
    checkout.environment["LD_LIBRARY_PATH"] = "/of/the/user"
    code = "import os; print(os.environ['LD_LIBRARY_PATH'].split(':'), os.environ['AMENT_PREFIX_PATH'])"
    status, out, _ = checkout.run("python", "-c", code)
    assert status == 0
    assert out.startswith(f"['{checkout.venv}/lib', ") and "'/of/the/user'] " in out
    assert out.endswith(f" {checkout.venv}\n")
