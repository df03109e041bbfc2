"""Current profiles."""

import numpy as np

from mooring_ros.core.cache import kernel
from mooring_ros.core.sea import build_sea
from mooring_ros.core.wave_sums import WINDOW_ROWS, WORK_SIZE
from mooring_ros.core.waves import refresh, streams
from mooring_ros.scene.description import REGULAR, Environment, Waves

PROFILE = ((-60.0, 0.1, 0.0, 0.0), (-30.0, 0.4, -0.2, 0.01), (-10.0, 0.9, 0.3, 0.0), (0.0, 1.2, 0.3, -0.02))
UNIFORM = (0.2, -0.1, 0.0)


@kernel
def streams_at(sea, time, size, position, window_times, window, stream, swell):
    streams(sea, time, size, position, window_times, window, stream, swell)


def flow(environment, z):
    """Velocity (3, n) of the water at levels z (n,) above each other, at the start."""
    sea, n = build_sea(environment), len(z)
    waves = n if environment.waves else 0
    position = np.array([np.zeros(n), np.zeros(n), z])
    times, window = np.array([0.0, -1.0]), np.zeros((2, WINDOW_ROWS, waves))
    stream, swell = np.tile(sea.current[:, None], n), np.zeros((4, waves))
    if waves:
        refresh(sea, 0.0, 0.0, n, position, np.zeros((3, n)), np.zeros(WORK_SIZE), times, window)
    streams_at(sea, 0.0, n, position, times, window, stream, swell)
    return stream


def interpolated(z):
    rows = np.array(PROFILE)
    return np.array([np.interp(z, rows[:, 0], rows[:, k]) for k in (1, 2, 3)])


def test_current_is_linear_between_the_levels_and_constant_beyond():
    z = np.concatenate([[-200.0, 8.0], np.linspace(-75.0, 3.0, 79)])
    assert np.allclose(flow(Environment(depth=250.0, current_profile=PROFILE), z), interpolated(z), atol=1e-14)


def test_profile_comes_on_top_of_the_uniform_current():
    z = np.linspace(-75.0, 3.0, 79)
    found = flow(Environment(depth=250.0, current=UNIFORM, current_profile=PROFILE), z)
    assert np.allclose(found, interpolated(z) + np.array(UNIFORM)[:, None], atol=1e-14)


def test_a_profile_of_one_level_is_a_uniform_current():
    z = np.linspace(-75.0, 3.0, 20)
    found = flow(Environment(depth=250.0, current=UNIFORM, current_profile=((-5.0, 0.3, 0.0, 0.1),)), z)
    assert np.allclose(found, np.array([[0.5], [-0.1], [0.1]]), atol=1e-15)


def test_waves_come_on_top_of_the_current():
    z = np.linspace(-75.0, -2.0, 40)
    waves = Waves(kind=REGULAR, height=2.0, period=9.0)
    together = flow(Environment(depth=250.0, current=UNIFORM, current_profile=PROFILE, waves=waves), z)
    alone = flow(Environment(depth=250.0, waves=waves), z)
    assert np.allclose(together - alone, interpolated(z) + np.array(UNIFORM)[:, None], atol=1e-14)
    assert np.max(np.abs(alone)) > 0.3
