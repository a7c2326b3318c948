"""Shape of a line in a uniform horizontal stream, with a quadratic normal drag R sin²φ per metre.

R = ½ρ Cn D V² is the drag per metre of a line normal to the stream, and F the tangential drag. With
the arc length s up the line and coordinates as in `Station`,

    dT/ds = w sin φ + F,      T dφ/ds = −(R sin²φ − w cos φ),      dx/ds = cos φ,      dz/ds = sin φ

Without weight, T is constant and the shape is a catenary turned by 90°. Without tangential drag,
the difference in tension between two points is w times their difference in height.

Pode's cable functions are for a heavy line with constant F. They refer to the point where the line
is normal to the stream, with tension T₀. With p = w/R and f = F/R,

    τ = T/T₀ = exp ∫ (f + p sin α)/(sin²α − p cos α) dα,      R s/T₀ = σ = ∫ τ dα/(sin²α − p cos α),

where the integrals run from φ to 90°. For ξ and η, replace τ in the integral for σ by τ cos α and
τ sin α. The functions satisfy τ − 1 = p η + f σ. Pode tabulates f = 0.01, 0.02 and 0.03.

Sources: L. Pode, *Tables for computing the equilibrium configuration of a flexible cable in a
uniform stream*, David Taylor Model Basin report 687, 1951; E. E. Zajac, Bell System Technical
Journal 36, 1957, for the critical angle.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from calm.analytic import catenary
from calm.analytic.hodograph import Floats, Hodograph, Law, Station, cosine_of_critical_angle


def neutral_line(
    arc: ArrayLike, tension: ArrayLike, angle: ArrayLike, normal_drag: ArrayLike
) -> Station:
    """Return the shape of a line without weight, along which the tension T is constant.

    With c = cot φ: c = c₀ + R s/T, x = (T/R) (√(1 + c²) − √(1 + c₀²)), z = (T/R) (asinh c − asinh
    c₀). Arrays broadcast against each other.

    Parameters
    ----------
    arc : distance s along the line from the given end [m], positive up the line
    tension : T > 0 [N]
    angle : φ₀ at the given end, between 0 and π [rad]
    normal_drag : R > 0 [N/m]

    Raises
    ------
    ValueError
        A parameter is outside its range.
    """
    s, t, start, r = (np.asarray(value, float) for value in (arc, tension, angle, normal_drag))
    if not (np.all(t > 0.0) and np.all(r > 0.0)):
        raise ValueError("the tension and the normal drag of a neutral line must be above 0")
    if not np.all((start > 0.0) & (start < np.pi)):
        raise ValueError("the angle of a neutral line must be between 0 and π")
    cotangent = np.cos(start) / np.sin(start)
    z, x = catenary.position(s, t, t * cotangent, r)
    phi: Floats = np.arctan2(1.0, cotangent + r * s / t)
    return Station(phi, np.broadcast_to(t, phi.shape), x, z)


def critical_angle(weight_ratio: ArrayLike) -> Floats:
    """Return the angle φc [rad] at which a line is straight, from cos φc = √(1 + p²/4) − p/2.

    `weight_ratio` is p = w/R ≥ 0. A line lighter than water is the vertical mirror image of a heavy
    line.

    Raises
    ------
    ValueError
        p is negative.
    """
    p = np.asarray(weight_ratio, float)
    if not np.all(p >= 0.0):
        raise ValueError(
            "the ratio of weight to normal drag must not be negative; a line lighter than water is "
            "the vertical mirror image of a heavy line"
        )
    u = cosine_of_critical_angle(p)
    return np.arctan2(np.sqrt(p * u), u)


def critical_weight_ratio(angle: ArrayLike) -> Floats:
    """Return the weight ratio p = w/R = sin φc tan φc [-] for a critical angle φc [rad].

    Raises
    ------
    ValueError
        φc is not from 0 to below π/2.
    """
    phi = np.asarray(angle, float)
    if not np.all((phi >= 0.0) & (phi < 0.5 * np.pi)):
        raise ValueError("a critical angle must be at least 0 and below 90°")
    ratio: Floats = np.sin(phi) * np.tan(phi)
    return ratio


def tension_ratio(
    angle: ArrayLike, start: float, weight_ratio: float, friction: float = 0.0, law: Law = "square"
) -> Floats:
    """Return the ratio of a heavy line's tensions at two angles, in closed form.

    Without friction and for φ₀ = 90°, the ratio is [u (1 + u cos φ)/(u − cos φ)]^((1 − u²)/(1 +
    u²)) with u = cos φc, where φc is the critical angle.

    Parameters
    ----------
    angle, start : φ and φ₀, 0 to π, on the same side of the critical angle [rad]
    weight_ratio : p = w/R > 0 [-]
    friction : f ≥ 0, ratio of maximum tangential to maximum normal drag per metre [-]
    law : "square": tangential drag f R cos²φ; "constant": f R at any angle (Pode)

    Raises
    ------
    ValueError
        The two angles are on different sides of the critical angle, or a value is outside its
        range.
    """
    branch = branch_of(start, weight_ratio, friction, law)
    m = branch.parameter(_checked(angle))
    if not np.all(np.isfinite(m)):
        raise ValueError(
            "all angles must be on the same side of the critical angle, "
            f"{np.degrees(branch.critical_angle):.6g}°, as the first angle"
        )
    return np.exp(branch.log_tension(m) - branch.log_tension(branch.parameter(start)))


def heavy_line(
    arc: ArrayLike,
    tension: float,
    angle: float,
    weight: float,
    normal_drag: float,
    tangential_drag: float = 0.0,
    law: Law = "square",
) -> Station:
    """Return the shape of a heavy line.

    Below a point where the line is horizontal, the line rises again, and its angle is below 0 or
    above π. A line lighter than water is the vertical mirror image of a line of weight −w.

    Parameters
    ----------
    arc : distance s along the line from the given end [m], positive up the line
    tension, angle : T₀ > 0 [N] and φ₀, −π to π [rad], at the given end
    weight : w > 0, weight per metre in the fluid [N/m]
    normal_drag : R > 0, drag per metre of a line normal to the stream [N/m]
    tangential_drag : drag per metre of a line along the stream, ≥ 0 [N/m]
    law : dependence of the tangential drag on the angle: "square" (cos²φ) or "constant"

    Raises
    ------
    ValueError
        A value is outside its range, or the tension of a straight line falls to zero within the
        arc.
    """
    if not (0.0 < tension < np.inf and 0.0 < normal_drag < np.inf):
        raise ValueError("the tension and the normal drag of a heavy line must be above 0")
    arcs = np.asarray(arc, float)
    if not np.all(np.isfinite(arcs)):
        raise ValueError("the arc lengths along a heavy line must be finite")
    if not -np.pi <= angle <= np.pi:
        raise ValueError(f"the angle of a heavy line must be from -π to π, not {angle:g}")

    def follow(s: float, pull: float, phi: float) -> tuple[float, float, float, float]:
        if phi < 0.0:
            turned, pull, x, z = follow(-s, pull, phi + np.pi)
            return turned - np.pi, pull, x, z
        branch = branch_of(phi, weight / normal_drag, tangential_drag / normal_drag, law)
        start, unit = float(branch.parameter(phi)), pull / normal_drag
        if np.isinf(start):
            return straight(s, pull, phi)
        step = branch.advance(start, s / unit)
        m = start + step
        ratio = float(np.exp(branch.log_tension(m) - branch.log_tension(start)))
        x, z = (unit * size for size in branch.reach(start, step))
        if m > 0.0 or s >= 0.0:
            return float(branch.angle(m)), pull * ratio, x, z
        beyond = unit * branch.arc(start, step) - s
        half_turn = np.pi if branch.steep else -np.pi
        rest = follow(beyond, pull * ratio, 0.0 if branch.steep else np.pi)
        return rest[0] + half_turn, rest[1], x + rest[2], z + rest[3]

    def straight(s: float, pull: float, phi: float) -> tuple[float, float, float, float]:
        cosine, sine = float(np.cos(phi)), float(np.sin(phi))
        rubbed = tangential_drag * (cosine**2 if law == "square" else 1.0)
        pull += (weight * sine + rubbed) * s
        if not pull >= 0.0:
            raise ValueError(
                "the tension of the straight line falls to 0 before this arc length is reached"
            )
        return phi, pull, s * cosine, s * sine

    stations = np.array([follow(float(s), tension, angle) for s in arcs.ravel()])
    return Station(*np.moveaxis(stations.reshape(*arcs.shape, 4), -1, 0))


def branch_of(start: float, weight_ratio: float, friction: float, law: Law) -> Hodograph:
    """Return the branch of shapes that contains an angle [rad].

    The critical angle belongs to the steep branch.
    """
    _checked(start)
    if law not in ("constant", "square"):
        raise ValueError(
            f'the law of the tangential drag must be "constant" or "square", not "{law}"'
        )
    steep = Hodograph(weight_ratio, friction, law, steep=True)
    return steep if start >= steep.critical_angle else Hodograph(weight_ratio, friction, law, False)


def _checked(angle: ArrayLike) -> Floats:
    phi = np.asarray(angle, float)
    if not np.all((phi >= 0.0) & (phi <= np.pi)):
        raise ValueError("the angle of a heavy line must be from 0 to π")
    return phi


class CableFunctions(NamedTuple):
    """Values of Pode's functions; the arrays have the shape of the angles.

    Attributes
    ----------
    tau : tension T/T₀
    sigma : arc length R s/T₀
    xi : distance upstream R x/T₀
    eta : height R z/T₀
    """

    tau: Floats
    sigma: Floats
    xi: Floats
    eta: Floats


def cable_functions(angle: ArrayLike, weight_ratio: float, friction: float = 0.0) -> CableFunctions:
    """Compute Pode's functions between 90° and an angle φ.

    Parameters
    ----------
    angle : φ [rad], above the critical angle and at most π. Angles below 90° are for a towed line;
        the body is at the point where φ = 90°. Angles above 90° are for a mooring line: arc lengths
        are negative, and the tangential drag and the term f σ change sign
    weight_ratio : p = w/R > 0 [-]
    friction : f = F/R ≥ 0 [-]

    Raises
    ------
    ValueError
        An angle or a ratio is outside its range.
    """
    branch = branch_of(0.5 * np.pi, weight_ratio, friction, "constant")
    angles = np.asarray(angle, float)
    if not np.all((angles > branch.critical_angle) & (angles <= np.pi)):
        raise ValueError(
            "angles must be greater than the critical angle, "
            f"{np.degrees(branch.critical_angle):.6g}°, and at most 180°"
        )
    start = float(branch.parameter(0.5 * np.pi))
    rows = []
    for m in branch.parameter(angles).ravel():
        tau = float(np.exp(branch.log_tension(m) - branch.log_tension(start)))
        rows.append((tau, branch.arc(start, m - start), *branch.reach(start, m - start)))
    return CableFunctions(*np.moveaxis(np.array(rows).reshape(*angles.shape, 4), -1, 0))
