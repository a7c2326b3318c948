"""A towed cable with linear drag, its components apart: D = 1, k_t ≠ k_n.

With the symbols of `calm.analytic.villain_guillot`, δ = μg cos α − k_n V sin α. Since
P = −A dδ/dα + B δ,

    T/T₀ = (δ₀/δ)^A e^(B (α − α₀)),      A = (μg² + k_t k_n V²)/(μg² + k_n² V²),
                                         B = μg (k_t − k_n) V/(μg² + k_n² V²),

and the shape takes one quadrature.
"""

from __future__ import annotations

from math import hypot, pi

import numpy as np
from numpy.typing import ArrayLike

from calm.analytic.hodograph import Floats, Station, integrated
from calm.analytic.villain_guillot import check_arc, straight_angle, straight_cable


def linear_tension_ratio(
    angle: ArrayLike,
    start: ArrayLike,
    weight: ArrayLike,
    normal_drag: ArrayLike,
    tangential_drag: ArrayLike,
) -> Floats:
    """T/T₀ = (δ₀/δ)^A e^(B (α − α₀)) of a towed cable with D = 1; arrays broadcast.

    Parameters
    ----------
    angle, start : α and α₀, both within π of α_d on the same side of it [rad]
    weight : μg > 0 [N/m]
    normal_drag : k_n V > 0 [N/m]
    tangential_drag : k_t V ≥ 0 [N/m]

    Raises
    ------
    ValueError
        Where a parameter is outside its range, or the angles lie on different sides of α_d.
    """
    mean = straight_angle(weight, normal_drag, 1)
    power, rate = _powers(weight, normal_drag, tangential_drag)
    here, there = (np.asarray(value, float) - mean for value in (angle, start))
    ratio = np.sin(there) / np.sin(here)
    if not np.all((ratio > 0.0) & (np.abs(here) < pi) & (np.abs(there) < pi)):
        raise ValueError("the angles must lie on the same side of the straight cable's, within π")
    return np.exp(power * np.log(ratio) + rate * (here - there))


def _powers(
    weight: ArrayLike, normal_drag: ArrayLike, tangential_drag: ArrayLike
) -> tuple[Floats, Floats]:
    """A and B."""
    w, n, t = (np.asarray(value, float) for value in (weight, normal_drag, tangential_drag))
    if not np.all(t >= 0.0):
        raise ValueError("the tangential drag must not be negative")
    square = w * w + n * n
    return (w * w + t * n) / square, w * (t - n) / square


def unequal_cable(
    arc: ArrayLike,
    tension: float,
    angle: float,
    weight: float,
    normal_drag: float,
    tangential_drag: float,
) -> Station:
    """Shape of a towed cable with D = 1, k_t ≠ k_n: elementary tension, the rest by quadrature.

    Parameters, V in place of V², and errors are those of `villain_guillot.quadratic_cable`; the
    angle lies within π of α_d.

    Notes
    -----
    With |α − α_d| = 2 arctan e^(−m) the arc is ∫ T dm/√((μg)² + (k_n V)²), m from −∞ to ∞.
    """
    from scipy.optimize import brentq

    arcs = np.asarray(arc, float)
    check_arc(arcs, np.asarray(tension, float))
    mean = float(straight_angle(weight, normal_drag, 1))
    power, rate = (float(value) for value in _powers(weight, normal_drag, tangential_drag))
    if tension == 0.0 or angle == mean:
        return straight_cable(arcs, tension, mean, weight, tangential_drag * np.cos(mean))
    side, away = (1.0 if angle > mean else -1.0), abs(angle - mean)
    if not away < pi:
        raise ValueError("the angle at the body must lie within π of the straight cable's")
    start = -np.log(np.tan(0.5 * away))
    load = hypot(weight, normal_drag)
    widest = 10.0 / (1.0 + power + abs(rate))  # the tension grows by no more than e^10

    def ratio(m: float) -> float:
        turn = side * (2.0 * np.arctan(np.exp(-m)) - away)
        swell = np.logaddexp(m, -m) - np.logaddexp(start, -start)
        return float(np.exp(power * swell + rate * turn))

    def integral(step: float, share: int, floor: float) -> float:
        def part(after: float) -> float:
            m = start + after
            sine = 2.0 * np.exp(-np.logaddexp(m, -m))
            return float(ratio(m) * (1.0, np.tanh(m), side * sine)[share])

        # the cable turns where m is near 0; a long step as a whole would hide that
        cuts = [m - start for m in (-16.0, -4.0, -1.0, 1.0, 4.0, 16.0, 64.0)]
        ends = [0.0, *(cut for cut in cuts if 0.0 < cut < step), step]
        return integrated(part, ends, floor * load / tension) * tension / load

    def follow(s: float) -> tuple[float, float, float, float]:
        def miss(step: float) -> float:
            return integral(step, 0, 0.0) - s

        low, width = 0.0, s * load / tension
        while miss(high := low + min(width, widest)) < 0.0:
            low, width = high, 2.0 * width
        step = float(brentq(miss, low, high, xtol=1e-300, rtol=1e-15))
        m = start + step
        turn = side * 2.0 * float(np.arctan(np.exp(-m)))
        along, across = (integral(step, share, 1e-13 * s) for share in (1, 2))
        return mean + turn, tension * ratio(m), along, across

    stations = np.array([follow(float(s)) for s in arcs.ravel()]).reshape(*arcs.shape, 4)
    alpha, pull, x, y = np.moveaxis(stations, -1, 0)
    cosine, sine = np.cos(mean), np.sin(mean)
    return Station(alpha, pull, x * cosine - y * sine, x * sine + y * cosine)
