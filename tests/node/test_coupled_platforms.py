"""The coupling helper with several platforms in one node."""
import numpy as np
from node_peer import SCENE, START, node_and_peer

from mooring_ros.coupling import Coupling
from mooring_ros.mooring import Mooring

PAIR = SCENE.replace("oc4.txt", "oc4_pair.txt")
NAMES = ["body1", "body2"]
STEP = 0.05


def surge(home, t):
    poses, twists = home.copy(), np.zeros((2, 6))
    poses[:, 0] += (1.0 - np.cos(0.3 * t)) * np.array([1.0, -0.5])
    twists[:, 0] = 0.3 * np.sin(0.3 * t) * np.array([1.0, -0.5])
    return poses, twists


def test_two_platforms_are_answered_together_with_the_wrenches_of_the_facade(tmp_path, monkeypatch):
    mooring = Mooring(PAIR, platforms=NAMES)
    home = mooring.pose_in_file
    with node_and_peer(tmp_path, scene=PAIR, platforms=NAMES) as (process, peer):
        process.wait_for("active: listens")
        monkeypatch.setenv("ROS_DOMAIN_ID", str(peer.node.context.get_domain_id()))
        with Coupling(STEP, scheme="stiffness", platforms=NAMES, timeout=START) as coupled:
            begun = coupled.begin(home)
            mooring.settle(home, time=coupled.time)
            np.testing.assert_array_equal(begun, mooring.wrench)
            assert coupled.stiffness.shape == (12, 12)
            begin = coupled.time
            for k in range(1, 30):
                poses, twists = surge(home, STEP * k)
                ahead = coupled.exchange(poses, twists)
                mooring.step(1e-9 * coupled.stamp, poses, twists)
                np.testing.assert_array_equal(coupled.wrench, mooring.wrench)
            assert coupled.time > begin and ahead.shape == (2, 6)
            assert (coupled.counts.answered, coupled.counts.lost, coupled.counts.doubled, coupled.counts.late) == (29, 0, 0, 0)
