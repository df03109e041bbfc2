"""Checks of the numbers that come into the façade; all raise ValueError with what was expected."""

import numpy as np

QUATERNION_TOLERANCE = 1e-3


def numbers(values, name):
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} is {values!r}; expected numbers") from error


def shaped(values, shape, name, meaning):
    values = numbers(values, name)
    if values.shape != shape:
        raise ValueError(f"{name} has shape {values.shape}; expected {shape}: {meaning}")
    return values


def checked_poses(poses):
    """Copies of poses (..., 7) with unit quaternions; ValueError when they are not finite or far from unit length."""
    if not np.isfinite(poses).all():
        raise ValueError("a pose holds a number that is not finite")
    norm = np.sqrt((poses[..., 3:] ** 2).sum(axis=-1, keepdims=True))
    if (np.abs(norm - 1.0) > QUATERNION_TOLERANCE).any():
        raise ValueError(f"a pose's quaternion has length {norm.flat[np.abs(norm - 1.0).argmax()]:.6g}; expected 1")
    return np.concatenate([poses[..., :3], poses[..., 3:] / norm], axis=-1)


def checked_twists(twists):
    if not np.isfinite(twists).all():
        raise ValueError("a twist holds a number that is not finite")
    return twists
