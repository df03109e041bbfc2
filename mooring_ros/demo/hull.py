"""The wetted hull of the demo's floater as strips, for the wave forces.

The shape is that of the VolturnUS-S platform of Allen et al., "Definition of the UMaine VolturnUS-S Reference Platform
Developed for the IEA Wind 15-Megawatt Offshore Reference Wind Turbine" (NREL/TP-5000-76773, 2020): three outer columns
and a central one, joined by three rectangular pontoons; one outer column points to −x.
"""

from dataclasses import dataclass

import numpy as np

# From the report.
DRAFT = 20.0
COLUMN_RADIUS = 51.75  # m, axis of an outer column from the central axis
OUTER_DIAMETER = 12.5
CENTRAL_DIAMETER = 10.0
PONTOON_WIDTH = 12.5
PONTOON_HEIGHT = 7.0
PONTOON_DEPTH = 16.5  # m, axis below the water line
DISPLACEMENT = 20206.0  # m³
HEADINGS = np.radians([180.0, 60.0, -60.0])

# Chosen: added masses over displaced masses (or over a hemisphere, for the columns' feet), such that the strips add up to
# the zero-frequency added mass of the published WAMIT results in surge and heave within 3 %.
_COLUMN_ADDED_MASS = 1.0
_FOOT_ADDED_MASS = 1.0
_PONTOON_VERTICAL = 2.1
_PONTOON_LATERAL = 0.6

_SLICES = 20  # for each member


@dataclass(frozen=True)
class Hull:
    """n strips and the water plane's m discs, about the reference point at the still water line, body axes = world axes.

    position (n, 3) m; volume (n,) m³; added_mass (n, 3, 3) over the density, m³; disc_position (m, 3) m; disc_area (m,) m².
    """

    position: np.ndarray
    volume: np.ndarray
    added_mass: np.ndarray
    disc_position: np.ndarray
    disc_area: np.ndarray


def volturnus_s():
    """The Hull of the VolturnUS-S at its mean position. The pontoons' length is what makes up the report's displacement."""
    position, volume, added_mass, disc_position, disc_area = [], [], [], [], []
    columns = [(0.0, 0.0, CENTRAL_DIAMETER)]
    columns += [(COLUMN_RADIUS * np.cos(a), COLUMN_RADIUS * np.sin(a), OUTER_DIAMETER) for a in HEADINGS]
    for x, y, diameter in columns:
        area = np.pi / 4.0 * diameter**2
        slice_volume = area * DRAFT / _SLICES
        for depth in DRAFT * (np.arange(_SLICES) + 0.5) / _SLICES:
            position.append((x, y, -depth))
            volume.append(slice_volume)
            added_mass.append(_COLUMN_ADDED_MASS * slice_volume * np.diag([1.0, 1.0, 0.0]))
        position.append((x, y, -DRAFT))
        volume.append(0.0)
        added_mass.append(_FOOT_ADDED_MASS * np.pi / 12.0 * diameter**3 * np.diag([0.0, 0.0, 1.0]))
        disc_position.append((x, y, 0.0))
        disc_area.append(area)

    length = (DISPLACEMENT - sum(disc_area) * DRAFT) / (3.0 * PONTOON_WIDTH * PONTOON_HEIGHT)
    middle = 0.5 * (CENTRAL_DIAMETER / 2.0 + COLUMN_RADIUS - OUTER_DIAMETER / 2.0)
    slice_volume = PONTOON_WIDTH * PONTOON_HEIGHT * length / _SLICES
    for heading in HEADINGS:
        along = np.array([np.cos(heading), np.sin(heading), 0.0])
        across = np.array([-np.sin(heading), np.cos(heading), 0.0])
        coefficient = _PONTOON_LATERAL * np.outer(across, across) + _PONTOON_VERTICAL * np.diag([0.0, 0.0, 1.0])
        for radius in middle + length * ((np.arange(_SLICES) + 0.5) / _SLICES - 0.5):
            position.append(tuple(radius * along + [0.0, 0.0, -PONTOON_DEPTH]))
            volume.append(slice_volume)
            added_mass.append(slice_volume * coefficient)
    return Hull(*(np.array(values) for values in (position, volume, added_mass, disc_position, disc_area)))
