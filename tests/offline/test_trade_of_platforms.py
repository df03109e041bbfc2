"""`mooring trade` on the motion of several platforms."""

import numpy as np
import pytest
import yaml
from test_motion_of_platforms import NAMES, PAIR, motion, recorded, table

from mooring_ros.mooring import Mooring
from mooring_ros.offline import trade_window
from mooring_ros.offline.motion_file import Motion
from mooring_ros.offline.trade_measure import measure
from mooring_ros.offline.trade_setting import Setting

TIMES = np.arange(0.0, 60.0, 0.1)


@pytest.fixture
def pair(tmp_path, monkeypatch):
    """Path of the scene; an empty cache and a working directory of its own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "pair.txt"
    path.write_text(PAIR)
    return path


def of(poses, twists):
    return Motion("", TIMES, poses, twists, np.zeros(TIMES.size, np.int64), "", platforms=NAMES if poses.ndim == 3 else ())


def test_a_setting_is_found_for_several_platforms_and_its_parameters_and_command_name_them(pair, tmp_path, mooring):
    found = mooring("trade", pair, table(tmp_path / "m.csv"), "--error", 10, "--time", 6, "--json")
    assert found.status == 0, found.err
    chosen = found.json()["chosen"]
    assert chosen["errors"]["worst"] <= 10.0 and {setting["fidelity"] for setting in found.json()["settings"]} == {"dynamic", "quasi_static", "linear"}
    values = yaml.safe_load((tmp_path / "trade_parameters.yaml").read_text())["/**"]["ros__parameters"]
    assert values["platforms"] == list(NAMES)
    assert mooring(*found.json()["replay"].split()[1:]).status == 0


def test_a_trade_by_topic_says_so_in_the_command_that_repeats_its_choice(pair, tmp_path, mooring):
    found = mooring("trade", pair, recorded(tmp_path / "m.mcap"), "--topic", "/tank/body2/odom", "--budget", 10, "--time", 3, "--json")
    assert found.status == 0, found.err
    assert "--topic /tank/body2/odom" in found.json()["replay"] and mooring(*found.json()["replay"].split()[1:]).status == 0


def test_runs_are_of_the_platforms(pair):
    window = trade_window.whole(of(*motion(TIMES)))
    found = measure(Mooring(pair).scene, Setting("dynamic", "explicit"), window, 10.0, False, platforms=NAMES)
    own = Mooring(pair, platforms=NAMES)
    own.settle(window.poses[0])
    np.testing.assert_array_equal(found.tension, own.run(window.times[1:], window.poses[1:], window.twists[1:]).fairlead_tension)


def test_the_period_is_that_of_the_fastest_and_all_swell_from_their_own_places():
    poses, twists = motion(TIMES)
    alone = [of(poses[:, own].copy(), twists[:, own].copy()) for own in range(2)]
    assert trade_window.motion_period(of(poses, twists)) == trade_window.motion_period(alone[1]) == pytest.approx(2.0 * np.pi / 1.5, rel=0.05)
    turning = poses.copy(), twists.copy()
    for values in turning:
        values[:, :, :3] = 0.0
    assert trade_window.motion_period(of(*turning)) == pytest.approx(2.0 * np.pi / 1.5, rel=0.05)
    poses, twists = poses[10:].copy(), twists[10:].copy()
    first = poses[0].copy()
    trade_window.swell(TIMES[10:], poses, twists, 5.0)
    for own, one in enumerate(alone):
        own_poses, own_twists = one.poses[10:].copy(), one.twists[10:].copy()
        trade_window.swell(TIMES[10:], own_poses, own_twists, 5.0)
        assert np.array_equal(poses[:, own], own_poses) and np.array_equal(twists[:, own], own_twists)
    assert np.array_equal(poses[0], first) and not twists[0].any()


@pytest.mark.parametrize("solver", ["explicit", "implicit"])
def test_the_step_that_a_trade_reckons_with_does_not_know_platforms(pair, solver):
    assert Mooring(pair, solver=solver).step_limit == Mooring(pair, solver=solver, platforms=NAMES).step_limit
