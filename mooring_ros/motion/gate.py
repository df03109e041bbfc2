"""The watch-dog in front of the core: each sample of the platform's motion passes here, or is counted with its reason.

A sample is refused when it holds a number that is not finite, a quaternion that is not unit, a stamp that repeats, runs
backwards or is older (or newer) than the receiving clock allows, a frame that is not the expected one, or a jump that no
platform makes.

A source that restarts, or a platform that is put elsewhere, is refused like any other jump. Once RELOCATED_AFTER samples
in a row agree with each other, the gate knows the new place, and `relocate` (the ~/settle service) moves there. It never goes
there by itself: the step from the old place to the new one would be a blow to the lines that never happened.
"""
import math
from collections import Counter
from dataclasses import dataclass
from typing import NamedTuple

from mooring_ros.motion import rotation
from mooring_ros.motion.velocity import OnlineTwist

UNIT_TOLERANCE = 1e-3
RELOCATED_AFTER = 10

NON_FINITE, QUATERNION, STALE, AHEAD, REPEATED, REORDERED, JUMP, FRAME, UNPAIRED, MALFORMED = REASONS = (
    "non_finite", "quaternion", "stale", "ahead", "repeated", "reordered", "jump", "frame", "unpaired", "malformed")

# Below these a difference is never a jump, however short the time: noise of a motion capture at 1 kHz stays in.
_JUMP_FLOOR, _JUMP_FLOOR_ANGLE = 0.1, 0.01


@dataclass
class Limits:
    """What a platform can do, at full scale; zero switches a limit off.

    input_age: s by the receiving clock. jump: m, jump_angle: rad: how far the new pose may lie from where the last pose and the
    twists lead. jump_speed: m/s, jump_rate: rad/s: by how much a twist may change from sample to sample, and how fast such a
    difference of pose may arise. gap: s, the longest time between two samples that is still one motion.
    """

    input_age: float = 0.0
    jump: float = 10.0
    jump_angle: float = 0.5
    jump_speed: float = 10.0
    jump_rate: float = 2.0
    gap: float = 60.0


class Sample(NamedTuple):
    """One sample as the source gave it, in its own convention and scale. twist is None when the source has none."""

    stamp: int                      # ns
    pose: tuple                     # (7,)
    twist: tuple | None             # (6,)
    frame: str = ""                 # frame of the pose
    child_frame: str = ""           # the platform's frame
    twist_frame: str | None = None  # child | world where the message itself says so


class Motion(NamedTuple):
    """One accepted sample in the inside convention."""

    stamp: int      # ns, as given
    pose: tuple     # (7,) m, world ENU, unit quaternion
    twist: tuple    # (6,) m/s, rad/s, world axes


