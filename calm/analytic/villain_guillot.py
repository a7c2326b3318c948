"""Villain-Guillot's towed cable: drag linear or quadratic in each component of the velocity.

A cable of weight μg per metre in the fluid (water or air) is towed at a speed V; α is the angle of
its upward direction above the way it is towed, s counts from its lower end. Across it acts
k_n (V sin α)^D per metre, along it k_t (V cos α)^D:

    dT/ds = P = μg sin α + k_t (V cos α)^D,      T dα/ds = δ = μg cos α − k_n (V sin α)^D.

The drag parameters below are k_n V^D and k_t V^D, in N/m. δ vanishes at α_d, where the cable is
straight; a cable without a body is straight there from its free end on. Between, with ρ = T/δ the
radius of curvature,

    dT/T = (P/δ) dα,      dρ/ρ = (P − dδ/dα)/δ dα.

D = 1, k_t = k_n: the drag is the same force on every metre and the cable a catenary about the
direction of that force and the weight together. D = 1, k_t ≠ k_n is in
`calm.analytic.unequal_drag`. D = 2 is the heavy line of `calm.analytic.uniform`, f = k_t/k_n.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from calm.analytic import catenary
from calm.analytic.hodograph import Floats, Station
from calm.analytic.uniform import critical_angle, heavy_line


def body_pull(weight: ArrayLike, lift: ArrayLike, drag: ArrayLike) -> tuple[Floats, Floats]:
    """Tension [N] and angle [rad] of the cable at a towed body.

    T₀ = √((W − F_P)² + F_T²), tan α₀ = (W − F_P)/F_T; arrays broadcast.

    Parameters
    ----------
    weight : W, in the fluid [N]
    lift : F_P, positive up; negative for a depressor [N]
    drag : F_T ≥ 0 [N]

    Raises
    ------
    ValueError
        Where the drag is negative.
    """
    down, back = np.asarray(weight, float) - np.asarray(lift, float), np.asarray(drag, float)
    if not np.all(back >= 0.0):
        raise ValueError("the drag of a towed body must not be negative")
    return np.hypot(down, back), np.arctan2(down, back)


def straight_angle(weight: ArrayLike, normal_drag: ArrayLike, exponent: Literal[1, 2]) -> Floats:
    """Angle α_d at which a cable is towed straight [rad]: tan α_d = μg/(k_n V) where D = 1.

    Parameters
    ----------
    weight : μg > 0 [N/m]
    normal_drag : k_n V^D > 0 [N/m]
    exponent : D; 2 gives the critical angle of a heavy line

    Raises
    ------
    ValueError
        Where a parameter is outside its range.
    """
    w, r = np.asarray(weight, float), np.asarray(normal_drag, float)
    if exponent not in (1, 2):
        raise ValueError(f"the exponent of the drag is 1 or 2, not {exponent}")
    if not (np.all(w > 0.0) and np.all(r > 0.0)):
        raise ValueError("weight and normal drag of a towed cable must be above 0")
    return np.arctan2(w, r) if exponent == 1 else critical_angle(w / r)


def linear_cable(
    arc: ArrayLike, tension: ArrayLike, angle: ArrayLike, weight: ArrayLike, drag: ArrayLike
) -> Station:
    """Shape of a towed cable with D = 1 and k_t = k_n = k; arrays broadcast.

    With ℓ = T₀/√((μg)² + (kV)²) and a = α₀ − α_d: tan(α − α_d) = sin a/(s/ℓ + cos a),
    T = T₀ √((s/ℓ)² + 2 (s/ℓ) cos a + 1).

    Parameters
    ----------
    arc : s ≥ 0 from the body [m]
    tension : T₀ ≥ 0 at the body [N]; 0 for a free end
    angle : α₀ at the body; of no effect at a free end [rad]
    weight : μg > 0 [N/m]
    drag : kV > 0 [N/m]

    Raises
    ------
    ValueError
        Where a parameter is outside its range.
    """
    s, t, start = (np.asarray(value, float) for value in (arc, tension, angle))
    check_arc(s, t)
    mean = straight_angle(weight, drag, 1)
    load = np.hypot(weight, drag)
    turn = np.where(t > 0.0, start - mean, 0.0)
    across, along = t * np.sin(turn), t * np.cos(turn)
    y, x = catenary.position(s, across, along, load)
    cosine, sine = np.cos(mean), np.sin(mean)
    pull = along + load * s
    return Station(
        mean + np.arctan2(across, pull),
        np.hypot(across, pull),
        x * cosine - y * sine,
        x * sine + y * cosine,
    )


def quadratic_cable(
    arc: ArrayLike,
    tension: float,
    angle: float,
    weight: float,
    normal_drag: float,
    tangential_drag: float,
) -> Station:
    """Shape of a towed cable with D = 2: elementary tension, the rest by quadrature.

    Parameters
    ----------
    arc : s ≥ 0 from the body, of any shape [m]
    tension : T₀ ≥ 0 at the body [N]; 0 for a free end
    angle : α₀ at the body, −π to π; of no effect at a free end [rad]
    weight : μg > 0 [N/m]
    normal_drag : k_n V² > 0 [N/m]
    tangential_drag : k_t V² ≥ 0 [N/m]

    Raises
    ------
    ValueError
        Where a parameter is outside its range.
    """
    arcs = np.asarray(arc, float)
    check_arc(arcs, np.asarray(tension, float))
    if tension > 0.0:
        return heavy_line(arcs, tension, angle, weight, normal_drag, tangential_drag)
    mean = float(straight_angle(weight, normal_drag, 2))
    return straight_cable(arcs, tension, mean, weight, tangential_drag * np.cos(mean) ** 2)


def straight_cable(
    arc: Floats, tension: float, angle: float, weight: float, rubbing: float
) -> Station:
    """A cable that is straight at α_d, as from a free end.

    Parameters
    ----------
    arc : s ≥ 0 from the lower end [m]
    tension : T₀ there [N]
    angle : α_d, from `straight_angle` [rad]
    weight : μg [N/m]
    rubbing : drag along the cable at that angle [N/m]
    """
    sine, cosine = np.sin(angle), np.cos(angle)
    pull = tension + (weight * sine + rubbing) * arc
    return Station(np.full_like(arc, angle), pull, arc * cosine, arc * sine)


def check_arc(arc: Floats, tension: Floats) -> None:
    """Raise ValueError where an arc or a tension is negative or infinite."""
    if not all(np.all((value >= 0.0) & (value < np.inf)) for value in (arc, tension)):
        raise ValueError("the arc and the tension of a towed cable must not be negative")
