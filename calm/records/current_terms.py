"""How a person wants the currents of a file taken, and which currents and depths cannot be."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, inf, isinf
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from calm.records.water_column import Place

DEEPEST = 11_000.0
"""Depth that no sea exceeds [m]."""

IMPOSSIBLE = (
    "an infinite or negative speed, or a direction outside -360 to 360°: a fill value, or "
    "another unit?"
)
"""What is said of a current whose speed is infinite in `too_fast`."""


@dataclass(frozen=True)
class Terms:
    """Describe how a person wants the currents of a file to be taken.

    Attributes
    ----------
    water_depth : places heights above the seabed [m]; inf where it is not known
    place : whose column is wanted, where a file holds several
    declination : of magnetic north from true north, positive to the east [degrees]; turns what
        the file says is magnetic
    maximum_speed : a faster current is a mistake of the file [m/s]
    on_the_line : whether levels may be parts of a line by their labels, and currents that the file
        flags as bad are kept with their flags; these are left out otherwise
    """

    water_depth: float = inf
    place: Place | None = None
    declination: float | None = None
    maximum_speed: float = inf
    on_the_line: bool = False


def too_fast(u: float, v: float, w: float, maximum_speed: float) -> str | None:
    """Return what is wrong with a current faster than the greatest that is plausible; None if it
    is not.

    Parameters
    ----------
    u, v, w : [m/s]
    """
    speed = hypot(u, v, w)
    if isinf(speed):
        return IMPOSSIBLE
    if not speed > maximum_speed:
        return None
    return (
        f"{speed:.5g} m/s is faster than `maximum_speed`, {maximum_speed:g} m/s: a fill value, or "
        "another unit? (`maximum_speed` of the environment allows it if it is true)"
    )


def too_deep(depth: float) -> str | None:
    """Return what is wrong with a depth [m] below that of any sea; None if it is not."""
    if not depth > DEEPEST:
        return None
    return f"depth {depth:g} m is deeper than any sea, {DEEPEST:g} m"
