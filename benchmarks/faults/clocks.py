"""Samples that are good in themselves, at the wrong time or in the wrong order."""
import random
import time

from .judge import Wrong
from .registry import fault
from .rig import STEP

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
    rig.expect("input", "lost|skipped|gap|missing")


@fault("bunched: ten samples at once, then nothing for 0.2 s, ten times", "none needed: each is answered by its own stamp")
def bunched(rig):
    rig.send(5)
    for _ in range(10):
        rig.send(10, answered=False)
        time.sleep(0.2)
    rig.answer(rig.stamp - STEP)


@fault("the simulator's clock set back by an hour", SETTLE)
def clock_back(rig):
    rig.stamp += HOUR
    rig._offset += HOUR
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
    _elsewhere_in_time(rig, rig._offset + 10_000_000_000 - rig.stamp, "reordered: stamp")


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


def _wall(rig):
    """Samples by the wall clock."""
    rig.stamp = rig._offset = time.time_ns()
    _wall_on(rig)


def _wall_on(rig):
    for _ in range(20):
        rig.stamp = time.time_ns()
        rig.send()
        time.sleep(0.01)
