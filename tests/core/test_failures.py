"""Lines that part at a time or at a tension."""

import numpy as np
import pytest
from scenes_in_code import FIXED, FREE, line_type, scene

from mooring_ros.core.failures import build_failures, failure_rows, part
from mooring_ros.core.model import LOOSE
from mooring_ros.scene.description import Failure

# three lines of 3 segments, nodes 0-3, 4-7, 8-11; points 0-3 at nodes 12-15, 4 and 5 reserved at 16 and 17
END_NODE = np.array([0, 3, 4, 7, 8, 11])
POINT_NODE = np.arange(12, 18)


class Mooring:
    def __init__(self, *rows):
        self.failures = build_failures(list(rows))
        self.end_point = np.array([0, 3, 1, 3, 2, 3])
        self.position, self.velocity = np.arange(54.0).reshape(3, 18), -np.arange(54.0).reshape(3, 18)
        self.tension, self.failed = np.zeros(18), np.zeros(len(rows), dtype=np.int64)

    def part(self, time):
        return part(
            self.failures, time, self.tension, self.end_point, END_NODE, self.position, self.velocity, POINT_NODE, self.failed
        )


def test_lines_part_at_the_time_and_stay_together():
    mooring = Mooring((3, 4, [1, 3], 12.0, np.inf))
    assert mooring.part(11.999) == 0
    np.testing.assert_array_equal(mooring.end_point, [0, 3, 1, 3, 2, 3])
    assert mooring.part(12.0) == 1
    np.testing.assert_array_equal(mooring.end_point, [0, 4, 1, 4, 2, 3])
    np.testing.assert_array_equal(mooring.position[:, 16], mooring.position[:, 15])
    np.testing.assert_array_equal(mooring.velocity[:, 16], mooring.velocity[:, 15])
    mooring.position[:, 16] += 5.0
    assert mooring.part(13.0) == 0
    assert (mooring.position[:, 16] != mooring.position[:, 15]).all()


@pytest.mark.parametrize(("segment", "parts"), [(3, True), (7, True), (11, False), (1, False), (2, False), (5, False)])
def test_lines_part_at_the_tension_of_their_segments_at_that_end(segment, parts):
    """Of any of the lines named, at that end; those of other lines, and other segments of the same, do not count."""
    mooring = Mooring((3, 4, [1, 3], np.inf, 1e6))
    mooring.tension[segment] = 1e6
    assert mooring.part(1.0) == 0
    mooring.tension[segment] = 1.0001e6
    assert mooring.part(1.0) == parts
    assert mooring.failed[0] == parts


def test_tension_at_end_a_is_that_of_the_first_segment():
    mooring = Mooring((1, 4, [2], np.inf, 1e6))
    mooring.tension[4] = 2e6  # the null segment before the line
    assert mooring.part(0.0) == 0
    mooring.tension[5] = 2e6
    assert mooring.part(0.0) == 1
    assert mooring.end_point[2] == 4


def test_what_has_parted_already_is_left_alone():
    """Let go of by hand or by another failure: it neither counts for the tension nor comes back."""
    mooring = Mooring((3, 4, [1], 5.0, np.inf), (3, 5, [1, 3], np.inf, 1e6))
    mooring.end_point[3] = LOOSE
    mooring.tension[7] = 2e6
    assert mooring.part(0.0) == 0
    assert mooring.part(5.0) == 1
    mooring.tension[3] = 2e6
    assert mooring.part(6.0) == 0
    np.testing.assert_array_equal(mooring.end_point, [0, 4, 1, LOOSE, 2, 3])
    np.testing.assert_array_equal(mooring.failed, [1, 0])


def test_two_failures_at_once():
    mooring = Mooring((0, 4, [0], 1.0, np.inf), (3, 5, [5], 1.0, np.inf))
    assert mooring.part(1.0) == 2
    np.testing.assert_array_equal(mooring.end_point, [4, 3, 1, 3, 2, 5])


def test_none():
    mooring = Mooring()
    assert mooring.part(1e9) == 0


def test_rows_from_the_scene():
    """Ends at the holder of the lines named, both ends of a line that begins and ends there; points reserved in turn."""
    kind = line_type()
    points = [(FIXED, (0, 0, -50)), (FREE, (10, 0, -40), 100.0), (FIXED, (20, 0, -50))]
    description = scene(points, [(kind, 1, 2, 20.0, 3), (kind, 3, 2, 20.0, 3), (kind, 2, 2, 20.0, 4)])
    failures = (Failure(1, 2, (1, 3), tension=1e6), Failure(2, 3, (2,), time=4.0))
    rows = failure_rows(failures, description.lines, {1: 0, 2: 1, 3: 2}, 3)
    assert rows == [(1, 3, [1, 4, 5], np.inf, 1e6), (2, 4, [2], 4.0, np.inf)]
