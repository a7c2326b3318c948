"""Braconnot's charts of EDF: a buoy, towed cables, and a point of the curve."""

from __future__ import annotations

from functools import cache, partial
from math import cos, degrees, radians, sin

from calm.analytic.chart import ChartSolution, chart_solve
from calm.analytic.chart_branch import CurvePoints, critical_angle, curve
from calm.physics.line import Line, Water
from calm.solve import Solution, solve_mooring
from calm.verification.case import PRINTED, Case, CaseColumn, Kind, Source, table
from calm.verification.ends import FINE, Ends, Wake, finely, towed
from calm.verification.pieces import LinePiece, deep_water, line_of, point, stream

_K = 2.4
_BUOY_WEIGHT, _TOW_WEIGHT = 5.0, 0.5
_BUOY_ANGLE, _BUOY_TENSION = radians(75.0), 350.0
_BUOYANCY = 1000.0
"""More than the buoy needs, so that it lies at the surface [N]."""

BUOY_LIFT = _BUOY_TENSION * sin(_BUOY_ANGLE)
"""What the buoy's cable takes of its buoyancy [N]."""


def _only(k: float, weight: float, **given: float) -> ChartSolution:
    """The cable that three givens fix; the first where several fit (it does not dip below A)."""
    answer = chart_solve(k, weight, **given)
    if not answer.solutions:
        raise ArithmeticError(answer.message)
    return answer.solutions[0]


@cache
def _buoy(k: float) -> ChartSolution:
    return _only(k, _BUOY_WEIGHT, phi_b=_BUOY_ANGLE, tension_b=_BUOY_TENSION, height=20.0)


@cache
def _tow(k: float) -> ChartSolution:
    return _only(k, _TOW_WEIGHT, phi_b=radians(140.0), tension_b=100.0, length=100.0)


@cache
def _second_branch() -> ChartSolution:
    return _only(_K, _TOW_WEIGHT, phi_a=radians(165.0), tension_a=40.0, length=100.0)


@cache
def _through_the_apex() -> ChartSolution:
    return _only(_K, _TOW_WEIGHT, phi_a=radians(-20.0), tension_a=60.0, length=200.0)


@cache
def _point() -> CurvePoints:
    return curve(_K, radians(75.0))


def buoy(buoyancy: float, depth: float) -> tuple[Line, Water]:
    """The buoy with a buoyancy [N] in water of a depth [m]: K w = 12 N/m of drag at 1 m/s."""
    cable = LinePiece(28.467, True, -_BUOY_WEIGHT, normal_drag=_K * _BUOY_WEIGHT)
    return line_of(point(buoyancy, _BUOY_TENSION * cos(_BUOY_ANGLE)), cable), stream(depth, 1.0)


@cache
def _below_the_surface() -> Ends:
    return finely(*buoy(BUOY_LIFT, 25.0))


@cache
def _afloat() -> Solution:
    return solve_mooring(*buoy(_BUOYANCY, 20.0), FINE)


@cache
def _towed() -> Wake:
    """The tow by the march: a body that pulls its cable as the printed T_A at φ_A does."""
    pull, angle = 63.401, radians(116.373)
    body = point(-pull * sin(angle), -pull * cos(angle))
    cable = LinePiece(100.0, True, -_TOW_WEIGHT, normal_drag=_K * _TOW_WEIGHT)
    return towed(line_of(cable, body), deep_water(), 1.0)


