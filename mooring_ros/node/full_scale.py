"""`~/full_scale/…`: the answers once more at the scale of the scene, on topics of their own, so that no message mixes scales. Needs no ROS graph.

Forces and moments are those that went out times λ³ and λ⁴ and the ratio of the densities; lengths and speeds those of the scene. Axes and
stamps are the source's: a stamp is a name that leads back to the input, and is not scaled.
"""
import dataclasses

import numpy as np

from mooring_ros.node import messages

PREFIX = "full_scale"


class FullScale:
    """Composes the messages. topics: name below the node -> type name."""

    def __init__(self, mooring, adapter, wrench_frame="world", world_frame="world"):
        unscaled = dataclasses.replace(adapter, scale=1.0, density_ratio=1.0)
        self._messages = messages.Messages(mooring, unscaled, wrench_frame, world_frame)
        self._factors = np.repeat([1.0 / adapter.force_factor, 1.0 / adapter.moment_factor], 3)
        self._wrenches = [*messages.total_topics(PREFIX, mooring.platforms), *(messages.fairlead_topic(PREFIX, name) for name in mooring.coupled_names)]
        self.topics = {**dict.fromkeys(self._wrenches, messages.WRENCH), f"{PREFIX}/lines": messages.JOINT_STATE,
                       f"{PREFIX}/line_tensions": messages.FLOAT_ARRAY}

    def wrenches(self, stamp, wrenches):
        """(name, type name, bytes) of the wrenches (platforms + coupled, 6) as they went out at the source's scale."""
        for row, (name, wrench) in enumerate(zip(self._wrenches, wrenches * self._factors)):
            yield name, messages.WRENCH, self._messages.wrench(stamp, wrench, row)

    def lines(self, stamp, mooring):
        """(name, type name, bytes) of the lines' lengths and tensions."""
        yield f"{PREFIX}/lines", messages.JOINT_STATE, self._messages.lines(stamp, mooring)
        yield f"{PREFIX}/line_tensions", messages.FLOAT_ARRAY, self._messages.line_tensions(mooring)
