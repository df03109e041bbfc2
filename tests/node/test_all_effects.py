"""A node on a scene with everything in it: an answer for each coupled part, and a recording that needs nothing beside it."""
import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from geometry_msgs.msg import WrenchStamped
from node_peer import node_and_peer, numbers
from sensor_msgs.msg import JointState
from visualization_msgs.msg import MarkerArray

SCENE = """\
--- LINE TYPES ---
Name  Diam  Mass/m  EA  BA/-zeta  EI  Cd  Ca  CdAx  CaAx
chain  0.05  50  2.0e7  -0.8  0  2.0  0.8  0.4  0.25
cable  0.10  20  5.0e7  -0.5  5e3  1.0  1.0  0.1  0.0
rope  0.10  9  2e6|1e7  1e7|1e6  0  1.2  1.0  0.0  0.0
tail  0.10  9  tables/curve.txt  -0.5  0  1.2  1.0  0.0  0.0
--- ROD TYPES ---
Name  Diam  Mass/m  Cd  Ca  CdEnd  CaEnd
pipe  0.3  120  0.6  1.0  1.0  1.0
--- BODIES ---
ID  Attachment  X  Y  Z  r  p  y  Mass  CG  I  Volume  CdA  Ca
1  Free      110  0  -20  0  0  0  2000  -0.5  2e3  3  2  0.5
2  Coupled   -22  0  -6   0  0  0  500   0     1e2  0.2  1  0.5
--- RODS ---
ID  Type  Attachment  Xa  Ya  Za  Xb  Yb  Zb  NumSegs  Outputs
1  pipe  Coupled  0  10  -5  0  11.5  -7  2  -
2  pipe  Fixed  0  100  -59.8  0  102  -59.8  1  -
--- POINTS ---
ID  Type  X  Y  Z  Mass  Volume  CdA  Ca
1  Fixed    250  0  -66.25  0  0  0  0
2  Body1   0  0  -1  0  0  0  0
3  Body1   0  0  1  0  0  0  0
4  Coupled   20  0   -5  0  0  0  0
5  Fixed   -250  0  -53.75  0  0  0  0
6  Free    -140  0  -40  100  0.02  0.5  0.5
7  Body2  -1  0  -0.5  0  0  0  0
--- LINES ---
ID  LineType  AttachA  AttachB  UnstrLen  NumSegs  Outputs
1  chain  1  2  150  10  -
2  tail  3  4  90  6  -
3  cable  R1B  R2A  112  14  -
4  rope  5  6  111  6  -
5  tail  6  7  121  6  -
--- FAILURE ---
ID  Point  Lines  Time  Tension
1  4  2  0.6  0
--- OPTIONS ---
tables/depths.txt  WtrDpth
0.9  mu_kT
0.7  mu_kA
regular WaveModel
1.5 WaveHeight
6 WavePeriod
1  Currents
"""
TABLES = {
    "tables/depths.txt": "2 2\n-400 400\n-400 400\n-400 -400 -50\n-400 400 -50\n400 -400 -70\n400 400 -70\n",
    "tables/curve.txt": "Rope\nStrain Tension\n(-) (N)\n0 0\n0.1 2e5\n0.2 6e5\n",
    "current_profile.txt": "Current\nz ux uy uz\n(m) (m/s) (m/s) (m/s)\n-70 0.1 0 0\n0 0.5 0 0\n",
}
PLACES = {"point4": (20.0, 0.0, -5.0), "point7": (-23.0, 0.0, -6.5), "rod1": (0.0, 10.0, -5.0), "body2": (-22.0, 0.0, -6.0)}  # where each wrench acts, in the platform's axes
TIMES = [0.05 * k for k in range(21)]


def surge(t):
    return 0.5 * (1.0 - np.cos(2.0 * t)), np.sin(2.0 * t)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """What a peer heard, stamp by stamp, and the recording; the scene's folder is gone."""
    folder = tmp_path_factory.mktemp("all")
    deck = folder / "deck"
    (deck / "tables").mkdir(parents=True)
    (deck / "scene.txt").write_text(SCENE)
    for name, text in TABLES.items():
        (deck / name).write_text(text)
    heard, shown = {name: [] for name in PLACES}, []
    with node_and_peer(folder, scene=str(deck / "scene.txt"), recording__enabled=True, recording__path=str(folder / "run.mcap"), visual_rate=20.0) as (process, peer):
        peer.wait_for_node(timeout=600.0)
        for name, messages in heard.items():
            peer.listen(WrenchStamped, f"mooring/fairleads/{name}/wrench", messages.append)
        peer.listen(MarkerArray, "mooring/markers", shown.append)
        peer.spin(0.5)
        winch = peer.node.create_publisher(JointState, "mooring/unstretched_lengths", 10)
        peer.wait(winch.get_subscription_count, what="the winch")
        wrenches = [peer.ask(t, *surge(t)) for t in TIMES[:-5]]
        winch.publish(JointState(name=["line5"], position=[119.5]))
        peer.spin(0.3)
        wrenches = np.array(wrenches + [peer.ask(t, *surge(t)) for t in TIMES[-5:]])
        peer.wait(lambda: all(len(messages) == len(TIMES) for messages in heard.values()), what="all wrenches")
        process.end()
        log = (folder / "node.log").read_text(encoding="utf-8")
    assert "Traceback" not in log, log
    shutil.rmtree(deck)
    return wrenches, {name: np.array([numbers(message) for message in messages]) for name, messages in heard.items()}, shown, folder / "run.mcap"


def test_points_rods_bodies_and_points_on_them_answer_and_add_up_to_the_total(recorded):
    wrenches, parts, _, _ = recorded
    total = np.zeros_like(wrenches)
    for name, place in PLACES.items():
        force, moment = parts[name][:, :3], parts[name][:, 3:]
        total += np.hstack([force, moment + np.cross(place, force)])
    np.testing.assert_allclose(total, wrenches, rtol=1e-9, atol=1e-6 * np.abs(wrenches).max())
    assert np.abs(parts["rod1"][:, 3:]).min(axis=0).max() > 100.0  # a clamped cable hands a moment on
    assert np.abs(parts["point4"][:, 3:]).max() < 1e-6  # a point does not


def test_a_failed_line_pulls_no_more(recorded):
    _, parts, _, _ = recorded
    pull = np.linalg.norm(parts["point4"][:, :3], axis=1)
    before, after = np.array(TIMES) < 0.6, np.array(TIMES) > 0.66
    assert pull[before].min() > 1e3 and pull[after].max() < 1.0


def test_a_line_that_is_wound_in_pulls_more(recorded):
    _, parts, _, _ = recorded
    pull = np.linalg.norm(parts["point7"][:, :3], axis=1)
    assert pull[-5:].min() > 1.05 * pull[:-5].max()


def test_markers_show_rods_bodies_and_the_mesh_of_the_bed(recorded):
    _, _, shown, _ = recorded
    kinds = [marker.ns for marker in shown[-1].markers]
    assert kinds.count("rods") == 2 and kinds.count("bodies") == 2 and kinds.count("lines") == 5


def test_the_recording_alone_replays_bit_for_bit(recorded, tmp_path):
    run = recorded[-1]
    words = [sys.executable, "-m", "mooring_ros.offline", "replay", str(run), str(run), "-o", str(tmp_path / "again.mcap"), "--json"]
    done = subprocess.run(words, cwd=Path(__file__).parents[2], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["identical"] == {"same": len(TIMES), "total": len(TIMES)} and found["scene_is_recorded"] is True
