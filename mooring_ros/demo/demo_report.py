"""The demo's report: what moved, what pulled, how it ran."""

import math

from mooring_ros.demo.figures import elevation_figure, extremes_figure, round_trip_figure, wrench_figure
from mooring_ros.demo.numbers import motion_rows, real_time_factor, replay_words, run_rows, tension_rows
from mooring_ros.offline.plots import line_shapes_figure, motion_figure, tension_figure
from mooring_ros.offline.report import Section, figure, paragraph, table, write_report


def write(path, scene, waves, history, summary, comparison):
    """Write the report of a run to path.

    scene: Scene; waves: Waves; history: History; summary: dict (see simulator.Summary); comparison: replay.Comparison. Raises OSError.
    """
    write_report(
        path,
        "A moored floater in waves",
        [
            _overview(scene, waves, history, summary, comparison),
            _motion(waves, history),
            _tensions(history),
            _wrench(history),
            _shapes(scene, history),
            _numbers(history, summary, comparison),
            _scene(scene),
        ],
    )


def _overview(scene, waves, history, summary, comparison):
    sea = waves.sea
    state = (
        f"waves of {sea.height:g} m significant height and {sea.period:g} s peak period that go to {math.degrees(sea.heading):g}° from the x axis "
        f"(JONSWAP, seed {sea.seed})"
        if sea.height
        else "still water"
    )
    text = (
        f"A VolturnUS-S-like floater in {state}, held by {_counted(len(scene.lines), 'line')} in {scene.environment.depth:g} m of water. "
        f"The floater and the mooring node ran as two ROS 2 processes in lockstep: {summary['steps']} steps, "
        f"{real_time_factor(summary):.1f} times real time, {summary['lost']} answers lost."
    )
    replayed = f"The recording was replayed offline: tensions and wrenches are {replay_words(comparison)}."
    return Section(
        "In short",
        paragraph(text)
        + paragraph(replayed)
        + table(["fairlead tension (kN)", "mean", "std", "least", "greatest"], tension_rows(history.answers))
        + table(["motion", "mean", "least", "greatest"], motion_rows(history.poses)),
    )


def _motion(waves, history):
    pictures = ""
    if waves.sea.height:
        elevation = waves.elevation(history.times)
        pictures += figure(elevation_figure(history.times, elevation), f"Surface elevation at the platform; the waves grow over the first {waves.sea.ramp:g} s.")
    pictures += figure(motion_figure(history.times, history.poses), "Motion of the reference point at the still water line, as sent to the mooring node.")
    return Section("Waves and motion", pictures)


def _tensions(history):
    times, names, answers = history.answers.times, history.answers.line_names, history.answers
    fairlead = figure(tension_figure(times, dict(zip(names, answers.fairlead_tension.T))), "Tension at the fairleads, as the node published it.")
    anchor = figure(tension_figure(times, dict(zip(names, answers.anchor_tension.T))), "Tension at the anchors.")
    return Section("Tensions", fairlead + anchor)


def _wrench(history):
    picture = wrench_figure(history.answers.times, history.answers.wrenches)
    return Section("Mooring wrench", figure(picture, "Force and moment of the moorings on the platform, about its reference point, world axes."))


def _shapes(scene, history):
    times, tension, names = history.answers.times, history.answers.fairlead_tension, history.answers.line_names
    loaded = tension.max(axis=0).argmax()
    high = history.shape_at(times[tension[:, loaded].argmax()])
    low = history.shape_at(times[tension[:, loaded].argmin()])
    start = history.shapes[0]
    name = names[loaded]
    moments = {
        f"start ({start[0]:.1f} s)": start[1],
        f"{name} at its greatest tension ({high[0]:.1f} s)": high[1],
        f"{name} at its least ({low[0]:.1f} s)": low[1],
    }
    depth = scene.environment.depth
    return Section(
        "Line shapes",
        figure(line_shapes_figure(high[1], depth), f"All lines when {name} pulls most, at {high[0]:.1f} s.")
        + figure(extremes_figure(names, moments, depth), "Each line in its vertical plane, and its tension, at three moments; the dots are the fairleads."),
    )


def _numbers(history, summary, comparison):
    caption = "A round trip lasts from publishing the motion to having the answer: two hops over DDS, the node's step and its recording."
    picture = ""
    if len(summary["round_trips"]) == len(history.times):  # else answers were lost, and which is which is not known
        picture = figure(round_trip_figure(history.times, summary["round_trips"]), caption)
    return Section("Numbers of the run", table(["", "value"], run_rows(summary, comparison)) + picture)


def _scene(scene):
    lines = [
        [line.name, line.type.name, f"{line.length:g}", line.segments, f"{line.type.diameter:g}", f"{line.type.mass:g}", f"{line.type.stiffness:.3g}"]
        for line in scene.lines
    ]
    kinds = [point.kind for point in scene.points]
    counts = ", ".join(f"{kinds.count(kind)} {kind}" for kind in ("fixed", "coupled", "free") if kind in kinds)
    text = f"{scene.path}: {_counted(len(scene.lines), 'line')}, {_counted(len(scene.points), 'point')} ({counts})."
    header = ["line", "type", "length (m)", "segments", "diameter (m)", "mass (kg/m)", "EA (N)"]
    return Section("Scene", paragraph(text) + table(header, lines))


def _counted(number, noun):
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
