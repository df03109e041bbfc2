"""What `mooring trade` says on a terminal."""

from .console import table
from .trade_reference import PARTS

HEADINGS = ["method", "segments", "step", "mean (%)", "dynamic (%)", "peak (%)", "worst line", "CPU (ms/s)", "× real time", "worst step (ms)"]
OF = {"tension": "fairlead tension", "force": "force at the fairlead"}


def text(found):
    """The trade in words and tables."""
    window = found.window
    lines = [
        f"{found.scene} on {found.motion}: error of the {OF[found.of]} and CPU time of one core, on {window.why}"
        f" ({window.times[0]:.6g} to {window.times[-1]:.6g} s, {len(window.times)} samples)",
        reference_words(found),
        f"{found.runs} runs, {found.from_cache} of them from the cache; {found.cpu:.3g} s of CPU time to measure, {found.elapsed:.3g} s now",
        "",
        table([""] + HEADINGS, [["* " if result is found.chosen else "", *row(found, result)] for result in found.front]),
        "",
        f"The settings worth their cost, of {len(found.results)}: all others are both slower and less accurate than one of these.",
    ]
    refused = [result for result in found.results if result.refused]
    if refused:
        lines += ["", "Refused", *(f"  {name(result.setting)}: {result.refused}" for result in refused)]
    if found.left_out:
        lines += ["", "Left out", *(f"  {name(setting)}: {why}" for setting, why in found.left_out)]
    if found.remarks:
        lines += ["", *(f"Note: {remark}" for remark in found.remarks)]
    if found.chosen is not None:
        error = found.error(found.chosen)
        lines += ["", f"To use (*), {found.why}: {name(found.chosen.setting)}; {error.worst:.3g} % at {1.0 / found.chosen.cost:.4g} times real time",
                  f"  {found.parameters}: for mooring_node, --ros-args --params-file",
                  f"  {found.replay_command}"]
    elif not found.why:
        lines += ["", "With --error PERCENT or --budget FACTOR, the setting to use is chosen and written as a parameter file."]
    return "\n".join(lines)


def name(setting):
    """A setting in words."""
    return f"{setting.method}, {setting.mesh} segments" + (f", step {setting.step}" if setting.fidelity == "dynamic" else "")


def row(found, result):
    """Cells under HEADINGS."""
    setting, error = result.setting, found.error(result)
    cells = [setting.method, setting.mesh, setting.step]
    if result.refused:
        return cells + ["–"] * (len(HEADINGS) - 3)
    worst_line = found.line_names[error.line] if error.line >= 0 else "predicted"
    step = "–" if result.worst_step is None else f"{1e3 * result.worst_step:.3g}"
    return cells + [f"{part:.3g}" for part in error.parts()] + [worst_line, f"{1e3 * result.cost:.3g}", f"{1.0 / result.cost:.3g}", step]


def reference_words(found):
    """How well the reference is known, and why one may believe it."""
    reference = found.reference
    parts = ", ".join(f"{part} {error:.2g} %" for part, error in zip(PARTS, reference.error))
    orders = [f"{where} {order[1]:.2g}" for where, order in (("mesh", reference.space_order), ("step", reference.time_order)) if order[1] is not None]
    return (
        f"Reference: {reference.refine} times the file's segments, {reference.steps} steps in a sample; known by the differences of"
        f" {len(reference.levels)} runs to {parts}{' (observed orders: ' + ', '.join(orders) + ')' if orders else ''}; {reference.why}"
    )
