"""One activation of the node without ROS: samples through the gate into the core, the schedule of what was done, and its answers."""
import math
import time

import numpy as np

from mooring_ros.mooring import MooringError
from mooring_ros.motion.convention_check import WRONG
from mooring_ros.node.delay import Delay, Fastest
from mooring_ros.node.states import ASKED, FAULT, FOUND, HOLD, IDLE, LOST, RAMP, RAMPED, SAFE, SETTLED, States, Watch
from mooring_ros.node.steps_in import StepsIn
from mooring_ros.node.timing import WALL_CLOCK, SourceClock
from mooring_ros.recording import schedule

# How long the last motion is carried on without a new sample (s of the source's clock) when no limit says.
HORIZON = 0.2
# Inputs that are answered in HOLD set the pace; after so long without one (ns) the clock does.
QUIET = 50_000_000


class Session:
    """Takes samples, steps the mooring, and holds the wrenches that go out.

    mooring: a fresh `Mooring`. gate, output, check: see motion.Gate, node.output.Output, motion.ConventionCheck (None: the source has no twist).
    clock: gives ns of a steady clock (of the simulation's, where time is simulated); input and heartbeat are watched by it.
    states: the state machine; watch: its limits. unanswered: good samples without an answer; unwound: messages with unstretched lengths that
    were refused, unwound_cause: why the last was; most_wound: share of its length by which one of them may change a line, 0 for any.
    delay: how late the answers are, and how far the motion is predicted for that; frequency: of the platform, of several the fastest; aimed: the moment (ns) that the
    last step was meant for, None after a settle. wrenches: (platforms + coupled, 6), the totals first, inside, as they go out now; shown: when, in ns of
    the source's clock.
    """

    def __init__(self, mooring, gate, output, check=None, clock=time.monotonic_ns):
        self.mooring, self.gate, self.output, self.check, self.clock = mooring, gate, output, check, clock
        self.states, self.watch = States(clock()), Watch()
        self.steps = self.settles = self.unanswered = self.unwound = 0
        self.unwound_cause, self.most_wound = "", 0.0
        self.wrenches = self.shown = None
        self.source = SourceClock()
        self.delay, self.frequency, self.aimed = Delay(), Fastest(output.totals), None
        self.steps_in = StepsIn()
        self._restarts = 0
        self._anew = True           # the next good sample settles: the first, and the first after a reset of the simulation
        self._static = None         # (platforms + coupled, 6): where HOLD and SAFE go to
        self._good = None           # the last Motion that the core went to
        self._heard = None          # ns of the clock, when it did
        self._actions = []
        self._origin = None
        self._stepped = None        # moment (ns) to which the core has been stepped
        self._unchecked = self._unmeasured = None
        self._handled = 0           # messages, the last good one included
        self._suspected = False     # something was missing at the last look at the clock

    @property
    def state(self):
        """IDLE, RAMP, RUN, HOLD or SAFE."""
        return self.states.state

    # --- mode `input` ---

    def take(self, sample, now):
        """Step to a sample, the first of which settles; returns its stamp when there is an answer, else None. now: receiving clock, ns."""
        motion = self._admit(sample, now)
        if motion is None:
            return None
        if self._anew:
            return self._settle_at(motion)
        self._found(motion.stamp)
        return self._step(motion.time, motion, motion.stamp)

    def look(self):
        """Judge by the clock alone. Returns the stamp of the last answer when the wrenches of HOLD and SAFE are to go out again, else None."""
        now = self.clock()
        self._judge(now, self.watch.input_lost(self.watch.since_input(now)))
        if not self.states.held or self.wrenches is None:
            return None
        if self.state == HOLD and not self.states.lost and now - self._heard < QUIET:
            return None
        self._show(self._time(now))
        return self._good.stamp

    # --- mode `timer` ---

    def observe(self, sample, now):
        """Note a sample for the next tick; the first settles. Returns its stamp when there is an answer at once, else None. now: receiving clock, ns."""
        motion = self._admit(sample, now)
        if motion is None:
            return None
        self.source.hear(motion.time, self.clock())
        return self._settle_at(motion) if self._anew else None

    def tick(self):
        """Step to this moment with the last motion carried on; returns the stamp of the sample that is answered, or None.

        The acceleration is held. Where the input counts as lost nothing is made up any more: the core waits.
        """
        now = self.clock()
        motion, shown = self.gate.last, self.source.now(now)
        if self.wrenches is None or motion is None or shown is None:
            return None
        lost = self.gate.cause if self.gate.lost else self.watch.input_lost((shown - motion.time) * 1e-9, HORIZON)
        self._judge(now, lost)
        if lost and not self.states.held:
            return None
        if lost or self.state == SAFE:
            self._show(self._time(now))
            return self._good.stamp
        self._found(shown)
        return self._step(shown, motion, shown)

    # --- services, heartbeat ---

    def settle(self):
        """Solve the statics anew, at the new place when there is one; returns (success, words)."""
        heart = self.watch.heart_lost(self.clock())
        if heart:
            return False, f"not settled: {heart}"
        relocated = self.gate.relocate()
        motion = relocated or self.gate.last
        if motion is None:
            return False, "no valid input yet; the first one settles"
        if relocated:
            self._new_stream()
        elif self._stepped is not None:     # the timer mode may have carried the last motion on: time does not go back
            motion = motion._replace(frame_time=max(motion.time, self._stepped))
        if self.check is not None and self.check.verdict.kind == WRONG:
            self.check = self.check.anew()
        if self._settle_at(motion, "~/settle") is None:
            return False, self.states.cause
        places = np.reshape(motion.pose, (-1, 7))[:, :3]
        place = " and ".join(f"({', '.join(f'{x:.3f}' for x in own)})" for own in places)
        return True, f"settled at {place} m{', the new place' if relocated else ''}"

    def hold(self):
        """Ramp to the static answer until the next settle; returns (success, words)."""
        if self.state == IDLE:
            return False, "no valid input yet, there is nothing to hold"
        if self.state == SAFE:
            return True, f"{SAFE} already, until ~/settle: {self.states.cause}"
        self._withdraw(ASKED, "~/hold")
        return True, "output ramps to the static wrench at the last good pose, and stays there until ~/settle"

    def lose(self, cause):
        """The input is there but of no use any more, for this cause: hold, until a good sample."""
        self._withdraw(LOST, cause)

    def fault(self, cause):
        """Something is wrong, for this cause: SAFE, until somebody settles."""
        self._withdraw(FAULT, cause)

    def beat(self):
        """A heartbeat came."""
        self.watch.beat(self.clock())

    def release(self, line):
        """Let go of the fairlead end of a line; returns (success, words)."""
        if self.state in (IDLE, SAFE):
            return False, f"cannot release {line}: {self.state}, {self.states.cause}"
        try:
            self.mooring.release(line)
        except (MooringError, ValueError) as error:
            return False, str(error)
        self._act(self._stepped, schedule.encode_release, self.mooring.time, self.mooring.line_names.index(line))
        return True, f"{line} released at its fairlead"

    def wind(self, lengths):
        """Give lines new unstretched lengths, dict of name -> m at the source's scale; all or none. Returns (success, words)."""
        if self.state in (IDLE, SAFE):
            return False, f"cannot wind {', '.join(lengths)}: {self.state}, {self.states.cause}"
        names, factor = self.mooring.line_names, 1.0 / self.gate.adapter.length_factor
        for name, length in lengths.items():
            if name not in names:
                return False, f"there is no line {name!r}, expected one of {', '.join(names)}"
            if not 0.0 < length < math.inf:
                return False, f"unstretched length of {name} is {length:g} m, expected a positive number"
            now = self.mooring.unstretched_length[names.index(name)] / factor
            if self.most_wound and abs(length / now - 1.0) > self.most_wound:
                return False, (f"unstretched length of {name} is {length:g} m, expected no more than {100.0 * self.most_wound:g} % from the {now:g} m that it has "
                               "(limits.winch)")
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
        if self._unmeasured is not None:
            (time, motion), self._unmeasured = self._unmeasured, None
            self.frequency.add(time, motion.each)
        if self._unchecked is None:
            return
        (motion, sample), self._unchecked = self._unchecked, None
        verdict = self.check.look_at(motion, sample)
        if verdict.kind == WRONG:
            self._withdraw(FAULT, verdict.text)

    # --- inside ---

    def _admit(self, sample, now):
        motion = self.gate.admit(sample, now)
        if motion is None:
            if self.gate.lost:
                self.lose(self.gate.cause)
            return None
        if self.gate.restarts != self._restarts:
            self._restarts = self.gate.restarts
            self._new_stream()
            self._anew = True
        self.steps_in.add(motion.time)
        self.watch.hear(self.clock())
        self._handled = self.gate.handled
        if self.check is not None and not self.check.finished and not motion.bridged:
            self._unchecked = motion, sample
        if self.state == SAFE:
            self.unanswered += 1
            return None
        return motion

    def forget_clock(self):
        """The clock has leapt: silence, and what the source's clock shows, count from here."""
        self.source.restart()
        self.watch.leap(self.clock())

    def _new_stream(self):
        """What comes from now on has nothing to do with the stamps and the arrivals before."""
        self.source.restart()
        self.steps_in.restart()
        self.watch.forget()

    def _judge(self, now, lost):
        """What the clock alone says: lost, why the input counts as lost, or ""; and the heartbeat.

        What is missing must be so at two looks in a row: a process that was held up has not heard yet what waits for it.
        """
        if self.state == IDLE:
            return
        heart = self.watch.heart_lost(now)
        suspected, self._suspected = self._suspected, bool(heart or lost)
        if suspected and heart:
            self._withdraw(FAULT, heart)
        elif suspected and lost:
            refused = self.gate.handled - self._handled
            self._withdraw(LOST, lost + self.gate.missing + (f"; {refused} refused, the last: {self.gate.cause}" if refused else ""))

    def _withdraw(self, event, cause):
        """Into HOLD or SAFE, where the event leads there."""
        went_out = not self.states.held and self.wrenches is not None
        if self.states.fire(self.clock(), event, cause) and went_out:
            self._static = self._static_here()
            self.shown = self._time(self.clock())
            self.output.turn(self.shown * 1e-9)

    def _static_here(self):
        """The static wrenches at the last good pose, or, where there are none, those of the last settle."""
        twin = self.mooring.twin()
        try:
            twin.settle(np.array(self._good.pose), time=twin.time)
            found = self._computed(twin)
        except (MooringError, ValueError):
            return self._static
        return found if math.isfinite(found.sum()) else self._static

    def _found(self, shown):
        """The input is good again; shown: ns, from where the output goes on."""
        if self.states.fire(self.clock(), FOUND, "the input is good again"):
            self.shown = shown
            self.output.turn(shown * 1e-9)

    def _time(self, now):
        """The source's clock (ns) at the clock's now, as far as it can be told; never before what has been shown."""
        time = self.source.now(now)
        if time is None:
            time = self._good.stamp + now - self._heard
        return max(time, self.shown)

    def _seconds(self, stamp):
        return (stamp - self._origin) * 1e-9 * self.gate.adapter.time_factor

    def _settle_at(self, motion, cause="the first good sample"):
        heart = self.watch.heart_lost(self.clock())
        if heart:
            self.states.cause = heart
            self.unanswered += 1
            return None
        if self._origin is None or motion.time < self._stepped:
            # Waves and failures have times of their own: those of a simulation's clock, or of a run by a wall clock.
            self._origin = motion.time if motion.time >= WALL_CLOCK else 0
        time, pose = self._seconds(motion.time), motion.pose
        self._stepped, self.aimed = motion.time, None
        try:
            self.mooring.settle(np.array(pose), time=time)
        except (MooringError, ValueError) as error:
            return self._fail(f"cannot settle: {error}")
        self._act(motion.stamp, schedule.encode_settle, time, pose)
        self.settles += 1
        self._anew = False
        computed = self._computed(self.mooring)
        self._static = computed.copy()
        self.output.start(motion.stamp * 1e-9, computed, self.states.held)
        self.states.fire(self.clock(), SETTLED, cause)
        return self._answer(motion.stamp, motion, computed)

    def _step(self, aimed, motion, shown):
        """Step the core to where a motion leads at the moment `aimed` (ns), and ahead of it by what makes up for the delay; shown: ns of the source's
        clock, when the answer goes out. Returns the stamp that is answered."""
        moment = aimed + self.delay.ahead(aimed)
        if moment <= self._stepped:     # a tick between two readings of the source's clock
            self._show(shown, self._computed(self.mooring))
            return motion.stamp
        pose, twist = motion.pose, motion.twist
        if moment != motion.time:
            pose, twist = motion.ahead((moment - motion.time) * 1e-9 * self.gate.adapter.time_factor)
        time = self._seconds(moment)
        try:
            self.mooring.step(time, np.array(pose), np.array(twist))
        except (MooringError, ValueError) as error:
            return self._fail(str(error))
        computed = self._computed(self.mooring)
        # The last line of defence: whatever happens inside, nothing that is not a number goes to an actuator.
        if not math.isfinite(computed.sum()):
            return self._fail(f"the step to t = {time:.6g} s gave a wrench that is not finite")
        self.steps += 1
        self._stepped, self.aimed, self._unmeasured = moment, aimed, (time, motion)
        self._act(motion.stamp, schedule.encode_step, time, pose, twist)
        return self._answer(shown, motion, computed)

    def _answer(self, shown, motion, computed):
        self._good, self._heard = motion, self.clock()
        self._show(max(shown, self.shown) if self.states.held else shown, computed)
        return motion.stamp

    def _act(self, stamp, encode, *values):
        self._actions.append((stamp, encode, values))

    def _fail(self, cause):
        self._withdraw(FAULT, cause)
        self.unanswered += 1
        return None

    def _computed(self, mooring):
        coupled, totals = mooring.coupled_wrenches, self.output.totals
        wrenches = np.empty((totals + len(coupled), 6))
        wrenches[:totals], wrenches[totals:] = mooring.wrench, coupled
        return wrenches

    def _show(self, shown, computed=None):
        """What goes out at this moment (ns) of the source's clock."""
        self.shown = shown
        self.wrenches = self.output.apply(shown * 1e-9, self._static if self.states.held else computed)
        if self.state == RAMP and not self.output.ramping(shown * 1e-9):
            self.states.fire(self.clock(), RAMPED, f"after {self.output.duration:g} s")
