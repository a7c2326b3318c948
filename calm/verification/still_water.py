"""Verification in still water: catenaries, an elastic rope, a slack line, and an anchor drop.

The case numbers are C12 to C14 (catenaries), C15 (rope) and C22 (watch circle of the slack line).
"""

import re
from dataclasses import replace
from functools import cache, partial
from math import pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from calm.analytic.catenary import Catenary, between
from calm.drop.fall import Fineness, Motion, Ship, fall, towed
from calm.drop.fall_record import end_tensions
from calm.drop.motion import ChainState, FallingAnchor
from calm.errors import NoEquilibrium
from calm.physics.hull import Floating, spherical_hull
from calm.physics.line import Line
from calm.physics.seawater import REFERENCE_DENSITY
from calm.solve import Solution, solve_mooring
from calm.verification.published_case import (
    FINE,
    GRAVITY,
    PRINTED,
    Case,
    CaseColumn,
    Ends,
    Kind,
    LinePiece,
    Source,
    cable,
    ends_of,
    line_of,
    point,
    sphere_drag,
    stream,
    table,
)

_MARCH = (
    "1e-6 of the line's length or of the load. The float exerts the printed forces. The error of "
    "the march is smaller at an angle step of 0.1°."
)

_SUSPENDED = 15677.747, 26291.876
_TAUT = 86912.281, 77703.619
_TOUCHDOWN = 0.763277, 3.424639
_DEPTH = 2.65
_BUOYANCY = 10.0
"""Buoyancy of a float that remains at the surface in the touchdown case [N]."""


def _number(field: ArrayLike) -> float:
    return float(np.asarray(field))


def _pulled(pull: tuple[float, float], length: float, weight: float, stiffness: float) -> Line:
    """Return a line without drag below a float.

    `pull` is the horizontal and upward force on the float in a flow of 1 m/s [N]. Length, weight
    and stiffness are in m, N/m and N.
    """
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
_SAG = (
    CaseColumn[Catenary]("horizontal pull", "N", 5.5e-7, lambda line: _number(line.horizontal)),
    CaseColumn[Catenary]("greatest tension", "N", 5.5e-7, lambda line: float(line.tension_top)),
    CaseColumn[Catenary]("sag", "m", 5.5e-7, lambda line: -float(line.position(165.0)[1])),
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
    """These cases are elastic catenaries (M. Irvine, *Cable Structures*, 1981). In C12, the ends
are 400 m apart, one 300 m above the other. The line weighs 50 N/m and has an EA of 5 MN and an
unstretched length of 520 m (suspended) or 490 m (taut). In C13, the public example of the Python
package *pycatenary*, the line reaches a frictionless seabed. Its ends are 5.3 m apart, one 2.65 m
above the other. The line has a length of 6.98 m, a weight of 1.036 N/m and an EA of 560 kN. C14 is
a level span of 300 m with 330 m of inextensible line of 20 N/m. The expected values are roots of
the closed forms with residuals below 1e-12. They are compared with `calm.analytic.catenary` and, if
the line can be moored, with the march.""",
    (
        *table(
            [*_pulls(5.5e-4), _LOWER_END],
            [
                ("C12 suspended", partial(between, 400.0, 300.0, 520.0, 50.0, 5e6),
                 (*_SUSPENDED, 30611.346, 291.876)),
            ],
            PRINTED, Kind.CLOSED_FORM),
        *table(
            _pulls(5.5e-4),
            [
                ("C12 taut", partial(between, 400.0, 300.0, 490.0, 50.0, 5e6),
                 (*_TAUT, 116583.005)),
            ],
            PRINTED, Kind.CLOSED_FORM),
        *table(
            [*_pulls(5.5e-7), _GROUNDED],
            [
                ("C13 touchdown", partial(between, 5.3, _DEPTH, 6.98, 1.036, 560e3, seabed=True),
                 (*_TOUCHDOWN, 3.508667, 3.674364)),
            ],
            PRINTED, Kind.CLOSED_FORM),
        *table(
            _SAG,
            [
                ("C14 level span", partial(between, 300.0, 0.0, 330.0, 20.0),
                 (3929.783686, 5131.588430, 60.090237)),
            ],
            PRINTED, Kind.CLOSED_FORM),
        *table(
            _SPAN,
            [
                ("C12 suspended", lambda: _march(_SUSPENDED, 520.0), (400.0, 300.0)),
                ("C12 taut", lambda: _march(_TAUT, 490.0), (400.0, 300.0)),
            ],
            _MARCH, Kind.CLOSED_FORM),
        *table(
            _LANDED,
            [("C13 touchdown", _march_to_the_seabed, (5.3, 3.424639, 3.674364, 0.763277))],
            _MARCH, Kind.CLOSED_FORM),
    ),
)  # fmt: skip


