"""The simulator's side of the coupling over ROS: Odometry out, wrenches in, one answer to each sample.

Samples carry simulated time. A stamp is never sent twice: to the mooring node that would be a repeated input. Answers are
matched by their stamp; what is missing, comes twice or comes too late is counted.
"""

import time
from dataclasses import dataclass

import numpy as np
from lifecycle_msgs.msg import State
from lifecycle_msgs.srv import GetState
from rclpy.experimental.events_executor import EventsExecutor

from mooring_ros.coupling.channel import ODOMETRY_TOPIC, Channel, rows, stamp_of

MOORING = "mooring"
WORLD, PLATFORM = "world", "platform"
_POLL = 0.1  # s, how long a wait may go on before it looks whether to stop
_AT_ONCE = 20  # messages that are taken without waiting
_LONGEST_UNCONFIGURED = 3.0  # s; while it configures, the node does not say its state
_LONGEST_CONFIGURING = 600.0  # s: the first start on a machine compiles the core


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


@dataclass
class _Sample:
    """One that is not answered yet: perf_counter of sending, poses, and the wrenches there are (None: to come), each of a platform."""

    sent: float
    poses: list
    wrenches: list


class MooringLink:
    """Publishes the Odometry of one platform, or of several, and takes the mooring's wrenches on a rclpy node.

    stop: called without arguments, tells whether to stop; waits then raise Stopped. platforms: names of several; then the topics are
    platforms/NAME/odom, the frames in the headers their names, and poses, twists and wrenches have a leading axis. Else, odometry: topic; wrench: topic of its
    answer, below the mooring node's name; platform: frame. mooring: name of the mooring node; world: frame. counts: Counts.
    """

    def __init__(self, node, stop=lambda: False, odometry=ODOMETRY_TOPIC, mooring=MOORING, world=WORLD, platform=PLATFORM, wrench="wrench", platforms=()):
        self.counts = Counts()
        self._node, self._stop, self._mooring = node, stop, mooring
        self._several = len(platforms)
        self._channels = [
            Channel(node, f"platforms/{name}/odom", f"{mooring}/platforms/{name}/wrench", world, name, self._take) for name in platforms
        ] or [Channel(node, odometry, f"{mooring}/{wrench}", world, platform, self._take)]
        self._executor = EventsExecutor(context=node.context)
        self._executor.add_node(node)
        self._sent = {}  # stamp -> _Sample
        self._answers = {}  # stamp -> (wrench, round trip in s)
        self._given_up = {}  # stamp -> wrenches that may still come
        self._before = set()  # stamps of samples that nothing is counted of
        self._problem = ""

    def wait_for_mooring(self, timeout):
        """Wait until the node listens and speaks. Raises LinkError after timeout (s), or when it stays unconfigured; Stopped.

        One that is there and configures is waited for beyond the timeout, for up to ten minutes.
        """
        begin = time.monotonic()
        state = _NodeState(self._node, self._mooring)
        missing = f"nobody answers on {self.topics}"
        while not all(channel.matched for channel in self._channels):
            longest = max(timeout, _LONGEST_CONFIGURING) if state.busy else timeout
            self._check(begin + longest, missing, longest)
            self._executor.spin_once(timeout_sec=_POLL)
            if state.unconfigured_for() > _LONGEST_UNCONFIGURED:
                raise LinkError("the mooring node is there, but unconfigured, expected active; its log says why")
        last = time.monotonic() + 1.0
        while state.asked and time.monotonic() < last:  # else its answer would find nobody
            self._executor.spin_once(timeout_sec=_POLL)
        state.close()

    def greet(self, stamps, pose, timeout, patience=1.0):
        """Send the pose (7,), or (platforms, 7), at rest, at one stamp (ns) of the iterator after the other, until one is answered.

        Being discovered is not yet being heard: an answer may be sent before this side can hear it. Unanswered samples are followed
        by later ones, each after a while (patience, s), and not counted. Returns the stamp that was answered and its wrench (6,).
        Raises LinkError after timeout (s), Stopped.
        """
        end = time.monotonic() + timeout
        while True:
            self.send(next(stamps), pose, np.zeros((*np.shape(pose)[:-1], 6)))
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
        poses, twists = rows(pose, 7, self._several, "pose"), rows(twist, 6, self._several, "twist")
        self.counts.sent += 1
        self._sent[stamp] = _Sample(time.perf_counter(), poses, [None] * len(poses))
        for channel, own_pose, own_twist in zip(self._channels, poses, twists):
            channel.send(stamp, own_pose, own_twist)

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
                sample = self._sent.pop(stamp, None)
                if sample is not None:
                    self._given_up[stamp] = sample.wrenches.count(None)
                return None
            self._executor.spin_once(timeout_sec=min(left, _POLL))
        self.counts.answered += 1
        return self._answers.pop(stamp)

    @property
    def topics(self):
        """The topics of both directions as they are after remapping, for messages."""
        return ", ".join(channel.topics for channel in self._channels)

    @property
    def heard(self):
        """Whether anybody listens to the samples."""
        return all(channel.heard for channel in self._channels)

    def close(self):
        """Let go of the executor; the node stays the caller's."""
        self._executor.shutdown()

    def _take(self, channel, message):
        stamp, which = stamp_of(message), self._channels.index(channel)
        sample = self._sent.get(stamp)
        if sample is None or sample.wrenches[which] is not None:
            self._count_again(stamp)
            return
        try:
            sample.wrenches[which] = channel.wrench(message, sample.poses[which])
        except ValueError as error:
            self._problem = str(error)
            return
        if all(wrench is not None for wrench in sample.wrenches):
            del self._sent[stamp]
            wrench = np.array(sample.wrenches) if self._several else sample.wrenches[0]
            self._answers[stamp] = wrench, time.perf_counter() - sample.sent

    def _count_again(self, stamp):
        if stamp in self._before:
            return
        if self._given_up.get(stamp, 0) > 0:
            self._given_up[stamp] -= 1
            self.counts.late += self._given_up[stamp] == 0
        else:
            self.counts.doubled += 1

    def _begin(self):
        """What was sent until now is neither lost nor late, whenever its answers come."""
        self.counts = Counts()
        self._before = set(self._sent) | set(self._answers)
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

    @property
    def busy(self):
        """Whether the node is there and does not answer, as while it configures."""
        return self.asked and self._client.service_is_ready()

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
