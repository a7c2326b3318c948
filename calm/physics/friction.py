"""The friction of the flow along cables and chains: three laws."""

from __future__ import annotations

from enum import Enum
from math import copysign, sqrt

from calm.physics.element import Vector


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

    @property
    def law(self) -> int:
        """The number by which `friction_force` knows it."""
        return list(Friction).index(self)


BERTEAUX, HOERNER, CONSTANT = (friction.law for friction in Friction)


def turning_friction(law: int, kt: float, u: float, v: float, w: float) -> float:
    """Return what a friction of Kt [N/(m/s)²] that is not along the cable pulls with per m/s
    [N/(m/s)].

    Along the current u, v, w [m/s]; it turns the cable, which a friction along it does not.
    """
    return kt * sqrt(u * u + v * v + w * w) if law == HOERNER else 0.0


def friction_force(
    law: int, kt: float, u: float, v: float, w: float, tx: float, ty: float, tz: float
) -> Vector:
    """Friction of the current u, v, w [m/s] on a cable of axis t [N], Kt in N/(m/s)²."""
    if law == HOERNER:
        pull = turning_friction(law, kt, u, v, w)
        return pull * u, pull * v, pull * w
    along = u * tx + v * ty + w * tz
    pull = kt * abs(along) * along
    if law == CONSTANT:
        pull = copysign(kt * (u * u + v * v + w * w), along) if along != 0.0 else 0.0
    return pull * tx, pull * ty, pull * tz
