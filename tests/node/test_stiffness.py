"""The stiffness as it goes out: axes, scale, and when; without ROS."""
import numpy as np
import pytest
from node_peer import SCENE
from rclpy.serialization import deserialize_message
from std_msgs.msg import Float64MultiArray

from mooring_ros.mooring import Mooring
from mooring_ros.motion import Adapter, rotation
from mooring_ros.node.stiffness import Stiffness, stiffness_out

TURNED = np.array([3.0, -2.0, 1.0, *rotation.from_rotation_vector((0.05, -0.1, 0.7))])
SECOND = 1_000_000_000


@pytest.fixture(scope="module")
def mooring():
    return Mooring(SCENE)


ADAPTERS = [Adapter(), Adapter(wrench_frame="body"), Adapter(convention="ned"), Adapter(convention="ned", wrench_frame="body"),
            Adapter(scale=50.0, density_ratio=1.025), Adapter(convention="ned", wrench_frame="body", scale=10.0)]


@pytest.mark.parametrize("adapter", ADAPTERS, ids=str)
def test_it_tells_how_the_wrench_that_goes_out_follows_a_move_of_the_source(mooring, adapter):
    """A small move is made in the source's own axes and scale; the wrench that goes out is compared, its axes held."""
    mooring.settle(TURNED)
    stiffness = stiffness_out(mooring.stiffness(), adapter, TURNED)
    before = adapter.wrenches_out(mooring.wrench[None], TURNED)[0]
    axes = Adapter(wrench_frame=adapter.wrench_frame, convention=adapter.convention).wrenches_out(np.eye(6), TURNED).T
    for k, size in ((0, 0.01), (2, 0.01), (3, 1e-4), (5, 1e-4)):
        move = np.zeros(6)
        move[k] = size / (adapter.scale if k < 3 else 1.0)
        inside = axes.T @ (np.repeat([adapter.scale, 1.0], 3) * move)
        pose = np.concatenate([TURNED[:3] + inside[:3], rotation.multiply(rotation.from_rotation_vector(inside[3:]), TURNED[3:])])
        mooring.settle(pose)
        change = adapter.wrenches_out(mooring.wrench[None], TURNED)[0] - before
        np.testing.assert_allclose(-stiffness @ move, change, rtol=0.02, atol=2e-3 * np.abs(change).max())


def numbers(data):
    message = deserialize_message(data, Float64MultiArray)
    assert [(d.label, d.size, d.stride) for d in message.layout.dim] == [("wrench", 6, 36), ("motion", 6, 6)]
    return np.reshape(message.data, (6, 6))


def test_it_comes_after_each_settle_and_for_listeners_when_the_range_is_left(mooring):
    home = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
    stiffness = Stiffness(mooring, Adapter(), 2.0)
    mooring.settle(home)
    np.testing.assert_array_equal(numbers(stiffness.message(SECOND, 1, False)), mooring.stiffness())
    assert stiffness.message(5 * SECOND, 1, True) is None       # it is where it was
    mooring.settle(home + [2.0, 0, 0, 0, 0, 0, 0])
    assert stiffness.message(5 * SECOND, 1, False) is None      # nobody listens
    assert stiffness.message(SECOND + SECOND // 4, 1, True) is None
    np.testing.assert_array_equal(numbers(stiffness.message(5 * SECOND, 1, True)), mooring.stiffness())
    assert stiffness.message(6 * SECOND, 2, False) is not None
    stiffness.rate = 0.0
    assert stiffness.message(9 * SECOND, 3, True) is None


def test_it_changes_no_bit_of_the_steps_after_it():
    def wrenches(asked):
        mooring = Mooring(SCENE)
        mooring.settle(np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]))
        for k in range(1, 40):
            mooring.step(0.05 * k, np.array([0.05 * k, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]), np.array([1.0, 0, 0, 0, 0, 0]))
            if asked and k % 7 == 0:
                mooring.stiffness()
            yield mooring.wrench
    np.testing.assert_array_equal(list(wrenches(True)), list(wrenches(False)))
