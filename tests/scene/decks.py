"""A deck with every section that the reader knows, and ways to change it."""

PLAIN = """\
Two lines, one of them with a clump weight
--- LINE TYPES ---
Name   Diam   Mass/m  EA       BA/-zeta EI  Cd   Ca   CdAx  CaAx
(-)    (m)    (kg/m)  (N)      (N-s/-)  (-) (-)  (-)  (-)   (-)
chain  0.0766 113.35  7.536e8  -1.0     0   2.0  0.8  0.4   0.25
rope   0.15   20.5    3.0e7    1.0e5    0.0 1.6  1.0  0.1   0
--- ROD TYPES ---
TypeName Diam Mass/m Cd Ca CdEnd CaEnd
(name) (m) (kg/m) (-) (-) (-) (-)
--- POINTS ---
ID Type     X      Y     Z      Mass  Volume CdA  Ca
(#) (-)     (m)    (m)   (m)    (kg)  (m^3)  (m^2) (-)
1  Fixed    400.0  0     -100   0     0      0    0
2  Vessel   10     0.0   -12.5  0     0      0    0
3  Free     -150   5     -60    2.0e3 0.5    1.5  0.9
4  Fixed    -400   0     -100   0     0      0    0
5  Coupled  -10    0     -12.5  0     0      0    0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
(#) (name)  (#)     (#)     (m)      (-)     (-)
1  chain    1       2       420.5    20      pt
2  chain    4       3       270      15      -
7  rope     Point3  P5      150.0    10      p t
--- OPTIONS ---
9.81     g        gravity (m/s^2)
1000     rhoW     water density
100      WtrDpth  water depth (m)
2.0e6    kBot
2.0e5    cBot     bed damping
0.3      CurrentX along x (m/s)
-0.1     CurrentY
0.001    dtM      time step
0        FrictionCoefficient
--- OUTPUTS ---
FairTen1 AnchTen1
END
--- need this line ---
"""


def line_of(text: str, start: str) -> int:
    """Number of the only line that starts with ``start``."""
    found = [n for n, line in enumerate(text.split("\n"), start=1) if line.startswith(start)]
    assert len(found) == 1, (start, found)
    return found[0]


def swap(old: str, new: str, text: str = PLAIN) -> str:
    assert text.count(old) == 1, (old, text.count(old))
    return text.replace(old, new)
