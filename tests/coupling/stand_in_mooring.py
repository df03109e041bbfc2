"""A linear spring in the place of the mooring node; run as a script. Misbehaves when told to, at a given sample."""

import argparse
import time

import numpy as np
import rclpy
from geometry_msgs.msg import WrenchStamped
from lifecycle_msgs.msg import State
from lifecycle_msgs.srv import GetState
from nav_msgs.msg import Odometry
from rclpy.executors import ExternalShutdownException


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--drop", type=int, default=-1)
    parser.add_argument("--double", type=int, default=-1)
    parser.add_argument("--silent-after", type=int, default=10**9)
    parser.add_argument("--frame", default="world")
    parser.add_argument("--begin-after", type=float, default=0.0)
    parser.add_argument("--unconfigured", action="store_true")
    options = parser.parse_args()
    time.sleep(options.begin_after)
    rclpy.init()
    node = rclpy.create_node("mooring")
    if options.unconfigured:
        node.create_service(GetState, "~/get_state", lambda _, reply: _state(reply))
        return _spin(node)
    publisher = node.create_publisher(WrenchStamped, "~/wrench", 10)
    stamps = []

    def answer(message):
        stamps.append((message.header.stamp.sec, message.header.stamp.nanosec))
        assert len(set(stamps)) == len(stamps), "a stamp came twice"
        number = len(stamps) - 1
        if number == options.drop or number >= options.silent_after:
            return
        position = message.pose.pose.position
        force = -7.19e4 * np.array([position.x, position.y, position.z]) + [0.0, 0.0, -6.08e6]
        reply = WrenchStamped(header=message.header)
        reply.header.frame_id = options.frame
        reply.wrench.force.x, reply.wrench.force.y, reply.wrench.force.z = force.tolist()
        for _ in range(2 if number == options.double else 1):
            publisher.publish(reply)

    node.create_subscription(Odometry, "platform/odom", answer, 10)
    _spin(node)


def _state(reply):
    reply.current_state.id, reply.current_state.label = State.PRIMARY_STATE_UNCONFIGURED, "unconfigured"
    return reply


def _spin(node):
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
