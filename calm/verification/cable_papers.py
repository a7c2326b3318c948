"""Verification against publications on cables by Braconnot, Bourget & Marichal and Villain-Guillot.

Braconnot: a buoy, towed cables and a chart curve. Bourget & Marichal: a towed cable that strums.
Villain-Guillot: the closed form of a cable with linear drag.
"""

from dataclasses import replace
from functools import cache, partial
from math import atan2, cos, degrees, pi, radians, sin

import numpy as np

from calm.analytic.chart import ChartSolution, chart_solve
from calm.analytic.chart_branch import CurvePoints, critical_angle, curve
from calm.analytic.hodograph import Station
from calm.analytic.villain_guillot import linear_cable
from calm.physics.line import Line, Water
from calm.physics.strumming import BourgetMarichal
from calm.solve import Settings, Solution, solve_mooring
from calm.verification.published_case import (
    FINE,
    GRAVITY,
    HALF_DENSITY,
    PRINTED,
    Case,
    CaseColumn,
    Ends,
    Kind,
    LinePiece,
    Source,
    Wake,
    deep_water,
    finely,
    line_of,
    point,
    sphere_drag,
    stream,
    table,
    towed,
)

_K = 2.4
_BUOY_WEIGHT, _TOW_WEIGHT = 5.0, 0.5
_BUOY_ANGLE, _BUOY_TENSION = radians(75.0), 350.0
_BUOYANCY = 1000.0
"""Buoyancy of a buoy that remains at the surface [N]."""

BUOY_LIFT = _BUOY_TENSION * sin(_BUOY_ANGLE)
"""Vertical force of the cable on the buoy [N]."""


@cache
def _only(k: float, weight: float, **given: float) -> ChartSolution:
    """Return the first cable that `chart_solve` finds for three given quantities.

    In the cases here, no part of this cable is below its lower end A.
    """
    answer = chart_solve(k, weight, **given)
    if not answer.solutions:
        raise ArithmeticError(answer.message)
    return answer.solutions[0]


def _buoy(k: float) -> ChartSolution:
    return _only(k, _BUOY_WEIGHT, phi_b=_BUOY_ANGLE, tension_b=_BUOY_TENSION, height=20.0)


def _tow(k: float) -> ChartSolution:
    return _only(k, _TOW_WEIGHT, phi_b=radians(140.0), tension_b=100.0, length=100.0)


_below = partial(_only, _K, _TOW_WEIGHT)


def buoy(buoyancy: float, depth: float) -> tuple[Line, Water]:
    """Return the line and the water for a buoy on a cable with K = 2.4.

    Parameters
    ----------
    buoyancy : buoyancy of the buoy [N]
    depth : water depth [m]
    """
    cable = LinePiece(28.467, True, -_BUOY_WEIGHT, normal_drag=_K * _BUOY_WEIGHT)
    return line_of(point(buoyancy, _BUOY_TENSION * cos(_BUOY_ANGLE)), cable), stream(depth, 1.0)


@cache
def _afloat() -> Solution:
    return solve_mooring(*buoy(_BUOYANCY, 20.0), FINE)


@cache
def _towed() -> Wake:
    pull, angle = 63.401, radians(116.373)  # printed tension T_A and angle φ_A at the body
    body = point(-pull * sin(angle), -pull * cos(angle))
    cable = LinePiece(100.0, True, -_TOW_WEIGHT, normal_drag=_K * _TOW_WEIGHT)
    return towed(line_of(cable, body), deep_water(), 1.0)


def _figures(place: float, angle: float, tension: float) -> dict[str, CaseColumn[ChartSolution]]:
    return {
        "L": CaseColumn("length L", "m", place, lambda cable: cable.length),
        "D": CaseColumn("distance D", "m", place, lambda cable: cable.distance),
        "H": CaseColumn("depth H", "m", place, lambda cable: cable.height),
        "phi_a": CaseColumn("angle φ_A", "°", angle, lambda cable: degrees(cable.phi_a)),
        "phi_b": CaseColumn("angle φ_B", "°", angle, lambda cable: degrees(cable.phi_b)),
        "T_A": CaseColumn("tension T_A", "N", tension, lambda cable: cable.tension_a),
        "T_B": CaseColumn("tension T_B", "N", tension, lambda cable: cable.tension_b),
    }


