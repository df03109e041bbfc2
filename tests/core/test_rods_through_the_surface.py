"""A rod that is lowered through the surface gains buoyancy evenly, without jumps as its nodes go under."""

import numpy as np
import pytest

from mooring_ros import Mooring
from mooring_ros.scene import parse_scene

SCENE = """\
--- LINE TYPES ---
Name  Diam  Mass/m  EA  BA/-zeta  EI  Cd  Ca  CdAx  CaAx
(-)  (m)  (kg/m)  (N)  (N-s/-)  (N-m2)  (-)  (-)  (-)  (-)
chain  0.05  50  2.0e7  -0.8  0  2.0  0.8  0.4  0.25
--- ROD TYPES ---
Name  Diam  Mass/m  Cd  Ca  CdEnd  CaEnd
(-)  (m)  (kg/m)  (-)  (-)  (-)  (-)
pile  1.0  900  0.6  1.0  1.0  0.5
--- RODS ---
ID  Type  Attachment  Xa  Ya  Za  Xb  Yb  Zb  NumSegs  Outputs
(-)  (-)  (-)  (m)  (m)  (m)  (m)  (m)  (m)  (-)  (-)
1  pile  Coupled  0  0  2  0  0  10  4  -
--- POINTS ---
ID  Type  X  Y  Z  Mass  Volume  CdA  Ca
(-)  (-)  (m)  (m)  (m)  (kg)  (m3)  (m2)  (-)
1  Fixed    100  0  -30  0  0  0  0
2  Coupled   20  0  -30  0  0  0  0
--- LINES ---
ID  LineType  AttachA  AttachB  UnstrLen  NumSegs  Outputs
(-)  (-)  (-)  (-)  (m)  (-)  (-)
1  chain  1  2  90  4  -
--- OPTIONS ---
60  WtrDpth
"""


def test_a_pile_takes_its_buoyancy_up_without_jumps():
    mooring = Mooring(parse_scene(SCENE))
    lowered = np.arange(0.0, 12.5, 0.05)
    lift = []
    for down in lowered:
        mooring.settle([0.0, 0.0, -down, 0.0, 0.0, 0.0, 1.0])
        lift.append(mooring.coupled_wrenches[mooring.coupled_names.index("rod1"), 2])
    wet_metre = 1025.0 * 9.80665 * np.pi / 4.0
    assert lift[0] == pytest.approx(-900.0 * 8.0 * 9.80665)
    assert lift[-1] - lift[0] == pytest.approx(8.0 * wet_metre)
    gained = np.diff(lift) / (0.05 * wet_metre)  # metres that go under for each metre of way
    assert -1e-9 < gained.min() and gained.max() < 1.5
