"""A simulator of one's own, coupled with a mooring node in a dozen lines.

    with Coupling(step=0.01) as mooring:
        wrench = mooring.begin(pose)
        while mooring.time < 60.0:
            pose, twist = simulate(wrench, 0.01)
            wrench = mooring.exchange(pose, twist)

Each sample is answered before the next one is made. Without `begin`, the simulator runs freely until the first answer comes.
"""

import time

import numpy as np
import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.signals import SignalHandlerOptions
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64MultiArray

from mooring_ros.coupling.channel import ODOMETRY_TOPIC, rows
from mooring_ros.coupling.link import MOORING, PLATFORM, WORLD, LinkError, MooringLink
from mooring_ros.coupling.schemes import SCHEMES

_MOST_LOST = 3  # answers missing in a row


class Coupling:
    """Sends the platform's motion, waits for the mooring's answer to it, and says what wrench to apply until the next.

    step: s of simulated time between samples. scheme: `extrapolated`, `stiffness` or `held`, see schemes. start: s, simulated time of the first
    sample; zero means "not set" in ROS. timeout: s of wall time, for the first answer; patience: s, for each one after. clock: publish /clock with
    every sample, for a node with `use_sim_time`. node: a rclpy node to use; else one of this name is made, in a context of its own.
    stop, odometry, mooring, world, platform: see MooringLink. body: which platform this is, where the mooring node has several (docs/platforms.md): each
    may be simulated by a process of its own, all with the same step and start. The scheme `stiffness` needs all platforms.
    platforms: names of several that are simulated here; poses are then (platforms, 7), twists and wrenches (platforms, 6).

    time: s, of the last sample sent. wrench (6,): the last answer; round_trip: s, it took. counts: see link.Counts.
    stiffness (6, 6): −∂wrench/∂pose as last heard, or None.
    """

    def __init__(self, step, scheme="extrapolated", start=1.0, timeout=60.0, patience=5.0, clock=False, node=None, name="simulator",
                 stop=lambda: False, odometry=None, mooring=MOORING, world=WORLD, platform=None, body=None, platforms=()):  # fmt: skip
        if not 0.0 < step < np.inf:
            raise ValueError(f"step is {step!r}, expected a positive number of seconds")
        if scheme not in SCHEMES:
            raise ValueError(f"scheme is {scheme!r}, expected one of {', '.join(SCHEMES)}")
        if body and SCHEMES[scheme].needs_stiffness:
            raise ValueError(f"scheme is {scheme!r}, which is for one platform, expected another one for {body}")
        if body and platforms:
            raise ValueError(f"body is {body!r} and platforms is {list(platforms)!r}, expected one of the two")
        self.step, self.timeout, self.patience = float(step), timeout, patience
        self.stiffness = self.wrench = self.round_trip = None
        self._make_scheme, self._scheme = SCHEMES[scheme], None
        self._start = self._begun = round(1e9 * start)
        self._number = -1
        self._coupled, self._missing, self._waiting_since, self._answered = False, 0, None, 0.0
        self._context, self._several = None, len(platforms)
        if node is None:
            self._context = rclpy.Context()
            rclpy.init(context=self._context, signal_handler_options=SignalHandlerOptions.NO)
            node = rclpy.create_node(name, context=self._context)
        self._node = node
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._stiffness_subscription = node.create_subscription(Float64MultiArray, f"{mooring}/stiffness", self._take_stiffness, latched)
        self._clock = node.create_publisher(Clock, "/clock", QoSProfile(depth=10)) if clock else None
        below = f"platforms/{body}/" if body else ""
        odometry = odometry or (f"{below}odom" if body else ODOMETRY_TOPIC)
        self._link = MooringLink(node, stop, odometry, mooring, world, platform or body or PLATFORM, f"{below}wrench", platforms)

    @property
    def counts(self):
        """Samples sent, answered, lost, doubled and late since the first answer."""
        return self._link.counts

    @property
    def topics(self):
        """The topics of both directions as they are after remapping, for messages."""
        return self._link.topics

    @property
    def time(self):
        return 1e-9 * self.stamp

    @property
    def stamp(self):
        """Of the last sample, ns."""
        return self._begun + round(1e9 * self.step * max(self._number, 0))

    def begin(self, pose):
        """Stand at pose (7,), at rest, until the mooring node is there and answers; returns its static wrench (6,).

        Simulated time goes on by a step with every sample that is sent. Raises LinkError when nobody answers, or nobody publishes the stiffness that
        the scheme needs; link.Stopped.
        """
        self._link.wait_for_mooring(self.timeout)
        return self._greet(pose, self.timeout)

    def exchange(self, pose, twist, free=np.zeros(6), at=None):
        """One step on, or at a simulated time (s) of one's own: send pose (7,) and twist (6,), both in world axes, and take the answer.

        Returns the wrench (6,) to hold until the next exchange: the scheme's, half a step ahead. Before the first answer it is `free`, and nothing waits.
        An answer that does not come in time counts as lost, and the scheme goes on from the last. Raises LinkError after three of them,
        or when none came within `timeout` of the first sample; ValueError for what is no motion; link.Stopped.
        """
        self._next(pose, twist, at)
        if not self._coupled:
            self._waiting_since = self._waiting_since or time.monotonic()
            first = self._link.first_answer()
            if first is not None:
                self._couple()
                # It answers an older sample: held until the next exchange, but no end of a straight line.
                self._scheme = SCHEMES["held"]()
                self._note(pose, twist, first[1])
                return self.wrench.copy()
            if time.monotonic() - self._waiting_since > self.timeout:
                raise LinkError(f"nobody answers on {self.topics}, waited {self.timeout:g} s")
            return np.broadcast_to(np.array(free, float), np.shape(twist)).copy()
        self._take(pose, twist)
        return self.ahead(self.time + 0.5 * self.step)

    def ahead(self, at):
        """The wrench (6,) at a simulated time (s) after the last sample, as the scheme sees it."""
        return self._scheme.ahead(at - self._answered)

    def reset(self, pose):
        """Simulated time back to `start`, at pose (7,), at rest; returns the static wrench (6,) there.

        The mooring node must have `on_reset: settle`; else it refuses the stamps, and this raises LinkError.
        """
        self._begun, self._number, self._coupled, self._waiting_since = self._start, -1, False, None
        try:
            return self._greet(pose, self.patience)
        except LinkError as error:
            raise LinkError(f"{error}; after a reset of simulated time the mooring node needs the parameter on_reset: settle, or a call of ~/settle") from error

    def close(self):
        """Leave ROS."""
        self._link.close()
        if self._context is not None:
            self._node.destroy_node()
            self._context.try_shutdown()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _greet(self, pose, timeout):
        _, wrench = self._link.greet(self._stamps(), pose, timeout)
        self._couple()
        self._note(pose, np.zeros_like(wrench), wrench)
        return self.wrench.copy()

    def _stamps(self):
        while True:
            self._number += 1
            self._tell_time()
            yield self.stamp

    def _next(self, pose, twist, at):
        rows(pose, 7, self._several, "pose"), rows(twist, 6, self._several, "twist")
        if at is None:
            self._number += 1
        elif at > self.time or self._number < 0:
            self._begun, self._number = round(1e9 * at), 0
        else:
            raise ValueError(f"at is {at!r} s, expected a time after that of the last sample, {self.time:.9f} s; after a reset call `reset`")
        self._tell_time()
        self._link.send(self.stamp, pose, twist)

    def _tell_time(self):
        if self._clock is not None:
            message = Clock()
            message.clock.sec, message.clock.nanosec = divmod(self.stamp, 1_000_000_000)
            self._clock.publish(message)

    def _couple(self):
        """From here on, each sample is answered."""
        if self._make_scheme.needs_stiffness:
            self._wait_for_stiffness()
        self._coupled, self._missing, self._scheme = True, 0, self._make_scheme()

    def _take(self, pose, twist):
        answer = self._link.answer(self.stamp, self.patience)
        self.round_trip = None
        if answer is None:
            self._missing += 1
            if self._missing == _MOST_LOST or not self._link.heard:
                raise LinkError(f"the mooring node stopped answering at {self.time:.2f} s")
            return
        self._missing = 0
        wrench, self.round_trip = answer
        if not isinstance(self._scheme, self._make_scheme):
            self._scheme = self._make_scheme()
        self._note(pose, twist, wrench)

    def _note(self, pose, twist, wrench):
        self.wrench, self._answered = wrench, self.time
        self._scheme.take(self.time, pose, twist, wrench, self.stiffness)

    def _take_stiffness(self, message):
        size = 6 * max(self._several, 1)
        if len(message.data) == size * size:
            self.stiffness = np.array(message.data).reshape(size, size)

    def _wait_for_stiffness(self):
        end = time.monotonic() + self.patience
        while self.stiffness is None:
            if time.monotonic() > end:
                raise LinkError(f"nobody publishes {self._stiffness_subscription.topic_name}, waited {self.patience:g} s; expected a mooring node with stiffness_rate above 0")
            self._link.listen()
            time.sleep(0.01)
