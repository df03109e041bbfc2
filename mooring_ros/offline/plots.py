"""Figures of motions, tensions and line shapes, for reports.

Every function returns a matplotlib Figure that belongs to nobody else: no global state, no window, no display needed.
"""

import numpy as np
from matplotlib import colormaps
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from .angles import roll_pitch_yaw

# Distinguishable without colour vision, and in print.
COLOURS = ("#0b6fa4", "#d1651a", "#2a8c5a", "#8a4fa8", "#b3323f", "#6b6f1d", "#4a5a6a", "#c7418f")
_WIDTH = 9.6  # inches
_INK = "#1c2530"
_FAINT = "#51606f"
_WATER = "#7fb3d5"
_BED = "#a58e6b"
_MOST_POINTS = 3000  # a curve holds no more: beyond, the extremes of each stretch stand for it


def motion_figure(times, poses):
    """The six motions over time. times (n,) s; poses (n, 7): x, y, z (m) and quaternion x, y, z, w."""
    times, poses = np.asarray(times, float), np.asarray(poses, float)
    angles = np.degrees(np.unwrap(roll_pitch_yaw(poses[:, 3:7]), axis=0))
    fig = _figure(3.9)
    axes = fig.subplots(3, 2, sharex=True)
    for row, (name, quantity) in enumerate((("surge", poses[:, 0]), ("sway", poses[:, 1]), ("heave", poses[:, 2]))):
        _curve(axes[row, 0], times, quantity, COLOURS[0])
        axes[row, 0].set_ylabel(f"{name} (m)")
    for row, name in enumerate(("roll", "pitch", "yaw")):
        _curve(axes[row, 1], times, angles[:, row], COLOURS[1])
        axes[row, 1].set_ylabel(f"{name} (°)")
    for axis in axes.flat:
        _plain(axis)
        _steady(axis)
    for axis in axes[-1]:
        axis.set_xlabel("time (s)")
    fig.align_ylabels()
    return fig


def tension_figure(times, series, title=None):
    """Tensions over time. times (n,) s, the same for all, or a dict name -> (n,); series: dict name -> (n,) N."""
    fig = _figure(3.4)
    axis = fig.subplots()
    divisor, unit = force_unit(np.concatenate([np.ravel(values) for values in series.values()]) if series else [0.0])
    for index, (name, values) in enumerate(series.items()):
        instants = times[name] if isinstance(times, dict) else times
        _curve(axis, instants, np.asarray(values, float) / divisor, COLOURS[index % len(COLOURS)], name)
    axis.set_xlabel("time (s)")
    axis.set_ylabel(f"tension ({unit})")
    _plain(axis, title)
    _legend(fig, len(series))
    return fig


def overlay_figure(times, result, reference, name):
    """One tension history over its reference, and their difference below. times (n,) s; result, reference (n,) N."""
    times, result, reference = (np.asarray(values, float) for values in (times, result, reference))
    divisor, unit = force_unit(np.concatenate([result, reference]))
    small_divisor, small_unit = force_unit(result - reference)
    fig = _figure(4.2)
    upper, lower = fig.subplots(2, 1, sharex=True, height_ratios=(2.4, 1))
    _curve(upper, times, reference / divisor, "#9aa7b4", "reference", 2.4)
    _curve(upper, times, result / divisor, COLOURS[0], "result", 1.0)
    upper.set_ylabel(f"tension ({unit})")
    _plain(upper, name)
    lower.axhline(0.0, color="#c5ced8", linewidth=0.8)
    _curve(lower, times, (result - reference) / small_divisor, COLOURS[1])
    lower.set_ylabel(f"difference ({small_unit})")
    lower.set_xlabel("time (s)")
    _plain(lower)
    fig.align_ylabels()
    _legend(fig, 2)
    return fig


