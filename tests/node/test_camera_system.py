"""A camera system as the source: best-effort, poses only, bunched stamps, frames without the platform."""
import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped
from node_peer import Peer, node_and_peer, numbers, stamp_of
from rclpy.qos import QoSProfile, ReliabilityPolicy

from benchmarks import camera_frames as recorded


@pytest.fixture(scope="module")
def cameras(tmp_path_factory):
    """A node at 1:50 with a best-effort publisher of poses as its only source: the peer, and a function that sends frames."""
    with node_and_peer(tmp_path_factory.mktemp("node"), input="pose", scale=50.0, density_ratio=1.025, input_rate=recorded.RATE, input_bandwidth=10.0,
                       limits__lost_frames=5) as (process, peer):
        peer.node.destroy_publisher(peer._pose)
        publisher = peer.node.create_publisher(PoseStamped, "platform/pose", QoSProfile(depth=50, reliability=ReliabilityPolicy.BEST_EFFORT))
        process.wait_for("active: listens")
        peer.wait(publisher.get_subscription_count, 20.0, "a subscription that a best-effort publisher matches")
        peer.wait(lambda: peer.node.count_publishers("mooring/wrench"))
        peer.spin(0.2)

        def send(frame):
            message = PoseStamped()
            Peer._fill_header(message, 0.0, "world")
            message.header.stamp.sec, message.header.stamp.nanosec = divmod(frame.sample.stamp, 1_000_000_000)
            Peer._fill_pose(message.pose, frame.sample.pose[:3], frame.sample.pose[3:])
            publisher.publish(message)
            peer.spin(0.004)
        yield process, peer, send


def test_frames_of_a_best_effort_camera_system_are_answered_smoothly_and_bridged(cameras):
    process, peer, send = cameras
    assert "are best-effort" in process.log
    made = recorded.occluded(recorded.bunched(recorded.frames(2.0)), 350, 4)
    for frame in made:
        send(frame)
    peer.wait(lambda: len(peer.wrenches) >= 0.98 * len(made), 10.0, "the wrenches")
    answered = {stamp_of(m) for m in peer.wrenches}
    assert answered <= {frame.sample.stamp for frame in made}
    assert len(answered & {frame.sample.stamp for frame in made[350:354]}) >= 3     # best effort may lose one
    surge = np.array([numbers(m)[0] for m in peer.wrenches])
    assert np.isfinite(surge).all()
    # between frames the force goes up by what the motion does, not by what noise and bunched stamps would make of it
    change = np.abs(np.diff(surge[50:]))
    assert change.max() < 0.15 * np.ptp(surge[50:])
    _, values, _ = peer.diagnostic("input", lambda level, values, _: int(values["accepted"]) >= 0.98 * (len(made) - 4))
    assert values["non_finite"] == "4" == values["bridged"] and int(values["late frames"]) > 20
