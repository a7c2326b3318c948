"""Criteria of the design check for every profile of a batch, and the fraction of profiles that
violate each criterion.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from calm.batch.statistics.series import Column, LegColumns, PartNumber, ResultColumns
from calm.batch.statuses import Ending
from calm.case import Design
from calm.case.leg import Leg
from calm.checks.assess import RULES, is_judged
from calm.checks.assessment import estimated
from calm.checks.criterion import AT_SURFACE, Criterion, JudgedPart
from calm.checks.finding import Rule, State
from calm.checks.posture import reaches_the_surface
from calm.checks.situations import equilibrium
from calm.files.pieces import STAND_IN, parts_of
from calm.files.rule_texts import RULES as TEXTS
from calm.physics.seabed import required_weight

NOT_JUDGED = {
    name: TEXTS[name].unseen
    for name, rule in RULES.items()
    if rule.criteria is None and name != "equilibrium"
}
"""Rules that cannot be evaluated per profile, each with the reason."""


@dataclass(frozen=True)
class CountedLimit:
    """A criterion of a rule, and the evaluation of the criterion for all profiles of a batch.

    Attributes
    ----------
    leg : leg to which the criterion applies. Values missing from the catalogue are estimated; the
        lower bound of each estimate is used
    columns : columns of the leg in the batch result of a net; None for a single line
    on_estimate : whether the limit depends on an estimate. A value beyond such a limit is not
        necessarily a failure
    """

    rule: Rule
    criterion: Criterion
    leg: Leg
    columns: LegColumns | None = None
    on_estimate: bool = False

    def values(self, series: ResultColumns) -> Column:
        """Return the values (n,) of the limited quantity in a batch, with NaN for profiles to which
        the criterion does not apply.
        """
        own = series if self.columns is None else series.of_leg(self.columns)
        return _VALUES[self.criterion.quantity](own, self.criterion.part, self.leg)

    def broken(self, values: Column) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Return whether each value (n,) violates the limit; NaN does not."""
        limit = self.criterion.limit
        assert limit is not None
        beyond = values < limit if self.criterion.least else values > limit
        return np.asarray(beyond, np.bool_)


def limits_of(mooring: Design) -> tuple[CountedLimit, ...]:
    """List all limits of a mooring that can be evaluated in a batch, by rule and then down the
    line.

    Lower bounds of estimates replace values missing from the catalogue. A line designed to reach
    the surface is checked as a surface mooring, even if its float is submerged. Tensions are
    evaluated only at the ends and the clamps of a piece.
    """
    legs = LegColumns.of_file(mooring.file) if mooring.several else (None,)
    order = list(RULES)
    found = [
        CountedLimit(rule, criterion, estimated(leg), columns, _on_estimate(rule, criterion, leg))
        for leg, columns in zip(mooring.typed_legs, legs, strict=True)
        for rule in RULES.values()
        if rule.criteria is not None
        for criterion in rule.criteria(estimated(leg))
        if is_judged(leg.file, rule, criterion.part.index)
    ]
    return tuple(sorted(found, key=lambda limit: order.index(limit.rule.name)))


def _on_estimate(rule: Rule, criterion: Criterion, leg: Leg) -> bool:
    figures, place = TEXTS[rule.name].figures, criterion.part.place
    if criterion.figure:
        figures = tuple(name for name in figures if name == criterion.figure)
    own = (part.component.estimates for part in parts_of(leg.file.pieces) if part.place == place)
    return any(name in figures for estimates in own for name in estimates)


def top_offset(series: ResultColumns) -> Column:
    """Return the horizontal distance (n,) of the line's top from the anchor [m]."""
    offset = series.column("x_top", 0) - series.column("x_top", -1)
    np.hypot(offset, series.column("y_top", 0) - series.column("y_top", -1), out=offset)
    return offset


def top_knockdown(series: ResultColumns) -> Column:
    """Return the knockdown (n,) of the line's top [m]."""
    return series.column("knockdown", 0)


