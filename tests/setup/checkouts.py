"""A copy of ./run and its requirements, with a stand-in for uv that makes real environments without the network."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

# `uv venv` makes a bare environment with stand-ins for the packages that ./run tries after an installation; `uv pip` only notes
# what it was asked for, waits if it shall, and fails if it shall.
UV = """#!/usr/bin/env bash
printf '%s\\n' "$*" >>"$UV_LOG"
case $1 in
    --version) ;;
    venv)
        while [[ $1 != --python ]]; do
            [[ $1 != --system-site-packages ]] || system=--system-site-packages
            shift
        done
        "$2" -m venv --without-pip $system "$4"
        packages=$(echo "$4"/lib/python3.*/site-packages)
        mkdir "$packages/nav_msgs"
        touch "$packages"/{numba,mcap}.py "$packages"/nav_msgs/{__init__,msg}.py
        [[ -n $system ]] || touch "$packages/rclpy.py"
        ;;
    pip)
        [[ ! -e $UV_LOG.slow ]] || sleep 1
        [[ ! -e $UV_LOG.broken ]] || { echo 'no route to anything' >&2; exit 1; }
        ;;
esac
"""

ROS_VARIABLES = ("ROS_DISTRO", "AMENT_PREFIX_PATH", "PYTHONPATH", "LD_LIBRARY_PATH", "_ROS_WHEELS_BOOTSTRAP_COMPLETE")


class Checkout:
    """A checkout in a folder, and a shell's environment in which no ROS is sourced."""

    def __init__(self, folder):
        self.root = Path(folder) / "a check-out"
        (self.root / "mooring_ros").mkdir(parents=True)
        (self.root / "mooring_ros" / "__init__.py").write_text("")
        shutil.copy(ROOT / "run", self.root)
        shutil.copytree(ROOT / "requirements", self.root / "requirements")
        tools = Path(folder) / "tools"
        tools.mkdir()
        (tools / "uv").write_text(UV)
        (tools / "uv").chmod(0o755)
        self.log = Path(folder) / "uv.log"
        self.environment = {name: value for name, value in os.environ.items() if name not in ROS_VARIABLES}
        self.environment.update(PATH=f"{tools}:{Path(sys.base_prefix) / 'bin'}:{os.environ['PATH']}", UV_LOG=str(self.log))

    def start(self, *arguments, script=None, **options):
        command = [str(script or self.root / "run"), *arguments]
        streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        return subprocess.Popen(command, env=self.environment, **{"cwd": self.root.parent, **streams, **options})

    def run(self, *arguments, **options):
        """(exit status, standard output, standard error) of ./run ARGUMENTS."""
        process = self.start(*arguments, **options)
        out, err = process.communicate(timeout=120)
        return process.returncode, out, err

    def installed(self):
        """What was installed since the last call, as names of locks."""
        lines = self.log.read_text().splitlines() if self.log.exists() else []
        self.log.unlink(missing_ok=True)
        return [Path(word).stem for line in lines if line.startswith("pip") for word in line.split() if word.endswith(".txt")]

    def switch(self, what, on):
        """Make the stand-in's installations slow or broken, or well again."""
        flag = Path(f"{self.log}.{what}")
        flag.touch() if on else flag.unlink()

    @property
    def venv(self):
        return self.root / ".venv"


@pytest.fixture
def checkout(tmp_path):
    return Checkout(tmp_path)
