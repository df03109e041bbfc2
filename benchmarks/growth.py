"""Cost per node from 60 to 150 000 nodes, and a thousand platforms in real time."""

import resource
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numba
import numpy as np

from mooring_ros import Fleet, Mooring, blocks
from mooring_ros.scene import load_scene

from . import figures, tables
from .motions import poses_and_twists

SCENE = Path(__file__).parent.parent / "config" / "scenes" / "oc4.txt"
SEGMENTS = 19  # of a line: 20 nodes
LINES = (3, 6, 15, 50, 150, 500, 1500, 7500)
FLAT = 2.0  # goal: largest cost of a node over the smallest
SAMPLE = 0.1  # s, of the farms
PLATFORMS, FLEET_SEGMENTS, RATE = 1000, 50, 50.0  # Hz
REPEATS = 3
HERE = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


def farm(base, lines):
    """A scene of `lines` lines like those of `base` in turn, each with an anchor and a fairlead of its own."""
    by_id = {point.id: point for point in base.points}
    points, rows = [], []
    for k in range(lines):
        line = base.lines[k % len(base.lines)]
        points += [replace(by_id[line.end_a], id=2 * k + 1), replace(by_id[line.end_b], id=2 * k + 2)]
        rows.append(replace(line, id=k + 1, end_a=2 * k + 1, end_b=2 * k + 2, segments=SEGMENTS))
    return replace(base, points=tuple(points), lines=tuple(rows))


def surge(times, shift=0.0):
    """Positions and velocities (n, 3) of a surge that starts from rest: 0.5 m to and fro in 16 s."""
    position, velocity = np.zeros((len(times), 3)), np.zeros((len(times), 3))
    position[:, 0], velocity[:, 0] = 0.5 * (1.0 - np.cos(0.4 * times)) * (1.0 + shift), 0.2 * np.sin(0.4 * times) * (1.0 + shift)
    return position, velocity


def cost_of_nodes(scene, in_one_piece, work):
    """A row: nodes, blocks, s of CPU time for a node and evaluation in runs and in single steps, s to build and to settle."""
    usual = blocks.LARGE
    blocks.LARGE = np.inf if in_one_piece else usual
    try:
        began = time.process_time()
        mooring = Mooring(scene)
        built = time.process_time() - began
    finally:
        blocks.LARGE = usual
    began = time.process_time()
    mooring.settle(HERE)
    settled = time.process_time() - began
    nodes = sum(mooring.segments) + len(mooring.segments)
    pieces = len(blocks._blocks(scene, mooring.segments)) if not in_one_piece and nodes >= blocks.LARGE else 1
    samples = max(10, round(work / nodes))
    best = {"run": np.inf, "step": np.inf}
    for _ in range(REPEATS + 1):  # the first one warms up
        for how in best:
            times = mooring.time + SAMPLE * np.arange(1, samples + 1)
            poses, twists = poses_and_twists(*surge(times))
            began = time.process_time()
            if how == "run":
                mooring.run(times, poses, twists)
            else:
                for t, pose, twist in zip(times, poses, twists):
                    mooring.step(t, pose, twist)
            taken = time.process_time() - began
            evaluations = mooring.last_step["evaluations"] / pieces * samples
            best[how] = min(best[how], taken / (nodes * evaluations))
    return {"nodes": nodes, "blocks": pieces, **best, "build": built, "settle": settled}


def fleet_cost(scene, threads, platforms, seconds):
    """CPU time and wall time (s) for one simulated second of a fleet, stepped at RATE and run; s to build and settle; bytes for each mooring."""
    Fleet([scene], segments=FLEET_SEGMENTS).settle(HERE)  # compiled from here on
    memory, began = _memory(), time.perf_counter()
    fleet = Fleet([scene] * platforms, threads=threads, segments=FLEET_SEGMENTS)
    built = time.perf_counter()
    fleet.settle(HERE)
    found = {"threads": fleet.threads, "build": built - began, "settle": time.perf_counter() - built}
    count = round(RATE * seconds)
    for how in ("step", "run", "step", "run"):  # the second time counts
        times = fleet[0].time + np.arange(1, count + 1) / RATE
        ways = [poses_and_twists(*surge(times, 0.3 * np.sin(m))) for m in range(platforms)]
        poses, twists = (np.stack([way[k] for way in ways], axis=1) for k in (0, 1))
        cpu, wall = time.process_time(), time.perf_counter()
        if how == "run":
            fleet.run(times, poses, twists)
        else:
            for t, pose, twist in zip(times, poses, twists):
                fleet.step(t, pose, twist)
        found[how] = (time.process_time() - cpu) / seconds, (time.perf_counter() - wall) / seconds
    return {**found, "bytes": (_memory() - memory) / platforms}


@numba.njit(nogil=True)
def _count(n):
    total = 0.0
    for i in range(n):
        total += np.sqrt(1.0 * i)
    return total


