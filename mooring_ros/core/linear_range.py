"""Linear responses about several poses: which one holds, when another one is derived, and how the answer passes from one to the next.

A response holds while its estimated error is below RANGE. Beyond, one that was derived before and whose error is below HYSTERESIS times RANGE
takes over, or a new one is derived where the platform is: one at most in a step. What they differ by there is carried on and fades as the platform
moves, so that the answer has no jump. All depends on the poses gone through alone: the same motion gives the same bits.
"""

from dataclasses import dataclass, replace

import numpy as np

from .linear import LinearResponse, Measure, solutions
from .poses import between, distance
from .readings import Readings

RANGE = 0.01  # estimated error, of fairlead tensions and wrench (linear.Measure), at which another response is looked for
HYSTERESIS = 0.5
FIRST_CHECK = 0.1  # of RANGE: estimated error below which nothing is measured
FADE = 0.5  # of the distance between two responses, over which their difference fades
JUMP = 2.0  # of RANGE: a larger difference is a correction that cannot wait (the platform has jumped, a line has come taut): it is not carried on
KEPT = 32  # responses; the oldest one goes


@dataclass(frozen=True)
class Difference:
    """What the answer had more than the response that took over, at `pose` (M, 7): readings of one row, fading over `length` (m) to `share`."""

    readings: Readings
    size: float  # as an error (linear.Measure)
    pose: np.ndarray
    length: float
    share: float = 1.0


@dataclass(frozen=True)
class LinearRange:
    """The responses derived so far; what is shown is kept[active] and the difference that fades. Nothing in it changes: `follow` gives the next.

    solved: static solutions that the last step took; derived: responses derived since the settle.
    """

    kept: tuple
    active: int = 0
    difference: Difference | None = None
    solved: int = 0
    derived: int = 1

    @property
    def response(self) -> LinearResponse:
        return self.kept[self.active]

    def error(self, pose):
        """Estimated error at `pose` (M, 7), a share: see linear.Measure."""
        rest = self.difference.share * self.difference.size if self.difference else 0.0
        return self.response.error(pose) + rest

    def show(self, state, pose, twist, row, readings):
        """Put the answer at `pose` (M, 7), `twist` (M, 6) into one row of `readings`, and places and tensions of the nodes into `state`."""
        shown = self.response.readings(pose)
        for values, own in zip(readings, shown):
            values[row] = own[0]
        if self.difference is not None:
            for values, rest in zip(readings, self.difference.readings):
                values[row] += self.difference.share * rest[0]
        np.maximum(readings.tension[row], 0.0, out=readings.tension[row])
        readings.length_rate[row] = np.tensordot(twist.ravel(), self.response.slope.length, 1)
        self.response.shape(pose, state)

    def follow(self, pose, solve, derive):
        """The LinearRange with which `pose` (M, 7) is answered.

        solve(pose) gives the true readings of one row; derive(pose) a LinearResponse about it and leaves its State behind.
        """
        after = replace(self, difference=_faded(self.difference, pose, self.response.reach), solved=0)
        here = after.response
        if here.error(pose) > FIRST_CHECK * RANGE and here.far_from_checked(pose):
            here, _ = here.confronted(pose, solve(pose))
            after = replace(after, kept=_put(after.kept, after.active, here), solved=1)
        if here.error(pose) <= RANGE:
            return after
        errors = [response.error(pose) for response in after.kept]
        nearest = int(np.argmin(errors))
        if errors[nearest] <= HYSTERESIS * RANGE:
            return after._take_over(after.kept, nearest, pose)
        response = derive(pose)
        kept = (*after.kept, replace(response, factor=max(response.factor, min(here.factor, 2.0))))
        after = replace(after, solved=after.solved + solutions(len(pose)), derived=after.derived + 1)
        return after._take_over(kept, len(kept) - 1, pose)

    def _take_over(self, kept, active, pose):
        """Let another response take over at `pose`, with the difference to what is shown now carried on."""
        old, new = self.response, kept[active]
        rest = [a - b for a, b in zip(old.readings(pose), new.readings(pose))]
        if self.difference is not None:
            rest = [own + self.difference.share * before for own, before in zip(rest, self.difference.readings)]
        rest = Readings(*rest)._replace(length_rate=np.zeros_like(new.base.length_rate))
        size = new.measure.worst(Measure.values(rest))
        length = max(FADE * distance(between(old.pose, new.pose), new.reach), 1e-9 * new.reach)
        difference = Difference(rest, size, pose.copy(), length) if size <= JUMP * RANGE else None
        if len(kept) > KEPT:
            gone = 0 if active != 0 else 1
            kept, active = kept[:gone] + kept[gone + 1 :], active - (active > gone)
        return replace(self, kept=kept, active=active, difference=difference)


def _faded(difference, pose, reach):
    """A difference after a move to `pose`: it never grows again, and None when nothing is left."""
    if difference is None:
        return None
    left = max(1.0 - distance(between(difference.pose, pose), reach) / difference.length, 0.0) ** 2
    return replace(difference, share=min(difference.share, left)) if left > 0.0 and difference.share > 0.0 else None


def _put(kept, index, response):
    return (*kept[:index], response, *kept[index + 1 :])
