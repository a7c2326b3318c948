"""Verification of lines in a uniform current, against closed forms and quadratures.

- C1 to C5: a float or a ball on a thread, and a float on a rope
- C6: Pode's cable functions and their identities
- C7 and C8: a bare cable towed at its critical angle, and a cable that tows a body
"""

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache, partial
from math import degrees, hypot, radians

from calm.analytic import uniform
from calm.physics.drag import Friction
from calm.physics.line import Line, Water
from calm.solve import Settings
from calm.verification.published_case import (
    HALF_DENSITY,
    PRINTED,
    Case,
    CaseColumn,
    Ends,
    Kind,
    LinePiece,
    Solved,
    Source,
    Wake,
    cable,
    deep_water,
    finely,
    line_of,
    point,
    sphere_drag,
    stream,
    table,
    towed,
)

_FLOAT = point(4905.0, sphere_drag(1.0, 0.65))
_LENGTH = 1000.0
_HEAVY = 2.0

_PRINTED = f"{PRINTED} The line is straight, so one segment is exact."
_SEVEN_DIGITS = (
    "1e-6 of the line's length or of the tension, 6e-5° for an angle. The expected values have "
    "seven digits; the error of the march is 4e-8 at an angle step of 0.1°."
)


def float_on_a_thread(speed: float) -> tuple[Line, Water]:
    """Return the line and the water of case C1, a float on a thread.

    Parameters
    ----------
    speed : speed of the current [m/s]
    """
    return line_of(_FLOAT, LinePiece(100.0, True, 0.0)), stream(110.0, speed)


def ball_on_a_thread() -> tuple[Line, Water]:
    """Return the line and the water of case C2, a ball on a thread."""
    ball = point(0.337612, sphere_drag(0.04, 1.0))
    return line_of(ball, LinePiece(0.5, True, 0.0)), stream(1.0, 0.5, density=1027.0)


def float_on_a_rope(weight: float, ct: float, speed: float) -> tuple[Line, Water]:
    """Return the line and the water of case C3, C4 or C5, a float on a rope.

    Parameters
    ----------
    weight : weight of the rope in water [N/m]
    ct : tangential drag coefficient
    speed : speed of the current [m/s]
    """
    return line_of(_FLOAT, cable(_LENGTH, 0.0127, weight, 1.3, ct)), stream(1010.0, speed)


_thread_ends, _rope_ends = partial(finely, float_on_a_thread), partial(finely, float_on_a_rope)


def _drop(length: float, ends: Ends) -> float:
    return length - ends.z


def _fall(speed: float) -> float:
    """Return T_top − T_bottom of the heavy rope of case C4 [N].

    T_top is the exact tension below the float, and T_bottom the tension that CALM computes.
    """
    at_the_float = hypot(_FLOAT.buoyancy, _FLOAT.normal_drag * speed**2)
    return at_the_float - _rope_ends(_HEAVY, 0.0, speed).tension


def _identity(speed: float) -> Case:
    return Case(
        f"C4 heavy line, {speed} m/s: (T_top − T_bottom) / (w z_top)", 1.0, "", 1e-6,
        "Exact; the error of straight segments is 1 − cos(half an angle step), 4e-7 at 0.1°.",
        lambda: _fall(speed) / (_HEAVY * _rope_ends(_HEAVY, 0.0, speed).z), Kind.PROPERTY,
    )  # fmt: skip


def _thread(length: float, force: float, place: float, angle: float) -> list[CaseColumn[Ends]]:
    """Return the columns of the table of results for a float or ball on a thread.

    `length` is the length of the thread [m]. `force`, `place` and `angle` are the tolerances of
    forces [N], positions [m] and angles [degrees].
    """
    return [
        CaseColumn("drag", "N", force, lambda ends: ends.horizontal),
        CaseColumn("tension", "N", force, lambda ends: ends.tension),
        CaseColumn("angle from the vertical", "°", angle, lambda ends: ends.lean),
        CaseColumn("offset", "m", place, lambda ends: ends.x),
        CaseColumn("drop", "m", place, partial(_drop, length)),
    ]


def _by_speed(
    name: str, solve: Callable[[float], Solved], rows: Iterable[tuple[float, ...]]
) -> list[tuple[str, Callable[[], Solved], list[float]]]:
    return [(f"{name}, {v} m/s", partial(solve, v), figures) for v, *figures in rows]


