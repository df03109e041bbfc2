"""A viscoelastic rope in two-Kelvin form, driven at one end: our tension beside MoorDyn's and the closed forms.

The rope is as heavy as water and straight, so that nothing but its own law pulls. Both codes read the same file.
"""

import os
import tempfile
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from mooring_ros.mooring import Mooring
from mooring_ros.scene import parse_scene

from . import figures, moordyn_peer, tables
from .motions import poses_and_twists, smooth_ramp

STATIC, DYNAMIC = 1.424e8, 1.586e8  # EA_S, EA_D, N
SLOW, FAST = 4e9, 11e6  # BA_S, BA_D, N s
SPRING = DYNAMIC * STATIC / (DYNAMIC - STATIC)  # of the slow element, N
START = 0.16  # m, of stretch
LENGTH = 40.0  # m: short enough that its inertia is not felt
SCENE = f"""\
A rope of {LENGTH} m that weighs nothing in water, held at both ends
--- LINE TYPES ---
Name  Diam  Mass/m   EA                 BA           EI  Cd  Ca  CdAx  CaAx
(-)   (m)   (kg/m)   (N)                (N-s)        (-) (-) (-) (-)   (-)
rope  0.2   32.2013  {STATIC}|{DYNAMIC} {SLOW}|{FAST} 0   0   0   0     0
--- POINTS ---
ID   Type      X      Y    Z      Mass   Volume  CdA   Ca
(-)  (-)       (m)    (m)  (m)    (kg)   (m3)    (m2)  (-)
1    Fixed     0      0    -50    0      0       0     0
2    Coupled   {LENGTH + START}  0    -50    0      0       0     0
--- LINES ---
ID   LineType   AttachA   AttachB   UnstrLen  NumSegs  Outputs
(-)  (-)        (-)       (-)       (m)       (-)      (-)
1    rope       1         2         {LENGTH}  2        -
--- OPTIONS ---
100.0    WtrDpth
1025.0   rho
9.80665  g
"""
PEER_OPTIONS = "0.0005 dtM\nRK2 tScheme\n5 TmaxIC\n0 writeLog\n1 disableOutput\n1 disableOutTime\n"
END = "--- END ---\n"
PULLS = ((16.0, 0.24), (46.0, -0.28))  # when (s) and by how much (m) the end is moved, in 2 s
MOVED, UNTIL, SAMPLE = 2.0, 75.0, 0.02  # s
FROM = 15.0  # s: before, MoorDyn's slow element comes to rest, which its initial state is not
PERIODS = (2.0, 5.0, 15.0, 60.0, 300.0)  # s
AMPLITUDE = 0.02  # m
GOAL, GOAL_MODULUS = 0.01, 0.01
EXACT = {"color": "#4a5a6a", "linewidth": 3.0, "alpha": 0.4}


def pulled(times):
    """Stretch of the rope (n,) in m and its rate."""
    stretch, rate = np.full(len(times), START), np.zeros(len(times))
    for begin, by in PULLS:
        factor, speed = smooth_ramp(times - begin, MOVED)
        stretch += by * factor
        rate += by * speed
    return stretch, rate


def modulus(omega):
    """Complex EA (N) of the series of two Kelvin elements."""
    slow, fast = SPRING + 1j * omega * SLOW, DYNAMIC + 1j * omega * FAST
    return slow * fast / (slow + fast)


def exact(times):
    """Tension (n,) of the rope without inertia: the differential equation of the two elements, to ten digits."""

    def rate(t, creep):
        stretch, speed = pulled(np.array([t]))
        return (FAST * speed / LENGTH + DYNAMIC * stretch / LENGTH - (SPRING + DYNAMIC) * creep) / (SLOW + FAST)

    rest = STATIC * START / LENGTH / SPRING
    creep = solve_ivp(rate, (0.0, times[-1]), [rest], t_eval=times, rtol=1e-10, atol=1e-14, max_step=0.1).y[0]
    return SPRING * creep + SLOW * np.array([rate(t, c)[0] for t, c in zip(times, creep)])


