"""C12 to C14: lines in still water, hanging free or lying on the seabed."""

from __future__ import annotations

from functools import cache
from math import inf

import numpy as np
from numpy.typing import ArrayLike

from calm.analytic.catenary import Catenary, between
from calm.physics.line import Line
from calm.solve import Solution, solve_mooring
from calm.verification.case import PRINTED, Case, CaseColumn, Kind, Source, table
from calm.verification.ends import FINE, ends_of
from calm.verification.pieces import LinePiece, line_of, point, stream

_MARCH = (
    "1e-6 of the line's length or of the pull; the float pulls with the printed forces, and the "
    "march errs by less than that at an angle step of 0.1°."
)

_SUSPENDED = 15677.747, 26291.876
_TAUT = 86912.281, 77703.619
_TOUCHDOWN = 0.763277, 3.424639
_DEPTH = 2.65
_BUOYANCY = 10.0
"""More than the touchdown case needs, so that the float lies at the surface [N]."""


@cache
def _suspended() -> Catenary:
    return between(400.0, 300.0, 520.0, 50.0, 5e6)


@cache
def _taut() -> Catenary:
    return between(400.0, 300.0, 490.0, 50.0, 5e6)


@cache
def _touchdown() -> Catenary:
    return between(5.3, _DEPTH, 6.98, 1.036, 560e3, seabed=True)


@cache
def _level() -> Catenary:
    return between(300.0, 0.0, 330.0, 20.0, inf)


def _number(field: ArrayLike) -> float:
    return float(np.asarray(field))


def _sag() -> float:
    _, z = _level().position(165.0)
    return -float(z)


def _pulled(pull: tuple[float, float], length: float, weight: float, stiffness: float) -> Line:
    """A float that pulls sideways and up in a current of 1 m/s, above a line without drag."""
    horizontal, vertical = pull
    return line_of(
        point(vertical, horizontal), LinePiece(length, True, -weight, compliance=1.0 / stiffness)
    )


@cache
def _march(pull: tuple[float, float], length: float) -> Solution:
    return solve_mooring(_pulled(pull, length, 50.0, 5e6), stream(600.0, 1.0), FINE)


@cache
def _march_to_the_seabed() -> Solution:
    line = _pulled((_TOUCHDOWN[0], _BUOYANCY), 6.98, 1.036, 560e3)
    return solve_mooring(line, stream(_DEPTH, 1.0), FINE)


def _pulls(force: float) -> tuple[CaseColumn[Catenary], ...]:
    return (
        CaseColumn("horizontal pull", "N", force, lambda line: _number(line.horizontal)),
        CaseColumn("vertical pull at the top", "N", force, lambda line: _number(line.vertical)),
        CaseColumn("tension at the top", "N", force, lambda line: float(line.tension_top)),
    )


_LOWER_END = CaseColumn[Catenary](
    "vertical pull at the lower end", "N", 5.5e-4, lambda line: float(line.vertical_bottom)
)
_GROUNDED = CaseColumn[Catenary](
    "length on the seabed", "m", 5.5e-7, lambda line: float(line.grounded)
)
_SPAN = (
    CaseColumn[Solution]("distance of the ends, march", "m", 5e-4, lambda line: ends_of(line).x),
    CaseColumn[Solution]("height of the ends, march", "m", 5e-4, lambda line: ends_of(line).z),
)
_LANDED = (
    CaseColumn[Solution]("distance of the ends, march", "m", 7e-6, lambda line: ends_of(line).x),
    CaseColumn[Solution](
        "vertical pull, march", "N", 3.4e-6, lambda line: line.buoyancy_used * _BUOYANCY
    ),
    CaseColumn[Solution](
        "length on the seabed, march", "m", 7e-6, lambda line: line.grounded_length
    ),
    CaseColumn[Solution](
        "tension at the anchor, march", "N", 8e-7, lambda line: float(line.tension[-1])
    ),
)

CATENARIES = Source(
    "Catenaries",
    """The elastic catenary of M. Irvine, *Cable Structures* (1981), on four sets of figures (C12 to
C14): ends 400 m apart and 300 m above each other, 50 N/m, EA 5 MN, once 520 m long and once
stretched from 490 m; a line that comes down on a seabed without friction (the inputs are the
public example of the Python package *pycatenary*: 5.3 m by 2.65 m, 6.98 m of 1.036 N/m, EA
560 kN); a level span of 300 m, 330 m of inextensible line, 20 N/m. The figures are roots of the
closed forms with residuals below 1e-12. They are held against `calm.analytic.catenary` and, where
the line can be moored, against the march.""",
    (
        *table(
            [*_pulls(5.5e-4), _LOWER_END],
            [("C12 suspended", _suspended, (*_SUSPENDED, 30611.346, 291.876))],
            PRINTED,
            Kind.CLOSED_FORM,
        ),
        *table(
            _pulls(5.5e-4),
            [("C12 taut", _taut, (*_TAUT, 116583.005))],
            PRINTED,
            Kind.CLOSED_FORM,
        ),
        *table(
            [*_pulls(5.5e-7), _GROUNDED],
            [("C13 touchdown", _touchdown, (*_TOUCHDOWN, 3.508667, 3.674364))],
            PRINTED,
            Kind.CLOSED_FORM,
        ),
        *(
            Case(f"C14 level span: {name}", expected, unit, 5.5e-7, PRINTED, got, Kind.CLOSED_FORM)
            for name, expected, unit, got in (
                ("horizontal pull", 3929.783686, "N", lambda: _number(_level().horizontal)),
                ("greatest tension", 5131.588430, "N", lambda: float(_level().tension_top)),
                ("sag", 60.090237, "m", _sag),
            )
        ),
        *table(
            _SPAN,
            [
                ("C12 suspended", lambda: _march(_SUSPENDED, 520.0), (400.0, 300.0)),
                ("C12 taut", lambda: _march(_TAUT, 490.0), (400.0, 300.0)),
            ],
            _MARCH,
            Kind.CLOSED_FORM,
        ),
        *table(
            _LANDED,
            [("C13 touchdown", _march_to_the_seabed, (5.3, 3.424639, 3.674364, 0.763277))],
            _MARCH,
            Kind.CLOSED_FORM,
        ),
    ),
)  # fmt: skip
