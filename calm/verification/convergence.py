"""How the error of the march falls with its angle step."""

from __future__ import annotations

from functools import cache, partial
from math import atan2, hypot, log2, radians

from calm.analytic.uniform import heavy_line
from calm.solve import Settings, solve_mooring
from calm.verification.case import Case, Kind, Source
from calm.verification.pieces import cable, line_of, point, sphere_drag, stream

ANGLE_STEPS = (4.0, 2.0, 1.0, 0.5, 0.25, 0.125)
"""[degrees]"""

LENGTH = 1000.0
_BUOYANCY, _WEIGHT = 4905.0, 2.0


@cache
def heavy_line_error(degrees: float) -> float:
    """Miss of the free end of a heavy line, against its closed form [m].

    Parameters
    ----------
    degrees : angle step [degrees]
    """
    drag, rope = sphere_drag(1.0, 0.65), cable(LENGTH, 0.0127, _WEIGHT, 1.3, 0.01)
    line = line_of(point(_BUOYANCY, drag), rope)
    solution = solve_mooring(line, stream(1010.0, 1.0), Settings(radians(degrees), 1e-9))
    exact = heavy_line(
        -LENGTH, hypot(_BUOYANCY, drag), atan2(_BUOYANCY, -drag), _WEIGHT,
        rope.normal_drag, rope.tangential_drag,
    )  # fmt: skip
    x, _, z = (solution.position[-1] - solution.position[0]).tolist()
    return hypot(-x - float(exact.x), z - float(exact.z))


def _order(coarse: float, fine: float) -> float:
    return log2(heavy_line_error(coarse) / heavy_line_error(fine)) / log2(coarse / fine)


CONVERGENCE = Source(
    "Order of convergence",
    """The heavy line of C5 at 1 m/s, a current without shear, marched at angle steps from 4° to
0.125°, against the closed form of `calm.analytic.uniform`, which shares nothing with the march. The
march is of second order: half the step, a quarter of the error.""",
    (
        *(
            Case(f"C20 order, {coarse:g}° to {fine:g}°", 2.0, "", 0.05,
                 "Terms of fourth order and the rest piece at the end stir it.",
                 partial(_order, coarse, fine), Kind.PROPERTY)
            for coarse, fine in ((2.0, 1.0), (1.0, 0.5), (0.5, 0.25))
        ),
        Case("C20 miss of the free end at 1°", 0.0, "m", 5e-5 * LENGTH,
             "What CALM promises at its default angle step: 5e-5 of the depth.",
             partial(heavy_line_error, 1.0), Kind.CLOSED_FORM),
    ),
    picture="verification-convergence",
)  # fmt: skip
