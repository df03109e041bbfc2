"""Motion capture: what noise, bunched stamps and lost frames make of velocities and of the mooring's force, at 1:50."""

import numpy as np

from mooring_ros import Mooring
from mooring_ros.motion import Adapter, Gate, Limits, OnlineTwist, Velocity
from mooring_ros.motion.gate import DEFAULT_BANDWIDTH
from mooring_ros.motion.tracking import Estimate, PoseFilter

from . import camera_frames, tables
from .moordyn_history import SCENES

SCALE = 50.0
SECONDS, SETTLED = 6.0, 1.0
WINDOW = 0.1            # s, of the quadratic fit that stands for filters with a window
LOST = 5                # frames in a row without the platform
KINDS = {
    "as taken": lambda made: made,
    "late by up to 1.5 ms": camera_frames.late,
    "bunched": camera_frames.bunched,
    "skipped": camera_frames.skipped,
    "without the platform": lambda made: hidden(made),
}


def hidden(made):
    """Five frames a second come without the platform."""
    for begin in range(len(made) // 4, len(made) - LOST, round(camera_frames.RATE)):
        made = camera_frames.occluded(made, begin, LOST)
    return made


class Quadratic:
    """Least squares of a quadratic through the poses of the last WINDOW, at its end: the usual alternative, in surge alone."""

    def __init__(self, period):
        self._period, self._rows, self._last = period, round(WINDOW / period), []

    def propose(self, time, pose):
        self._last = (self._last + [(time, pose)])[-self._rows:]
        if len(self._last) < 4:
            return Estimate(time, pose, (0.0,) * 6, (0.0,) * 6)
        times, poses = np.array([t for t, _ in self._last]) - time, np.array([p for _, p in self._last])
        place, speed, _ = np.linalg.lstsq(np.vander(times, 3, increasing=True), poses[:, :3], rcond=None)[0]
        return Estimate(time, (*place, *pose[3:]), (*speed, 0.0, 0.0, 0.0), (0.0,) * 6)

    def take(self, estimate):
        pass


def estimates(tracker, made):
    """Pose (7,) and twist (6,) of each frame, (frames, 13)."""
    rows = []
    for frame in made:
        estimate = tracker.propose(frame.time, frame.sample.pose)
        tracker.take(estimate)
        rows.append((*estimate.pose, *estimate.twist))
    return np.array(rows)


def force(times, poses, twists):
    """The mooring's force (frames, 3) in N at full scale, for motion at model scale."""
    mooring, root = Mooring(SCENES / "oc4.txt"), SCALE ** 0.5
    found = []
    for t, pose, twist in zip(root * np.asarray(times), poses, twists):
        pose = np.array([*(SCALE * pose[:3]), *pose[3:]])
        if found:
            mooring.step(t, pose, np.array([*(root * twist[:3]), *(twist[3:] / root)]))
        else:
            mooring.settle(pose, time=t)
        found.append(mooring.wrench[:3])
    return np.array(found)


def off(found, true, rows):
    """Per cent, rms and largest difference in surge, of the true force's standard deviation."""
    difference, spread = (found - true)[rows, 0], true[rows, 0].std()
    return f"{100 * np.sqrt(np.mean(difference ** 2)) / spread:.1f}", f"{100 * np.abs(difference).max() / spread:.0f}"


def filter_rows(rate):
    """Rows of the table of filters at one rate (Hz)."""
    period = 1.0 / rate
    made, quiet = camera_frames.frames(SECONDS, rate, turning=False), camera_frames.frames(SECONDS, rate, noise=0.0, turning=False)
    times, true = np.array([f.time for f in made]), np.array([(*f.pose, *f.twist) for f in made])
    rows = times > SETTLED
    reference = force(times, true[:, :7], true[:, 7:])
    bandwidths = 5.0, min(rate / 15.0, DEFAULT_BANDWIDTH * SCALE**0.5), 12.0
    ways = {"three poses differenced": OnlineTwist(), f"quadratic through {WINDOW:g} s": Quadratic(period),
            **{f"Kalman, {bandwidth:.3g} Hz": PoseFilter(period, bandwidth) for bandwidth in bandwidths}}
    table = []
    for name, tracker in ways.items():
        noisy, smooth = estimates(tracker, made), estimates(type(tracker)(*arguments(tracker, period)), quiet)
        noise = np.std((noisy - smooth)[rows, 7]) * 1e3
        turn = np.exp(-2j * np.pi * times[rows])
        response = np.sum(smooth[rows, 7] * turn) / np.sum(true[rows, 7] * turn)
        gain, lag = 100 * (abs(response) - 1.0), -1e3 * np.angle(response) / (2 * np.pi)
        table.append([f"{rate:g} Hz, {name}", f"{noise:.1f}", f"{gain:+.1f}", f"{lag:+.2f}",
                      *off(force(times, noisy[:, :7], noisy[:, 7:]), reference, rows)])
    shaken = np.hstack((np.array([frame.sample.pose for frame in made]), true[:, 7:]))
    return [[f"{rate:g} Hz, poses as measured, true twists", *["0.0"] * 3, *off(force(times, shaken[:, :7], shaken[:, 7:]), reference, rows)], *table]


def arguments(tracker, period):
    """Of a new tracker like this one."""
    return {OnlineTwist: (), Quadratic: (period,)}.get(type(tracker)) or ((period, tracker.bandwidth) if isinstance(tracker, PoseFilter) else ())


def kind_row(name, disturb, known):
    """A row of the table of disturbances, with the rate known to the gate or not."""
    made = disturb(camera_frames.frames(SECONDS, turning=False))
    gate = Gate(Adapter(scale=SCALE), Limits(lost_frames=LOST), velocity=Velocity(camera_frames.RATE) if known else Velocity())
    admitted = [(frame, motion) for frame in made if (motion := gate.admit(frame.sample)) is not None]
    begin, root = admitted[0][1].time, SCALE ** 0.5
    times = np.array([(motion.time - begin) * 1e-9 for _, motion in admitted])
    poses = np.array([(*np.divide(motion.pose[:3], SCALE), *motion.pose[3:]) for _, motion in admitted])
    twists = np.array([(*np.divide(motion.twist[:3], root), *np.multiply(motion.twist[3:], root)) for _, motion in admitted])
    true = np.array([(*frame.pose, *frame.twist) for frame, _ in admitted])
    taken = np.array([frame.time for frame, _ in admitted])
    rows = taken > SETTLED
    speed = np.sqrt(np.mean((twists - true[:, 7:])[rows, 0] ** 2)) * 1e3
    return [f"{name}, rate {'known' if known else 'not known'}", f"{100 * (1 - len(admitted) / len(made)):.0f}", f"{speed:.1f}",
            *off(force(times, poses, twists), force(taken, true[:, :7], true[:, 7:]), rows)]


def run(quick=False):
    """Both tables; prints them."""
    errors = "error of the force, rms (%)", "largest (%)"
    filters = tables.table(["rate and way", "noise of the velocity, rms (mm/s)", "amplitude at 1 Hz (%)", "lag at 1 Hz (ms)", *errors],
                           [row for rate in ((250.0,) if quick else (100.0, 250.0)) for row in filter_rows(rate)])
    print(filters, flush=True)
    kinds = tables.table(["frames of 250 Hz", "refused (%)", "error of the velocity, rms (mm/s)", *errors],
                         [kind_row(name, disturb, known) for known in (True, False) for name, disturb in KINDS.items()])
    print(kinds, flush=True)
    return {"tables": {"motion_filters": filters, "motion_kinds": kinds}, "failed": []}