def speed_up(scene, platforms, rounds):
    """{what: wall time on one thread over that on all}, medians of alternating rounds; of a fleet, and of loops that only count: what the machine gives."""
    fleets = [Fleet([scene] * platforms, threads=threads, segments=FLEET_SEGMENTS) for threads in (1, None)]
    for fleet in fleets:
        fleet.settle(HERE)
    found = {"fleet.run": [], "fleet.step": [], "loops that only count": []}
    with ThreadPoolExecutor(fleets[1].threads) as pool:
        for _ in range(rounds):
            for what, ratios in found.items():
                walls = []
                for fleet in fleets:
                    times = fleet[0].time + np.arange(1, 51) / RATE
                    poses, twists = (np.repeat(way[:, None], platforms, axis=1) for way in poses_and_twists(*surge(times)))
                    began = time.perf_counter()
                    if what == "fleet.run":
                        fleet.run(times, poses, twists)
                    elif what == "fleet.step":
                        for t, pose, twist in zip(times, poses, twists):
                            fleet.step(t, pose, twist)
                    else:
                        list((map if fleet.threads == 1 else pool.map)(_count, [20_000_000] * (2 * fleets[1].threads)))
                    walls.append(time.perf_counter() - began)
                ratios.append(walls[0] / walls[1])
    return {"threads": fleets[1].threads, **{what: float(np.median(ratios)) for what, ratios in found.items()}}


def _memory():
    """What this process has in memory, bytes."""
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1]) * resource.getpagesize()


def run(quick=False):
    """All sizes; prints the tables."""
    base = load_scene(SCENE)
    fleets = [fleet_cost(base, threads, 100 if quick else PLATFORMS, 1.0 if quick else 2.0) for threads in (1, None)]
    fleets[1].pop("bytes")  # it had the memory of the first one
    rows = []
    for lines in LINES[:6] if quick else LINES:
        scene = farm(base, lines)
        row = cost_of_nodes(scene, False, 2e4 if quick else 1e5)
        row["whole"] = cost_of_nodes(scene, True, 2e4 if quick else 1e5) if row["blocks"] > 1 else dict(row)
        rows.append(row)
        print(f"{row['nodes']} nodes: {1e9 * row['run']:.1f} ns, in one piece {1e9 * row['whole']['run']:.1f} ns", flush=True)
    body = [
        [r["nodes"], r["blocks"], *(f"{1e9 * value:.1f}" for value in (r["run"], r["whole"]["run"], r["step"], r["whole"]["step"])), f"{r['build']:.2g}", f"{r['settle']:.2g}"]
        for r in rows
    ]
    head = ["nodes", "blocks", "run: ns for a node and evaluation", "in one piece", "step by step", "in one piece", "built in, s", "settled in, s"]
    fleet_body = [
        [f["threads"], *(f"{f[how][k]:.2f}" for how in ("run", "step") for k in (0, 1)), f"{f['build']:.2f}", f"{f['settle']:.2f}", f"{f['bytes'] / 1024:.0f}" if "bytes" in f else ""]
        for f in fleets
    ]
    fleet_head = ["threads", "run: CPU s for 1 s", "wall s", "steps: CPU s for 1 s", "wall s", "built in, s", "settled in, s", "kB a mooring"]
    faster = speed_up(base, 100 if quick else PLATFORMS, 3 if quick else 5)
    faster_body = [[what, f"{ratio:.2f}"] for what, ratio in faster.items() if what != "threads"]
    content = {
        "growth": tables.table(head, body),
        "fleet": tables.table(fleet_head, fleet_body),
        "fleet_threads": tables.table(["", f"{faster['threads']} threads: times faster than one"], faster_body),
    }
    print(*content.values(), sep="\n\n", flush=True)
    costs = [row["run"] for row in rows]
    failed = []
    if max(costs) > FLAT * min(costs):
        failed.append(f"a node costs {1e9 * min(costs):.1f} to {1e9 * max(costs):.1f} ns, goal: within a factor {FLAT:g}")
    if not quick and fleets[0]["step"][0] > 1.0:
        failed.append(f"{PLATFORMS} platforms stepped on one core take {fleets[0]['step'][0]:.2f} s for a second, goal 1")
    return {"rows": rows, "fleets": fleets, "speed_up": faster, "tables": content, "failed": failed, "figures": {"growth.png": picture(rows)}}


def picture(rows):
    """Cost of a node over the number of nodes, in blocks and in one piece."""
    figure, grid = figures.axes(height=3.4)
    axis, nodes = grid[0, 0], [row["nodes"] for row in rows]
    axis.plot(nodes, [1e9 * row["run"] for row in rows], "o-", color=figures.COLOURS[0], label="in blocks that fit the cache")
    axis.plot(nodes, [1e9 * row["whole"]["run"] for row in rows], "s--", color=figures.COLOURS[1], label="in one piece")
    axis.set(xscale="log", xlabel="nodes", ylabel="ns for a node and evaluation", ylim=(0.0, None))
    figures.legend(figure, axis)
    return figure
