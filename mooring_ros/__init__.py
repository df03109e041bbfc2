"""Mooring forces, live: a ROS 2 node, a numba mooring core, and the tools around them."""

from .errors import MooringError
from .fleet import Fleet
from .mooring import Mooring
from .scene import SceneError

__all__ = ["Fleet", "Mooring", "MooringError", "SceneError"]
__version__ = "0.1.0"
