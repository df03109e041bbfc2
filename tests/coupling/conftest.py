"""A spring in the place of the mooring node, on a ROS domain of the test's own."""

import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.domains import free_domain

STAND_IN = Path(__file__).with_name("stand_in_mooring.py")


@pytest.fixture
def domain(monkeypatch):
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    monkeypatch.setenv("ROS_DOMAIN_ID", str(free_domain()))


@pytest.fixture
def spring(domain):
    """start(*arguments) runs the stand-in; its process is returned, and ended with the test."""
    processes = []

    def start(*arguments):
        processes.append(subprocess.Popen([sys.executable, STAND_IN, *arguments]))
        return processes[-1]

    yield start
    for process in processes:
        process.kill()
        process.wait()
