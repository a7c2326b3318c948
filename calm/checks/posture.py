"""Where the line stands: tilt, depth, knockdown and excursion."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import hypot
from typing import TYPE_CHECKING

from calm.case.columns import ClampRow, ComponentRow
from calm.checks.finding import State, Verdict, at_most, rule, unknown
from calm.quantities import say

if TYPE_CHECKING:
    from calm.case import Mooring, Result

AT_SURFACE = 0.1
"""What comes so near to the surface is at it [m]."""

MOST_OF_A_RATING = 0.5
"""Share of a rating that the margin takes at most: what is made for shallow water may be used."""

JUDGED_ROLES = ("float", "instrument", "release")
"""What is made for a depth; of line and connectors only those that give a rating are judged."""


def meant_for_the_surface(result: Result) -> bool:
    """Whether the float is at the surface but for the current, the wind or the tide."""
    return reaches_the_surface(result.mooring)


def reaches_the_surface(mooring: Mooring) -> bool:
    """Whether a line is meant to have its float at the surface: whether it has in still water.

    A line that reaches it has no unique shape in still water where it is longer than that is deep.
    """
    if mooring.for_surface is not None:
        return mooring.for_surface
    if mooring.at_rest is None:
        return float(mooring.line.length.sum()) >= mooring.water.depth
    return -float(mooring.at_rest.position[0, 2]) <= AT_SURFACE


@rule("tilt")
def tilt(result: Result) -> Iterator[Verdict]:
    """Tilt of instruments and releases against their own limits and the design's.

    The makers': an Aanderaa RCM deviates by 27 degrees at most (BODC), a single-point Doppler by
    30, an ADCP by 20 and is doubtful from 15, a release by 45, a sediment trap by 10.
    """
    design = result.file.checks.maximum_tilt
    for row in _rows(result):
        label, leaning, component = row.label, row.tilt, row.part.component
        own, warned = component.max_tilt, component.warn_tilt
        if own is warned is None and component.role not in ("instrument", "release"):
            continue
        limits = [limit for limit in (own, design) if limit is not None]
        remedy = "Add buoyancy above it, or move it where the line stands straighter."
        leans = f"{label} leans {say('tilt', leaning)}"
        if limits:
            message = f"{leans}; {say('tilt', min(limits))} is its limit."
            verdict = at_most(row, leaning, min(limits), message, remedy)
        else:
            message = f"{leans}; how far it may is not known."
            verdict = unknown(row, message, "Give its `max_tilt`.", leaning)
        if warned is not None and leaning > warned and verdict.state is not State.FAIL:
            message = f"{leans}; from {say('tilt', warned)} on its data are doubtful."
            verdict = replace(verdict, state=State.WARN, message=message, remedy=remedy)
        yield verdict


@rule("depth-rating")
def depth_rating(result: Result) -> Iterator[Verdict]:
    """Depth in the current, and a margin, against the rating of floats and instruments.

    A float that is knocked down below its rating is crushed, and the line with it.
    """
    margin = result.file.checks.rating_margin
    for row, depth in _at_depth(result):
        component = row.part.component
        rating = component.depth_rating
        stands = f"{row.label} is {say('depth', depth)} deep"
        if rating is None:
            if component.role in JUDGED_ROLES:
                yield unknown(
                    row,
                    f"{stands}; what depth it stands is not known.",
                    "Give its `depth_rating`.",
                    depth,
                )
            continue
        spare = min(margin, MOST_OF_A_RATING * rating)
        yield at_most(
            row,
            depth,
            rating - spare,
            f"{stands}; it is rated to {say('depth_rating', rating)}, less a margin of "
            f"{say('depth_rating', spare)}.",
            "Take one that stands more depth, or add buoyancy against the knockdown.",
        )


@rule("knockdown")
def knockdown(result: Result) -> Iterator[Verdict]:
    """Knockdown of the top against the design's limit, where it gives one."""
    limit, top = result.file.checks.maximum_knockdown, result.file.pieces[0]
    if limit is None:
        return
    if result.top.knockdown is None:
        yield unknown(
            top,
            "The line has no unique shape in still water to measure a knockdown from.",
            "Judge a slack line by its excursion: `maximum_excursion`.",
        )
        return
    yield at_most(
        top,
        result.top.knockdown,
        limit,
        f"The top is knocked down by {say('knockdown', result.top.knockdown)}; "
        f"{say('knockdown', limit)} are allowed.",
        "Add buoyancy at the top, or take drag off: `calm run --explain` tells which.",
    )


@rule("excursion")
def excursion(result: Result) -> Iterator[Verdict]:
    """Horizontal offset of the top against the design's limit, where it gives one."""
    limit, offset = result.file.checks.maximum_excursion, hypot(result.top.x, result.top.y)
    if limit is None:
        return
    yield at_most(
        result.file.pieces[0],
        offset,
        limit,
        f"The top is {say('offset', offset)} off the anchor; {say('offset', limit)} are allowed.",
        "Add buoyancy, take drag off, or shorten the line.",
    )


def _rows(result: Result) -> tuple[ComponentRow | ClampRow, ...]:
    """The pieces above the anchor and the clamps."""
    return (*list(result.components)[:-1], *result.clamps)


def _at_depth(result: Result) -> Iterator[tuple[ComponentRow | ClampRow, float]]:
    """What is under water above the anchor, and its greatest depth [m]."""
    for row in _rows(result):
        if isinstance(row, ClampRow):
            yield row, row.depth
        elif result.type != "surface" or row.depth_top > AT_SURFACE:
            yield row, max(row.depth_top, row.depth_bottom)
