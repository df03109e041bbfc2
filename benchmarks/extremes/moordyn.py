"""The battery in MoorDyn (C++, the Python package ``moordyn``): what happens to the same scene and motion, in a process that may die of it.

Twice: as a file without options leaves it (``default``), and with a step of half the axial limit and a start that has swung out (``careful``). Its
coupled points follow the same cubic curves, in calls of 1 ms or one internal step. A case is right when it holds what the case claims within
`LENIENT` times what is allowed: the codes lump drag and contact a little differently.
"""

import dataclasses
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mooring_ros import Mooring
from mooring_ros.scene import COUPLED, SATURATED, Bathymetry

from ..moordyn_deck import RELAXATION, DeckError, deck, files
from .judge import NOT_A_NUMBER, RIGHT, WRONG, Track, Verdict, from_claims

LENIENT = 3.0
PATIENCE = 60  # s of CPU time
CALL = 0.001  # s: the velocity is held over a call, and the internal damping feels it
HANG, CRASH, STOPPED, APART = "hang", "crash", "stopped", "—"
SETTINGS = ("default", "careful")


def texts(scene, setting, dt, folder):
    """Deck and files beside it; raises DeckError for what MoorDyn, or our deck, does not know."""
    env, options, beside = scene.environment, [], {}
    if scene.failures or env.friction is not None and env.friction.law != SATURATED:
        raise DeckError("no counterpart")
    if any(env.current):
        speed = " ".join(map(str, env.current))
        beside["current_profile.txt"] = f"current\ncurrent\ncurrent\n{-env.depth} {speed}\n0.0 {speed}\n"
        options.append("1 Currents")
        env = dataclasses.replace(env, current=(0.0, 0.0, 0.0))
    if any(env.bed_slope):
        rise, ashore = env.bed_slope[0], (env.depth - 1.0) / env.bed_slope[0]
        sides = tuple(sorted((ashore, -2.0 * ashore)))  # along x, from where it is 1 m deep
        depth = tuple((env.depth - rise * x,) * 2 for x in sides)
        env = dataclasses.replace(env, bed_slope=(0.0, 0.0), bathymetry=Bathymetry(sides, (-500.0, 500.0), depth))
    if setting == "careful":
        options.append("1 ICgenDynamic")
    scene = dataclasses.replace(scene, environment=env)
    lines = deck(scene, dt, "RK2", options=options, folder=folder).splitlines()
    if setting == "default":
        left_out = ("dtM", "tScheme", *RELAXATION)
        lines = [line for line in lines if not line.split()[1:2] or line.split()[1] not in left_out]
    return {"lines.txt": "\n".join([*lines, ""]), **files(scene), **beside}


def internal_step(case, scene):
    """s: half of what the stiffest segment allows, or what the case asks for."""
    wanted = case.settings(scene) if callable(case.settings) else case.settings
    return wanted.get("dt") or 0.5 * Mooring(scene).step_limit.limits["axial"]


def tracks(scene, motion):
    """Curves of the coupled points' positions (k, 3 points), as MoorDyn takes them, from the samples."""
    times = np.append(0.0, motion.times)
    poses, twists = np.vstack([motion.start, motion.poses]), np.vstack([np.zeros(6), motion.twists])
    places, speeds = [], []
    for point in scene.points:
        if point.kind == COUPLED:
            v, q = np.array(point.position), poses[:, 3:6]
            turn = 2.0 * np.cross(q, v)
            arm = v + poses[:, 6:7] * turn + np.cross(q, turn)
            places.append(poses[:, :3] + arm)
            speeds.append(twists[:, :3] + np.cross(twists[:, 3:], arm))
    return CubicHermiteSpline(times, np.hstack(places), np.hstack(speeds))


def child(name, setting):
    """Run a case and print its fairlead tensions."""
    import moordyn

    resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE + 5))
    from .battery import cases

    case = next(c for c in cases() if c.name == name)
    scene, motion = case.scene(), case.motion()
    with tempfile.TemporaryDirectory(prefix="moordyn_") as folder:
        os.chdir(folder)
        dt = internal_step(case, scene)
        for file, text in texts(scene, setting, dt, folder).items():
            with open(file, "w", encoding="utf-8") as out:
                out.write(text)
        path = tracks(scene, motion)
        system = moordyn.Create("lines.txt")
        if system is None:
            raise SystemExit("refused the deck")
        moordyn.SetVerbosity(system, moordyn.LEVEL_NONE)
        if moordyn.Init(system, path(0.0).tolist(), [0.0] * path(0.0).size) != 0:
            raise SystemExit("found no initial state")
        lines, now, rows = [moordyn.GetLine(system, n.id) for n in scene.lines], 0.0, []
        for t in motion.times:
            calls = max(int(np.ceil((t - now) / max(CALL, dt if setting == "careful" else 0.0) - 1e-9)), 1)
            edges = np.linspace(now, t, calls + 1)
            places = path(edges)
            for k in range(calls):
                h = edges[k + 1] - edges[k]
                moordyn.Step(system, places[k].tolist(), ((places[k + 1] - places[k]) / h).tolist(), float(edges[k]), float(h))
            now = t
            rows.append([moordyn.GetLineFairTen(n) for n in lines])
    sys.stderr.write("\nRESULT " + json.dumps(rows) + "\n")


def verdict(case, setting):
    """Verdict on MoorDyn's run of a case; APART where it cannot be given the same."""
    if not case.peer or case.claims is None:
        return Verdict(APART, "")
    scene = case.scene()
    try:
        texts(scene, setting, 0.01, ".")
    except DeckError:
        return Verdict(APART, "")
    if scene.rods or scene.bodies:
        return Verdict(APART, "")
    command = [sys.executable, "-m", "benchmarks.extremes.moordyn", case.name, setting]
    done = subprocess.run(command, capture_output=True, text=True, errors="replace")
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return Verdict(HANG, f"no end within {PATIENCE} s of CPU time")
    answer = [line for line in done.stderr.splitlines() if line.startswith("RESULT ")]
    if not answer:
        said = " ".join(done.stdout.split()[-30:] + done.stderr.split()[-30:])
        if done.returncode < 0:
            return Verdict(CRASH, f"signal {-done.returncode}")
        return Verdict(NOT_A_NUMBER if "nan" in said.lower() else STOPPED, said[-160:])
    motion = case.motion()
    tension = np.array(json.loads(answer[-1][7:]), dtype=float)
    if not np.isfinite(tension).all():
        return Verdict(NOT_A_NUMBER, "")
    claims = (case.peer_claims or case.claims)(scene, motion, Track(motion.times, tension))
    found = from_claims([dataclasses.replace(one, allowed=LENIENT * one.allowed) for one in claims])
    return found if found.outcome in (RIGHT, WRONG) else Verdict(WRONG, found.words)


if __name__ == "__main__":
    child(*sys.argv[1:])
