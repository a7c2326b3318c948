"""Compare anchor drops with a dynamic program's run of one, and closed forms of the fall."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import pi, sqrt

import numpy as np

from calm.drop.fall import Fineness, Motion, Ship, fall, towed
from calm.drop.fall_record import end_tensions
from calm.drop.motion import ChainState
from calm.physics.hull import Floating, spherical_hull
from calm.physics.line import Line, Water
from calm.physics.reference import REFERENCE_DENSITY
from calm.solve import FallingAnchor, solve_fall
from calm.verification.published_case import (
    GRAVITY,
    Case,
    Kind,
    LinePiece,
    Source,
    cable,
    line_of,
    sphere_drag,
)

_FINE = Fineness(bars=100, steps=100)
_DENSITY, _DEPTH = 1027.0, 1000.0
_VOLUME, _DRY = pi * 1.5**3 / 6.0, 1200.0 * GRAVITY

_SEA = Water(
    depth=_DEPTH, level=np.zeros(1), u=np.zeros(1), v=np.zeros(1), w=np.zeros(1),
    density=np.array([_DENSITY]), gravity=GRAVITY,
)  # fmt: skip
_DROPPED = FallingAnchor(weight=8896.0, drag=sphere_drag(0.81, 1.0))

_INERTIA = (
    "3 % of a time or a tension, 8 % of the fall-back: what leaving out inertia may cost. The "
    "program's own method without it differs by 0.4 and 1.1 % from that with it."
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


def _back() -> float:
    return -float(_fall().states[-1].node[-1, 1])


def _moved() -> float:
    first, last = (state.node[0, 1] for state in (_start(), _fall().states[-1]))
    return float(last - first)


def _pull(bar: int, end: int) -> float:
    drop = _fall()
    return max(float(end_tensions(drop.mover, state)[bar, end]) for state in drop.states[1:])


@cache
def _deep_fall() -> tuple[float, float]:
    """Speed of a plumb line far down [m/s]: that of the chain, and the terminal speed."""
    water = replace(_SEA, depth=3000.0)
    anchor = FallingAnchor(weight=8896.0, drag=400.0)
    line = replace(_wire_below_a_sphere().with_length(1, 150.0), floating=None)
    start = towed(line, water, anchor, Ship(0.0, 1.0), _FINE)
    last = fall(line, water, anchor, start, _FINE).states[-1]
    motion = solve_fall(line, water, anchor)
    return -float(last.velocity[-1, 2]), -float(motion.velocity[2])


@cache
def _alone() -> float:
    """Speed of a heavy sphere below a thread of nothing and a cork [m/s]."""
    line = line_of(
        LinePiece(0.05, False, 1.0, 1e-3, directional=False), cable(300.0, 1e-6, 1e-6, 1.3, 0.0)
    )
    anchor = FallingAnchor(weight=10_000.0, drag=100.0)
    fineness = Fineness(bars=50, steps=50)
    start = towed(line, _SEA, anchor, Ship(0.0, 1.0), fineness)
    return -float(fall(line, _SEA, anchor, start, fineness).states[-1].velocity[-1, 2])


_ALONE = sqrt(10_000.0 / (100.0 * _DENSITY / REFERENCE_DENSITY))
_THREAD = "Drag of the thread and the cork, and the last of the line's straightening."

ANCHOR_DROP = Source(
    "Anchor drop",
    """The example of a deployment that comes with WHOI Cable (J. Gobat & M. Grosenbaugh): 1050 m
of wire between a sphere of 1.5 m at the surface and an anchor of 8896 N in water, let go at 2 knots
in 1000 m of still water. Expected is what a program with inertia and added mass finds when the end
bodies are dragged by |V|V, as CALM's are; WHOI Cable 3.12 drags them axis by axis and finds 233
to 234 s and 107.9 m, that program with that drag 232.6 s and 108.3 m. The distance streamed is that
of WHOI Cable's own static solution. Then the terminal speed, against that of the steady fall, and
√(W/K) of a heavy sphere.""",
    (
        Case("streamed behind the ship", 894.8, "m", 0.5, "The chain's bars are 10 m long.",
             lambda: float(-_start().node[0, 1]), Kind.INDEPENDENT),
        Case("fall time", 238.4, "s", 0.03 * 238.4, _INERTIA, lambda: _fall().states[-1].time,
             Kind.INDEPENDENT),
        Case("fall-back", 64.1, "m", 0.08 * 64.1, _INERTIA, _back, Kind.INDEPENDENT),
        Case("way of the float", 431.0, "m", 0.03 * 431.0, _INERTIA, _moved, Kind.INDEPENDENT),
        Case("greatest tension at the anchor", 6245.0, "N", 0.03 * 6245.0, _INERTIA,
             lambda: _pull(-1, 1), Kind.INDEPENDENT),
        Case("greatest tension below the float", 7432.0, "N", 0.03 * 7432.0, _INERTIA,
             lambda: _pull(1, 0), Kind.INDEPENDENT),
        Case("terminal speed less that of the steady fall", 0.0, "m/s", 2e-3,
             "Both are within 1e-4 of the speed; the line has had 2850 m to become plumb.",
             lambda: _deep_fall()[0] - _deep_fall()[1], Kind.PROPERTY),
        Case("speed of a heavy sphere", _ALONE, "m/s", 0.01, _THREAD, _alone, Kind.CLOSED_FORM),
    ),
)  # fmt: skip