def scatter_figure(pairs):
    """Result against reference, one panel a pair. pairs: dict name -> (result (n,), reference (n,)) N."""
    columns = min(3, max(1, len(pairs)))
    rows = -(-len(pairs) // columns)
    fig = _figure(3.3 * rows)
    axes = fig.subplots(rows, columns, squeeze=False).ravel()
    for axis, (name, (result, reference)) in zip(axes, pairs.items()):
        result, reference = np.asarray(result, float), np.asarray(reference, float)
        divisor, unit = force_unit(np.concatenate([result, reference]))
        stride = max(1, len(result) // 1500)
        low, high = min(result.min(), reference.min()) / divisor, max(result.max(), reference.max()) / divisor
        margin = 0.04 * (high - low) or max(abs(high) * 0.01, 1e-9)
        span = (low - margin, high + margin)
        axis.plot(span, span, color="#9aa7b4", linewidth=0.8)
        axis.plot(reference[::stride] / divisor, result[::stride] / divisor, ".", markersize=2, color=COLOURS[0])
        axis.set(xlim=span, ylim=span, xlabel=f"reference ({unit})", ylabel=f"result ({unit})")
        axis.set_aspect("equal")
        _plain(axis, name)
    for axis in axes[len(pairs):]:
        axis.set_visible(False)
    return fig


def spectra_figure(times, series, highest=None):
    """Amplitude of each series over frequency. times (n,) s, evenly spaced; series: dict name -> (n,) N; highest: Hz shown."""
    fig = _figure(3.2)
    axis = fig.subplots()
    spectra = {name: amplitude_spectrum(times, values) for name, values in series.items()}
    divisor, unit = force_unit(np.concatenate([amplitude for _, amplitude in spectra.values()]) if spectra else [0.0])
    for index, (name, (frequency, amplitude)) in enumerate(spectra.items()):
        _curve(axis, frequency, amplitude / divisor, COLOURS[index % len(COLOURS)], name)
    if highest is None and spectra:
        highest = max(_band(frequency, amplitude) for frequency, amplitude in spectra.values())
    axis.set_xlim(0.0, highest or 1.0)
    axis.set_ylim(bottom=0.0)
    axis.set_xlabel("frequency (Hz)")
    axis.set_ylabel(f"amplitude ({unit})")
    _plain(axis)
    _legend(fig, len(series))
    return fig


def amplitude_spectrum(times, values):
    """One-sided amplitude spectrum by a Hann window, mean removed: frequency (k,) Hz, amplitude (k,) in the unit of values."""
    times, values = np.asarray(times, float), np.asarray(values, float)
    if len(times) < 2:
        return np.zeros(1), np.zeros(1)
    window = np.hanning(len(values) + 2)[1:-1]  # the outer zeros would waste two samples
    amplitude = 2.0 * np.abs(np.fft.rfft((values - values.mean()) * window)) / window.sum()
    return np.fft.rfftfreq(len(values), (times[-1] - times[0]) / (len(times) - 1)), amplitude


def line_shapes_figure(shapes, depth):
    """The lines from the side and from above, coloured by tension.

    shapes: dict name -> (positions (n, 3) m, tension (n,) N); depth: m.
    """
    positions = np.concatenate([np.asarray(nodes, float) for nodes, _ in shapes.values()])
    tensions = np.concatenate([np.asarray(tension, float) for _, tension in shapes.values()])
    divisor, unit = force_unit(tensions)
    norm = Normalize(tensions.min() / divisor, max(tensions.max(), tensions.min() * (1 + 1e-6) + 1e-9) / divisor)
    low, high = positions.min(axis=0), positions.max(axis=0)
    low[2], high[2] = min(low[2], -depth), max(high[2], 0.0)
    margin = 0.04 * max(high[0] - low[0], high[1] - low[1], 1.0)
    low, high = low - margin, high + margin
    width, breadth, height = high - low
    # Both views share one scale, the largest that fits the page.
    scale = min((_WIDTH - 2.2) / width, 5.0 / height, 5.5 / breadth)
    fig = _figure(max(scale * (height + breadth), 1.8) + 1.5, max(scale * width + 2.2, 4.5))
    side, plan = fig.subplots(2, 1, height_ratios=(max(scale * height, 0.9), max(scale * breadth, 0.9)))
    cmap = colormaps["viridis"]
    side.axhline(0.0, color=_WATER, linewidth=1.2, zorder=0)
    side.axhspan(low[2] - height, -depth, color=_BED, alpha=0.35, linewidth=0, zorder=0)
    for name, (nodes, tension) in shapes.items():
        nodes, tension = np.asarray(nodes, float), np.asarray(tension, float) / divisor
        for axis, (i, j) in ((side, (0, 2)), (plan, (0, 1))):
            points = nodes[:, (i, j)]
            pieces = np.stack([points[:-1], points[1:]], axis=1)
            coloured = LineCollection(pieces, cmap=cmap, norm=norm, linewidth=2.2, capstyle="round")
            coloured.set_array(0.5 * (tension[:-1] + tension[1:]))
            axis.add_collection(coloured)
            axis.plot(*points[[0, -1]].T, "o", markersize=3.5, color=_INK, linestyle="none")
        middle = len(nodes) // 2
        plan.annotate(str(name), nodes[middle, :2], xytext=(4, 4), textcoords="offset points", fontsize=8, color=_FAINT)
    side.set(xlim=(low[0], high[0]), ylim=(low[2], high[2]), ylabel="z (m)")
    plan.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), ylabel="y (m)", xlabel="x (m)")
    for axis, text in ((side, "from the side"), (plan, "from above")):
        axis.set_aspect("equal", adjustable="box")
        _plain(axis, text)
    fig.colorbar(coloured, ax=[side, plan], label=f"tension ({unit})", shrink=0.8, pad=0.02, aspect=30)
    return fig