class Gate:
    """Admits samples one by one.

    received, accepted: counts. rejected: Counter of REASONS. cause: words for the last refusal. frame, child_frame: as given by the
    parameters, else pinned to those of the first accepted sample ("" in a message means not said, and is let through).
    """

    def __init__(self, adapter, limits=None, world_frame="", platform_frame=""):
        self.adapter = adapter
        self.limits = limits or Limits()
        self.frame, self.child_frame = world_frame, platform_frame
        self.received = self.accepted = 0
        self.rejected = Counter()
        self.cause = ""
        self.last = None
        self._online = OnlineTwist()
        self._candidate = None
        self._agreeing = 0

    def admit(self, sample, now=None):
        """The Motion of a good sample, or None. now: the receiving clock in ns, needed where the age is limited."""
        self.received += 1
        problem = self._check_sample(sample, now)
        if problem:
            return self._refuse(*problem)
        motion, given = self._convert(sample)
        if not math.isfinite(sum(motion.pose) + sum(motion.twist)):
            return self._refuse(NON_FINITE, "pose or twist is too large to convert")
        if self.last is not None:
            problem = self._check_against(self.last, motion, given)
            if problem:
                if problem[0] in (JUMP, REORDERED):
                    self._remember(motion, given)
                return self._refuse(*problem)
        return self._accept(motion, given, sample)

    def reject(self, reason, words):
        """Count what never became a sample."""
        self.received += 1
        self._refuse(reason, words)

    @property
    def relocated(self):
        """Whether refused samples agree on a new place, or a new time, to which `relocate` can go."""
        return self._agreeing >= RELOCATED_AFTER

    def relocate(self):
        """Take the new place as the place; returns its last Motion, or None when there is none."""
        if not self.relocated:
            return None
        motion, given = self._candidate
        self._online = OnlineTwist()
        return self._accept(motion, given)

    # --- checks: each returns None, or (reason, words) ---

    def _check_sample(self, sample, now):
        # The sum of numbers with one among them that is not finite is not finite; of numbers so large, it is no loss either.
        if not math.isfinite(sum(sample.pose)):
            return NON_FINITE, f"pose {_short(sample.pose)} is not finite"
        if sample.twist is not None and not math.isfinite(sum(sample.twist)):
            return NON_FINITE, f"twist {_short(sample.twist)} is not finite"
        # hypot keeps a huge component from overflowing
        norm = math.hypot(*sample.pose[3:7])
        if abs(norm - 1.0) > UNIT_TOLERANCE:
            return QUATERNION, f"quaternion {_short(sample.pose[3:7])} has length {norm:.6g}, expected 1"
        if sample.frame != self.frame and sample.frame and self.frame:
            return FRAME, f"frame of the pose is '{sample.frame}', expected '{self.frame}'"
        if sample.child_frame != self.child_frame and sample.child_frame and self.child_frame:
            return FRAME, f"frame of the platform is '{sample.child_frame}', expected '{self.child_frame}'"
        if self.limits.input_age > 0.0 and now is not None:
            age = (now - sample.stamp) * 1e-9
            if age > self.limits.input_age:
                return STALE, f"sample is {age:.3f} s old, limit {self.limits.input_age:g} s"
            if -age > self.limits.input_age:
                return AHEAD, f"stamp is {-age:.3f} s ahead of the clock, limit {self.limits.input_age:g} s"
        return None

    def _check_against(self, last, motion, given):
        if motion.stamp == last.stamp:
            return REPEATED, f"stamp {motion.stamp * 1e-9:.9f} s came again"
        if motion.stamp < last.stamp:
            return REORDERED, f"stamp {motion.stamp * 1e-9:.9f} s is before the last, {last.stamp * 1e-9:.9f} s"
        return self._check_jump(last, motion, given)

    def _check_jump(self, last, motion, given):
        limits = self.limits
        dt = (motion.stamp - last.stamp) * 1e-9 * self.adapter.time_factor
        if limits.gap and dt > limits.gap:
            return JUMP, f"stamp is {dt:.6g} s after the last, limit {limits.gap:g} s"
        v, w = last.twist[:3], last.twist[3:]
        if given:
            problem = self._check_change(last.twist, motion.twist)
            if problem:
                return problem
            v, w = _middle(v, motion.twist[:3]), _middle(w, motion.twist[3:])
        off = _miss(last.pose, motion.pose, v, dt)
        limit = _least(limits.jump, limits.jump_speed * dt, _JUMP_FLOOR)
        if off > limit:
            return JUMP, f"pose is {off:.4g} m from where the motion led, limit {limit:.4g} m after {dt:.4g} s"
        off = _miss((0.0, 0.0, 0.0), rotation.turn_between(last.pose[3:], motion.pose[3:]), w, dt)
        limit = _least(limits.jump_angle, limits.jump_rate * dt, _JUMP_FLOOR_ANGLE)
        if off > limit:
            return JUMP, f"attitude is {off:.4g} rad from where the motion led, limit {limit:.4g} rad after {dt:.4g} s"
        return None

    def _check_change(self, old, new):
        for part, limit, unit in ((slice(0, 3), self.limits.jump_speed, "m/s"), (slice(3, 6), self.limits.jump_rate, "rad/s")):
            change = math.dist(new[part], old[part])
            if limit and change > limit:
                return JUMP, f"twist changed by {change:.4g} {unit} in one sample, limit {limit:.4g} {unit}"
        return None

    # --- outcomes ---

    def _convert(self, sample):
        pose = sample.pose
        norm = math.hypot(*pose[3:7])
        if norm != 1.0:
            pose = (*pose[:3], *(c / norm for c in pose[3:7]))
        pose = self.adapter.pose_in(pose)
        given = sample.twist is not None
        twist = self.adapter.twist_in(sample.twist, pose[3:], sample.twist_frame) if given else (0.0,) * 6
        return Motion(sample.stamp, pose, twist), given

    def _accept(self, motion, given, sample=None):
        if not given:
            motion = motion._replace(twist=self._online.update(motion.stamp * 1e-9 * self.adapter.time_factor, motion.pose))
        if sample is not None:
            self.accepted += 1
            self.frame = self.frame or sample.frame
            self.child_frame = self.child_frame or sample.child_frame
        self.last = motion
        self._candidate, self._agreeing = None, 0
        return motion

    def _remember(self, motion, given):
        agrees = self._candidate and self._check_against(self._candidate[0], motion, given) is None
        self._agreeing = self._agreeing + 1 if agrees else 1
        self._candidate = motion, given

    def _refuse(self, reason, words):
        self.rejected[reason] += 1
        self.cause = f"{reason}: {words}"
        return None


def _middle(a, b):
    return 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])


def _miss(a, b, v, dt):
    """Distance between b and where the speed v leads from a."""
    return math.hypot(b[0] - a[0] - dt * v[0], b[1] - a[1] - dt * v[1], b[2] - a[2] - dt * v[2])


def _least(limit, limit_by_speed, floor):
    """The smaller of the two that are switched on (not zero)."""
    return min(limit or math.inf, max(limit_by_speed, floor) if limit_by_speed else math.inf)


def _short(numbers):
    return "(" + ", ".join(f"{x:.6g}" for x in numbers) + ")"
