"""The node's state as a DiagnosticArray: state, input, core, timing, accuracy, recording; counts and causes."""
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from mooring_ros.motion.convention_check import MISSING, UNDECIDED, WRONG
from mooring_ros.motion.gate import REASONS, REPEATED
from mooring_ros.node.states import HOLD, IDLE, RAMP, RUN, SAFE

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR
PREFIX = "mooring: "
RECENT = 5.0        # s for which something that happened still colours the level
BEHIND = 1.0        # s of messages that a recording may owe to the disk: no more are lost to a kill
LEVELS = {IDLE: WARN, RAMP: OK, RUN: OK, HOLD: WARN, SAFE: ERROR}


class Diagnostics:
    """Builds the messages. hardware_id: the node's full name. Times are s of a steady clock."""

    def __init__(self, hardware_id):
        self._hardware_id = hardware_id
        self._grown = {}
        self._session = None

    def array(self, now, stamp, lifecycle, session=None, problem="", timing=None, recorder=None, accuracy=None, delay=None, publishers=0):
        """The DiagnosticArray of this moment.

        lifecycle: label of the node's state. session: of the activation, or None. problem: why the node could not be configured, or "".
        timing: (level, words, name -> value), with "missed" counted, or None; recorder: the RecordingWriter, or None; accuracy: (words, name -> value), or None; delay: (whether it
        matters, words, name -> value), or None. publishers: of the topic of the platform's motion that has most.
        """
        if session is not self._session:
            self._session = session
            self._grown = {}
        message = DiagnosticArray()
        message.header.stamp = stamp
        message.status = [self._state(now, session), self._input(now, session, publishers), self._core(now, session, lifecycle, problem),
                          self._timing(now, timing), self._delay(delay), self._accuracy(accuracy), self._recording(recorder)]
        return message

    def _state(self, now, session):
        if session is None:
            return self._status("state", OK, "not active", {"state": IDLE})
        states = session.states
        return self._status("state", LEVELS[states.state], f"{states.state}: {states.cause}", {
            "state": states.state, "cause": states.cause, "for (s)": f"{1e-9 * (session.clock() - states.since):.3f}", "transitions": states.count})

    def _input(self, now, session, publishers):
        if session is None:
            return self._status("input", OK, "not active", {})
        gate, rejected = session.gate, sum(session.gate.rejected.values())
        values = {"received": gate.received, "accepted": gate.accepted, "rejected": rejected,
                  **{reason: gate.rejected[reason] for reason in REASONS}, "last rejection": gate.cause,
                  **self._steps_in(session), **self._frames(gate), "world frame": gate.frame, "platform frame": gate.child_frame}
        if gate.missing:
            values["waits for"] = gate.missing.removeprefix("; ")
        fresh_rejection = self._grew("rejected", rejected, now)
        fresh_input = self._grew("accepted", gate.accepted, now)
        level, words = OK, f"{gate.accepted} samples"
        if session.state == IDLE:
            level, words = WARN, f"waiting: {session.states.cause}{gate.missing}"
        if session.check is not None:
            verdict = session.check.verdict
            values["twist check"] = verdict.text
            if verdict.kind == MISSING or verdict.kind == UNDECIDED and session.check.moved:
                level, words = WARN, verdict.text
        if fresh_rejection:
            level, words = (WARN if fresh_input else ERROR), f"refused: {gate.cause}"
            if gate.relocated:
                words += "; call ~/settle to take the new place"
        elif self._grew("lost steps", session.steps_in.lost, now) and level == OK:
            level, words = WARN, f"{session.steps_in.lost} steps were lost on the way here, the nominal one is {1e-9 * session.steps_in.nominal:.6g} s"
        elif gate.resets is not None and self._grew("resets", gate.restarts, now) and level == OK:
            level, words = WARN, f"settled anew: {gate.resets.cause}"
        if session.check is not None and session.check.verdict.kind == WRONG:
            level, words = ERROR, session.check.verdict.text
        if publishers > 1:
            level, words = max(level, WARN), f"{publishers} publishers of the platform's motion are known, expected one; {words}"
        return self._status("input", level, words, values)

    @staticmethod
    def _frames(gate):
        """What becomes of the frames of a camera system."""
        values = {"bridged": gate.bridged}
        return values if gate.frame_clock is None else {**values, "late frames": gate.frame_clock.late, "frames that never came": gate.frame_clock.skipped}

    @staticmethod
    def _steps_in(session):
        """What a lockstep shows of steps that never came, or came twice."""
        gate, steps = session.gate, session.steps_in
        values = {"nominal step (s)": f"{1e-9 * steps.nominal:.6g}", "lost steps": steps.lost, "gaps": steps.gaps, "doubled steps": gate.rejected[REPEATED]}
        return values if gate.resets is None else {**values, "resets": gate.resets.count}

    def _core(self, now, session, lifecycle, problem):
        values = {"state": lifecycle}
        if problem:
            return self._status("core", ERROR, problem, values)
        if session is None:
            return self._status("core", OK, lifecycle, values)
        output, mooring = session.output, session.mooring
        limited = sum(output.limited.values())
        values |= {"mooring": session.state, "steps": session.steps, "unanswered": session.unanswered, "unstretched lengths refused": session.unwound,
                   **{f"{name} limit reached": count for name, count in output.limited.items()}}
        if session.wrenches is not None:
            values |= {"time (s)": f"{mooring.time:.3f}", "largest fairlead tension (N)": f"{mooring.fairlead_tension.max():.6g}"}
        level, words = OK, session.state
        if self._grew("unwound", session.unwound, now):
            level, words = WARN, f"unstretched lengths refused: {session.unwound_cause}"
        if session.state == HOLD:
            level, words = WARN, f"output held: {session.states.cause}"
        if self._grew("limited", limited, now):
            level, words = ERROR, "output limited: " + ", ".join(f"{name} {count} times" for name, count in output.limited.items())
        if session.state == SAFE:
            level, words = ERROR, f"stopped, ~/settle restarts: {session.states.cause}"
        return self._status("core", level, words, values)

    def _timing(self, now, timing):
        level, words, values = timing or (OK, "", {})
        missed = values.get("missed", 0)
        level = max(level, WARN if self._grew("missed", missed, now) else OK)
        return self._status("timing", level, "; ".join(filter(None, (f"{missed} cycles missed" if missed else "", words))) or "in time", values)

    def _delay(self, delay):
        matters, words, values = delay or (False, "not active", {})
        return self._status("delay", WARN if matters else OK, words, values)

    def _accuracy(self, accuracy):
        words, values = accuracy or ("not active", {})
        return self._status("accuracy", WARN if words.startswith("no estimate:") or "process ended" in words else OK, words, values)

    def _recording(self, recorder):
        if recorder is None:
            return self._status("recording", OK, "off", {})
        values = {"path": recorder.path, "written": recorder.written, "lost": recorder.lost}
        if recorder.error:
            return self._status("recording", ERROR, recorder.error, values)
        if recorder.lost:
            return self._status("recording", ERROR, f"{recorder.lost} messages lost", values)
        if recorder.behind > BEHIND:
            return self._status("recording", WARN, f"{recorder.behind:.1f} s behind, the disk is slow", values)
        return self._status("recording", OK, f"{recorder.written} messages", values)

    def _grew(self, name, count, now):
        """Whether a count has grown within the last RECENT seconds."""
        last, when = self._grown.get(name, (0, None))
        if count > last:
            when = now
        elif count < last:
            when = None
        self._grown[name] = count, when
        return when is not None and now - when <= RECENT

    def _status(self, name, level, words, values):
        return DiagnosticStatus(name=PREFIX + name, level=level, message=words, hardware_id=self._hardware_id,
                                values=[KeyValue(key=key, value=str(value)) for key, value in values.items()])


def fingerprint(session, lifecycle, problem="", missed=0, recorder=None, publishers=0):
    """What is worth telling at once: when it differs from the last, something has happened. Cheap; arguments as of `Diagnostics.array`."""
    own = (lifecycle, problem, missed, recorder and (recorder.error, recorder.lost, recorder.behind > BEHIND), publishers)
    if session is None:
        return own
    states, gate = session.states, session.gate
    return (*own, states.state, states.cause, states.count, sum(gate.rejected.values()), gate.restarts, session.steps_in.lost,
            sum(session.output.limited.values()), session.unanswered, session.unwound)
