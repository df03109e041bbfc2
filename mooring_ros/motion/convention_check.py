"""The start-up check: does the given twist move the given pose?

Over the first samples the mean twist of each interval, read in the assumed convention and in the alternatives, is compared with
the differenced pose. A source whose twist is in another frame than said, or in NED where ENU is said, shows once the platform moves
and is turned. What this cannot see: a source that is NED throughout (its twist fits its own pose), and two conventions that
give the same numbers because the platform is not turned.
"""
import math
from dataclasses import dataclass

from mooring_ros.motion import rotation
from mooring_ros.motion.frames import CONVENTIONS, TWIST_FRAMES

UNDECIDED, OK, WRONG, MISSING = "undecided", "ok", "wrong", "missing"

_INTERVALS = 30         # at least so many intervals with motion before a verdict
_MOST_INTERVALS = 5000  # start-up is over by then
_SPEED, _RATE = 0.02, 0.002     # m/s and rad/s rms at full scale: below this the platform stands still
# Misfit: rms difference over rms of the differenced pose. A frame turned by 20 degrees gives 0.35.
_FITS, FAILS, _CLEARLY_BETTER = 0.2, 0.3, 1.0 / 3.0


@dataclass(frozen=True)
class Verdict:
    """kind: ``undecided`` (not enough motion to tell, or nothing fits), ``ok``, ``wrong`` (clearly another convention), ``missing``
    (the pose moves, the twist is zero). text: the same in words. fits: names of the conventions that fit. misfit: rms difference over rms
    of the differenced pose in the assumed convention; None before there was enough motion."""

    kind: str
    text: str
    fits: tuple = ()
    misfit: float | None = None


class ConventionCheck:
    """Collects samples until it can tell. finished: no more samples are needed; verdict: as of now."""

    def __init__(self, adapter):
        self._adapter = adapter
        self._options = [(frame, convention) for frame in TWIST_FRAMES for convention in CONVENTIONS]
        self._last = None
        self._misfit = {option: [0.0, 0.0] for option in self._options}
        self._motion = [0.0, 0.0]
        self._twist = 0.0
        self._count = 0
        self.verdict = Verdict(UNDECIDED, "twist not checked yet: not enough motion to tell")

    def anew(self):
        """A check that begins again."""
        return ConventionCheck(self._adapter)

    @property
    def moved(self):
        """Whether the platform has moved enough to tell."""
        return bool(self._moving())

    @property
    def finished(self):
        return self.verdict.kind in (WRONG, MISSING) or self._count >= _MOST_INTERVALS

    def look_at(self, motion, sample):
        """Take one accepted Motion and the Sample that it is from; returns the verdict."""
        return self.add(motion.time, motion.pose, sample.twist, sample.twist_frame)

    def add(self, stamp, pose, raw_twist, twist_frame=None):
        """Take one accepted sample: stamp ns, pose (7,) inside, raw_twist (6,) as the source gave it; returns the verdict."""
        assumed = (twist_frame or self._adapter.twist_frame, self._adapter.convention)
        twists = {(frame, convention): self._adapter.twist_in(raw_twist, pose[3:], frame, convention)
                  for frame, convention in self._options}
        last, self._last = self._last, (stamp, pose, twists)
        if last is None or stamp <= last[0]:
            return self.verdict
        dt = (stamp - last[0]) * 1e-9 * self._adapter.time_factor
        differenced = [(b - a) / dt for a, b in zip(last[1][:3], pose[:3])]
        differenced += [a / dt for a in rotation.turn_between(last[1][3:], pose[3:])]
        for option in self._options:
            middle = [0.5 * (a + b) for a, b in zip(last[2][option], twists[option])]
            misfit = self._misfit[option]
            linear, angular = math.dist(middle[:3], differenced[:3]), math.dist(middle[3:], differenced[3:])
            misfit[0] += linear * linear
            misfit[1] += angular * angular
        self._twist += sum(component * component for component in raw_twist)
        self._motion[0] += sum(v * v for v in differenced[:3])
        self._motion[1] += sum(w * w for w in differenced[3:])
        self._count += 1
        if self._count % _INTERVALS == 0:
            self.verdict = self._judge(assumed)
        return self.verdict

    def _moving(self):
        if self._count < _INTERVALS:
            return []
        return [part for part, least in enumerate((_SPEED, _RATE)) if math.sqrt(self._motion[part] / self._count) > least]

    def _judge(self, assumed):
        moving = self._moving()
        if not moving:
            return self.verdict
        if self._twist == 0.0:
            return Verdict(MISSING, "the pose moves but the twist is zero throughout; if the source has no twist, use input: pose")
        misfit = {option: math.sqrt(sum(sums[part] / self._motion[part] for part in moving) / len(moving))
                  for option, sums in self._misfit.items()}
        fits = tuple(_name(option) for option, value in misfit.items() if value < _FITS)
        if misfit[assumed] < _FITS:
            return Verdict(OK, f"twist agrees with the differenced pose as {_name(assumed)} (misfit {misfit[assumed]:.2g})", fits, misfit[assumed])
        if misfit[assumed] > FAILS and min(misfit.values()) < _CLEARLY_BETTER * misfit[assumed] and fits:
            return Verdict(WRONG, f"twist read as {_name(assumed)} does not move the pose (misfit {misfit[assumed]:.2g}), "
                                  f"it looks like {' or '.join(fits)}: set twist_frame and convention to match the source", fits, misfit[assumed])
        return Verdict(UNDECIDED, f"twist agrees with the differenced pose in no convention (as {_name(assumed)}: misfit "
                                  f"{misfit[assumed]:.2g})", fits, misfit[assumed])


def _name(option):
    return f"twist_frame {option[0]} in {option[1].upper()}"
