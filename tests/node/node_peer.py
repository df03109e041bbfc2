"""A node process under test and a peer that talks to it over DDS."""
import contextlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped
from lifecycle_msgs.srv import ChangeState, GetState
from nav_msgs.msg import Odometry
from rcl_interfaces.srv import SetParameters
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import Trigger
from lifecycle_msgs.msg import Transition

from benchmarks.domains import free_domain

SCENE = str(Path(__file__).parents[2] / "config" / "scenes" / "oc4.txt")
UPRIGHT = (0.0, 0.0, 0.0, 1.0)
START = 180.0           # s, cold compilation included

TRANSITIONS = {"configure": Transition.TRANSITION_CONFIGURE, "activate": Transition.TRANSITION_ACTIVATE,
               "deactivate": Transition.TRANSITION_DEACTIVATE, "cleanup": Transition.TRANSITION_CLEANUP}


class NodeProcess:
    """A mooring node as a process of its own. parameters: name -> value. The log is in `log`."""

    def __init__(self, folder, parameters, domain):
        arguments = [part for name, value in parameters.items() for part in ("-p", f"{name}:={_yaml(value)}")]
        self._log = open(Path(folder) / "node.log", "w+", encoding="utf-8")
        self.process = subprocess.Popen([sys.executable, "-m", "mooring_ros.node", "--ros-args", *arguments], cwd=Path(__file__).parents[2],
                                        stdout=self._log, stderr=subprocess.STDOUT, env={**os.environ, "ROS_DOMAIN_ID": str(domain)})

    @property
    def log(self):
        self._log.flush()
        return Path(self._log.name).read_text(encoding="utf-8")

    def wait_for(self, words, timeout=START):
        """Wait until the log has these words."""
        end = time.monotonic() + timeout
        while words not in self.log:
            assert self.process.poll() is None, f"the node ended with {self.process.returncode}:\n{self.log}"
            assert time.monotonic() < end, f"no '{words}' in the log:\n{self.log}"
            time.sleep(0.05)

    def end(self, number=signal.SIGTERM, times=1):
        """Send a signal; returns the exit status."""
        for _ in range(times):
            if self.process.poll() is None:
                self.process.send_signal(number)
                time.sleep(0.02)
        try:
            return self.process.wait(20.0)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise
        finally:
            self._log.close()


def _yaml(value):
    return f'"{value}"' if isinstance(value, str) else str(value).lower() if isinstance(value, bool) else value


