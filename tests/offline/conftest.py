"""A small moored scene, a motion for it, and `mooring` run inside this process."""

import json

import pytest

from mooring_ros.offline.__main__ import main

from motion_files import write_motion

SCENE = """\
Two chains, small and quick
--- LINE TYPES ---
Name  Diam  Mass/m  EA  BA/-zeta  EI  Cd  Ca  CdAx  CaAx
(-)  (m)  (kg/m)  (N)  (N-s/-)  (N-m2)  (-)  (-)  (-)  (-)
chain  0.05  50  2.0e7  -0.8  0  2.0  0.8  0.4  0.25
--- POINTS ---
ID  Type  X  Y  Z  Mass  Volume  CdA  Ca
(-)  (-)  (m)  (m)  (m)  (kg)  (m3)  (m2)  (-)
1  Fixed    300  0  -60  0  0  0  0
2  Fixed   -300  0  -60  0  0  0  0
3  Coupled   20  0   -5  0  0  0  0
4  Coupled  -20  0   -5  0  0  0  0
--- LINES ---
ID  LineType  AttachA  AttachB  UnstrLen  NumSegs  Outputs
(-)  (-)  (-)  (-)  (m)  (-)  (-)
1  chain  1  3  292  8  -
2  chain  2  4  292  8  -
--- OPTIONS ---
60  WtrDpth
1025  rho
9.80665  g
"""


@pytest.fixture
def scene(tmp_path):
    """Path of the scene."""
    path = tmp_path / "scene.txt"
    path.write_text(SCENE)
    return path


@pytest.fixture
def motion(tmp_path):
    """Path of a motion as CSV."""
    return write_motion(tmp_path / "motion.csv")


class Outcome:
    """status, out and err of a run; json() of out, refusing what is not strict JSON."""

    def __init__(self, status, out, err):
        self.status, self.out, self.err = status, out, err

    def json(self):
        def refuse(word):
            raise AssertionError(f"{word} is no JSON")

        return json.loads(self.out, parse_constant=refuse)


@pytest.fixture
def mooring(capsys):
    """`mooring(*words)` runs the command line in this process."""

    def run(*words):
        capsys.readouterr()
        status = main([str(word) for word in words])
        captured = capsys.readouterr()
        return Outcome(status, captured.out, captured.err)

    return run
