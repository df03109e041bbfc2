"""How late the wrench is, what that does to the platform, and how far the motion is predicted to make up for it (docs/delay.md).

A mooring that answers τ late takes ω τ / 2 of critical damping from a platform that swings at ω with the mooring as its spring.
"""
import array
import math
from collections import deque

from rclpy.serialization import serialize_message
from std_msgs.msg import Float64MultiArray, MultiArrayDimension

MODES = ("off", "given", "measured")
TOPIC = "~/delay"
FIELDS = ("mean (s)", "99th percentile (s)", "predicted (s)", "frequency of the platform (rad/s)", "damping ratio added by the delay",
          "with the prediction")

_KEPT = 2000            # delays for the percentile
_MEAN = 200             # answers that the mean is over
_STRANGE = 10.0         # s: stamps further off are of another clock than the node's
_SLEW = 0.1             # s a second, by which the prediction may change: the core's time goes on, and the motion stays smooth


class Delay:
    """Delays of the answers, by the source's clock, and the lead that makes up for them.

    mode: one of MODES. seconds: in the mode `given` the whole delay; else that on the part of the way that the node cannot see, before the stamp
    and after the wrench. Both may be changed at any time. by_stamps: whether the stamps are of the node's clock; where not, the delay is
    counted from when the input arrived.
    """

    def __init__(self, mode="off", seconds=0.0):
        self.mode, self.seconds = mode, seconds
        self.by_stamps = True
        self.mean = 0.0
        self.lead = 0.0             # s
        self._moment = None
        self._count = 0
        self._delays = deque(maxlen=_KEPT)

    def add(self, moment, out, took):
        """An answer went out. moment: the time of the motion that it was meant for (ns, before the lead). out: when, by the node's clock (ns).
        took: ns since its input arrived."""
        delay = (out - moment) * 1e-9
        self.by_stamps = abs(delay) < _STRANGE
        if not self.by_stamps:
            delay = took * 1e-9
        self._count = min(self._count + 1, _MEAN)
        self.mean += (delay - self.mean) / self._count
        self._delays.append(delay)

    def ahead(self, moment):
        """By how much (ns) the motion is to be predicted at this moment (ns), no earlier than the last."""
        wanted = {"off": 0.0, "given": self.seconds, "measured": max(self.mean, 0.0) + self.seconds}[self.mode]
        passed = math.inf if self._moment is None or self._count == 0 else max(moment - self._moment, 0) * 1e-9
        self._moment = moment
        most = _SLEW * passed
        self.lead += min(max(wanted - self.lead, -most), most)
        return round(self.lead * 1e9)

    @property
    def counted(self):
        """Whether there has been an answer to count."""
        return bool(self._delays)

    @property
    def percentile(self):
        """The 99th percentile (s) of the last delays; 0 when there are none."""
        ordered = sorted(self._delays)
        return ordered[min(int(0.99 * len(ordered)), len(ordered) - 1)] if ordered else 0.0

    def report(self, frequency):
        """Numbers of FIELDS; frequency: rad/s, or None."""
        omega, late = frequency or 0.0, max(self.mean, self.seconds) if self.mode == "given" else self.mean + self.seconds
        return [self.mean, self.percentile, self.lead, omega, -0.5 * omega * late, -0.5 * omega * (late - self.lead)]

    def status(self, frequency):
        """For diagnostics: whether a person should look, words, name -> value; frequency: rad/s, or None."""
        numbers = self.report(frequency)
        values = {name: f"{number + 0.0:.6g}" for name, number in zip(FIELDS, numbers)}
        values |= {"compensate": self.mode, "counted from": "the stamp" if self.by_stamps else "the arrival"}
        words = f"{1e3 * self.mean:.2f} ms" + (f", {1e3 * self.lead:.2f} ms predicted" if self.lead else "")
        if frequency:
            words += f": {100.0 * numbers[-1]:+.2g} % of critical damping at {0.5 * frequency / math.pi:.3g} Hz"
        if not self.by_stamps:
            words += ", from the arrival: the stamps are of another clock than the node's"
        return not self.by_stamps and self.mode == "measured", words, values


def message(numbers):
    """Bytes of a Float64MultiArray with numbers of FIELDS."""
    made = Float64MultiArray(data=array.array("d", numbers))
    made.layout.dim = [MultiArrayDimension(label=", ".join(FIELDS), size=len(FIELDS), stride=len(FIELDS))]
    return serialize_message(made)


class Frequency:
    """At which frequency a platform swings: root of the mean square velocity over that of the distance from the mean place, both horizontal.

    The means are over some three periods. In waves it is theirs rather than the platform's own.
    """

    _MEMORY = 20.0          # rad

    def __init__(self):
        self._last = self._first = None
        self._passed = 0.0
        self._mean = [0.0, 0.0]
        self._square = self._speed = 0.0

    def add(self, moment, pose, twist):
        """The motion at a moment (s): pose (7,), twist (6,)."""
        if self._last is None or moment <= self._last:
            self.__init__()
            self._last, self._first = moment, pose[:2]
            return
        dt, self._last = moment - self._last, moment
        self._passed += dt
        omega = self._now()
        share = dt / min(self._passed, self._MEMORY / omega if omega else math.inf)
        off = [x - first for x, first in zip(pose, self._first)]
        self._mean = [mean + share * (x - mean) for mean, x in zip(self._mean, off)]
        self._square += share * (off[0] ** 2 + off[1] ** 2 - self._square)
        self._speed += share * (twist[0] ** 2 + twist[1] ** 2 - self._speed)

    def _now(self):
        spread = self._square - self._mean[0] ** 2 - self._mean[1] ** 2
        return math.sqrt(self._speed / spread) if spread > 1e-9 * self._square and self._speed > 0.0 else 0.0

    @property
    def value(self):
        """rad/s, or None before about one period has passed."""
        # of a motion that only goes on in one direction, this is the root of 12
        now = self._now()
        return now if now * self._passed > 2.0 * math.pi else None


class Fastest:
    """The Frequency of that platform of several which swings fastest: of those that the lines alone hold back, it loses most of its damping."""

    def __init__(self, platforms=1):
        self._each = [Frequency() for _ in range(platforms)]

    def add(self, moment, motions):
        """The motions at a moment (s): (pose (7,), twist (6,)) of every platform."""
        for frequency, motion in zip(self._each, motions):
            frequency.add(moment, *motion)

    @property
    def value(self):
        """rad/s, or None before about one period of any has passed."""
        return max((own.value for own in self._each if own.value), default=None)
