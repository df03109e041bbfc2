"""The start-up check tells a twist in the wrong frame or convention from one in the right one."""
import math

import pytest

from mooring_ros.motion import Adapter, ConventionCheck, rotation
from mooring_ros.motion.convention_check import MISSING, OK, UNDECIDED, WRONG


def motion(t, heading, amplitude=2.0):
    """Pose and world twist: surge and pitch about a fixed heading, with some sway and heave."""
    w = 0.5
    q = rotation.multiply(rotation.from_rotation_vector((0.0, 0.0, heading)), rotation.from_rotation_vector((0.0, 0.1 * math.sin(w * t), 0.0)))
    position = (amplitude * math.sin(w * t), 0.3 * amplitude * math.sin(w * t + 1.0), 0.2 * amplitude * math.cos(w * t))
    velocity = (amplitude * w * math.cos(w * t), 0.3 * amplitude * w * math.cos(w * t + 1.0), -0.2 * amplitude * w * math.sin(w * t))
    turning = rotation.rotate(rotation.from_rotation_vector((0.0, 0.0, heading)), (0.0, 0.1 * w * math.cos(w * t), 0.0))
    return (*position, *q), (*velocity, *turning)


def as_sent(q, twist, frame, convention):
    """World twist inside as a source of the given frame and convention would send it."""
    parts = []
    for v in (twist[:3], twist[3:]):
        if frame == "child":
            v = rotation.rotate(rotation.conjugate(q), v)
            parts += v if convention == "enu" else (v[0], -v[1], -v[2])
        else:
            parts += v if convention == "enu" else (v[1], v[0], -v[2])
    return tuple(parts)


def verdict(assumed, sent, heading=1.2, seconds=5.0, rate=20.0, amplitude=2.0):
    check = ConventionCheck(Adapter(twist_frame=assumed[0], convention=assumed[1]))
    for k in range(round(seconds * rate)):
        pose, twist = motion(k / rate, heading, amplitude)
        check.add(round(k / rate * 1e9), pose, as_sent(pose[3:], twist, *sent))
    return check.verdict


CONVENTIONS = [("child", "enu"), ("world", "enu"), ("child", "ned"), ("world", "ned")]


@pytest.mark.parametrize("sent", CONVENTIONS)
@pytest.mark.parametrize("assumed", CONVENTIONS)
def test_a_turned_platform_shows_which_convention_its_twist_is_in(assumed, sent):
    result = verdict(assumed, sent)
    if assumed == sent:
        assert result.kind == OK
    else:
        assert result.kind == WRONG
        assert result.fits == (f"twist_frame {sent[0]} in {sent[1].upper()}",)
        assert sent[0] in result.text


def test_a_platform_that_is_not_turned_is_not_refused():
    result = verdict(("child", "enu"), ("world", "enu"), heading=0.0)
    assert result.kind == OK and len(result.fits) == 2


def test_a_platform_at_rest_gives_no_verdict():
    assert verdict(("child", "enu"), ("world", "enu"), amplitude=0.0, seconds=1.0).kind in (UNDECIDED, OK)
    check = ConventionCheck(Adapter())
    for k in range(200):
        check.add(k * 10_000_000, (0.0, 0.0, 0.0, *rotation.IDENTITY), (0.0,) * 6)
    assert check.verdict.kind == UNDECIDED and not check.finished


def test_a_few_samples_give_no_verdict():
    assert verdict(("child", "enu"), ("world", "ned"), seconds=1.0).kind == UNDECIDED


def test_a_twist_left_empty_is_told_apart_from_a_wrong_one():
    check = ConventionCheck(Adapter())
    for k in range(100):
        check.add(k * 50_000_000, motion(k * 0.05, 1.0)[0], (0.0,) * 6)
    assert check.verdict.kind == MISSING and "input: pose" in check.verdict.text


def test_a_twist_that_fits_nothing_is_reported_but_not_called_another_convention():
    check = ConventionCheck(Adapter())
    for k in range(100):
        check.add(k * 50_000_000, motion(k * 0.05, 1.0)[0], (0.3, -0.2, 0.5, 0.1, -0.1, 0.2))
    assert check.verdict.kind == UNDECIDED and "no convention" in check.verdict.text
