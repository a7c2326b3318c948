"""Pode's cable functions: a heavy line in a uniform stream, constant drag along it.

From the point where the line stands square to the stream, with p = w/R, f = F/R and T₀ there,

    τ = T/T₀ = exp ∫ (f + p sin α)/(sin²α − p cos α) dα,      R s/T₀ = σ = ∫ τ dα/(sin²α − p cos α),

ξ and η likewise with τ cos α and τ sin α, all from φ to 90°. They satisfy τ − 1 = p η + f σ.

Source: L. Pode, David Taylor Model Basin report 687, 1951. The tangential drag F does not depend on
the angle, unlike ½ρ Ct πD (V cos φ)²; tabulated were f = 0.01, 0.02 and 0.03.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from calm.analytic.hodograph import Floats
from calm.analytic.uniform import branch_of


class CableFunctions(NamedTuple):
    """Pode's functions, each of the shape of the angles.

    Attributes
    ----------
    tau : tension T/T₀ [-]
    sigma : arc R s/T₀ [-]
    xi : distance upstream R x/T₀ [-]
    eta : height R z/T₀ [-]
    """

    tau: Floats
    sigma: Floats
    xi: Floats
    eta: Floats


def cable_functions(angle: ArrayLike, weight_ratio: float, friction: float = 0.0) -> CableFunctions:
    """Tension, arc, distance and height between 90° and an angle.

    Parameters
    ----------
    angle : φ, above the critical angle and up to π, of any shape [rad]; below 90° of a line that
        is towed, its body at 90°. Above 90° (a moored line, the arc counted downwards and
        negative) the drag along the line acts the other way, and the identity with it.
    weight_ratio : p = w/R > 0 [-]; `critical_weight_ratio` gives it for a critical angle
    friction : f = F/R ≥ 0 [-]

    Raises
    ------
    ValueError
        Where an angle or a ratio is outside its range.
    """
    branch = branch_of(0.5 * np.pi, weight_ratio, friction, "constant")
    angles = np.asarray(angle, float)
    if not np.all((angles > branch.critical_angle) & (angles <= np.pi)):
        raise ValueError(
            f"angles must lie above the critical angle, {np.degrees(branch.critical_angle):.6g}°, "
            "and not above 180°"
        )
    start = float(branch.parameter(0.5 * np.pi))
    rows = []
    for m in branch.parameter(angles).ravel():
        tau = float(np.exp(branch.log_tension(m) - branch.log_tension(start)))
        rows.append((tau, branch.arc(start, m - start), *branch.reach(start, m - start)))
    return CableFunctions(*np.moveaxis(np.array(rows).reshape(*angles.shape, 4), -1, 0))