_TENSION = CaseColumn[Ends]("tension at the anchor", "N", 1e-6, lambda ends: ends.tension, True)
_ANGLE = CaseColumn[Ends]("angle at the anchor", "°", 6e-5, lambda ends: ends.lean)
_OFFSET = CaseColumn[Ends]("offset of the float", "m", 1e-6 * _LENGTH, lambda ends: ends.x)
_KNOCKDOWN = CaseColumn[Ends]("knockdown", "m", 1e-6 * _LENGTH, partial(_drop, _LENGTH))
_HEIGHT = CaseColumn[Ends]("height of the float", "m", 1e-6 * _LENGTH, lambda ends: ends.z)
_HORIZONTAL = CaseColumn[Ends]("anchor, horizontal", "N", 5e-3, lambda ends: ends.horizontal)
_VERTICAL = CaseColumn[Ends]("anchor, vertical", "N", 5e-3, lambda ends: ends.vertical)

UNIFORM_CURRENT = Source(
    "Floats and lines in a uniform current",
    """C1 is a float of 500 kgf and 1 m (Cx 0.65) on 100 m of line without weight or drag. C2 is a
ball on a thread, from the R package *mooring* by D. Kelley, in water of 1027 kg/m³. In C3, C4 and
C5, the float of C1 is on 1000 m of 12.7 mm line with Cn 1.3. The line is neutral in C3 and weighs 2
N/m in C4 and C5; in C5 it also has a Ct of 0.01.

C1 and C2 have elementary solutions: tan θ = D/B, T² = B² + D². C3 is a catenary on its side, cot φ
= cot φ₀ + R s/T at constant T. The values of C4 and C5 are quadratures of T′ = w sin φ + F, T φ′ =
w cos φ − R sin² φ, with a relative error of 1e-10, evaluated without CALM. In C4 the tension
differs between two points by w times their difference in height. C5 tests the sign of the
tangential drag. All cases use g = 9.81 m/s² and, except C2, ρ = 1025 kg/m³. The march has an angle
step of 0.1°.""",
    (
        *table(
            _thread(100.0, 5.5e-5, 5.5e-6, 5.5e-6),
            _by_speed("C1 float on a thread", _thread_ends, (
                (0.5, 65.4089, 4905.4361, 0.76400, 1.33340, 0.00889),
                (1.0, 261.6358, 4911.9730, 3.05330, 5.32649, 0.14196),
                (1.5, 588.6805, 4940.1994, 6.84370, 11.91613, 0.71251),
            )),
            _PRINTED, Kind.CLOSED_FORM),
        *table(
            _thread(0.5, 5.5e-7, 5.5e-7, 5.5e-5),
            [
                ("C2 ball on a thread", partial(finely, ball_on_a_thread),
                 (0.161321, 0.374174, 25.5398, 0.215569, 0.048857)),
            ],
            _PRINTED, Kind.CLOSED_FORM),
        *table(
            [_TENSION, _ANGLE, _OFFSET, _KNOCKDOWN, _HORIZONTAL, _VERTICAL],
            _by_speed("C3 neutral line", partial(_rope_ends, 0.0, 0.0), (
                (0.3, 4905.05652, 9.09326, 81.90536, 4.35144, 775.2048, 4843.4117),
                (0.5, 4905.43610, 23.96800, 218.62256, 31.25006, 1992.7172, 4482.4526),
                (1.0, 4911.97295, 60.61696, 601.82678, 253.81368, 4280.0921, 2410.0395),
            )),
            _SEVEN_DIGITS, Kind.CLOSED_FORM),
        *table(
            [_TENSION, _ANGLE, _OFFSET, _KNOCKDOWN],
            _by_speed("C4 heavy line", partial(_rope_ends, _HEAVY, 0.0), (
                (0.3, 2923.34451, 15.16163, 112.91905, 9.14400),
                (0.5, 3026.41812, 37.45139, 288.75562, 60.49101),
                (1.0, 3617.23106, 75.74447, 671.31955, 352.62905),
            )),
            _SEVEN_DIGITS, Kind.INDEPENDENT),
        *(_identity(speed) for speed in (0.3, 0.5, 1.0)),
        *table(
            [_TENSION, _ANGLE, _OFFSET, _HEIGHT],
            _by_speed("C5 with Ct", partial(_rope_ends, _HEAVY, 0.01), (
                (0.3, 2923.67728, 15.16114, 112.91781, 990.85628),
                (0.5, 3032.17770, 37.43331, 288.70951, 939.53639),
                (1.0, 3720.85012, 75.41155, 670.62132, 648.89038),
            )),
            _SEVEN_DIGITS, Kind.INDEPENDENT),
    ),
)  # fmt: skip


_DIAMETER, _WEIGHT, _CN = 0.01, 2.5, 1.5


@cache
def _bare(speed: float) -> Wake:
    line = line_of(cable(100.0, _DIAMETER, _WEIGHT, _CN, 0.0))
    return towed(line, deep_water(), speed, Settings())


