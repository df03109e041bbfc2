"""Several platforms, one motion: a gate for each, and a Motion of all as soon as every one has given a sample of the same stamp.

Platforms may send in any order, and some ahead of others: samples wait for those of the same stamp. As stamps of one platform only grow, one that
waits is given up when another platform has none of its stamp, but a newer one; it is counted as unpaired, with the name of who was missing.
"""
from collections import Counter, deque
from dataclasses import replace
from typing import NamedTuple

from mooring_ros.motion.convention_check import MISSING, OK, UNDECIDED, WRONG, ConventionCheck
from mooring_ros.motion.gate import REORDERED, UNPAIRED, Gate, Limits, Motion, Sample, Velocity
from mooring_ros.motion.prediction import carry_on

WAITING = 100   # samples of a platform that wait for the others; then the oldest goes


class OfPlatform(NamedTuple):
    """A Sample of the platform with this number."""

    number: int
    sample: Sample


class MotionOfAll(Motion):
    """A Motion whose pose, twist and acceleration have a row (a tuple) for each platform."""

    __slots__ = ()

    @property
    def each(self):
        return tuple(zip(self.pose, self.twist))

    def ahead(self, seconds):
        return tuple(zip(*(carry_on(pose, twist, seconds, change) for pose, twist, change in zip(self.pose, self.twist, self.acceleration))))


class _NamedGate(Gate):
    """A gate that says whose sample it has refused: to `tell`."""

    def __init__(self, name, tell, *arguments):
        super().__init__(*arguments)
        self._name, self._tell = name, tell

    def _refuse(self, reason, words):
        super()._refuse(reason, f"{self._name}: {words}")
        self._tell(self.cause)


class Ensemble:
    """What a Gate is to one platform, for several: the same names mean the same things, and counts are those of all together.

    names: of the platforms. resets: what each gate has, as a list `each`, and together (node.platforms.AllResets), or None. gates: one for each.
    samples: those of the last MotionOfAll.
    """

    def __init__(self, names, adapter, limits=None, world_frame="", velocity=Velocity(), resets=None):
        self.names, self.adapter, self.limits, self.resets = names, adapter, limits or Limits(), resets
        each = [None] * len(names) if resets is None else resets.each
        self.gates = [_NamedGate(name, self._note, adapter, self.limits, world_frame, "", velocity, own) for name, own in zip(names, each)]
        self.last, self.samples, self.cause = None, [], ""
        self._waiting = [deque() for _ in names]
        self._given_up = Counter()

    def admit(self, sample, now=None):
        """The Motion of all platforms that an OfPlatform completes, or None."""
        gate, waiting = self.gates[sample.number], self._waiting[sample.number]
        restarts = gate.restarts
        motion = gate.admit(sample.sample, now)
        if motion is None:
            return None
        for other in self.gates:
            other.frame = other.frame or gate.frame
        if gate.restarts != restarts:
            waiting.clear()
            self._begin_with(gate.restarts)
        waiting.append((motion, sample.sample))
        if len(waiting) > WAITING:
            self._give_up(sample.number, UNPAIRED, f"{WAITING} samples wait for {self._silent()}")
        return self._complete()

    @property
    def missing(self):
        """Who keeps the others waiting, as the end of a sentence; "" when nobody does."""
        first = min((queue[0][0].stamp for queue in self._waiting if queue), default=None)
        return "" if first is None else f"; waits for {self._silent()} at {first * 1e-9:.3f} s"

    def relocate(self):
        """Take the new places of those that have one; returns the Motion of all there, or None when there is none."""
        if not self.relocated:
            return None
        for gate in self.gates:
            gate.relocate()
        if any(gate.last is None for gate in self.gates):
            return None
        self._forget()
        self.last = _together(max(gate.last.stamp for gate in self.gates), [gate.last for gate in self.gates])
        return self.last

    # --- what a Gate has ---

    @property
    def received(self):
        return sum(gate.received for gate in self.gates)

    @property
    def handled(self):
        return self.received - sum(len(queue) for queue in self._waiting)

    @property
    def accepted(self):
        return sum(gate.accepted for gate in self.gates) - sum(self._given_up.values())

    @property
    def bridged(self):
        return sum(gate.bridged for gate in self.gates)

    @property
    def restarts(self):
        return sum(gate.restarts for gate in self.gates)

    @property
    def rejected(self):
        return sum((gate.rejected for gate in self.gates), self._given_up)

    @property
    def lost(self):
        return any(gate.lost for gate in self.gates)

    @property
    def frame_clock(self):
        """That of the first platform; all get the same stamps."""
        return self.gates[0].frame_clock

    @property
    def relocated(self):
        return any(gate.relocated for gate in self.gates)

    @property
    def frame(self):
        return self.gates[0].frame

    @property
    def child_frame(self):
        """Frames of the platforms, a tuple."""
        return tuple(gate.child_frame for gate in self.gates)

    # --- inside ---

    def _note(self, cause):
        self.cause = cause

    def _forget(self):
        for queue in self._waiting:
            queue.clear()

    def _begin_with(self, restarts):
        """Forget what is from before the reset that a platform has seen first."""
        self.last = None
        for gate, queue in zip(self.gates, self._waiting):
            if gate.restarts < restarts:
                queue.clear()

    def _complete(self):
        while all(self._waiting):
            newest = max(queue[0][0].stamp for queue in self._waiting)
            late = [number for number, queue in enumerate(self._waiting) if queue[0][0].stamp < newest]
            if not late:
                motion = self._joined(newest)
                if motion is not None:
                    return motion
            without = ", ".join(name for name, queue in zip(self.names, self._waiting) if queue and queue[0][0].stamp == newest)
            for number in late:
                self._give_up(number, UNPAIRED, f"nothing of {without} with this stamp")
        return None

    def _joined(self, stamp):
        if self.last is not None and stamp <= self.last.stamp:
            for number in range(len(self.names)):
                self._give_up(number, REORDERED, f"not after the last, {self.last.stamp * 1e-9:.9f} s")
            return None
        motions, samples = zip(*(queue.popleft() for queue in self._waiting))
        self.samples, self.last = samples, _together(stamp, motions)
        return self.last

    def _give_up(self, number, reason, words):
        motion, _ = self._waiting[number].popleft()
        self._given_up[reason] += 1
        self.cause = f"{reason}: {self.names[number]}: sample at {motion.stamp * 1e-9:.9f} s: {words}"

    def _silent(self):
        return ", ".join(name for name, queue in zip(self.names, self._waiting) if not queue)


