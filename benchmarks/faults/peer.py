"""The other side of the node: motion out, wrenches and diagnostics in, by DDS without rclpy."""
import threading
import time
from typing import NamedTuple

import rosless

from .motion import stamp_of
from .process import START

ODOMETRY, WRENCH, DIAGNOSTICS = "nav_msgs/msg/Odometry", "geometry_msgs/msg/WrenchStamped", "diagnostic_msgs/msg/DiagnosticArray"
_POLL = 0.05    # s
_ONE_SIDED = 0.3    # s: discovery is one-sided for a moment


class Heard(NamedTuple):
    """arrived: s of the steady clock. stamp: ns. wrench: (6,) N, N·m."""

    arrived: float
    stamp: int
    wrench: tuple


class Status(NamedTuple):
    """One status of /diagnostics. arrived: s of the steady clock; level 0, 1, 2; values: dict of text."""

    arrived: float
    name: str
    level: int
    message: str
    values: dict


def wait_until_heard(publisher, pause=_ONE_SIDED):
    """Until somebody listens to a publisher, and `pause` (s) more."""
    while not publisher.subscriber_count:
        time.sleep(0.01)
    time.sleep(pause)


class Peer:
    """Publishes Odometry and listens, each topic in a thread of its own. heard: list of Heard; statuses: list of Status, in order of arrival."""

    def __init__(self, domain, reliability="reliable", node="/mooring"):
        self._node = rosless.Node(domain=domain)
        self.odometry = self.publisher("/platform/odom", ODOMETRY, reliability)
        self.heard, self.statuses = [], []
        self._news = threading.Condition()
        self._open = True
        self._threads = [self._listen(f"{node}/wrench", WRENCH, self._take_wrench), self._listen("/diagnostics", DIAGNOSTICS, self._take_status)]

    def publisher(self, topic, type_name, reliability="reliable"):
        """A publisher; `send` takes dictionaries, `send_payload` bytes."""
        return self._node.advertise(topic, type_name, reliability=reliability, depth=1000)

    def subscription(self, topic, type_name):
        """A reliable subscription; `read(timeout)` gives the next message, or None."""
        return self._node.subscribe(topic, type_name=type_name, reliability="reliable", depth=1000)

    def wait_for_node(self, alive=lambda: True, timeout=START):
        """Until the node is active, which a subscriber on platform/odom means. Raises TimeoutError."""
        end = time.monotonic() + timeout
        while not self.odometry.subscriber_count:
            if time.monotonic() > end or not alive():
                raise TimeoutError("no node subscribes to /platform/odom" + ("" if alive() else ": it has ended"))
            time.sleep(0.01)
        self.wait(lambda: self.statuses, 3.0)       # who hears the node's diagnostics will hear its wrenches
        time.sleep(_ONE_SIDED)

    def wait(self, condition, timeout):
        """Until condition() is true; returns its result, or its last one (false) after timeout (s)."""
        with self._news:
            end = time.monotonic() + timeout
            while not (result := condition()) and (left := end - time.monotonic()) > 0.0:
                self._news.wait(min(left, _POLL))
            return result

    def close(self):
        """End the threads."""
        self._open = False
        for thread in self._threads:
            thread.join()

    def _listen(self, topic, type_name, take):
        subscription = self.subscription(topic, type_name)

        def listen():
            while self._open:
                message = subscription.read(timeout=_POLL)
                if message is not None:
                    now = time.monotonic()
                    with self._news:
                        take(now, message)
                        self._news.notify_all()

        thread = threading.Thread(target=listen, daemon=True)
        thread.start()
        return thread

    def _take_wrench(self, now, message):
        force, torque = message.wrench.force, message.wrench.torque
        self.heard.append(Heard(now, stamp_of(message), (force.x, force.y, force.z, torque.x, torque.y, torque.z)))

    def _take_status(self, now, message):
        for status in message.status:
            values = {pair.key: pair.value for pair in status.values}
            self.statuses.append(Status(now, status.name.removeprefix("mooring: "), int(status.level), status.message, values))
