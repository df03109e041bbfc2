"""Ropes held by both ends, driven by the same motion as in MoorDyn: its lines of one straight piece against our law."""

import numpy as np
import pytest

from mooring_ros.core.ropes import build_ropes, rope_tensions
from mooring_ros.scene.description import LineType

LENGTH, DT = 20.0, 0.002  # m, s
DECK = """\
a rope that weighs nothing in water
---- LINE TYPES ----
Name Diam Mass EA BA EI Cd Ca CdAx CaAx
(-) (m) (kg/m) (N) (N-s/-) (N-m2) (-) (-) (-) (-)
rope 0.2 32.2013 {stiffness} {damping} 0 0 0 0 0
---- POINTS ----
ID Type X Y Z M V CdA Ca
(#) (-) (m) (m) (m) (kg) (m3) (m2) (-)
1 Fixed 0 0 -50 0 0 0 0
2 Coupled 20 0 -50 0 0 0 0
---- LINES ----
ID Type A B Len N Out
(#) (-) (#) (#) (m) (-) (-)
1 rope 1 2 20 2 -
---- OPTIONS ----
0.0002 dtM
RK2 tScheme
100 WtrDpth
1 TmaxIC
0 writeLog
1 disableOutput
1 disableOutTime
---- END ----
"""
TABLE = ((0.0, 0.0), (0.002, 1e5), (0.004, 4e5), (0.01, 6e5))


def speed(t):
    """Out by 10 cm in half a second, half of it back after six seconds, m/s."""
    return 0.2 if t < 0.5 else -0.1 if 6.0 <= t < 6.5 else 0.0


def moordyn_tension(tmp_path, monkeypatch, stiffness, damping, until):
    moordyn = pytest.importorskip("moordyn")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "rope.txt").write_text(DECK.format(stiffness=stiffness, damping=damping))
    system = moordyn.Create("rope.txt")
    x, rows = LENGTH, []
    try:
        assert moordyn.Init(system, [x, 0.0, -50.0], [0.0] * 3) == 0
        line = moordyn.GetLine(system, 1)
        for k in range(round(until / DT)):
            v = speed(k * DT)
            moordyn.Step(system, [x, 0.0, -50.0], [v, 0.0, 0.0], k * DT, DT)
            x += v * DT
            rows.append(moordyn.GetLineFairTen(line))
    finally:
        moordyn.Close(system)
    return np.array(rows)


def our_tension(kind, until):
    ropes = build_ropes([(kind, 0, 1, LENGTH)])
    position, inverse = np.zeros((3, 2)), np.full(2, 1.0 / LENGTH)
    damping, rate, tension, creep, creep_rate = np.zeros((5, 2))
    damping[:] = kind.damping / LENGTH
    x, rows = LENGTH, []

    def evaluate(x, step):
        position[0, 1] = x
        rope_tensions(ropes, step, position, inverse, damping, rate, tension, creep, creep_rate)

    for k in range(round(until / DT)):
        rate[1] = speed(k * DT)
        start = creep[1]
        for stage in (0, 1):
            evaluate(x + stage * DT * rate[1], DT)
            creep[1] += DT * creep_rate[1]
        creep[1] = 0.5 * (start + creep[1])
        x += rate[1] * DT
        evaluate(x, 0.0)
        rows.append(tension[1])
    return np.array(rows)


def test_a_two_kelvin_rope_pulls_as_in_moordyn(tmp_path, monkeypatch):
    """Stretched, held and slackened by half: within 0.1 % of the largest tension (MoorDyn's is up to a step late), 0.01 % while held."""
    stiff, soft = 1.586e8, 1.424e8
    kind = LineType("rope", 0.2, 32.2013, stiff, 11e6, slow_stiffness=stiff * soft / (stiff - soft), slow_damping=4e9)
    theirs = moordyn_tension(tmp_path, monkeypatch, f"{soft}|{stiff}", "4e9|11e6", 8.0)
    ours = our_tension(kind, 8.0)
    jumps = np.zeros(ours.size, dtype=bool)  # of the speed
    jumps[[0, *(round(t / DT) + k for t in (0.5, 6.0, 6.5) for k in (-1, 0, 1))]] = True
    held = (np.arange(ours.size) * DT > 1.5) & (np.arange(ours.size) * DT < 5.9)
    assert np.abs(ours - theirs)[~jumps].max() < 1e-3 * ours.max()
    assert np.abs(ours - theirs)[held].max() < 1e-4 * ours.max()
    assert 0.9 * ours.max() > ours[held][-1] > 0.5 * ours.max()


def test_a_load_strain_curve_is_read_as_in_moordyn(tmp_path, monkeypatch):
    rows = "\n".join(f"{strain} {load}" for strain, load in TABLE)  # an empty last row is an error for MoorDyn
    (tmp_path / "curve.txt").write_text("rope\nStrain Tension\n(-) (N)\n" + rows)
    theirs = moordyn_tension(tmp_path, monkeypatch, "curve.txt", "1e6", 1.0)
    ours = our_tension(LineType("rope", 0.2, 32.2013, 1.5e8, 1e6, curve=TABLE), 1.0)
    held = np.arange(ours.size) * DT > 0.9
    assert np.abs(ours - theirs)[held].max() < 1e-5 * ours.max()
    np.testing.assert_allclose(ours[held], np.interp(0.005, *np.array(TABLE).T), rtol=1e-6)
    late = np.abs(ours - theirs)[5:245].max()
    assert late < 2.0 * 1.5e8 * 0.2 * DT / LENGTH
