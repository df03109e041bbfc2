"""A mooring of very many lines: blocks of lines that fit the processor's cache, each advanced through many samples, on all cores.

Lines that nothing but the platforms and the ground join do not feel each other. A step over all of them reads every array from the memory
again and again; block by block it stays in the cache, and a block where lines snap takes finer steps by itself.
"""

import os
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy as np

from .core.layout import Layout
from .errors import MooringError
from .mixed import Group, MixedMooring
from .mooring import Mooring
from .platforms import Platforms
from .scene.cutting import cut, joints
from .scene.grouping import group_of_each, times_segments

LARGE = 6000  # nodes from which a mooring is cut
BLOCK = 1500  # nodes of a block, where joints allow: some 60 numbers of 8 bytes each fit a cache of 1 MB
KEPT = 256  # samples after which the state is kept anew, to go back to when a step fails


def is_large(scene, segments=None, refine=1.0):
    """Whether a scene has so many nodes, in lines that can be solved apart, that it is better cut. Bad numbers are for Mooring to refuse."""
    try:
        counts = _counts(scene, segments, refine)
    except (TypeError, ValueError, OverflowError):
        return False
    return sum(counts) + len(counts) >= LARGE and len(_blocks(scene, counts)) > 1


def _counts(scene, segments, refine):
    return [times_segments(refine, line.segments) if segments is None else int(segments) for line in scene.lines]


def _blocks(scene, counts):
    """Names of the lines of each block: what a joint holds together stays together."""
    number = {line.name: k for k, line in enumerate(scene.lines)}
    links = ((number[first], number[other]) for _, (first, *others) in joints(scene) for other in others)
    joined = {}
    for line, count, group in zip(scene.lines, counts, group_of_each(len(scene.lines), links)):
        lines = joined.setdefault(group, [[], 0])
        lines[0].append(line.name)
        lines[1] += count + 1
    blocks, room = [], 0
    for names, nodes in joined.values():
        if nodes > room or not blocks:
            blocks.append(set())
            room = BLOCK
        blocks[-1].update(names)
        room -= nodes
    return blocks


class BlockMooring(MixedMooring):
    """A dynamic `Mooring` of many lines, as `Mooring(scene)` makes it from LARGE nodes on: in blocks, each a Mooring of its own."""

    def __init__(self, scene, fidelity="dynamic", solver="auto", dt=None, segments=None, refine=1.0, *, platforms=None, **settings):
        self.fidelity = fidelity
        self.line_names = [line.name for line in self.scene.lines]
        self.platforms = Platforms(platforms, self.scene).names
        self.coupled_names = Layout(self.scene, self.platforms or ()).outputs
        blocks = _blocks(self.scene, _counts(self.scene, segments, refine))
        line_of, output_of = ({name: k for k, name in enumerate(names)} for names in (self.line_names, self.coupled_names))
        self._groups, self._home = [], {}
        for part in cut(self.scene, blocks, self.platforms or ()):
            mooring = Mooring(part, fidelity, solver, dt, segments, refine, platforms=self.platforms, **settings)
            lines, outputs = (np.array([of[name] for name in names], dtype=int) for of, names in ((line_of, mooring.line_names), (output_of, mooring.coupled_names)))
            self._groups.append(Group(fidelity, mooring, lines, outputs))
            self._home.update(dict.fromkeys(mooring.line_names, len(self._groups) - 1))
        self._begin()
        self.solver, self.choice = self._fullest.solver, self._fullest.choice
        self.segments = self._by_line(lambda mooring: np.array(mooring.segments)).tolist()

    def _begin(self):
        self._fullest = self._groups[0].mooring
        self._pool = ThreadPoolExecutor(min(len(os.sched_getaffinity(0)), len(self._groups)))
        self._kept, self._since = None, []

    # -- doing ------------------------------------------------------------------------------------------------------------------------

    def settle(self, pose, time=0.0):
        self._kept = None
        super().settle(pose, time)

    def step(self, t, pose, twist):
        self._keep()
        errors = [error for error in self._pool.map(partial(_tried, "step", t, pose, twist), self._moorings) if error is not None]
        if errors:
            self._go_back(errors[0])
            raise errors[0]
        self._since.append((np.array([t], dtype=float), np.array([pose], dtype=float), np.array([twist], dtype=float)))

    def run(self, times, poses, twists):
        self._keep()
        found = list(self._pool.map(partial(_tried, "run", times, poses, twists), self._moorings))
        errors = [error for error in found if isinstance(error, Exception)]
        if errors:
            first = min(errors, key=lambda error: error.samples if isinstance(error, MooringError) else -1)
            self._go_back(first)
            if isinstance(first, MooringError):
                first.history = self.run(times[: first.samples], poses[: first.samples], twists[: first.samples])
            raise first
        self._since.append(tuple(np.array(values, dtype=float) for values in (times, poses, twists)))
        return self._merged(found)

    def release(self, line_name):
        self._kept = None
        super().release(line_name)

    def set_unstretched_length(self, line_name, length):
        self._kept = None
        super().set_unstretched_length(line_name, length)

    def restore(self, saved):
        self._kept = None
        super().restore(saved)

    def twin(self):
        other = object.__new__(BlockMooring)
        other.__dict__.update(self.__dict__)
        other._groups = [Group(group.fidelity, group.mooring.twin(), group.lines, group.outputs) for group in self._groups]
        other._begin()
        return other

    @property
    def step_limit(self):
        """That of the block with the smallest one."""
        return min((mooring.step_limit for mooring in self._moorings), key=lambda limit: limit.dt)

    # -- inside -----------------------------------------------------------------------------------------------------------------------

    def _of(self, line_name):
        if line_name not in self._home:
            raise ValueError(f"there is no line {line_name!r}; expected one of {', '.join(self.line_names)}")
        return self._groups[self._home[line_name]].mooring

    def _keep(self):
        """Have a state to go back to, and what has been done since."""
        if self._kept is None or sum(len(times) for times, _, _ in self._since) >= KEPT:
            self._kept, self._since = self.snapshot(), []

    def _go_back(self, error):
        """Undo a step that some blocks have done and others could not: from what was kept, what has been done since is done again, to the same bits."""
        if not isinstance(error, MooringError):
            return  # bad input: no block has moved
        kept, since = self._kept, self._since
        self.restore(kept)
        for motion in since:
            list(self._pool.map(partial(_tried, "run", *motion), self._moorings))
        self._kept, self._since = kept, since


def _tried(what, times, poses, twists, mooring):
    """What `mooring.step` or `.run` returns, or the error that it raises."""
    try:
        return getattr(mooring, what)(times, poses, twists)
    except (MooringError, ValueError) as error:
        return error
