"""Motions as CSV files."""

import math

import numpy as np


def write_motion(path, duration=6.0, step=0.1):
    """CSV of a surge and pitch motion that starts at rest."""
    rows = ["t,x,y,z,roll,pitch,yaw"]
    for instant in np.arange(0.0, duration + step / 2, step):
        surge = 2.0 * (1.0 - math.cos(2.0 * math.pi * instant / 6.0))
        rows.append(f"{instant:.3f},{surge!r},0,0,0,{surge / 2!r},0")
    path.write_text("\n".join(rows) + "\n")
    return path
