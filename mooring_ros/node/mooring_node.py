"""The managed node: it ties parameters, inputs, session, outputs, recording and diagnostics to the lifecycle."""
import os
import time

import numpy as np
from rclpy.clock import Clock, ClockType, JumpThreshold
from rclpy.duration import Duration
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from std_srvs.srv import Trigger

from mooring_ros.mooring import Mooring, MooringError
from mooring_ros.motion import Adapter, ConventionCheck, Gate, Limits, Velocity
from mooring_ros.motion.ensemble import Checks, Ensemble
from mooring_ros.node import guards, interpreter, live, parameters, realtime
from mooring_ros.node.accuracy import Companion, report
from mooring_ros.node.diagnostics import WARN, Diagnostics, fingerprint
from mooring_ros.node.heartbeat import Heartbeat
from mooring_ros.node.inputs import Inputs
from mooring_ros.node.output import Output
from mooring_ros.node.outputs import Outputs
from mooring_ros.node.platforms import AllInputs, AllResets, refuse
from mooring_ros.node.punctuality import Punctuality
from mooring_ros.node.reports import Reports
from mooring_ros.node.resets import Resets
from mooring_ros.node.session import Session
from mooring_ros.node.states import HOLD, IDLE, SAFE, Transition
from mooring_ros.node.timing import FixedRate, Pace
from mooring_ros.node.winch import Winch
from mooring_ros.platforms import platform_count
from mooring_ros.recording.attached import AttachedScene
from mooring_ros.recording.errors import RecordingError
from mooring_ros.recording.writer import RecordingWriter
from mooring_ros.scene import load_scene

FAILURE = TransitionCallbackReturn.FAILURE

DIAGNOSTICS_PERIOD = 1.0    # s
NEWS_PERIOD = 0.1           # s: what is new is told within it
# A simulation's clock that leaps by more (ns) has been set, or has just been heard for the first time: nothing was silent meanwhile.
_JUMPS = JumpThreshold(min_forward=Duration(nanoseconds=500_000_000), min_backward=Duration(nanoseconds=-1), on_clock_change=False)


def _velocity(values):
    return Velocity(values["input_rate"], values["input_bandwidth"])


