"""The mooring core: numba kernels over arrays. No ROS, no files, no clock; what allocates nothing cannot surprise in a step."""
