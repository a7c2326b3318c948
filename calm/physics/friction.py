"""The friction of the flow along cables and chains: three laws."""

from __future__ import annotations

from enum import Enum


class Friction(Enum):
    """How the current drags a cable or chain along itself; the name is that of the files.

    With Kt for a metre at 1 m/s, t the unit vector along the cable and Vt = (V·t) t:

    - ``berteaux``: Kt |Vt| Vt, along the cable; Kt = ½ρ Ct πD. Berteaux, Buoy Engineering (1976).
    - ``hoerner``: Kt |V| V, along the current; the same Kt. Hoerner, Fluid-Dynamic Drag (1965).
    - ``constant``: Kt |V|² along the cable, towards where the current goes, whatever the angle;
      Kt = Ct ½ρ Cn D. Pode, David Taylor Model Basin report 687 (1951).
    """

    BERTEAUX = "berteaux"
    HOERNER = "hoerner"
    CONSTANT = "constant"
