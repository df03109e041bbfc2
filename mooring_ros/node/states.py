"""The states of an activation, without ROS and without a clock of its own: times are integer ns, handed in.

    IDLE   nothing goes out yet: waits for the first good sample, and for the heartbeat where one is asked for
    RAMP   the answer is blended in, from what went out before
    RUN    the answer goes out as computed, within the limits
    HOLD   the output goes to the static answer at the last good pose, and stays there: the input was lost, or ~/hold was called
    SAFE   the same after a fault, until a person calls ~/settle

A constant force about the mooring's mean holds a floater and adds no energy; no force at all would be a load step on a moored model.
"""
from typing import NamedTuple

STATES = IDLE, RAMP, RUN, HOLD, SAFE = "IDLE", "RAMP", "RUN", "HOLD", "SAFE"
EVENTS = SETTLED, RAMPED, ASKED, LOST, FOUND, FAULT = "settled", "ramp done", "hold asked for", "input lost", "input back", "fault"

# What is not in the table changes nothing.
TABLE = {
    (IDLE, SETTLED): RAMP,
    (IDLE, FAULT): SAFE,
    (RAMP, SETTLED): RAMP,
    (RAMP, RAMPED): RUN,
    (RAMP, ASKED): HOLD,
    (RAMP, LOST): HOLD,
    (RAMP, FAULT): SAFE,
    (RUN, SETTLED): RAMP,
    (RUN, ASKED): HOLD,
    (RUN, LOST): HOLD,
    (RUN, FAULT): SAFE,
    (HOLD, SETTLED): RAMP,
    (HOLD, ASKED): HOLD,        # a lost input's hold becomes one that only ~/settle ends
    (HOLD, FOUND): RAMP,        # not where it was asked for
    (HOLD, FAULT): SAFE,
    (SAFE, SETTLED): RAMP,
}
NO_INPUT = "no input yet"
_USUAL_INTERVALS = 16       # over how many arrivals the interval between frames is averaged
_LEARNT = 8                 # from so many on it is used


class Transition(NamedTuple):
    """at: ns. cause: in words."""

    at: int
    before: str
    after: str
    event: str
    cause: str

    def __str__(self):
        return f"{self.before} -> {self.after}, {self.event}: {self.cause}"


class States:
    """Where an activation stands, why (`cause`), since when (`since`, ns), and after how many transitions (`count`)."""

    def __init__(self, now):
        self.state, self.cause, self.since, self.count = IDLE, NO_INPUT, now, 0
        self._asked = False
        self._news = []

    @property
    def held(self):
        """Whether the output is, or goes to, the static answer."""
        return self.state in (HOLD, SAFE)

    @property
    def lost(self):
        """Whether it holds because the input was lost: a good sample ends that."""
        return self.state == HOLD and not self._asked

    def fire(self, now, event, cause):
        """Something happened at now (ns), for this cause; returns whether that was a transition."""
        after = TABLE.get((self.state, event))
        if after is None or event == FOUND and self._asked or event == ASKED and self._asked:
            return False
        self._asked = event == ASKED
        self._news.append(Transition(now, self.state, after, event, cause))
        self.state, self.cause, self.since = after, cause, now
        self.count += 1
        return True

    def news(self):
        """The transitions since the last call, in order."""
        news, self._news = self._news, []
        return news


class Watch:
    """Judges by the clock alone whether input and heartbeat are still there. Zero switches a limit off; all may be changed at any time.

    input_age: s without a good sample. lost_frames: so many frames may be missing; `input_rate` (Hz) says how far they are apart, else the
    mean of the last arrivals. heartbeat: s without a message on ~/heartbeat.
    """

    def __init__(self, input_age=0.0, lost_frames=0, input_rate=0.0, heartbeat=0.0):
        self.input_age, self.lost_frames, self.input_rate, self.heartbeat = input_age, lost_frames, input_rate, heartbeat
        self._heard = self._beat = None
        self._interval, self._intervals = 0.0, 0

    @property
    def on(self):
        """Whether there is anything to watch for."""
        return bool(self.input_age or self.lost_frames or self.heartbeat)

    def hear(self, now):
        """A good sample arrived at now (ns)."""
        if self._heard is not None and now > self._heard:
            self._intervals = min(self._intervals + 1, _USUAL_INTERVALS)
            self._interval += ((now - self._heard) * 1e-9 - self._interval) / self._intervals
        self._heard = now

    def forget(self):
        """What comes next begins a new stream: the pause before it is none of its intervals."""
        self._heard, self._interval, self._intervals = None, 0.0, 0

    def leap(self, now):
        """The clock has leapt to now (ns): what has been heard until then counts from there."""
        self._heard = None if self._heard is None else now
        self._beat = None if self._beat is None else now

    def beat(self, now):
        """A heartbeat arrived at now (ns)."""
        self._beat = now

    def since_input(self, now):
        """s since the last good sample; 0 before the first, and when the clock was set back: the limits then count from there on."""
        if self._heard is None:
            return 0.0
        self._heard = min(self._heard, now)
        return (now - self._heard) * 1e-9

    def input_lost(self, age, otherwise=0.0):
        """Why an input of this age (s) counts as lost, or "". otherwise: the limit (s) where none is set."""
        # Half a period for frames that are merely late.
        period = self._period() if self.lost_frames else 0.0
        if period and age > (self.lost_frames + 1.5) * period:
            return f"no good input for {age / period:.1f} frames of {1e3 * period:.3g} ms, {self.lost_frames} may be missing"
        limit = self.input_age or (0.0 if period else otherwise)
        return f"no good input for {age:.3f} s, limit {limit:g} s" if limit and age > limit else ""

    def heart_lost(self, now):
        """Why the heartbeat counts as lost, or ""."""
        if not self.heartbeat:
            return ""
        if self._beat is None:
            return "no heartbeat yet"
        self._beat = min(self._beat, now)
        age = (now - self._beat) * 1e-9
        return f"no heartbeat for {age:.3f} s, limit {self.heartbeat:g} s" if age > self.heartbeat else ""

    def _period(self):
        if self.input_rate:
            return 1.0 / self.input_rate
        return self._interval if self._intervals >= _LEARNT else 0.0