_FIVE = _figures(5.5e-4, 5.5e-4, 5.5e-3)
_TOWED = _figures(5.5e-4, 5.5e-4, 5.5e-4)
_EIGHT = _figures(5.5e-7, 5.5e-6, 5.5e-7)
_READ = _figures(0.02 * 20.0, 0.5, 0.02 * 250.0)

BRACONNOT = Source(
    "Braconnot's charts",
    """H. Braconnot (EDF) drew charts of cables in a uniform current with normal drag only, for
values of K = ρ Cx D V²/(2w). A is the lower end of the cable and B the upper end; angles are
measured from the current.

His first example is a buoy 20 m above A, with K = 2.4, w = 5 N/m, φ_B = 75° and T_B = 350 N. From
the charts, Braconnot reads a cable length of 28.3 m, a distance D of 18.5 m, an angle φ_A of 22°
and a tension T_A of 250 N. The true K of this buoy is 2.7; with this K, the length is 30.71 m.

His second example is a towed cable with K = 2.4, w = 0.5 N/m, φ_B = 140°, T_B = 100 N and L = 100
m. The paper gives a depth of 69.5 m, because it computes H₀ with 1 + z′ = 2.4. The point is at z′ =
2.27, so the depth is 73.20 m. At his tow speed of one knot, K is 3.176 and the depth 82.87 m.

Two more cases are integrals of T′ = w sin φ, φ′ = (w/T)(cos φ + K |sin φ| sin φ) to nine digits.
One is a cable of the second branch, beyond the critical angle of 144.4°. The other is a cable that
dips below its lower end. All values are compared with `calm.analytic.chart`; the buoy and the tow
are also compared with the march.""",
    (
        *table(
            [_READ[name] for name in ("L", "D", "phi_a", "T_A")],
            [("buoy as read off the charts", partial(_buoy, _K), (28.3, 18.5, 22.0, 250.0))],
            "2 % of the height or the tension and half a degree: the accuracy of reading a chart.",
            Kind.PUBLISHED),
        *table(
            [_FIVE[name] for name in ("L", "D", "phi_a", "T_A")],
            [("buoy", partial(_buoy, _K), (28.467, 18.782, 22.027, 250.00))],
            PRINTED, Kind.INDEPENDENT),
        *table(
            [
                CaseColumn[Ends]("height of the buoy, march", "m", 1e-3, lambda ends: ends.z),
                CaseColumn[Ends]("distance D, march", "m", 1e-3, lambda ends: ends.x),
                CaseColumn[Ends]("tension T_A, march", "N", 5e-3, lambda ends: ends.tension),
                CaseColumn[Ends]("angle φ_A, march", "°", 2e-3, lambda ends: 90.0 - ends.lean),
            ],
            [("buoy", partial(finely, buoy, BUOY_LIFT, 25.0), (20.0, 18.782, 250.00, 22.027))],
            "The length of the cable, 28.467 m, is known to half a millimetre.",
            Kind.INDEPENDENT),
        *table(
            [
                CaseColumn[Solution](
                    "vertical pull, march", "N", 5e-3, lambda s: s.buoyancy_used * _BUOYANCY
                ),
                CaseColumn[Solution]("reserve, march", "N", 5e-3, lambda s: s.reserve),
            ],
            [("buoy of 1000 N, afloat", _afloat, (338.0740, 661.9260))],
            "The length of the cable, 28.467 m, is known to half a millimetre.",
            Kind.INDEPENDENT),
        *table(
            [_figures(5.5e-3, 0.0, 0.0)[name] for name in ("L", "D")],
            [("buoy at its true K, 2.7", partial(_buoy, 2.7), (30.71, 21.50))],
            PRINTED, Kind.INDEPENDENT),
        *table(
            [_TOWED[name] for name in ("H", "D", "phi_a", "T_A")],
            [("tow", partial(_tow, _K), (73.198, -67.215, 116.373, 63.401))],
            PRINTED, Kind.INDEPENDENT),
        *table(
            [
                CaseColumn[Wake]("depth H, march", "m", 1e-3, lambda wake: wake.depth),
                CaseColumn[Wake]("distance D, march", "m", 1e-3, lambda wake: -wake.aft),
                CaseColumn[Wake]("angle φ_B, march", "°", 2e-3, lambda wake: 180.0 - wake.angle),
                CaseColumn[Wake]("tension T_B, march", "N", 2e-3, lambda wake: wake.tension),
            ],
            [("tow", _towed, (73.198, -67.215, 140.0, 100.0))],
            "T_A and φ_A of the body are printed to 5e-4 N and 5e-4°.", Kind.INDEPENDENT),
        Case("tow at 1 knot, K 3.176: depth H", 82.87, "m", 5.5e-3, PRINTED,
             lambda: _tow(3.176).height, Kind.INDEPENDENT),
        *table(
            [_EIGHT[name] for name in ("phi_b", "T_B", "H", "D")],
            [
                ("second branch",
                 partial(_below, phi_a=radians(165.0), tension_a=40.0, length=100.0),
                 (145.83813, 63.9741152, 47.9482305, -87.2866976)),
                ("through the apex",
                 partial(_below, phi_a=radians(-20.0), tension_a=60.0, length=200.0),
                 (107.31124, 105.978848, 91.9576956, 126.772138)),
            ],
            PRINTED, Kind.INDEPENDENT),
        *table(
            [
                CaseColumn[CurvePoints]("s′", "", 5.5e-6, lambda at: float(at.arc)),
                CaseColumn[CurvePoints]("y′", "", 5.5e-6, lambda at: float(at.distance)),
                CaseColumn[CurvePoints]("z′", "", 5.5e-6, lambda at: float(at.height)),
            ],
            [("curve at 75°", partial(curve, _K, radians(75.0)), (0.96945, 0.75437, 0.49348))],
            PRINTED, Kind.INDEPENDENT),
        Case("critical angle, K 2.4", 144.4, "°", 0.055, PRINTED,
             lambda: degrees(float(critical_angle(_K))), Kind.CLOSED_FORM),
    ),
)  # fmt: skip


