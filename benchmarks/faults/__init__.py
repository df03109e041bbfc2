"""Faults, done to a running node from outside: `./run bench faults`, `./run bench soak`.

The peer that moves the platform and hears the node is `rosless`, a DDS library that shares no code with rclpy; services alone go through rclpy.
"""