def _part_number(part: JudgedPart) -> PartNumber:
    return PartNumber(part.index) if part.clamp is None else PartNumber(part.clamp, True)


def _greatest_tension(series: ResultColumns, part: JudgedPart, leg: Leg) -> Column:
    pieces = leg.file.pieces
    first = sum(len(piece.clamps) for piece in pieces[: part.index])
    clamps = range(first, first + len(pieces[part.index].clamps))
    return series.greatest_tension(
        [_part_number(part), *(PartNumber(clamp, True) for clamp in clamps)]
    )


def _least_tension(series: ResultColumns, part: JudgedPart, leg: Leg) -> Column:
    """Return the minimum tension (n,) at the ends of a piece [N]; NaN if the whole piece is on the
    seabed.
    """
    water, pieces, least = leg.water, leg.file.pieces, series.least_tension(_part_number(part))
    bed: Column | float = water.depth * (1.0 - _LYING)
    for name, deeper in (("x_top", water.deeper_east), ("y_top", water.deeper_north)):
        if deeper != 0.0 and pieces[-1].use != STAND_IN:
            anchor = series.column(name, len(pieces) - 1)
            bed = bed + deeper * (series.column(name, part.index) - anchor)
    least[series.depth(_part_number(part)) >= bed] = np.nan
    return least


def _greatest_depth(series: ResultColumns, part: JudgedPart, leg: Leg) -> Column:
    """Return the depth (n,) of the deeper end of a piece [m]; NaN for a piece at the surface."""
    depth = series.depth(_part_number(part))
    floats = depth <= (AT_SURFACE if reaches_the_surface(leg) else -np.inf)
    pieces = leg.file.pieces
    if part.clamp is None and pieces[part.index + 1].use == STAND_IN:
        # an upper bound of the depth, unless the piece stretches
        depth += pieces[part.index].length or 0.0
    elif part.clamp is None:
        np.maximum(depth, series.depth(PartNumber(part.index + 1)), out=depth)
    depth[floats] = np.nan
    return depth


def _required_weight(series: ResultColumns, _: JudgedPart, leg: Leg) -> Column:
    return required_weight(
        series.ends("anchor_vertical"),
        series.ends("anchor_horizontal"),
        leg.file.checks.anchor_factor,
        leg.file.anchor_friction,
    )


def _slide(series: ResultColumns, _: JudgedPart, leg: Leg) -> Column:
    slide = series.ends("anchor_vertical")
    slide *= leg.file.anchor_friction
    slide += series.ends("anchor_horizontal")
    return slide


_VALUES: dict[str, Callable[[ResultColumns, JudgedPart, Leg], Column]] = {
    "tension": _greatest_tension,
    "tension_bottom": lambda series, part, _: series.column("tension_bottom", part.index),
    "least_tension": _least_tension,
    "tilt": lambda series, part, _: series.of_part("tilt", _part_number(part)),
    "depth": _greatest_depth,
    "top_depth": lambda series, _, __: series.column("depth_top", 0),
    "knockdown": lambda series, _, __: top_knockdown(series),
    "offset": lambda series, _, __: top_offset(series),
    "required_weight": _required_weight,
    "vertical": lambda series, _, __: series.ends("anchor_vertical"),
    "slide": _slide,
    "reserve": lambda series, _, __: 1.0 - series.ends("used_buoyancy"),
}
"""Functions that read the quantities of `calm.checks.criterion` from batch results."""

_LYING = 1e-6  # share of the depth; parts closer to the seabed than this lie on it


@dataclass(frozen=True)
class Exceedance:
    """Frequency with which a limit is exceeded in a batch.

    Attributes
    ----------
    count : number of profiles in which the limit can be evaluated. If the limit depends on an
        estimate, profiles beyond the limit are not counted
    share : fraction of the counted profiles that exceed the limit
    worst, time : most unfavourable value, and its time; None if `count` is 0
    """

    limit: CountedLimit
    count: int
    share: float | None
    worst: float | None
    time: np.datetime64 | None


