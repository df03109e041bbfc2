"""The report of `mooring validate`: the table, and each pair drawn."""

from . import plots, report
from .validate import COLUMNS, rows, time_base

_MOST_DRAWN = 24  # pairs: more would be a book


def write(path, bases, comparison):
    """Write the HTML report. bases: {pair's title: Common}, in the order of comparison["pairs"]. Raises OSError."""
    headings = ["pair", *(heading for heading, _ in COLUMNS)]
    intro = report.paragraph(f"Result: {comparison['result']}. Reference: {comparison['reference']}.")
    intro += report.paragraph(f"Compared over {time_base(comparison)}")
    intro += report.table(
        headings,
        rows(comparison),
        "Δμ = 100 (μ_result − μ_reference)/μ_reference, and Δσ alike with the standard deviations; rms and the largest absolute value of the "
        "difference; the lag is positive where the result comes later; a dash stands for what is not defined.",
    )
    for whose, names in comparison["unpaired"].items():
        if names:
            intro += report.paragraph(f"Not compared, of the {whose}: {', '.join(names)}.")
    moments = report.table(
        ["pair", "μ result (N)", "μ reference (N)", "σ result (N)", "σ reference (N)", "peak at (s)"],
        [
            [row[0], *(_six_digits(pair[key]) for key in ("mean_result", "mean_reference", "std_result", "std_reference", "peak_difference_time"))]
            for row, pair in zip(rows(comparison), comparison["pairs"])
        ],
    )
    drawn = dict(list(bases.items())[:_MOST_DRAWN])
    overlays = "".join(
        report.figure(plots.overlay_figure(base.times, base.result, base.reference, name), f"{name}: result over reference, and their difference")
        for name, base in drawn.items()
    )
    if len(drawn) < len(bases):
        overlays += report.paragraph(f"{len(bases) - len(drawn)} more pairs are in the table only.")
    scatter = report.figure(
        plots.scatter_figure({name: (base.result, base.reference) for name, base in drawn.items()}),
        "Result against reference, sample by sample; the line is equality.",
    )
    report.write_report(
        path,
        "Two tension histories side by side",
        [
            report.Section("Differences", intro),
            report.Section("Means and standard deviations", moments),
            report.Section("Histories", overlays),
            report.Section("Sample by sample", scatter),
        ],
    )


def _six_digits(value):
    return f"{value:.6g}" if abs(value) < 1e5 else f"{value:.0f}"
