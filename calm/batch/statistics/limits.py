"""The limits of the design check that can be judged in every profile of a batch."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from calm.batch.statistics.series import Column, Series
from calm.case import Mooring
from calm.case.warnings import is_synthetic
from calm.checks.anchor import anchor_sliding, anchor_uplift, anchor_weight
from calm.checks.finding import Rule, State
from calm.checks.posture import (
    AT_SURFACE,
    JUDGED_ROLES,
    MOST_OF_A_RATING,
    depth_rating,
    excursion,
    knockdown,
    reaches_the_surface,
    tilt,
)
from calm.checks.slack import slack
from calm.checks.strength import allowable_load, strength
from calm.checks.surface import reserve
from calm.files import Cable, Component
from calm.physics.anchor import required_weight

NOT_JUDGED = {
    "strength-steps": "the strengths of pieces side by side do not change with the current",
    "freeboard": "the result does not tell how the float lies in the water",
    "watch-circle": "the result does not tell the stretched length of the line",
    "scope": "it is told, and has no limit",
    "backup": "judged once of a mooring, by `calm check`",
    "launch-strength": "judged once of a mooring, by `calm check`",
    "launch-speed": "judged once of a mooring, by `calm check`",
    "recovery": "judged once of a mooring, by `calm check`",
    "tangling": "judged once of a mooring, by `calm check`",
}
"""Rules that no profile can be judged by, and why."""


@dataclass(frozen=True)
class Limit:
    """What a rule allows a part of the line, or the line as a whole.

    Attributes
    ----------
    rule : of the design check
    component : label of a piece or a clamp
    quantity : of `calm.quantities`
    limit : SI units and degrees; None where a figure of the component is missing
    least : whether values may not fall short of the limit, rather than not pass it
    beyond : state of a value that does: fail or warn
    values : the (n,) values of a batch; NaN where there is nothing to judge
    """

    rule: Rule
    component: str
    quantity: str
    limit: float | None
    least: bool
    beyond: State
    values: Callable[[Series], Column]

    def broken(self, values: Column) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """(n,) where values are beyond the limit; never where they are NaN."""
        assert self.limit is not None
        beyond = values < self.limit if self.least else values > self.limit
        return np.asarray(beyond, np.bool_)


def limits_of(mooring: Mooring) -> tuple[Limit, ...]:
    """Every limit of a mooring, rule by rule and down the line.

    The rules are those of `calm.checks`, with what a result holds: the tension of a piece is the
    greatest, or the least, of those at its ends and at the clamps on it. A line meant for the
    surface is judged as such wherever the current takes its float.
    """
    surface = reaches_the_surface(mooring)
    rules = (
        _strength(mooring, surface),
        _tilt(mooring),
        _depth_rating(mooring, surface),
        _top(mooring),
        _anchor(mooring),
        _slack(mooring),
        _reserve(mooring, surface),
    )
    return tuple(limit for rule in rules for limit in rule)


def _strength(mooring: Mooring, surface: bool) -> Iterator[Limit]:
    factors = mooring.file.checks.safety_factor
    for piece in mooring.file.pieces:
        labels = (piece.label, *(clamp.label for clamp in piece.clamps))
        limit = allowable_load(piece.component, factors, surface)
        yield Limit(
            strength, piece.label, "tension", limit, False, State.FAIL, _greatest_tension(labels)
        )


def _tilt(mooring: Mooring) -> Iterator[Limit]:
    design = mooring.file.checks.maximum_tilt
    for label, component in _parts(mooring):
        own, warned = component.max_tilt, component.warn_tilt
        if own is warned is None and component.role not in ("instrument", "release"):
            continue
        known = [limit for limit in (own, design) if limit is not None]
        limit, values = min(known, default=None), _tilt_of(label)
        yield Limit(tilt, label, "tilt", limit, False, State.FAIL, values)
        if warned is not None and (limit is None or warned < limit):
            yield Limit(tilt, label, "tilt", warned, False, State.WARN, values)


def _depth_rating(mooring: Mooring, surface: bool) -> Iterator[Limit]:
    margin = mooring.file.checks.rating_margin
    afloat = AT_SURFACE if surface else -np.inf
    pieces = mooring.file.pieces
    lower = {piece.label: below.label for piece, below in pairwise(pieces)}
    for label, component in _parts(mooring):
        rating = component.depth_rating
        if rating is None and component.role not in JUDGED_ROLES:
            continue
        limit = None if rating is None else rating - min(margin, MOST_OF_A_RATING * rating)
        values = _greatest_depth(label, lower.get(label), afloat)
        yield Limit(depth_rating, label, "depth", limit, False, State.FAIL, values)


def _top(mooring: Mooring) -> Iterator[Limit]:
    checks, label = mooring.file.checks, mooring.file.pieces[0].label
    for rule, quantity, limit, values in (
        (knockdown, "knockdown", checks.maximum_knockdown, top_knockdown),
        (excursion, "offset", checks.maximum_excursion, top_offset),
    ):
        if limit is not None:
            yield Limit(rule, label, quantity, limit, False, State.FAIL, values)


def _anchor(mooring: Mooring) -> Iterator[Limit]:
    anchor, checks, weight = mooring.file.anchor, mooring.file.checks, mooring.anchor_weight
    factor, friction = checks.anchor_factor, anchor.friction or checks.anchor_friction

    lifting, dragging = (  # the weight that each newton upward and sideways requires
        required_weight(*unit, factor, friction) for unit in ((1.0, 0.0), (0.0, 1.0))
    )

    def pull(series: Series, upward: float, sideways: float) -> Column:
        weighted = series.ends("anchor_vertical")
        weighted *= upward
        aside = series.ends("anchor_horizontal")
        aside *= sideways
        weighted += aside
        return weighted

    def required(series: Series) -> Column:
        return pull(series, lifting, dragging)

    def sliding(series: Series) -> Column:
        return pull(series, friction, 1.0)

    def uplift(series: Series) -> Column:
        return series.ends("anchor_vertical")

    for rule, quantity, limit, values in (
        (anchor_weight, "required_weight", weight, required),
        (anchor_uplift, "vertical", weight / factor, uplift),
        (anchor_sliding, "horizontal", friction * weight / factor, sliding),
    ):
        label = mooring.file.pieces[-1].label
        yield Limit(rule, label, quantity, limit, False, State.FAIL, values)


def _slack(mooring: Mooring) -> Iterator[Limit]:
    file, limits = mooring.file, mooring.file.checks.minimum_tension
    lowest = len(file.pieces) - 1 if file.release is None else file.release
    for piece in file.pieces[:lowest]:
        if isinstance(piece.component, Cable) and piece.component.slack != "allowed":
            limit = limits.rope if is_synthetic(piece.component) else limits.wire
            values = _least_tension(piece.label, mooring.water.depth)
            yield Limit(slack, piece.label, "tension", limit, True, State.FAIL, values)


def _reserve(mooring: Mooring, surface: bool) -> Iterator[Limit]:
    if surface:
        label, limit = mooring.file.pieces[0].label, mooring.file.checks.minimum_reserve
        yield Limit(reserve, label, "used_buoyancy", limit, True, State.FAIL, _reserve_left)


def _parts(mooring: Mooring) -> Iterator[tuple[str, Component]]:
    """Label and component of the pieces above the anchor, then of the clamps."""
    pieces = mooring.file.pieces[:-1]
    yield from ((piece.label, piece.component) for piece in pieces)
    yield from ((clamp.label, clamp.component) for piece in pieces for clamp in piece.clamps)


def top_offset(series: Series) -> Column:
    """(n,) horizontal distance of the top of the line from the anchor [m]."""
    offset = series.column("x_top", 0)
    np.hypot(offset, series.column("y_top", 0), out=offset)
    return offset


def top_knockdown(series: Series) -> Column:
    """(n,) how much deeper the top of the line is than in still water [m]."""
    return series.column("knockdown", 0)


def _reserve_left(series: Series) -> Column:
    left = series.ends("used_buoyancy")
    np.subtract(1.0, left, out=left)
    return left


def _tilt_of(label: str) -> Callable[[Series], Column]:
    return lambda series: series.tilt(label)


def _greatest_tension(labels: Sequence[str]) -> Callable[[Series], Column]:
    return lambda series: series.greatest_tension(labels)


def _least_tension(label: str, seabed: float) -> Callable[[Series], Column]:
    """Of the ends of a piece; NaN where all of it lies on the seabed."""

    def values(series: Series) -> Column:
        lies = series.depth(label) >= seabed * (1.0 - _LYING)
        least = series.least_tension(label)
        least[lies] = np.nan
        return least

    return values


def _greatest_depth(label: str, below: str | None, afloat: float) -> Callable[[Series], Column]:
    """Of both ends of a piece, the lower one being the upper one of the piece below."""

    def values(series: Series) -> Column:
        depth = series.depth(label)
        floats = depth <= afloat
        if below is not None:
            np.maximum(depth, series.depth(below), out=depth)
        depth[floats] = np.nan
        return depth

    return values


_LYING = 1e-6  # of the depth: what is no further above the seabed lies on it
