"""Statics of random scenes with rods, bodies, bridles, bending, slopes and friction: each settles, or says clearly that it does not."""

import numpy as np
import pytest
from scenes_in_code import HERE

from mooring_ros import Mooring, MooringError

from .random_parts import SCENES, random_scene

REFUSED = {"buoy": 1}  # of six: a buoy that lines with bending stiffness draw through the surface


@pytest.mark.parametrize("kind", SCENES)
def test_random_scenes_with_parts_settle(kind):
    """Six of each kind, seeded; the tension at every fairlead is finite and no line pushes. A buoy may be refused."""
    refused = 0
    for seed in range(6):
        mooring = Mooring(random_scene(kind, seed))
        try:
            mooring.settle(HERE)
        except MooringError as error:
            assert "did not converge" in str(error)
            refused += 1
            continue
        assert mooring.static_result.converged, seed
        assert np.isfinite(mooring.fairlead_tension).all() and (mooring.fairlead_tension >= 0.0).all(), seed
    assert refused <= REFUSED.get(kind, 0)