_DENSITY = 1000.0
_SPEED = 1.30
_DIAMETER, _CABLE_LENGTH = 0.017, 3.845
_WEIGHT = (2383.0 - _DENSITY) * GRAVITY * pi / 4.0 * _DIAMETER**2
_SPHERE_WEIGHT = (1.47 - _DENSITY * pi / 6.0 * 0.1**3) * GRAVITY
_SPHERE_DRAG = sphere_drag(0.1, 0.90)
_LAW = BourgetMarichal()


def _line(length: float, *others: LinePiece, strums: bool = True) -> Line:
    cable = LinePiece(length, True, -_WEIGHT, HALF_DENSITY * _DIAMETER * _LAW.rest)
    diameter = np.array([_DIAMETER] + [0.0] * len(others))
    return replace(
        line_of(cable, *others), diameter=diameter, strumming=_LAW if strums else None
    )  # fmt: skip


@cache
def _example(strums: bool) -> Wake:
    sphere = point(-_SPHERE_WEIGHT, _SPHERE_DRAG)
    return towed(_line(_CABLE_LENGTH, sphere, strums=strums), deep_water(_DENSITY), _SPEED)


@cache
def _bare(speed: float) -> Wake:
    return towed(_line(10.0), deep_water(_DENSITY), speed, Settings())


def _coefficient(angle: float) -> float:
    """Return the drag coefficient C* of the strumming cable of `_example` at an angle [rad]."""
    return _LAW.coefficient(angle, radians(_example(True).angle))


def _at_the_sphere() -> float:
    drag = _SPHERE_DRAG * _DENSITY / (2.0 * HALF_DENSITY) * _SPEED**2
    return _coefficient(atan2(_SPHERE_WEIGHT, drag))


def _amplitude(speed: float) -> float:
    """Return the amplitude ratio a/D of the bare cable at its towing angle."""
    return _LAW.amplitude(radians(_bare(speed).angle))


_FITTED = "One unit of the last digit, because the fitted values A₁, B₁ and C₁ have six digits."

