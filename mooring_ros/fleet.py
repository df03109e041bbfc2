"""Many moorings at once, each with its own platform, or its own platforms: a wind farm, a search over sea states, an ensemble."""

import itertools
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from .arguments import checked_poses, checked_twists, numbers, shaped
from .core.explicit import DONE
from .core.fleet import Member, advance_many, collect, read_clocks, run_address
from .core.model import new_scratch
from .errors import MooringError
from .mooring import Mooring
from .scene import Scene

BLOCKS = 8  # that every thread finds to do: what one has left, another one takes
SAMPLES = 64  # that a mooring is advanced by before the next one: it stays in the processor's cache for as long
ALONE = -1  # status of members that the kernel does not serve
MOST_NAMED = 5  # moorings that a message tells of


@dataclass(frozen=True)
class FleetHistory:
    """Readings of many samples of many moorings; k samples, world frame. Lines of mooring m are first_line[m] to first_line[m + 1] - 1."""

    time: np.ndarray  # (k,) s
    wrench: np.ndarray  # (k, moorings, 6) N, N m; (k, moorings, platforms, 6) of platforms with names
    anchor_tension: np.ndarray  # (k, all lines) N
    fairlead_tension: np.ndarray  # (k, all lines) N
    first_line: np.ndarray  # (moorings + 1,)


