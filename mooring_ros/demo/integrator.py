"""Steps the floater from sample to sample, with one mooring wrench a sample.

Scheme: Heun (explicit trapezium, second order). At t_n the mooring answers once, with the wrench at t_n. The wrench at
t_{n+1}, which the corrector needs, is extrapolated in a straight line from the last two answers: this keeps the second
order and leaves no delay, which would act as negative damping. Everything else (hydrostatics, damping, waves) is evaluated
at both ends of the step.
"""

import numpy as np

from mooring_ros.coupling.schemes import Extrapolated
from mooring_ros.demo.floater import quaternion_rate


class Integrator:
    """The floater's state and the way it advances.

    floater: has acceleration(pose, twist, wrench); excitation: called with a time (s), returns a wrench (6,); step: s.
    time (s), pose (7,) and twist (6,) are where the floater stands.
    """

    def __init__(self, floater, excitation, step, pose=(0, 0, 0, 0, 0, 0, 1), twist=(0, 0, 0, 0, 0, 0)):
        self.floater, self.excitation, self.step = floater, excitation, step
        self.pose, self.twist = np.array(pose, float), np.array(twist, float)
        self.count = 0
        self._wave = excitation(0.0)
        self._mooring = Extrapolated()

    @property
    def time(self):
        return self.count * self.step

    def advance(self, mooring_wrench):
        """One step, given the mooring wrench (6,) at the present time. Raises ArithmeticError when the state is not finite."""
        wrench = np.asarray(mooring_wrench, float)
        self._mooring.take(self.time, self.pose, self.twist, wrench)
        ahead = self._mooring.ahead(self.step)
        next_wave = self.excitation((self.count + 1) * self.step)
        pose_rate, twist_rate = self._rates(self.pose, self.twist, wrench + self._wave)
        trial_pose = _normalised(self.pose + self.step * pose_rate)
        trial_twist = self.twist + self.step * twist_rate
        end_pose_rate, end_twist_rate = self._rates(trial_pose, trial_twist, ahead + next_wave)
        pose = _normalised(self.pose + 0.5 * self.step * (pose_rate + end_pose_rate))
        twist = self.twist + 0.5 * self.step * (twist_rate + end_twist_rate)
        if not (np.isfinite(pose).all() and np.isfinite(twist).all()):
            raise ArithmeticError(f"the floater's motion is not finite after {self.time + self.step:.3f} s")
        self.pose, self.twist, self._wave = pose, twist, next_wave
        self.count += 1

    def _rates(self, pose, twist, wrench):
        pose_rate = np.concatenate([twist[:3], quaternion_rate(pose[3:7], twist[3:])])
        return pose_rate, self.floater.acceleration(pose, twist, wrench)


def _normalised(pose):
    pose[3:7] /= np.linalg.norm(pose[3:7])
    return pose
