"""C22: how far a slack surface mooring can drift."""

from __future__ import annotations

import re

from calm.errors import NoEquilibrium
from calm.solve import solve_mooring
from calm.verification.case import Case, Kind, Source
from calm.verification.pieces import cable, line_of, point, stream

_SLACK_DEPTH, _SCOPE = 540.0, 2.0


def _radius() -> float:
    """The radius reported with the refusal of a line that has no unique shape [m]."""
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
unique shape: CALM refuses it with the status `slack` and reports the radius of its watch circle, at
most depth · √(scope² − 1). PacIOOS publishes 934 m, 1.73 times the depth, for that mooring.""",
    (
        Case("C22 radius", 934.0, "m", 0.002 * 934.0,
             "0.2 %: 1.73 is √3 to three digits.", _radius, Kind.PUBLISHED),
    ),
)  # fmt: skip
