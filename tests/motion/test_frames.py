"""The adapter of frames, units and scale, against rotation matrices and hand-made cases."""
import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mooring_ros.motion import Adapter, rotation, twist_axes

NED_TO_ENU = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
FRD_TO_FLU = np.diag([1.0, -1.0, -1.0])


def random_poses(count, seed=1):
    rng = np.random.default_rng(seed)
    return [(*rng.uniform(-50, 50, 3), *Rotation.random(random_state=rng).as_quat()) for _ in range(count)]


def matrix(pose):
    return Rotation.from_quat(pose[3:]).as_matrix()


def test_enu_pose_and_world_twist_pass_through_unchanged():
    adapter = Adapter(twist_frame="world")
    for pose in random_poses(5):
        assert adapter.pose_in(pose) == pose
        assert adapter.twist_in((1.0, 2.0, 3.0, 0.1, 0.2, 0.3), pose[3:]) == (1.0, 2.0, 3.0, 0.1, 0.2, 0.3)


def test_child_twist_is_turned_into_world_axes():
    for pose in random_poses(5):
        twist = np.array([1.0, -2.0, 3.0, 0.1, 0.2, -0.3])
        inside = Adapter().twist_in(twist, pose[3:])
        np.testing.assert_allclose(inside[:3], matrix(pose) @ twist[:3], atol=1e-14)
        np.testing.assert_allclose(inside[3:], matrix(pose) @ twist[3:], atol=1e-14)


def test_ned_pose_becomes_the_same_place_and_attitude_in_enu():
    for pose in random_poses(5):
        inside = Adapter(convention="ned").pose_in(pose)
        np.testing.assert_allclose(inside[:3], NED_TO_ENU @ pose[:3])
        np.testing.assert_allclose(matrix(inside), NED_TO_ENU @ matrix(pose) @ FRD_TO_FLU, atol=1e-14)


def test_ned_north_heading_is_facing_north_in_enu():
    inside = Adapter(convention="ned").pose_in((0.0, 0.0, 0.0, *rotation.IDENTITY))
    np.testing.assert_allclose(matrix(inside) @ [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], atol=1e-14)
    np.testing.assert_allclose(matrix(inside) @ [0.0, 0.0, 1.0], [0.0, 0.0, 1.0], atol=1e-14)


@pytest.mark.parametrize("twist_frame", ["child", "world"])
def test_ned_twist_is_the_same_motion_in_enu(twist_frame):
    for pose in random_poses(5):
        adapter = Adapter(convention="ned", twist_frame=twist_frame)
        twist = np.array([1.0, -2.0, 3.0, 0.1, 0.2, -0.3])
        inside = adapter.twist_in(twist, adapter.pose_in(pose)[3:])
        turn = NED_TO_ENU @ matrix(pose) if twist_frame == "child" else NED_TO_ENU
        np.testing.assert_allclose(inside, np.concatenate([turn @ twist[:3], turn @ twist[3:]]), atol=1e-13)


@pytest.mark.parametrize("convention", ["enu", "ned"])
@pytest.mark.parametrize("wrench_frame", ["world", "body"])
def test_power_of_the_wrench_is_the_same_on_both_sides(convention, wrench_frame):
    """A wrench in the source's axes does the same work on the source's twist as the one inside on the twist inside."""
    rng = np.random.default_rng(3)
    adapter = Adapter(convention=convention, wrench_frame=wrench_frame, twist_frame="child" if wrench_frame == "body" else "world")
    for pose in random_poses(5):
        wrench, twist = rng.normal(size=(1, 6)) * 1e6, rng.normal(size=6)
        inside = adapter.pose_in(pose)
        power = float(wrench[0] @ adapter.twist_in(twist, inside[3:]))
        assert float(adapter.wrenches_out(wrench, inside)[0] @ twist) == pytest.approx(power, rel=1e-12)


def test_world_enu_wrench_is_handed_back_bit_for_bit():
    wrench = np.random.default_rng(0).normal(size=(4, 6)) * 1e6
    np.testing.assert_array_equal(Adapter().wrenches_out(wrench, random_poses(1)[0]), wrench)


def test_model_scale_follows_froude():
    adapter = Adapter(scale=50.0, density_ratio=1.025)
    assert adapter.pose_in((0.1, 0.0, -0.02, *rotation.IDENTITY))[:3] == (5.0, 0.0, -1.0)
    twist = adapter.twist_in((0.1, 0.0, 0.0, 0.0, 0.0, 0.3), rotation.IDENTITY)
    assert twist[0] == pytest.approx(0.1 * math.sqrt(50.0))
    assert twist[5] == pytest.approx(0.3 / math.sqrt(50.0))
    assert adapter.time_factor == pytest.approx(math.sqrt(50.0))
    out = adapter.wrenches_out(np.ones((1, 6)), (0.0, 0.0, 0.0, *rotation.IDENTITY))[0]
    np.testing.assert_allclose(out, [1 / (50.0 ** 3 * 1.025)] * 3 + [1 / (50.0 ** 4 * 1.025)] * 3)


def test_points_go_back_into_the_sources_world():
    adapter = Adapter(convention="ned", scale=10.0)
    points = np.array([[1.0, 2.0, -30.0]])
    np.testing.assert_allclose(adapter.points_out(points), [[0.2, 0.1, 3.0]])


@pytest.mark.parametrize("wrong", [{"twist_frame": "body"}, {"convention": "nwu"}, {"wrench_frame": "child"}, {"scale": 0.0}, {"scale": math.nan},
                                   {"density_ratio": -1.0}])
def test_unknown_choices_are_refused_by_name(wrong):
    with pytest.raises(ValueError, match=next(iter(wrong))):
        Adapter(**wrong)


def test_a_twist_message_may_name_its_own_axes():
    assert twist_axes("map", "map", "base_link", "child") == "world"
    assert twist_axes("base_link", "map", "base_link", "world") == "child"
    assert twist_axes("", "", "", "child") == "child"
    assert twist_axes("imu", "map", "base_link", "world") == "world"


def test_rotation_vectors_and_quaternions_match_scipy():
    rng = np.random.default_rng(5)
    for _ in range(50):
        vector = rng.normal(size=3) * rng.choice([1e-9, 1e-3, 1.0])
        q = rotation.from_rotation_vector(vector)
        np.testing.assert_allclose(q, Rotation.from_rotvec(vector).as_quat(), atol=1e-14)
        np.testing.assert_allclose(rotation.rotation_vector(q), vector, rtol=1e-9, atol=1e-15)
        other = Rotation.random(random_state=rng).as_quat()
        np.testing.assert_allclose(rotation.matrix(other), Rotation.from_quat(other).as_matrix(), atol=1e-14)
        np.testing.assert_allclose(rotation.turn_between(other, rotation.multiply(q, other)), vector, rtol=1e-6, atol=1e-14)
