"""The schemes on a spring: order, damping, and how large a step may be."""

import numpy as np
import pytest

from mooring_ros.coupling.schemes import SCHEMES

OMEGA = 0.7
SPRING = OMEGA**2 * np.eye(6)


def swing(name, step, seconds, damping=0.0, stiffness=SPRING):
    """Surge (n, 2): x and v of a unit mass on a spring and damper, the force held over each step; the motion within a step is exact."""
    scheme, x, v, rows = SCHEMES[name](), 1.0, 0.0, []
    for number in range(round(seconds / step)):
        rows.append((x, v))
        pose, twist = [x, 0, 0, 0, 0, 0, 1], [v, 0, 0, 0, 0, 0]
        scheme.take(number * step, pose, twist, -SPRING[0] * x - damping * np.eye(6)[0] * v, stiffness)
        force = scheme.ahead(0.5 * step)[0]
        x, v = x + step * v + 0.5 * step**2 * force, v + step * force
    return np.array(rows)


def exact(time, damping=0.0):
    turning = np.sqrt(OMEGA**2 - 0.25 * damping**2)
    return np.exp(-0.5 * damping * time) * (np.cos(turning * time) + 0.5 * damping / turning * np.sin(turning * time))


def error(name, step):
    rows = swing(name, step, 40.0, damping=0.1)
    return np.abs(rows[:, 0] - exact(step * np.arange(len(rows)), damping=0.1)).max()


@pytest.mark.parametrize("name, order", [("held", 1), ("extrapolated", 2), ("stiffness", 2)])
def test_order_in_the_step(name, order):
    errors = [error(name, step) for step in (0.2, 0.1, 0.05, 0.025)]
    assert np.log2(np.divide(errors[:-1], errors[1:]))[-1] == pytest.approx(order, abs=0.15)


def test_a_held_wrench_loses_a_share_of_critical_damping_of_a_quarter_of_omega_h():
    step = 0.1
    energy = swing("held", step, 60.0) ** 2 @ [OMEGA**2, 1.0]
    gained = np.polyfit(step * np.arange(energy.size), np.log(energy), 1)[0] / (2.0 * OMEGA)
    assert gained == pytest.approx(OMEGA * step / 4.0, rel=0.02)


def test_with_the_stiffness_a_spring_keeps_its_energy_up_to_large_steps():
    step = 1.9 / OMEGA
    assert np.abs(swing("stiffness", step, 400.0)[:, 0]).max() < 1.01
    assert np.abs(swing("extrapolated", step, 400.0)[:, 0]).max() > 1e3


def test_a_stiffness_that_is_wrong_costs_no_order():
    def off(step):
        rows = swing("stiffness", step, 40.0, damping=0.1, stiffness=1.5 * SPRING)
        return np.abs(rows[:, 0] - exact(step * np.arange(len(rows)), damping=0.1)).max()

    assert np.log2(off(0.1) / off(0.05)) == pytest.approx(2.0, abs=0.2)


def test_a_turn_is_followed_by_the_stiffness_about_the_world_axes():
    scheme, spring = SCHEMES["stiffness"](), np.diag([0, 0, 0, 3.0, 5.0, 7.0])
    rate = np.array([0.0, 0.0, 0.3])
    for number in range(2):
        angle = 0.3 * 0.1 * number
        scheme.take(0.1 * number, [0, 0, 0, 0, 0, np.sin(angle / 2), np.cos(angle / 2)], [0, 0, 0, *rate], [0, 0, 0, 0, 0, -7.0 * angle], spring)
    np.testing.assert_allclose(scheme.ahead(0.05), [0, 0, 0, 0, 0, -7.0 * 0.3 * 0.15], atol=1e-12)