@cache
def _with_body(speed: float) -> Wake:
    normal, tangential = HALF_DENSITY * _CN * _DIAMETER, HALF_DENSITY * 0.02 * _DIAMETER
    line = line_of(
        LinePiece(300.0, True, -_WEIGHT, normal, tangential), point(-2000.0, HALF_DENSITY * 0.05)
    )
    return towed(line, deep_water(), speed)


_AT_THE_SHIP = "angle at the ship"

TOWED_CABLES = Source(
    "Towed cables",
    """C7 is a bare towed cable of 10 mm, 2.5 N/m and Cn 1.5. The cable is straight at the critical
angle φc, with cos φc = √(1 + p²/4) − p/2. Here p is the weight of the cable divided by the drag of
a cable perpendicular to the stream. In C8, 300 m of this cable tow a body that weighs 2000 N in
water and has a drag area of 0.05 m². The friction along the cable is ½ρ 0.02 D V² cos² φ. The
expected values of C8 are quadratures of the differential equations, with a relative error of 1e-10,
evaluated without CALM. The march has an angle step of 0.1° in C8.""",
    (
        *table(
            [CaseColumn[Wake](_AT_THE_SHIP, "°", 5.5e-5, lambda wake: wake.angle)],
            _by_speed("C7 bare cable", _bare, (
                (1.0, 31.7304), (2.0, 16.2243), (3.0, 10.8582), (5.0, 6.5277),
            )),
            f"{PRINTED} A straight cable is exact at any angle step.", Kind.CLOSED_FORM),
        *table(
            [
                CaseColumn[Wake]("tension at the ship", "N", 1e-6, lambda wake: wake.tension, True),
                CaseColumn[Wake](_AT_THE_SHIP, "°", 1e-4, lambda wake: wake.angle),
                CaseColumn[Wake]("distance aft of the ship", "m", 3e-4, lambda wake: wake.aft),
                CaseColumn[Wake]("depth of the body", "m", 3e-4, lambda wake: wake.depth),
            ],
            _by_speed("C8 with a body", _with_body, (
                (1.0, 2676.8181, 50.2681, 121.0705, 268.2631),
                (2.0, 2493.0209, 19.5421, 235.7036, 163.5868),
                (3.0, 2505.4823, 11.5260, 271.0537, 103.8530),
            )),
            "1e-6 of the length and of the tension, 1e-4° for the angle; the figures are printed "
            "to four decimals.", Kind.INDEPENDENT),
    ),
)  # fmt: skip


_TABLE = (
    (10, 0.00, 60, 1.017122, 0.588029, 0.158486, 0.559210),
    (10, 0.00, 30, 1.042705, 1.851566, 1.087628, 1.394744),
    (10, 0.00, 12, 1.090688, 7.217782, 6.201196, 2.961826),
    (10, 0.02, 60, 1.029050, 0.591480, 0.159706, 0.562411),
    (10, 0.02, 30, 1.081109, 1.885694, 1.112322, 1.417257),
    (10, 0.02, 12, 1.250175, 7.740277, 6.695377, 3.114723),
    (20, 0.00, 45, 1.125686, 1.156392, 0.499797, 1.009646),
    (20, 0.01, 45, 1.137970, 1.162815, 0.503310, 1.014916),
    (20, 0.02, 45, 1.150388, 1.169285, 0.506851, 1.020223),
    (20, 0.03, 45, 1.162942, 1.175803, 0.510421, 1.025567),
    (20, 0.02, 25, 1.357990, 3.603604, 2.566427, 2.296805),
    (30, 0.00, 45, 1.364054, 1.467920, 0.677138, 1.261120),
    (30, 0.02, 60, 1.205823, 0.701770, 0.199734, 0.664372),
    (30, 0.02, 45, 1.398297, 1.487219, 0.688118, 1.276704),
    (60, 0.00, 80, 1.357894, 0.240017, 0.023141, 0.238596),
    (60, 0.02, 70, 2.218338, 0.825827, 0.183732, 0.801214),
)
"""Table of Pode's functions, with the columns φc [degrees], f, φ [degrees], τ, σ, ξ, η."""

_CRITICAL = (
    (0.05, 12.7578), (0.1, 17.9642), (0.2, 25.1784), (0.5, 38.6683), (1.0, 51.8273),
    (2.0, 65.5302), (5.0, 78.8965), (10.0, 84.3173),
)  # fmt: skip
"""Table of critical angles, with the columns p, φc [degrees]."""

_PULL = 100.0
"""Tension of the cable at the towed body [N]."""


