"""Lines that part while the mooring runs."""

import numpy as np
import pytest

from mooring_ros import Mooring
from mooring_ros.scene import parse_scene

REST = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
SCENE = """\
Two lines that meet at a fairlead
--- LINE TYPES ---
Name  Diam  Mass/m  EA    BA/-zeta  EI  Cd   Ca   CdAx  CaAx
(-)   (m)   (kg/m)  (N)   (N-s/-)   (-) (-)  (-)  (-)   (-)
wire  0.05  12.0    2e7   -1.0      0   1.2  1.0  0.1   0.0
--- POINTS ---
ID   Type      X     Y    Z     Mass   Volume  CdA   Ca
(-)  (-)       (m)   (m)  (m)   (kg)   (m3)    (m2)  (-)
1    Fixed    -60    0   -60    0      0       0     0
2    Fixed     60    0   -60    0      0       0     0
3    Coupled   0     0   -5     0      0       0     0
--- LINES ---
ID   LineType   AttachA   AttachB   UnstrLen  NumSegs  Outputs
(-)  (-)        (-)       (-)       (m)       (-)      (-)
1    wire       1         3         83.0      12       -
2    wire       2         3         83.0      12       -
--- FAILURE ---
ID   Point   Lines   FailTime  FailTen
(-)  (-)     (,)     (s)       (N)
1    3       1,2     {time}    {tension}
--- OPTIONS ---
60.0    WtrDpth
--- END ---
"""


def running(time, tension):
    mooring = Mooring(parse_scene(SCENE.format(time=time, tension=tension), "failure.txt"))
    mooring.settle(REST)
    return mooring


def test_lines_part_together_at_their_time():
    """Held to the last sample before, the platform free from then on, both ends in one place and falling."""
    mooring = running(2.0, 0)
    before = mooring.wrench.copy()
    mooring.run([1.0, 1.99], np.tile(REST, (2, 1)), np.zeros((2, 6)))
    np.testing.assert_allclose(mooring.wrench, before, atol=1e-6 * np.abs(before).max())
    times = np.arange(2.1, 12.0, 0.1)
    history = mooring.run(times, np.tile(REST, (times.size, 1)), np.zeros((times.size, 6)))
    assert np.abs(history.wrench[1:]).max() == 0.0
    ends = [mooring.node_positions(name)[-1] for name in mooring.line_names]
    np.testing.assert_array_equal(*ends)
    assert ends[0][2] < -30.0


@pytest.mark.parametrize(("limit", "parts"), [(6e4, True), (6e7, False)])
def test_lines_part_at_their_tension(limit, parts):
    """The platform goes sideways until a line is taut: of the pair at the fairlead one pulls past the limit and both let go."""
    mooring = running(0, limit)
    times = np.arange(0.1, 12.05, 0.1)
    poses, twists = np.tile(REST, (times.size, 1)), np.zeros((times.size, 6))
    poses[:, 0], twists[:, 0] = 0.3 * times, 0.3
    history = mooring.run(times, poses, twists)
    assert (np.abs(history.wrench[-1]).max() == 0.0) == parts
    if parts:
        pulled = history.fairlead_tension.max(axis=1)
        assert 0.7 * limit < pulled.max() < 1.3 * limit


def test_a_failure_comes_back_with_a_snapshot():
    """Restored from before, the lines part again, to the same bits."""
    mooring = running(1.0, 0)
    saved = mooring.snapshot()
    runs = []
    for _ in range(2):
        mooring.restore(saved)
        mooring.step(3.0, REST, np.zeros(6))
        runs.append(mooring.node_positions("line1").copy())
        assert np.abs(mooring.wrench).max() == 0.0
    np.testing.assert_array_equal(*runs)
