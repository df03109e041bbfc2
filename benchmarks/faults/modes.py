"""Faults of the other ways to run: at a fixed rate, with a camera system, under simulated time.

What the core was given there depends on the clock, so the judge is the recording: every wrench must be finite and of a stamp that was sent, and
the replay must give the recorded tensions again, bit for bit.
"""
import json
import math
import os
import subprocess
import sys
import time

from . import motion
from .disks import recorded
from .judge import Wrong
from .peer import wait_until_heard
from .process import ROOT, SCENE
from .registry import fault
from .rig import BEGIN, STEP, Rig


def _replayed(rig, folder):
    """End the node; raises Wrong where something was not finite, was of a stamp that nobody sent, or comes out differently."""
    if rig.process.end() != 0:
        raise Wrong(f"the node did not end well:\n{rig.process.log}")
    for heard in rig.peer.heard:
        if not all(map(math.isfinite, heard.wrench)) or heard.stamp not in rig.judge.good:
            raise Wrong(f"a wrench that is not finite, or answers what was not sent: {heard}")
    rig.judge.checked += len(rig.peer.heard)
    done = subprocess.run([sys.executable, "-m", "mooring_ros.offline", "replay", SCENE, "run.mcap", "-o", "again.mcap", "--json"],
                          capture_output=True, text=True, cwd=folder,
                          env={**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])})
    same = json.loads(done.stdout)["identical"] if done.returncode == 0 else None
    if not same or not same["total"] or same["same"] != same["total"]:
        raise Wrong(f"the replay differs: {same} {done.stderr.strip()}")
    rig.shown.append(("mooring replay", f"{same['same']} of {same['total']} tensions again", 0.0))


def _clock(rig):
    """A publisher of /clock that the node hears."""
    clock = rig.peer.publisher("/clock", "rosgraph_msgs/msg/Clock")
    wait_until_heard(clock)
    return clock


def _clocked(rig, clock):
    """A second of samples, each at its stamp by /clock."""
    for _ in range(50):
        clock.send({"clock": motion.header(rig.stamp, "")["stamp"]})
        time.sleep(0.005)
        rig.send()


def _paced(rig, count):
    """Samples at 50 Hz by the clock, without waiting for answers."""
    rig.send(count, answered=False, period=1e-9 * STEP)


@fault("no samples for a second in the mode `timer`",
       "none needed: HOLD after 0.2 s until the next good sample, then it ramps back", node=None, quick=False)
def timer_input_lost(folder):
    with Rig({**recorded(folder), "timing.mode": "timer", "timing.rate": 100.0}, folder=folder) as rig:
        _paced(rig, 50)
        rig.mark()
        rig.expect("state", "HOLD: no good input for 0.2", allowed=0.2)
        time.sleep(0.8)
        rig.stamp += 1_000_000_000
        _paced(rig, 100)
        rig.runs()
        _replayed(rig, folder)
    return rig


@fault("bodies occluded for 3 frames, then for 30, with `limits.lost_frames: 3`",
       "none needed: three are bridged, then HOLD until the next good frame", node=None, quick=False)
def frames_lost(folder):
    with Rig({**recorded(folder), "limits.lost_frames": 3, "input_rate": 50.0}, folder=folder) as rig:
        _paced(rig, 50)
        for count in (3, 30):
            rig.fault_at = None
            rig.mark()
            for _ in range(count):
                state = rig.state(rig.stamp)
                rig.judge.good[rig.stamp] = state       # may be bridged
                rig.send_at(rig.stamp, good=False, state=state._replace(pose=(math.nan,) * 7))
                rig.stamp += STEP
                time.sleep(1e-9 * STEP)
            if count == 3 and rig.value("state", "state") != "RUN":
                raise Wrong("it holds after three lost frames, expected them to be bridged")
            if count == 30:
                rig.expect("state", "HOLD: ", allowed=30 * 1e-9 * STEP)
            _paced(rig, 60)
        rig.runs()
        _replayed(rig, folder)
    return rig


@fault("/clock stands still for 2 s under `use_sim_time`, with `limits.input_age: 0.5`",
       "none needed: a clock that stands is no lost input", node=None, quick=False)
def clock_stands(folder):
    with Rig({**recorded(folder), "use_sim_time": True, "limits.input_age": 0.5}, folder=folder) as rig:
        clock = _clock(rig)
        for pause in (0.0, 2.0):
            time.sleep(pause)
            if rig.value("state", "state") == "HOLD":
                raise Wrong("it holds while the clock stands")
            _clocked(rig, clock)
        _replayed(rig, folder)
    return rig


@fault("/clock jumps back to the start under `use_sim_time`, with `on_reset: settle`", "none needed: the next sample settles", node=None, quick=False)
def clock_jumps_back(folder):
    with Rig({**recorded(folder), "use_sim_time": True, "on_reset": "settle"}, folder=folder) as rig:
        clock = _clock(rig)
        for number in range(2):
            rig.stamp = BEGIN
            if number:
                rig.judge.settle(None)
                rig.mark()
            _clocked(rig, clock)
        rig.expect("input", "settled anew: simulated time went back")
        _replayed(rig, folder)
    return rig
