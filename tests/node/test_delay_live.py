"""The delay of a running node, what makes up for it, and the scales of its answers; then the recording of it all done again."""
import json
import math
import subprocess
import sys

import numpy as np
import pytest
from geometry_msgs.msg import WrenchStamped
from mcap.reader import make_reader
from node_peer import SCENE, node_and_peer, numbers, stamp_of
from std_msgs.msg import Float64MultiArray

from mooring_ros.node.delay import FIELDS

SCALE, RATIO, GIVEN = 50.0, 1.025, 0.02
OMEGA = 2.0 * math.pi


def motion(t):
    """Surge (m) and its speed (m/s) at model scale."""
    return 0.04 * math.sin(OMEGA * t), 0.04 * OMEGA * math.cos(OMEGA * t)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """What a peer heard of a node at 1:50 that predicts by 20 ms and what it measures, and the folder with its recording."""
    folder = tmp_path_factory.mktemp("delay")
    with node_and_peer(folder, scale=SCALE, density_ratio=RATIO, full_scale=True, delay__compensate="measured", delay__seconds=GIVEN,
                       recording__enabled=True, recording__path=str(folder / "run.mcap")) as (process, peer):
        delays, full = [], []
        peer.listen(Float64MultiArray, "mooring/delay", lambda message: delays.append(dict(zip(FIELDS, message.data))))
        peer.listen(WrenchStamped, "mooring/full_scale/wrench", full.append)
        peer.wait_for_node()
        peer.wait(lambda: peer.node.count_publishers("mooring/full_scale/wrench"))
        peer.spin(0.3)
        clock, stamps = peer.node.get_clock(), []
        while len(stamps) < 400:
            stamps.append(clock.now().nanoseconds)
            x, v = motion((stamps[-1] - stamps[0]) * 1e-9)
            peer.send(stamps[-1] * 1e-9, x, v)      # float seconds: the stamp is rounded below a microsecond
            peer.spin(0.01)
        peer.wait(lambda: len(delays) > 2 and len(full) >= len(peer.wrenches) >= 390, 10.0, "the answers")
        status = peer.diagnostic("delay", lambda level, values, words: "Hz" in words)
        assert process.end() == 0
        yield peer.wrenches, full, delays, status, folder


def test_the_delay_is_measured_told_and_predicted(run):
    _, _, delays, (level, values, words), _ = run
    last = delays[-1]
    assert 0.0 < last["mean (s)"] < last["99th percentile (s)"] < 5.0
    assert last["predicted (s)"] == pytest.approx(last["mean (s)"] + GIVEN, rel=0.5)
    assert last["frequency of the platform (rad/s)"] == pytest.approx(OMEGA, rel=0.1)
    lost = -0.5 * last["frequency of the platform (rad/s)"] * (last["mean (s)"] + GIVEN)
    assert last["damping ratio added by the delay"] == pytest.approx(lost)
    assert abs(last["with the prediction"]) < 0.5 * abs(lost)
    assert values["compensate"] == "measured" and values["counted from"] == "the stamp" and "predicted" in words


def test_full_scale_stands_beside_model_scale_with_the_same_stamps(run):
    wrenches, full, _, _, _ = run
    beside = {stamp_of(message): numbers(message) for message in full}
    for message in wrenches[-50:]:
        np.testing.assert_allclose(beside[stamp_of(message)], numbers(message) * np.repeat([SCALE ** 3 * RATIO, SCALE ** 4 * RATIO], 3), rtol=1e-13)


def test_the_recording_says_its_scale_and_replays_bit_for_bit_with_the_prediction_in_it(run):
    folder = run[-1]
    with open(folder / "run.mcap", "rb") as file:
        metadata = {record.name: record.metadata for record in make_reader(file).iter_metadata()}
    assert metadata["mooring_ros_scale"]["messages"].startswith("model scale 1:50")
    command = [sys.executable, "-m", "mooring_ros.offline", "replay", SCENE, str(folder / "run.mcap"), "-o", str(folder / "again.mcap"), "--json"]
    found = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    assert found["identical"]["same"] == found["identical"]["total"] >= 390
    validate = [*command[:3], "validate", str(folder / "again.mcap"), str(folder / "run.mcap"), "--json"]
    assert subprocess.run(validate, check=True, capture_output=True).stdout
    assert found["scale"] == {"scale": SCALE, "density_ratio": RATIO}
