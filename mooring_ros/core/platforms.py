"""Platforms M over an interval between two samples: their motions, their mean accelerations, and where they come to stand."""

from .cache import stage
from .platform import start_motion


@stage
def start_motions(state, poses, twists, duration, motions):
    """`start_motion` of all platforms to poses (M, 7) and twists (M, 6) after `duration` (s), into motions (M, 8, 3)."""
    for m in range(motions.shape[0]):
        start_motion(state.pose[m], state.twist[m], poses[m], twists[m], duration, motions[m])


@stage
def average_acceleration(state, scratch, twists, duration, share):
    """Give the platforms the mean acceleration of an interval to twists (M, 6): `share` (0..1) of it, the rest as it was. `recall_acceleration` undoes it."""
    a = state.acceleration_of_platform
    for m in range(a.shape[0]):
        for i in range(6):
            scratch.saved_platforms[m, i] = a[m, i]
            a[m, i] += share * ((twists[m, i] - state.twist[m, i]) / duration - a[m, i])


@stage
def recall_acceleration(state, scratch):
    for m in range(state.twist.shape[0]):
        for i in range(6):
            state.acceleration_of_platform[m, i] = scratch.saved_platforms[m, i]


@stage
def end_interval(state, time, poses, twists):
    """Stand at `time` (s), with the platforms at poses (M, 7) and twists (M, 6)."""
    for m in range(state.twist.shape[0]):
        for i in range(7):
            state.pose[m, i] = poses[m, i]
        for i in range(6):
            state.twist[m, i] = twists[m, i]
    state.clock[0] = time
