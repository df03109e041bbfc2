"""One activation of the node without ROS: samples through the gate into the core, the schedule of what was done, and its answers."""
import math

import numpy as np

from mooring_ros.mooring import MooringError
from mooring_ros.motion import rotation
from mooring_ros.motion.convention_check import WRONG
from mooring_ros.node.steps_in import StepsIn
from mooring_ros.node.timing import WALL_CLOCK, SourceClock
from mooring_ros.recording import schedule

WAITING, RUNNING, FAILED, REFUSED = "waiting for input", "running", "failed", "refused"

AGE_HOLD = "the input is too old"
ASKED_HOLD = "asked for"
# How long the last motion is carried on without a new sample (s of the source's clock) when limits.input_age does not say.
HORIZON = 0.2


class Session:
    """Takes samples, steps the mooring, and holds the wrenches that go out.

    mooring: a fresh `Mooring`. gate, output, check: see motion.Gate, node.output.Output, motion.ConventionCheck (None: the source has no twist).
    state: waiting, running, failed (the core could not complete a step, or settle) or refused (the twist is in another convention); cause: why.
    unwound: messages with unstretched lengths that were refused. Only `settle` leads out of failed and refused. wrenches: (1 + coupled, 6), row 0 the total, inside, as they go out now.
    """

    def __init__(self, mooring, gate, output, check=None):
        self.mooring, self.gate, self.output, self.check = mooring, gate, output, check
        self.state, self.cause = WAITING, ""
        self.steps = self.settles = self.unanswered = self.unwound = 0
        self.wrenches = None
        self.clock = SourceClock()
        self.steps_in = StepsIn()
        self._restarts = 0
        self._actions = []
        self._origin = None
        self._stepped = None        # stamp (ns) to which the core has been stepped
        self._unchecked = None

    # --- mode `input` ---

    def take(self, sample, now):
        """Step to a sample, the first of which settles; returns its stamp when there is an answer, else None. now: receiving clock, ns."""
        motion = self._admit(sample, now)
        if motion is None:
            return None
        if self.state == WAITING:
            return self._settle_at(motion)
        return self._step(motion.stamp, motion.pose, motion.twist)

    # --- mode `timer` ---

    def observe(self, sample, now, steady):
        """Note a sample for the next tick; the first settles. Returns its stamp when there is an answer at once, else None. steady: ns."""
        motion = self._admit(sample, now)
        if motion is None:
            return None
        self.clock.hear(motion.stamp, steady)
        return self._settle_at(motion) if self.state == WAITING else None

    def tick(self, steady):
        """Step to the moment steady (ns) with the last motion carried on; returns the stamp of the sample that is answered, or None.

        The velocity is held. Past the horizon nothing is made up any more: the output is held, and the core waits.
        """
        motion, shown = self.gate.last, self.clock.now(steady)
        if motion is None or shown is None or self._stopped():
            return None
        ahead = (shown - motion.stamp) * 1e-9
        horizon = self.gate.limits.input_age or HORIZON
        if ahead > horizon:
            if not self.output.holding:
                self.output.hold(shown * 1e-9, AGE_HOLD)
        elif self.output.holding == AGE_HOLD:
            self.output.release(shown * 1e-9)
        if ahead > horizon or shown <= self._stepped:
            self._set_wrenches(shown, self._computed())
            return motion.stamp
        pose = carry_on(motion, ahead * self.gate.adapter.time_factor)
        return self._step(shown, pose, motion.twist, answers=motion.stamp)

    # --- services ---

    def settle(self):
        """Solve the statics anew, at the new place when there is one; returns (success, words)."""
        relocated = self.gate.relocate()
        motion = relocated or self.gate.last
        if motion is None:
            return False, "no valid input yet; the first one settles"
        if relocated:
            self.clock.restart()
            self.steps_in.restart()
        elif self._stepped is not None:     # the timer mode may have carried the last motion on: time does not go back
            motion = motion._replace(stamp=max(motion.stamp, self._stepped))
        if self.check is not None and self.state == REFUSED:
            self.check = type(self.check)(self.gate.adapter)
        if self._settle_at(motion) is None:
            return False, self.cause
        place = ", ".join(f"{x:.3f}" for x in motion.pose[:3])
        return True, f"settled at ({place}) m{', the new place' if relocated else ''}"

    def hold(self):
        """Ramp to the safe state until the next settle; returns (success, words)."""
        if self.state == WAITING:
            return False, "no valid input yet, there is nothing to hold"
        self.output.hold(self._stepped * 1e-9, ASKED_HOLD)
        return True, "output ramps to the static wrench of the last settle, and stays there until ~/settle"

    def release(self, line):
        """Let go of the fairlead end of a line; returns (success, words)."""
        if self.state != RUNNING:
            return False, f"cannot release {line}: {self.state}"
        try:
            self.mooring.release(line)
        except (MooringError, ValueError) as error:
            return False, str(error)
        self._act(self._stepped, schedule.encode_release, self.mooring.time, self.mooring.line_names.index(line))
        return True, f"{line} released at its fairlead"

    def wind(self, lengths):
        """Give lines new unstretched lengths, dict of name -> m at the source's scale; all or none. Returns (success, words)."""
        if self.state != RUNNING:
            return False, f"cannot wind {', '.join(lengths)}: {self.state}"
        names, factor = self.mooring.line_names, 1.0 / self.gate.adapter.length_factor
        for name, length in lengths.items():
            if name not in names:
                return False, f"there is no line {name!r}, expected one of {', '.join(names)}"
            if not 0.0 < length < math.inf:
                return False, f"unstretched length of {name} is {length:g} m, expected a positive number"
        for name, length in lengths.items():
            try:
                self.mooring.set_unstretched_length(name, factor * length)
            except (MooringError, ValueError) as error:
                return False, f"{name}: {error}"
            self._act(self._stepped, schedule.encode_wind, self.mooring.time, names.index(name), factor * length)
        return True, ""

    # --- after the answer ---

    def actions(self):
        """What was done to the core since the last call: (stamp in ns, schedule record of 15 floats), in order."""
        done, self._actions = self._actions, []
        return [(stamp, encode(*values)) for stamp, encode, values in done]

    def review(self):
        """Compare the twist of the last sample with its pose; may refuse the source. Not urgent: call it when the answer is out."""
        if self._unchecked is None:
            return
        (motion, sample), self._unchecked = self._unchecked, None
        verdict = self.check.add(motion.stamp, motion.pose, sample.twist, sample.twist_frame)
        if verdict.kind == WRONG:
            self.state, self.cause = REFUSED, verdict.text

    # --- inside ---

    def _admit(self, sample, now):
        motion = self.gate.admit(sample, now)
        if motion is None:
            return None
        if self.gate.restarts != self._restarts:
            self._begin_anew()
        self.steps_in.add(motion.stamp)
        if self.check is not None and not self.check.finished:
            self._unchecked = motion, sample
        if self._stopped():
            self.unanswered += 1
            return None
        return motion

    def _begin_anew(self):
        """After a reset of the simulation: the sample that was admitted settles, but nothing leads out of a fault."""
        self._restarts = self.gate.restarts
        self.clock.restart()
        if not self._stopped():
            self.state = WAITING

    def _stopped(self):
        return self.state in (FAILED, REFUSED)

    def _seconds(self, stamp):
        return (stamp - self._origin) * 1e-9 * self.gate.adapter.time_factor

    def _settle_at(self, motion):
        if self._origin is None or motion.stamp < self._stepped:
            # Waves and failures have times of their own: those of a simulation's clock, or of a run by a wall clock.
            self._origin = motion.stamp if motion.stamp >= WALL_CLOCK else 0
        time, pose = self._seconds(motion.stamp), motion.pose
        self._stepped = motion.stamp
        try:
            self.mooring.settle(np.array(pose), time=time)
        except (MooringError, ValueError) as error:
            return self._fail(f"cannot settle: {error}")
        self._act(motion.stamp, schedule.encode_settle, time, pose)
        self.state, self.cause = RUNNING, ""
        self.settles += 1
        computed = self._computed()
        self.output.start(motion.stamp * 1e-9, computed)
        self._set_wrenches(motion.stamp, computed)
        return motion.stamp

    def _step(self, stamp, pose, twist, answers=None):
        time = self._seconds(stamp)
        try:
            self.mooring.step(time, np.array(pose), np.array(twist))
        except (MooringError, ValueError) as error:
            return self._fail(str(error))
        computed = self._computed()
        # The last line of defence: whatever happens inside, nothing that is not a number goes to an actuator.
        if not math.isfinite(computed.sum()):
            return self._fail(f"the step to t = {time:.6g} s gave a wrench that is not finite")
        self.steps += 1
        self._stepped = stamp
        answers = stamp if answers is None else answers
        self._act(answers, schedule.encode_step, time, pose, twist)
        self._set_wrenches(stamp, computed)
        return answers

    def _act(self, stamp, encode, *values):
        self._actions.append((stamp, encode, values))

    def _fail(self, cause):
        self.state, self.cause = FAILED, cause
        self.unanswered += 1
        return None

    def _computed(self):
        coupled = self.mooring.coupled_wrenches
        wrenches = np.empty((1 + len(coupled), 6))
        wrenches[0], wrenches[1:] = self.mooring.wrench, coupled
        return wrenches

    def _set_wrenches(self, stamp, computed):
        self.wrenches = self.output.apply(stamp * 1e-9, computed)


def carry_on(motion, seconds):
    """The pose (7,) that a Motion reaches after some seconds (inside) at its twist."""
    turn = rotation.from_rotation_vector([seconds * w for w in motion.twist[3:]])
    q = rotation.multiply(turn, motion.pose[3:])
    norm = math.hypot(*q)
    return (*(x + seconds * v for x, v in zip(motion.pose[:3], motion.twist[:3])), *(c / norm for c in q))