_LENGTH, _WEIGHT, _LOAD, _STIFFNESS = 1000.0, 0.3, 2000.0, 97_817.4

_WHY = (
    f"{PRINTED} Tension falls linearly along a hanging rope, so the stretch of a segment at its "
    "mean tension is exact for any angle step."
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
    """A 19 mm nylon rope of 1000 m hangs in still water (C15), with a weight of 0.3 N/m, a load of
2000 N at its lower end and EA 97 817.4 N (3.45e8 Pa on its section, the modulus of R. Dewey's
*Mooring Design & Dynamics*). Its elongation is (2000 L + 0.3 L²/2)/EA.""",
    (
        Case("C15 elongation", 21.97973, "m", 5.5e-6, _WHY, lambda: _hanging().z - _LENGTH,
             Kind.CLOSED_FORM),
        Case("C15 tension at the lower end", _LOAD, "N", 1e-6, "Rounding.",
             lambda: _hanging().tension, Kind.CLOSED_FORM),
    ),
)  # fmt: skip


_SLACK_DEPTH, _SCOPE = 540.0, 2.0


def _stated_watch_circle_radius() -> float:
    rope = cable(_SCOPE * _SLACK_DEPTH, 0.02, 1.0, 1.3, 0.0)
    try:
        solve_mooring(line_of(point(20_000.0, 100.0), rope), stream(_SLACK_DEPTH, 0.0))
    except NoEquilibrium as refusal:
        radius = re.search(r"radius of (\d+) m", refusal.message)
        if refusal.status == "slack" and radius:
            return float(radius[1])
        raise
    raise AssertionError("a slack line in still water was given a shape")


WATCH_CIRCLE = Source(
    "Watch circle",
    """A surface mooring of scope 2 in 540 m of water without current (C22) is slack and has no
unique shape. CALM reports the status `slack` and the radius of the watch circle, at most
depth · √(scope² − 1). PacIOOS publishes 934 m, 1.73 times the depth, for this mooring.""",
    (
        Case("C22 radius", 934.0, "m", 0.002 * 934.0,
             "0.2 %: 1.73 is √3 to three digits.", _stated_watch_circle_radius, Kind.PUBLISHED),
    ),
)  # fmt: skip


_FINE = Fineness(bars=100, steps=100)
_DENSITY, _FALL_DEPTH = 1027.0, 1000.0
_VOLUME, _DRY = pi * 1.5**3 / 6.0, 1200.0 * GRAVITY

_SEA = stream(_FALL_DEPTH, 0.0, _DENSITY)
_DROPPED = FallingAnchor(weight=8896.0, drag=sphere_drag(0.81, 1.0))

_INERTIA = (
    "3 % of a time or a tension, 8 % of the fall-back: the error that neglecting inertia may "
    "cause. Without inertia, the results of the independent program change by 0.4 and 1.1 %."
)


def _wire_below_a_sphere() -> Line:
    ball = LinePiece(
        1.5, False, 1025.0 * GRAVITY * _VOLUME - _DRY, sphere_drag(1.5, 0.3), directional=False,
        volume=_VOLUME,
    )  # fmt: skip
    line = line_of(ball, cable(1050.0, 0.01, 2.64, 1.5, 0.01, 1.0 / 4.7e6))
    lift = _DENSITY * GRAVITY * _VOLUME - _DRY
    return replace(line, floating=Floating(spherical_hull(1.5), _DRY, lift))


@cache
def _start() -> ChainState:
    return towed(_wire_below_a_sphere(), _SEA, _DROPPED, Ship(0.0, 1.028), _FINE)


@cache
def _fall() -> Motion:
    return fall(_wire_below_a_sphere(), _SEA, _DROPPED, _start(), _FINE)


def _pull(bar: int, end: int) -> float:
    drop = _fall()
    return max(float(end_tensions(drop.mover, state)[bar, end]) for state in drop.states[1:])


_PLUMB_WIRE, _PLUMB_ANCHOR = 150.0, FallingAnchor(weight=8896.0, drag=400.0)