def ours(times, stretch, rate):
    """Our tension (n,) at the fairlead, N."""
    mooring = Mooring(parse_scene(SCENE + END, "rope.txt"))
    mooring.settle([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
    column = np.zeros(len(times))
    poses, twists = poses_and_twists(np.stack([stretch - START, column, column], axis=1), np.stack([rate, column, column], axis=1))
    return np.array(mooring.run(times[1:], poses[1:], twists[1:]).fairlead_tension)[:, 0]


def moordyns(times, stretch):
    """MoorDyn's tension (n,) after each interval between two times."""
    import moordyn

    here = os.getcwd()
    with tempfile.TemporaryDirectory() as folder, moordyn_peer._silence():
        (Path(folder) / "rope.txt").write_text(SCENE + PEER_OPTIONS + END)
        os.chdir(folder)
        try:
            system = moordyn.Create("rope.txt")
            moordyn.Init(system, [LENGTH + START, 0.0, -50.0], [0.0] * 3)
            line = moordyn.GetLine(system, 1)
            tension = []
            for k in range(len(times) - 1):
                call = times[k + 1] - times[k]
                speed = (stretch[k + 1] - stretch[k]) / call
                moordyn.Step(system, [LENGTH + stretch[k], 0.0, -50.0], [speed, 0.0, 0.0], times[k], call)
                tension.append(moordyn.GetLineFairTen(line))
            moordyn.Close(system)
        finally:
            os.chdir(here)
    return np.array(tension)


def our_modulus(period):
    """Complex EA (N) from the last of some periods of a sinusoidal stretch."""
    turns = max(2, int(np.ceil(20.0 / period))) + 1
    times = np.linspace(0.0, turns * period, 200 * turns + 1)
    omega = 2.0 * np.pi / period
    tension = ours(times, START + AMPLITUDE * np.sin(omega * times), AMPLITUDE * omega * np.cos(omega * times))
    last = slice(-200, None)
    wave = np.sin(omega * times[1:][last]) + 1j * np.cos(omega * times[1:][last])
    return 2.0 * np.mean(tension[last] * wave) / (AMPLITUDE / LENGTH)


def run(quick=False):
    """Tables, figure and missed goals."""
    times = np.arange(0.0, UNTIL + 0.5 * SAMPLE, SAMPLE)
    stretch, rate = pulled(times)
    truth = exact(times)[1:]
    our = ours(times, stretch, rate)
    peer = moordyns(times, stretch)
    counted = times[1:] > FROM
    errors = {name: np.abs(values - truth)[counted].max() / np.ptp(truth) for name, values in (("ours", our), ("MoorDyn", peer))}
    periods = PERIODS[:-1] if quick else PERIODS
    measured = [our_modulus(period) for period in periods]
    rows, failed = [], []
    for period, value in zip(periods, measured, strict=True):
        want = modulus(2.0 * np.pi / period)
        off = abs(value - want) / abs(want)
        rows.append([f"{period:g} s", f"{want.real / 1e6:.2f}", f"{value.real / 1e6:.2f}", f"{want.imag / 1e6:.3f}", f"{value.imag / 1e6:.3f}"])
        if off > GOAL_MODULUS:
            failed.append(f"ropes: modulus at {period:g} s off by {off:.2%}")
    if errors["ours"] > GOAL:
        failed.append(f"ropes: tension off by {errors['ours']:.2%} of its range")
    moduli = tables.table(["period", "storage, exact (MN)", "ours", "loss, exact (MN)", "ours"], rows)
    sentence = f"Largest difference from the closed form, of the tension's range: ours {errors['ours']:.3%}, MoorDyn {errors['MoorDyn']:.3%}."
    print(moduli, sentence, sep="\n", flush=True)
    return {
        "tables": {"ropes_viscoelastic": f"{moduli}\n\n{sentence}"},
        "figures": {"ropes.png": picture(times[1:], truth, our, peer, periods, measured)},
        "errors": errors,
        "failed": failed,
    }


def picture(times, truth, our, peer, periods, measured):
    """Tension in time, and the moduli over the period."""
    figure, grid = figures.axes(1, 3)
    left, *right = grid[0]
    left.plot(times, truth / 1e3, label="closed form", **EXACT)
    left.plot(times, our / 1e3, label="ours", **figures.STYLES["ours"])
    left.plot(times, peer / 1e3, label="MoorDyn", **figures.STYLES["MoorDyn"])
    left.set_xlabel("time (s)")
    left.set_ylabel("tension (kN)")
    smooth = np.geomspace(0.5 * min(periods), 2.0 * max(periods), 200)
    want = modulus(2.0 * np.pi / smooth)
    for axis, name, of in zip(right, ("storage", "loss"), (np.real, np.imag), strict=True):
        axis.semilogx(smooth, of(want) / 1e6, **EXACT)
        axis.semilogx(periods, of(measured) / 1e6, "o", color=figures.STYLES["ours"]["color"])
        axis.set_xlabel("period (s)")
        axis.set_ylabel(f"{name} modulus (MN)")
    figures.legend(figure, left)
    return figure
