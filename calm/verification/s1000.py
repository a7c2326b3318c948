"""S1000: 1000 m of stretchy cable in a sheared current."""

from __future__ import annotations

from functools import cache
from math import log2, radians

from calm.physics.line import Line
from calm.solve import Settings, Solution, solve_mooring
from calm.verification.case import Case, CaseColumn, Kind, Source, table
from calm.verification.pieces import HALF_DENSITY, cable, line_of, point, profile

S1000_SEA = profile(1100.0, [(0.0, 1.0), (200.0, 0.6), (500.0, 0.2), (1100.0, 0.05)])

DEPTH, OFFSET, TENSION, KNOCKDOWN = 131.4256, 237.3218, 2068.154, 32.1756
"""Of the float [m], of the float [m], at the anchor [N], of the float [m]."""

_FINEST = 0.02


def s1000_mooring(parts: int = 1) -> Line:
    """The line, its cable in equal parts."""
    part = cable(1000.0 / parts, 0.01, 2.0, 1.3, 0.01, 1.0 / 4e6)
    return line_of(point(4000.0, HALF_DENSITY * 0.6), *[part] * parts)


@cache
def solved_s1000(degrees: float) -> Solution:
    """The mooring at an angle step [degrees]."""
    return solve_mooring(s1000_mooring(), S1000_SEA, Settings(radians(degrees), tolerance=1e-9))


@cache
def _still() -> Solution:
    return solve_mooring(s1000_mooring(), S1000_SEA.still(), Settings(tolerance=1e-9))


def float_depth(solution: Solution) -> float:
    """Of the float [m]."""
    return -float(solution.position[0, 2])


def _figures(place: float, tension: float) -> tuple[CaseColumn[Solution], ...]:
    return (
        CaseColumn("depth of the float", "m", place, float_depth),
        CaseColumn("offset of the float", "m", place, lambda s: float(s.position[0, 0])),
        CaseColumn("tension at the anchor", "N", tension, lambda s: float(s.tension[-1])),
        CaseColumn("knockdown", "m", place, lambda s: float_depth(s) - float_depth(_still())),
    )


def _order(coarse: float, fine: float) -> float:
    """Order at which the depth of the float comes to the known one."""
    errors = [abs(float_depth(solved_s1000(degrees)) - DEPTH) for degrees in (coarse, fine)]
    return log2(errors[0] / errors[1]) / log2(coarse / fine)


_EXPECTED = DEPTH, OFFSET, TENSION, KNOCKDOWN

S1000 = Source(
    "S1000",
    """The reference case of accuracy and speed, `lines/s1000.yaml`: a float of 4000 N and 0.6 m² of
drag area on 1000 m of cable, 10 mm, 2 N/m, Cn 1.3, Ct 0.01, EA 4 MN, in 1100 m of water that flows
at 1.0, 0.6, 0.2 and 0.05 m/s at 0, 200, 500 and 1100 m. Its figures come from an initial-value
integration of the differential equations with bracketing; the tests hold a second independent
integration against them.""",
    (
        *table(
            _figures(5e-5 * 1100.0, 2e-4 * TENSION),
            [("S1000 at 1°", lambda: solved_s1000(1.0), _EXPECTED)],
            "What CALM promises at its default angle step: 5e-5 of the water depth, 2e-4 of the "
            "tension.",
            Kind.INDEPENDENT,
        ),
        *table(
            _figures(1e-4, 1e-3),
            [("S1000 at 0.02°", lambda: solved_s1000(_FINEST), _EXPECTED)],
            "One unit of the last digit printed: half for its rounding, half for the march.",
            Kind.INDEPENDENT,
        ),
        Case("S1000 order of convergence, 2° to 0.5°", 2.0, "", 0.25,
             "Second order, stirred by cuts at the levels of the profile, which shift the "
             "segments.",
             lambda: _order(2.0, 0.5), Kind.PROPERTY),
    ),
    picture="verification-s1000",
)  # fmt: skip
