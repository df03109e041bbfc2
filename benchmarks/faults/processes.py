"""The node's process: signals, kills, and standing still."""
import math
import os
import signal
import time
from pathlib import Path

from .disks import recorded, recovered, wrenches_in
from .judge import Wrong
from .process import START
from .registry import fault
from .rig import STEP, Rig
from .setups import QUIET


def _ended(number, times):
    def act(folder):
        with Rig(recorded(folder), folder=folder) as rig:
            rig.send(100)
            rig.judged()
            for _ in range(times):
                rig.process.send(number)
                time.sleep(0.02)
            begin = time.monotonic()
            status = rig.process.wait()
            if status != 0 or "Traceback" in rig.process.log:
                raise Wrong(f"ended with {status}, expected 0 without a traceback:\n{rig.process.log}")
            rig.shown.append(("the process", "exit status 0, recording closed", time.monotonic() - begin))
            if wrenches_in(Path(folder) / "run.mcap") != [heard.stamp for heard in rig.peer.heard]:
                raise Wrong("the recording does not hold the wrenches that were heard")
        return rig
    return act


@fault("SIGTERM in full run", "start it again; the recording is closed and complete", node=None, quick=False)
def sigterm(folder):
    return _ended(signal.SIGTERM, 1)(folder)


@fault("SIGHUP: the terminal is gone", "start it again; the recording is closed and complete", node=None, quick=False)
def sighup(folder):
    return _ended(signal.SIGHUP, 1)(folder)


@fault("nobody reads the log any more: standard output and error are broken pipes", "none needed", node=None, quick=False)
def log_gone(folder):
    with Rig(QUIET, folder=folder, log=False) as rig:
        rig.send(20)
        rig.bad(position=(math.nan,) * 3)       # which is logged
        rig.expect("input", "non_finite")
        rig.send(20)
        rig.process.send(signal.SIGTERM)
        if rig.process.wait() != 0:
            raise Wrong(f"it ended with {rig.process.process.returncode}, expected 0")
    return rig


@fault("SIGINT twice", "start it again; the recording is closed and complete", node=None, quick=False)
def sigint_twice(folder):
    return _ended(signal.SIGINT, 2)(folder)


@fault("SIGKILL, then a new process at the same recording.path while the simulator goes on",
       "the new process settles at its first sample and records to `run_2.mcap`; `mooring recover` reads the first", node=None)
def sigkill(folder):
    with Rig(recorded(folder), folder=folder) as rig:
        for _ in range(40):
            rig.send(5)
            time.sleep(0.05)
        rig.judged()
        rig.process.send(signal.SIGKILL)
        rig.process.wait()
        rig.shown.append(("the process", "exit status −9, /diagnostics silent", 0.0))
        count = recovered(Path(folder) / "run.mcap", Path(folder) / "whole.mcap", 200 - 100)
        rig.shown.append(("mooring recover", f"{count} of 200 wrenches", 0.0))
        rig.launch()
        # The dead one is still known for a while, so its log tells when the new one listens.
        if not rig.peer.wait(lambda: "active: listens" in rig.process.log, START):
            raise Wrong(f"the new process does not become active:\n{rig.process.log}")
        rig.peer.wait(lambda: False, 0.5)
        rig.judge.settle(None)
        rig.send(50)
        rig.judged()
        rig.process.end()
        if len(wrenches_in(Path(folder) / "run_2.mcap")) != 50:
            raise Wrong("the second recording does not hold the 50 wrenches of the second process")
    return rig


@fault("the process stopped for 2 s (SIGSTOP) while samples come at 200 Hz", "none needed: all that waited are answered, sample by sample")
def process_stopped(rig):
    rig.send(20)
    count = len(rig.peer.heard)
    rig.process.send(signal.SIGSTOP)
    rig.send(400, answered=False, period=0.005)
    rig.process.send(signal.SIGCONT)
    rig.answer(rig.stamp - STEP)
    if len(rig.peer.heard) - count != 400:
        raise Wrong(f"{len(rig.peer.heard) - count} of 400 samples are answered")
    rig.send(20)


@fault("the process stopped for 2 s while samples by the wall clock come, with `limits.input_age: 0.5`",
       "none needed: HOLD until the next good sample, where the clock speaks first", node="age")
def process_stopped_age(rig):
    for _ in range(20):
        rig.stamp = rig.offset = time.time_ns()
        rig.send()
    rig.judge.held()        # when it wakes up, the clock may speak before the samples do
    rig.process.send(signal.SIGSTOP)
    for _ in range(50):
        stamp = time.time_ns()
        rig.judge.good[stamp] = rig.state(stamp)
        rig.send_at(stamp)
        time.sleep(0.04)
    rig.mark()
    rig.process.send(signal.SIGCONT)
    rig.expect("input", "stale: sample is")
    rig.judged()
    rig.running_by_the_wall_clock()


@fault("the process that estimates the accuracy killed", "deactivate and activate; the wrenches do not need it", node=None, quick=False)
def accuracy_killed(folder):
    with Rig({}, folder=folder) as rig:
        rig.send(20)
        children = Path(f"/proc/{rig.process.process.pid}/task/{rig.process.process.pid}/children").read_text().split()
        if len(children) != 1:
            raise Wrong(f"the node has {len(children)} children, expected one")
        rig.mark()
        os.kill(int(children[0]), signal.SIGKILL)
        rig.expect("accuracy", "ended", allowed=1.0)
        rig.send(20)
    return rig
