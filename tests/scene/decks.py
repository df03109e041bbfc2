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

# Every section, every kind of part, and files beside the scene.
FULL = """\
A buoy on bridles, a cable with joints, and a sea
--- LINE TYPES ---
Name  Diam Mass/m EA          BA/-zeta  EI   Cd  Ca  CdAx CaAx
(-)   (m)  (kg/m) (N)         (N-s/-)   (-)  (-) (-) (-)  (-)
chain 0.08 113.0  7.5e8       -0.8      0    2.0 0.8 0.4  0.25
cable 0.2  40.0   7.0e8       -0.5      1e4  1.2 1.0 0.01 0
rope  0.19 23.0   1.424e8|1.586e8 4e9|11e6 0 1.2 1.0 0.1  0
nylon 0.15 18.0   nylon.txt   2.0e4     0    1.2 1.0 0.1  0
--- ROD TYPES ---
TypeName Diam Mass/m Cd Ca CdEnd CaEnd
(name)   (m)  (kg/m) (-) (-) (-) (-)
spar     2.0  500.0  0.6 1.0 1.2 0.8
joint    0.2  0      0   0   0   0
--- BODIES ---
ID Attachment X0   Y0 Z0  r0 p0 y0 Mass CG        I           Volume CdA     Ca
(#) (word)    (m)  (m) (m) (deg) (deg) (deg) (kg) (m) (kg-m^2) (m^3) (m^2)   (-)
1  Free       50   0  -20 10 20 30 5000 0|0.1|-1  2e4|3e4|4e4 6      5|40    1|1|2
2  Coupled    -5   0  -8  0  0  90 0    0         0           0      0       0
3  Fixed      0    90 -95 0  0  0  0    0         0           0      1|2|3|4|5|6 0
--- RODS ---
ID RodType Attachment    Xa  Ya Za  Xb  Yb Zb  NumSegs RodOutputs
(#) (name) (word)        (m) (m) (m) (m) (m) (m) (-)   (-)
1  spar    Body1         0   0  -3  0   0  3   6       p
2  joint   Free          0   40 -60 0   40 -60 0       -
3  joint   Coupled       5   0  -8  6   0  -9  0       -
4  spar    Pinned        90  0  -98 90  0  -92 4       -
5  joint   Body3         0   0  0   0   -1 0   0       -
6  spar    CoupledPinned 0   -5 -10 0   -5 -20 5       -
7  spar    Free          20  20 -30 20  20 -20 4       -
8  joint   Fixed         60  90 -100 59 90 -100 0      -
--- POINTS ---
ID Type     X      Y     Z      Mass  Volume CdA  Ca
(#) (-)     (m)    (m)   (m)    (kg)  (m^3)  (m^2) (-)
1  Fixed    400    0     -100   0     0      0    0
2  Body1    0      0     3      10    0.1    0    0
3  Fixed    0      -300  seabed 0     0      0    0
4  Coupled  10     0     -12    0     0      0    0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
(#) (name)  (#)     (#)     (m)      (-)     (-)
1  chain    1       R1B     380      20      p
2  rope     R4B     Rod1A   80       10      p
3  cable    R5B     R2A     80       40      p
4  cable    r2b     rod3a   60       30      p
5  nylon    3       4       310      15      p
6  chain    2       R7A     50       10      p
7  chain    R6B     R7B     40       10      p
8  cable    R8B     3       500      10      p
--- FAILURE ---
FailureID Point Lines FailTime FailTen
()        ()    (,)   (s)      (N)
1         R1A   2     0        2e6
2         P4    5     12.5     0
3         3     5, 8  0        1e6
--- CONTROL ---
ChannelID Lines
()        (,)
1         1,2
--- OPTIONS ---
100      WtrDpth
0.01     BedSlopeX
0.5      mu_kT
0.4      mu_kA
1.25     mc
1e6      cv
stick    FrictionModel
paper    BendingModel
jonswap  WaveModel
8.25     WaveHeight
14.5     WavePeriod
30       WaveDirection
2.5      WaveGamma
7        WaveSeed
200      WaveComponents
20       waveKin_rampT
1        Currents
0.2      CurrentY
--- OUTPUTS ---
FairTen1
--- need this line ---
"""

FILES = {
    "nylon.txt": "Nylon\nStrain Tension\n(-) (N)\n0.0 0.0\n0.05 2.0e5\n0.10 8.0e5\n0.20 3.0e6\n",
    "current_profile.txt": "steady current\nof the test\nz ux uy uz\n-100 0.1 0 0\n-50.0 0.3 0.1 0\n0 0.8 0.2 0.0\n",
}
