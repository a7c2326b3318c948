"""Verification against two moorings solved by others: S1000, and CDMS-1 of Berteaux's manual (C16).

S1000 is a float on 1000 m of elastic cable in a sheared current. Two other programs have solved
CDMS-1.
"""

from dataclasses import replace
from functools import cache, partial
from math import log2, pi, radians

import numpy as np

from calm.physics.line import Line, Water
from calm.solve import Settings, Solution, solve_mooring
from calm.verification import published_case
from calm.verification.published_case import GRAVITY, Case, CaseColumn, Ends, Kind, LinePiece, table

S1000_SEA = published_case.profile(1100.0, [(0.0, 1.0), (200.0, 0.6), (500.0, 0.2), (1100.0, 0.05)])

DEPTH, OFFSET, TENSION, KNOCKDOWN = 131.4256, 237.3218, 2068.154, 32.1756
"""Expected depth and offset of the float [m], tension at the anchor [N], and knockdown of the float
[m].
"""

_FINEST = 0.02


def s1000_mooring(parts: int = 1) -> Line:
    """Return the line of the mooring S1000, with its cable divided into `parts` equal parts."""
    part = published_case.cable(1000.0 / parts, 0.01, 2.0, 1.3, 0.01, 1.0 / 4e6)
    return published_case.line_of(
        published_case.point(4000.0, published_case.HALF_DENSITY * 0.6), *[part] * parts
    )


@cache
def solved_s1000(degrees: float) -> Solution:
    """Solve the mooring S1000 with a given angle step [degrees]."""
    return solve_mooring(s1000_mooring(), S1000_SEA, Settings(radians(degrees), tolerance=1e-9))


@cache
def _still() -> Solution:
    return solve_mooring(s1000_mooring(), S1000_SEA.still(), Settings(tolerance=1e-9))


def float_depth(solution: Solution) -> float:
    """Return the depth of the float [m]."""
    return -float(solution.position[0, 2])


def _figures(place: float, tension: float) -> tuple[CaseColumn[Solution], ...]:
    return (
        CaseColumn("depth of the float", "m", place, float_depth),
        CaseColumn("offset of the float", "m", place, lambda s: float(s.position[0, 0])),
        CaseColumn("tension at the anchor", "N", tension, lambda s: float(s.tension[-1])),
        CaseColumn("knockdown", "m", place, lambda s: float_depth(s) - float_depth(_still())),
    )


def _order(coarse: float, fine: float) -> float:
    """Return the order of convergence of the float's depth, from two angle steps [degrees].

    The extrapolation of the solver is not applied to these depths.
    """
    errors = [
        abs(float_depth(solved_s1000(degrees).as_marched) - DEPTH) for degrees in (coarse, fine)
    ]
    return log2(errors[0] / errors[1]) / log2(coarse / fine)


_EXPECTED = DEPTH, OFFSET, TENSION, KNOCKDOWN

S1000 = published_case.Source(
    "S1000",
    """`lines/s1000.yaml` is the reference case for accuracy and speed: a float of 4000 N with 0.6
m² of drag area, on 1000 m of cable (10 mm, 2 N/m, Cn 1.3, Ct 0.01, EA 4 MN) in 1100 m of water. The
current is 1.0, 0.6, 0.2 and 0.05 m/s at 0, 200, 500 and 1100 m. The expected values come from an
initial-value integration of the differential equations with bracketing; the tests compare them with
a second independent integration.""",
    (
        *table(
            _figures(5e-5 * 1100.0, 2e-4 * TENSION),
            [("S1000 at 1°", lambda: solved_s1000(1.0), _EXPECTED)],
            "CALM's stated accuracy at its default angle step: 5e-5 of the depth, 2e-4 of the "
            "tension.", Kind.INDEPENDENT),
        *table(
            _figures(1e-4, 1e-3),
            [("S1000 at 0.02°", lambda: solved_s1000(_FINEST), _EXPECTED)],
            "One unit of the last printed digit: half a unit for rounding, half for the march.",
            Kind.INDEPENDENT),
        Case("S1000 order of convergence of the march, 2° to 0.5°", 2.0, "", 0.25,
             "The march is of second order; segments are also cut at the levels of the profile, "
             "which disturbs the order.",
             lambda: _order(2.0, 0.5), Kind.PROPERTY),
    ),
    picture="verification-s1000",
)  # fmt: skip