class Checks:
    """A ConventionCheck for each platform of an Ensemble."""

    def __init__(self, ensemble):
        self._ensemble = ensemble
        self._each = [ConventionCheck(ensemble.adapter) for _ in ensemble.names]

    def anew(self):
        """Checks that begin again."""
        return Checks(self._ensemble)

    @property
    def moved(self):
        """Whether the platform that the verdict is of has moved enough to tell."""
        return self._worst()[1].moved

    @property
    def finished(self):
        return self.verdict.kind == WRONG or all(check.finished for check in self._each)

    @property
    def verdict(self):
        """The worst of all platforms, with its name."""
        name, check = self._worst()
        return check.verdict if check.verdict.kind == OK else replace(check.verdict, text=f"{name}: {check.verdict.text}")

    def _worst(self):
        """(name, check) of the platform with the worst verdict; one that lies still has none of its own, and stands behind those that nothing fits."""
        kinds = (WRONG, MISSING, UNDECIDED, OK)
        return min(zip(self._ensemble.names, self._each), key=lambda pair: (kinds.index(pair[1].verdict.kind), not pair[1].moved))

    def look_at(self, motion, _):
        """Take the last Motion of the ensemble, and the samples that it is from; returns the verdict."""
        for check, pose, sample in zip(self._each, motion.pose, self._ensemble.samples):
            if not check.finished:
                check.add(motion.time, pose, sample.twist, sample.twist_frame)
        return self.verdict


def _together(stamp, motions):
    frame_times = [motion.frame_time for motion in motions]
    poses, twists, accelerations = zip(*((motion.pose, motion.twist, motion.acceleration) for motion in motions))
    bridged = any(motion.bridged for motion in motions)
    return MotionOfAll(stamp, poses, twists, accelerations, None if None in frame_times else max(frame_times), bridged)
