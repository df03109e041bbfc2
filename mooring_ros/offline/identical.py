"""Whether a replay's tensions are those of the recording, bit for bit."""

from collections import defaultdict

import numpy as np
from std_msgs.msg import Float64MultiArray

from .decoded import decoded

TENSIONS = "/line_tensions"


class Identical:
    """Holds a replay against the outputs of a recording; `same` of `total` recorded tension messages came out again.

    A node may answer twice at one stamp (a settle, then a step; a timer that ticks faster than the input), so the recorded ones of a stamp
    are looked for among the replayed ones of that stamp, in their order.
    """

    def __init__(self, entries):
        """entries: the messages of a recording on its topic of tensions."""
        self._recorded = defaultdict(list)
        self._replayed = defaultdict(list)
        self.total = 0
        for entry in entries:
            self._recorded[entry.publish_time].append(np.array(decoded(entry, Float64MultiArray).data).tobytes())
            self.total += 1

    def add(self, stamp, anchor_tension, fairlead_tension):
        """A replayed answer, as it goes out: (L,) N each."""
        if stamp in self._recorded:
            self._replayed[stamp].append(np.column_stack((anchor_tension, fairlead_tension)).tobytes())

    @property
    def same(self):
        return sum(self._found(recorded, self._replayed[stamp]) for stamp, recorded in self._recorded.items())

    @staticmethod
    def _found(recorded, replayed):
        found, position = 0, 0
        for value in recorded:
            if value in replayed[position:]:
                position = replayed.index(value, position)
                found += 1
        return found
