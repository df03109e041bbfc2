"""Things that hang together, found from the links between them; and the whole numbers that meshes are made of."""

from collections.abc import Iterable


def group_of_each(count: int, links: Iterable[tuple[int, int]]) -> list[int]:
    """The least number of the group of each of `count` things; those that a link names are in one group."""
    leader = list(range(count))

    def first(k):
        while leader[k] != k:
            leader[k] = leader[leader[k]]
            k = leader[k]
        return k

    for one, other in links:
        low, high = sorted((first(one), first(other)))
        leader[high] = low
    return [first(k) for k in range(count)]


def times_segments(factor: float, segments: int) -> int:
    """`factor` times as many segments: a whole number, at least 1."""
    return max(1, round(factor * segments))
