"""Heavy line in a uniform stream, drag as the square of its normal component: the exact integrals.

With φ the angle between the line going up and the way upstream, s up the line, w its weight and R
its normal drag per metre when square to the stream, p = w/R:

    dT/ds = w sin φ + F,      T dφ/ds = −R D(φ),      D = sin²φ − p cos φ,      0 ≤ φ ≤ π.

D vanishes at the critical angle φc, cos φc = u = √(1 + p²/4) − p/2, which no line crosses, and
D = (u − cos φ)(cos φ + 1/u). With a = tan(φc/2) and

    a cot(φ/2) = tanh m  (φ > φc)    or    coth m  (φ < φc),

the whole of either branch is m = 0 (the line level) to ∞ (straight at φc), up the line, and

    ∫ (p sin φ/D) dφ,      ∫ dφ/D,      ∫ (cos²φ/D) dφ

are elementary in m. So is the tension, for F = 0, F = f R (Pode: constant along the line) and
F = f R cos²φ (tangential drag as the square of its own component), F changing sign at 90°. Arc,
distance and height follow from the tension by one smooth quadrature in m.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf, isfinite, nan, pi, sqrt
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from calm.analytic.station import Floats

Law = Literal["constant", "square"]


def cosine_of_critical_angle(weight_ratio: ArrayLike) -> Floats:
    """u = √(1 + p²/4) − p/2 without cancellation; p ≥ 0 [-]."""
    half = 0.5 * np.asarray(weight_ratio, float)
    return 1.0 / (half + np.sqrt(1.0 + half * half))


@dataclass(frozen=True)
class Hodograph:
    """One branch of the shapes of a heavy line.

    Parameters
    ----------
    weight_ratio : p = w/R > 0 [-]
    friction : f ≥ 0 [-]
    law : how f acts: "constant", F = f R, or "square", F = f R cos²φ
    steep : the branch φ > φc; else φ < φc

    Raises
    ------
    ValueError
        Where p or f is outside its range.
    """

    weight_ratio: float
    friction: float
    law: Law
    steep: bool

    def __post_init__(self) -> None:
        if not (isfinite(self.weight_ratio) and self.weight_ratio > 0.0):
            raise ValueError(
                f"weight over normal drag must be above 0, not {self.weight_ratio:g}; "
                "a line without weight is the neutral line"
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
        """φc [rad]."""
        return float(np.arctan2(self._sine, self._u))

    def parameter(self, angle: ArrayLike) -> Floats:
        """M of an angle [rad] of this branch; inf at φc, nan on the other branch."""
        half = 0.5 * np.asarray(angle, float)
        a, sine, cosine = self._a, np.sin(half), np.cos(half)
        # e^(2m) = (1 + tanh m)/(1 − tanh m), where 1 − tanh m is a sine of φ − φc
        gap = np.sin(half - 0.5 * self.critical_angle) * np.hypot(a, 1.0)
        away, near = (gap, a * cosine) if self.steep else (-gap, sine)
        with np.errstate(divide="ignore", invalid="ignore"):
            m = 0.5 * np.log1p(2.0 * near / away)
        return np.where(away < 0.0, nan, np.where(away == 0.0, inf, m))

    def _half_angle(self, m: Floats) -> tuple[Floats, Floats]:
        """Numbers in the ratio sin(φ/2) : cos(φ/2)."""
        tanh = np.tanh(m)
        return (self._a, tanh) if self.steep else (self._a * tanh, np.ones_like(tanh))

    def direction(self, m: ArrayLike) -> tuple[Floats, Floats]:
        """Cosine and sine of φ."""
        sine, cosine = self._half_angle(np.asarray(m, float))
        square = sine * sine + cosine * cosine
        return (cosine - sine) * (cosine + sine) / square, 2.0 * sine * cosine / square

    def angle(self, m: ArrayLike) -> Floats:
        """φ [rad]."""
        sine, cosine = self._half_angle(np.asarray(m, float))
        return 2.0 * np.arctan2(sine, cosine)

    @cached_property
    def _upright(self) -> float:
        """M of φ = 90°, the kink of the friction; 0 on the branch that does not come there."""
        return float(np.arctanh(self._a)) if self.steep else 0.0

    def log_tension(self, m: ArrayLike) -> Floats:
        """Logarithm of the tension, but for a constant."""
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
        # beyond 90° the stream rubs the other way
        return weight + self.friction * np.abs(here - upright)

    def _rubbing(self, m: Floats) -> Floats:
        """∫ F/(f R D) dφ down from φ, but for a constant: growing with m."""
        u, a = self._u, self._a
        sine, cosine = self._half_angle(m)
        straight = 2.0 * m / self._sine
        # ∫ dφ/(cos φ + 1/u); (1 − a²)/a = 2u/sin φc
        bend = 2.0 * u / self._sine * np.arctan2(a * sine, cosine)
        if self.law == "constant":
            return (straight - bend) * u / (1.0 + u * u)
        angle = 2.0 * np.arctan2(sine, cosine)
        return (u**3 * straight - bend / u) / (1.0 + u * u) + angle

    def integrals(self, start: float, end: float) -> tuple[float, float, float]:
        """∫ {1, cos φ, sin φ} (T/T at `start`) R ds/T from one m to another: σ, ξ, η.

        They are arc, distance upstream and height in units of T/R at `start`.
        """
        from scipy.integrate import quad

        reference = float(self.log_tension(start))
        u = self._u

        def slope(m: float, part: int) -> float:
            cosine, sine = (float(value) for value in self.direction(m))
            tension = float(np.exp(self.log_tension(m) - reference))
            share = (1.0, cosine, sine)[part]
            return tension * share * 2.0 * u / (self._sine * (1.0 + u * cosine))

        kinks = [self._upright] if self.friction and start < self._upright < end else None
        sigma, xi, eta = (
            float(quad(slope, start, end, (part,), epsabs=0.0, epsrel=1e-12, limit=400, points=kinks)[0])
            for part in range(3)
        )
        return sigma, xi, eta
