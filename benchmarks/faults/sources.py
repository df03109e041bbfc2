"""What happens around the source of the motion, and around those who listen."""
import contextlib
import math
import os
import signal
import subprocess
import sys
import time

from . import motion
from .judge import Wrong
from .peer import ODOMETRY, WRENCH, wait_until_heard
from .process import ROOT
from .registry import fault
from .rig import BEGIN, STEP, Rig
from .setups import QUIET

YAW = 0.6      # rad
SETTLE = "~/settle, once ten samples in a row agree"


class Simulator:
    """benchmarks.faults.simulator as a child. stamps: read so far."""

    def __init__(self, domain, begin=BEGIN, shift=0.0):
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])])}
        self._process = subprocess.Popen([sys.executable, "-m", "benchmarks.faults.simulator", str(domain), str(begin), str(shift)], cwd=ROOT,
                                         env=environment, stdout=subprocess.PIPE, stdin=subprocess.DEVNULL)
        self.last = None

    def read(self, count=1):
        """Wait for so many more samples; returns the stamp (ns) of the last."""
        for _ in range(count):
            self.last = int(self._process.stdout.readline())
        return self.last

    def freeze(self):
        """Stop it between two samples; returns the stamp of the last."""
        self._process.send_signal(signal.SIGSTOP)
        os.set_blocking(self._process.stdout.fileno(), False)
        time.sleep(0.1)
        for line in self._process.stdout:
            self.last = int(line)
        os.set_blocking(self._process.stdout.fileno(), True)
        return self.last

    def go_on(self):
        """After `freeze`."""
        self._process.send_signal(signal.SIGCONT)

    def kill(self):
        """SIGKILL."""
        self._process.kill()
        self._process.wait()
        self._process.stdout.close()


@contextlib.contextmanager
def simulator(rig, begin=BEGIN, shift=0.0):
    """A running Simulator, killed at the end."""
    child = Simulator(rig.domain, begin, shift)
    try:
        yield child
    finally:
        child.kill()


def _own(rig):
    """All samples of the simulator may be answered."""
    for k in range(3000):
        stamp = BEGIN + k * STEP
        rig.judge.good[stamp] = motion.at(stamp * 1e-9)


# A publisher that ended is known for some twenty seconds more: where they are counted, the domain is a fresh one.
@fault("a second simulator with the same motion", "end one of them; the first of two equal stamps is answered", node=None, quick=False)
def two_equal_publishers(folder):
    with Rig(QUIET, folder=folder) as rig:
        rig.send(20)
        other = rig.peer.publisher("/platform/odom", ODOMETRY)
        rig.mark()
        wait_until_heard(other, pause=0.0)
        rig.expect("input", "2 publishers")
        for _ in range(50):
            stamp, state = rig.stamp, rig.state(rig.stamp)
            rig.mark()
            rig.send()
            other.send(motion.odometry(stamp, state))
        rig.expect("input", "2 publishers.*repeated")
        rig.send(20)
    return rig


@fault("a second simulator at the same time, 5 m off", "end one of them; the first one is answered all the while", node=None)
def two_publishers(folder):
    with Rig(QUIET, folder=folder) as rig:
        rig.send(20)
        with simulator(rig, rig.stamp + STEP // 2, 5.0) as second:
            second.read(1)
            rig.mark()
            for _ in range(50):
                rig.send()
                time.sleep(0.9e-9 * STEP)
            rig.expect("input", "2 publishers.*jump: pose is", allowed=1.0)     # somewhere in that second
            rig.send(20)
    return rig


@fault("the simulator killed in full run, and restarted from its beginning", SETTLE, quick=False)
def simulator_killed(rig):
    _own(rig)
    with simulator(rig) as first:
        first.read(100)
    rig.peer.wait(lambda: False, 0.2)
    rig.judged()
    count = len(rig.peer.heard)
    with simulator(rig) as second:
        second.read(1)
        rig.mark()
        second.read(20)
        rig.expect("input", "reordered: stamp")
        if len(rig.peer.heard) > count:
            raise Wrong("the restarted simulator was answered before ~/settle")
        rig.stamp = second.freeze() + STEP
        rig.settle()
        second.go_on()
        second.read(20)
        rig.answer(second.freeze())


@fault("the listener of the wrench goes away and comes back", "none needed: it hears the wrenches from then on")
def listener_gone(rig):
    with contextlib.closing(rig.peer.subscription("/mooring/wrench", WRENCH)) as other:
        rig.send(20)
        if other.read(timeout=2.0) is None:
            raise Wrong("a second listener hears nothing")
    rig.send(20)


@fault("a listener that never reads", "none needed: the others are answered all the same")
def listener_asleep(rig):
    with contextlib.closing(rig.peer.subscription("/mooring/wrench", WRENCH)):
        rig.send(500)


@fault("a publisher that is best effort only", "none needed: while there is no other, it is heard likewise", node=None, quick=False)
def best_effort_publisher(folder):
    with Rig(QUIET, folder=folder, reliability="best_effort") as rig:
        if "best-effort" not in rig.process.log:
            raise Wrong(f"the log does not say that the publisher is best effort:\n{rig.process.log}")
        rig.shown.append(("the log", "all publishers of /platform/odom are best-effort: listens to it likewise", 1.0))
        rig.send(50, answered=False, period=0.02)
        rig.answer(rig.stamp - STEP)
    return rig


def _to_body(v, yaw):
    """A velocity in the axes of a platform that is turned by yaw (rad)."""
    c, s = math.cos(yaw), math.sin(yaw)
    return c * v[0] + s * v[1], c * v[1] - s * v[0], v[2]


@fault("velocities in world axes where the platform's are expected, at 0.6 rad of yaw", "set `twist_frame: world`; ~/settle tries again")
def wrong_axes(rig):
    _wrong_twist(rig, lambda v: v, "world")


@fault("velocities forward-right-down where forward-left-up is expected", "set `convention: ned` at a source that is; ~/settle tries again")
def ned_twist(rig):
    def given(v):
        x, y, z = _to_body(v, YAW)
        return x, -y, -z
    _wrong_twist(rig, given, "does not move the pose")


def _wrong_twist(rig, given, words):
    """Motion in circles at a yaw of 0.6 rad, its twist in the wrong axes."""
    half, rate = 0.5 * YAW, 2.0 * math.pi / 8.0
    for _ in range(400):
        t = (rig.stamp - BEGIN) * 1e-9
        v = (4.0 * rate * math.cos(rate * t), -3.0 * rate * math.sin(rate * t), 2.0 * rate * math.cos(2.0 * rate * t))
        pose = (4.0 * math.sin(rate * t), 3.0 * math.cos(rate * t), math.sin(2.0 * rate * t), 0.0, 0.0, math.sin(half), math.cos(half))
        message = motion.odometry(rig.stamp, motion.State(pose, (*v, 0.0, 0.0, 0.0)))
        message["twist"]["twist"]["linear"] = dict(zip("xyz", given(v)))
        rig.fault_at = time.monotonic()
        rig.peer.odometry.send(message)
        rig.stamp += STEP
        if not rig.peer.wait(lambda: rig.peer.heard and rig.peer.heard[-1].stamp == rig.stamp - STEP, 0.2):
            break
    else:
        raise Wrong("400 samples with the twist in other axes were all answered")
    rig.expect("input", words, level=2)
    for _ in range(20):
        rig.send_at(rig.stamp, good=False)
        rig.stamp += STEP
    rig.silence(0.3)
    rig.unjudged()      # until it was found out they were answered as given, which no reference can say to be wrong
