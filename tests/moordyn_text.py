"""Files of MoorDyn 2 for tests, of some points and lines in 200 m of water."""


def moordyn(points: str, lines: str) -> str:
    """A file with two types, a rope and a chain."""
    return f"""\
--------------------- MoorDyn Input File ------------------------------------
---------------------- LINE TYPES -------------------------------------------
TypeName   Diam    Mass/m     EA         BA/-zeta    EI         Cd     Ca     CdAx    CaAx
(name)     (m)     (kg/m)     (N)        (N-s/-)     (N-m^2)    (-)    (-)    (-)     (-)
rope       0.02    0.6        2e6        -0.8        0          1.6    1.0    0.05    0.0
chain      0.05    20         1e8        -0.8        0          1.6    1.0    0.05    0.0
---------------------- POINTS -----------------------------------------------
ID    Attachment  X     Y     Z      Mass   Volume  CdA    Ca
(#)   (-)         (m)   (m)   (m)    (kg)   (m^3)   (m^2)  (-)
{points}---------------------- LINES ------------------------------------------------
ID   LineType   AttachA  AttachB  UnstrLen  NumSegs  LineOutputs
(#)  (name)     (#)      (#)      (m)       (-)      (-)
{lines}---------------------- OPTIONS ----------------------------------------------
1025.0  WtrDnsty    water density (kg/m^3)
9.81    g           gravity
200     WtrDpth     water depth (m)
------------------------- need this line ------------------------------------
"""
