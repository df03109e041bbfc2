"""What `mooring replay --accuracy` adds: an estimate of the error around the highest tension of the run."""

import math

import numpy as np

from mooring_ros.accuracy import LEAD, estimate, motion_in
from mooring_ros.recording import schedule

WINDOW = 60.0  # s of the core's time that are solved again; the highest tension is in the middle of what is compared


class Watched:
    """The motion of the last run since a settle, and where its highest tension is."""

    def __init__(self):
        self._motion, self._released, self._lengths = [], [], None
        self._highest, self._at = -math.inf, 0.0

    def note(self, done, mooring):
        """Something was done to the mooring (replay_run.Done)."""
        if done.kind == schedule.SETTLE:
            self._motion, self._highest = [], -math.inf
        if done.kind in schedule.MOVES:
            self._motion.append(done.record[1:])
            highest = float(mooring.fairlead_tension.max())
            if highest > self._highest:
                self._highest, self._at, self._lengths = highest, mooring.time, mooring.unstretched_length
                self._lost = tuple(self._released)
        elif done.kind == schedule.RELEASE:
            self._released.append(mooring.line_names[int(done.record[2])])

    def estimate(self, scene, settings):
        """Accuracy of the settings (arguments of Mooring) there."""
        motion = np.array(self._motion)
        times = motion[:, 0]
        begin = np.clip(self._at - 0.5 * (1.0 + LEAD) * WINDOW, times[0], max(times[0], times[-1] - WINDOW))
        rows = (times >= begin) & (times <= begin + WINDOW)
        return estimate(scene, settings, *motion_in(motion[rows], settings.get("platforms")), self._lengths, self._lost)
