"""ROS domains for tests and benchmarks: two processes never share one."""

import subprocess
import sys
from pathlib import Path

from benchmarks import domains

ROOT = Path(__file__).parents[2]


def test_what_a_process_holds_no_other_one_gets(monkeypatch):
    mine = domains.free_domain()
    monkeypatch.setattr(domains, "FIRST", mine)
    monkeypatch.setattr(domains, "COUNT", 1)
    code = f"from benchmarks import domains; domains.FIRST, domains.COUNT = {mine}, 1; print(domains.free_domain())"
    other = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert other.returncode == 1 and "all taken by other processes" in other.stderr
    assert domains.free_domain() in [domain for domain, _ in domains._held]


def test_a_process_that_has_ended_leaves_its_domain():
    code = "from benchmarks import domains; domains.FIRST, domains.COUNT = 231, 1; print(domains.free_domain())"
    for _ in range(2):
        assert subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip() == "231"
