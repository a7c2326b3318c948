"""Rule `environment`: doubtful values in the environments of a mooring.

Examples are a storm with a weaker current than the ordinary environment, and missing wind for a
float with a wind area.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import numpy as np

from calm.case.leg import Leg
from calm.case.warnings import buoyancy_of_sea_water
from calm.checks.finding import State, Verdict, rule, verdict_on
from calm.checks.posture import reaches_the_surface
from calm.files import CurrentTable
from calm.physics.line import Floats
from calm.quantities import say

Found = tuple[Leg, Verdict]

_STRONG = re.compile(
    r"storm|gale|hurricane|typhoon|cyclone|extreme|surviv|surge|strong|worst|max(imum)?\b|\d+.?year"
    r"|return|sturm|tempête",
    re.IGNORECASE,
)
"""Words in the names of environments whose current should be stronger than the ordinary current."""

WEAKER = 0.5
"""Ratio to the ordinary current below which the current of a storm is doubtful."""

_LEAST = 0.05
"""Ordinary current speed below which a weaker storm current is ignored [m/s]."""

_CHECK = "Check the values and units of the environment."


@rule("environment")
def environment(legs: Sequence[Leg]) -> Iterator[Found]:
    """Yield warnings about the environments of a mooring; `legs` has one leg per environment."""
    reported: set[str] = set()
    for leg in legs:
        for doubt in leg.file.environment.doubts:
            if doubt not in reported:
                reported.add(doubt)
                yield leg, verdict_on(None, State.WARN, doubt, _CHECK)
    for leg in legs[1:]:
        yield from _weaker_than(legs[0], leg)
    yield from _no_wind(legs)
    yield from _in_fresh_water(legs)


def _weaker_than(ordinary: Leg, other: Leg) -> Iterator[Found]:
    """Warn if a storm current is much weaker than the ordinary current at some depth.

    The current of `other` is a storm current if the name of its environment suggests a storm, or if
    its maximum speed is larger. In the second case, the depths above the first level and below the
    last level at which `other` is at least as strong are ignored.
    """
    first, second = (each.file.environment for each in (ordinary, other))
    levels = np.union1d(first.current.depth, second.current.depth)
    levels = levels[levels <= other.water.depth]
    before, after = (_speeds(each.current, levels) for each in (first, second))
    weaker = (after < WEAKER * before) & (before >= _LEAST)
    if not weaker.any():
        return
    name = second.name or ""
    stronger = np.flatnonzero(after >= before)
    if not _STRONG.search(name):
        if not len(stronger) or after.max() <= before.max():
            return
        weaker[: stronger[0]] = weaker[stronger[-1] :] = False
        if not weaker.any():
            return
    at = int(np.argmin(np.where(weaker, after / np.maximum(before, _LEAST), np.inf)))
    message = (
        f"At {say('depth', float(levels[at]))}, the current of {name} is "
        f"{say('speed', float(after[at]))}, against {say('speed', float(before[at]))} in the "
        "first environment."
    )
    remedy = f"Check the current of {name} for a misplaced decimal point or exchanged rows."
    yield other, verdict_on(None, State.WARN, message, remedy)


def _speeds(current: CurrentTable, levels: Floats) -> Floats:
    depth, speed = np.array(current.depth), np.hypot(current.u, current.v)
    between: Floats = np.interp(levels, depth, speed)
    return between


def _no_wind(legs: Sequence[Leg]) -> Iterator[Found]:
    top = legs[0].file.pieces[0]
    area = getattr(top.component, "wind_area", None)
    calm = all(leg.file.environment.wind is None for leg in legs)
    if area and calm and reaches_the_surface(legs[0]):
        message = f"No environment has a `wind`, so the wind load on {top.label} is not checked."
        remedy = "Set `wind` in each environment, for example the wind of a storm."
        yield legs[0], verdict_on(top, State.WARN, message, remedy)


def _in_fresh_water(legs: Sequence[Leg]) -> Iterator[Found]:
    lightest = min(legs, key=lambda leg: float(np.max(leg.water.density)))
    if (found := buoyancy_of_sea_water(lightest)) is not None:
        part, message = found
        yield lightest, verdict_on(part, State.WARN, message, "Set the `mass` of the float.")
