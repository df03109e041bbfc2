"""Motion from MCAP: a recording of the node by its schedule; else nav_msgs/Odometry, or PoseStamped with TwistStamped."""

import math

import numpy as np

from mooring_ros.motion.frames import Adapter, twist_axes
from mooring_ros.motion.gate import UNIT_TOLERANCE
from mooring_ros.motion.velocity import twist_from_poses
from mooring_ros.recording import schedule
from mooring_ros.recording.reader import Recording

from .motion_file import Motion
from .motion_of_all import own_topics, together
from .stamps import kept, times_of
from .twist_check import twist_is_missing

ODOMETRY, POSE, TWIST = "nav_msgs/msg/Odometry", "geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/TwistStamped"


def load_mcap(path, topic=None, platforms=()):
    """The Motion in an MCAP file or bag folder; `topic` and `platforms` as in `load_motion`.

    Stamps are those of the headers. Times are the stamps in s, from the first one where they are of a wall clock. Twists of Odometry are in
    the platform's axes, as the message says. Those of TwistStamped are in world axes, unless their frame is another one than the pose's:
    then in the platform's. A twist that clearly does not move the pose is refused. In a recording of the node, its parameters
    `twist_frame`, `convention` and `scale` hold for its inputs.
    Raises ValueError and RecordingError (a ValueError).
    """
    recording = Recording(path)
    platforms = _platforms(recording, platforms)
    found = {name: type_name for name, (type_name, count) in recording.topics().items() if count}
    cut = (f"{recording.cut}; what is before was taken",) if recording.cut else ()
    if topic is None and recording.parameters is not None:
        steps = [name for name, type_name in found.items()
                 if name.endswith(schedule.TOPIC_SUFFIX) and type_name == schedule.TYPE_NAME]
        if len(steps) > 1:
            raise ValueError(f"{path}: several step schedules ({', '.join(steps)}), expected one, or --topic for an input")
        if steps:
            return _scheduled(recording, steps[0], cut, platforms)
    if not platforms:
        return _measured(recording, found, *_chosen(path, found, topic), cut)
    each = [_measured(recording, own, *_chosen(path, own, asked), cut) for own, asked in own_topics(path, found, topic, platforms)]
    return together(each, platforms, _adapter(recording.parameters, []).time_factor)


def _platforms(recording, asked):
    """Names of the platforms: the recorded ones, or, where nothing is recorded, those that are asked for."""
    if recording.parameters is None:
        return asked
    names = recording.parameters.get("platforms", [])
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise ValueError(f"{recording.path}: recorded parameter platforms is {str(names)[:80]!r}, expected a list of names")
    if asked and asked != tuple(names):
        raise ValueError(f"{recording.path}: recorded with {'platforms ' + ', '.join(names) if names else 'one platform'}, expected the same as in --platforms")
    return tuple(names)


def _scheduled(recording, topic, remarks, platforms):
    from std_msgs.msg import Float64MultiArray

    from .decoded import decoded

    actions, stamps, expected = [], [], 0
    for entry in recording.messages([topic]):
        if entry.sequence != expected:
            raise ValueError(f"{recording.path}: {abs(entry.sequence - expected)} records of the step schedule {topic} are missing after "
                             f"{len(actions)}, expected all of them (--topic chooses an input to replay instead)")
        expected += 1
        data = decoded(entry, Float64MultiArray, recording.path).data
        try:
            actions.append(schedule.decode(data, platforms))
        except ValueError as error:
            raise ValueError(f"{recording.path}: topic {topic}: message {len(actions) + 1}: {error}") from error
        stamps.append(entry.log_time)
    moves = [index for index, action in enumerate(actions) if action.kind in schedule.MOVES]
    if not moves:
        raise ValueError(f"{recording.path}: the step schedule {topic} has no step, expected at least a settle")
    return Motion(
        path=str(recording.path),
        times=np.array([actions[index].time for index in moves]),
        poses=np.array([actions[index].pose for index in moves]),
        twists=np.array([actions[index].twist for index in moves]),
        stamps=np.array([stamps[index] for index in moves], dtype=np.int64),
        source=f"step schedule {topic}",
        schedule=actions,
        schedule_stamps=stamps,
        parameters=recording.parameters,
        scene=recording.scene,
        remarks=(*remarks, *recording.damage),
        platforms=platforms,
    )


def _chosen(path, found, topic):
    """(pose topic, twist topic or None) for what was asked for."""
    poses = [name for name, type_name in found.items() if type_name in (ODOMETRY, POSE)]
    twists = [name for name, type_name in found.items() if type_name == TWIST]
    asked = [part.strip() for part in topic.split(",")] if topic else poses
    if topic is None and len(poses) != 1:
        raise ValueError(f"{path}: {'several topics could be the motion' if poses else 'no topic is a motion'}, expected one of Odometry or "
                         f"PoseStamped{', or --topic NAME' if poses else ''}; it has {_listed(found)}")
    if found.get(asked[0]) not in (ODOMETRY, POSE) or len(asked) > 2:
        raise ValueError(f"{path}: topic {asked[0]} is no Odometry or PoseStamped with messages in it; it has {_listed(found)}")
    if len(asked) == 2:
        if found[asked[0]] != POSE or found.get(asked[1]) != TWIST:
            raise ValueError(f"{path}: topics {topic}, expected a PoseStamped and a TwistStamped; it has {_listed(found)}")
        return asked[0], asked[1]
    if found[asked[0]] == ODOMETRY or not twists:
        return asked[0], None
    namespace = asked[0].rsplit("/", 1)[0]
    near = [name for name in twists if name.rsplit("/", 1)[0] == namespace]
    if len(twists) == 1 or len(near) == 1:
        return asked[0], near[0] if near else twists[0]
    raise ValueError(f"{path}: which twist goes with {asked[0]}? expected --topic {asked[0]},TWIST_TOPIC; it has {_listed(found)}")


