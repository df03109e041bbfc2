"""A mooring whose lines have fidelities of their own: one mooring for each fidelity, on the same platforms."""

from dataclasses import dataclass, field, fields

import numpy as np

from .core.layout import Layout
from .errors import MooringError
from .fidelity import of_lines
from .history import History
from .mooring import Mooring, Snapshot
from .platforms import Platforms
from .scene import Scene, load_scene
from .scene.cutting import cut, joints

ORDER = ("quasi_static", "linear", "dynamic")  # in which they are stepped: a dynamic step that fails changes nothing, so it comes last


@dataclass(frozen=True)
class MixedSnapshot:
    """Snapshots of the moorings of all fidelities; opaque, for `restore`."""

    parts: tuple[Snapshot, ...] = field(repr=False)


@dataclass(frozen=True)
class Group:
    """The lines of one fidelity. lines, outputs: indices of its lines and of its coupled points, rods and bodies in the whole mooring."""

    fidelity: str
    mooring: Mooring
    lines: np.ndarray
    outputs: np.ndarray


class MixedMooring(Mooring):
    """A `Mooring` with a fidelity for each line, as `Mooring(scene, fidelity={"line1": "dynamic", "default": "linear"})` makes it.

    fidelity: dict of line name -> fidelity, all lines. Lines that a free point, a rod, a free body or a failure joins share one fidelity: ValueError
    names them otherwise. What cannot be asked of one fidelity (`error_estimate`) is the worst of those that know it.
    """

    def __init__(self, scene, fidelity, *positional, platforms=None, **settings):
        self.scene = scene if isinstance(scene, Scene) else load_scene(scene)
        self.platforms = Platforms(platforms, self.scene).names
        self.line_names = [line.name for line in self.scene.lines]
        self.fidelity = of_lines(fidelity, self.line_names)
        self._refuse_joints()
        chosen = [one for one in ORDER if one in self.fidelity.values()]
        names = [{name for name, own in self.fidelity.items() if own == one} for one in chosen]
        self.coupled_names = Layout(self.scene, self.platforms or ()).outputs
        # what stands alone goes where the physics are fullest
        scenes = cut(self.scene, names[::-1], self.platforms or ())[::-1]
        self._groups = [self._group(part, one, positional, settings) for one, part in zip(chosen, scenes)]
        self._fullest = self._groups[-1].mooring
        self.solver, self.choice = self._fullest.solver, self._fullest.choice
        self.segments = self._by_line(lambda mooring: np.array(mooring.segments)).tolist()

    def _refuse_joints(self):
        for joint, lines in joints(self.scene):
            if len({self.fidelity[name] for name in lines}) > 1:
                each = ", ".join(f"{name} {self.fidelity[name]}" for name in lines)
                raise ValueError(f"fidelity: {joint} joins lines of different fidelities ({each}); expected one fidelity for them")

    def _group(self, scene, fidelity, positional, settings):
        mooring = Mooring(scene, fidelity, *positional, platforms=self.platforms, **settings)
        lines, outputs = ([all_names.index(name) for name in names]
                          for all_names, names in ((self.line_names, mooring.line_names), (self.coupled_names, mooring.coupled_names)))  # fmt: skip
        return Group(fidelity, mooring, np.array(lines, dtype=int), np.array(outputs, dtype=int))

    @property
    def _moorings(self):
        return [group.mooring for group in self._groups]

    # -- doing ------------------------------------------------------------------------------------------------------------------------

    def settle(self, pose, time=0.0):
        self._all_or_none(lambda mooring: mooring.settle(pose, time))

    def step(self, t, pose, twist):
        self._all_or_none(lambda mooring: mooring.step(t, pose, twist))

    def _all_or_none(self, act):
        """Do something to all moorings; when one cannot, those before it go back."""
        *before, last = self._moorings
        done = []
        try:
            for mooring in before:
                done.append((mooring, mooring.snapshot()))
                act(mooring)
            act(last)
        except (MooringError, ValueError):
            for mooring, saved in done:
                mooring.restore(saved)
            raise

    def run(self, times, poses, twists):
        start = self.snapshot()
        try:
            return self._merged([mooring.run(times, poses, twists) for mooring in self._moorings])
        except MooringError as error:
            failure = error
        done = None
        while done is None:
            # the others stop where the failing one did, or before, if they fail there
            done = len(failure.history.time)
            self.restore(start)
            try:
                histories = [mooring.run(times[:done], poses[:done], twists[:done]) for mooring in self._moorings]
            except MooringError as error:
                failure, done = error, None
        failure.history = self._merged(histories)
        raise failure

    def release(self, line_name):
        self._of(line_name).release(line_name)

    def set_unstretched_length(self, line_name, length):
        self._of(line_name).set_unstretched_length(line_name, length)

    def snapshot(self):
        return MixedSnapshot(tuple(mooring.snapshot() for mooring in self._moorings))

    def restore(self, saved):
        if not isinstance(saved, MixedSnapshot) or len(saved.parts) != len(self._groups):
            raise ValueError("this is not a snapshot of a mooring like this one")
        before = self.snapshot()
        try:
            for mooring, part in zip(self._moorings, saved.parts):
                mooring.restore(part)
        except ValueError:
            for mooring, part in zip(self._moorings, before.parts):
                mooring.restore(part)
            raise

    def twin(self):
        other = object.__new__(MixedMooring)
        other.__dict__.update(self.__dict__)
        other._groups = [Group(group.fidelity, group.mooring.twin(), group.lines, group.outputs) for group in self._groups]
        other._fullest = other._groups[-1].mooring
        return other

    # -- reading ----------------------------------------------------------------------------------------------------------------------

    @property
    def warnings(self):
        """Of the scene and of all its fidelities, each once."""
        return tuple(dict.fromkeys((*self.scene.warnings, *(warning for mooring in self._moorings for warning in mooring.warnings))))

    @property
    def step_limit(self):
        """That of the dynamic lines, if there are any."""
        return self._fullest.step_limit

    @property
    def static_result(self):
        """The one of all fidelities that is farthest from what was asked for."""
        found = [mooring.static_result for mooring in self._moorings]
        return None if None in found else max(found, key=lambda result: (not result.converged, result.residual / max(result.tolerance, 1e-300)))

    @property
    def last_step(self):
        steps = [mooring.last_step for mooring in self._moorings]
        return {
            "evaluations": sum(step["evaluations"] for step in steps),
            "steps": max(step["steps"] for step in steps),
            "retries": sum(step["retries"] for step in steps),
            "uneven": sum(step["uneven"] for step in steps),
            "dt": min((step["dt"] for step in steps if step["dt"] > 0.0), default=0.0),
        }

    @property
    def time(self):
        return self._fullest.time

    @property
    def pose(self):
        return self._fullest.pose

    @property
    def platform_of_coupled(self):
        found = dict(pair for mooring in self._moorings for pair in zip(mooring.coupled_names, mooring.platform_of_coupled))
        return [found[name] for name in self.coupled_names]

    @property
    def pose_in_file(self):
        return self._fullest.pose_in_file

    @property
    def twist(self):
        return self._fullest.twist

    @property
    def wrench(self):
        return sum(mooring.wrench for mooring in self._moorings)

    @property
    def fairlead_tension(self):
        return self._by_line(lambda mooring: mooring.fairlead_tension)

    @property
    def anchor_tension(self):
        return self._by_line(lambda mooring: mooring.anchor_tension)

    @property
    def fairlead_end_force(self):
        return self._by_line(lambda mooring: mooring.fairlead_end_force)

    @property
    def anchor_end_force(self):
        return self._by_line(lambda mooring: mooring.anchor_end_force)

    @property
    def stretched_length(self):
        return self._by_line(lambda mooring: mooring.stretched_length)

    @property
    def length_rate(self):
        return self._by_line(lambda mooring: mooring.length_rate)

    @property
    def unstretched_length(self):
        return self._by_line(lambda mooring: mooring.unstretched_length)

    @property
    def coupled_wrenches(self):
        return self._at_outputs([mooring.coupled_wrenches for mooring in self._moorings])

    def node_positions(self, line_name):
        return self._of(line_name).node_positions(line_name)

    def node_tension(self, line_name):
        return self._of(line_name).node_tension(line_name)

    def node_curvature(self, line_name):
        return self._of(line_name).node_curvature(line_name)

    def rod_positions(self, rod_name):
        for mooring in self._moorings:
            if any(rod.name == rod_name for rod in mooring.scene.rods):
                return mooring.rod_positions(rod_name)
        raise ValueError(f"there is no rod {rod_name!r}; expected one of {', '.join(rod.name for rod in self.scene.rods) or 'none: the scene has no rods'}")

    @property
    def body_poses(self):
        poses = {name: pose for mooring in self._moorings for name, pose in mooring.body_poses.items()}
        return {body.name: poses[body.name] for body in self.scene.bodies}

    def stiffness(self):
        return sum(mooring.stiffness() for mooring in self._moorings)

    @property
    def error_estimate(self):
        known = [mooring.error_estimate for mooring in self._moorings]
        return max((error for error in known if error is not None), default=None)

    @property
    def energy(self):
        own = [mooring.energy for mooring in self._moorings]
        return type(own[0])(*(sum(values) for values in zip(*own)))

    # -- inside -----------------------------------------------------------------------------------------------------------------------

    def _of(self, line_name):
        """The mooring that has a line."""
        if line_name not in self.line_names:
            raise ValueError(f"there is no line {line_name!r}; expected one of {', '.join(self.line_names)}")
        return next(group.mooring for group in self._groups if group.fidelity == self.fidelity[line_name])

    def _by_line(self, read):
        """Values (lines, ...) of all lines, from those of each group."""
        return self._in_order([read(mooring) for mooring in self._moorings], axis=0)

    def _in_order(self, values, axis):
        """Values of the groups' lines along an axis, in the order of all lines."""
        return np.take(np.concatenate(values, axis=axis), np.argsort(np.concatenate([group.lines for group in self._groups])), axis=axis)

    def _at_outputs(self, values):
        """Wrenches (..., outputs, 6) from those at each group's outputs: they add up where a point or a body holds lines of several."""
        total = np.zeros((*values[0].shape[:-2], len(self.coupled_names), 6))
        for group, own in zip(self._groups, values):
            total[..., group.outputs, :] += own
        return total

    def _merged(self, histories):
        whole = {"time": histories[0].time, "wrench": sum(history.wrench for history in histories)}
        whole["uneven"] = sum(history.uneven for history in histories)
        whole["coupled_wrenches"] = self._at_outputs([history.coupled_wrenches for history in histories])
        for one in fields(History):
            if one.name not in whole:
                whole[one.name] = self._in_order([getattr(history, one.name) for history in histories], axis=1)
        return History(**whole)
