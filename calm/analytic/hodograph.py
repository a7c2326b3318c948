"""Heavy line in a uniform stream, with drag quadratic in the normal velocity: exact integrals.

φ is the angle between the upward direction of the line and the upstream direction, and s the arc
length up the line. Per metre of line, w is the weight, R the drag normal to the stream, and F the
tangential drag. With p = w/R:

    dT/ds = w sin φ + F,      T dφ/ds = −R D(φ),      D = sin²φ − p cos φ,      0 ≤ φ ≤ π.

No line crosses the critical angle φc with D = 0 and cos φc = u = √(1 + p²/4) − p/2. On each side of
φc lies a branch with a parameter m. With a = tan(φc/2),

    a cot(φ/2) = tanh m  (φ > φc)    or    coth m  (φ < φc).

Up the line, m grows from 0 (line horizontal) to ∞ (straight at φc). The tension is an elementary
function of m for

- F = 0;
- F = f R (Pode's constant friction);
- F = f R cos²φ (drag quadratic in the tangential velocity), where F changes sign at 90°.

Arc length, distance and height need one quadrature in m.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import inf, isfinite, nan, sqrt
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Law = Literal["constant", "square"]


def cosine_of_critical_angle(weight_ratio: ArrayLike) -> Floats:
    """Return the cosine of the critical angle, √(1 + p²/4) − p/2 [-].

    The weight ratio p must be ≥ 0. The formula is evaluated without cancellation.
    """
    half = 0.5 * np.asarray(weight_ratio, float)
    return 1.0 / (half + np.sqrt(1.0 + half * half))


@dataclass(frozen=True)
class Hodograph:
    """One branch of the possible shapes of a heavy line.

    Parameters
    ----------
    weight_ratio : p = w/R > 0, ratio of weight to normal drag [-]
    friction : f ≥ 0, ratio of the largest tangential drag to R [-]
    law : tangential drag F: "constant" for F = f R, or "square" for F = f R cos²φ
    steep : true for the branch φ > φc, false for the branch φ < φc

    Raises
    ------
    ValueError
        p or f is outside its range.
    """

    weight_ratio: float
    friction: float
    law: Law
    steep: bool

    def __post_init__(self) -> None:
        if not (isfinite(self.weight_ratio) and self.weight_ratio > 0.0):
            raise ValueError(
                f"the ratio of weight to normal drag must be above 0, not {self.weight_ratio:g}; "
                "for a line without weight, use the neutral line"
            )
        if not (isfinite(self.friction) and self.friction >= 0.0):
            raise ValueError(f"the tangential drag must not be negative: {self.friction:g}")

    @cached_property
    def _u(self) -> float:
        return float(cosine_of_critical_angle(self.weight_ratio))

    @cached_property
    def _sine(self) -> float:
        return sqrt(self.weight_ratio * self._u)

    @cached_property
    def _a(self) -> float:
        return self._sine / (1.0 + self._u)

    @property
    def critical_angle(self) -> float:
        """Critical angle φc [rad]."""
        return float(np.arctan2(self._sine, self._u))

    def parameter(self, angle: ArrayLike) -> Floats:
        """Return the parameter m at an angle φ [rad].

        The parameter is inf at φc, and nan for an angle that is not on this branch.
        """
        half = 0.5 * np.asarray(angle, float)
        a, sine, cosine = self._a, np.sin(half), np.cos(half)
        # e^(2m) = (1 + tanh m)/(1 − tanh m), where 1 − tanh m is a sine of φ − φc
        gap = np.sin(half - 0.5 * self.critical_angle) * np.hypot(a, 1.0)
        away, near = (gap, a * cosine) if self.steep else (-gap, sine)
        with np.errstate(divide="ignore", invalid="ignore"):
            m = 0.5 * np.log1p(2.0 * near / away)
        return np.where(away < 0.0, nan, np.where(away == 0.0, inf, m))

    def _half_angle(self, m: Floats) -> tuple[Floats, Floats]:
        """Return two numbers in the ratio sin(φ/2) : cos(φ/2)."""
        tanh = np.tanh(m)
        one = np.ones_like(tanh)
        return (self._a * one, tanh) if self.steep else (self._a * tanh, one)

    def direction(self, m: ArrayLike) -> tuple[Floats, Floats]:
        """Return the cosine and the sine of the angle φ at m."""
        sine, cosine = self._half_angle(np.asarray(m, float))
        square = sine * sine + cosine * cosine
        return (cosine - sine) * (cosine + sine) / square, 2.0 * sine * cosine / square

    def angle(self, m: ArrayLike) -> Floats:
        """Return the angle φ [rad] at m."""
        sine, cosine = self._half_angle(np.asarray(m, float))
        return 2.0 * np.arctan2(sine, cosine)

    @cached_property
    def _upright(self) -> float:
        """Parameter m at φ = 90°, where the friction has a kink; 0 if not on this branch."""
        return float(np.arctanh(self._a)) if self.steep else 0.0

    def log_tension(self, m: ArrayLike) -> Floats:
        """Return the logarithm of the tension at m, up to an additive constant."""
        m = np.asarray(m, float)
        decay, a4 = np.exp(-2.0 * m), self._a**4
        less, more = -np.expm1(-2.0 * m), 1.0 + decay
        if self.steep:
            shares = np.square(less) + a4 * np.square(more)
        else:
            shares = np.square(more) + a4 * np.square(less)
        u = self._u
        power = (1.0 - u * u) / (1.0 + u * u)
        weight: Floats = power * (2.0 * m + np.log(shares))
        if self.friction == 0.0:
            return weight
        here, upright = self._rubbing(m), self._rubbing(np.asarray(self._upright))
        # beyond 90° the tangential flow reverses
        return weight + self.friction * np.abs(here - upright)

    def _rubbing(self, m: Floats) -> Floats:
        """Return the integral ∫ F/(f R D) dφ up to a constant; it increases with φ."""
        u, a = self._u, self._a
        sine, cosine = self._half_angle(m)
        straight = 2.0 * m / self._sine
        # ∫ dφ/(cos φ + 1/u); (1 − a²)/a = 2u/sin φc
        bend = 2.0 * u / self._sine * np.arctan2(a * sine, cosine)
        if self.law == "constant":
            return (straight - bend) * u / (1.0 + u * u)
        angle = 2.0 * np.arctan2(sine, cosine)
        return (u**3 * straight - bend / u) / (1.0 + u * u) + angle

    def slope(self, m: ArrayLike) -> Floats:
        """Return (R/T) ds/dm, which is positive, so that the arc length increases with m."""
        sine, cosine = self._half_angle(np.asarray(m, float))
        u, s2, c2 = self._u, sine * sine, cosine * cosine
        # 1 + u cos φ, without cancellation where both are near 1
        return 2.0 * u * (s2 + c2) / (self._sine * (1.0 + u) * (c2 + self._a**2 * s2))

    def arc(self, start: float, step: float) -> float:
        """Return σ = ∫ R ds/T₀ over a step of m, where T₀ is the tension at `start`."""
        return self._integral(start, step, None, 0.0)

    def reach(self, start: float, step: float) -> tuple[float, float]:
        """Return the distance upstream ξ and the height η over a step of m, in units of T₀/R."""
        # either coordinate may vanish although the arc length does not
        floor = 1e-13 * abs(self.arc(start, step))
        xi, eta = (self._integral(start, step, share, floor) for share in (0, 1))
        return xi, eta

    def _integral(self, start: float, step: float, share: int | None, floor: float) -> float:
        reference = float(self.log_tension(start))

        def part(after: float) -> float:
            m = start + after
            projection = 1.0 if share is None else self.direction(m)[share]
            return float(np.exp(self.log_tension(m) - reference) * projection * self.slope(m))

        return integrated(part, self._panels(start, step), floor)

    def _panels(self, start: float, step: float) -> list[float]:
        """Return the edges of the panels for quadrature over a step of m, relative to `start`.

        If friction has a kink within the step, one edge is at the kink.
        """
        low, high = sorted((start, start + step))
        # the line turns within the first few parts, which quadrature over a long step would miss
        edge, cuts = self._upright or self._a, []
        while edge < high:
            if edge > low:
                cuts.append(edge - start)
            edge *= 4.0
        return [0.0, *(cuts if step > 0.0 else reversed(cuts)), step]

    def advance(self, start: float, arc: float) -> float:
        """Return the step of m that covers a given arc length, in units of T₀/R.

        The arc is positive up the line, and `start` must be finite. The result is −`start` if the
        line becomes horizontal first.
        """
        from scipy.optimize import brentq

        side, length = (-1.0, -arc) if arc < 0.0 else (1.0, arc)
        limit = start if arc < 0.0 else inf

        def miss(step: float) -> float:
            return side * self.arc(start, side * step) - length

        def farther(near: float, width: float) -> float:
            # the tension may grow without bound: limit its growth to e^10 per step
            far, reference = min(near + width, limit), self.log_tension(start + side * near)
            while self.log_tension(start + side * far) - reference > 10.0:
                far = 0.5 * (near + far)
            return far

        near, width = 0.0, length / float(self.slope(start))
        far = farther(near, width)
        while miss(far) < 0.0:
            if far == limit:
                return -start
            near, width = far, 2.0 * width
            far = farther(near, width)
        return side * float(brentq(miss, near, far, xtol=1e-300, rtol=1e-15)) if far else 0.0


Floats = NDArray[np.float64]


def integrated(part: Callable[[float], float], edges: Sequence[float], floor: float) -> float:
    """Integrate a function over panels, to a relative error of 1e-12.

    Parameters
    ----------
    part : function to integrate
    edges : edges of the panels, in increasing or decreasing order
    floor : absolute error that is negligible
    """
    from scipy.integrate import quad

    return sum(
        float(quad(part, low, high, epsabs=floor, epsrel=1e-12, limit=400)[0])
        for low, high in pairwise(edges)
    )


class Station(NamedTuple):
    """Points on a line in a stream. Positions are relative to the end where the tension is given.

    The angle of a cable above a towed body is below 90°. The angle of a mooring line is above 90°:
    90° + tilt. A towed body with the weight W in water and the drag D gives its end of the cable
    the tension √(W² + D²) and the angle atan2(W, D). A float with the buoyancy B and the drag D
    gives the same tension with B in place of W, and the angle atan2(B, −D).

    Attributes
    ----------
    angle : angle between the upward direction of the line and the upstream direction [rad]
    tension : tension [N]
    x, z : distance upstream of this end, and height above this end [m]
    """

    angle: Floats
    tension: Floats
    x: Floats
    z: Floats
