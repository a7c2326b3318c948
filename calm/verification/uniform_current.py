"""C1 to C5: a float on a thread, a neutral line, a heavy line, in a uniform current."""

from __future__ import annotations

from functools import cache, partial
from math import hypot

from calm.physics.line import Line, Water
from calm.verification.case import Case, CaseColumn, Kind, Source, table
from calm.verification.ends import Ends, finely
from calm.verification.pieces import LinePiece, cable, line_of, point, sphere_drag, stream

_FLOAT = point(4905.0, sphere_drag(1.0, 0.65))
_LENGTH = 1000.0
_HEAVY = 2.0

_PRINTED = "Half a unit of the last digit printed, and a tenth: one straight rod is exact."
_SEVEN_DIGITS = (
    "1e-6 of the line's length or of the tension, 6e-5° for an angle; the figures have seven "
    "digits, and the march errs by 4e-8 at an angle step of 0.1°."
)


def float_on_a_thread(speed: float) -> tuple[Line, Water]:
    """C1 at a speed [m/s]."""
    return line_of(_FLOAT, LinePiece(100.0, True, 0.0)), stream(110.0, speed)


def ball_on_a_thread() -> tuple[Line, Water]:
    """C2."""
    ball = point(0.337612, sphere_drag(0.04, 1.0))
    return line_of(ball, LinePiece(0.5, True, 0.0)), stream(1.0, 0.5, density=1027.0)


def float_on_a_rope(weight: float, ct: float, speed: float) -> tuple[Line, Water]:
    """C3 to C5, of a weight [N/m] and a Ct, at a speed [m/s]."""
    return line_of(_FLOAT, cable(_LENGTH, 0.0127, weight, 1.3, ct)), stream(1010.0, speed)


@cache
def _thread_ends(speed: float) -> Ends:
    return finely(*float_on_a_thread(speed))


@cache
def _ball_ends() -> Ends:
    return finely(*ball_on_a_thread())


@cache
def _rope_ends(weight: float, ct: float, speed: float) -> Ends:
    return finely(*float_on_a_rope(weight, ct, speed))


def _drop(length: float, ends: Ends) -> float:
    return length - ends.z


def _fall(speed: float) -> float:
    """T_top − T_bottom of the heavy line [N]."""
    at_the_float = hypot(_FLOAT.buoyancy, _FLOAT.normal_drag * speed**2)
    return at_the_float - _rope_ends(_HEAVY, 0.0, speed).tension


def _identity(speed: float) -> Case:
    return Case(
        f"C4 heavy line, {speed} m/s: (T_top − T_bottom) / (w z_top)", 1.0, "", 1e-6,
        "Exact; the rods keep it to 1 − cos of half an angle step, 4e-7 at 0.1°.",
        lambda: _fall(speed) / (_HEAVY * _rope_ends(_HEAVY, 0.0, speed).z), Kind.PROPERTY,
    )  # fmt: skip


def _thread(length: float, force: float, place: float, angle: float) -> list[CaseColumn[Ends]]:
    """The figures printed of a float on a thread, with their tolerances."""
    return [
        CaseColumn("drag", "N", force, lambda ends: ends.horizontal),
        CaseColumn("tension", "N", force, lambda ends: ends.tension),
        CaseColumn("angle from the vertical", "°", angle, lambda ends: ends.lean),
        CaseColumn("offset", "m", place, lambda ends: ends.x),
        CaseColumn("drop", "m", place, partial(_drop, length)),
    ]


_TENSION = CaseColumn[Ends]("tension at the anchor", "N", 1e-6, lambda ends: ends.tension, True)
_ANGLE = CaseColumn[Ends]("angle at the anchor", "°", 6e-5, lambda ends: ends.lean)
_OFFSET = CaseColumn[Ends]("offset of the float", "m", 1e-6 * _LENGTH, lambda ends: ends.x)
_KNOCKDOWN = CaseColumn[Ends]("knockdown", "m", 1e-6 * _LENGTH, partial(_drop, _LENGTH))
_HEIGHT = CaseColumn[Ends]("height of the float", "m", 1e-6 * _LENGTH, lambda ends: ends.z)
_HORIZONTAL = CaseColumn[Ends]("anchor, horizontal", "N", 5e-3, lambda ends: ends.horizontal)
_VERTICAL = CaseColumn[Ends]("anchor, vertical", "N", 5e-3, lambda ends: ends.vertical)

