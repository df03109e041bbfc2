"""Twist from poses, where a source gives none: offline over a whole history, and online from the last samples."""
import numpy as np

from mooring_ros.motion import rotation
from mooring_ros.motion.prediction import REST
from mooring_ros.motion.tracking import Estimate

_STENCIL = 5


def twist_from_poses(times, poses):
    """Twist of a history of poses: velocity and angular velocity, both in world axes.

    times: (n,) s, strictly increasing, at any spacing. poses: (n, 7) m and unit quaternions (their sign is free).
    Returns (n, 6) m/s and rad/s. Fourth order in the spacing, to the ends; with fewer than five samples as high as they
    allow, and zero for a single one. Raises ValueError for wrong shapes, non-finite numbers, or times that do not increase.
    """
    times = np.asarray(times, dtype=float)
    poses = np.asarray(poses, dtype=float)
    n = times.size
    if times.shape != (n,) or poses.shape != (n, 7) or n == 0:
        raise ValueError(f"times {times.shape} and poses {poses.shape} do not fit, expected (n,) and (n, 7)")
    if not (np.isfinite(times).all() and np.isfinite(poses).all()):
        raise ValueError("times and poses must be finite")
    if n > 1 and not (np.diff(times) > 0.0).all():
        raise ValueError(f"times must increase, but do not after row {int(np.argmin(np.diff(times) > 0.0))}")
    width = min(_STENCIL, n)
    columns = np.clip(np.arange(n) - width // 2, 0, n - width)[:, None] + np.arange(width)
    weights = _derivative_weights(times[columns], np.arange(n) - columns[:, 0])
    velocity = np.einsum("ij,ijk->ik", weights, poses[columns, :3] - poses[:, None, :3])
    turning = np.einsum("ij,ijk->ik", weights, _turns(poses[:, None, 3:], poses[columns, 3:]))
    return np.hstack((velocity, turning))


def _derivative_weights(nodes, at):
    """Weights (n, k) of the derivative at nodes[i, at[i]] of the polynomial through the nodes (n, k)."""
    n, k = nodes.shape
    rows = np.arange(n)
    here = nodes[rows, at]
    weights = np.zeros((n, k))
    for j in range(k):
        others = [m for m in range(k) if m != j]
        scale = np.prod([nodes[:, j] - nodes[:, m] for m in others], axis=0) if others else np.ones(n)
        # Derivative of the product over the others of (t - t_m): one factor left out at a time.
        total = np.zeros(n)
        for left_out in others:
            total += np.prod([here - nodes[:, m] for m in others if m != left_out] or [np.ones(n)], axis=0)
        weights[:, j] = total / scale
    return weights


def _turns(q_from, q_to):
    """Rotation vectors (..., 3), world axes, from q_from to q_to, quaternions (..., 4)."""
    x, y, z, w = np.moveaxis(q_to, -1, 0)
    a, b, c, d = np.moveaxis(q_from, -1, 0)
    vector = np.stack((-w * a + x * d - y * c + z * b,
                       -w * b + y * d - z * a + x * c,
                       -w * c + z * d - x * b + y * a), axis=-1)
    real = w * d + x * a + y * b + z * c
    vector = np.where(real[..., None] < 0.0, -vector, vector)
    sine = np.linalg.norm(vector, axis=-1)
    angle = 2.0 * np.arctan2(sine, np.abs(real))
    return vector * np.where(sine > 1e-12, angle / np.maximum(sine, 1e-300), 2.0)[..., None]


class OnlineTwist:
    """Twist at the newest of the poses seen so far, from the last three of them: second order, nothing from the future, nothing against noise.

    The acceleration is not told: twice differenced, noise would be all of it. `propose` says what a pose would give, `take` goes there, as in
    tracking.PoseFilter.
    """

    def __init__(self):
        self._older = []

    def propose(self, time, pose):
        """The Estimate for a pose (7,) at a time (s) later than the last. The first pose is at rest."""
        older = self._older
        twist = REST
        if older:
            near = self._difference(older[-1].pose, pose)
            h1 = time - older[-1].time
            twist = tuple(change / h1 for change in near)
        if len(older) > 1:
            h2 = time - older[-2].time
            far = self._difference(older[-2].pose, pose)
            near_weight, far_weight = h2 / (h1 * (h2 - h1)), -h1 / (h2 * (h2 - h1))
            twist = tuple(near_weight * a + far_weight * b for a, b in zip(near, far))
        return Estimate(time, tuple(pose), twist, REST)

    def take(self, estimate):
        """Go on from an Estimate that was proposed."""
        self._older = (self._older + [estimate])[-2:]

    @staticmethod
    def _difference(old, pose):
        return (pose[0] - old[0], pose[1] - old[1], pose[2] - old[2], *rotation.turn_between(old[3:], pose[3:]))
