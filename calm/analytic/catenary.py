"""Catenary: a line in still water, inextensible or elastic, suspended or partly on the seabed.

The horizontal tension is H. The vertical tension is V at the upper end, and V₀ = V − w s at an
unstretched distance s below. With the weight w per metre, an inextensible line spans

    x = (H/w) [asinh(V/H) − asinh(V₀/H)],      z = [√(H² + V²) − √(H² + V₀²)] / w.

Linear stretch adds H s/EA to x and (V² − V₀²)/(2 w EA) to z; w is then per unstretched metre. On a
level seabed without friction, the length L − V/w lies on the seabed with tension H.

Source: H. M. Irvine, *Cable Structures*, MIT Press, 1981, chapter 2.
"""

from dataclasses import dataclass
from math import hypot, inf, isfinite, sqrt, tanh

import numpy as np
from numpy.typing import ArrayLike

from calm.analytic.hodograph import Floats


def position(
    arc: ArrayLike, horizontal: ArrayLike, vertical: ArrayLike, weight: ArrayLike
) -> tuple[Floats, Floats]:
    """Return the position of one point on an inextensible line relative to another.

    Parameters
    ----------
    arc : distance along the line from the known point [m], positive up the line
    horizontal, vertical : components of the tension at the known point [N]; `vertical` is positive
        if the line rises from this point
    weight : weight per metre, > 0 [N/m]

    Returns
    -------
    x, z : horizontal distance, with the sign of `horizontal * arc`, and height relative to the
        known point [m]
    """
    s, h, v, w = (np.asarray(value, float) for value in (arc, horizontal, vertical, weight))
    top = v + w * s
    sum_of_tensions = np.hypot(h, top) + np.hypot(h, v)
    with np.errstate(divide="ignore", invalid="ignore"):
        # the half-angle form is accurate for a taut line, the difference for a slack line
        taut = w * s / sum_of_tensions
        turn = np.where(
            np.abs(taut) < 0.5,
            2.0 * np.arctanh(np.clip(taut, -0.5, 0.5)),
            np.arcsinh(top / np.abs(h)) - np.arcsinh(v / np.abs(h)),
        )
        x = np.where(h == 0.0, 0.0, h / w * turn)
        z = np.where(sum_of_tensions == 0.0, 0.0, (top + v) * s / sum_of_tensions)
    return x, z


@dataclass(frozen=True)
class Catenary:
    """A line suspended between two points, defined by the forces at its upper end.

    Parameters
    ----------
    horizontal, vertical : tension H > 0 and V at the upper end [N]; V > 0 if `seabed` is set
    length : unstretched length L > 0 [m]
    weight : weight in water per unstretched metre, > 0 [N/m]
    stiffness : axial stiffness EA [N]; infinite for an inextensible line
    seabed : whether the lower part of the line may lie on a level seabed without friction

    Fields may be arrays that broadcast against each other.

    Raises
    ------
    ValueError
        A field is outside its range.
    """

    horizontal: ArrayLike
    vertical: ArrayLike
    length: ArrayLike
    weight: ArrayLike
    stiffness: ArrayLike = inf
    seabed: bool = False

    def __post_init__(self) -> None:
        for name in ("horizontal", "length", "weight", "stiffness"):
            if not np.all(np.asarray(getattr(self, name)) > 0.0):
                raise ValueError(f"the {name} of a catenary must be above 0")
        if self.seabed and not np.all(np.asarray(self.vertical) > 0.0):
            raise ValueError("a line that rises from the seabed needs a vertical pull above 0")

    @property
    def grounded(self) -> Floats:
        """Unstretched length of the part of the line that lies on the seabed [m]."""
        length = np.asarray(self.length, float)
        if not self.seabed:
            return np.zeros_like(length)
        lifted = np.asarray(self.vertical, float) / np.asarray(self.weight, float)
        rest: Floats = np.maximum(length - lifted, 0.0)
        return rest

    @property
    def vertical_bottom(self) -> Floats:
        """Vertical tension at the lower end [N], positive if the line rises from there.

        The value is 0 if the lower part of the line lies on the seabed.
        """
        lifted = np.asarray(self.length, float) - self.grounded
        hanging = np.asarray(self.vertical, float) - np.asarray(self.weight, float) * lifted
        return np.where(self.grounded > 0.0, 0.0, hanging)

    @property
    def tension_top(self) -> Floats:
        """Tension at the upper end [N]."""
        return np.hypot(self.horizontal, self.vertical)

    @property
    def tension_bottom(self) -> Floats:
        """Tension at the lower end [N]."""
        return np.hypot(self.horizontal, self.vertical_bottom)

    def position(self, arc: ArrayLike) -> tuple[Floats, Floats]:
        """Return the horizontal distance and height of a point, relative to the lower end [m].

        `arc` is the unstretched length from the lower end to the point [m].

        Raises
        ------
        ValueError
            A value of `arc` is negative or exceeds `length`.
        """
        length, bottom = np.asarray(self.length, float), self.vertical_bottom
        h, w = np.asarray(self.horizontal, float), np.asarray(self.weight, float)
        s = np.clip(arc, 0.0, length)
        if not np.all(np.abs(s - arc) <= 1e-12 * length):
            raise ValueError("an arc length must be from 0 to the length of the catenary")
        lifted = np.maximum(s - self.grounded, 0.0)
        x, z = position(lifted, h, bottom, w)
        compliance = 1.0 / np.asarray(self.stiffness, float)
        x = x + (s - lifted) + h * s * compliance
        return x, z + (bottom + 0.5 * w * lifted) * lifted * compliance

    @property
    def end(self) -> tuple[Floats, Floats]:
        """Horizontal distance and height of the upper end, relative to the lower end [m]."""
        return self.position(self.length)


