"""Floater and moorings integrated as one system, the reference of the coupled decays.

The unknowns are the floater's pose and twist and the places and velocities of all free nodes; the forces on the nodes are one evaluation of the core's stages, without a
time step of their own, and the floater feels them at the same instant. scipy's DOP853 integrates it all to a tight tolerance: nothing here couples, steps or holds.
"""

import numpy as np
from scipy.integrate import solve_ivp

from mooring_ros.core.forces import evaluate_once
from mooring_ros.core.readings import observe
from mooring_ros.demo.floater import quaternion_rate, rotation_matrix
from mooring_ros.mooring import Mooring

TOLERANCE = 1e-8  # relative; absolute, of places: times a metre
_TURNS = 3  # of the platform's acceleration, of which the end nodes' inertia takes a thousandth back


class Whole:
    """A floater on a Mooring of lines from fixed anchors to the platform, settled; the moorings are its own from here on."""

    def __init__(self, floater, mooring):
        if type(mooring) is not Mooring or mooring.scene.bodies or mooring.scene.rods or mooring.pose.ndim != 1:
            raise ValueError("expected a mooring of lines alone, of one fidelity, on one platform")
        self._floater, self._m = floater, mooring
        model, state = mooring._model, mooring._state
        self._free = np.flatnonzero(~state.slaved[: model.size] & (model.mass[: model.size] > 0.0))
        self._points = model.point_node[model.coupled_points]
        self._arms = model.point_place[model.coupled_points]
        self._acceleration = np.zeros(6)

    def run(self, pose, times):
        """Poses (n, 7) and twists (n, 6) at times (n,), s, of the floater let go at rest at `pose`."""
        self._m.settle(pose)
        size, state = 3 * self._free.size, self._m._state
        begin = np.concatenate([pose, np.zeros(6), state.position[:, self._free].ravel(), np.zeros(size)])
        done = solve_ivp(self._rate, (0.0, times[-1]), begin, method="DOP853", t_eval=times, rtol=TOLERANCE, atol=TOLERANCE)
        if not done.success:
            raise ArithmeticError(done.message)
        return done.y[:7].T, done.y[7:13].T

    def _rate(self, _, y):
        model, state, scratch = self._m._model, self._m._state, self._m._scratch
        size = 3 * self._free.size
        pose, twist = y[:7].copy(), y[7:13]
        pose[3:] /= np.linalg.norm(pose[3:])
        state.pose[:], state.twist[:] = pose, twist
        state.position[:, self._free] = y[13 : 13 + size].reshape(3, -1)
        state.velocity[:, self._free] = y[13 + size :].reshape(3, -1)
        arms = self._arms @ rotation_matrix(pose[3:]).T
        state.position[:, self._points] = (pose[:3] + arms).T
        state.velocity[:, self._points] = (twist[:3] + np.cross(twist[3:], arms)).T
        evaluate_once(model, state, scratch, 0.0, 0.0, False)
        for _ in range(_TURNS):
            state.acceleration_of_platform[:] = self._acceleration
            observe(model, state, 0, self._m._readings)
            self._acceleration = self._floater.acceleration(pose, twist, self._m.wrench)
        nodes = state.acceleration[:, self._free].ravel()
        return np.concatenate([twist[:3], quaternion_rate(pose[3:], twist[3:]), self._acceleration, y[13 + size :], nodes])
