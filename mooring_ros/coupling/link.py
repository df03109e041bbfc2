"""The simulator's side of the coupling over ROS: Odometry out, wrenches in, one answer to each sample.

Samples carry simulated time. A stamp is never sent twice: to the mooring node that would be a repeated input. Answers are
matched by their stamp; what is missing, comes twice or comes too late is counted.
"""

import math
import time
from dataclasses import dataclass

import numpy as np
from geometry_msgs.msg import WrenchStamped
from lifecycle_msgs.msg import State
from lifecycle_msgs.srv import GetState
from nav_msgs.msg import Odometry
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.qos import QoSProfile

from mooring_ros.motion import rotation

ODOMETRY_TOPIC = "platform/odom"
MOORING = "mooring"
WORLD, PLATFORM = "world", "platform"
_POLL = 0.1  # s, how long a wait may go on before it looks whether to stop
_AT_ONCE = 20  # messages that are taken without waiting
_LONGEST_UNCONFIGURED = 3.0  # s; while it configures, the node does not say its state


class LinkError(Exception):
    """The mooring node is not there, or has stopped answering; the text says what was waited for."""


class Stopped(Exception):
    """The wait was ended from outside (Ctrl-C, SIGTERM)."""


@dataclass
class Counts:
    """Samples sent, answers in time, samples without an answer, answers that came twice, answers that came too late."""

    sent: int = 0
    answered: int = 0
    lost: int = 0
    doubled: int = 0
    late: int = 0


