"""Builds of the package in which the stage of an effect is removed, for `benchmarks.effects`."""

import hashlib
import os
from pathlib import Path

PACKAGE = Path(__file__).parent.parent / "mooring_ros"
# effect -> (file of the core, the condition of its stage): it becomes False, and Python leaves out what stands under it
STAGES = {
    "bending": [("forces.py", "if model.bending.stiffness.size > 0:")],
    "waves and current profiles": [
        ("forces.py", "if flowing:"),
        ("forces.py", "if state.swell.shape[1] > 0:"),
        ("surface.py", "if state.swell.shape[1] > 0:"),
        ("explicit.py", "if model.sea.frequency.size > 0 and outdated(state.window_times, now, now + span):"),
    ],
    "load-strain curves and viscoelastic ropes": [("forces.py", "if model.ropes.curve_first.size + model.ropes.kelvin_first.size > 0:")],
    "bathymetry and friction": [("forces.py", "if model.ground.on:"), ("points.py", "if model.ground.on:"), ("explicit.py", "if state.grip.shape[1] > 0:")],
    "rods and bodies": [
        ("forces.py", "if model.rigid.mass.size > 0:"),
        ("forces.py", "if model.hulls.point.size > 0:"),
        ("explicit.py", "if state.parts.size > 0:"),
    ],
    "free points": [("forces.py", "if model.free_points.size + model.rigid.mass.size > 0:")],
    "line failures": [("explicit.py", "if model.failures.point.size > 0:")],
}
# what goes with it and has no condition of its own
LINES = {
    "load-strain curves and viscoelastic ropes": [
        ("explicit.py", "copy_row(state.creep, scratch.creep)"),
        ("guard.py", "copy_row(state.creep, scratch.saved_creep[place])"),
        ("guard.py", "copy_row(scratch.saved_creep[place], state.creep)"),
    ],
    "bathymetry and friction": [
        ("guard.py", "copy_rows(state.grip, scratch.saved_grip[place])"),
        ("guard.py", "copy_rows(scratch.saved_grip[place], state.grip)"),
    ],
    "line failures": [
        ("guard.py", "copy_row(state.failed, scratch.saved_failed[place])"),
        ("guard.py", "copy_row(scratch.saved_failed[place], state.failed)"),
    ],
}
ALL = "all of these"
GUARD = "the guard"
REPLACED = {  # what is not under a condition: file, line, what stands there instead
    GUARD: [
        ("explicit.py", "keep_tension(model, state, scratch)", "pass"),
        ("explicit.py", "worst = max(worst, tension_jumped(model, state, scratch, AXIAL_JUMP if scheme == AXIAL else JUMP))", "pass"),
        ("explicit.py", "save(model, state, scratch, source)", "pass"),
        ("explicit.py", "wild = runaway(model, state, fastest)", "wild = False"),
        ("explicit.py", "torn = overstretched(model, state, settings[5])", "torn = False"),
    ]
}


def build(effects, root):
    """Folder with a copy of the package without the stages of `effects`, below the folder `root`; the package itself when there are none.

    The folder is named after what is in it, and made once: what has been compiled there stays good. Raises ValueError when a stage is not where it was.
    """
    if not effects:
        return PACKAGE.parent
    sources = sorted(PACKAGE.rglob("*.py"))
    changed = {path: _without(effects, path) for path in sources}
    digest = hashlib.sha256("".join(changed.values()).encode()).hexdigest()[:16]
    folder = root / digest
    if not folder.exists():
        made = root / f"{digest}.{os.getpid()}"
        for path, text in changed.items():
            target = made / path.relative_to(PACKAGE.parent)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")
        made.rename(folder)
    return folder


def _without(effects, path):
    """Text of a file of the package without the stages of `effects`."""
    text = path.read_text(encoding="utf-8")
    if path.parent.name != "core":
        return text
    for effect in effects:
        for file, condition in STAGES.get(effect, []):
            text = _replaced(text, path, condition, "if False:", effect) if path.name == file else text
        for file, line in LINES.get(effect, []):
            text = _replaced(text, path, line, "pass", effect) if path.name == file else text
        for file, line, instead in REPLACED.get(effect, []):
            text = _replaced(text, path, line, instead, effect) if path.name == file else text
    return text


def _replaced(text, path, old, new, effect):
    if f" {old}\n" not in text:
        raise ValueError(f"core/{path.name}: expected {old!r}, the stage of {effect}; it has moved, and benchmarks/removed.py must follow")
    return text.replace(f" {old}\n", f" {new}\n")
