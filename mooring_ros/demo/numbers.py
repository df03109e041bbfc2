"""The figures of a run in rows of a table, for the terminal and the report."""

import numpy as np

from mooring_ros.offline.angles import roll_pitch_yaw

MOTIONS = ("surge", "sway", "heave", "roll", "pitch", "yaw")


def motions(poses):
    """(n, 6) of poses (n, 7): surge, sway, heave in m; roll, pitch, yaw about the fixed axes in degrees."""
    poses = np.asarray(poses, float)
    return np.column_stack([poses[:, :3], np.degrees(roll_pitch_yaw(poses[:, 3:7]))])


def tension_rows(answers):
    """[name, mean, standard deviation, least, greatest] of each line's fairlead tension in kN, as text. answers: history.Answers."""
    kilo = answers.fairlead_tension / 1e3
    return [
        [name, *(f"{value:.1f}" for value in (column.mean(), column.std(), column.min(), column.max()))]
        for name, column in zip(answers.line_names, kilo.T)
    ]


def motion_rows(poses, which=MOTIONS):
    """[name with unit, mean, least, greatest] of the motions in `which`, as text."""
    rows = []
    for name, column in zip(MOTIONS, motions(poses).T):
        if name in which:
            unit = "m" if name in MOTIONS[:3] else "°"
            rows.append([f"{name} ({unit})", *(f"{value:z.2f}" for value in (column.mean(), column.min(), column.max()))])
    return rows


def real_time_factor(summary):
    """Simulated time over wall time of a run's summary (dict, see simulator.Summary)."""
    return summary["steps"] * summary["step"] / summary["wall_time"]


def run_rows(summary, comparison):
    """[what, value] of the run: steps, answers, latencies, speed, replay. summary: dict; comparison: replay.Comparison."""
    trips = np.percentile(summary["round_trips"], [50, 99, 100])
    return [
        ["simulated time", f"{summary['steps'] * summary['step']:g} s"],
        ["steps", f"{summary['steps']} of {1e3 * summary['step']:g} ms"],
        ["wall time of the coupled run", f"{summary['wall_time']:.1f} s"],
        ["speed", f"{real_time_factor(summary):.1f} × real time"],
        ["samples sent, answered", f"{summary['sent']}, {summary['answered']}"],
        ["answers lost, doubled, late", f"{summary['lost']}, {summary['doubled']}, {summary['late']}"],
        ["round trip, median", f"{trips[0]:.2f} ms"],
        ["round trip, 99 %", f"{trips[1]:.2f} ms"],
        ["round trip, longest", f"{trips[2]:.2f} ms"],
        ["replayed offline", replay_words(comparison)],
    ]


def replay_words(comparison):
    """What became of the comparison with the replay, in words."""
    if comparison.identical:
        return f"bit-identical in all {comparison.samples} samples"
    if np.isinf(comparison.difference):
        return "NOT identical: another number of samples or lines"
    return f"NOT identical: largest difference {comparison.difference:.3g} N or N·m in {comparison.samples} samples"