UNIFORM_CURRENT = Source(
    "Floats and lines in a uniform current",
    """A float of 500 kgf and 1 m (Cx 0.65) on 100 m of line without weight or drag (C1); a ball
on a thread, the check of the R package *mooring* by D. Kelley, in water of 1027 kg/m³ (C2); the
float of C1 on 1000 m of line, 12.7 mm, Cn 1.3: neutral (C3), of 2 N/m (C4), and with Ct 0.01 on its
surface besides (C5).

C1 and C2 are elementary: tan θ = D/B, T² = B² + D². C3 is a catenary on its side,
cot φ = cot φ₀ + R s/T at constant T. C4 and C5 follow from T′ = w sin φ + F, T φ′ = w cos φ −
R sin² φ by quadrature (relative error 1e-10), without CALM. In C4 the tension differs between two
points by w times their difference in height. C5 shows the sign of the tangential drag. All with
g = 9.81 m/s² and, but for C2, ρ = 1025 kg/m³; the march of CALM at an angle step of 0.1° is held
against them.""",
    (
        *table(
            _thread(100.0, 5.5e-5, 5.5e-6, 5.5e-6),
            [
                (f"C1 float on a thread, {speed} m/s", partial(_thread_ends, speed), figures)
                for speed, *figures in (
                    (0.5, 65.4089, 4905.4361, 0.76400, 1.33340, 0.00889),
                    (1.0, 261.6358, 4911.9730, 3.05330, 5.32649, 0.14196),
                    (1.5, 588.6805, 4940.1994, 6.84370, 11.91613, 0.71251),
                )
            ],
            _PRINTED,
            Kind.CLOSED_FORM,
        ),
        *table(
            _thread(0.5, 5.5e-7, 5.5e-7, 5.5e-5),
            [
                ("C2 ball on a thread", _ball_ends,
                 (0.161321, 0.374174, 25.5398, 0.215569, 0.048857)),
            ],
            _PRINTED,
            Kind.CLOSED_FORM,
        ),
        *table(
            [_TENSION, _ANGLE, _OFFSET, _KNOCKDOWN, _HORIZONTAL, _VERTICAL],
            [
                (f"C3 neutral line, {speed} m/s", partial(_rope_ends, 0.0, 0.0, speed), figures)
                for speed, *figures in (
                    (0.3, 4905.05652, 9.09326, 81.90536, 4.35144, 775.2048, 4843.4117),
                    (0.5, 4905.43610, 23.96800, 218.62256, 31.25006, 1992.7172, 4482.4526),
                    (1.0, 4911.97295, 60.61696, 601.82678, 253.81368, 4280.0921, 2410.0395),
                )
            ],
            _SEVEN_DIGITS,
            Kind.CLOSED_FORM,
        ),
        *table(
            [_TENSION, _ANGLE, _OFFSET, _KNOCKDOWN],
            [
                (f"C4 heavy line, {speed} m/s", partial(_rope_ends, _HEAVY, 0.0, speed), figures)
                for speed, *figures in (
                    (0.3, 2923.34451, 15.16163, 112.91905, 9.14400),
                    (0.5, 3026.41812, 37.45139, 288.75562, 60.49101),
                    (1.0, 3617.23106, 75.74447, 671.31955, 352.62905),
                )
            ],
            _SEVEN_DIGITS,
            Kind.INDEPENDENT,
        ),
        *(_identity(speed) for speed in (0.3, 0.5, 1.0)),
        *table(
            [_TENSION, _ANGLE, _OFFSET, _HEIGHT],
            [
                (f"C5 with Ct, {speed} m/s", partial(_rope_ends, _HEAVY, 0.01, speed), figures)
                for speed, *figures in (
                    (0.3, 2923.67728, 15.16114, 112.91781, 990.85628),
                    (0.5, 3032.17770, 37.43331, 288.70951, 939.53639),
                    (1.0, 3720.85012, 75.41155, 670.62132, 648.89038),
                )
            ],
            _SEVEN_DIGITS,
            Kind.INDEPENDENT,
        ),
    ),
)  # fmt: skip
