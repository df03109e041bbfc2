"""The floater as a ROS process, against a spring that answers, or does not."""

import contextlib
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.domains import free_domain

STAND_IN = Path(__file__).parents[1] / "coupling" / "stand_in_mooring.py"
ROOT = Path(__file__).parents[2]


@pytest.fixture
def environment():
    domain = str(free_domain())
    path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
    return {**os.environ, "ROS_DOMAIN_ID": domain, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "PYTHONPATH": path}


@contextlib.contextmanager
def stand_in(environment, *arguments):
    process = subprocess.Popen([sys.executable, STAND_IN, *arguments], env=environment)
    try:
        yield process
    finally:
        process.kill()
        process.wait()


def simulator(*arguments):
    return [sys.executable, "-m", "mooring_ros.demo.simulator", *arguments]


def run(environment, *arguments):
    return subprocess.run(simulator(*arguments), env=environment, capture_output=True, text=True, timeout=60)


def test_every_sample_is_answered_once_and_no_stamp_is_sent_twice(environment, tmp_path):
    with stand_in(environment) as spring:
        done = run(environment, "--duration", "2", "--summary", str(tmp_path / "summary.json"), "--json")
        assert done.returncode == 0, done.stderr
        assert spring.poll() is None  # it asserts that no stamp comes twice
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["steps"] == 100 and summary["sent"] == summary["answered"] == len(summary["round_trips"]) == 101
    assert summary["lost"] == summary["doubled"] == summary["late"] == 0
    assert summary["ballast"][2] == pytest.approx(6.08e6 - 9.80665 * (1025 * 20206 - 20093e3))
    assert json.loads(done.stdout.splitlines()[-1]) == {"time": 2.0}


def test_a_lost_and_a_doubled_answer_are_counted_and_the_run_goes_on(environment, tmp_path):
    with stand_in(environment, "--drop", "20", "--double", "30"):
        done = run(environment, "--duration", "1", "--patience", "0.5", "--summary", str(tmp_path / "summary.json"))
    assert done.returncode == 0, done.stderr
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert (summary["lost"], summary["doubled"], summary["late"]) == (1, 1, 0)
    assert summary["answered"] == summary["sent"] - 1


def test_a_mooring_that_falls_silent_ends_the_run_with_a_clear_word(environment):
    with stand_in(environment, "--silent-after", "10"):
        done = run(environment, "--duration", "5", "--patience", "0.3")
    assert done.returncode == 1
    assert "the mooring node stopped answering at 1." in done.stderr and "Traceback" not in done.stderr


def test_without_a_mooring_node_it_says_what_it_waited_for(environment):
    done = run(environment, "--timeout", "1")
    assert done.returncode == 1
    assert "platform/odom" in done.stderr and "mooring/wrench" in done.stderr and "Traceback" not in done.stderr


def test_a_node_that_stays_unconfigured_is_named_long_before_the_time_out(environment):
    with stand_in(environment, "--unconfigured"):
        done = run(environment, "--timeout", "55")
    assert done.returncode == 1
    assert "unconfigured, expected active" in done.stderr and "Traceback" not in done.stderr


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_it_stops_at_once_on_a_signal(environment, number):
    process = subprocess.Popen(simulator("--timeout", "60"), env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert "waiting" in process.stdout.readline()
        process.send_signal(number)
        _, errors = process.communicate(timeout=10)
    finally:
        process.kill()
    assert process.returncode == 130 and "Traceback" not in errors