def _listed(found):
    return ", ".join(f"{name} ({type_name.split('/')[-1]})" for name, type_name in sorted(found.items())) or "no messages"


def _measured(recording, found, pose_topic, twist_topic, remarks):
    from mooring_ros.node import decode

    path, remarks = recording.path, list(remarks)
    adapter = _adapter(recording.parameters, remarks)
    read = decode.odometry if found[pose_topic] == ODOMETRY else decode.pose_stamped
    stamps, samples = _read(recording, pose_topic, read, remarks)
    if len(samples) < 2:
        damage = "".join(f"; {where}" for where in recording.damage)
        raise ValueError(f"{path}: topic {pose_topic}: {len(samples)} samples, expected at least 2{damage}")
    raw = [sample.twist for sample in samples]
    axes = [None] * len(samples)
    source = pose_topic
    if twist_topic:
        kept_rows, raw, frame = _twists_at(recording, stamps, pose_topic, twist_topic, decode.twist_stamped, remarks)
        stamps, samples = stamps[kept_rows], [samples[row] for row in kept_rows]
        axes = _axes(frame, samples, recording.parameters)
        source = f"{pose_topic} and {twist_topic}"
    poses = np.array([adapter.pose_in(_unit(path, pose_topic, row, sample.pose)) for row, sample in enumerate(samples)])
    times = times_of(stamps, adapter.time_factor)
    if raw[0] is not None and not twist_is_missing(path, source, adapter, stamps, poses, raw, axes, remarks):
        twists = np.array([adapter.twist_in(twist, pose[3:], frame) for twist, pose, frame in zip(raw, poses, axes)])
    else:
        twists = twist_from_poses(times, poses)
        source += "; twist differentiated from it"
    return Motion(str(path), times, poses, twists, stamps, source, parameters=recording.parameters, scene=recording.scene,
                  remarks=(*remarks, *recording.damage))


def _adapter(parameters, remarks):
    """How the source gives its motion: as the node's parameters say in a recording of it, else as the messages do."""
    given = {name: parameters[name] for name in ("twist_frame", "convention", "scale") if name in (parameters or {})}
    if given and Adapter(**given) != Adapter():
        remarks.append("read with the recorded parameters " + ", ".join(f"{name}: {value}" for name, value in given.items()))
    return Adapter(**given)


def _read(recording, topic, read, remarks):
    """Stamps (n,) ns and decoded messages of a topic, checked."""
    samples, log_times = [], []
    for entry in recording.messages([topic]):
        try:
            samples.append(read(entry.data))
        except ValueError as error:
            raise ValueError(f"{recording.path}: topic {topic}: message {len(samples) + 1}: {error}") from error
        log_times.append(entry.log_time)
        numbers = (value for part in samples[-1] if isinstance(part, tuple) for value in part)
        if not all(map(math.isfinite, numbers)):
            raise ValueError(f"{recording.path}: topic {topic}: message {len(samples)}: a number that is not finite, "
                             "expected finite numbers")
    indices, stamps, found = kept(recording.path, topic, samples, log_times)
    remarks += found
    return stamps, [samples[index] for index in indices]


def _unit(path, topic, row, pose):
    length = math.hypot(*pose[3:])
    if abs(length - 1.0) > UNIT_TOLERANCE:
        raise ValueError(f"{path}: topic {topic}: sample {row + 1}: quaternion of length {length:.6g}, "
                         f"expected 1 (within {UNIT_TOLERANCE:g})")
    return pose if length == 1.0 else (*pose[:3], *(component / length for component in pose[3:]))


def _twists_at(recording, stamps, pose_topic, twist_topic, read, remarks):
    """Twists at the stamps of the poses: (rows of the poses that have one, their twists, frame of the twists).

    With equal stamps as they are, in between interpolated linearly; poses outside the span of the twists are left out, with a remark.
    """
    twist_stamps, messages = _read(recording, twist_topic, read, remarks)
    frames = sorted({message[1] for message in messages})
    if len(frames) != 1:
        raise ValueError(f"{recording.path}: topic {twist_topic}: frames {', '.join(map(repr, frames))}, expected one")
    rows = np.flatnonzero((stamps >= twist_stamps[0]) & (stamps <= twist_stamps[-1]))
    if len(rows) < 2:
        raise ValueError(f"{recording.path}: topics {pose_topic} and {twist_topic} share no span of time, "
                         "expected the twist of each pose")
    values = np.array([message[2] for message in messages])
    own = stamps[rows]
    if not np.isin(own, twist_stamps).all():
        remarks.append(f"{twist_topic}: stamps differ from those of {pose_topic}, the twists were interpolated linearly")
    if len(rows) < len(stamps):
        remarks.append(f"{pose_topic}: {len(stamps) - len(rows)} poses before the first or after the last twist were left out")
    start = twist_stamps[0]
    at, given = (own - start).astype(float), (twist_stamps - start).astype(float)
    twists = np.column_stack([np.interp(at, given, values[:, column]) for column in range(6)])
    return rows, [tuple(row) for row in twists.tolist()], frames[0]


def _axes(frame, samples, parameters):
    """Axes of a TwistStamped with this frame, for each pose: as the node decides in a recording of it."""
    if parameters is not None:
        platform, default = parameters.get("platform_frame", ""), parameters.get("twist_frame", "world")
        return [twist_axes(frame, sample.frame, platform, default) for sample in samples]
    return ["child" if frame not in ("", sample.frame) else "world" for sample in samples]
