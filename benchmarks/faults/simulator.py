"""A simulator as a process of its own, which knows no lockstep: `python -m benchmarks.faults.simulator DOMAIN BEGIN SHIFT`.

Sends the motion of `motion.at` at 50 Hz from the stamp BEGIN (ns) on, displaced by SHIFT (m), and says each stamp on its standard output.
"""
import sys
import time

import rosless

from . import motion
from .peer import wait_until_heard
from .rig import STEP


def main(domain, begin, shift):
    """Send until killed."""
    odometry = rosless.Node(domain=domain).advertise("/platform/odom", "nav_msgs/msg/Odometry", reliability="reliable", depth=1000)
    wait_until_heard(odometry)
    stamp, due = begin, time.monotonic()
    while True:
        state = motion.at(stamp * 1e-9)
        x, *rest = state.pose
        odometry.send(motion.odometry(stamp, state._replace(pose=(x + shift, *rest))))
        print(stamp, flush=True)
        stamp += STEP
        due += STEP * 1e-9
        time.sleep(max(due - time.monotonic(), 0.0))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3]))