class MooringLink:
    """Publishes the platform's Odometry and takes the mooring's wrench on a rclpy node.

    stop: called without arguments, tells whether to stop; waits then raise Stopped. odometry: topic; mooring: name of the mooring node;
    wrench: topic of its answer, below that name; world, platform: frames in the headers. counts: Counts.
    """

    def __init__(self, node, stop=lambda: False, odometry=ODOMETRY_TOPIC, mooring=MOORING, world=WORLD, platform=PLATFORM, wrench="wrench"):
        self.counts = Counts()
        self._node, self._stop, self._mooring = node, stop, mooring
        self._world, self._platform = world, platform
        self._publisher = node.create_publisher(Odometry, odometry, QoSProfile(depth=10))
        self._subscription = node.create_subscription(WrenchStamped, f"{mooring}/{wrench}", self._take, QoSProfile(depth=10))
        self._executor = EventsExecutor(context=node.context)
        self._executor.add_node(node)
        self._sent = {}  # stamp -> (perf_counter of sending, quaternion), for samples not answered yet
        self._answers = {}  # stamp -> (wrench, round trip in s)
        self._given_up = set()  # stamps
        self._before = set()  # stamps of samples that nothing is counted of
        self._problem = ""

    def wait_for_mooring(self, timeout):
        """Wait until the node listens and speaks. Raises LinkError after timeout (s), or when it stays unconfigured; Stopped."""
        end = time.monotonic() + timeout
        state = _NodeState(self._node, self._mooring)
        missing = f"nobody answers on {self.topics}"
        while not (self._publisher.get_subscription_count() and self._subscription.get_publisher_count()):
            self._check(end, missing, timeout)
            self._executor.spin_once(timeout_sec=_POLL)
            if state.unconfigured_for() > _LONGEST_UNCONFIGURED:
                raise LinkError("the mooring node is there, but unconfigured, expected active; its log says why")
        last = time.monotonic() + 1.0
        while state.asked and time.monotonic() < last:  # else its answer would find nobody
            self._executor.spin_once(timeout_sec=_POLL)
        state.close()

    def greet(self, stamps, pose, timeout, patience=1.0):
        """Send the pose (7,) at rest, at one stamp (ns) of the iterator after the other, until one is answered.

        Being discovered is not yet being heard: an answer may be sent before this side can hear it. Unanswered samples are followed
        by later ones, each after a while (patience, s), and not counted. Returns the stamp that was answered and its wrench (6,).
        Raises LinkError after timeout (s), Stopped.
        """
        end = time.monotonic() + timeout
        while True:
            self.send(next(stamps), pose, np.zeros(6))
            until = min(end, time.monotonic() + patience)
            while not self._answers and time.monotonic() < until:
                self._check(end, "the mooring node does not answer", timeout)
                self._executor.spin_once(timeout_sec=_POLL)
            if self._answers:
                return self.first_answer()
            self._check(end, "the mooring node does not answer", timeout)

    def send(self, stamp, pose, twist):
        """Publish a sample: stamp ns, pose (7,), twist (6,) in the world frame (the message's is in the platform's, as ROS wants it).

        Raises ValueError for what is no motion; the mooring node would refuse it.
        """
        pose, twist = checked(pose, 7, "pose"), checked(twist, 6, "twist")
        message = Odometry()
        message.header.frame_id, message.child_frame_id = self._world, self._platform
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 1_000_000_000)
        position, orientation = message.pose.pose.position, message.pose.pose.orientation
        position.x, position.y, position.z, orientation.x, orientation.y, orientation.z, orientation.w = pose
        to_body = rotation.conjugate(pose[3:])
        linear, angular = message.twist.twist.linear, message.twist.twist.angular
        linear.x, linear.y, linear.z = rotation.rotate(to_body, twist[:3])
        angular.x, angular.y, angular.z = rotation.rotate(to_body, twist[3:])
        self.counts.sent += 1
        self._sent[stamp] = time.perf_counter(), pose[3:]
        self._publisher.publish(message)

    def first_answer(self):
        """Stamp and wrench (6,) of the newest answer there is, without waiting, or None. With it the counting begins."""
        self.listen()
        if not self._answers:
            return None
        stamp = max(self._answers)
        wrench, _ = self._answers[stamp]
        self._begin()
        return stamp, wrench

    def listen(self):
        """Take what has arrived, without waiting. Raises Stopped, LinkError for a wrench in a frame of its own."""
        self._look()
        for _ in range(_AT_ONCE):
            self._executor.spin_once(timeout_sec=0.0)
        self._look()

    def answer(self, stamp, timeout):
        """The (wrench (6,), round trip in s) that answers the sample of this stamp, or None when none came within timeout (s).

        Raises LinkError for a wrench in a frame that is neither the world's nor the platform's; Stopped.
        """
        end = time.monotonic() + timeout
        while stamp not in self._answers:
            self._look()
            left = end - time.monotonic()
            if left <= 0.0:
                self.counts.lost += 1
                self._sent.pop(stamp, None)
                self._given_up.add(stamp)
                return None
            self._executor.spin_once(timeout_sec=min(left, _POLL))
        self.counts.answered += 1
        return self._answers.pop(stamp)

    @property
    def topics(self):
        """The topics of both directions as they are after remapping, for messages."""
        return f"{self._publisher.topic_name} and {self._subscription.topic_name}"

    @property
    def heard(self):
        """Whether anybody listens to the samples."""
        return self._publisher.get_subscription_count() > 0

    def close(self):
        """Let go of the executor; the node stays the caller's."""
        self._executor.shutdown()

    def _take(self, message):
        stamp = message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec
        sent = self._sent.pop(stamp, None)
        if sent is None:
            if stamp in self._before:
                self._before.remove(stamp)
            elif stamp in self._given_up:
                self._given_up.remove(stamp)
                self.counts.late += 1
            else:
                self.counts.doubled += 1
            return
        began, quaternion = sent
        force, torque, frame = message.wrench.force, message.wrench.torque, message.header.frame_id
        parts = (force.x, force.y, force.z), (torque.x, torque.y, torque.z)
        if frame == self._platform:
            parts = tuple(rotation.rotate(quaternion, part) for part in parts)
        elif frame != self._world:
            self._problem = f"the wrench is in frame '{frame}', expected '{self._world}' or '{self._platform}'"
            return
        self._answers[stamp] = np.array(parts).ravel(), time.perf_counter() - began

    def _begin(self):
        """What was sent until now is neither lost nor late, whenever its answers come."""
        self.counts = Counts()
        self._before.update(self._sent)
        self._sent.clear()
        self._answers.clear()
        self._given_up.clear()

    def _look(self):
        if self._stop():
            raise Stopped
        if self._problem:
            raise LinkError(self._problem)

    def _check(self, end, missing, timeout):
        self._look()
        if time.monotonic() >= end:
            raise LinkError(f"{missing}, waited {timeout:g} s")


class _NodeState:
    """Asks a lifecycle node for its state again and again; one that has no such service is never unconfigured."""

    def __init__(self, node, mooring):
        self._node = node
        self._client = node.create_client(GetState, f"{mooring}/get_state")
        self._question = None
        self._since = None

    @property
    def asked(self):
        """Whether an answer is still to come."""
        return self._question is not None and not self._question.done()

    def unconfigured_for(self):
        """For how long (s) every answer has been `unconfigured`."""
        if self._question is None and self._client.service_is_ready():
            self._question = self._client.call_async(GetState.Request())
        elif self._question is not None and self._question.done():
            unconfigured = self._question.result().current_state.id == State.PRIMARY_STATE_UNCONFIGURED
            self._since = (self._since or time.monotonic()) if unconfigured else None
            self._question = None
        return time.monotonic() - self._since if self._since else 0.0

    def close(self):
        self._node.destroy_client(self._client)


def checked(values, size, name):
    """A tuple of so many finite floats."""
    numbers = tuple(map(float, values))
    if len(numbers) != size or not math.isfinite(sum(numbers)):
        raise ValueError(f"{name} is {numbers}, expected {size} finite numbers")
    return numbers
