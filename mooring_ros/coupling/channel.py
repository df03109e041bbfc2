"""One platform's two topics: its Odometry out, its wrench in."""

import math

import numpy as np
from geometry_msgs.msg import WrenchStamped
from nav_msgs.msg import Odometry
from rclpy.qos import QoSProfile

from mooring_ros.motion import rotation

ODOMETRY_TOPIC = "platform/odom"
_QOS = QoSProfile(depth=10)


class Channel:
    """Publishes `odometry` (topic) in the frames world and platform; take: called with this channel and each message on `wrench` (topic)."""

    def __init__(self, node, odometry, wrench, world, platform, take):
        self.world, self.platform = world, platform
        self._publisher = node.create_publisher(Odometry, odometry, _QOS)
        self._subscription = node.create_subscription(WrenchStamped, wrench, lambda message: take(self, message), _QOS)

    @property
    def topics(self):
        """The topics of both directions as they are after remapping."""
        return f"{self._publisher.topic_name} and {self._subscription.topic_name}"

    @property
    def heard(self):
        """Whether anybody listens to the samples."""
        return self._publisher.get_subscription_count() > 0

    @property
    def matched(self):
        """Whether both directions have found somebody."""
        return self.heard and self._subscription.get_publisher_count() > 0

    def send(self, stamp, pose, twist):
        """Publish a sample: stamp ns, pose (7,), twist (6,) in the world frame (the message's is in the platform's, as ROS wants it)."""
        message = Odometry()
        message.header.frame_id, message.child_frame_id = self.world, self.platform
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 1_000_000_000)
        position, orientation = message.pose.pose.position, message.pose.pose.orientation
        position.x, position.y, position.z, orientation.x, orientation.y, orientation.z, orientation.w = pose
        to_body = rotation.conjugate(pose[3:])
        linear, angular = message.twist.twist.linear, message.twist.twist.angular
        linear.x, linear.y, linear.z = rotation.rotate(to_body, twist[:3])
        angular.x, angular.y, angular.z = rotation.rotate(to_body, twist[3:])
        self._publisher.publish(message)

    def wrench(self, message, pose):
        """The wrench (6,) of an answer to pose (7,), in world axes. Raises ValueError for one in a frame of its own."""
        force, torque, frame = message.wrench.force, message.wrench.torque, message.header.frame_id
        parts = (force.x, force.y, force.z), (torque.x, torque.y, torque.z)
        if frame == self.platform:
            parts = tuple(rotation.rotate(pose[3:], part) for part in parts)
        elif frame != self.world:
            raise ValueError(f"the wrench is in frame '{frame}', expected '{self.world}' or '{self.platform}'")
        return np.array(parts).ravel()


def stamp_of(message):
    """ns."""
    return message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec


def rows(values, columns, platforms, name):
    """So many finite floats for each platform, as a list of tuples. values: (columns,) for one without a name, (platforms, columns) otherwise. ValueError."""
    shape = (platforms, columns) if platforms else (columns,)
    array = np.asarray(values, float)
    if array.shape != shape or not math.isfinite(array.sum()):
        raise ValueError(f"{name} is {np.array2string(array, threshold=20)}, expected finite numbers of shape {shape}")
    return [tuple(row) for row in array.reshape(-1, columns).tolist()]
