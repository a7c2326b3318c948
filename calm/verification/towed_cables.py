"""C7 and C8: a bare cable at its critical angle, and a cable that tows a body."""

from __future__ import annotations

from functools import cache, partial

from calm.solve import Settings
from calm.verification.case import CaseColumn, Kind, Source, table
from calm.verification.ends import Wake, towed
from calm.verification.pieces import (
    HALF_DENSITY,
    LinePiece,
    cable,
    deep_water,
    line_of,
    point,
)

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
    """A cable of 10 mm, 2.5 N/m, Cn 1.5, towed bare (C7): it is straight at the critical angle,
cos φc = √(1 + p²/4) − p/2 with p the weight over the normal drag square to the stream. And 300 m
of it with a body of 2000 N in water and 0.05 m² of drag area (C8), friction
½ρ 0.02 D V² cos² φ along the cable: by quadrature of the differential equations (relative error
1e-10) without CALM. The march of CALM is held against them, at an angle step of 0.1° in C8.""",
    (
        *table(
            [CaseColumn[Wake](_AT_THE_SHIP, "°", 5.5e-5, lambda wake: wake.angle)],
            [
                (f"C7 bare cable, {speed} m/s", partial(_bare, speed), (angle,))
                for speed, angle in ((1.0, 31.7304), (2.0, 16.2243), (3.0, 10.8582), (5.0, 6.5277))
            ],
            "Half a unit of the last digit printed, and a tenth: a straight cable is exact "
            "whatever the angle step.",
            Kind.CLOSED_FORM,
        ),
        *table(
            [
                CaseColumn[Wake]("tension at the ship", "N", 1e-6, lambda wake: wake.tension, True),
                CaseColumn[Wake](_AT_THE_SHIP, "°", 1e-4, lambda wake: wake.angle),
                CaseColumn[Wake]("body aft of the ship", "m", 3e-4, lambda wake: wake.aft),
                CaseColumn[Wake]("depth of the body", "m", 3e-4, lambda wake: wake.depth),
            ],
            [
                (f"C8 with a body, {speed} m/s", partial(_with_body, speed), figures)
                for speed, *figures in (
                    (1.0, 2676.8181, 50.2681, 121.0705, 268.2631),
                    (2.0, 2493.0209, 19.5421, 235.7036, 163.5868),
                    (3.0, 2505.4823, 11.5260, 271.0537, 103.8530),
                )
            ],
            "1e-6 of the length and of the tension, 1e-4° for the angle; the figures are printed "
            "to four decimals.",
            Kind.INDEPENDENT,
        ),
    ),
)
