"""Children of the demo: what they say is read, they stop when told, and they do not outlive their owner."""

import os
import signal
import subprocess
import sys
import textwrap
import time

import pytest

from mooring_ros.demo.processes import Child


@pytest.fixture
def child(tmp_path):
    started = []

    def start(code, read=False):
        (tmp_path / "talk.py").write_text(textwrap.dedent(code))
        variables = {**os.environ, "PYTHONPATH": str(tmp_path), "PYTHONUNBUFFERED": "1"}
        started.append(Child("talker", "talk", [], tmp_path / "talk.log", variables, sys.executable, read))
        return started[-1]

    yield start
    for one in started:
        one.stop()


def test_lines_come_whole_even_when_printed_in_pieces(child):
    talker = child('import sys, time\nsys.stdout.write("one\\ntw"); sys.stdout.flush(); time.sleep(0.5); print("o")', read=True)
    seen = []
    while talker.status is None:
        seen += talker.lines()
    assert seen + talker.lines() == ["one", "two"]


def test_the_end_of_its_log_says_why_it_failed(child):
    talker = child('import sys\nfor n in range(50): print("line", n)\nsys.exit("out of chain")')
    assert talker.wait(20) == 1
    assert talker.tail(2).splitlines() == ["line 49", "out of chain"]


@pytest.mark.parametrize("in_the_owner", [signal.default_int_handler, signal.SIG_IGN], ids=["heeded", "ignored"])
def test_stop_is_an_interrupt_and_what_it_does_then_is_finished(child, in_the_owner):
    """Also where the owner ignores it, as what a shell starts in the background does."""
    before = signal.signal(signal.SIGINT, in_the_owner)
    talker = child(
        """
        import sys, time
        try:
            print("ready", flush=True)
            time.sleep(60)
        except KeyboardInterrupt:
            print("closed", flush=True)
        """
    )
    signal.signal(signal.SIGINT, before)
    while "ready" not in talker.tail():
        time.sleep(0.02)
    assert talker.stop() == 0
    assert talker.tail().splitlines() == ["ready", "closed"]


def test_it_does_not_outlive_an_owner_that_is_killed(tmp_path):
    (tmp_path / "sleeper.py").write_text("import time\ntime.sleep(60)\n")
    (tmp_path / "owner.py").write_text(
        "import os, sys, time\nfrom mooring_ros.demo.processes import Child\n"
        f"child = Child('sleeper', 'sleeper', [], r'{tmp_path}/log', dict(os.environ), sys.executable)\n"
        "print(child._process.pid, flush=True)\ntime.sleep(60)\n"
    )
    variables = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), os.getcwd(), os.environ.get("PYTHONPATH", "")])}
    owner = subprocess.Popen([sys.executable, tmp_path / "owner.py"], env=variables, stdout=subprocess.PIPE, text=True)
    orphan = int(owner.stdout.readline())
    owner.send_signal(signal.SIGKILL)
    owner.communicate()
    for _ in range(200):
        if not _runs(orphan):
            return
        time.sleep(0.05)
    os.kill(orphan, signal.SIGKILL)
    pytest.fail("the child still runs 10 s after its owner was killed")


def _runs(pid):
    try:
        with open(f"/proc/{pid}/stat", encoding="utf-8") as file:
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False
