"""Whether an equilibrium stands: Newton's method finds those that topple, too, as a rod balanced upright."""

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import ArpackError, eigsh, splu

NEUTRAL = 1e-6  # of the stiffness by weight: what is softer in any direction neither stands nor topples
STEEPEST = 1e9  # of the same: how unstable anything is taken to be


def direction_of_fall(stiffness, scale):
    """Unit step (count,) along which an equilibrium with `stiffness` (count, count), sparse, gives way fastest, or None where it stands.

    Friction and followers leave the matrix without symmetry: its symmetric half says whether work is gained. scale (count,) N/m or N m: what
    weight alone would resist with.
    """
    scaling = sparse.diags(1.0 / np.sqrt(scale))
    matrix = (scaling @ (0.5 * (stiffness + stiffness.T)) @ scaling).tocsc()
    shift = NEUTRAL
    if _all_positive(matrix, shift):
        return None
    while not _all_positive(matrix, shift):
        shift *= 10.0
        if shift > STEEPEST:
            return None
    start = np.random.default_rng(1).normal(size=scale.size)  # the same every time
    try:
        _, vectors = eigsh(matrix, k=1, sigma=-shift, which="LM", v0=start, tol=1e-3)
    except (ArpackError, RuntimeError):
        return None
    step = scaling @ vectors[:, 0]
    return step / np.abs(step).max()


def _all_positive(matrix, shift):
    """Whether matrix + shift has positive pivots only (Sylvester's law of inertia)."""
    lifted = (matrix + shift * sparse.identity(matrix.shape[0])).tocsc()
    try:
        factors = splu(lifted, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError:  # exactly singular
        return False
    return bool((factors.U.diagonal() > 0.0).all())