BOURGET_MARICHAL = Source(
    "Bourget & Marichal",
    """Bourget and Marichal towed a sphere of 100 mm and 1.47 kg (Cx 0.90) at 1.30 m/s in fresh
water. The cable has a length of 3.845 m, a diameter of 17 mm and a density of 2383 kg/m³. In their
model, the whole cable strums at one frequency, F = 0.166 V₀ sin φ_n/D, where φ_n is the angle at
the ship. The amplitude is a/D = A₁ + B₁ φ + C₁ φ², and the drag coefficient is C* = C₀ f(λ), at
most 3.0. The paper does not give A₁, B₁ and C₁. CALM's values are fitted to three results of the
paper: a/D = 0.5 at 90°, C* = 1.25 at the sphere, φ_n = 16.28°. These three results therefore agree
by construction. The frequency, the immersion and the maximum C* are not fitted. Neither are the
amplitudes of the bare cable, for which the paper has 0.9 to 1.4 at 0.6 to 2.0 m/s. The paper prints
2/π as the factor of f on [0, π]; the factor must be 1/π, because f(0) = 1.

The paper computes 3.56 Hz and measured 4.07 Hz. CALM's 3.559 Hz agrees with the computed value; the
difference of 13 % is an error of the model. The last case is the same tow with a constant C of 1.2,
computed without CALM.""",
    (
        Case("strumming: angle φ_n at the ship", 16.280, "°", 1e-3, _FITTED,
             lambda: _example(True).angle, Kind.BY_CONSTRUCTION),
        Case("strumming: frequency", 3.559, "Hz", 5.5e-4, _FITTED,
             lambda: _example(True).frequency, Kind.CLOSED_FORM),
        Case("strumming: immersion of the sphere", 1.6529, "m", 5.5e-5, _FITTED,
             lambda: _example(True).depth, Kind.INDEPENDENT),
        Case("strumming: frequency, as printed", 3.56, "Hz", 5.5e-3, PRINTED,
             lambda: _example(True).frequency, Kind.PUBLISHED),
        Case("strumming: C* at the sphere", 1.250, "", 1e-3, _FITTED, _at_the_sphere,
             Kind.BY_CONSTRUCTION),
        Case("strumming: C* at the ship", 3.0, "", 1e-9, "The upper limit of the model.",
             lambda: _coefficient(radians(_example(True).angle)),
             Kind.PUBLISHED),
        Case("strumming: amplitude a/D at 90°", 0.5, "", 1e-4, _FITTED,
             lambda: _LAW.amplitude(pi / 2.0), Kind.BY_CONSTRUCTION),
        *(
            Case(f"bare cable, {speed} m/s: amplitude a/D", expected, "", 0.05,
                 "Half a unit of the last printed digit.",
                 partial(_amplitude, speed), Kind.PUBLISHED)
            for speed, expected in ((0.6, 0.9), (2.0, 1.4))
        ),
        *table(
            [
                CaseColumn[Wake]("angle at the ship", "°", 5.5e-4, lambda wake: wake.angle),
                CaseColumn[Wake]("immersion of the sphere", "m", 5.5e-5, lambda wake: wake.depth),
                CaseColumn[Wake]("tension at the ship", "N", 5.5e-5, lambda wake: wake.tension),
            ],
            [("constant C = 1.2", lambda: _example(False), (24.362, 1.9191, 16.9495))],
            PRINTED, Kind.INDEPENDENT),
    ),
)  # fmt: skip


_LENGTH, _UNIT = 1.25, 0.5
"""Length L and ℓ = T₀/√((μg)² + (kV)²) of the cable in the figure."""


@cache
def _cable(start: float, mean: float) -> Station:
    """Return the upper end of the cable in the figure, for √((μg)² + (kV)²) = 1.

    `start` and `mean` are the angles α₀ and α_d [degrees].
    """
    angle = radians(mean)
    return linear_cable(_LENGTH, _UNIT, radians(start), sin(angle), cos(angle))


VILLAIN_GUILLOT = Source(
    "Villain-Guillot, figure 1",
    """In S. Villain-Guillot's model of a towed cable, the drag is proportional to the velocity (D =
1), with the same factor along and across the cable (k_t = k_n). With tan α_d = μg/(kV) and ℓ =
T₀/√((μg)² + (kV)²), the cases have L = 1.25 and ℓ = 0.5, as in his figure 1. The expected values
come from the closed form in the paper, and are compared with `calm.analytic.villain_guillot`. His
formula for ρ(α) at D = 1 is printed upside down; s, T and the shape are right.""",
    table(
        [
            CaseColumn("x", "", 5.5e-7, lambda cable: float(cable.x)),
            CaseColumn("y", "", 5.5e-7, lambda cable: float(cable.z)),
            CaseColumn("T/T₀", "", 5.5e-7, lambda cable: float(cable.tension) / _UNIT),
        ],
        [
            (f"α₀ {start}°, α_d {mean}°", partial(_cable, start, mean), (x, y, 3.402959))
            for start, mean, x, y in (
                (0, 30, 1.201579, 0.321762),
                (60, 30, 0.879444, 0.879717),
                (30, 60, 0.879717, 0.879444),
            )
        ],
        PRINTED,
        Kind.CLOSED_FORM,
    ),
)