@cache
def _functions(critical: float, friction: float, angle: float) -> uniform.CableFunctions:
    ratio = float(uniform.critical_weight_ratio(radians(critical)))
    return uniform.cable_functions(radians(angle), ratio, friction)


@cache
def _march(critical: float, friction: float, arc: float) -> Wake:
    weight = float(uniform.critical_weight_ratio(radians(critical)))
    rope = LinePiece(_PULL * arc, True, -weight, 1.0, friction)
    line = replace(line_of(rope, point(-_PULL, 0.0)), friction=Friction.CONSTANT)
    return towed(line, deep_water(), 1.0)


def _name(critical: float, friction: float, angle: float) -> str:
    return f"C6 φc {critical}°, f {friction:g}, φ {angle}°"


def _identity_missed() -> float:
    """Return the largest |τ − 1 − p η − f σ| over the rows of the table."""
    misses = []
    for critical, friction, angle, *_ in _TABLE:
        tau, sigma, _, eta = _functions(critical, friction, angle)
        ratio = float(uniform.critical_weight_ratio(radians(critical)))
        misses.append(abs(float(tau - 1.0 - ratio * eta - friction * sigma)))
    return max(misses)


def _tension(critical: float, angle: float, tau: float) -> Case:
    def got() -> float:
        ratio = float(uniform.critical_weight_ratio(radians(critical)))
        return float(uniform.tension_ratio(radians(angle), radians(90.0), ratio))

    return Case(
        f"{_name(critical, 0.0, angle)}: τ, closed form", tau, "", 5.5e-7, PRINTED, got,
        Kind.INDEPENDENT,
    )  # fmt: skip


def _critical_angle(ratio: float) -> float:
    return degrees(float(uniform.critical_angle(ratio)))


PODE = Source(
    "Pode's cable functions",
    """L. Pode (David Taylor Model Basin reports 687 and 717, 1951) tabulated τ, σ, ξ and η,
functions of a heavy cable in a uniform stream, with a constant friction F = f R along the cable
(C6). The expected values are quadratures of his integrals from φ to 90°, with an error of 1e-10;
they are not copied from his tables. They are compared with `calm.analytic.uniform` and with τ − 1 =
p η + f σ. Cases with friction are also compared with the march of a towed body. Cases without
friction are also compared with the closed form of the tension. E. E. Zajac (Bell System Technical
Journal 36, 1957) also gives the critical angle, cos φc = √(1 + p²/4) − p/2.""",
    (
        *table(
            [
                CaseColumn[uniform.CableFunctions]("τ", "", 5.5e-7, lambda row: float(row.tau)),
                CaseColumn[uniform.CableFunctions]("σ", "", 5.5e-7, lambda row: float(row.sigma)),
                CaseColumn[uniform.CableFunctions]("ξ", "", 5.5e-7, lambda row: float(row.xi)),
                CaseColumn[uniform.CableFunctions]("η", "", 5.5e-7, lambda row: float(row.eta)),
            ],
            [(_name(*given), partial(_functions, *given), row)
             for *given, tau, sigma, xi, eta in _TABLE
             for row in [(tau, sigma, xi, eta)]],
            PRINTED, Kind.INDEPENDENT),
        *table(
            [
                CaseColumn[Wake]("φ, march", "°", 1e-4, lambda wake: wake.angle),
                CaseColumn[Wake]("τ, march", "", 2e-6, lambda wake: wake.tension / _PULL),
                CaseColumn[Wake]("ξ, march", "", 2e-6, lambda wake: wake.aft / _PULL),
                CaseColumn[Wake]("η, march", "", 2e-6, lambda wake: wake.depth / _PULL),
            ],
            [(_name(critical, f, angle), partial(_march, critical, f, sigma),
              (angle, tau, xi, eta))
             for critical, f, angle, tau, sigma, xi, eta in _TABLE if f > 0.0],
            "5e-7 for the rounding of the printed cable length σ, and about 1e-6 for the march, "
            "whose error is 1e-7 of the cable length at an angle step of 0.1°.", Kind.INDEPENDENT),
        *(_tension(critical, angle, tau) for critical, f, angle, tau, *_ in _TABLE if f == 0.0),
        Case("C6 all rows: maximum |τ − 1 − p η − f σ|", 0.0, "", 1e-11,
             "Exact; the quadratures have an error of 1e-12.", _identity_missed, Kind.PROPERTY),
        *(
            Case(f"critical angle, p {ratio:g}", expected, "°", 5.5e-5, PRINTED,
                 partial(_critical_angle, ratio), Kind.CLOSED_FORM)
            for ratio, expected in _CRITICAL
        ),
    ),
)  # fmt: skip
