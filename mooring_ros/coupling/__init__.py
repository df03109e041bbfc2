"""Coupling one's own simulator with a mooring node, in lockstep over ROS: see docs/coupling.md."""

from mooring_ros.coupling.link import Counts, LinkError, MooringLink, Stopped
from mooring_ros.coupling.lockstep import Coupling
from mooring_ros.coupling.schemes import SCHEMES

__all__ = ["SCHEMES", "Counts", "Coupling", "LinkError", "MooringLink", "Stopped"]
