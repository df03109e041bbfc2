"""The trade of speed for accuracy on twelve moorings: ours, measured as `mooring trade` does, and MoorDyn's and CableDyn's best beside it.

Cost is CPU time for a simulated second. The error is that of the force on the platform at the fairleads, against the same code's run that is converged in space
and time: the worst of mean, dynamic and peak of the worst line, as `mooring trade` counts it. The peers' runs are kept outside the repository, and so are ours
until a source of the core changes.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.ticker import NullFormatter
from scipy.interpolate import CubicSpline

from mooring_ros.mooring import Mooring
from mooring_ros.offline.motion_file import Motion
from mooring_ros.offline.trade_cache import Cache
from mooring_ros.offline.trade_errors import errors_between
from mooring_ros.offline.trade_measure import measure as measured
from mooring_ros.offline.trade_setting import Setting
from mooring_ros.offline.trade_window import whole

from . import figures, peer_runs, peer_search, tables
from .motions import poses_and_twists
from .peer_cases import BY_NAME, TRADED, fairleads

MESHES = (1.0, 0.5, 0.7, 1.4, 2.0)  # ours, of the file's segments
IMPLICIT = (50, 100, 200)  # steps in a period
FINE = 4.0  # segments of our converged run
LONGEST = 10.0  # s of CPU time for one run of ours
SAMPLES = 120  # in a period, at most 20 Hz
DEAR = (  # whose fine runs cost the peers minutes each
    "laboratory chain, 33 m", "VolturnUS-S semi-taut", "VolturnUS-S semi-taut, up a slope", "VolturnUS-S semi-taut, rough bed", "RM3 cable", "lazy wave",
    "ISWEC, bridles and clump weights", "farm of 100 lines",
)  # fmt: skip
LEVELS = (0.01, 0.02, 0.05, 0.1)  # errors at which the codes are compared: the first that all reach
TIMINGS = 2  # more of a peer's setting that may be compared, now; the least of all counts, as it does in ours
METHODS = {  # of ours: marker and colour index
    "dynamic, explicit": ("o", 0), "dynamic, implicit": ("s", 3), "quasi_static": ("^", 5), "linear": ("v", 7),
}  # fmt: skip


@dataclass(frozen=True)
class Point:
    """A setting in the plane of cost and error."""

    code: str  # "MoorDyn", "CableDyn", or a method of ours
    label: str
    error: float
    cost: float  # s/s
    worst_step: float = math.nan  # s


def ours(case):
    """(points of all settings that could be run, error of the converged run that they are held against)."""
    scene, motion = case.still(), sampled(case)
    cache, everything = Cache(scene, motion), whole(motion)
    window = replace(everything, compared=int(np.searchsorted(motion.times, case.platform().start)) - 1)
    ends = [k for k, _ in fairleads(scene)]

    def run(setting, limit, timed=True):
        name = cache.name(setting, window, timed)
        found = cache.recall(name)
        if found is None:
            found = measured(scene, setting, window, limit, timed)
            cache.keep(name, found)
        return found

    def force(found):
        return found.force[window.compared :, ends]

    fine, half = (run(Setting("dynamic", "explicit", refine=refine), math.inf, False) for refine in (FINE, FINE / 2.0))
    points = []
    for setting in settings(case):
        found = run(setting, LONGEST)
        if found.refused:
            print(f"{case.name}, {setting.method}, {setting.mesh} segments, step {setting.step}: {found.refused}", flush=True)
        else:
            label = f"{setting.method}, {setting.mesh} segments, step {setting.step}"
            points.append(Point(setting.method, label, errors_between(force(found), force(fine)).worst / 100.0, found.cost, found.worst_step))
    return points, errors_between(force(half), force(fine)).worst / 300.0


def settings(case):
    """Ours that are tried: all fidelities on the file's mesh, explicit dynamics on meshes with the default step and half of it, implicit ones with steps in a period."""
    yield Setting("linear")
    yield Setting("quasi_static")
    for refine in MESHES:
        yield Setting("dynamic", "explicit", refine=refine)
    yield Setting("dynamic", "explicit", 0.5 * float(Mooring(case.still(), solver="explicit").step_limit.dt))
    for refine in MESHES[:2]:
        for steps in IMPLICIT:
            yield Setting("dynamic", "implicit", peer_search.rounded(peer_search.period(case) / steps), refine=refine)


