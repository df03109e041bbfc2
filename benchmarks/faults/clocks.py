"""Samples that are good in themselves, at the wrong time or in the wrong order."""
import random
import threading
import time

from .judge import Wrong
from .peer import wait_until_heard
from .registry import fault
from .rig import BEGIN, STEP

NEXT = "the next good sample is answered"
SETTLE = "~/settle, once ten samples in a row agree"
HOUR = 3_600_000_000_000


@fault("a sample sent twice", NEXT)
def doubled(rig):
    rig.send(20)
    rig.mark()
    rig.send_at(rig.stamp - STEP)
    rig.expect("input", "repeated: stamp")
    rig.send(20)


@fault("every sample sent twice, for a second", NEXT)
def all_doubled(rig):
    rig.send(5)
    for _ in range(50):
        rig.mark()
        rig.send()
        rig.send_at(rig.stamp - STEP)
    rig.expect("input", "repeated: stamp")
    rig.send(20)


@fault("two samples in the wrong order", NEXT)
def reordered(rig):
    rig.send(20)
    rig.mark()
    rig.send_at(rig.stamp + STEP)
    rig.send_at(rig.stamp, good=False)
    rig.expect("input", "reordered: stamp")
    rig.stamp += 2 * STEP
    rig.send(20)


@fault("10 % of the samples lost", "none needed: the step goes over the gap, and is answered")
def a_tenth_lost(rig):
    dice = random.Random(1)
    rig.send(5)
    for _ in range(200):
        if dice.random() < 0.1:
            rig.mark()
            rig.stamp += STEP
        else:
            rig.send()
    rig.expect("input", "steps were lost")


@fault("a flood: 5000 samples as fast as they can be sent",
       "none needed: what the queue of 1000 cannot hold is lost, the others are answered, in order")
def flood(rig):
    rig.send(20)
    rig.mark()
    rig.judge.tolerance = 1e-6      # the way over the samples that are lost is a violent one, which multiplies what is rounded off
    rig.send(5000, answered=False)
    rig.answer(rig.stamp - STEP)
    rig.send(20)


@fault("bunched: ten samples at once, then nothing for 0.2 s, ten times", "none needed: each is answered by its own stamp", quick=False)
def bunched(rig):
    rig.send(5)
    for _ in range(10):
        rig.send(10, answered=False)
        time.sleep(0.2)
    rig.answer(rig.stamp - STEP)


@fault("the simulator's clock set back by an hour", SETTLE)
def clock_back(rig):
    rig.stamp += HOUR
    rig.offset += HOUR
    rig.send(20)
    _elsewhere_in_time(rig, -HOUR, "reordered: stamp")


@fault("the simulator's clock set forward by an hour", SETTLE)
def clock_forward(rig):
    rig.send(20)
    _elsewhere_in_time(rig, HOUR, "jump: stamp is 3600")


def _elsewhere_in_time(rig, by, words):
    rig.jump_clock(by)
    count = len(rig.peer.heard)
    for _ in range(12):
        rig.mark()
        rig.send_at(rig.stamp, good=False)
        rig.stamp += STEP
    rig.expect("input", words)
    rig.silence(0.1)
    if len(rig.peer.heard) > count:
        raise Wrong("a sample of the new time was answered before ~/settle")
    rig.judge.good.clear()
    rig.judge.good[rig.stamp - STEP] = rig.state(rig.stamp - STEP)
    rig.settle()
    rig.send(20)


@fault("the simulator paused for 2 s", "none needed: the next sample is answered")
def pause(rig):
    rig.send(20)
    time.sleep(2.0)
    rig.send(20)


@fault("the simulator reset: its time and its platform begin anew", SETTLE)
def reset(rig):
    rig.send(100)
    _elsewhere_in_time(rig, rig.offset + 10_000_000_000 - rig.stamp, "reordered: stamp")


