"""One branch of the curve of a cable in a uniform current, in units of H₀ and wH₀.

The cable lies in the plane of a uniform current and has only normal drag. The weight in water is
w > 0 [N/m], φ is the angle between cable and current, and s is the arc length up the cable::

    dT/ds = w sin φ,    T dφ/ds = w g(φ),    g(φ) = cos φ + K |sin φ| sin φ,    K = ρ Cx D V²/(2w)

H₀ is T/w at the apex, φ = 0. In units of H₀ and wH₀, all cables with the same K are pieces of one
curve with its origin at the apex. The curve has two branches. They are separated by the critical
angle φ_c, where g = 0. The second branch has its apex at φ = 180°. With −K in place of K, the
formulas of the first branch give the mirror image of the second branch.

With u = cos φ, u_c = cos φ_c and the parameter λ, the tension is

    T/(wH₀) = [(1 − u_c)(1 + u u_c)/((1 + u_c)(u − u_c))]^m = cosh^m λ,    m = (1 − u_c²)/(1 + u_c²)

The parameter λ covers the whole branch. For K = 0, λ is the parameter of the catenary. Arc length
and distance are computed by quadrature over λ, accurate to rounding.

Source: H. Braconnot, charts for cables in a uniform current; closed form derived here.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Self, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from calm.errors import UsageError

Floats: TypeAlias = NDArray[np.float64]

GREATEST_K = 100.0

# The nearest singularity of the integrands lies about 1.4 off the real axis: 8 nodes on a panel
# of 1/2 leave an error of (1.4/0.25 · 2)^-16, 1e-17.
_PANEL = 0.5
_PANELS = 128
_NODES, _WEIGHTS = (half / 2 for half in np.polynomial.legendre.leggauss(8))
_NODES = _NODES + 0.5


def critical_angle(k: ArrayLike) -> Floats:
    """Return the angle to the current at which a cable is straight [rad]; it is π/2 for K = 0.

    K ≥ 0 is the normal drag per metre divided by the weight per metre.
    """
    return np.asarray(np.arccos(-_leaning(k)), dtype=np.float64)


def check_k(k: float) -> float:
    """Return K, or raise UsageError if K is not between 0 and 100."""
    if not 0.0 <= k <= GREATEST_K:
        raise UsageError(f"K is {k:.6g}; the charts hold for K from 0 to {GREATEST_K:g}")
    return float(k)


@dataclass(frozen=True)
class Branch:
    """One branch of the curve, rotated so that it extends downstream and its apex is at ψ = 0.

    The parameter λ gives a point on the branch; λ is negative before the apex. On the first branch,
    ψ = φ. On the second branch, ψ = 180° − φ, and distances are positive upstream.

    Parameters
    ----------
    k : 0 ≤ K ≤ 100
    sign : 1 for the first branch, −1 for the second
    """

    k: float
    sign: int

    @classmethod
    def holding(cls, k: float, phi: float) -> tuple[Self, float] | None:
        """Return the branch that contains an angle φ [rad], and the value of λ at this angle.

        Returns None for a critical angle. Raises UsageError for an angle beyond ±180°.
        """
        if not -np.pi <= phi <= np.pi:
            raise UsageError(f"an angle is {np.degrees(phi):.6g}°; it must be from −180° to 180°")
        critical = float(critical_angle(k))
        first = critical - np.pi < phi < critical
        branch = cls(k, 1 if first else -1)
        if min(abs(phi - critical), abs(phi - critical + np.pi)) < _STRAIGHT:
            return None
        return branch, float(branch.parameter(branch.turned(phi)))

    def turned(self, angle: ArrayLike) -> Floats:
        """Convert angles φ of this branch to ψ, or ψ to φ [rad]."""
        given = np.asarray(angle, dtype=np.float64)
        return given if self.sign > 0 else np.copysign(np.pi, given) - given

    @cached_property
    def exponent(self) -> float:
        """Exponent m in T/(wH₀) = cosh^m λ."""
        return float(1.0 / np.hypot(1.0, 2.0 * self.k))

    @cached_property
    def limit(self) -> float:
        """Limit of cos ψ far beyond the apex.

        Far before the apex, cos ψ approaches the negative of this value.
        """
        return float(-self.sign * _leaning(self.k))

    def log_tension(self, parameter: ArrayLike) -> Floats:
        """Return ln(T/wH₀), the logarithm of the tension, at the parameter λ."""
        return self.exponent * log_cosh(parameter)

    def angle(self, parameter: ArrayLike) -> Floats:
        """Return the angle ψ [rad] at the parameter λ."""
        size = np.abs(np.asarray(parameter, dtype=np.float64))
        limit = np.where(np.asarray(parameter) < 0.0, -self.limit, self.limit)
        sech = _sech(size)
        squared_tangent = (1.0 - limit**2) * np.tanh(size) * np.tanh(size / 2.0)
        squared_tangent /= (1.0 + limit) ** 2 + (1.0 - limit) ** 2 * sech
        return np.asarray(np.sign(parameter) * 2.0 * np.arctan(np.sqrt(squared_tangent)))

    def parameter(self, angle: ArrayLike) -> Floats:
        """Return λ at angles ψ [rad], which must lie between the two critical angles."""
        signed = np.asarray(angle, dtype=np.float64)
        limit = np.where(signed < 0.0, -self.limit, self.limit)
        size, critical = np.abs(signed), np.arccos(limit)
        beyond = 2.0 * np.sin((critical + size) / 2.0) * np.sin((critical - size) / 2.0)
        excess = (1.0 + limit**2) * 2.0 * np.sin(size / 2.0) ** 2 / ((1.0 + limit) * beyond)
        size = np.log1p(excess + np.sqrt(excess * (excess + 2.0)))
        return np.asarray(np.copysign(size, signed))

    def from_apex(self, parameter: ArrayLike) -> tuple[Floats, Floats]:
        """Return the arc length s′ and the distance y′ of points from the apex, in units of H₀.

        y′ is positive downstream on both branches.
        """
        signed = np.asarray(parameter, dtype=np.float64)
        arc, distance = self.span(np.minimum(signed, 0.0), np.maximum(signed, 0.0))
        side = np.sign(signed)
        return side * arc, side * self.sign * distance

    def span(self, start: ArrayLike, end: ArrayLike) -> tuple[Floats, Floats]:
        """Return the arc length and the distance between two points, in units of H₀.

        `start` and `end` are values or arrays of λ, with `start` ≤ `end`.
        """
        first, last = (
            np.asarray(side, dtype=np.float64) for side in np.broadcast_arrays(start, end)
        )
        total = self._span(self.limit, np.maximum(first, 0.0), np.maximum(last, 0.0))
        if np.any(first < 0.0):
            before = np.maximum(-last, 0.0), np.maximum(-first, 0.0)
            total = total + self._span(-self.limit, *before)
        return total[0], total[1]

    def _span(self, limit: float, start: Floats, end: Floats) -> Floats:
        """Return arc length and distance (2, …) between two points with 0 ≤ start ≤ end."""
        # a short piece is integrated directly, since the difference of two long ones loses digits
        short = end - start <= _PANEL
        whole = self._cumulative[limit]
        edge_start, edge_end = (
            np.minimum(np.floor(place / _PANEL), _PANELS) * _PANEL for place in (start, end)
        )
        total = self._panel(limit, np.where(short, start, edge_end), end)
        if not np.all(short):
            between = np.moveaxis(
                whole[(edge_end / _PANEL).astype(int)] - whole[(edge_start / _PANEL).astype(int)],
                -1,
                0,
            )
            rest = self._panel(limit, edge_start, start)
            total = total + np.where(short, 0.0, between - rest)
        return total

    def _panel(self, limit: float, start: Floats, end: Floats) -> Floats:
        """Return arc length and distance (2, …) between two points within one panel.

        Far from the apex, the two points may be more than one panel apart.
        """
        width = end - start
        places = start + width * _NODES.reshape(-1, *([1] * start.ndim))
        arc, cosine = self._rates(limit, places)
        weights = _WEIGHTS.reshape(-1, *([1] * start.ndim)) * width
        total = np.array([np.sum(weights * arc, axis=0), np.sum(weights * arc * cosine, axis=0)])
        far = width > _PANEL
        if np.any(far):
            # at this distance from the apex, the cable is straight within rounding
            rise = np.exp(self.log_tension(end)) - np.exp(self.log_tension(start))
            straight = np.where(far, rise, 0.0) / np.sqrt(1.0 - limit**2)
            total = np.where(far, [straight, limit * straight], total)
        return total

    def _rates(self, limit: Floats | float, parameter: Floats) -> tuple[Floats, Floats]:
        """Return ds′/dλ and cos ψ on one side of the apex, for λ ≥ 0.

        `limit` selects the side: it is the limit of cos ψ far from the apex on this side.
        """
        sech = _sech(parameter)
        divisor = 1.0 + limit - limit * (1.0 - limit) * sech
        cosine = ((1.0 - limit) * sech + limit * (1.0 + limit)) / divisor
        root = (1.0 - limit**2) * ((1.0 + limit) ** 2 + (1.0 - limit) ** 2 * sech)
        tension = np.exp(self.log_tension(parameter))
        return self.exponent * tension * np.sqrt((1.0 + sech) / root) * divisor, cosine

    @cached_property
    def _cumulative(self) -> dict[float, Floats]:
        """Arc length and distance (panels + 1, 2) from the apex to each edge of the panels.

        The keys are the limits of cos ψ on the two sides of the apex.
        """
        edges: Floats = np.arange(_PANELS + 1) * np.float64(_PANEL)
        tables = {}
        for limit in (self.limit, -self.limit):
            panels = self._panel(limit, edges[:-1], edges[1:])
            tables[limit] = np.vstack([np.zeros(2), np.cumsum(panels.T, axis=0)])
        return tables


def log_cosh(parameter: ArrayLike) -> Floats:
    """Return the logarithm of cosh λ without overflow or loss of digits."""
    size = np.abs(np.asarray(parameter, dtype=np.float64))
    near = np.log1p(2.0 * np.sinh(np.minimum(size, 1.0) / 2.0) ** 2)
    return np.where(size < 1.0, near, size + np.log1p(np.exp(-2.0 * size)) - np.log(2.0))


def inverse_log_cosh(value: ArrayLike) -> Floats:
    """Return λ ≥ 0 for a given ln cosh λ ≥ 0."""
    given = np.asarray(value, dtype=np.float64)
    excess = np.expm1(np.minimum(given, 1.0))
    near = np.log1p(excess + np.sqrt(excess * (excess + 2.0)))
    return np.where(given < 1.0, near, given + np.log1p(np.sqrt(-np.expm1(-2.0 * given))))


# angles closer to the critical angle than this [rad] count as critical
_STRAIGHT = 1e-12


def _leaning(k: ArrayLike) -> Floats:
    """Return −cos φ_c, the root of x² K + x = K, without cancellation."""
    twice = 2.0 * np.asarray(k, dtype=np.float64)
    return np.asarray(twice / (1.0 + np.hypot(1.0, twice)))


def _sech(size: Floats) -> Floats:
    decay = np.exp(-size)
    return np.asarray(2.0 * decay / (1.0 + decay**2))


@dataclass(frozen=True)
class CurvePoints:
    """Points of the curve in units of H₀ and wH₀, as arrays of equal shape.

    Parameters
    ----------
    phi : angle of the cable to the current [rad]
    arc, distance, height : arc length, distance (positive downstream) and height from the apex
    tension : T/(wH₀) = 1 + height
    """

    phi: Floats
    arc: Floats
    distance: Floats
    height: Floats
    tension: Floats


def curve(k: float, phi: ArrayLike) -> CurvePoints:
    """Return the points of the curve at given angles, with errors below 1e-12 of the arc length.

    Points between φ_c − π and φ_c lie on the first branch, and other points on the second.

    Parameters
    ----------
    k : 0 ≤ K ≤ 100
    phi : angles to the current [rad], from −π to π

    Raises
    ------
    UsageError
        K or an angle is outside its range, or an angle is critical.
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
