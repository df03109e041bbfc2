"""The watch-dog in front of the core: each sample of the platform's motion passes here, or is counted with its reason.

A sample is refused when it holds a number that is not finite, a quaternion that is not unit, a stamp that repeats, runs
backwards or is older (or newer) than the receiving clock allows, a frame that is not the expected one, or a jump that no
platform makes. Twists that a source does not give are made from its poses here, and pass the same limits.

A camera system that loses sight of the platform goes on sending, without numbers. Up to limits.lost_frames such frames in a row are bridged: they
are counted as refused, and the motion is carried on. After that the input is `lost`.

A source that restarts, or a platform that is put elsewhere, is refused like any other jump. Once RELOCATED_AFTER samples
in a row agree with each other, the gate knows the new place, and `relocate` (the ~/settle service) moves there. It never goes
there by itself: the step from the old place to the new one would be a blow to the lines that never happened.
"""
import math
from collections import Counter
from dataclasses import dataclass
from typing import NamedTuple

from mooring_ros.motion import rotation
from mooring_ros.motion.frame_clock import FrameClock
from mooring_ros.motion.freshness import Freshness
from mooring_ros.motion.prediction import REST, acceleration_between, carry_on
from mooring_ros.motion.tracking import PoseFilter
from mooring_ros.motion.velocity import OnlineTwist

UNIT_TOLERANCE = 1e-3
RELOCATED_AFTER = 10
DEFAULT_BANDWIDTH = 1.2             # Hz at full scale: six times the frequency of waves of 5 s
_LARGEST_SHARE = 1.0 / 15.0         # of the rate, that the bandwidth is where nobody says it

NON_FINITE, QUATERNION, STALE, AHEAD, REPEATED, REORDERED, JUMP, FRAME, UNPAIRED, MALFORMED, EARLY, FROZEN = REASONS = (
    "non_finite", "quaternion", "stale", "ahead", "repeated", "reordered", "jump", "frame", "unpaired", "malformed", "early", "frozen")
LOST = (NON_FINITE, QUATERNION, FROZEN)     # what a camera system sends while it does not see the platform

# Below these a difference is never a jump, however short the time: noise of a motion capture at 1 kHz stays in.
_JUMP_FLOOR, _JUMP_FLOOR_ANGLE = 0.1, 0.01
_NOWHERE = (0.0, 0.0, 0.0)


@dataclass
class Limits:
    """What a platform can do, at full scale; zero switches a limit off.

    input_age: s by the receiving clock. jump: m, jump_angle: rad: how far the new pose may lie from where the last pose and the
    twists lead. jump_speed: m/s, jump_rate: rad/s: by how much a twist may change from sample to sample (and how large one
    may be that is made of poses), and how fast such a difference of pose may arise. gap: s, the longest time between two samples that is
    still one motion. lost_frames: how many samples in a row that hold no pose are bridged (0: none).
    """

    input_age: float = 0.0
    jump: float = 10.0
    jump_angle: float = 0.5
    jump_speed: float = 10.0
    jump_rate: float = 2.0
    gap: float = 60.0
    lost_frames: int = 0


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

    stamp: int                      # ns, as given
    pose: tuple                     # (7,) m, world ENU, unit quaternion
    twist: tuple                    # (6,) m/s, rad/s, world axes
    acceleration: tuple = REST      # (6,) m/s², rad/s², world axes
    frame_time: int | None = None   # ns, when the frame was taken, where the rate is known
    bridged: bool = False           # carried on over a frame without a pose

    @property
    def time(self):
        """When the platform was there, ns by the source's clock."""
        return self.stamp if self.frame_time is None else self.frame_time

    @property
    def each(self):
        """(pose, twist) of every platform: of one, or of several (ensemble.py)."""
        return ((self.pose, self.twist),)

    def ahead(self, seconds):
        """Pose and twist some seconds (inside) later."""
        return carry_on(self.pose, self.twist, seconds, self.acceleration)


