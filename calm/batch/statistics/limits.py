"""The criteria of the design check as they are counted in every profile of a batch."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from calm.batch.statistics.series import Column, Seat, Series
from calm.case import Mooring
from calm.checks.criterion import AT_SURFACE, Criterion, Judged
from calm.checks.finding import Rule, State
from calm.checks.posture import reaches_the_surface
from calm.checks.rules import RULES
from calm.files.rules import RULES as TEXTS

NOT_JUDGED = {
    name: TEXTS[name].unseen
    for name, rule in RULES.items()
    if rule.criteria is None and name != "equilibrium"
}
"""Rules that no profile can be judged by, and why."""


@dataclass(frozen=True)
class Limit:
    """A criterion of a rule, and its values in a batch.

    Attributes
    ----------
    rule : of the design check
    criterion : what it asks
    mooring : of what
    """

    rule: Rule
    criterion: Criterion
    mooring: Mooring

    @property
    def component(self) -> str:
        """Label of the piece or the clamp."""
        return self.criterion.part.label

    @property
    def quantity(self) -> str:
        """Of `calm.quantities`, whose unit the values have."""
        return self.rule.quantity

    @property
    def limit(self) -> float | None:
        """SI units and degrees; None where a figure of the component is missing."""
        return self.criterion.limit

    @property
    def least(self) -> bool:
        """Whether values may not fall short of the limit, rather than not pass it."""
        return self.criterion.least

    @property
    def beyond(self) -> State:
        """State of a value that does: fail or warn."""
        return self.criterion.beyond

    def values(self, series: Series) -> Column:
        """The (n,) values of a batch; NaN where there is nothing to judge."""
        return _VALUES[self.criterion.quantity](series, self.criterion.part, self.mooring)

    def broken(self, values: Column) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """(n,) where values are beyond the limit; never where they are NaN."""
        assert self.limit is not None
        beyond = values < self.limit if self.least else values > self.limit
        return np.asarray(beyond, np.bool_)


def limits_of(mooring: Mooring) -> tuple[Limit, ...]:
    """Every limit of a mooring that can be counted in a batch, rule by rule and down the line.

    The tension of a piece is the greatest, or the least, of those at its ends and at the clamps on
    it, which is what a result holds. A line meant for the surface is judged as such wherever the
    current takes its float.
    """
    return tuple(
        Limit(rule, criterion, mooring)
        for rule in RULES.values()
        if rule.criteria is not None
        for criterion in rule.criteria(mooring)
    )


def top_offset(series: Series) -> Column:
    """(n,) horizontal distance of the top of the line from the anchor [m]."""
    offset = series.column("x_top", 0)
    np.hypot(offset, series.column("y_top", 0), out=offset)
    return offset


def top_knockdown(series: Series) -> Column:
    """(n,) how much deeper the top of the line is than in still water [m]."""
    return series.column("knockdown", 0)


def _seat(part: Judged) -> Seat:
    return Seat(part.index) if part.clamp is None else Seat(part.clamp, True)


def _greatest_tension(series: Series, part: Judged, mooring: Mooring) -> Column:
    pieces = mooring.file.pieces
    first = sum(len(piece.clamps) for piece in pieces[: part.index])
    clamps = range(first, first + len(pieces[part.index].clamps))
    return series.greatest_tension([_seat(part), *(Seat(clamp, True) for clamp in clamps)])


def _least_tension(series: Series, part: Judged, mooring: Mooring) -> Column:
    """Of the ends of a piece; NaN where all of it lies on the seabed."""
    lies = series.depth(_seat(part)) >= mooring.water.depth * (1.0 - _LYING)
    least = series.least_tension(_seat(part))
    least[lies] = np.nan
    return least


def _greatest_depth(series: Series, part: Judged, mooring: Mooring) -> Column:
    """Of both ends of a piece, the lower one being the upper one of the piece below."""
    depth = series.depth(_seat(part))
    floats = depth <= (AT_SURFACE if reaches_the_surface(mooring) else -np.inf)
    if part.clamp is None:
        np.maximum(depth, series.depth(Seat(part.index + 1)), out=depth)
    depth[floats] = np.nan
    return depth


def _required_weight(series: Series, _: Judged, mooring: Mooring) -> Column:
    """Factor (V + H / friction): see `calm.physics.anchor.required_weight`."""
    factor, friction = mooring.file.checks.anchor_factor, _friction(mooring)
    needed = series.ends("anchor_horizontal")
    np.divide(needed, friction, out=needed)
    needed += series.ends("anchor_vertical")
    needed *= factor
    return needed


def _slide(series: Series, _: Judged, mooring: Mooring) -> Column:
    slide = series.ends("anchor_vertical")
    slide *= _friction(mooring)
    slide += series.ends("anchor_horizontal")
    return slide


def _friction(mooring: Mooring) -> float:
    own = mooring.file.anchor.friction
    return mooring.file.checks.anchor_friction if own is None else own


def _reserve_left(series: Series, _: Judged, __: Mooring) -> Column:
    left = series.ends("used_buoyancy")
    np.subtract(1.0, left, out=left)
    return left


_VALUES: dict[str, Callable[[Series, Judged, Mooring], Column]] = {
    "tension": _greatest_tension,
    "tension_bottom": lambda series, part, _: series.column("tension_bottom", part.index),
    "least_tension": _least_tension,
    "tilt": lambda series, part, _: series.tilt(_seat(part)),
    "depth": _greatest_depth,
    "top_depth": lambda series, _, __: series.column("depth_top", 0),
    "knockdown": lambda series, _, __: top_knockdown(series),
    "offset": lambda series, _, __: top_offset(series),
    "required_weight": _required_weight,
    "vertical": lambda series, _, __: series.ends("anchor_vertical"),
    "slide": _slide,
    "reserve": _reserve_left,
}
"""The readings of `calm.checks.criterion` over the profiles of a batch."""

_LYING = 1e-6  # of the depth: what is no further above the seabed lies on it
