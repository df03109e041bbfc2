"""Froude scale: the same test at full scale and at 1:50, through adapter, gate and session."""
import numpy as np
import pytest
from geometry_msgs.msg import WrenchStamped
from node_peer import SCENE
from rclpy.serialization import deserialize_message
from scipy.spatial.transform import Rotation
from sensor_msgs.msg import JointState

from mooring_ros.mooring import Mooring
from mooring_ros.motion import Adapter, Gate, Sample
from mooring_ros.node.full_scale import FullScale
from mooring_ros.node.output import Output
from mooring_ros.node.session import Session

SCALE, RATIO = 50.0, 1.025
# Stamps are whole nanoseconds, and the root of 50 is no fraction: these two intervals have it as their ratio to 2e-14.
MODEL_STEP, FULL_STEP = 18 * 548_842, 18 * 3_880_899
ROOT = np.sqrt(SCALE)


def motion(t):
    """Pose (7,) and twist (6,), world axes, of the full-scale platform at t (s)."""
    phase = 2.0 * np.pi * t / np.array([14.0, 9.0, 11.0])
    amplitude = np.array([2.0, 1.0, 0.06])
    surge, heave, pitch = amplitude * np.sin(phase)
    rates = amplitude * 2.0 * np.pi / np.array([14.0, 9.0, 11.0]) * np.cos(phase)
    return (np.array([surge, 0.0, heave, *Rotation.from_rotvec([0.0, pitch, 0.0]).as_quat()]),
            np.array([rates[0], 0.0, rates[1], 0.0, rates[2], 0.0]))


def wrenches(adapter, step, lengths, speeds, rates, steps=400):
    """What goes out, (steps, 1 + coupled, 6): motion at full scale times lengths, speeds and rates goes in every step (ns)."""
    session = Session(Mooring(SCENE), Gate(adapter), Output())
    found = []
    for k in range(steps):
        pose, twist = motion(k * FULL_STEP * 1e-9)
        pose[:3] *= lengths
        sample = Sample(k * step, tuple(pose), (*(speeds * twist[:3]), *(rates * twist[3:])), "world", "platform")
        assert session.take(sample, None) == k * step
        found.append(adapter.wrenches_out(session.wrenches, session.mooring.pose))
    return np.array(found), session


def test_a_test_at_1_to_50_gives_the_full_scale_answers_to_1e_9_after_scaling():
    assert abs(FULL_STEP / MODEL_STEP / ROOT - 1.0) < 1e-13
    full, _ = wrenches(Adapter(twist_frame="world"), FULL_STEP, 1.0, 1.0, 1.0)
    model, session = wrenches(Adapter("world", scale=SCALE, density_ratio=RATIO), MODEL_STEP, 1.0 / SCALE, 1.0 / ROOT, ROOT)
    assert session.mooring.time == pytest.approx(399 * FULL_STEP * 1e-9, rel=1e-12)
    scaled = model * np.repeat([SCALE ** 3 * RATIO, SCALE ** 4 * RATIO], 3)
    for part in (slice(0, 3), slice(3, 6)):
        assert np.abs(scaled[..., part] - full[..., part]).max() < 1e-9 * np.abs(full[..., part]).max()


def test_the_full_scale_topics_are_the_answers_of_the_scene_and_name_no_other_scale():
    model, session = wrenches(Adapter("world", scale=SCALE, density_ratio=RATIO), MODEL_STEP, 1.0 / SCALE, 1.0 / ROOT, ROOT, 20)
    composed = FullScale(session.mooring, session.gate.adapter)
    sent = {name: data for name, _, data in (*composed.wrenches(7, model[-1]), *composed.lines(7, session.mooring))}
    assert list(sent) == list(composed.topics) and all(name.startswith("full_scale/") for name in sent)
    message = deserialize_message(sent["full_scale/wrench"], WrenchStamped)
    np.testing.assert_allclose([message.wrench.force.x, message.wrench.torque.y], session.mooring.wrench[[0, 4]], rtol=1e-12)
    assert message.header.stamp.nanosec == 7
    lines = deserialize_message(sent["full_scale/lines"], JointState)
    np.testing.assert_array_equal(lines.effort, session.mooring.fairlead_tension)
    np.testing.assert_array_equal(lines.position, session.mooring.stretched_length)
    np.testing.assert_array_equal(lines.velocity, session.mooring.length_rate)
