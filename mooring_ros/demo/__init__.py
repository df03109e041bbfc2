"""The demo: a floater simulator as a ROS process, coupled in lockstep with the mooring node."""