_SEABED = 525.0
_STILL = np.zeros(3)
CDMS_1_SEA = Water(
    depth=_SEABED, level=np.array([0.0, 200.0, _SEABED]), u=np.array([1.5, 0.6, 0.1]), v=_STILL,
    w=_STILL, density=np.array([1024.0, 1025.0, 1026.0]), gravity=GRAVITY,
)  # fmt: skip
_FIRST_KEVLAR, _THIRD_METER, _FIRST_GLASS = 3, 6, 8


def _sphere(diameter: float, lift: float, cx: float) -> LinePiece:
    drag = published_case.sphere_drag(diameter, cx)
    return LinePiece(diameter, False, lift * GRAVITY, drag, directional=False)


def _rope(length: float, diameter: float, weight: float, modulus: float, ct: float) -> LinePiece:
    compliance = 1.0 / (modulus * pi / 4.0 * diameter**2) if modulus else 0.0
    return published_case.cable(length, diameter, weight * GRAVITY, 1.3, ct, compliance)


def cdms_1_mooring(ct: float = 0.0) -> Line:
    """Return the line of the mooring CDMS-1 for a given tangential drag coefficient."""
    meter = LinePiece(2.0, False, -20.0 * GRAVITY, published_case.HALF_DENSITY * 1.2 * 0.2 * 2.0)
    kevlar = [_rope(length, 0.007, 0.009, 6.9e10, ct) for length in (98.0, 98.0, 212.9)]
    return published_case.line_of(
        _sphere(1.2, 682.0, 0.5),
        _rope(10.0, 0.007, 0.12, 1.38e11, ct),
        meter, kevlar[0], meter, kevlar[1], meter, kevlar[2],
        *[_sphere(0.51, 23.0, 0.95)] * 10,
        meter,  # the release has the same values as a meter
        _rope(4.8, 0.022, 2.33, 0.0, ct),
        anchor_height=0.55,
    )  # fmt: skip


@cache
def solved_cdms_1() -> Solution:
    """Solve the mooring CDMS-1 with default settings and with the anchor at the origin."""
    return solve_mooring(cdms_1_mooring(), CDMS_1_SEA)


def _ends() -> Ends:
    return published_case.ends_of(solved_cdms_1())


def height_at(solution: Solution, node: int) -> float:
    """Return the height of a node above the seabed [m]."""
    return _SEABED + float(solution.position[node, 2])


def nodes_of_tensions(solution: Solution) -> list[int]:
    """Return the nodes for which a tension is published.

    These nodes are below the sphere, below the third current meter, and at the anchor.
    """
    last: list[int] = solution.piece_nodes[[0, _THIRD_METER, -1], 1].tolist()
    return last


def tension_at(solution: Solution, node: int) -> float:
    """Return the tension at a node [kgf]."""
    return float(solution.tension[node]) / GRAVITY


def _centre(piece: int, solution: Solution) -> tuple[float, float]:
    """Return offset from the anchor and height above the seabed of a piece's midpoint [m]."""
    first, last = solution.piece_nodes[piece].tolist()
    offset = 0.5 * float(solution.position[first, 0] + solution.position[last, 0])
    return offset, 0.5 * (height_at(solution, first) + height_at(solution, last))


def _stretched_length(piece: int, solution: Solution) -> float:
    first, last = solution.piece_nodes[piece].tolist()
    place = solution.position[first : last + 1]
    return float(np.linalg.norm(np.diff(place, axis=0), axis=1).sum())


_HEIGHT = CaseColumn[Solution]("height of the sphere", "m", 1.0, lambda line: _centre(0, line)[1])
_OFFSET = CaseColumn[Solution]("offset of the sphere", "m", 0.2, lambda line: _centre(0, line)[0])
_PLACES = ("below the sphere", "below the third meter", "at the anchor")


def _tension(number: int, solution: Solution) -> float:
    return tension_at(solution, nodes_of_tensions(solution)[number])


def _tensions(share: float) -> list[CaseColumn[Solution]]:
    return [
        CaseColumn(f"tension {place}", "kgf", share, partial(_tension, number), True)
        for number, place in enumerate(_PLACES)
    ]


