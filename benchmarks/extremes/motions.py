"""Motions of the platform that no ship makes: jumps, turns, pulls and shakes, as samples for `Mooring.run`."""

from dataclasses import dataclass

import numpy as np

HERE = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Samples:
    """Where the platform starts, at rest, and its samples from there."""

    start: np.ndarray  # (7,) pose
    times: np.ndarray  # (k,) s
    poses: np.ndarray  # (k, 7)
    twists: np.ndarray  # (k, 6)


def quintic(s):
    """From 0 to 1 over s = 0 to 1 without speed or acceleration at the ends, and its derivative."""
    s = np.clip(s, 0.0, 1.0)
    return s**3 * (10.0 + s * (6.0 * s - 15.0)), 30.0 * s**2 * (1.0 - s) ** 2


def turned(angles):
    """Quaternions (k, 4) of turns by rotation vectors (k, 3), rad."""
    size = np.linalg.norm(angles, axis=1, keepdims=True)
    return np.hstack([angles * 0.5 * np.sinc(size / (2.0 * np.pi)), np.cos(0.5 * size)])


def samples(times, shift, speed, angle=None, rate=None):
    """Samples from shifts (k, 3), their speeds, and turns about one axis (k, 3) with their rates; from the zero pose at rest."""
    zero = np.zeros((times.size, 3))
    poses = np.hstack([shift, turned(zero if angle is None else angle)])
    return Samples(HERE, times, poses, np.hstack([speed, zero if rate is None else rate]))


def move(shift=(0.0, 0.0, 0.0), turn=(0.0, 0.0, 0.0), over=1.0, hold=0.0, every=0.05, times=None):
    """Smoothly to a shift (m) and a turn (rotation vector, rad) over `over` s, and stay there for `hold` s; a sample `every` s."""
    if times is None:
        times = np.arange(1, int(round((over + hold) / every)) + 1) * every
    share, rate = quintic(times / over)
    rate = rate / over
    shift, turn = np.array(shift, dtype=float), np.array(turn, dtype=float)
    return samples(times, share[:, None] * shift, rate[:, None] * shift, share[:, None] * turn, rate[:, None] * turn)


def jump(shift=(0.0, 0.0, 0.0), turn=(0.0, 0.0, 0.0), within=0.05, hold=60.0, every=0.05):
    """From one sample to the next; the samples say that it rests before and after."""
    return move(shift, turn, over=within, hold=hold, every=every)


def pull(velocity, duration, every=0.05, start=0.001):
    """At a constant velocity (3,) m/s from the first sample on, which is `start` s after rest."""
    times = np.append(start, start + np.arange(1, int(round(duration / every)) + 1) * every)
    velocity = np.array(velocity, dtype=float)
    return samples(times, times[:, None] * velocity, np.tile(velocity, (times.size, 1)))


def sway(shift, period, duration, every=0.05, times=None, turn=(0.0, 0.0, 0.0)):
    """There and back again like a sine, ramped up from rest over the first period; with a turn (rotation vector, rad) in step with it."""
    if times is None:
        times = np.arange(1, int(round(duration / every)) + 1) * every
    w = 2.0 * np.pi / period
    ramp, slope = quintic(times / period)
    value = ramp * np.sin(w * times)
    rate = slope / period * np.sin(w * times) + ramp * w * np.cos(w * times)
    shift, turn = np.array(shift, dtype=float), np.array(turn, dtype=float)
    return samples(times, value[:, None] * shift, rate[:, None] * shift, value[:, None] * turn, rate[:, None] * turn)