def force_unit(values):
    """(divisor, unit) that shows forces (N, any shape) with few digits."""
    largest = float(np.max(np.abs(values), initial=0.0))
    for divisor, unit in ((1e6, "MN"), (1e3, "kN")):
        if largest >= divisor:
            return divisor, unit
    return 1.0, "N"


def _figure(height, width=_WIDTH):
    return Figure(figsize=(width, height), layout="constrained")


def _curve(axis, x, y, colour, name=None, width=1.2):
    x, y = _thinned(np.asarray(x, float), np.asarray(y, float))
    axis.plot(x, y, color=colour, linewidth=width, label=name)
    if len(x) > 1:
        axis.set_xlim(min(axis.dataLim.x0, x[0]), max(axis.dataLim.x1, x[-1]))


def _thinned(x, y):
    """The lowest and the highest sample of each stretch, in their order, where there are too many to draw."""
    stretch = 2 * len(x) // _MOST_POINTS
    if stretch < 3:
        return x, y
    whole = len(x) // stretch * stretch
    blocks = y[:whole].reshape(-1, stretch)
    start = np.arange(0, whole, stretch)
    kept = np.unique(np.concatenate([start + blocks.argmin(axis=1), start + blocks.argmax(axis=1), [0, len(x) - 1]]))
    return x[kept], y[kept]


def style_axis(axis, title=None):
    """The look of every axis here and in the demo's figures."""
    axis.grid(True, color="#e4e9ef", linewidth=0.7)
    axis.set_axisbelow(True)
    axis.spines[["top", "right"]].set_visible(False)
    axis.spines[["left", "bottom"]].set_color("#aab6c3")
    axis.tick_params(colors=_FAINT, labelsize=8, length=3)
    axis.xaxis.label.set(color=_INK, fontsize=9)
    axis.yaxis.label.set(color=_INK, fontsize=9)
    if title:
        axis.set_title(title, loc="left", fontsize=10, color=_INK)


def _plain(axis, title=None):
    style_axis(axis, title)
    axis.ticklabel_format(useOffset=False)


def _steady(axis):
    """Keep a motion that is still from being drawn as noise over the full height."""
    low, high = axis.get_ylim()
    if high - low < 1e-6:
        middle = 0.5 * (low + high)
        axis.set_ylim(middle - 0.5, middle + 0.5)


def _legend(fig, entries):
    if entries > 1:
        fig.legend(loc="outside upper right", ncols=min(entries, 6), frameon=False, fontsize=8)


def _band(frequency, amplitude):
    """The frequency below which nearly all of the power lies, with room to see that it ends."""
    power = np.cumsum(amplitude**2)
    if power[-1] <= 0.0:
        return frequency[-1]
    return min(frequency[-1], 2.0 * frequency[np.searchsorted(power, 0.995 * power[-1])])
