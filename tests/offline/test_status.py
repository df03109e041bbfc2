"""`mooring status`: what is told of a node, by a clock that the test turns."""
import os
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.domains import free_domain
from mooring_ros.offline.status_text import status_text
from mooring_ros.offline.status_view import SILENT, View

ROOT = Path(__file__).parents[2]
STATUSES = [
    ("mooring: state", 0, "RUN: after 0 s", "/mooring", {"state": "RUN", "transitions": "2"}),
    ("mooring: input", 1, "refused: jump: pose is 3 m from where the motion led", "/mooring", {"received": "7", "lost steps": "3"}),
    ("mooring: timing", 0, "in time", "/mooring", {"mode": "input", "input to wrench p99 (ms)": "1.250"}),
    ("mooring: accuracy", 0, "no estimate yet", "/mooring", {"worst step (ms)": "4.689"}),
    ("camera: lens", 2, "covered", "/camera", {}),
]


def view_of_a_second(rate=200):
    """A View after one second of messages at so many Hz; the clock stands at 1."""
    view = View()
    view.take_statuses(0.5, STATUSES)
    for k in range(rate + 1):
        view.take_wrench(k / rate, 10.0 + k / rate, "world", (1e5, 0.0, -2e6), (0.0, 3e6, 0.0))
        view.take_lines(k / rate, ["line1", "line2"], [836.2, 837.0], [0.1, -0.1], [1e6 + 1e3 * (k % 50), 5e5])
    return view


def test_the_picture_tells_states_rates_delay_tensions_and_the_worst_step():
    picture = view_of_a_second().picture(1.0)
    assert picture["node"] == "/mooring" and not picture["silent"] and picture["level"] == 1
    assert picture["wrench"]["rate"] == pytest.approx(200.0) and picture["wrench"]["age"] == 0.0 and picture["wrench"]["stamp"] == 11.0
    assert picture["lines"][0] == {"name": "line1", "length": 836.2, "length_rate": 0.1, "fairlead_tension": 1e6, "highest_tension": 1.049e6}
    text = status_text(picture)
    for words in ("/mooring: WARN", "RUN", "refused: jump", "lost steps 3", "input to wrench p99 (ms) 1.250",
                  "worst step (ms) 4.689", "200.0 Hz", "line2"):
        assert words in text
    assert "camera" not in text and "\x1b" not in text and "\x1b[33mWARN" in status_text(picture, colour=True)


def test_of_several_platforms_each_has_its_wrench():
    view = view_of_a_second()
    for k in range(11):
        view.take_wrench(k / 10, 0.1 * k, "world", (1.0, 2.0, 3.0), (0.0,) * 3, "body2")
    picture = view.picture(1.0)
    assert picture["platforms"]["body2"]["rate"] == pytest.approx(10.0) and picture["wrench"]["rate"] == pytest.approx(200.0)
    assert "\nbody2       10.0 Hz" in status_text(picture)


def test_a_rate_is_that_of_the_last_seconds_and_ages_when_nothing_comes():
    view = view_of_a_second(100)
    for k in range(50):
        view.take_wrench(100.0 + k / 10, 0.0, "", (0.0,) * 3, (0.0,) * 3)
    assert view.picture(105.0)["wrench"]["rate"] == pytest.approx(10.0)
    assert view.picture(105.0)["wrench"]["age"] == pytest.approx(0.1)
    assert view.picture(200.0)["wrench"]["rate"] is None


def test_a_node_that_tells_nothing_any_more_is_silent_and_the_text_says_for_how_long():
    view = view_of_a_second()
    assert not view.picture(0.5 + 0.9 * SILENT)["silent"]
    picture = view.picture(0.5 + 7.0)
    assert picture["silent"] and status_text(picture).startswith("/mooring: silent for 7.0 s")


def test_of_several_nodes_the_one_that_was_asked_for_is_shown():
    other = [(name, 2, "x", "/tank/mooring", values) for name, _, _, hardware, values in STATUSES if hardware == "/mooring"]
    view = View("/tank/mooring")
    view.take_statuses(0.0, STATUSES)
    assert not view.heard
    view.take_statuses(0.0, other)
    assert view.heard and view.nodes == {"/mooring", "/tank/mooring"} and view.picture(0.0)["level"] == 2


def run_status(*arguments, domain):
    return subprocess.run([sys.executable, "-m", "mooring_ros.offline", "status", *arguments], cwd=ROOT, capture_output=True, text=True, timeout=60,
                          env={**os.environ, "ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"})


def test_where_no_node_is_heard_it_says_so_with_the_domain_and_ends_with_status_one():
    domain = free_domain()
    done = run_status("--json", "--wait", "0.5", domain=domain)
    assert done.returncode == 1 and done.stdout == ""
    assert len(done.stderr.splitlines()) == 1 and "nothing heard of a mooring node within 0.5 s" in done.stderr and f"ROS_DOMAIN_ID={domain}" in done.stderr

