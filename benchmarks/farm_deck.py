"""A farm of 25 platforms with four chains each as one scene of 100 lines: ``python -m benchmarks.farm_deck`` writes config/scenes/farm_100.txt.

All platforms are held to move alike, as one platform of which the fairleads stand kilometres apart: it is a scene to measure large models with.
"""

import math
from pathlib import Path

FILE = Path(__file__).parent.parent / "config" / "scenes" / "farm_100.txt"
ROWS, SPACING = 5, 2000.0  # platforms in each direction, m between them
HEADINGS = (45.0, 135.0, 225.0, 315.0)  # degrees
ANCHOR_RADIUS, FAIRLEAD_RADIUS, FAIRLEAD_DEPTH, DEPTH = 837.6, 40.868, 14.0, 200.0  # m

HEAD = """\
--- MoorDyn v2 input file --------------------------------------------------------------------
Farm of 25 semisubmersibles in 200 m of water, with four chains of 835.35 m each: 100 lines.

Written by benchmarks/farm_deck.py. Sources:
  [1] the chain, its length, the radii of anchors and fairleads, and the water are those of `oc4.txt`
  [c] chosen here: 5 x 5 platforms 2 km apart, four lines each at headings 45, 135, 225, 315 degrees; all platforms move alike, as one

--- LINE TYPES -------------------------------------------------------------------------------
Name    Diam    Mass/m   EA         BA/-zeta  EI      Cd    Ca    CdAx  CaAx
(-)     (m)     (kg/m)   (N)        (N-s/-)   (N-m2)  (-)   (-)   (-)   (-)
main    0.0766  113.35   7.536e8    -1.0      0       2.0   0.8   0.4   0.25
"""
TAIL = """\
--- OPTIONS ----------------------------------------------------------------------------------
200.0    WtrDpth   water depth (m): [1]
1025.0   rho       water density (kg/m^3): [1]
9.80665  g         gravity (m/s^2)
3.0e6    kBot      bed stiffness (Pa/m): [1]
3.0e5    cBot      bed damping (Pa s/m): [1]
--- need this line ---------------------------------------------------------------------------
"""


def text():
    """The scene's text."""
    points = ["--- POINTS -----------------------------------------------------------------------------------"]
    points += ["ID   Type      X          Y          Z        Mass   Volume  CdA   Ca", "(-)  (-)       (m)        (m)        (m)      (kg)   (m3)    (m2)  (-)"]
    lines = ["--- LINES ------------------------------------------------------------------------------------"]
    lines += ["ID   LineType  AttachA   AttachB   UnstrLen  NumSegs  Outputs", "(-)  (-)       (-)       (-)       (m)       (-)      (-)"]
    number = 0
    for k in range(ROWS * ROWS):
        centre = (SPACING * (k % ROWS - ROWS // 2), SPACING * (k // ROWS - ROWS // 2))
        for heading in HEADINGS:
            number += 1
            along = (math.cos(math.radians(heading)), math.sin(math.radians(heading)))
            for which, kind, radius, z in ((2 * number - 1, "Fixed", ANCHOR_RADIUS, -DEPTH), (2 * number, "Coupled", FAIRLEAD_RADIUS, -FAIRLEAD_DEPTH)):
                x, y = (c + radius * a for c, a in zip(centre, along, strict=True))
                points.append(f"{which:<4} {kind:<8} {x:>10.3f} {y:>10.3f} {z:>8.1f}    0      0       0     0")
            lines.append(f"{number:<4} main      {2 * number - 1:<9} {2 * number:<9} 835.35    20       -")
    return HEAD + "\n".join([*points, *lines, ""]) + TAIL


if __name__ == "__main__":
    FILE.write_text(text(), encoding="utf-8")
