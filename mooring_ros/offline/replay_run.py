"""A recorded motion through the mooring core, one answer after the other: plain motions, and the node's own step schedules."""

from dataclasses import dataclass

import numpy as np

from mooring_ros.recording import schedule

from .stamps import times_of


@dataclass(frozen=True)
class Done:
    """What was just done to the mooring, which now stands at its answer (only settles and steps have one).

    stamp: ns, of the source; time: s, for tables, by the source's clock; record: as in the schedule (15 floats); pose (7,), twist (6,): of the
    platform by the source, world axes, a row for each platform with a name; None for what is done to a line.
    """

    kind: int  # of schedule.KINDS
    stamp: int
    time: float
    record: list
    pose: np.ndarray | None
    twist: np.ndarray | None


def run_motion(mooring, times, poses, twists, stamps):
    """Settle at the first pose, then step through all samples; yields a Done after each.

    times (n,) s, poses (n, 7), twists (n, 6), stamps (n,) ns. Raises MooringError and ValueError.
    """
    for row, (instant, stamp) in enumerate(zip(times.tolist(), stamps.tolist())):
        if row == 0:
            mooring.settle(poses[0], time=instant)
            yield Done(schedule.SETTLE, stamp, instant, schedule.encode_settle(instant, poses[0]), poses[0], twists[0])
        else:
            mooring.step(instant, poses[row], twists[row])
            yield Done(schedule.STEP, stamp, instant, schedule.encode_step(instant, poses[row], twists[row]), poses[row], twists[row])


def run_schedule(mooring, actions, stamps, time_factor):
    """Do again what a node did, action by action; yields a Done after each.

    actions: of recording.schedule; stamps: ns, one each; time_factor: seconds inside for one of the source's clock. The times yielded go on
    over a settle that starts the core's clock anew. Raises MooringError and ValueError.
    """
    shown = times_of(np.asarray(stamps, dtype=np.int64))
    offset = 0.0
    for action, stamp, source_time in zip(actions, stamps, shown.tolist()):
        if action.kind == schedule.SETTLE:
            mooring.settle(action.pose, time=action.time)
            offset = source_time - action.time / time_factor
            record = schedule.encode_settle(action.time, action.pose)
        elif action.kind == schedule.STEP:
            mooring.step(action.time, action.pose, action.twist)
            record = schedule.encode_step(action.time, action.pose, action.twist)
        elif action.kind == schedule.WIND:
            mooring.set_unstretched_length(_line_name(mooring, action.line), action.length)
            record = schedule.encode_wind(action.time, action.line, action.length)
        else:
            mooring.release(_line_name(mooring, action.line))
            record = schedule.encode_release(action.time, action.line)
        yield Done(action.kind, stamp, offset + action.time / time_factor, record, action.pose, action.twist)


def _line_name(mooring, index):
    if index >= len(mooring.line_names):
        raise ValueError(f"the step schedule names line {index + 1} of the scene, expected one of its {len(mooring.line_names)}")
    return mooring.line_names[index]
