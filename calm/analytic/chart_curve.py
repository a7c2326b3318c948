"""The curve of a uniform-current chart, point by point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from calm.analytic.chart_branch import Branch, Floats, check_k, critical_angle
from calm.errors import UsageError


@dataclass(frozen=True)
class CurvePoints:
    """Points of the curve in units of H₀ and wH₀, arrays of one shape.

    Parameters
    ----------
    phi : ndarray
        Angle of the cable to the current [rad].
    arc, distance, height : ndarray
        s′, y′ (downstream), z′ (up), counted from the apex of the branch.
    tension : ndarray
        T/(wH₀) = 1 + z′.
    """

    phi: Floats
    arc: Floats
    distance: Floats
    height: Floats
    tension: Floats


def curve(k: float, phi: ArrayLike) -> CurvePoints:
    """The curve of K at given angles, to 1e-12 of the arc; vectorised.

    Parameters
    ----------
    k : float
        0 ≤ K ≤ 100.
    phi : array_like
        Angles to the current [rad], each from −π to π and none of them critical. Between φ_c − π
        and φ_c a point lies on the first branch, otherwise on the second.

    Returns
    -------
    CurvePoints

    Raises
    ------
    UsageError
        K or an angle out of range, or a critical angle.
    """
    angles = np.asarray(phi, dtype=np.float64)
    if not np.all(np.abs(angles) <= np.pi):
        raise UsageError("an angle of the curve must be from −180° to 180°")
    critical = critical_angle(check_k(k))
    if np.any(np.isclose(angles % np.pi, critical, rtol=0.0, atol=1e-12)):
        raise UsageError(
            f"the curve does not reach its critical angle, {np.degrees(critical):.6g}°"
        )
    arc, distance, tension = (np.empty_like(angles) for _ in range(3))
    first = (critical - np.pi < angles) & (angles < critical)
    for branch, here in ((Branch(k, 1), first), (Branch(k, -1), ~first)):
        parameter = branch.parameter(branch.turned(angles[here]))
        arc[here], distance[here] = branch.from_apex(parameter)
        tension[here] = np.exp(branch.log_tension(parameter))
    return CurvePoints(angles, arc, distance, tension - 1.0, tension)