PROGRAMS = {
    "SSMOOR": (432.4, 71.0, 682.9, 620.4, 812.8),
    "MD&D": (432.07, 75.5, 682.9, 631.7, 827.2),
    "independent": (431.82, 76.81, 682.9, 621.3, 815.06),
}
"""Printed results of other programs: height and offset of the sphere [m]; tensions below the
sphere, below the third meter and at the anchor [kgf].
"""

_PROGRAM = (
    "1 m for heights and 2 % for tensions: each of the two programs has errors of 1 to 4 %, and "
    "their results differ by as much."
)
_RANGE = "The range of the results of the programs, plus half a unit of the last digit."

CDMS_1 = published_case.Source(
    "CDMS-1",
    """CDMS-1 is an intermediate mooring in the user manual of Berteaux's CDMS package (C16). Two
programs have solved this mooring: Berteaux's SSMOOR, and R. Dewey's *Mooring Design & Dynamics*
(MD&D). The users guide of MD&D prints the results of both. From the top, the mooring has a sphere
of 1.2 m, 10 m of wire, three current meters, ten glass balls, a release, 4.8 m of chain and the
anchor. Below each of the first two meters are 98 m of Kevlar, and below the third meter 212.9 m.
The water is 525 m deep. The current is 1.5, 0.6 and 0.1 m/s at heights of 525, 325 and 0 m.

**Why the programs differ.** From the third meter down, MD&D's tensions are 2 % above SSMOOR's. On
an inclined line, the normal drag has a downward component, which reduces the tension in the lower
part of the line. SSMOOR and CALM include this component. MD&D does not: the version that solved the
case has a drag of Cd cos³ θ and 0.01 π θ/90°, both along the current. The users guide attributes
the difference to |U|Uᵢ instead of Uᵢ², but both are equal in a current of one direction. An
independent solution has rigid links and segments of 0.25 to 1 m. Its tension at the anchor is 815.1
kgf with normal drag, and 826.6 kgf with MD&D's law. Each of these values is within 0.3 % of the
program with the same law. SSMOOR's offset is 4 to 6 m shorter than all other offsets. CALM, here
with normal drag and no tangential drag, agrees with the independent solution to 0.1 m in height and
0.2 % in tension.""",
    (
        *(
            case
            for name in ("SSMOOR", "MD&D")
            for case in table(
                [_HEIGHT, *_tensions(0.02)],
                [(f"C16 {name}", solved_cdms_1, (PROGRAMS[name][0], *PROGRAMS[name][2:]))],
                _PROGRAM,
                Kind.PUBLISHED,
            )
        ),
        Case("C16 both programs: offset of the sphere", 74.0, "m", 3.0,
             "71 to 77 m: SSMOOR has 71.0, MD&D 75.5, the independent solution 76.8 m.",
             lambda: _OFFSET.of(solved_cdms_1()), Kind.PUBLISHED),
        Case("C16 both programs: angle at the anchor", 9.3, "°", 0.25, f"9.1° to 9.5°. {_RANGE}",
             lambda: _ends().lean, Kind.PUBLISHED),
        *table(
            [replace(_HEIGHT, tolerance=0.1), _OFFSET, *_tensions(0.002)],
            [("C16 independent solution", solved_cdms_1, PROGRAMS["independent"])],
            "Heights 0.1 m, offset 0.2 m, tensions 0.2 %: the accuracy of the printed data of the "
            "mooring.", Kind.INDEPENDENT),
        *(
            Case(f"C16 independent solution: {name}", kgf, "kgf", 0.002 * kgf,
                 "0.2 %, the accuracy of the printed data of the mooring.", got,
                 Kind.INDEPENDENT)
            for name, kgf, got in (
                ("anchor, horizontal", 131.6, lambda: _ends().horizontal / GRAVITY),
                ("anchor, vertical", 804.4, lambda: _ends().vertical / GRAVITY),
            )
        ),
        Case("C16 printed: height of the first glass ball", 12.03, "m", 0.01,
             "Printed to the centimetre; the line below the ball is almost vertical.",
             lambda: _centre(_FIRST_GLASS, solved_cdms_1())[1], Kind.PUBLISHED),
        Case("C16 printed: 98 m of Kevlar under load", 98.24, "m", 0.011,
             "Printed to the centimetre; 2 % of the stretch is added for the error of the tension.",
             lambda: _stretched_length(_FIRST_KEVLAR, solved_cdms_1()), Kind.PUBLISHED),
    ),
    picture="verification-cdms-1",
)  # fmt: skip
