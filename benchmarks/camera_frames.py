"""Inputs as camera systems record them, made from a motion that is known: frames at a steady rate, noise, and what goes wrong with them.

The platform moves as in waves of 1 s at a scale of 1:50, and turns. All randomness is from one fixed seed for each input.
"""
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from mooring_ros.motion import Sample

RATE = 250.0            # Hz: frames 4 ms apart
NOISE = 1e-4            # m
ANGLE_NOISE = 5e-4      # rad
_START = 1_760_000_000 * 10 ** 9    # ns, a wall clock
_OMEGA = 2.0 * np.pi


class Frame(NamedTuple):
    """sample: as it is received. time: s since the first frame when it was taken. pose (7,), twist (6,): the true ones then."""

    sample: Sample
    time: float
    pose: np.ndarray
    twist: np.ndarray


def truth(t, turning=True):
    """Pose (7,) and twist (6,), world axes, at time t (s): surge 40 mm, heave 30 mm, and, turning, pitch 5 degrees, at 1 Hz."""
    phase = _OMEGA * t
    angle, rate = (0.09 * np.sin(phase + 1.0), 0.09 * _OMEGA * np.cos(phase + 1.0)) if turning else (0.0, 0.0)
    pose = np.array([0.04 * np.sin(phase), 0.0, 0.03 * np.cos(phase), *Rotation.from_rotvec([0.0, angle, 0.0]).as_quat()])
    return pose, np.array([0.04 * _OMEGA * np.cos(phase), 0.0, -0.03 * _OMEGA * np.sin(phase), 0.0, rate, 0.0])


def frames(seconds=4.0, rate=RATE, noise=1.0, moving=True, turning=True, seed=1):
    """Good frames with the stamps of when they were taken. noise: times NOISE and ANGLE_NOISE. moving, turning: whether the platform does."""
    random = np.random.default_rng(seed)
    made = []
    for k in range(round(seconds * rate)):
        t = k / rate
        pose, twist = truth(t if moving else 0.0, turning)
        twist = twist if moving else np.zeros(6)
        measured = pose[:3] + noise * NOISE * random.standard_normal(3)
        turned = Rotation.from_rotvec(noise * ANGLE_NOISE * random.standard_normal(3)) * Rotation.from_quat(pose[3:])
        made.append(Frame(_sample(t, (*measured, *turned.as_quat())), t, pose, twist))
    return made


def stamped(made, delays):
    """The frames with the stamps of their arrival: delays (n,) s after they were taken, in order and never together."""
    arrivals = np.maximum.accumulate(np.array([frame.time for frame in made]) + delays)
    arrivals += 1e-4 * _place_in_bunch(arrivals)
    return [frame._replace(sample=frame.sample._replace(stamp=_stamp(t))) for frame, t in zip(made, arrivals)]


def late(made, jitter=1.5e-3, seed=2):
    """Stamps of arrival, late by some ms now and then."""
    return stamped(made, np.random.default_rng(seed).exponential(jitter / 3.0, len(made)).clip(0.0, jitter))


def bunched(made, every=25, pause=4, seed=3):
    """Every now and then the network stands still for some frames, which then come together, 0.1 ms apart."""
    random = np.random.default_rng(seed)
    delays = np.zeros(len(made))
    k = every
    while k < len(made) - pause:
        length = random.integers(2, pause + 1)
        delays[k:k + length] = [made[k + length - 1].time - frame.time for frame in made[k:k + length]]
        k += length + random.integers(every // 2, every)
    return stamped(made, delays)


def skipped(made, every=25, most=4, seed=4):
    """Every now and then some frames never come."""
    random = np.random.default_rng(seed)
    kept, k = [], 0
    while k < len(made):
        run = random.integers(every // 2, every)
        kept += made[k:k + run]
        k += run + random.integers(1, most + 1)
    return kept


def occluded(made, begin, count, how=float("nan")):
    """Frames begin … begin + count − 1 come without the platform: NaN throughout, or a pose of zeros."""
    hidden = [frame._replace(sample=frame.sample._replace(pose=(how,) * 7)) for frame in made[begin:begin + count]]
    return made[:begin] + hidden + made[begin + count:]


def _place_in_bunch(arrivals):
    place = np.zeros(len(arrivals))
    for k in range(1, len(arrivals)):
        place[k] = place[k - 1] + 1.0 if arrivals[k] <= arrivals[k - 1] else 0.0
    return place


def _stamp(t):
    return _START + round(t * 1e9)


def _sample(t, pose):
    return Sample(_stamp(t), tuple(float(c) for c in pose), None, "world", "")
