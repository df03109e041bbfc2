"""The report of `mooring trade`."""

from . import plots, report
from .trade_cache import machine_text
from .trade_plots import front_figure, reference_figure
from .trade_reference import PARTS
from .trade_text import HEADINGS, OF, name, reference_words, row


def write(path, found):
    """Write the HTML report. Raises OSError."""
    window = found.window
    intro = report.paragraph(f"Scene: {found.scene}. Motion: {found.motion}. Machine: {machine_text()}.")
    intro += report.paragraph(
        f"Error of the {OF[found.of]} against a converged reference, and CPU time of one core without compiling, measured on {window.why}: "
        f"{window.times[0]:.6g} to {window.times[-1]:.6g} s, {len(window.times)} samples, compared from {window.times[window.compared + 1]:.6g} s on."
    )
    if found.chosen is not None:
        error = found.error(found.chosen)
        intro += report.paragraph(
            f"To use, {found.why}: {name(found.chosen.setting)}, with {error.worst:.3g} % at {1.0 / found.chosen.cost:.4g} times real time; "
            f"written to {found.parameters}. The same offline: {found.replay_command}"
        )
    elif found.why:
        intro += report.paragraph(f"Nothing to use: {found.why}.")
    intro += "".join(report.paragraph(f"Note: {remark}.") for remark in found.remarks)
    intro += report.figure(front_figure(found), "Each setting's error and cost; the line joins those that are worth their cost.")
    sections = [report.Section("The trade", intro), report.Section("Settings worth their cost", _table(found, found.front))]
    if found.chosen is not None:
        sections.append(report.Section("The setting to use, beside the reference", _histories(found)))
    reference = report.paragraph(reference_words(found) + ".")
    reference += report.table(
        ["segments, times the file's", "steps in a sample", "CPU (ms/s)",
         *(f"mesh, {part} (%)" for part in PARTS), *(f"step, {part} (%)" for part in PARTS)],
        [[level.refine, level.steps, 1e3 * level.cost, *_parts(level.space), *_parts(level.time)] for level in found.reference.levels],
        "Differences to the run with half the segments, and to that with half the steps.",
    )
    reference += report.figure(reference_figure(found.reference), "Differences between the reference's own runs; straight and steep is good.")
    sections += [report.Section("The reference", reference), report.Section("All settings", _table(found, [r for r in found.results if not r.refused]))]
    refused = [[name(result.setting), result.refused] for result in found.results if result.refused]
    refused += [[name(setting), why] for setting, why in found.left_out]
    if refused:
        sections.append(report.Section("Refused or left out", report.table(["setting", "why"], refused)))
    report.write_report(path, "Speed for accuracy", sections)


def _table(found, results):
    return report.table(
        [*HEADINGS, ""], [[*row(found, result), "" if result.measured else "predicted, not run"] for result in results],
        "Mean: difference of the means over the mean. Dynamic: standard deviation of the difference over the standard deviation. Peak: difference of the "
        "maxima over the maximum. Each of the worst line. Worst step: CPU time from one sample to the next.",
    )


def _histories(found):
    window, line = found.window, max(found.error(found.chosen).line, 0)
    times = window.times[1 + window.compared :]
    name_of_line = found.line_names[line]
    return report.figure(
        plots.overlay_figure(times, found.chosen.tension[:, line], found.reference.tension[:, line], name_of_line),
        f"Fairlead tension of {name_of_line}, where the error is largest, over the reference's force at the fairlead.",
    )


def _parts(errors):
    return [None] * 3 if errors is None else errors.parts().tolist()