class MooringNode(LifecycleNode):
    """Answers platform motion with mooring forces; see the README for topics, services and parameters."""

    def __init__(self, **keywords):
        super().__init__("mooring", **keywords)
        self._session = self._inputs = self._winch = self._heartbeat = self._outputs = self._recorder = self._mooring = self._adapter = None
        self._companion, self._settings = None, {}
        self._own_services = []
        self._timer = self._rate = self._granted = None
        self._axis = None           # ns: where the recording stands
        self._problem = ""
        self._refused = self._restarts = 0
        self._frequency = 0.0       # rad/s of the source's clock, where it is given
        self._punctuality, self._pace = Punctuality(), Pace()
        self._access = parameters.declare(self, lambda: self._mooring is not None)
        self.add_post_set_parameters_callback(lambda _: self._apply_live_parameters())
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._resets, self._jumps = None, self.get_clock().create_jump_callback(_JUMPS, post_callback=self._follow_clock)
        self._diagnostics = Diagnostics(self.get_fully_qualified_name())
        self._reports, self._told, self._told_at, self._collected = Reports(self), None, 0.0, 0.0
        guards.refuse_unknown_transitions(self)
        self._diagnostics_timer = self.create_timer(NEWS_PERIOD, self._tick_diagnostics, clock=self._steady)

    # --- lifecycle ---

    @guards.transition
    def on_configure(self, state):
        """Load the scene, compile, open the recording, make the outputs. A bad scene is a failure that says where and why."""
        try:
            self._configure()
        except (ValueError, OSError, MooringError, RecordingError) as error:
            self._take_down()
            self._problem = str(error)
            self.get_logger().fatal(f"cannot configure: {self._problem}")
            self.publish_diagnostics("unconfigured")
            return FAILURE
        self._problem = ""
        return super().on_configure(state)

    @guards.transition
    def on_activate(self, state):
        """Start a session: the first good sample settles. Subscriptions are made now, so being subscribed to says that it is active."""
        values = parameters.values(self)
        gate, check = self._make_gate(values)
        self._session = Session(self._mooring, gate, Output(totals=platform_count(self._mooring.platforms)), check, self._watch_now)
        self._refused = self._restarts = 0
        self._pace = Pace()
        if values["accuracy.enabled"]:
            self._companion = Companion(self._mooring, self._settings, values["accuracy.share"], values["accuracy.window"])
        timer = values["timing.mode"] == "timer"
        # Simulated deadlines come from a timer on that clock, which may be early; steady ones are the loop's (loop.py).
        self._rate = FixedRate(values["timing.rate"], early=0.5 if self._simulated else 0.0) if timer else None
        self._punctuality = Punctuality(values["timing.rate"] if timer else values["input_rate"])
        if not timer or self._simulated:
            self._timer = self.create_timer(1.0 / values["timing.rate"], self.cycle if timer else self._look,
                                            clock=self.get_clock() if self._simulated else self._steady)
        self._apply_live_parameters()
        self._inputs = (AllInputs if self._mooring.platforms else Inputs)(self, values["input"], values["twist_frame"], gate, self._take)
        self._winch = Winch(self, self._wind)
        self._heartbeat = Heartbeat(self, self._session.beat)
        interpreter.be_punctual()
        self._ask_for_real_time(values)
        self.get_logger().info(f"active: listens to {', '.join(self._inputs.topics)}")
        return super().on_activate(state)

    @guards.transition
    def on_deactivate(self, state):
        """End the session; the outputs stay, silent."""
        self._end_session()
        return super().on_deactivate(state)

    @guards.transition
    def on_cleanup(self, state):
        """Close the recording and forget the scene."""
        self._take_down()
        return super().on_cleanup(state)

    @guards.transition
    def on_shutdown(self, state):
        """From any state: end all and close the recording."""
        self._take_down()
        return super().on_shutdown(state)

    @guards.transition
    def on_error(self, state):
        """Whatever went wrong: back to unconfigured, with the recording closed."""
        self._take_down()
        self._problem = self._problem or "a transition failed, see the log"
        return super().on_error(state)

    def _make_gate(self, values):
        """(gate, check of the convention or None) of one platform, or of several."""
        names = self._mooring.platforms
        if names:
            self._resets = AllResets(values["on_reset"], len(names))
            gate = Ensemble(names, self._adapter, Limits(), values["world_frame"], _velocity(values), self._resets)
        else:
            self._resets = Resets(values["on_reset"])
            gate = Gate(self._adapter, Limits(), values["world_frame"], values["platform_frame"], _velocity(values), self._resets)
        if values["input"] == "pose":
            return gate, None
        return gate, Checks(gate) if names else ConventionCheck(self._adapter)

    def _configure(self):
        values = parameters.values(self)
        refuse(values)
        if not values["scene"]:
            raise ValueError("parameter scene is empty, expected the path of a MoorDyn v2 input file")
        scene = load_scene(values["scene"], self._access.folders_of(values["scene"]))
        for name in parameters.unknown(self):
            self.get_logger().warning(f"there is no parameter {name}: it is not used")
        settings = {name: values[name] for name in ("fidelity", "solver", "refine")} | {name: values[name] or None for name in ("dt", "segments", "platforms")}
        self.get_logger().info(f"loading {values['scene']}: a core that is new on this machine is compiled first, which takes a minute or more")
        begin = time.monotonic()
        self._warm_up(Mooring(scene, **settings))
        self.get_logger().info(f"compiled in {time.monotonic() - begin:.1f} s")
        adapter = Adapter(values["twist_frame"], values["convention"], values["wrench_frame"], values["scale"], values["density_ratio"])
        _velocity(values).tracker(adapter.time_factor)
        mooring = Mooring(scene, **settings)
        for warning in mooring.warnings:
            self.get_logger().warning(warning)
        self._mooring, self._adapter, self._settings = mooring, adapter, settings
        self._recorder = self._reports.recorder = self._open_recording(values, scene)
        self._outputs = Outputs(self, mooring, adapter, self._recorder, values["visual_rate"], values["full_scale"])
        self._make_services(mooring.line_names)
        self.get_logger().info(f"configured: {values['scene']}, {len(mooring.line_names)} lines, {values['fidelity']}")

    def _warm_up(self, mooring):
        """Run on a mooring that is thrown away what a live one will run, so that everything is compiled."""
        try:
            pose = mooring.pose_in_file
            mooring.settle(pose)
            for k in range(1, 4):
                mooring.step(0.01 * k, pose, np.zeros((*pose.shape[:-1], 6)))
        except MooringError as error:
            self.get_logger().warning(f"the scene cannot be solved at the platform's zero pose: {error}")

    def _open_recording(self, values, scene):
        if not values["recording.enabled"]:
            if values["recording.path"]:
                self.get_logger().warning("recording.path is set but recording.enabled is false: nothing is recorded")
            return None
        path = values["recording.path"] or time.strftime("mooring_%Y%m%d-%H%M%S.mcap")
        recorder = RecordingWriter(path, values, AttachedScene(os.path.basename(scene.path), scene.text, scene.files))
        self.get_logger().info(f"records to {recorder.path}")
        return recorder

    def _make_services(self, line_names):
        self._own_services = [
            self.create_service(Trigger, "~/settle", self._serve(lambda session: session.settle())),
            self.create_service(Trigger, "~/hold", self._serve(lambda session: session.hold()))]
        for name in line_names:
            self._own_services.append(
                self.create_service(Trigger, f"~/lines/{name}/release", self._serve(lambda session, name=name: session.release(name))))

    def _end_session(self):
        if self._inputs is not None:
            self._inputs.destroy()
            self._winch.destroy()
            self._heartbeat.destroy()
        if self._timer is not None:
            self.destroy_timer(self._timer)
        if self._granted is not None:
            realtime.give_back()
        if self._session is not None:
            self._reports.timing(self._punctuality, self._axis)
            self.publish_diagnostics(self._state_machine.current_state[1])
            interpreter.be_usual()
        if self._companion is not None:
            self._companion.close()
            self._companion = None
        if self._session is not None and self._session.state != IDLE:
            self._tell(Transition(self._session.clock(), self._session.state, IDLE, "deactivated", "not active"))
        self._inputs = self._winch = self._heartbeat = self._timer = self._rate = self._granted = self._session = None

    def _ask_for_real_time(self, values):
        priority, lock_memory = values["realtime.priority"], values["realtime.lock_memory"]
        if priority or lock_memory:
            self._granted = realtime.ask(priority, lock_memory)
            self.get_logger().info(f"scheduling {self._granted.scheduling}, memory {self._granted.memory}")
            for problem in self._granted.problems:
                self.get_logger().warning(problem)

    def _take_down(self):
        self._end_session()
        for service in self._own_services:
            self.destroy_service(service)
        self._own_services = []
        if self._outputs is not None:
            self._outputs.destroy()
        recorder, self._recorder = self._recorder, None
        self._reports.recorder = self._axis = None
        self._outputs = self._mooring = self._adapter = None
        if recorder is not None:
            recorder.close()
            if recorder.error or recorder.lost:
                self.get_logger().error(f"recording {recorder.path}: {recorder.lost} messages lost {recorder.error or ''}")

    # --- the way of a sample ---

    @guards.live
    def _take(self, sample, topic, type_name, data, stamp):
        arrived = time.monotonic_ns()
        session, outputs = self._session, self._outputs
        answers = None
        if sample is not None:
            now = self.get_clock().now().nanoseconds if session.gate.limits.input_age else None
            if self._rate is None:
                self._punctuality.begin(arrived)
                answers = session.take(sample, now)
            else:
                answers = session.observe(sample, now)
            if answers is not None:
                self._answer(answers, arrived)
                if self._rate is not None:
                    # The first answer settles, which takes the time that it takes: deadlines begin after it.
                    self._rate.restart()
                    self._rate.missed = 0
        last = session.gate.last
        # A refused stamp may be anything: on the recording's time axis it stands beside the last good one.
        good = last.stamp if last is not None else stamp or 0
        outputs.record_input(topic, type_name, data, stamp if sample is not None and answers == stamp else good, stamp if stamp is not None else good)
        self._after()

    @guards.live
    def _wind(self, lengths, words, topic, type_name, data):
        session, last = self._session, self._session.gate.last
        if lengths is not None:
            _, words = session.wind(lengths)
        if words:
            session.unwound, session.unwound_cause = session.unwound + 1, words
            self.get_logger().warning(f"unstretched lengths refused, {session.unwound} so far, the last: {words}", throttle_duration_sec=5.0)
        stamp = last.stamp if last is not None else 0
        self._outputs.record_input(topic, type_name, data, stamp, stamp)
        self._after()

    def deadline(self):
        """ns of the steady clock at which `cycle` is due, or None."""
        return None if self._rate is None or self._timer is not None else self._rate.next(time.monotonic_ns())

    @guards.live
    def cycle(self):
        """One cycle of the timer mode."""
        begin = time.monotonic_ns()
        if not self._rate.due(self._watch_now()):
            return
        if self._session.wrenches is not None:
            self._punctuality.begin(begin, self._rate.late, self._rate.skipped)
        steps = self._session.steps
        answers = self._session.tick()
        if self._session.steps > steps:
            self._answer(answers, begin)
        elif answers is not None:
            self._repeat(answers)
        self._after()

    @guards.live
    def _look(self):
        """The mode input, while there is something to watch, or no input to set the pace."""
        answers = self._session.look()
        if answers is not None:
            self._repeat(answers)
        self._after()

    @property
    def active(self):
        """Whether there is a session."""
        return self._session is not None

    def fault(self, words):
        """Something is wrong that nobody expected."""
        self._session.fault(words)
        self._say_state()

    def _repeat(self, stamp):
        self._outputs.repeat(stamp, self._outputs.answer(stamp, self._session), self._session.shown)

    def _answer(self, stamp, begin):
        gate, outputs = self._session.gate, self._outputs
        outputs.use_frames(gate.frame, gate.child_frame)
        answered = outputs.answer(stamp, self._session)
        took = time.monotonic_ns() - begin
        if self._session.aimed is not None:
            self._session.delay.add(self._session.aimed, self.get_clock().now().nanoseconds, took)
        self._punctuality.answered(took)
        self._pace.add(self._mooring.time, took, self._mooring.last_step)
        outputs.follow(stamp, answered)
        outputs.follow_stiffness(stamp, self._session.settles)
        if outputs.stiffness.problem:
            self.get_logger().warning(f"no stiffness: {outputs.stiffness.problem}", throttle_duration_sec=5.0)

    def _after(self):
        actions = self._session.actions()
        self._outputs.record_actions(actions)
        if self._companion is not None:
            self._companion.note(actions)
        self._session.review()
        self._say_state()

    def _say_state(self):
        """Log, publish and record every transition at once; log refused samples now and then."""
        session = self._session
        self._axis = session.shown or self._axis
        news = session.states.news()
        for transition in news:
            self._tell(transition)
        if news:
            self._arm()
            self.publish_diagnostics("active")
        elif session.gate.restarts > self._restarts:
            self._restarts = session.gate.restarts
            self.get_logger().warning(f"settled anew: {self._resets.cause}")
        elif session.gate.received > session.gate.accepted + self._refused:
            self._refused = session.gate.received - session.gate.accepted
            self.get_logger().warning(f"input refused, {self._refused} so far, the last: {session.gate.cause}", throttle_duration_sec=5.0)

    def _tell(self, transition):
        words = str(transition)
        if transition.after == SAFE:
            self.get_logger().error(f"{words}; ~/settle restarts")
        elif transition.after == HOLD:
            self.get_logger().warning(words)
        else:
            self.get_logger().info(words)
        self._reports.transition(transition, self._axis)

    def _arm(self):
        """Let the timer of the mode input run only while it is needed."""
        if self._rate is None:
            needed = self._session.states.held or self._session.watch.on
            if needed and self._timer.is_canceled():
                self._timer.reset()
            elif not needed:
                self._timer.cancel()

    @property
    def _simulated(self):
        return self.get_clock().ros_time_is_active

    def _watch_now(self):
        """ns of the clock that watches over input and heartbeat, and paces the timer: steady, or that of the simulation, which may stand still."""
        return self.get_clock().now().nanoseconds if self._simulated else time.monotonic_ns()

    def _follow_clock(self, jump):
        """/clock has leapt."""
        if self._session is None:
            return
        if jump.delta.nanoseconds < 0:
            self._resets.clock_went_back()
        self._session.forget_clock()
        if self._rate is not None:
            self._rate.restart()

    # --- services, parameters, diagnostics ---

    def _serve(self, act):
        def serve(_, response):
            if self._session is None:
                response.success, response.message = False, "not active"
            else:
                response.success, response.message = act(self._session)
                self.get_logger().info(response.message)
                self._after()
            return response
        return serve

    def _apply_live_parameters(self):
        if self._session is None:
            return
        values = parameters.values(self)
        live.apply(values, self._session, self._outputs, self._punctuality)
        self._frequency = 2.0 * np.pi * values["delay.frequency"]
        self._arm()

    def _tick_diagnostics(self):
        lifecycle, now = self._state_machine.current_state[1], time.monotonic()
        missed = self._rate.missed if self._rate is not None else 0
        news = fingerprint(self._session, lifecycle, self._problem, missed, self._recorder, self._sources())
        if news != self._told or now - self._told_at >= DIAGNOSTICS_PERIOD:
            self._told = news
            self.publish_diagnostics(lifecycle)
        if self._session is not None and now - self._collected >= DIAGNOSTICS_PERIOD:
            self._collected = now
            interpreter.collect()
            if self._session.delay.counted and self._axis is not None:
                self._outputs.tell_delay(self._session.delay.report(self._omega()), self._axis)
            self._reports.timing(self._punctuality, self._axis)
            for name in self._inputs.review():
                self.get_logger().warning(f"all publishers of {name} are best-effort: listens to it likewise, what is lost on the way is not sent again")

    def publish_diagnostics(self, lifecycle):
        """Publish the state now. lifecycle: label of the node's state."""
        now = self._told_at = time.monotonic()
        self._reports.diagnostics(self._diagnostics.array(
            now, self.get_clock().now().to_msg(), lifecycle, self._session, self._problem, self._timing(), self._recorder, self._accuracy(now),
            self._delay(), self._sources()), self._axis)

    def _omega(self):
        """Frequency of the platform in rad/s of the source's clock, or None."""
        return self._frequency or (self._session.frequency.value or 0.0) * self._adapter.time_factor or None

    def _delay(self):
        return None if self._session is None or not self._session.delay.counted else self._session.delay.status(self._omega())

    def _sources(self):
        return self._inputs.publishers() if self._inputs is not None else 0

    def _accuracy(self, now):
        if self._session is None or self._session.wrenches is None:
            return None
        if self._companion is not None:
            self._companion.poll(now)
        return report(self._companion, self._pace, self._mooring, now)

    def _timing(self):
        level, words, values = self._punctuality.report()
        facts = {"mode": "input" if self._rate is None else "timer", "missed": 0}
        if self._rate is not None:
            facts |= {"rate (Hz)": f"{1e9 / self._rate.period:g}", "cycles": self._rate.ticks, "missed": self._rate.missed}
        if self._granted is not None:
            facts |= {"scheduling": self._granted.scheduling, "memory": self._granted.memory}
            if self._granted.problems:
                level, words = max(level, WARN), "; ".join(filter(None, (words, *self._granted.problems)))
        return level, words, facts | values

    def destroy_node(self):
        """Close the recording even when nobody went through the lifecycle."""
        self._take_down()
        self._jumps.unregister()
        super().destroy_node()