@dataclass(frozen=True)
class RuleShare:
    """Fraction of profiles in which a rule fails or warns for any part of the line.

    Attributes
    ----------
    judged : number of profiles in which at least one limit of the rule is evaluated
    fails : fraction of the judged profiles in which the rule fails; None if `judged` is 0
    warns : fraction of the judged profiles in which the rule warns but does not fail, or None
    fails_at_most : upper bound of `fails`: unsolved profiles with a current count as failures
    unknown : number of limits that no profile can evaluate, usually because a value is missing
    """

    name: str
    title: str
    judged: int
    fails: float | None
    fails_at_most: float | None
    warns: float | None
    unknown: int
    exceedances: tuple[Exceedance, ...]


def equilibrium_share(ended: Mapping[Ending, int]) -> RuleShare:
    """Compute the fraction of profiles without equilibrium.

    The fraction excludes profiles that did not converge.
    """
    without = ended[Ending.NO_EQUILIBRIUM]
    judged = ended[Ending.SOLVED] + without
    return _rule_share(equilibrium, judged, without, 0, ended[Ending.NOT_CONVERGED], ())


def shares_of(
    series: ResultColumns, limits: Iterable[CountedLimit], unsolved: int
) -> Iterator[RuleShare]:
    """Yield the `RuleShare` of each rule.

    Parameters
    ----------
    limits : limits of the rules; limits of the same rule are consecutive
    unsolved : number of profiles with a current but without a solution
    """
    for rule, group in groupby(limits, key=lambda limit: limit.rule):
        beyond = {state: np.zeros(len(series), np.bool_) for state in (State.FAIL, State.WARN)}
        judged = np.zeros(len(series), np.bool_)
        exceedances = tuple(
            _exceedance(series, limit, beyond[limit.criterion.beyond], judged) for limit in group
        )
        beyond[State.WARN] &= ~beyond[State.FAIL]
        yield _rule_share(
            rule,
            int(np.count_nonzero(judged)),
            int(np.count_nonzero(beyond[State.FAIL])),
            int(np.count_nonzero(beyond[State.WARN])),
            unsolved,
            exceedances,
        )


def _rule_share(
    rule: Rule,
    judged: int,
    failed: int,
    warned: int,
    unsolved: int,
    exceedances: tuple[Exceedance, ...],
) -> RuleShare:
    return RuleShare(
        name=rule.name,
        title=rule.title,
        judged=judged,
        fails=failed / judged if judged else None,
        fails_at_most=(failed + unsolved) / (judged + unsolved) if judged else None,
        warns=warned / judged if judged else None,
        unknown=sum(one.count == 0 for one in exceedances),
        exceedances=exceedances,
    )


def _exceedance(
    series: ResultColumns, limit: CountedLimit, beyond: NDArray[np.bool_], judged: NDArray[np.bool_]
) -> Exceedance:
    """Compute how often a limit is exceeded.

    The function sets `beyond` (n,) for profiles beyond the limit, and `judged` (n,) for profiles in
    which the limit can be evaluated.
    """
    if limit.criterion.limit is None:
        return Exceedance(limit, 0, None, None, None)
    values = limit.values(series)
    broken, known = limit.broken(values), np.isfinite(values)
    if limit.on_estimate:
        known &= ~broken
        broken = np.zeros_like(broken)
    beyond |= broken
    judged |= known
    count = int(np.count_nonzero(known))
    if not count:
        return Exceedance(limit, 0, None, None, None)
    edge = np.fmin.reduce(values) if limit.criterion.least else np.fmax.reduce(values)
    share = int(np.count_nonzero(broken)) / count
    return Exceedance(limit, count, share, float(edge), series.time[np.argmax(values == edge)])
