"""From forces to accelerations: the inverse of m (I - t t') + m_a t t' at each node."""

from .cache import stage
from .tension import TINY


@stage
def accelerations(model, state):
    """a = F/m + t (t.F) (1/m_a - 1/m) with the node's tangent t; vertical acceleration relieved for nodes that the bed pushes."""
    fx, fy, fz = state.force[0], state.force[1], state.force[2]
    qx, qy, qz = state.tangent[0], state.tangent[1], state.tangent[2]
    ax, ay, az = state.acceleration[0], state.acceleration[1], state.acceleration[2]
    relief = state.bed_relief
    normal, axial = state.inertia_normal, state.inertia_axial
    for i in range(model.size):
        tx, ty, tz = qx[i] + qx[i + 1], qy[i] + qy[i + 1], qz[i] + qz[i + 1]
        square = max(tx * tx + ty * ty + tz * tz, TINY)
        both = 1.0 / (normal[i] * axial[i] * square + 1e-300)
        across = axial[i] * square * both
        along = (tx * fx[i] + ty * fy[i] + tz * fz[i]) * (normal[i] - axial[i]) * both
        ax[i] = across * fx[i] + along * tx
        ay[i] = across * fy[i] + along * ty
        az[i] = (across * fz[i] + along * tz) * relief[i]
