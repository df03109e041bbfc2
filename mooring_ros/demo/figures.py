"""Figures of the demo's report that no other report needs."""

import numpy as np
from matplotlib.figure import Figure

from mooring_ros.offline.plots import COLOURS, force_unit, style_axis

_FAINT, _WATER, _BED = "#51606f", "#7fb3d5", "#a58e6b"
_WIDTH = 9.6  # inches
_MOMENT_STYLES = (
    {"color": _FAINT, "linestyle": "--", "linewidth": 1.3},
    {"color": COLOURS[1], "linewidth": 1.4},
    {"color": COLOURS[2], "linewidth": 1.4},
    {"color": COLOURS[3], "linewidth": 1.4},
)


def elevation_figure(times, elevation):
    """Surface elevation (n,) m at the platform's reference point over times (n,) s."""
    figure, axis = _axes(2.0)
    axis.axhline(0.0, color=_FAINT, linewidth=0.6)
    axis.fill_between(times, elevation, color=_WATER, alpha=0.35, linewidth=0)
    axis.plot(times, elevation, color=COLOURS[0], linewidth=1.3)
    axis.set(xlabel="time (s)", ylabel="elevation (m)", xlim=(times[0], times[-1]))
    return figure


def wrench_figure(times, wrenches):
    """The wrench (n, 6) N, N·m of the moorings on the platform over times (n,) s: forces on the left, moments on the right."""
    figure = Figure(figsize=(_WIDTH, 4.2), layout="constrained")
    axes = figure.subplots(3, 2, sharex=True)
    for column, (letter, unit) in enumerate((("F", "N"), ("M", "N m"))):
        for row, direction in enumerate("xyz"):
            values = wrenches[:, 3 * column + row]
            divisor, prefix = force_unit(values)
            axis = axes[row, column]
            axis.plot(times, values / divisor, color=COLOURS[column], linewidth=1.2)
            axis.set_ylabel(f"${letter}_{direction}$ ({prefix[:-1]}{unit})")
            axis.set_xlim(times[0], times[-1])
            style_axis(axis)
            if np.ptp(values) < 1e-6 * np.abs(wrenches[:, 3 * column : 3 * column + 3]).max():
                axis.set_ylim(values.mean() / divisor - 1.0, values.mean() / divisor + 1.0)
    for axis in axes[-1]:
        axis.set_xlabel("time (s)")
    figure.align_ylabels()
    return figure


def extremes_figure(names, moments, depth):
    """Each line at several moments: in its own vertical plane, and its tension from the anchor to the fairlead.

    names: line names; moments: dict of label -> dict of line name -> (positions (n, 3) m, tension (n,) N), the first one the reference
    whose anchor and fairlead span the plane; depth: m.
    """
    figure = Figure(figsize=(_WIDTH, 1.9 * len(names) + 0.6), layout="constrained")
    axes = figure.subplots(len(names), 2, squeeze=False, sharex="col", width_ratios=(1.7, 1))
    reference = next(iter(moments.values()))
    divisor, unit = force_unit(np.concatenate([tension for shapes in moments.values() for _, tension in shapes.values()]))
    for (side, along), name in zip(axes, names):
        start = reference[name][0]
        fairlead = start[0] if start[0, 2] > start[-1, 2] else start[-1]
        heading = _heading(start) * (1.0 if fairlead is start[0] else -1.0)
        for (label, shapes), style in zip(moments.items(), _MOMENT_STYLES):
            nodes, tension = shapes[name]
            distance = (nodes[:, :2] - fairlead[:2]) @ heading
            side.plot(distance, nodes[:, 2], label=label, **style)
            highest = np.argmax(nodes[:, 2])
            side.plot(distance[highest], nodes[highest, 2], "o", color=style["color"], markersize=4)
            order = slice(None) if nodes[0, 2] < nodes[-1, 2] else slice(None, None, -1)
            arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(nodes[order], axis=0), axis=1))])
            along.plot(arc, tension[order] / divisor, **style)
        side.axhspan(-1.12 * depth, -depth, color=_BED, alpha=0.35, linewidth=0)
        side.axhline(0.0, color=_WATER, linewidth=1.2)
        side.set(ylabel="z (m)", ylim=(-1.12 * depth, 0.1 * depth))
        along.set(ylabel=f"tension ({unit})")
        along.margins(x=0.0)
        style_axis(side, name)
        style_axis(along)
    reach = max(np.ptp(nodes[:, :2] @ _heading(nodes)) for nodes, _ in reference.values())
    suspended = max(_suspended(nodes, depth) for shapes in moments.values() for nodes, _ in shapes.values())
    axes[-1, 0].set(xlabel="distance from the fairlead at the start (m)", xlim=(-0.05 * reach, min(reach, 1.3 * suspended)))
    axes[-1, 1].set(xlabel="along the line, from the anchor (m)")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper right", ncols=len(labels), frameon=False, fontsize=8)
    return figure


def round_trip_figure(times, round_trips):
    """Round trips (n,) ms of each sample: over simulated times (n,) s, and how often each occurs."""
    figure = Figure(figsize=(_WIDTH, 2.5), layout="constrained")
    over_time, often = figure.subplots(1, 2, width_ratios=(2, 1))
    over_time.semilogy(times, round_trips, ".", color=COLOURS[0], markersize=1.8)
    over_time.set(xlabel="simulated time (s)", ylabel="round trip (ms)", xlim=(times[0], times[-1]))
    edges = np.geomspace(min(round_trips), max(round_trips) * 1.001, 50)
    often.hist(round_trips, edges, color=COLOURS[0], alpha=0.75)
    often.set_xscale("log")
    often.set(xlabel="round trip (ms)", ylabel="samples")
    for axis in (over_time, often):
        style_axis(axis)
    ticks = [value for value in (0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000) if edges[0] <= value <= edges[-1]]
    for axis in (over_time.yaxis, often.xaxis):
        axis.set_ticks(ticks, [f"{value:g}" for value in ticks])
        axis.set_ticks([], minor=True)
    return figure


def _heading(nodes):
    along = (nodes[-1] - nodes[0])[:2]
    return along / (np.linalg.norm(along) or 1.0)


def _suspended(nodes, depth):
    """Horizontal reach of the part of a line above the bed."""
    hanging = nodes[nodes[:, 2] > -depth + 0.01 * depth]
    return np.ptp(hanging[:, :2] @ _heading(nodes)) if len(hanging) else 0.0


def _axes(height):
    figure = Figure(figsize=(_WIDTH, height), layout="constrained")
    axis = figure.subplots()
    style_axis(axis)
    return figure, axis