@cache
def _plumb() -> float:
    """Return the terminal speed of a vertical line, computed at a depth of 3000 m [m/s]."""
    water = replace(_SEA, depth=3000.0)
    line = replace(_wire_below_a_sphere().with_length(1, _PLUMB_WIRE), floating=None)
    start = towed(line, water, _PLUMB_ANCHOR, Ship(0.0, 1.0), _FINE)
    return -float(fall(line, water, _PLUMB_ANCHOR, start, _FINE).states[-1].velocity[-1, 2])


@cache
def _alone() -> float:
    """Return the terminal speed of a heavy sphere [m/s].

    The sphere falls as the anchor of a thread below a small float. Thread and float are so light
    that they hardly affect the speed.
    """
    line = line_of(
        LinePiece(0.05, False, 1.0, 1e-3, directional=False), cable(300.0, 1e-6, 1e-6, 1.3, 0.0)
    )
    anchor = FallingAnchor(weight=10_000.0, drag=100.0)
    fineness = Fineness(bars=50, steps=50)
    start = towed(line, _SEA, anchor, Ship(0.0, 1.0), fineness)
    return -float(fall(line, _SEA, anchor, start, fineness).states[-1].velocity[-1, 2])


_PLUMB = sqrt(
    (_PLUMB_ANCHOR.weight + 2.64 * _PLUMB_WIRE - (_DENSITY * GRAVITY * _VOLUME - _DRY))
    * REFERENCE_DENSITY
    / _DENSITY
    / (
        _PLUMB_ANCHOR.drag
        + sphere_drag(1.5, 0.3)
        + 0.5 * REFERENCE_DENSITY * pi * 0.01 * 0.01 * _PLUMB_WIRE
    )
)
"""Terminal speed of the vertical line in closed form, √(net weight/sum of the drags) [m/s]."""
_ALONE = sqrt(10_000.0 / (100.0 * _DENSITY / REFERENCE_DENSITY))
_THREAD = "The drag of the thread and the cork, and the remaining bend of the line."

ANCHOR_DROP = Source(
    "Anchor drop",
    """The deployment example of WHOI Cable (J. Gobat & M. Grosenbaugh) has 1050 m of wire between a
sphere of 1.5 m at the surface and an anchor of 8896 N in water. The anchor is released at 2 knots
in 1000 m of still water. The expected values come from an independent program with inertia and
added mass. In this program, as in CALM, the drag of the end bodies is proportional to |V|V. WHOI
Cable 3.12 computes the drag of the end bodies axis by axis, and finds a fall time of 233 to 234 s
and a fall-back of 107.9 m. With the drag law of WHOI Cable, the independent program finds 232.6 s
and 108.3 m. The distance streamed is from WHOI Cable's static solution. The last two cases are the
terminal speeds of a vertical (*plumb*) line and of a heavy sphere. Each speed is compared with
√(W/K), where W is the net weight and K the sum of the drags.""",
    (
        Case("streamed behind the ship", 894.8, "m", 0.5, "The chain's bars are 10 m long.",
             lambda: float(-_start().node[0, 1]), Kind.INDEPENDENT),
        Case("fall time", 238.4, "s", 0.03 * 238.4, _INERTIA, lambda: _fall().states[-1].time,
             Kind.INDEPENDENT),
        Case("fall-back", 64.1, "m", 0.08 * 64.1, _INERTIA,
             lambda: -float(_fall().states[-1].node[-1, 1]), Kind.INDEPENDENT),
        Case("distance travelled by the float", 431.0, "m", 0.03 * 431.0, _INERTIA,
             lambda: float(_fall().states[-1].node[0, 1] - _start().node[0, 1]), Kind.INDEPENDENT),
        Case("maximum tension at the anchor", 6245.0, "N", 0.03 * 6245.0, _INERTIA,
             lambda: _pull(-1, 1), Kind.INDEPENDENT),
        Case("maximum tension below the float", 7432.0, "N", 0.03 * 7432.0, _INERTIA,
             lambda: _pull(1, 0), Kind.INDEPENDENT),
        Case("speed of a plumb line", _PLUMB, "m/s", 1e-4,
             "After a fall of 2850 m, the line is straight. A stretch of 0.1 % reduces the speed "
             "by 3e-5 m/s.",
             _plumb, Kind.CLOSED_FORM),
        Case("speed of a heavy sphere", _ALONE, "m/s", 0.01, _THREAD, _alone, Kind.CLOSED_FORM),
    ),
)  # fmt: skip
