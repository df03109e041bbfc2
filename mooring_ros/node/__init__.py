"""The ROS 2 node: parameters, timing, messages, diagnostics and markers around the motion gate and the mooring core."""
