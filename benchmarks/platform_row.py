"""A row of floaters, each moored to its neighbours by a shared chain and each a platform of its own: what a simulated second of it costs."""

import dataclasses
import time

import numpy as np

from mooring_ros import Mooring
from mooring_ros.core.poses import moved
from mooring_ros.scene import load_scene

APART = 1000.0  # m
SIZE, SHORTEST, LONGEST, RAMP = 2.0, 8.0, 15.0, 5.0  # m of surge; periods and start, s


def row_of(count, path):
    """The Scene of `count` floaters in a row, from that of two: the first and the last one have two chains each to the ground."""
    pair = load_scene(path)
    kinds, like = {line.id: line for line in pair.lines}, {point.id: point for point in pair.points}
    points, lines = [], []

    def point(number, body=None, **changed):
        points.append(dataclasses.replace(like[number], id=len(points) + 1, body=body, **changed))
        return len(points)

    def line(number, a, b):
        lines.append(dataclasses.replace(kinds[number], id=len(lines) + 1, end_a=a, end_b=b))

    first, last = pair.bodies
    bodies = [dataclasses.replace(last if k else first, id=k + 1, position=(first.position[0] + APART * k, 0.0, 0.0)) for k in range(count)]
    far = APART * (count - len(pair.bodies))
    for number, fairlead in ((1, 5), (2, 6)):
        line(number, point(number), point(fairlead, 1))
    for number, fairlead in ((3, 8), (4, 9)):
        x, y, z = like[number].position
        line(number, point(number, position=(x + far, y, z)), point(fairlead, count))
    ahead = tuple(np.multiply(like[10].position, (-1.0, 1.0, 1.0)))
    for k in range(1, count):
        line(5, point(7, k) if k == 1 else point(10, k, position=ahead), point(10, k + 1))
    return dataclasses.replace(pair, bodies=tuple(bodies), points=tuple(points), lines=tuple(lines))


def cost(count, path, sample=0.05):
    """(lines, CPU time (s) for one simulated second), each floater in surge with a period of its own."""
    scene = row_of(count, path)
    mooring = Mooring(scene, platforms=[body.name for body in scene.bodies])
    times = np.arange(1, 201) * sample
    w = 2.0 * np.pi / np.linspace(SHORTEST, LONGEST, count)
    share = np.clip(times / RAMP, 0.0, 1.0)[:, None]
    ramp, slope = share * share * (3.0 - 2.0 * share), 6.0 * share * (1.0 - share) / RAMP
    offsets, rates = np.zeros((2, times.size, count, 6))
    offsets[:, :, 0] = SIZE * ramp * np.sin(w * times[:, None])
    rates[:, :, 0] = SIZE * (ramp * w * np.cos(w * times[:, None]) + slope * np.sin(w * times[:, None]))
    start, least = mooring.pose_in_file, np.inf
    poses = np.array([moved(start, offset.ravel()) for offset in offsets])
    mooring.settle(start)
    saved = mooring.snapshot()
    for _ in range(10):
        mooring.restore(saved)
        began = time.process_time()
        mooring.run(times, poses, rates)
        least = min(least, time.process_time() - began)
    return len(scene.lines), least / times[-1]