def sampled(case):
    """The motion as a recording: samples of pose and twist."""
    platform = case.platform()
    rate = max(20.0, SAMPLES / peer_search.period(case))
    times = np.arange(int(np.ceil(platform.end * rate)) + 1) / rate
    poses, twists = poses_and_twists(*platform.displacement(times))
    return Motion(path=case.name, times=times, poses=poses, twists=twists, stamps=np.round(times * 1e9).astype(np.int64), source="made here")


def measure(outcome, reference, motion):
    """The trade's error of a peer's run, as a fraction; inf where it failed."""
    if outcome.failure:
        return math.inf
    end = min(outcome.times[-1], reference.times[-1])
    times = reference.times[(reference.times >= motion.start) & (reference.times <= end)]
    run, known = (CubicSpline(x.times, x.force)(times) for x in (outcome, reference))
    error = errors_between(run, known).worst / 100.0
    return error if np.isfinite(error) else math.inf


def of_moordyn(case):
    """MoorDyn's points, and why there are none. On dear moorings its converged run has twice the segments, else four times, and half of those are the finest mesh."""
    finest = 1.0 if case.name in DEAR else 2.0
    reference = peer_search.moordyn_reference(case, 2.0 * finest, 2)
    if reference.failure:
        return [], reference.failure

    def again(s):
        return peer_runs.of_moordyn(case, s.name.split(",")[0], s.dt, s.refinement, fresh=True).cost

    return _points("MoorDyn", peer_search.moordyn_grid(case, reference, measure, finest), again), ""


def of_cabledyn(case):
    """CableDyn's points, and why there are none; the same of its meshes and its converged run, but for steps twice as long on dear moorings."""
    dear = case.name in DEAR
    reference = peer_search.cabledyn_reference(case, 2 if dear else 4, 400 if dear else 800)
    if reference.failure:
        return [], reference.failure
    meshes = [m for m in peer_search.MESHES if m <= 1.0 or not dear]

    def again(s):
        return peer_runs.of_cabledyn(case, s.dt, s.refinement, fresh=True).cost

    return _points("CableDyn", peer_search.cabledyn_settings(case, reference, measure, meshes), again), ""


def _points(code, settings, again):
    """Points of a peer's settings; `again` runs one anew and gives its cost."""
    compared = {peer_search.best(settings, level) for level in LEVELS}
    costs = {s: min(s.cost, *(again(s) for _ in range(TIMINGS))) if s in compared else s.cost for s in settings}
    return [Point(code, s.label(), s.error, costs[s]) for s in settings if np.isfinite(s.error)]


def run(quick=False):
    """All twelve (quick: two); prints the tables."""
    found = {}
    for name in TRADED[:2] if quick else TRADED:
        case = BY_NAME[name]
        mine, known = ours(case)
        (moordyn, no_moordyn), (cabledyn, no_cabledyn) = of_moordyn(case), of_cabledyn(case)
        found[name] = {"points": [*mine, *moordyn, *cabledyn], "known": known, "why": {"MoorDyn": no_moordyn, "CableDyn": no_cabledyn}}
        points = found[name]["points"]
        print(name, {code: _words(cheapest(points, code, level(points))) for code in ("ours", "MoorDyn", "CableDyn")}, flush=True)
    content = {"trades_best": best_table(found), "trades_front": front_table(found)}
    print("\n" + "\n\n".join(content.values()), flush=True)
    cases = {name: {**f, "points": [p.__dict__ for p in f["points"]]} for name, f in found.items()}
    return {"cases": cases, "tables": content, "failed": [], "figures": {"trades.png": figure(found)}}


def of_code(points, code):
    """The points of a code; "ours": of all its methods."""
    return [p for p in points if (p.code == code or (code == "ours" and p.code not in ("MoorDyn", "CableDyn")))]