class Velocity(NamedTuple):
    """How twists are made of poses, and how bunched stamps are put right.

    rate: Hz of the frames by the source's clock; 0: not known, then three poses are differenced and stamps are taken at their word.
    bandwidth: Hz, see tracking.PoseFilter; 0: DEFAULT_BANDWIDTH, but at most a fifteenth of the rate.
    """

    rate: float = 0.0
    bandwidth: float = 0.0

    def tracker(self, time_factor):
        """What makes twists of poses at times inside."""
        if not self.rate:
            return OnlineTwist()
        if self.bandwidth >= 0.5 * self.rate:
            raise ValueError(f"input_bandwidth is {self.bandwidth:g} Hz, expected less than half of input_rate, {self.rate:g} Hz")
        rate = self.rate / time_factor
        return PoseFilter(1.0 / rate, self.bandwidth / time_factor or min(DEFAULT_BANDWIDTH, _LARGEST_SHARE * rate))

    def frame_clock(self):
        """What makes frame times of stamps, or None."""
        return FrameClock(self.rate) if self.rate else None


class Gate:
    """Admits samples one by one.

    received, accepted: counts. rejected: Counter of REASONS. cause: words for the last refusal. frame, child_frame: as given by the
    parameters, else pinned to those of the first accepted sample ("" in a message means not said, and is let through). bridged: frames without a
    pose over which the motion was carried on. velocity: see Velocity. resets: what tells a simulation's reset from a reordered sample
    (node.resets), or None. restarts: resets after which a new motion was begun. missing: whom a gate of several waits for (ensemble.py); one waits for nobody.
    """

    missing = ""

    def __init__(self, adapter, limits=None, world_frame="", platform_frame="", velocity=Velocity(), resets=None):
        self.adapter = adapter
        self.limits = limits or Limits()
        self.frame, self.child_frame = world_frame, platform_frame
        self.received = self.accepted = self.bridged = self.restarts = 0
        self.resets, self._after_reset = resets, False
        self.rejected = Counter()
        self.cause = ""
        self.last = None
        self._velocity = velocity
        self._freshness = Freshness() if velocity.rate else None
        self._lost_run = 0
        self._start_anew()

    def _start_anew(self):
        self._tracker = self._velocity.tracker(self.adapter.time_factor)
        self.frame_clock = self._velocity.frame_clock()
        self._origin = None
        self._real, self._interval = None, 0        # ns: time of the last sample that was none of ours, and from the one before to it
        self._candidate = None
        self._agreeing = 0

    def admit(self, sample, now=None):
        """The Motion of a good sample, or of one that is bridged; else None. now: the receiving clock in ns, needed where the age is limited."""
        self.received += 1
        problem = self._check_sample(sample, now)
        if problem:
            self._refuse(*problem)
            return self._bridge(sample) if problem[0] in LOST else None
        motion, given = self._convert(sample)
        if not math.isfinite(sum(motion.pose) + sum(motion.twist)):
            return self._refuse(NON_FINITE, "pose or twist is too large to convert")
        if self.last is not None and self.resets is not None and self.resets.seen(motion.stamp, self.last.stamp):
            self._follow_reset()
        problem = self._check_stamp(self.last, motion)
        if problem and problem[0] == REPEATED and self._freshness is not None and self._freshness.new:
            problem = None      # another frame of a bunch, by a clock that is coarser than the bunch
        if problem is None and self.frame_clock is not None:
            motion, problem = self._timed(motion)
        estimate = None
        if problem is None:
            motion, estimate, problem = self._moved(self.last, motion, given)
        if problem:
            if problem[0] in (JUMP, REORDERED):
                self._remember(motion, given)
            return self._refuse(*problem)
        self.accepted += 1
        self._lost_run = 0
        self.frame = self.frame or sample.frame
        self.child_frame = self.child_frame or sample.child_frame
        return self._accept(motion, estimate)

    @property
    def handled(self):
        """How many of those received have been answered or refused, and do not wait for others (ensemble.py)."""
        return self.received

    def reject(self, reason, words):
        """Count what never became a sample."""
        self.received += 1
        self._refuse(reason, words)

    @property
    def lost(self):
        """Whether more frames in a row came without a pose than are bridged."""
        return 0 < self.limits.lost_frames < self._lost_run

    @property
    def relocated(self):
        """Whether refused samples agree on a new place, or a new time, to which `relocate` can go; after a reset, one of them is enough."""
        return self._candidate is not None and (self._after_reset or self._agreeing >= RELOCATED_AFTER)

    def relocate(self):
        """Take the new place as the place; returns its last Motion, or None when there is none."""
        if not self.relocated:
            return None
        motion, given = self._candidate
        self._start_anew()
        self._lost_run = 0
        motion, estimate, _ = self._moved(None, motion, given)
        return self._accept(motion, estimate)

    def _follow_reset(self):
        self._after_reset = True
        if self.resets.settles:
            self.restarts += 1
            self.last = None
            self._start_anew()

    # --- checks: each returns None, or (reason, words) ---

    def _check_sample(self, sample, now):
        if sample.frame != self.frame and sample.frame and self.frame:
            return FRAME, f"frame of the pose is {sample.frame!r}, expected {self.frame!r}"
        if sample.child_frame != self.child_frame and sample.child_frame and self.child_frame:
            return FRAME, f"frame of the platform is {sample.child_frame!r}, expected {self.child_frame!r}"
        if self.limits.input_age > 0.0 and now is not None:
            age = (now - sample.stamp) * 1e-9
            if age > self.limits.input_age:
                return STALE, f"sample is {age:.3f} s old, limit {self.limits.input_age:g} s"
            if -age > self.limits.input_age:
                return AHEAD, f"stamp is {-age:.3f} s ahead of the clock, limit {self.limits.input_age:g} s"
        # The sum of numbers with one among them that is not finite is not finite; of numbers so large, it is no loss either.
        if not math.isfinite(sum(sample.pose)):
            return NON_FINITE, f"pose {_short(sample.pose)} is not finite"
        if sample.twist is not None and not math.isfinite(sum(sample.twist)):
            return NON_FINITE, f"twist {_short(sample.twist)} is not finite"
        # hypot keeps a huge component from overflowing
        norm = math.hypot(*sample.pose[3:7])
        if abs(norm - 1.0) > UNIT_TOLERANCE:
            return QUATERNION, f"quaternion {_short(sample.pose[3:7])} has length {norm:.6g}, expected 1"
        if self._freshness is not None and self._freshness.frozen(sample.pose) and sample.twist is None and sample.stamp != self._last_stamp:
            return FROZEN, "pose came again bit for bit, of a source whose poses never did: is the platform out of sight?"
        return None

    @property
    def _last_stamp(self):
        return None if self.last is None else self.last.stamp

    @staticmethod
    def _check_stamp(last, motion):
        if last is None or motion.stamp > last.stamp:
            return None
        if motion.stamp == last.stamp:
            return REPEATED, f"stamp {motion.stamp * 1e-9:.9f} s came again"
        return REORDERED, f"stamp {motion.stamp * 1e-9:.9f} s is before the last, {last.stamp * 1e-9:.9f} s"

    def _check_jump(self, last, motion, given):
        limits = self.limits
        dt = self._seconds(motion.time - last.time)
        if limits.gap and dt > limits.gap:
            return JUMP, f"stamp is {dt:.6g} s after the last, limit {limits.gap:g} s"
        v, w = last.twist[:3], last.twist[3:]
        turn = rotation.turn_between(last.pose[3:], motion.pose[3:])
        if given:
            problem = self._check_change(last.twist, motion.twist)
            if problem:
                return problem
            v, w = _middle(v, motion.twist[:3]), _middle(w, motion.twist[3:])
        off, off_angle = _miss(last.pose, motion.pose, v, dt), _miss(_NOWHERE, turn, w, dt)
        if not given:   # over a long gap, as near the last place as where its twist leads is near enough
            off, off_angle = min(off, math.dist(last.pose[:3], motion.pose[:3])), min(off_angle, math.hypot(*turn))
        limit = _least(limits.jump, limits.jump_speed * dt, _JUMP_FLOOR)
        if off > limit:
            return JUMP, f"pose is {off:.4g} m from where the motion led, limit {limit:.4g} m after {dt:.4g} s"
        limit = _least(limits.jump_angle, limits.jump_rate * dt, _JUMP_FLOOR_ANGLE)
        if off_angle > limit:
            return JUMP, f"attitude is {off_angle:.4g} rad from where the motion led, limit {limit:.4g} rad after {dt:.4g} s"
        return None

    def _check_change(self, old, new, words="twist changed by {} in one sample"):
        for part, limit, unit in ((slice(0, 3), self.limits.jump_speed, "m/s"), (slice(3, 6), self.limits.jump_rate, "rad/s")):
            change = math.dist(new[part], old[part])
            if limit and change > limit:
                return JUMP, f"{words.format(f'{change:.4g} {unit}')}, limit {limit:.4g} {unit}"
        return None

    # --- what a sample becomes ---

    def _convert(self, sample):
        pose = sample.pose
        norm = math.hypot(*pose[3:7])
        if norm != 1.0:
            pose = (*pose[:3], *(c / norm for c in pose[3:7]))
        pose = self.adapter.pose_in(pose)
        given = sample.twist is not None
        twist = self.adapter.twist_in(sample.twist, pose[3:], sample.twist_frame) if given else REST
        return Motion(sample.stamp, pose, twist), given

    def _timed(self, motion):
        """The Motion with the time of its frame, or why it has none."""
        last = self.last

        def miss(time):
            led, _ = carry_on(last.pose, last.twist, self._seconds(time - last.time), last.acceleration)
            return math.dist(led[:3], motion.pose[:3])

        time = self.frame_clock.propose(motion.stamp, miss)
        if time is None:
            return motion, (EARLY, f"frame comes before it is due at {self._velocity.rate:g} Hz; is that the rate?")
        return motion._replace(frame_time=time), None

    def _moved(self, last, motion, given):
        """The Motion with twist and acceleration, the Estimate they are from (None where the twist is given), and what is wrong with them."""
        problem = None if last is None else self._check_jump(last, motion, given)
        if problem:
            return motion, None, problem
        if given:
            if last is not None:
                change = acceleration_between(0.0, last.twist, self._seconds(motion.time - last.time), motion.twist)
                motion = motion._replace(acceleration=change)
            return motion, None, None
        origin = motion.time if self._origin is None else self._origin
        estimate = self._tracker.propose(self._seconds(motion.time - origin), motion.pose)
        if last is not None:    # as a whole: one that was let through, and is wrong, must not shut out those that are right
            problem = self._check_change(REST, estimate.twist, "twist, made of the poses, is {}")
        return motion._replace(pose=estimate.pose, twist=estimate.twist, acceleration=estimate.acceleration), estimate, problem

    def _bridge(self, sample):
        """The Motion of a frame without a pose, carried on from the last; None where that is not wanted, or no more."""
        last = self.last
        self._lost_run += 1
        if last is None or self._lost_run > self.limits.lost_frames or sample.stamp <= last.stamp:
            return None
        time = None if self.frame_clock is None else self.frame_clock.propose(sample.stamp)
        time = sample.stamp if time is None else time
        # A stamp that leaps is no reason to leap along: so many intervals between frames since the last that was real, and no more; the stamp
        # of a frame that is late itself may be as much again.
        most = (self.limits.lost_frames + 0.5) * self._interval
        if time <= last.time or time - self._real > most or sample.stamp - self._real > 2.0 * most:
            return None
        ahead = self._seconds(time - last.time)
        self.bridged += 1
        pose, twist = carry_on(last.pose, last.twist, ahead, last.acceleration)
        return self._accept(Motion(sample.stamp, pose, twist, last.acceleration, time, bridged=True))

    def _seconds(self, nanoseconds):
        return nanoseconds * 1e-9 * self.adapter.time_factor

    # --- outcomes ---

    def _accept(self, motion, estimate=None):
        if estimate is not None:
            self._tracker.take(estimate)
            self._origin = motion.time if self._origin is None else self._origin
        if self.frame_clock is not None:
            self.frame_clock.take(motion.time, motion.stamp)
        if self.resets is not None and (self.last is None or motion.stamp < self.last.stamp):
            self.resets.begin(motion.stamp)
        if not motion.bridged:
            if self._real is not None:
                self._interval = motion.time - self._real if self.frame_clock is None else self.frame_clock.period
            self._real = motion.time
        self.last, self._after_reset = motion, False
        self._candidate, self._agreeing = None, 0
        return motion

    def _remember(self, motion, given):
        motion = motion._replace(frame_time=None)
        agrees = self._candidate and self._agrees(self._candidate[0], motion, given)
        self._agreeing = self._agreeing + 1 if agrees else 1
        self._candidate = motion, given

    def _agrees(self, before, motion, given):
        return self._check_stamp(before, motion) is None and self._check_jump(before, motion, given) is None

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
