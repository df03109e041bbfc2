"""Mooring forces, live: a ROS 2 node, a numba mooring core, and the tools around them."""
