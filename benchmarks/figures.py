"""The look of the benchmarks' figures, which docs/physics.md shows."""

from matplotlib.figure import Figure

from mooring_ros.offline.plots import COLOURS, style_axis

WIDTH = 9.6  # inches
STYLES = {  # one look for each code in all figures
    "ours": {"color": COLOURS[0], "linewidth": 3.2, "alpha": 0.45},  # broad and pale: the others run inside it
    "MoorDyn": {"color": COLOURS[1], "linewidth": 1.3, "linestyle": "--"},
    "CableDyn": {"color": COLOURS[2], "linewidth": 1.3, "linestyle": ":"},
}


def axes(rows=1, columns=1, height=3.2, **options):
    """(figure, array of styled axes (rows, columns))."""
    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False, **options)
    for axis in grid.flat:
        style_axis(axis)
    return figure, grid


def legend(figure, axis):
    """One legend for the whole figure, above it, of what stands in one of its axes."""
    handles, labels = axis.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=min(len(labels), 7), frameon=False, fontsize=9)
