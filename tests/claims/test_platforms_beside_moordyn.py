"""Claim: two floaters that share a chain, each with a motion of its own, feel what MoorDyn's two coupled bodies feel."""

import pytest

pytest.importorskip("moordyn")

from benchmarks import platforms  # noqa: E402


def test_tensions_and_wrenches_of_both_floaters_are_those_of_moordyn_within_a_percent_of_their_variation():
    """Surge, sway and heave of some metres, pitch of 0.06 rad, each with a period of its own, 40 s: rms of the difference, and 0.1 % of the means."""
    for what, ours, theirs in platforms.compared():
        changing, mean = platforms.apart(ours, theirs)
        assert changing.max() < platforms.GOAL and mean.max() < 0.1, what