@fault("the same with `on_reset: settle`", "none needed: the next sample settles", node="settling")
def reset_settles(rig):
    rig.send(100)
    rig.jump_clock(BEGIN - rig.stamp)
    rig.judge.good.clear()
    rig.judge.settle(None)
    rig.mark()
    rig.send(50)
    rig.expect("input", "settled anew: simulated time went back")


@fault("no samples for a second, with `limits.input_age: 0.5`", "none needed: HOLD until the next good sample, then it ramps back", node="age")
def input_lost(rig):
    _wall(rig)
    rig.judge.held()
    rig.mark()
    rig.expect("state", "HOLD: no good input for 0.5", allowed=0.5)
    rig.held()
    while True:
        rig.stamp = time.time_ns()
        rig.send()
        time.sleep(0.01)
        if not rig.judge.blends:
            break


@fault("the heartbeat lost, samples going on, with `limits.heartbeat: 0.3`", "the heartbeat, and ~/settle", node="heartbeat")
def heartbeat_lost(rig):
    with Heart(rig) as heart:
        rig.send(20)
        rig.judge.held()
        heart.stop()
        rig.mark()
        rig.expect("state", "SAFE: no heartbeat for 0.3", allowed=0.3, level=2)
        for _ in range(20):
            rig.send_at(rig.stamp, good=False)
            rig.stamp += STEP
        rig.silence(0.1)
        rig.held()
        ok, words = rig.services.trigger("settle")
        if ok or "heartbeat" not in words:
            raise Wrong(f"~/settle works without a heartbeat, or does not say why not: {words}")
        heart.start()
        rig.silence(0.3)
        rig.judge.good[rig.stamp - STEP] = rig.state(rig.stamp - STEP)
        rig.settle()
        rig.running()


class Heart:
    """Beats on ~/heartbeat at 20 Hz, until stopped."""

    def __init__(self, rig):
        self._publisher = rig.peer.publisher("/mooring/heartbeat", "std_msgs/msg/Empty")
        self._beats, self._end = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._work, daemon=True)

    def __enter__(self):
        self.start()
        self._thread.start()
        wait_until_heard(self._publisher, pause=0.4)
        return self

    def __exit__(self, *_):
        self._end.set()
        self._thread.join()
        self._publisher.close()

    def start(self):
        """Beat."""
        self._beats.set()

    def stop(self):
        """Stand still."""
        self._beats.clear()

    def _work(self):
        while not self._end.wait(0.05):
            if self._beats.is_set():
                self._publisher.send({})


@fault("samples a second old by the node's clock", NEXT, node="age")
def stale(rig):
    _wall(rig)
    rig.mark()
    rig.send_at(time.time_ns() - 1_000_000_000, good=False)
    rig.expect("input", "stale: sample is 1")
    _wall_on(rig)


@fault("a stamp a second ahead of the node's clock", NEXT, node="age")
def ahead(rig):
    _wall(rig)
    rig.mark()
    rig.send_at(time.time_ns() + 1_000_000_000, good=False)
    rig.expect("input", "ahead: stamp")
    _wall_on(rig)


@fault("`use_sim_time` switched on in full run, with no /clock", "switch it off: the next good sample is answered", node="age", quick=False)
def sim_time_switched(rig):
    _wall(rig)
    rig.judge.held()
    rig.mark()
    if not rig.services.set("use_sim_time", True)[0]:
        raise Wrong("use_sim_time cannot be set, expected every ROS node to let it")
    for _ in range(20):
        rig.send_at(time.time_ns(), good=False)
        time.sleep(0.02)
    rig.expect("input", "ahead: stamp is", allowed=0.4)
    rig.services.set("use_sim_time", False)
    rig.judged()
    rig.running_by_the_wall_clock()


def _wall(rig):
    """Samples by the wall clock."""
    rig.stamp = rig.offset = time.time_ns()
    _wall_on(rig)


def _wall_on(rig):
    for _ in range(20):
        rig.stamp = time.time_ns()
        rig.send()
        time.sleep(0.01)
