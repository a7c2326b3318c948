"""Villain-Guillot's towed cables, with drag linear or quadratic in each velocity component.

A cable of weight μg per metre in the fluid (water or air) is towed at a speed V. The angle α of its
upward direction is measured from the direction of tow. The arc length s is counted from the lower
end. Drag per metre is k_n (V sin α)^D normal to the cable and k_t (V cos α)^D along it:

    dT/ds = P = μg sin α + k_t (V cos α)^D,      T dα/ds = δ = μg cos α − k_n (V sin α)^D.

The drag parameters of the functions are k_n V^D and k_t V^D, in N/m. At the angle α_d, where δ = 0,
the cable is straight. A cable without a body has a free end and is straight at this angle. For a
curved cable with the radius of curvature ρ = T/δ,

    dT/T = (P/δ) dα,      dρ/ρ = (P − dδ/dα)/δ dα.

For D = 1 and k_t = k_n, the cable is a catenary about the direction of the sum of drag and weight.
D = 2 is the heavy line of `calm.analytic.uniform`, with f = k_t/k_n.
"""

from math import hypot, pi
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from calm.analytic import catenary
from calm.analytic.hodograph import Floats, Station, integrated
from calm.analytic.uniform import critical_angle, heavy_line


def body_pull(weight: ArrayLike, lift: ArrayLike, drag: ArrayLike) -> tuple[Floats, Floats]:
    """Return tension [N] and angle [rad] of the cable at a towed body.

    T₀ = √((W − F_P)² + F_T²), tan α₀ = (W − F_P)/F_T; arrays broadcast.

    Parameters
    ----------
    weight : weight W in the fluid [N]
    lift : hydrodynamic lift F_P [N], positive up
    drag : drag F_T ≥ 0 [N]

    Raises
    ------
    ValueError
        The drag is negative.
    """
    down, back = np.asarray(weight, float) - np.asarray(lift, float), np.asarray(drag, float)
    if not np.all(back >= 0.0):
        raise ValueError("the drag of a towed body must not be negative")
    return np.hypot(down, back), np.arctan2(down, back)


def straight_angle(weight: ArrayLike, normal_drag: ArrayLike, exponent: Literal[1, 2]) -> Floats:
    """Return the angle α_d at which a towed cable is straight [rad].

    For D = 1, tan α_d = μg/(k_n V). For D = 2, α_d is the critical angle of a heavy line.

    Parameters
    ----------
    weight, normal_drag : μg > 0 and k_n V^D > 0, per metre [N/m]
    exponent : exponent D of the velocity in the drag

    Raises
    ------
    ValueError
        A parameter is outside its range.
    """
    w, r = np.asarray(weight, float), np.asarray(normal_drag, float)
    if exponent not in (1, 2):
        raise ValueError(f"the exponent of the drag must be 1 or 2, not {exponent}")
    if not (np.all(w > 0.0) and np.all(r > 0.0)):
        raise ValueError("weight and normal drag of a towed cable must be above 0")
    return np.arctan2(w, r) if exponent == 1 else critical_angle(w / r)


def linear_cable(
    arc: ArrayLike, tension: ArrayLike, angle: ArrayLike, weight: ArrayLike, drag: ArrayLike
) -> Station:
    """Return the shape of a towed cable for D = 1 and k_t = k_n = k. Arrays broadcast.

    With ℓ = T₀/√((μg)² + (kV)²) and a = α₀ − α_d: tan(α − α_d) = sin a/(s/ℓ + cos a),
    T = T₀ √((s/ℓ)² + 2 (s/ℓ) cos a + 1).

    Parameters
    ----------
    arc : distance s ≥ 0 along the cable from the body [m]
    tension, angle : T₀ ≥ 0 [N] and α₀ [rad] at the body; the angle is ignored at a free end, T₀ = 0
    weight : μg > 0 [N/m]
    drag : kV > 0 [N/m]

    Raises
    ------
    ValueError
        A parameter is outside its range.
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
    """Return the shape of a towed cable for D = 2.

    Parameters
    ----------
    arc : distance s ≥ 0 along the cable from the body [m]
    tension, angle : T₀ ≥ 0 [N] and α₀, −π to π [rad], at the body; the angle is ignored at a free
        end, T₀ = 0
    weight : μg > 0 [N/m]
    normal_drag, tangential_drag : k_n V² > 0 and k_t V² ≥ 0 [N/m]

    Raises
    ------
    ValueError
        A parameter is outside its range.
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
    """Return the shape of a cable that is straight at α_d, such as a cable with a free end.

    Parameters
    ----------
    arc, tension : distance s ≥ 0 from the lower end [m], and tension T₀ there [N]
    angle : α_d [rad]
    weight, rubbing : μg, and tangential drag per metre at this angle [N/m]
    """
    sine, cosine = np.sin(angle), np.cos(angle)
    pull = tension + (weight * sine + rubbing) * arc
    return Station(np.full_like(arc, angle), pull, arc * cosine, arc * sine)


def check_arc(arc: Floats, tension: Floats) -> None:
    """Raise ValueError if an arc length or a tension is negative or infinite."""
    if not all(np.all((value >= 0.0) & (value < np.inf)) for value in (arc, tension)):
        raise ValueError("the arc length and the tension of a towed cable must not be negative")


def linear_tension_ratio(
    angle: ArrayLike,
    start: ArrayLike,
    weight: ArrayLike,
    normal_drag: ArrayLike,
    tangential_drag: ArrayLike,
) -> Floats:
    """Return the tension ratio T/T₀ = (δ₀/δ)^A e^(B (α − α₀)) of a towed cable for D = 1.

    A = (w² + t n)/(w² + n²) and B = w (t − n)/(w² + n²), with the weight w and the normal and
    tangential drag n and t. Arrays broadcast.

    Parameters
    ----------
    angle, start : α and α₀ [rad], on the same side of α_d and less than π away from α_d
    weight, normal_drag, tangential_drag : w = μg > 0, n = k_n V > 0 and t = k_t V ≥ 0 [N/m]

    Raises
    ------
    ValueError
        A parameter is outside its range, or the angles are on different sides of α_d.
    """
    mean = straight_angle(weight, normal_drag, 1)
    power, rate = _powers(weight, normal_drag, tangential_drag)
    here, there = (np.asarray(value, float) - mean for value in (angle, start))
    ratio = np.sin(there) / np.sin(here)
    if not np.all((ratio > 0.0) & (np.abs(here) < pi) & (np.abs(there) < pi)):
        raise ValueError(
            "the angles must be on the same side of the angle of the straight cable, and differ "
            "from it by less than π"
        )
    return np.exp(power * np.log(ratio) + rate * (here - there))


def _powers(
    weight: ArrayLike, normal_drag: ArrayLike, tangential_drag: ArrayLike
) -> tuple[Floats, Floats]:
    """Return the exponents A and B of `linear_tension_ratio`."""
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
    """Return the shape of a towed cable for D = 1 and k_t ≠ k_n.

    Parameters and errors are as in `quadratic_cable`, but the drags contain V instead of V², and
    the angle must be less than π away from α_d. The arc length is ∫ T dm/√((μg)² + (k_n V)²), with
    |α − α_d| = 2 arctan e^(−m).
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
        raise ValueError(
            "the angle at the body must differ from the angle of the straight cable by less than π"
        )
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

        # the cable turns near m = 0, which quadrature over a whole long step would miss
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
