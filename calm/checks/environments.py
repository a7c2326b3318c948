"""The rule `environment`: what is doubtful in the environments of a mooring, and beside each other.

One environment alone: what `Environment.doubts` lists. Together: a storm that is weaker than the
ordinary current somewhere, and a float with an area in the wind that no wind blows on.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import numpy as np

from calm.case.leg import Leg
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
"""Names of environments that are meant to be stronger than the ordinary one."""

WEAKER = 0.5
"""Share of the ordinary current below which that of a stronger environment is doubted."""

_LEAST = 0.05
"""Ordinary current below which a weaker one is no matter [m/s]."""

_CHECK = "Check its values and units."


@rule("environment")
def environment(legs: Sequence[Leg]) -> Iterator[Found]:
    """What is doubtful about the environments that a mooring stands in.

    Each verdict comes with the leg in the environment that it is of.
    """
    said: set[str] = set()
    for leg in legs:
        for doubt in leg.file.environment.doubts:
            if doubt not in said:
                said.add(doubt)
                yield leg, verdict_on(None, State.WARN, doubt, _CHECK)
    for leg in legs[1:]:
        yield from _weaker_than(legs[0], leg)
    yield from _no_wind(legs)


def _weaker_than(ordinary: Leg, other: Leg) -> Iterator[Found]:
    """A current that is meant to be the stronger, by the name of its environment or by its maximum,
    and has much weaker levels; only the latter may be weaker at one end of its profile.
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
        f"The current of {name} is {say('speed', float(after[at]))} at "
        f"{say('depth', float(levels[at]))}, that of the ordinary environment "
        f"{say('speed', float(before[at]))}."
    )
    remedy = f"Check the levels of {name}: a decimal point, or rows exchanged?"
    yield other, verdict_on(None, State.WARN, message, remedy)


def _speeds(current: CurrentTable, levels: Floats) -> Floats:
    depth, speed = np.array(current.depth), np.hypot(current.u, current.v)
    between: Floats = np.interp(levels, depth, speed)
    return between


def _no_wind(legs: Sequence[Leg]) -> Iterator[Found]:
    """A float at the surface with an area in the wind, and no wind in any environment."""
    top = legs[0].file.pieces[0]
    area = getattr(top.component, "wind_area", None)
    calm = all(leg.file.environment.wind is None for leg in legs)
    if area and calm and reaches_the_surface(legs[0]):
        message = f"No environment has a `wind`: its pull on {top.label} is not judged."
        remedy = "Give the `wind` of the site, and of its storm."
        yield legs[0], verdict_on(top, State.WARN, message, remedy)