class Peer:
    """What a simulator has: motion out, answers in. Times are s of the simulation."""

    def __init__(self, domain, process=None):
        self._process = process
        self._context = rclpy.Context()
        self._context.init(domain_id=domain)
        self.node = rclpy.create_node("peer", context=self._context)
        self._executor = EventsExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._odometry = self.node.create_publisher(Odometry, "platform/odom", 50)
        self._pose = self.node.create_publisher(PoseStamped, "platform/pose", 50)
        self._twist = self.node.create_publisher(TwistStamped, "platform/twist", 50)
        self.wrenches, self.lines, self.tensions, self.fairleads, self.status = [], [], [], {}, {}
        self.listen(WrenchStamped, "mooring/wrench", self.wrenches.append)
        self.listen(JointState, "mooring/lines", self.lines.append)
        self.listen(Float64MultiArray, "mooring/line_tensions", self.tensions.append)
        self.listen(DiagnosticArray, "/diagnostics", lambda message: self.status.update({s.name: s for s in message.status}))
        self._clients = {}

    def listen(self, message_type, topic, callback):
        return self.node.create_subscription(message_type, topic, callback, 100)

    def close(self):
        self._executor.shutdown()
        self.node.destroy_node()
        self._context.try_shutdown()

    # --- waiting ---

    def spin(self, seconds):
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0.0:
            self._executor.spin_once(timeout_sec=left)

    def wait(self, condition, timeout=10.0, what="condition"):
        end = time.monotonic() + timeout
        while not (result := condition()):
            alive = self._process is None or self._process.process.poll() is None
            assert alive and time.monotonic() < end, f"waited {timeout} s for {what}" + ("" if alive else ", but the node has ended:\n" + self._process.log)
            self._executor.spin_once(timeout_sec=0.02)
        return result

    def wait_for_node(self, topic="platform/odom", timeout=START):
        """Until the node is active and both sides know each other."""
        self.wait(lambda: self.node.count_subscribers(topic) and self.node.count_publishers("mooring/wrench"), timeout, f"the node on {topic}")
        self.wait(lambda: all(p.get_subscription_count() for p in (self._odometry, self._pose, self._twist) if p.topic_name == "/" + topic))
        self.spin(0.15)     # discovery is one-sided for a moment

    # --- motion ---

    def send(self, t, x=0.0, v=0.0, q=UPRIGHT, position=None, twist=None, frame="world", child="platform"):
        """An Odometry at time t, in surge at x (m) with v (m/s), or with a whole position and twist."""
        message = Odometry(child_frame_id=child)
        self._fill_header(message, t, frame)
        self._fill_pose(message.pose.pose, position or (x, 0.0, 0.0), q)
        self._fill_twist(message.twist.twist, twist or (v, 0.0, 0.0, 0.0, 0.0, 0.0))
        self._odometry.publish(message)
        return message

    def send_pose(self, t, x=0.0):
        message = PoseStamped()
        self._fill_header(message, t, "world")
        self._fill_pose(message.pose, (x, 0.0, 0.0), UPRIGHT)
        self._pose.publish(message)

    def send_twist(self, t, v=0.0):
        message = TwistStamped()
        self._fill_header(message, t, "")
        self._fill_twist(message.twist, (v, 0.0, 0.0, 0.0, 0.0, 0.0))
        self._twist.publish(message)

    def answer(self, t, timeout=5.0, after=0):
        """The wrench (6,) that carries the stamp t, among those heard but for the first `after`."""
        message = self.wait(lambda: next((m for m in self.wrenches[after:] if stamp_of(m) == round(t * 1e9)), None), timeout, f"the wrench of {t} s")
        return numbers(message)

    def ask(self, t, *args, **keywords):
        """Send a sample and return its wrench (6,)."""
        heard = len(self.wrenches)
        self.send(t, *args, **keywords)
        return self.answer(t, after=heard)

    @staticmethod
    def _fill_header(message, t, frame):
        message.header.frame_id = frame
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(t * 1e9), 1_000_000_000)

    @staticmethod
    def _fill_pose(pose, position, q):
        pose.position.x, pose.position.y, pose.position.z = map(float, position)
        pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w = map(float, q)

    @staticmethod
    def _fill_twist(message, twist):
        message.linear.x, message.linear.y, message.linear.z, message.angular.x, message.angular.y, message.angular.z = map(float, twist)

    # --- services ---

    def call(self, name, service_type=Trigger, request=None, timeout=30.0):
        client = self._clients.get(name)
        if client is None:
            client = self._clients[name] = self.node.create_client(service_type, name)
        self.wait(client.service_is_ready, timeout, f"service {name}")
        future = client.call_async(request or service_type.Request())
        self.wait(future.done, timeout, f"the answer of {name}")
        return future.result()

    def transition(self, label):
        request = ChangeState.Request()
        request.transition.id = TRANSITIONS[label]
        return self.call("mooring/change_state", ChangeState, request, START).success

    def state(self):
        return self.call("mooring/get_state", GetState).current_state.label

    def set(self, name, value):
        request = SetParameters.Request(parameters=[Parameter(name, value=value).to_parameter_msg()])
        return self.call("mooring/set_parameters", SetParameters, request).results[0]

    def restart(self):
        """A fresh session of the same process, and nothing left of the last."""
        if self.state() == "active":
            assert self.transition("deactivate")
        assert self.transition("activate")
        self.wait_for_node()
        for heard in (self.wrenches, self.lines, self.tensions):
            heard.clear()
        self.status.clear()

    def diagnostic(self, name, condition=lambda level, values, message: True, timeout=5.0):
        """The values of a status once its level, values and message fulfil a condition."""
        def found():
            status = self.status.get("mooring: " + name)
            if status is None:
                return None
            values = {pair.key: pair.value for pair in status.values}
            return (values, status) if condition(status.level, values, status.message) else None
        try:
            values, status = self.wait(found, timeout, f"diagnostics of {name}")
        except AssertionError as error:
            raise AssertionError(f"{error}, now {self.status.get('mooring: ' + name)}") from None
        return status.level, values, status.message


def stamp_of(message):
    return message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec


def numbers(message):
    force, torque = message.wrench.force, message.wrench.torque
    return np.array([force.x, force.y, force.z, torque.x, torque.y, torque.z])


@contextlib.contextmanager
def node_and_peer(folder, **parameters):
    """A node process with these parameters (dots written as __) and a peer on a domain of their own; ended at exit."""
    domain = free_domain()
    process = NodeProcess(folder, {"scene": SCENE, **{name.replace("__", "."): value for name, value in parameters.items()}}, domain)
    peer = Peer(domain, process)
    try:
        yield process, peer
    finally:
        peer.close()
        if process.process.poll() is None:
            process.end()
