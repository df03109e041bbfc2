"""Statics of random scenes with rods, bodies, bridles, bending, slopes and friction: each settles."""

import numpy as np
import pytest
from scenes_in_code import HERE

from mooring_ros import Mooring

from .random_parts import SCENES, random_scene


@pytest.mark.parametrize("kind", SCENES)
def test_random_scenes_with_parts_settle(kind):
    """Six of each kind, seeded; the tension at every fairlead is finite and no line pushes."""
    for seed in range(6):
        mooring = Mooring(random_scene(kind, seed))
        mooring.settle(HERE)
        assert mooring.static_result.converged, seed
        assert np.isfinite(mooring.fairlead_tension).all() and (mooring.fairlead_tension >= 0.0).all(), seed
