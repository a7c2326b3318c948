"""The float of a surface mooring: its reserve of buoyancy, its freeboard and its watch circle."""

from __future__ import annotations

from collections.abc import Iterator
from math import sqrt
from typing import TYPE_CHECKING

from calm.checks.criterion import Criterion, criteria, pieces_of
from calm.checks.finding import Verdict, at_least, at_most, reported, rule, unknown
from calm.checks.limits import Citing
from calm.checks.posture import meant_for_the_surface, reaches_the_surface
from calm.quantities import say

if TYPE_CHECKING:
    from calm.case import Mooring, Result


@criteria("reserve")
def reserve(mooring: Mooring) -> Iterator[Criterion]:
    """Share of the surface float's buoyancy that is left: what it could still take on.

    The 0.3 that are asked for by default cover waves, which a static solution does not see.
    """
    if not reaches_the_surface(mooring):
        return
    limit = mooring.file.checks.minimum_reserve

    def words(left: float, result: Result) -> tuple[str, str]:
        if result.type == "surface":
            message = f"{100 * left:.0f} % of the float's buoyancy is left"
        else:
            message = f"The float is {say('depth', result.top.depth)} under water: 0 % is left"
        return (
            f"{message}; {100 * limit:.0f} % should be.",
            "Take a larger float, a lighter line, or more length.",
        )

    source = Citing.of(mooring.file)("minimum_reserve")
    top = pieces_of(mooring)[0]
    yield Criterion(top, "reserve", limit, words, least=True, source=source)


@rule("freeboard")
def freeboard(result: Result) -> Iterator[Verdict]:
    """A float meant for the surface stands out of the water."""
    if not meant_for_the_surface(result):
        return
    top, height = result.file.pieces[0], result.top.freeboard
    if result.type != "surface":
        height = -result.top.depth
    if height is None:
        yield unknown(
            top,
            "The freeboard of the float is not known.",
            "Give its `hull`, `mass` and `volume`, and let `buoy_drag` be `immersed`.",
        )
        return
    yield at_least(
        top,
        height,
        0.0,
        f"The float stands {say('freeboard', height)} out of the water.",
        "Take a larger float.",
    )


@rule("watch-circle")
def watch_circle(result: Result) -> Iterator[Verdict]:
    """Radius √(L² - depth²) within which a surface float can be found, with the line stretched.

    Worst case of a slack line, e.g. PacIOOS: 1.73 times the depth at a scope of 2. Judged by
    `maximum_excursion`, where the design gives it.
    """
    limit = result.file.checks.maximum_excursion
    if not meant_for_the_surface(result):
        return
    length, depth = float(result.components.length.sum()), result.mooring.water.depth
    radius = sqrt(max(length**2 - depth**2, 0.0))
    top = result.file.pieces[0]
    message = f"The watch circle has a radius of {say('offset', radius)}"
    if limit is None:
        yield reported(top, radius, f"{message}.")
        return
    message += f"; {say('offset', limit)} are allowed."
    yield at_most(top, radius, limit, message, "Shorten the line.")


@rule("scope")
def scope(result: Result) -> Iterator[Verdict]:
    """Cut length over water depth of a line to the surface; it is reported, and has no limit."""
    if not meant_for_the_surface(result):
        return
    depth = result.mooring.water.depth
    ratio = float(result.components.cut_length.sum()) / depth
    yield reported(None, ratio, f"The line is {ratio:.3f} times as long as the water is deep.")