class Fleet:
    """Many moorings, each with the motion of its own platform (or platforms), advanced together on all cores.

    members: scenes, paths of scenes, or Moorings; a scene that occurs again shares all that does not change. threads: None for one on each core that
    the process may use. Further arguments are those of `Mooring`, for the members that are built here. All members have the same number of `platforms`,
    and an axis for them where these have names: poses (moorings, platforms, 7), twists and wrenches (moorings, platforms, 6).

    What comes out has the bits of single Moorings. Members (`fleet[m]`) are Moorings like others, to be read, and between two calls also to be moved by themselves.
    Raises what Mooring raises.
    """

    def __init__(self, members, threads=None, **options):
        if threads is not None and not float(shaped(threads, (), "threads", "a whole number")) in range(1, 1025):
            raise ValueError(f"threads is {threads!r}; expected a whole number from 1 to 1024, or None")
        self.moorings = tuple(_built(list(members), options))
        if not self.moorings:
            raise ValueError("a fleet of no moorings; expected one at least")
        self._axis = _axis_of_platforms(self.moorings)  # (platforms,), () where they have no names
        self.threads = min(int(threads or len(os.sched_getaffinity(0))), len(self.moorings))
        self.first_line = np.concatenate([[0], np.cumsum([len(mooring.line_names) for mooring in self.moorings])])
        count, lines = len(self.moorings), int(self.first_line[-1])
        self._models = [None] * count  # for which the members are packed
        self._members, self._packed = np.zeros(count, dtype=np.int64), [None] * count
        self._shown = np.zeros((1, count, *(self._axis or (1,)), 6)), np.zeros((1, lines, 2))
        self._clocks, self._status = np.zeros(count), np.zeros((count, 2), dtype=np.int64)
        self._alone = [m for m, mooring in enumerate(self.moorings) if not _served(mooring)]
        self._together = sorted(set(range(count)) - set(self._alone))
        self._pool = ThreadPoolExecutor(self.threads - 1) if self.threads > 1 else None
        self._share_work_space()
        self._pack()
        self._stepper = run_address(self._packed[self._together[0]], self._scratches[0][0]) if self._together else 0

    def __len__(self):
        return len(self.moorings)

    def __getitem__(self, m):
        return self.moorings[m]

    # -- doing ------------------------------------------------------------------------------------------------------------------------

    def settle(self, poses, time=0.0):
        """Static equilibrium with the platforms at rest at poses (7,), the same for all, or (moorings, 7); of platforms with names (platforms, 7), or
        (moorings, platforms, 7). Equal scenes at equal poses are settled once."""
        poses = numbers(poses, "poses")
        poses = self._of_all(np.stack([poses] * len(self)) if poses.shape == (*self._axis, 7) else poses, 7, "poses")
        done = {}
        for m in self._alone:
            self.moorings[m].settle(poses[m], time)
        for m in self._together:
            mooring, pose, state = self.moorings[m], poses[m], self.moorings[m]._state
            key = id(mooring._model), pose.tobytes(), state.end_point.tobytes(), state.failed.tobytes()
            if key not in done:
                mooring.settle(pose, time)
                done[key] = mooring, mooring.snapshot()
            else:
                first, saved = done[key]
                mooring.restore(saved)
                mooring.static_result, mooring.warnings = first.static_result, first.warnings

    def step(self, t, poses, twists):
        """Advance all to `t` (s), where the platforms have poses (moorings, 7) and twists (moorings, 6), or a row for each platform, as `Mooring.step` does.

        ValueError for bad input leaves all as they were. A mooring whose step cannot be completed stays where it was, the others go on:
        MooringError names those that did not, and its attribute `failed` holds their numbers and messages.
        """
        t = float(shaped(t, (), "t", "seconds"))
        poses, twists = self._of_all(poses, 7, "poses"), self._of_all(twists, 6, "twists")
        self._run(np.array([t]), checked_poses(poses)[None], checked_twists(twists)[None], *self._shown)

    def run(self, times, poses, twists):
        """`step` through many samples, with the same bits: times (k,), poses (k, moorings, 7), twists (k, moorings, 6), or a row for each platform. Returns a FleetHistory.

        When some cannot be completed, the others go to the end all the same; MooringError has the attributes `failed` (see `step`) and
        `history`, of the samples that all have done.
        """
        times = numbers(times, "times").reshape(-1)
        poses, twists = numbers(poses, "poses"), numbers(twists, "twists")
        k, count = times.size, len(self)
        if poses.shape != (k, count, *self._axis, 7) or twists.shape != (k, count, *self._axis, 6):
            each = ", ".join(f"(k, {', '.join(map(str, (count, *self._axis, width)))})" for width in (7, 6))
            raise ValueError(f"times {times.shape}, poses {poses.shape}, twists {twists.shape}; expected (k,), {each}")
        wrench, tension = np.zeros((k, *self._shown[0].shape[1:])), np.zeros((k, int(self.first_line[-1]), 2))
        try:
            if k:
                self._run(times, checked_poses(poses), checked_twists(twists), wrench, tension)
        except MooringError as error:
            error.history = self._history(times, wrench, tension, error.samples)
            raise
        return self._history(times, wrench, tension, k)

    # -- reading ----------------------------------------------------------------------------------------------------------------------

    @property
    def wrenches(self):
        """(moorings, 6) N and N m of each mooring on its platform, about its reference point, world frame; (moorings, platforms, 6) of platforms with names."""
        return self._outside(self._collected()[0][0]).copy()

    @property
    def fairlead_tension(self):
        """(all lines,) N; lines of mooring m are first_line[m] to first_line[m + 1] - 1."""
        return self._collected()[1][0, :, 1].copy()

    @property
    def anchor_tension(self):
        """(all lines,) N."""
        return self._collected()[1][0, :, 0].copy()

    # -- inside -----------------------------------------------------------------------------------------------------------------------

    def _share_work_space(self):
        """One work space for each thread and shape of moorings."""
        kinds, self._kinds, self._scratches = {}, np.zeros(len(self), dtype=np.int64), []
        for m in self._together:
            mooring = self.moorings[m]
            shape = tuple(array.shape for array in mooring._scratch)
            self._kinds[m] = kinds.setdefault(shape, len(kinds))
            if self._kinds[m] == len(self._scratches):
                self._scratches.append([new_scratch(mooring._model) for _ in range(self.threads)])
        self._spaces = np.array([[space.address for space in spaces] for spaces in self._scratches], dtype=np.int64).T.copy()

    def _pack(self):
        """Pack what has been built again since the last call: a winch makes a new model."""
        for m in self._together:
            mooring = self.moorings[m]
            if self._models[m] is not mooring._model:
                self._models[m] = mooring._model
                self._packed[m] = Member(mooring._model, mooring._state, mooring._table, mooring._report, mooring._readings)
                self._members[m] = self._packed[m].address

    def _of_all(self, values, width, name):
        return shaped(values, (len(self), *self._axis, width), name, "a row for each mooring" + (", and in it one for each platform" if self._axis else ""))

    def _outside(self, wrench):
        """Wrenches (..., moorings, platforms, 6) as users see them: without the axis where the platforms have no names."""
        return wrench if self._axis else wrench[..., 0, :]

    def _need_settled(self):
        waiting = [m for m in self._together if not self.moorings[m]._settled]
        if waiting:
            raise ValueError(f"moorings {_some(waiting)} have not been settled; call settle(poses) first")
        self._pack()

    def _run(self, times, poses, twists, wrench, tension):
        """Advance all; poses and twists as in `run`, checked; wrench and tension as in core.fleet."""
        self._need_settled()
        if self._alone:
            self._clocks[:] = [mooring.time for mooring in self.moorings]
        else:
            read_clocks(self._members, self._clocks)
        if not (np.isfinite(times).all() and (np.diff(times) > 0.0).all() and times[0] > self._clocks.max()):
            raise ValueError(f"times must be finite, grow, and be after the present one, {self._clocks.max()!r} s; the first is {times[0]!r} s")
        self._status[:, 0] = DONE
        failed = {}
        for m in self._alone:
            self._status[m] = ALONE, 0
            self._run_alone(m, times, poses[:, m], twists[:, m], wrench[:, m], tension[:, self.first_line[m] : self.first_line[m + 1]], failed)
        for start in range(0, len(times), SAMPLES):
            rows = slice(start, start + SAMPLES)
            ways = [np.ascontiguousarray(values[rows].swapaxes(0, 1)) for values in (poses, twists)]
            ways = [values.reshape(*values.shape[:2], 1, -1, values.shape[-1]) for values in ways]
            self._advance(times[rows, None], *ways, wrench[rows], tension[rows])
            for m in np.flatnonzero(self._status[:, 0] != DONE).tolist():
                if m not in failed and self._status[m, 0] != ALONE:
                    sample = start + int(self._status[m, 1])
                    failed[m] = sample, self._why(m, times[sample], poses[sample, m], twists[sample, m])
        if failed:
            told = " ".join(f"Mooring {m}: {failed[m][1]}." for m in sorted(failed)[:MOST_NAMED])
            error = MooringError(f"{len(failed)} of {len(self)} moorings could not be advanced. {told}")
            error.failed = {m: message for m, (_, message) in sorted(failed.items())}
            error.samples = min(sample for sample, _ in failed.values())
            raise error

    def _advance(self, times, poses, twists, wrench, tension):
        """The kernel on all cores: blocks of members, taken by whoever is free."""
        blocks = np.linspace(0, len(self), min(self.threads * BLOCKS, len(self)) + 1 if self.threads > 1 else 2).astype(int).tolist()
        tickets = itertools.count()

        def work(thread):
            spaces = self._spaces[thread]
            while (block := next(tickets)) < len(blocks) - 1:
                advance_many(
                    self._stepper, self._members, self._kinds, spaces, blocks[block], blocks[block + 1],
                    times, poses, twists, self.first_line, self._status, wrench, tension,
                )  # fmt: skip

        waiting = [self._pool.submit(work, thread) for thread in range(1, self.threads)]
        work(0)
        for other in waiting:
            other.result()

    def _run_alone(self, m, times, poses, twists, wrench, tension, failed):
        """A member that the stepping kernel does not serve."""
        mooring = self.moorings[m]
        for j, (time, pose, twist) in enumerate(zip(times.tolist(), poses, twists)):
            try:
                mooring.step(time, pose, twist)
            except MooringError as error:
                failed[m] = j, str(error)
                return
            wrench[j], tension[j, :, 0], tension[j, :, 1] = mooring.wrench, mooring.anchor_tension, mooring.fairlead_tension

    def _why(self, m, time, pose, twist):
        """What mooring m has to say of a step that it refuses: it is asked once more."""
        try:
            self.moorings[m].step(time, pose, twist)
        except MooringError as error:
            return str(error)
        return f"the step to t = {time:.6g} s was refused by the fleet's kernel alone"

    def _collected(self):
        self._need_settled()
        wrench, tension = self._shown
        if self._alone:
            wrench[0] = np.reshape([mooring.wrench for mooring in self.moorings], wrench.shape[1:])
            for side, name in enumerate(("anchor_tension", "fairlead_tension")):
                tension[0, :, side] = np.concatenate([getattr(mooring, name) for mooring in self.moorings])
        else:
            collect(self._members, self.first_line, wrench, tension)
        return self._shown

    def _history(self, times, wrench, tension, done):
        return FleetHistory(times[:done].copy(), self._outside(wrench[:done]), tension[:done, :, 0], tension[:done, :, 1], self.first_line.copy())