def _figures(
    place: float, angle: float, tension: float, length: float | None = None
) -> dict[str, CaseColumn[ChartSolution]]:
    return {
        "L": CaseColumn("length L", "m", length or place, lambda cable: cable.length),
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
    """H. Braconnot's charts of cables in a uniform current with normal drag only (EDF),
K = ρ Cx D V²/(2w); A is the lower end of the cable, B the upper, angles are to the current.

His buoy, K = 2.4, w = 5 N/m, φ_B = 75°, T_B = 350 N, 20 m above A, he reads off the charts: 28.3 m
of cable, 18.5 m, 22°, 250 N. The true K of that buoy is 2.7, and a chart of a nearby K is not
harmless: L then is 30.71 m. His towed cable, K = 2.4, w = 0.5 N/m, φ_B = 140°, T_B = 100 N,
L = 100 m, comes to a depth of 69.5 m in the paper, which takes H₀ from 1 + z′ = 2.4; the point lies
at z′ = 2.27, and the depth is 73.20 m, 82.87 m at the K = 3.176 of its own knot. The other figures
are integrals of T′ = w sin φ, φ′ = (w/T)(cos φ + K |sin φ| sin φ) to nine digits: a cable of the
second branch, beyond the critical angle of 144.4°, and one that dips below its lower end through
the apex. All are held against `calm.analytic.chart`, the buoy and the tow
against the march as well.""",
    (
        *table(
            [_READ[name] for name in ("L", "D", "phi_a", "T_A")],
            [("buoy as read off the charts", partial(_buoy, _K), (28.3, 18.5, 22.0, 250.0))],
            "2 % of the height or the tension and half a degree: how well a chart is read.",
            Kind.PUBLISHED,
        ),
        *table(
            [_FIVE[name] for name in ("L", "D", "phi_a", "T_A")],
            [("buoy", partial(_buoy, _K), (28.467, 18.782, 22.027, 250.00))],
            PRINTED,
            Kind.INDEPENDENT,
        ),
        *table(
            [
                CaseColumn[Ends]("height of the buoy, march", "m", 1e-3, lambda ends: ends.z),
                CaseColumn[Ends]("distance D, march", "m", 1e-3, lambda ends: ends.x),
                CaseColumn[Ends]("tension T_A, march", "N", 5e-3, lambda ends: ends.tension),
                CaseColumn[Ends]("angle φ_A, march", "°", 2e-3, lambda ends: 90.0 - ends.lean),
            ],
            [("buoy", _below_the_surface, (20.0, 18.782, 250.00, 22.027))],
            "The cable is cut to 28.467 m, half a millimetre being the last digit of its length.",
            Kind.INDEPENDENT,
        ),
        *table(
            [
                CaseColumn[Solution](
                    "vertical pull, march", "N", 5e-3, lambda s: s.buoyancy_used * _BUOYANCY
                ),
                CaseColumn[Solution]("reserve, march", "N", 5e-3, lambda s: s.reserve),
            ],
            [("buoy of 1000 N, afloat", _afloat, (338.0740, 661.9260))],
            "The cable is cut to 28.467 m, half a millimetre being the last digit of its length.",
            Kind.INDEPENDENT,
        ),
        *table(
            [
                CaseColumn[ChartSolution]("length L", "m", 5.5e-3, lambda cable: cable.length),
                CaseColumn[ChartSolution]("distance D", "m", 5.5e-3, lambda cable: cable.distance),
            ],
            [("buoy at its true K, 2.7", partial(_buoy, 2.7), (30.71, 21.50))],
            PRINTED,
            Kind.INDEPENDENT,
        ),
        *table(
            [_TOWED[name] for name in ("H", "D", "phi_a", "T_A")],
            [("tow", partial(_tow, _K), (73.198, -67.215, 116.373, 63.401))],
            PRINTED,
            Kind.INDEPENDENT,
        ),
        *table(
            [
                CaseColumn[Wake]("depth H, march", "m", 1e-3, lambda wake: wake.depth),
                CaseColumn[Wake]("distance D, march", "m", 1e-3, lambda wake: -wake.aft),
                CaseColumn[Wake]("angle φ_B, march", "°", 2e-3, lambda wake: 180.0 - wake.angle),
                CaseColumn[Wake]("tension T_B, march", "N", 2e-3, lambda wake: wake.tension),
            ],
            [("tow", _towed, (73.198, -67.215, 140.0, 100.0))],
            "T_A and φ_A of the body are printed to 5e-4 N and 5e-4°.",
            Kind.INDEPENDENT,
        ),
        Case("tow at 1 knot, K 3.176: depth H", 82.87, "m", 5.5e-3, PRINTED,
             lambda: _tow(3.176).height, Kind.INDEPENDENT),
        *table(
            [_EIGHT[name] for name in ("phi_b", "T_B", "H", "D")],
            [
                ("second branch", _second_branch, (145.83813, 63.9741152, 47.9482305, -87.2866976)),
                ("through the apex", _through_the_apex,
                 (107.31124, 105.978848, 91.9576956, 126.772138)),
            ],
            PRINTED,
            Kind.INDEPENDENT,
        ),
        *table(
            [
                CaseColumn[CurvePoints]("s′", "", 5.5e-6, lambda point: float(point.arc)),
                CaseColumn[CurvePoints]("y′", "", 5.5e-6, lambda point: float(point.distance)),
                CaseColumn[CurvePoints]("z′", "", 5.5e-6, lambda point: float(point.height)),
            ],
            [("curve at 75°", _point, (0.96945, 0.75437, 0.49348))],
            PRINTED,
            Kind.INDEPENDENT,
        ),
        Case("critical angle, K 2.4", 144.4, "°", 0.055, PRINTED,
             lambda: degrees(float(critical_angle(_K))), Kind.CLOSED_FORM),
    ),
)  # fmt: skip
