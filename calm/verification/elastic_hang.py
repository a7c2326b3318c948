"""C15: a nylon rope stretched by its load and its own weight."""

from __future__ import annotations

from functools import cache

from calm.solve import solve_mooring
from calm.verification.case import Case, Kind, Source
from calm.verification.ends import Ends, ends_of
from calm.verification.pieces import LinePiece, line_of, point, stream

_LENGTH, _WEIGHT, _LOAD, _STIFFNESS = 1000.0, 0.3, 2000.0, 97_817.4

_WHY = (
    "Half a unit of the last digit printed, and a tenth. Tension falls linearly along a hanging "
    "rope, so the stretch of a segment at its mean tension is exact whatever the angle step."
)


HANGING_ROPE = line_of(
    point(_LOAD + _WEIGHT * _LENGTH, 0.0),
    LinePiece(_LENGTH, True, -_WEIGHT, compliance=1.0 / _STIFFNESS),
)
HANGING_SEA = stream(1100.0, 0.0)


@cache
def _hanging() -> Ends:
    return ends_of(solve_mooring(HANGING_ROPE, HANGING_SEA))


ELASTIC_HANG = Source(
    "Elastic hang",
    """A 19 mm nylon rope of 1000 m in still water (C15), 0.3 N/m, 2000 N at its lower end,
EA 97 817.4 N (3.45e8 Pa on its section, the modulus of R. Dewey's *Mooring Design & Dynamics*):
its elongation is (2000 L + 0.3 L²/2)/EA.""",
    (
        Case("C15 elongation", 21.97973, "m", 5.5e-6, _WHY, lambda: _hanging().z - _LENGTH,
             Kind.CLOSED_FORM),
        Case("C15 tension at the lower end", _LOAD, "N", 1e-6, "Rounding.",
             lambda: _hanging().tension, Kind.CLOSED_FORM),
    ),
)  # fmt: skip
