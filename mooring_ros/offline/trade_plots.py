"""Figures of the trade's report."""

from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatter, StrMethodFormatter

from .plots import COLOURS, style_axis
from .trade_reference import PARTS

_WIDTH = 9.6  # inches
_INK, _FAINT = "#1c2530", "#9aa7b4"


def front_figure(found):
    """Error over CPU time of all settings: runs filled, predictions open, the front as a line, the chosen setting ringed."""
    fig = Figure(figsize=(_WIDTH, 5.0), layout="constrained")
    axis = fig.subplots()
    shown = [result for result in found.results if result.refused is None]
    methods = list(dict.fromkeys(result.setting.method for result in shown))
    for index, method in enumerate(methods):
        colour = COLOURS[index % len(COLOURS)]
        for measured in (True, False):
            own = [result for result in shown if result.setting.method == method and result.measured is measured]
            if own:
                axis.plot([1e3 * result.cost for result in own], [found.error(result).worst for result in own], "o", color=colour, markersize=5.5,
                          markerfacecolor=colour if measured else "none", label=method + ("" if measured else " (predicted)"))
    axis.plot([1e3 * result.cost for result in found.front], [found.error(result).worst for result in found.front], color=_INK, linewidth=1.0, zorder=0,
              label="front")
    known = float(found.reference.error.max())
    axis.axhspan(1e-9, known, color=_FAINT, alpha=0.25, linewidth=0, label="not told by the reference")
    if found.goal.error is not None:
        axis.axhline(found.goal.error, color=_INK, linewidth=0.8, linestyle="--", label="error asked for")
    if found.goal.budget is not None:
        axis.axvline(1e3 / found.goal.budget, color=_INK, linewidth=0.8, linestyle=":", label="budget")
    if found.chosen is not None:
        axis.plot(1e3 * found.chosen.cost, found.error(found.chosen).worst, "o", markersize=13, markerfacecolor="none", color=_INK, label="chosen")
    axis.set(xscale="log", yscale="log", xlabel="CPU time for one simulated second (ms)", ylabel="largest error (%)")
    lowest = min(found.error(result).worst for result in shown)
    axis.set_ylim(bottom=0.5 * min(lowest, known) if known > 0.0 else 0.5 * lowest)
    _plain_numbers(axis)
    fig.legend(loc="outside right upper", frameon=False, fontsize=8)
    return fig


def reference_figure(reference):
    """Differences of the reference's runs over their meshes, and over their steps."""
    fig = Figure(figsize=(_WIDTH, 3.2), layout="constrained")
    space, steps = fig.subplots(1, 2)
    for index, part in enumerate(PARTS):
        for axis, kind, size in ((space, "space", lambda level: level.refine), (steps, "time", lambda level: level.steps)):
            own = [(size(level), getattr(level, kind).parts()[index]) for level in reference.levels if getattr(level, kind) is not None]
            own = sorted(pair for pair in own if pair[1] > 0.0)
            axis.plot(*zip(*own) if own else ([], []), "o-", color=COLOURS[index], markersize=4, linewidth=1.0, label=part)
    for axis, label in ((space, "segments, times the file's"), (steps, "steps in a sample")):
        axis.set(xscale="log", yscale="log", xlabel=label, ylabel="difference to the next coarser (%)")
        _plain_numbers(axis)
    space.legend(frameon=False, fontsize=8)
    return fig


def _plain_numbers(axis):
    style_axis(axis)
    for own in (axis.xaxis, axis.yaxis):
        own.set_major_formatter(StrMethodFormatter("{x:g}"))
        own.set_minor_formatter(LogFormatter(labelOnlyBase=False, minor_thresholds=(1.5, 0.5)))
    axis.tick_params(which="minor", labelsize=7)