def _served(mooring):
    """Whether the stepping kernel does all that a step of `mooring` does."""
    return type(mooring) is Mooring and (mooring.fidelity, mooring.solver) == ("dynamic", "explicit")


def _built(members, options):
    """Moorings of `members`; scenes that occur again become twins of their first one."""
    firsts = {}  # by path, or by identity of the Scene
    for m, member in enumerate(members):
        if isinstance(member, Mooring):
            if options:
                raise ValueError(f"member {m} is a Mooring already; {', '.join(options)} can be given for scenes only")
            yield member
            continue
        key = id(member) if isinstance(member, Scene) else str(member)
        if key in firsts:
            yield firsts[key].twin()
        else:
            firsts[key] = Mooring(member, **options)
            yield firsts[key]


def _axis_of_platforms(moorings):
    """(platforms,) of moorings, or () where these have no names. Raises ValueError when not all are alike."""
    axes = [() if mooring.platforms is None else (len(mooring.platforms),) for mooring in moorings]
    for m, axis in enumerate(axes):
        if axis != axes[0]:
            has = [f"platforms {', '.join(names)}" if names else "one platform without a name" for names in (moorings[0].platforms, moorings[m].platforms)]
            raise ValueError(f"member 0 has {has[0]}, member {m} {has[1]}; expected the same number of platforms in all, with names or without")
    return axes[0]


def _some(numbers_):
    """The first few of a list of numbers, in words."""
    text = ", ".join(map(str, numbers_[:MOST_NAMED]))
    return text if len(numbers_) <= MOST_NAMED else f"{text} and {len(numbers_) - MOST_NAMED} more"