def level(points):
    """The least of `LEVELS` within which all codes that carry the mooring have a setting; the largest where there is none."""
    codes = [code for code in ("ours", "MoorDyn", "CableDyn") if of_code(points, code)]
    return next((error for error in LEVELS if all(cheapest(points, code, error) for code in codes)), LEVELS[-1])


def cheapest(points, code, error):
    """The cheapest of a code within an error; None where there is none."""
    within = [p for p in of_code(points, code) if p.error <= error]
    return min(within, key=lambda p: p.cost) if within else None


def _words(point):
    return "none" if point is None else f"{point.label}: {100 * point.error:.2g} %, {1e3 * point.cost:.3g} ms/s"


def best_table(found):
    """Each code's cheapest setting within the error that all reach."""
    header = ["mooring", "within", "ours", "error", "CPU ms per simulated s", "worst step, ms", "MoorDyn", "CPU ms per simulated s", "CableDyn", "CPU ms per simulated s"]
    rows = []
    for name, f in found.items():
        error = level(f["points"])
        mine = cheapest(f["points"], "ours", error)
        row = [name, f"{100 * error:g} %"]
        row += [mine.label, f"{100 * mine.error:.2g} %", f"{1e3 * mine.cost:.3g}", f"{1e3 * mine.worst_step:.3g}"] if mine else ["none", "", "", ""]
        for code in ("MoorDyn", "CableDyn"):
            theirs = cheapest(f["points"], code, error)
            row += [theirs.label, f"{1e3 * theirs.cost:.3g}"] if theirs else ["none" if of_code(f["points"], code) else "cannot", ""]
        rows.append(row)
    return tables.table(header, rows)


def front_table(found):
    """Our front: what no other setting is both cheaper and more accurate than."""
    rows = []
    for name, f in found.items():
        for p in peer_search.front(of_code(f["points"], "ours")):
            rows.append([name, p.label, f"{100 * p.error:.2g} %", f"{1e3 * p.cost:.3g}", f"{1.0 / p.cost:.3g}", f"{1e3 * p.worst_step:.3g}"])
    return tables.table(["mooring", "setting", "error", "CPU ms per simulated s", "times real time", "worst step, ms"], rows)


def figure(found):
    """Cost and error of all settings, a panel for each mooring."""
    picture, grid = figures.axes(-(-len(found) // 3), 3, height=3.0 * -(-len(found) // 3))
    for axis, (name, f) in zip(grid.flat, found.items(), strict=False):
        for method, (marker, colour) in METHODS.items():
            _scatter(axis, [p for p in f["points"] if p.code == method], marker, figures.COLOURS[colour], f"ours: {method}")
        front = peer_search.front(of_code(f["points"], "ours"))
        axis.plot([1e3 * p.cost for p in front], [100 * p.error for p in front], color=figures.COLOURS[0], linewidth=1.0, label="ours: front")
        for code, marker in (("MoorDyn", "x"), ("CableDyn", "+")):
            colour = figures.STYLES[code]["color"]
            _scatter(axis, of_code(f["points"], code), marker, colour, code)
            front = peer_search.front(of_code(f["points"], code))
            axis.plot([1e3 * p.cost for p in front], [100 * p.error for p in front], color=colour, linewidth=1.0, linestyle="--")
        axis.set(xscale="log", yscale="log", xlabel="CPU ms per simulated s", ylabel="error (%)")
        axis.xaxis.set_minor_formatter(NullFormatter())  # where a panel holds less than a decade, they run into one another
        axis.yaxis.set_minor_formatter(NullFormatter())
        axis.set_title(name, loc="left", fontsize=9)
        axis.set_ylim(top=min(100.0, axis.get_ylim()[1]))
    for axis in grid.flat[len(found) :]:
        axis.set_visible(False)
    handles = {label: handle for axis in grid.flat for handle, label in zip(*axis.get_legend_handles_labels(), strict=True)}
    picture.legend(handles.values(), handles.keys(), loc="outside upper center", ncols=4, frameon=False, fontsize=9)
    return picture


def _scatter(axis, points, marker, colour, label):
    if points:
        axis.scatter([1e3 * p.cost for p in points], [100 * p.error for p in points], s=14, marker=marker, color=colour, label=label, linewidths=0.9, alpha=0.8)
