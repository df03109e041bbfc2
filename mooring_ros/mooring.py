"""The façade: one mooring, for the live node, the replay and Python alike."""

import copy
import hashlib
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from .arguments import checked_poses, checked_twists, numbers, shaped
from .choice import choose_solver
from .core import explicit, implicit
from .core.bending_readings import curvature as curvature_of_nodes
from .core.energy import energy
from .core.forces import evaluate_once
from .core.guard import FASTEST
from .core.layout import Layout
from .core.linear import linearise
from .core.linear_range import LinearRange
from .core.model import LOOSE, State, build, new_scratch, new_state
from .core.readings import new_readings, observe
from .core.schemes import LEAPFROG, step_table
from .core.stability import step_limit
from .core.platform import rotate
from .core.statics import StaticSolver
from .core.waves import waken
from .equilibria import Equilibria, copied
from .errors import MooringError
from .fidelity import EXPECTED, FIDELITIES, is_by_line
from .history import History
from .platforms import Platforms
from .scene import COUPLED, Scene, load_scene
from .scene.grouping import times_segments

SOLVERS = ("auto", "explicit", "implicit")
MOST_SEGMENTS = 100_000  # of a line
MOST_STRAIN = 1.0  # of a line in motion, or twice that of the settled one


@dataclass(frozen=True)
class Snapshot:
    """A copy of everything that changes in a mooring; opaque, for `Mooring.restore`."""

    mooring: str
    state: State = field(repr=False)
    readings: tuple = field(repr=False)
    settled: bool
    linear: LinearRange | None = field(repr=False)
    lengths: tuple


