"""The moorings' stiffness for a simulator that couples with it: [wrench][motion], −∂wrench/∂pose of the equilibrium at the present pose.

It is solved after a settle, and then, only while somebody listens, when the platform has left the range in which the last one holds. A step that has been
answered is not delayed by it; the next input waits for as long as the statics take (some ms, see docs/coupling.md).
"""
from dataclasses import replace

import numpy as np
from scipy.linalg import block_diag
from std_msgs.msg import Float64MultiArray, MultiArrayDimension

from mooring_ros.mooring import MooringError
from mooring_ros.motion import rotation
from mooring_ros.node.messages import floats
from mooring_ros.node.template import Template, placeholder
from mooring_ros.platforms import platform_count

RANGE = 1e-3            # of the longest line: a move that changes the stiffness of a catenary by some percent at most
RANGE_ANGLE = 3e-3      # rad


def stiffness_out(stiffness, adapter, pose):
    """A stiffness (6, 6), inside, in the axes, convention and scale of the wrenches that go out; pose (7,) is inside. Of M platforms (6 M, 6 M) and (M, 7).

    Forces and moves are both along those axes, moments and turns about them, through the reference point.
    """
    axes, poses = replace(adapter, scale=1.0, density_ratio=1.0), np.reshape(pose, (-1, 7))
    turn = block_diag(*(axes.wrenches_out(np.eye(6), own).T for own in poses))
    loads = np.tile(np.repeat([adapter.force_factor, adapter.moment_factor], 3), len(poses))
    moves = np.tile(np.repeat([adapter.length_factor, 1.0], 3), len(poses))
    return loads[:, None] * (turn @ stiffness @ turn.T) / moves


class Stiffness:
    """Decides when the stiffness is due, and makes its message.

    mooring, adapter: see outputs. rate: Hz in the time of the input, may be changed; 0 is never. problem: why the last one could not be solved, or "".
    """

    def __init__(self, mooring, adapter, rate):
        self._mooring, self._adapter = mooring, adapter
        self.rate, self.problem = rate, ""
        self._range = RANGE * max(mooring.unstretched_length, default=np.inf)
        self._at = self._pose = None
        self._settles = 0
        size = 6 * platform_count(mooring.platforms)
        slot = placeholder(size * size)
        message = Float64MultiArray(data=floats(slot))
        message.layout.dim = [MultiArrayDimension(label="wrench", size=size, stride=size * size), MultiArrayDimension(label="motion", size=size, stride=size)]
        self._template = Template(message, [slot])

    def message(self, stamp, settles, wanted):
        """The bytes of the message after an answer at stamp (ns), or None when it is not due. settles: how many there have been; wanted: somebody listens."""
        if not self.rate or not (settles != self._settles or wanted and self._due(stamp)):
            return None
        self._settles = settles
        self._at, pose = stamp, self._mooring.pose
        try:
            stiffness = self._mooring.stiffness()
        except MooringError as error:
            self.problem = str(error)
            return None
        self.problem, self._pose = "", pose
        return self._template.fill(0, stiffness_out(stiffness, self._adapter, pose).ravel())

    def _due(self, stamp):
        if self._at is not None and 0 <= stamp - self._at < 0.999e9 / self.rate:
            return False
        return self._pose is None or self._left(self._mooring.pose)

    def _left(self, pose):
        return any(self._far(own, before) for own, before in zip(pose.reshape(-1, 7), self._pose.reshape(-1, 7)))

    def _far(self, pose, before):
        moved, turned = pose[:3] - before[:3], rotation.turn_between(before[3:], pose[3:])
        return np.linalg.norm(moved) > self._range or np.linalg.norm(turned) > RANGE_ANGLE
