"""Coupled decays with a real mooring node: a process of its own, in lockstep over DDS with the floater here."""

import contextlib
import os
import subprocess
import sys
import tempfile
from collections import deque
from pathlib import Path

import numpy as np

from mooring_ros.coupling import Coupling

from . import decay_floater as floaters
from .decay_measure import measure

DOMAIN = 92  # of ROS, for these runs alone
ROOT = Path(__file__).resolve().parents[1]
START = 600.0  # s, cold compilation included


@contextlib.contextmanager
def mooring_node(scale=1.0, delay=0.0, domain=DOMAIN, **parameters):
    """A mooring node with the scene of the decays, at a length scale; it predicts the motion by `delay` (s) if that is not zero. Settles anew after a reset."""
    given = {"scene": str(ROOT / floaters.SCENE), "scale": float(scale), "on_reset": "settle", "accuracy.enabled": False, "visual_rate": 0.0} | parameters
    if delay:
        given |= {"delay.compensate": "given", "delay.seconds": delay}
    words = [part for name, value in given.items() for part in ("-p", f"{name}:={str(value).lower() if isinstance(value, bool) else value}")]
    before = {name: os.environ.get(name) for name in ("ROS_DOMAIN_ID", "ROS_AUTOMATIC_DISCOVERY_RANGE")}
    os.environ |= {"ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    with tempfile.TemporaryFile("w+") as log:
        process = subprocess.Popen([sys.executable, "-m", "mooring_ros.node", "--ros-args", *words], cwd=ROOT, stdout=log, stderr=subprocess.STDOUT)
        try:
            yield process
        finally:
            process.terminate()
            process.wait(20.0)
            for name, value in before.items():
                if value is None:
                    os.environ.pop(name)
                else:
                    os.environ[name] = value


def decay(body, release, scale, step, seconds, scheme="extrapolated", lag=0, patience=20.0):
    """Let go and couple: times (n,), poses (n, 7), twists (n, 6), and the Counts of the link.

    body: Floater at this scale; release: decay_floater.Release; step, seconds: s at this scale. lag: steps by which the floater feels each wrench later than it could.
    """
    pose, twist = release.pose(scale), np.zeros(6)
    times, poses, twists = step * np.arange(round(seconds / step) + 1), [], []
    with Coupling(step, scheme, timeout=START, patience=patience, name="floater") as mooring:
        late = deque([mooring.begin(pose)] * (lag + 1), lag + 1)
        for _ in times:
            late.append(mooring.exchange(pose, twist))
            poses.append(pose)
            twists.append(twist)
            wrench = late[0]
            pose, twist = floaters.advance(body, pose, twist, step, lambda _, wrench=wrench: wrench)
        return times, np.array(poses), np.array(twists), mooring.counts


def decay_of(body, release, scale, step, seconds, **keywords):
    """The Decay of `decay`. Raises RuntimeError where a step was lost or came twice: such a run says nothing."""
    times, poses, twists, counts = decay(body, release, scale, step, seconds, **keywords)
    if counts.lost or counts.doubled or counts.late or counts.answered != len(times):
        raise RuntimeError(f"the lockstep did not hold: {counts}")
    return measure(times, poses, twists, release.axis, release.halves)
