"""The work of `mooring replay`: run, write, stop cleanly."""

from dataclasses import dataclass

import numpy as np

from mooring_ros.mooring import MooringError
from mooring_ros.motion import Adapter
from mooring_ros.node.full_scale import PREFIX, FullScale
from mooring_ros.node.messages import Messages
from mooring_ros.platforms import platform_count
from mooring_ros.recording import schedule
from mooring_ros.recording.reader import Recording

from .console import ComputationFailed, Progress, UsageError
from .identical import TENSIONS, Identical
from .interrupt import Stop
from .pace import Pace
from .replay_output import Answer, CsvOutput, McapOutput, ODOMETRY, PLATFORM_FRAME, WORLD_FRAME
from .replay_run import run_motion, run_schedule
from .resample import resample

_MOST_SAMPLES = 1e7  # of --rate: more would fill the memory

WINCHES = "/unstretched_lengths"
INPUT_TYPES = (ODOMETRY, "geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/TwistStamped")


@dataclass(frozen=True)
class Replayed:
    """answers written; simulated: s; elapsed: s of wall time; speed: simulated over wall time, without the first step and what it waits for
    (compiling); uneven: answers to steps in which tensions jump however fine they are (Mooring.last_step), and the time (s) of the first of them;
    identical: None when the motion came with no tensions."""

    answers: int
    simulated: float
    elapsed: float
    speed: float
    uneven: tuple[int, float | None]
    identical: Identical | None


def replay(args, mooring, motion, settings, watched=None):
    """Run the motion through the mooring and write the outputs that args name.

    settings: the node's parameters that hold; watched: a replay_accuracy.Watched that is told what is done, or None. Returns Replayed. Whatever ends it, the outputs are closed and readable.
    Raises ComputationFailed, UsageError, KeyboardInterrupt.
    """
    adapter = Adapter(**{name: settings[name] for name in ("twist_frame", "convention", "wrench_frame", "scale", "density_ratio")})
    world, platform = settings.get("world_frame") or WORLD_FRAME, settings.get("platform_frame") or PLATFORM_FRAME
    own = motion.platforms or (platform,)
    frames = [world] * len(own) if adapter.wrench_frame == "world" else own, world
    composed = Messages(mooring, adapter, *frames)
    full_scale = FullScale(mooring, adapter, *frames) if settings["full_scale"] else None
    identical = inputs = None
    if motion.schedule is not None:
        recording = Recording(motion.path)
        topics = {topic: kind for topic, (kind, _) in recording.topics().items()}
        identical = Identical(recording.messages([topic for topic in topics if topic.endswith(TENSIONS) and f"/{PREFIX}/" not in topic]))
        inputs = recording.messages([topic for topic, kind in topics.items() if kind in INPUT_TYPES or topic.endswith(WINCHES)])
        steps = run_schedule(mooring, motion.schedule, motion.schedule_stamps, adapter.time_factor)
    else:
        steps = run_motion(mooring, *_samples(args, motion))
    answers, uneven, pace = 0, [], Pace()
    with Stop() as stop, Outputs(args, mooring, settings, full_scale) as outputs, Progress("replay", float(np.ptp(motion.times))) as progress:
        try:
            for done in steps:
                outputs.write_inputs(inputs, done)
                if watched is not None:
                    watched.note(done, mooring)
                if done.kind in schedule.MOVES:
                    answer = _answer(mooring, composed, adapter, done)
                    outputs.write(answer, mooring, composed)
                    if identical:
                        identical.add(answer.stamp, answer.anchor_tension, answer.fairlead_tension)
                    answers += 1
                    if done.kind == schedule.STEP and mooring.last_step["uneven"]:
                        uneven.append(done.time)
                pace.note(done.time)
                progress.update(pace.simulated)
                if stop.asked:
                    raise KeyboardInterrupt
            outputs.write_inputs(inputs, None)
        except MooringError as error:
            raise ComputationFailed(_after(motion, pace.last, error)) from error
        except ValueError as error:
            raise UsageError(_after(motion, pace.last, error)) from error
    return Replayed(answers, pace.simulated, pace.elapsed, pace.speed, (len(uneven), min(uneven, default=None)), identical if identical and identical.total else None)


class Outputs:
    """The files of a replay; leaving the context closes them, whatever happened."""

    def __init__(self, args, mooring, settings, full_scale):
        self._mcap = McapOutput(args.output, settings, mooring.scene, mooring.coupled_names, full_scale, mooring.platforms)
        try:
            self._csv = CsvOutput(args.csv, mooring.line_names, mooring.platforms) if args.csv else None
        except UsageError:
            self._mcap.close()
            raise
        self._next_input = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            if self._csv:
                self._csv.close()
        finally:
            self._mcap.close()

    def write(self, answer, mooring, composed):
        self._mcap.write(answer, mooring, composed)
        if self._csv:
            self._csv.write(answer)

    def write_inputs(self, inputs, done):
        """What led to the answer: the recording's own messages up to its stamp (all that are left for None), or the motion; and the step."""
        if inputs is None:
            if done is not None:
                self._mcap.write_motion(done.stamp, done.pose, done.twist)
        else:
            while (entry := self._next_input or next(inputs, None)) is not None:
                self._next_input = entry
                if done is not None and entry.log_time > done.stamp:
                    break
                self._mcap.write_entry(entry)
                self._next_input = None
        if done is not None:
            self._mcap.write_step(done.stamp, done.record)


def _samples(args, motion):
    """times, poses, twists, stamps of the steps."""
    if args.rate is None:
        return motion.times, motion.poses, motion.twists, motion.stamps
    wanted = (motion.times[-1] - motion.times[0]) * args.rate
    if wanted > _MOST_SAMPLES:
        raise UsageError(f"--rate {args.rate:g}: {wanted:.3g} samples of this motion, expected at most {_MOST_SAMPLES:g}")
    times, poses, twists = resample(motion.times, motion.poses, motion.twists, args.rate)
    # Between recorded stamps, so that a clock at another scale keeps its pace.
    whole = np.searchsorted(motion.times, times, side="right").clip(1, len(motion.times) - 1) - 1
    share = (times - motion.times[whole]) / np.diff(motion.times)[whole]
    return times, poses, twists, motion.stamps[whole] + np.rint(share * np.diff(motion.stamps)[whole]).astype(np.int64)


def _answer(mooring, composed, adapter, done):
    wrenches = composed.wrenches(np.vstack((mooring.wrench, mooring.coupled_wrenches)), mooring.pose)
    totals = platform_count(mooring.platforms)
    return Answer(
        stamp=done.stamp,
        time=done.time,
        wrench=wrenches[:totals] if mooring.platforms else wrenches[0],
        coupled_wrenches=wrenches[totals:],
        fairlead_tension=mooring.fairlead_tension * adapter.force_factor,
        anchor_tension=mooring.anchor_tension * adapter.force_factor,
    )


def _after(motion, last, error):
    where = "while settling at the first sample" if last is None else f"after the answer at {last:.6g} s"
    return f"{motion.path}: {where}: {error}"