def between(
    x: float,
    z: float,
    length: float,
    weight: float,
    stiffness: float = inf,
    *,
    seabed: bool = False,
) -> Catenary:
    """Find the catenary between two given points.

    The upper end is at (x, z) to about 1e-13 of the length. There is only one such catenary.

    Parameters
    ----------
    x, z : horizontal distance (> 0) and height of the upper end, relative to the lower end [m]
    length, weight, stiffness, seabed : as in `Catenary`; if `seabed` is set, z must be positive

    Raises
    ------
    ValueError
        A value is outside its range, or the line is too short or, with a seabed, too slack.
    """
    if not isfinite(x + z + length + weight):
        raise ValueError("the dimensions of a catenary must be finite")
    given = {"distance": x, "length": length, "weight": weight, "stiffness": stiffness}
    for name, value in given.items():
        if not value > 0.0:
            raise ValueError(f"the {name} of a catenary must be above 0, not {value:g}")
    chord = hypot(x, z)
    if stiffness == inf and chord >= length:
        raise ValueError(f"a line of {length:g} m does not reach a point {chord:g} m away")
    if seabed:
        _refuse_slack(x, z, length, weight, stiffness)
    # scaled by the line's length and weight, so that one tolerance suffices
    h, v = _solve(x / length, z / length, weight * length / stiffness, seabed)
    return Catenary(h * weight * length, v * weight * length, length, weight, stiffness, seabed)


def _refuse_slack(x: float, z: float, length: float, weight: float, stiffness: float) -> None:
    if not z > 0.0:
        raise ValueError(f"the upper end must be above the seabed: its height is {z:g} m")
    # hanging plumb: z = l + w l²/(2 EA), l the unstretched length
    plumb = 2.0 * z / (1.0 + sqrt(1.0 + 2.0 * weight * z / stiffness))
    if plumb < length and length - plumb >= x:
        raise ValueError(
            f"a line of {length:g} m is slack: {plumb:g} m hang vertically, and the rest is at "
            f"least as long as the horizontal distance, {x:g} m"
        )


def _solve(x: float, z: float, compliance: float, seabed: bool) -> tuple[float, float]:
    """Solve for the forces (H, V) at the upper end, relative to the line's weight.

    The line has the length 1 and the compliance w L/EA.
    """
    chord = hypot(x, z)
    if chord < 1.0:
        sag = sqrt(max(3.0 * ((1.0 - z * z) / (x * x) - 1.0), 1e-300))
        h, v = x / (2.0 * sag), 0.5 * (z / tanh(sag) + 1.0)
    else:
        pull = (chord - 1.0) / compliance + 0.5
        h, v = pull * x / chord, pull * z / chord + 0.5
    if seabed:
        v = max(v, z)
    miss_x, miss_z, jacobian = _miss(h, v, x, z, compliance, seabed)
    # the jacobian is positive definite, so that Newton's method with halved steps converges
    for _ in range(200):
        xx, xz, zz = jacobian
        determinant = xx * zz - xz * xz
        step_h = (zz * miss_x - xz * miss_z) / determinant
        step_v = (xx * miss_z - xz * miss_x) / determinant
        size, share = hypot(miss_x, miss_z), 1.0
        while True:
            new_h, new_v = h - share * step_h, v - share * step_v
            if new_h > 0.0 and (new_v > 0.0 or not seabed):
                miss_x, miss_z, jacobian = _miss(new_h, new_v, x, z, compliance, seabed)
                if hypot(miss_x, miss_z) < size:
                    break
            share *= 0.5
            if share < 1e-12:  # the miss is at rounding level
                return h, v
        h, v = new_h, new_v
    raise ValueError("no catenary was found between these points")


def _miss(
    h: float, v: float, x: float, z: float, compliance: float, seabed: bool
) -> tuple[float, float, tuple[float, float, float]]:
    """Return the errors of x and z at the upper end, and the derivatives of x and z.

    The three derivatives are ∂x/∂H, ∂x/∂V and ∂z/∂V; ∂z/∂H equals ∂x/∂V. The length and the weight
    of the line are 1.
    """
    lifted = min(1.0, v) if seabed else 1.0
    bottom = v - lifted
    over, under = hypot(h, v), hypot(h, bottom)
    across, up = (float(value) for value in position(lifted, h, bottom, 1.0))
    miss_x = across + (1.0 - lifted) + h * compliance - x
    miss_z = up + (bottom + 0.5 * lifted) * lifted * compliance - z
    sines, cosines = v / over - bottom / under, h / over - h / under
    jacobian = across / h - sines + compliance, cosines, sines + lifted * compliance
    return miss_x, miss_z, jacobian
