"""What hangs together, and meshes in whole numbers."""

import pytest

from mooring_ros.scene.grouping import group_of_each, times_segments


def test_links_join_whatever_their_order():
    assert group_of_each(6, [(4, 5), (1, 3), (3, 4)]) == [0, 1, 2, 1, 1, 1]
    assert group_of_each(6, [(3, 4), (5, 4), (3, 1)]) == [0, 1, 2, 1, 1, 1]


def test_nothing_linked_stands_alone():
    assert group_of_each(3, []) == [0, 1, 2]


@pytest.mark.parametrize("factor, segments, expected", [(2, 20, 40), (0.01, 20, 1), (1.26, 10, 13)])
def test_segments_are_whole_and_at_least_one(factor, segments, expected):
    assert times_segments(factor, segments) == expected