class Mooring:
    """Mooring lines between the ground and a moving platform.

    scene: path of a MoorDyn v2 file, or a `Scene`. fidelity: "dynamic", or "quasi_static": equilibrium at every sample, without inertia, damping
    and drag of the motion, or "linear": the 6 x 6 stiffness, and tensions to first order, about the last settled pose, and about others where the
    platform leaves the range of that (see `error_estimate`); dt has no meaning in these two. Line by line: {"line1": "dynamic", "default": "linear"},
    or the text "line1=dynamic,default=linear" (mixed.py). solver: "auto", "explicit" or "implicit" (docs/solvers.md). dt: largest step of the solver
    (s), None for the largest that is stable, or of the implicit solver one that follows the motion; of the explicit one a dt beyond is not taken.
    spectral_radius: of the implicit solver, 0..1: the share of waves too quick for the step that a step leaves. segments: segments of every line, None for the file's; refine: the file's
    segments of each line times this, rounded, where lines of unlike lengths share a mesh. platforms: names of the coupled bodies that move by themselves,
    each a platform with the body's pose (docs/platforms.md); None for one platform, which carries all that is coupled.

    pose is (7,): x, y, z (m) and a unit quaternion x, y, z, w; twist is (6,): velocity (m/s) of the reference point and angular velocity
    (rad/s); all in the world frame, z up from the still water level. With `platforms`, pose, twist and wrench are (platforms, 7) and (platforms, 6),
    whatever is said of (7,) and (6,) here. A line's fairlead is its coupled end, or, where none is coupled, the one that is not fixed (end B if both
    are alike).
    Raises SceneError for a bad scene, ValueError for bad arguments; MooringError when a computation cannot be completed.
    """

    def __new__(cls, scene=None, fidelity="dynamic", solver="auto", dt=None, segments=None, refine=1.0, *_, **__):
        if cls is not Mooring or scene is None:
            return object.__new__(cls)
        if is_by_line(fidelity):
            from .mixed import MixedMooring

            return object.__new__(MixedMooring)
        from .blocks import BlockMooring, is_large

        scene = scene if isinstance(scene, Scene) else load_scene(Path(scene))
        large = fidelity == "dynamic" and solver != "implicit" and is_large(scene, segments, refine)
        made = object.__new__(BlockMooring if large else cls)
        made.scene = scene
        return made

    def __init__(self, scene, fidelity="dynamic", solver="auto", dt=None, segments=None, refine=1.0, spectral_radius=implicit.SPECTRAL_RADIUS, platforms=None):
        if fidelity not in FIDELITIES:
            raise ValueError(f"fidelity {fidelity!r} is not built; expected {EXPECTED}")
        if solver not in SOLVERS:
            raise ValueError(f"solver {solver!r} is not built; expected one of {', '.join(SOLVERS)}")
        if dt is not None and not 0.0 < float(shaped(dt, (), "dt", "seconds")) < np.inf:
            raise ValueError(f"dt is {dt!r}; expected a positive number of seconds, or None")
        if segments is not None and not float(shaped(segments, (), "segments", "a whole number")) in range(1, MOST_SEGMENTS + 1):
            raise ValueError(f"segments is {segments!r}; expected a whole number from 1 to {MOST_SEGMENTS}, or None")
        if not 0.0 < float(shaped(refine, (), "refine", "a factor")) < np.inf:
            raise ValueError(f"refine is {refine!r}; expected a positive factor on the file's numbers of segments")
        if segments is not None and refine != 1.0:
            raise ValueError(f"segments is {segments!r} and refine is {refine!r}; expected one of the two")
        if "scene" not in self.__dict__:  # __new__ has read it, but for a subclass
            self.scene = scene if isinstance(scene, Scene) else load_scene(Path(scene))
        self.fidelity = fidelity
        self.solver = "implicit" if solver == "implicit" else "explicit"
        self._implicit, self._spectral_radius = None, float(shaped(spectral_radius, (), "spectral_radius", "a number"))
        if not 0.0 <= self._spectral_radius <= 1.0:
            raise ValueError(f"spectral_radius is {spectral_radius!r}; expected a number from 0 to 1")
        if self.solver == "implicit":
            implicit.refuse(self.scene)
        self._wound = _refined(self.scene, refine)  # and with the lengths that winches have given its lines
        self._segments = None if segments is None else int(segments)
        self._given_dt = dt
        self._platforms = Platforms(platforms, self.scene)
        self.platforms = self._platforms.names
        self._layout = layout = Layout(self.scene, self.platforms or ())
        self._model, self._ends = build(self._wound, self._segments, layout)
        self._prepare()
        self.choice = f"{solver}, as asked for"
        if solver == "auto" and fidelity == "dynamic":
            self.solver, self.choice = choose_solver(self._wound, self._model, self.step_limit, self._table, dt)
            self._prepare_implicit()
        self._identity = hashlib.sha256(b"".join((self.solver.encode(), *_bytes(self._model)))).hexdigest()
        self._state = new_state(self._model, self._ends)
        self._scratch = new_scratch(self._model)
        self._readings = new_readings(self._model, 1)
        self.warnings = self.scene.warnings
        if dt is not None and dt > self.step_limit.dt:
            self.warnings += (f"dt = {dt:g} s is more than the largest step, {self.step_limit.dt:.4g} s ({self.step_limit.limited_by}), which is taken",)
        if fidelity != "dynamic":
            env = self.scene.environment
            idle = [what for what, there in (("waves", env.waves), ("line failures", self.scene.failures), ("creep of ropes", self._model.ropes.kelvin_first.size)) if there]
            if idle:
                self.warnings += (f"{fidelity} moorings know no {', '.join(idle)}: still water, lines as they stand, ropes as they settle",)
        self._report = np.zeros(5)
        count = self._platforms.count
        self._time, self._pose, self._twist = np.zeros(1), np.zeros((1, count, 7)), np.zeros((1, count, 6))
        self._settled = False
        self._linear = None
        self.line_names = [line.name for line in self.scene.lines]
        self.segments = [int(count) for count in self._model.segments]  # of each line
        self._rods = {rod.name: self._model.point_node[[layout.rods[rod.id].points[0], layout.rods[rod.id].points[-1]]] for rod in self.scene.rods}
        self._body_parts = layout.body_parts
        self.coupled_names = layout.outputs  # coupled points, rods and bodies
        self.static_result = None

    def _prepare(self):
        """What depends on the model alone."""
        self._statics = StaticSolver(self._wound, self._model)
        self.step_limit = step_limit(self._wound, self._model, self._ends, self._given_dt)
        self._table = step_table(self.step_limit.axial, self.step_limit.dt)  # of swings, too
        self._prepare_implicit()

    def _prepare_implicit(self):
        if self.solver == "implicit":
            self.step_limit = implicit.step_limit(self._wound, self.step_limit, self._given_dt)
            self._implicit = self._implicit or implicit.ImplicitSolver(self._model, self.step_limit.dt, self._spectral_radius)

    # -- doing ------------------------------------------------------------------------------------------------------------------------

    def settle(self, pose, time=0.0):
        """Static equilibrium with the platform at rest at `pose` (7,), from a cold start; the clock stands at `time` (s) after it."""
        pose = self._platforms.pose(pose)
        time = float(shaped(time, (), "time", "seconds"))
        if not np.isfinite(time):
            raise ValueError(f"time is {time!r}; expected a finite number of seconds")
        state, result = self._static_state(pose)
        state.clock[0] = time
        strain = (state.tension / np.maximum(self._model.stiffness, 1e-300)).max()
        state.settings[5] = max(MOST_STRAIN, 2.0 * strain)
        waken(state.window_times)
        _assign(self._state, state)
        if self._implicit:
            self._implicit.begin(self._state)
        self.static_result = result
        self._settled = True
        if self.fidelity == "linear":
            self._linear = LinearRange((self._linearised(pose),))
        observe(self._model, self._state, 0, self._readings)

    def step(self, t, pose, twist):
        """Advance to `t` (s), where the platform has `pose` (7,) and `twist` (6,).

        Its motion since the last sample is a cubic Hermite curve in position and rotation. Wrong shapes, NaN, a quaternion that is not of
        unit length, or time that does not go forward raise ValueError; a step that cannot be completed raises MooringError. Either leaves
        the mooring as it was.
        """
        self._time[0] = self._checked_time(t)
        self._pose[0], self._twist[0] = self._platforms.pose(pose), self._platforms.twist(twist)
        self._need_settled()
        self._run(self._time, self._pose, self._twist, self._readings)

    def run(self, times, poses, twists):
        """`step` through many samples in one call, with the same bits: times (k,), poses (k, 7), twists (k, 6). Returns a History.

        When a step cannot be completed, MooringError is raised with the attribute `history` holding the samples done before it.
        """
        times = numbers(times, "times").reshape(-1)
        poses, twists = self._platforms.motion(times, poses, twists)
        if times.size == 0:
            return self._history(times, new_readings(self._model, 0))
        self._need_settled()
        self._checked_time(times[0])
        if not (np.isfinite(times).all() and (np.diff(times) > 0.0).all()):
            raise ValueError("times must be finite and grow from sample to sample")
        times, poses, twists = (np.ascontiguousarray(rows) for rows in (times, checked_poses(poses), checked_twists(twists)))
        readings, done = new_readings(self._model, times.size), 0
        try:
            done = self._run(times, poses, twists, readings)
        except MooringError as error:
            done = error.samples
            error.history = self._history(times[:done], _rows(readings, slice(0, done)))
            raise
        finally:
            if done:
                for mine, row in zip(self._readings, _rows(readings, slice(done - 1, done))):
                    mine[:] = row
        return self._history(times, readings)

    def release(self, line_name):
        """Let go of the fairlead end of a line; it falls from where it is. Raises ValueError for an unknown or loose line."""
        line = self._line(line_name)
        end = 2 * line + self._model.fairlead_end[line]
        if self._state.end_point[end] == LOOSE:
            raise ValueError(f"{line_name} has been let go already")
        self._state.end_point[end] = LOOSE
        self._state.slaved[self._model.end_node[end]] = False
        self._read_again()

    @property
    def unstretched_length(self):
        """(lines,) m."""
        return np.array(self._lengths)

    def set_unstretched_length(self, line_name, length):
        """Give a line the unstretched length `length` (m), as a winch does: all its segments share the change, and its mass with it.

        It takes effect at once: for a winch that turns, set before every step the length at its end. `Scene` stays as it was read.
        Raises ValueError for an unknown line or a length that is not positive.
        """
        line = self._line(line_name)
        length = float(shaped(length, (), "length", "metres"))
        if not 0.0 < length < np.inf:
            raise ValueError(f"length is {length!r}; expected a positive number of metres")
        self._set_lengths((*self._lengths[:line], length, *self._lengths[line + 1 :]))
        self._read_again()

    @property
    def _lengths(self):
        return tuple(line.length for line in self._wound.lines)

    def _set_lengths(self, lengths):
        """Build the model again for other unstretched lengths; what changes in a step stays."""
        self._wound = replace(self._wound, lines=tuple(replace(line, length=own) for line, own in zip(self._wound.lines, lengths)))
        self._model, _ = build(self._wound, self._segments, self._layout)
        self._prepare()

    def _read_again(self):
        """Bring the readings up to date after something other than the motion has changed."""
        if self.fidelity == "linear" and self._settled:
            self._linear = LinearRange((self._linearised(self._state.pose.copy()),))
            self._linear.show(self._state, self._state.pose, self._state.twist, 0, self._readings)
        elif self._settled:
            settings = self._state.settings
            accelerations = [array.copy() for array in (self._state.acceleration, self._state.parts_acceleration)]
            evaluate_once(self._model, self._state, self._scratch, settings[0], settings[1], bool(settings[2]))
            if self._implicit:  # a jump of the forces is for the next step to answer: its first moment tells nothing of it
                self._state.acceleration[:], self._state.parts_acceleration[:] = accelerations
            observe(self._model, self._state, 0, self._readings)

    def snapshot(self):
        """A copy of everything that changes, for `restore`."""
        return Snapshot(self._identity, copied(self._state), tuple(array.copy() for array in self._readings), self._settled, self._linear, self._lengths)

    def restore(self, saved):
        """Go back to a snapshot of this mooring or one like it, bit for bit. Raises ValueError for one of another mooring."""
        if not isinstance(saved, Snapshot) or saved.mooring != self._identity:
            raise ValueError("this is not a snapshot of a mooring like this one")
        if saved.lengths != self._lengths:
            self._set_lengths(saved.lengths)
        _assign(self._state, saved.state)
        for mine, theirs in zip(self._readings, saved.readings):
            mine[:] = theirs
        self._settled, self._linear = saved.settled, saved.linear

    def twin(self):
        """Another mooring like this one, in the same state. What does not change they share."""
        other = copy.copy(self)
        other._state, other._scratch = copied(self._state), new_scratch(self._model)
        other._readings = type(self._readings)(*(array.copy() for array in self._readings))
        other._statics = StaticSolver(self._wound, self._model)
        if self._implicit:
            other._implicit = implicit.ImplicitSolver(self._model, self.step_limit.dt, self._spectral_radius)
        other._report, other._time, other._pose, other._twist = (array.copy() for array in (self._report, self._time, self._pose, self._twist))
        return other

    # -- reading ----------------------------------------------------------------------------------------------------------------------

    @property
    def time(self):
        """Where the mooring stands, s."""
        return float(self._state.clock[0])

    @property
    def pose(self):
        """(7,) of the platform at `time`, or (platforms, 7)."""
        return self._platforms.outside(self._state.pose).copy()

    @property
    def platform_of_coupled(self):
        """Which platform each of `coupled_names` is on, a list of numbers from 0."""
        return self._model.point_platform[self._model.output_point].tolist()

    @property
    def pose_in_file(self):
        """(7,) or (platforms, 7): where the file puts the platforms, zero when they have no names."""
        return self._platforms.pose_in_file.copy()

    @property
    def twist(self):
        """(6,) of the platform at `time`, or (platforms, 6)."""
        return self._platforms.outside(self._state.twist).copy()

    @property
    def wrench(self):
        """(6,) or (platforms, 6) N and N m of the mooring on the platform, about its reference point, world frame."""
        return self._platforms.outside(self._shown.wrench[0]).copy()

    @property
    def fairlead_tension(self):
        """(lines,) N, of the end segments at the fairleads."""
        return self._shown.tension[0, :, 1].copy()

    @property
    def anchor_tension(self):
        """(lines,) N, of the end segments at the anchors."""
        return self._shown.tension[0, :, 0].copy()

    @property
    def fairlead_end_force(self):
        """(lines, 3) N of each line on what holds its fairlead end: with the half segment's weight, drag and inertia."""
        return self._shown.end_force[0, :, 1].copy()

    @property
    def anchor_end_force(self):
        """(lines, 3) N of each line on what holds its anchor end."""
        return self._shown.end_force[0, :, 0].copy()

    @property
    def coupled_wrenches(self):
        """(outputs, 6) N and N m on the platform at each coupled point, rod (at its end A) and body, world frame, as in `coupled_names`."""
        return self._shown.coupled[0].copy()

    @property
    def stretched_length(self):
        """(lines,) m."""
        return self._shown.length[0].copy()

    @property
    def length_rate(self):
        """(lines,) m/s."""
        return self._shown.length_rate[0].copy()

    def node_positions(self, line_name):
        """(N + 1, 3) m, from end A to end B."""
        return self._state.position[:, self._nodes(line_name)].T.copy()

    def node_tension(self, line_name):
        """(N + 1,) N from end A to end B: the mean of the segments on both sides, at the ends the norm of the end force."""
        line = self._line(line_name)
        nodes = self._nodes(line_name)
        segments = self._state.tension[nodes.start + 1 : nodes.stop]
        tension = np.empty(segments.size + 1)
        tension[1:-1] = 0.5 * (segments[1:] + segments[:-1])
        ends = np.linalg.norm(self._shown.end_force[0, line], axis=1)
        tension[0], tension[-1] = ends if self._model.fairlead_end[line] == 1 else ends[::-1]
        return tension

    def node_curvature(self, line_name):
        """(N + 1,) 1/m from end A to end B: the angle between the neighbouring segments over the length that it belongs to; zero at pinned ends."""
        nodes, state = self._nodes(line_name), self._state
        curvature = np.zeros(state.tension.size)
        curvature_of_nodes(self._model.bending, self._model.size, state.tangent, state.end_point, state.clamp_axis, curvature)
        return curvature[nodes]

    def rod_positions(self, rod_name):
        """(2, 3) m: where ends A and B of a rod are."""
        self._need_settled()
        if rod_name not in self._rods:
            raise ValueError(f"there is no rod {rod_name!r}; expected one of {', '.join(self._rods) or 'none: the scene has no rods'}")
        return self._state.position[:, self._rods[rod_name]].T.copy()

    @property
    def body_poses(self):
        """Poses (7,) of the bodies by name: x, y, z (m) and quaternion x, y, z, w."""
        self._need_settled()
        return {body.name: self._body_pose(body) for body in self.scene.bodies}

    def _body_pose(self, body):
        part = self._body_parts.get(body.id)
        if part is not None:
            return self._state.parts[part, :7].copy()
        own = np.array([*body.position, *body.orientation], dtype=float)
        if body.kind != COUPLED:
            return own
        pose = self._state.pose[self._layout.platforms[body.id]]
        return np.concatenate(composed(pose, own)) if self.platforms is None else pose.copy()

    def stiffness(self):
        """(6, 6) -d wrench / d pose of the static mooring at the present pose, N/m, N, N m; rotations about the world axes.

        With `platforms` (6 platforms, 6 platforms): row 6 i + a is wrench component a on platform i, column 6 j + b the move b of platform j.
        """
        self._need_settled()
        state, _ = self._static_state(self._state.pose.copy())
        return self._statics.platform_stiffness(state, self._scratch)

    @property
    def error_estimate(self):
        """Estimated error of a linear mooring where it stands, against the equilibrium there; None for other fidelities.

        A share: the largest of each fairlead tension's error over that tension (or a tenth of the mean one, if that is more), and of the error of
        the wrench's force and moment over the sum of the fairlead tensions (times the farthest coupled point's distance).
        """
        self._need_settled()
        return self._linear.error(self._state.pose) if self.fidelity == "linear" else None

    @property
    def energy(self):
        """core.energy.Energy, J: kinetic, strain, bending, potential and their total, after a settle or a dynamic step."""
        self._need_settled()
        lead = 0.5 * self._state.settings[1] if self._table[0, 0] <= LEAPFROG and self.solver == "explicit" else 0.0  # its velocities stand half a step behind
        return energy(self._model, self._state, lead)

    @property
    def last_step(self):
        """What the last interval took: evaluations of the forces, steps, parts taken again with a finer step, shortest step `dt` (s).

        `uneven`: parts in which tensions jump from step to step even in the finest: lines snap taut, and what single peaks are is a matter of
        chance (docs/extremes.md).
        """
        evaluations, steps, retries, dt, uneven = self._report
        return {"evaluations": int(evaluations), "steps": int(steps), "retries": int(retries), "dt": float(dt), "uneven": int(uneven)}

    # -- inside -----------------------------------------------------------------------------------------------------------------------

    @property
    def _equilibria(self):
        return Equilibria(self._model, self._statics, self._scratch, self._table, self.step_limit.dt, self._warn)

    def _warn(self, words):
        if words not in self.warnings:
            self.warnings += (words,)

    def _next_static_state(self, pose):
        """A State in equilibrium at `pose` and its StaticResult, from the present shape."""
        return self._equilibria.near(self._state, pose)

    def _static_state(self, pose):
        """The same from the catenaries."""
        return self._equilibria.from_cold(self._state, pose)

    def _equilibrium(self, pose, time):
        """State and StaticResult at the pose of a step to `time` (s)."""
        try:
            return self._next_static_state(pose)
        except MooringError as error:
            raise MooringError(
                f"no equilibrium for the step to t = {time:.6g} s: {error}; settle() at a pose that the platform is to be put to, or take "
                f'fidelity "dynamic"; the mooring stands at t = {self.time:.6g} s'
            ) from error

    def _history(self, times, readings):
        return History.of(times, readings._replace(wrench=self._platforms.outside(readings.wrench)))

    def _run(self, times, poses, twists, readings):
        if self.fidelity == "quasi_static":
            return self._run_statics(times, poses, twists, readings)
        if self.fidelity == "linear":
            return self._run_linear(times, poses, twists, readings)
        if self.solver == "implicit":
            status, done = self._implicit.run(self._model, self._state, self._scratch, times, poses, twists, self._report, readings)
        else:
            status, done = explicit.run(
                self._model, self._state, self._scratch, self._table, times, poses, twists, self._report, readings
            )
        if status != explicit.DONE:
            cause = {
                explicit.RUNAWAY: f"ran away (speeds that nothing here can cause) even with a step of {self.step_limit.dt / explicit.FINEST:.3g} s; "
                "expected a smoother motion, or a smaller dt",
                explicit.OVERSTRETCHED: f"stretches a line by more than {100.0 * self._state.settings[5]:.0f} % of its length; "
                "settle() at a pose that the platform is to be put to, or let it take its time",
                explicit.TOO_LONG: f"needs more than {explicit.MOST_STEPS:g} steps of {self.step_limit.dt:.3g} s; expected shorter intervals",
                explicit.TOO_FAST: f"moves the platform faster than {FASTEST:g} m/s; settle() at a pose that the platform is to be put to",
            }[status]
            if self.solver == "implicit" and status == explicit.RUNAWAY:
                cause = f"comes to no balance of forces even with a step of {self.step_limit.dt / implicit.FINEST:.3g} s; expected a smoother motion, or solver 'explicit'"
            error = MooringError(f"the step to t = {times[done]:.6g} s {cause}; the mooring stands at t = {self.time:.6g} s")
            error.samples = done
            raise error
        return done

    def _run_statics(self, times, poses, twists, readings):
        for sample, pose in enumerate(poses):
            try:
                state, result = self._equilibrium(pose, times[sample])
            except MooringError as failure:
                failure.samples = sample
                raise
            self._report[:] = result.iterations, 1.0, 0.0, times[sample] - self.time, 0.0
            state.clock[0] = times[sample]
            _assign(self._state, state)
            observe(self._model, self._state, sample, readings)
            self._state.twist[:] = twists[sample]  # not before: it would bring inertia into the readings
        return times.size

    def _linearised(self, pose):
        """A LinearResponse about `pose`; the state stands in equilibrium there after it, or where it was when there is none."""
        before = copied(self._state)
        try:
            _assign(self._state, self._next_static_state(pose)[0])  # what is solved around it begins there
            response, state = linearise(
                self._model,
                pose,
                lambda there: self._next_static_state(there)[0],
                lambda there: self._statics.platform_stiffness(copied(there), self._scratch),
            )
        except MooringError:
            _assign(self._state, before)
            raise
        state.clock[0] = before.clock[0]
        _assign(self._state, state)
        return response

    def _solved_readings(self, pose):
        """Readings of one row in equilibrium at `pose`; the state stays."""
        state, _ = self._next_static_state(pose)
        readings = new_readings(self._model, 1)
        observe(self._model, state, 0, readings)
        return readings

    def _run_linear(self, times, poses, twists, readings):
        for sample, (pose, twist) in enumerate(zip(poses, twists)):
            try:
                self._linear = self._linear.follow(pose, self._solved_readings, self._linearised)
            except MooringError as failure:
                error = MooringError(f"the linear mooring leaves its range in the step to t = {times[sample]:.6g} s, and no other can be derived: {failure}")
                error.samples = sample
                raise error from failure
            self._linear.show(self._state, pose, twist, sample, readings)
            self._report[:] = self._linear.solved, 1.0, 0.0, times[sample] - self.time, 0.0
            self._state.clock[0], self._state.pose[:], self._state.twist[:] = times[sample], pose, twist
        return times.size

    def _need_settled(self):
        if not self._settled:
            raise ValueError("the mooring has not been settled; call settle(pose) first")

    def _checked_time(self, t):
        t = float(shaped(t, (), "t", "seconds"))
        if not np.isfinite(t):
            raise ValueError(f"t is {t!r}; expected a finite number of seconds")
        if not t > self._state.clock[0]:
            raise ValueError(f"t is {t!r} s; expected a time after the present one, {self.time!r} s")
        return t

    def _line(self, name):
        if name not in self.line_names:
            raise ValueError(f"there is no line {name!r}; expected one of {', '.join(self.line_names)}")
        return self.line_names.index(name)

    @property
    def _shown(self):
        self._need_settled()
        return self._readings

    def _nodes(self, line_name):
        self._need_settled()
        line = self._line(line_name)
        first = int(self._model.first_node[line])
        return slice(first, first + int(self._model.segments[line]) + 1)


def composed(pose, own):
    """Place (3,) and quaternion (4,) of what has the pose `own` (7,) in the axes of `pose` (7,)."""
    a, b, w, v = pose[3:6], own[3:6], pose[6], own[6]
    turn = np.append(w * b + v * a + np.cross(a, b), w * v - a @ b)
    return pose[:3] + np.array(rotate(pose[3:], own[:3])), turn


def _refined(scene, factor):
    """The scene with `factor` times the segments in each line, whole numbers from 1."""
    if factor == 1.0:
        return scene
    counts = [times_segments(factor, line.segments) for line in scene.lines]
    if max(counts) > MOST_SEGMENTS:
        raise ValueError(f"refine is {factor!r}, which makes {max(counts)} segments in a line; expected at most {MOST_SEGMENTS}")
    return replace(scene, lines=tuple(replace(line, segments=count) for line, count in zip(scene.lines, counts)))


def _rows(readings, rows):
    return type(readings)(*(array[rows] for array in readings))


def _bytes(model):
    """The bytes of all numbers in a model, one after another."""
    for part in model:
        yield from _bytes(part) if isinstance(part, tuple) else (np.asarray(part).tobytes(),)


def _assign(state, other):
    for mine, theirs in zip(state, other):
        mine[:] = theirs
