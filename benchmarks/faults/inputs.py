"""Samples that are wrong in themselves."""
import math

from .registry import fault
from .rig import BEGIN, STEP

NEXT = "the next good sample is answered"
SETTLE = "~/settle, once ten samples in a row agree"
_HUGE = 1e300


def _one(rig, words, **wrong):
    """A session, the wrong sample in its middle, and on."""
    rig.send(20)
    rig.bad(**wrong)
    rig.expect("input", words)
    rig.send(20)


@fault("NaN in the position", NEXT)
def nan_position(rig):
    _one(rig, "non_finite: pose", position=(math.nan, 0.0, 0.0))


@fault("an infinite angular velocity", NEXT)
def infinite_twist(rig):
    _one(rig, "non_finite: twist", twist=(0.0, 0.0, 0.0, 0.0, math.inf, 0.0))


@fault("numbers of 1e300", NEXT)
def huge_numbers(rig):
    _one(rig, "jump|non_finite", position=(_HUGE, -_HUGE, _HUGE), twist=(_HUGE,) * 6)


@fault("NaN for as long as a body is occluded, 50 samples", NEXT)
def occluded(rig):
    rig.send(20)
    for _ in range(50):
        rig.bad(position=(math.nan,) * 3, quaternion=(math.nan,) * 4)
        rig.stamp += STEP
    rig.expect("input", "non_finite: pose")
    rig.send(20)


@fault("NaN in the very first sample", NEXT)
def nan_first(rig):
    rig.bad(position=(0.0, 0.0, math.nan))
    rig.expect("input", "non_finite: pose")
    rig.send(20)


@fault("a quaternion of zero length", NEXT)
def zero_quaternion(rig):
    _one(rig, "quaternion: .*length 0", quaternion=(0.0, 0.0, 0.0, 0.0))


@fault("a quaternion of length 1.1", NEXT)
def long_quaternion(rig):
    _one(rig, r"quaternion: .*length 1\.1", quaternion=(0.0, 0.0, 0.0, 1.1))


@fault("a jump of 1 m within 20 ms", NEXT)
def jump_of_a_metre(rig):
    rig.send(20)
    x, y, z = rig.state(rig.stamp).pose[:3]
    rig.bad(position=(x + 1.0, y, z))
    rig.expect("input", "jump: pose is 1 m")
    rig.send(20)


@fault("a jump of 1 km that stays: the platform is put elsewhere", SETTLE)
def jump_of_a_kilometre(rig):
    rig.send(20)
    for _ in range(12):
        x, y, z = rig.state(rig.stamp).pose[:3]
        moved = rig.state(rig.stamp)._replace(pose=(x + 1000.0, y, z, *rig.state(rig.stamp).pose[3:]))
        rig.mark()
        rig.send_at(rig.stamp, good=False, state=moved)
        rig.stamp += STEP
    rig.expect("input", "jump: pose is 1000 m")
    rig.silence(0.1)
    rig.send_at(rig.stamp, good=False, state=moved)


@fault("the velocity changes by 100 m/s", NEXT)
def jump_of_velocity(rig):
    _one(rig, "jump: twist changed", twist=(100.0, 0.0, 0.0, 0.0, 0.0, 0.0))


@fault("the platform turned upside down within 20 ms", NEXT)
def jump_of_attitude(rig):
    _one(rig, "jump: attitude", quaternion=(1.0, 0.0, 0.0, 0.0))


@fault("the pose in another frame", NEXT)
def wrong_frame(rig):
    _one(rig, "frame: frame of the pose is 'odom'", frame="odom")


@fault("another platform's sample", NEXT)
def wrong_child_frame(rig):
    _one(rig, "frame: frame of the platform is 'rov'", child="rov")


@fault("covariances of NaN and of 1e308", "none needed: covariances are not used, and it is answered")
def huge_covariance(rig):
    rig.send(20)
    stamp, state = rig.stamp, rig.state(rig.stamp)
    rig.judge.good[stamp] = state
    rig.bad(change=lambda message: [message[part].update(covariance=[math.nan, 1e308] * 18) for part in ("pose", "twist")])
    rig.fault_at = None
    rig.stamp += STEP
    rig.answer(stamp)
    rig.send(20)


@fault("a frame name of a hundred kilobytes", NEXT)
def long_frame_name(rig):
    _one(rig, "malformed: a frame's name has 1000", frame="$(id); `id`\n" + "x" * 100_000)


@fault("a frame name with line breaks and shell characters", NEXT)
def odd_frame_name(rig):
    _one(rig, r"frame: frame of the pose is '\$\(id\); `id`\\n../../x'", frame="$(id); `id`\n../../x")


@fault("bytes that are no Odometry", NEXT)
def malformed_bytes(rig):
    rig.send(20)
    rig.mark()
    for data in (b"\x00\x01\x00\x00", b"\xff" * 40, b"\x00\x01\x00\x00" + b"\xff" * 60):
        rig.peer.odometry.send_payload(data)
    rig.expect("input", "malformed")
    rig.send(20)


@fault("a stamp before 1970", NEXT)
def negative_stamp(rig):
    rig.send(20)
    rig.bad(stamp=-BEGIN)
    rig.expect("input", "reordered")
    rig.send(20)


@fault("nanoseconds of 4 000 000 000 in a stamp", NEXT)
def odd_nanoseconds(rig):
    rig.send(20)
    rig.bad(change=lambda message: message["header"]["stamp"].update(nanosec=4_000_000_000))
    rig.expect("input", "malformed: stamp has")
    rig.send(20)
