"""The statistics of a batch in short."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from calm.batch.statistics.extremes import Fit, Level
from calm.checks.finding import State
from calm.quantities import QUANTITIES
from calm.report.batch_summary import (
    METHODS_IN_SHORT,
    QUANTITY,
    TITLES,
    extent,
    left_out,
    percent,
    refusals,
    standing,
    when,
)
from calm.report.blocks import (
    Block,
    Cell,
    Column,
    Heading,
    Prose,
    ReportPart,
    Span,
    Table,
    table_of,
)

if TYPE_CHECKING:
    from calm.batch.statistics.limits import RuleShare
    from calm.batch.statistics.summary import Distribution, Summary

_QUANTITIES = ("knockdown", "tilt", "tension")
_PERIODS = (10, 50, 100)
_ALL = (
    "All percentiles, limits and profiles are in the JSON and on the page. Depths and offsets are "
    "within 1e-4 of the water depth of those of `calm run`, tensions within 2e-4; no profile is "
    "audited."
)


def summary_part(summary: Summary) -> ReportPart:
    """Return what a summary says; it fits 80 columns, where long labels wrap.

    Components and clamps with the 99 % percentile and the maximum of each quantity, how often
    each rule fails, the worst profile by each response, and return levels.
    """
    lost, note = summary.count - summary.solved, left_out(summary)
    ended = Span(standing(summary), State.FAIL if lost else None)
    missing = tuple(refusals(summary))
    blocks: tuple[Block, ...] = (
        Heading(summary.name),
        Prose((extent(summary), (ended,))),
        _parts(summary),
        _rules(summary),
        *([Prose((note,), State.WARN)] if note else []),
        _worst(summary),
        *_levels(summary),
        *([Prose(missing, State.WARN)] if missing else []),
        Prose(((Span(_ALL, quiet=True),),)),
    )
    return ReportPart("", blocks)


def _parts(summary: Summary) -> Table:
    columns = [Column("")]
    for name in _QUANTITIES:
        quantity = QUANTITIES[name]
        columns.append(Column(f"{quantity.heading}\n99 %", numeric=True))
        columns.append(Column(f"{quantity.display_unit}\nmaximum", numeric=True))
    rows = tuple(
        (
            Cell(part.label, indented=part.clamped),
            *(Cell(text) for name in _QUANTITIES for text in _extremes(name, getattr(part, name))),
        )
        for part in summary.parts
    )
    return Table("", tuple(columns), rows)


def _extremes(name: str, one: Distribution | None) -> tuple[str, str]:
    if one is None:
        return "-", "-"
    quantity = QUANTITIES[name]
    return quantity.format(one.percentiles[2]), quantity.format(one.maximum)


def _rules(summary: Summary) -> Table:
    return table_of(
        "",
        summary.rules,
        (Column("rule"), lambda rule: rule.title),
        (
            Column("fails\n% of profiles", numeric=True),
            lambda rule: Cell(percent(rule.fails), state=State.FAIL if rule.fails else None),
        ),
        (Column("at most\n%", numeric=True), lambda rule: percent(rule.fails_at_most)),
        (Column("warns\n%", numeric=True), lambda rule: percent(rule.warns)),
        (Column("most often broken by"), _broken),
    )


def _broken(rule: RuleShare) -> str:
    """The part that breaks a rule most often, and how many cannot be judged by it."""
    unknown = f"{rule.unknown} unknown" if rule.unknown else ""
    most = max(rule.exceedances, key=lambda one: one.share or 0.0, default=None)
    if most is None or not most.share:
        return unknown
    broken = f"{most.limit.component}, {percent(most.share)} %"
    return f"{broken}; {unknown}" if unknown else broken


def _worst(summary: Summary) -> Table:
    columns = [Column("worst profile by"), Column("time", share=0.0)]
    for name in TITLES:
        unit = QUANTITIES[QUANTITY[name]].display_unit
        columns.append(Column(name.replace("_", " "), unit, numeric=True))
    rows = []
    for name, profiles in summary.worst.items():
        for profile in profiles[:1]:
            figures = (QUANTITIES[QUANTITY[one]].format(getattr(profile, one)) for one in TITLES)
            rows.append(tuple(map(Cell, (name.replace("_", " "), when(profile.time), *figures))))
    return Table("", tuple(columns), tuple(rows))


def _levels(summary: Summary) -> Iterator[Table]:
    """Return levels, where there are any."""
    columns = [Column("return level, and 95 % interval")]
    columns += [Column(f"{period} years", numeric=True) for period in _PERIODS]
    rows = []
    for response in summary.responses:
        quantity = QUANTITIES[QUANTITY[response.name]]
        for fit in response.return_levels:
            if isinstance(fit, Fit):
                levels = {level.period: level for level in fit.levels}
                said = (_level(response.name, levels.get(period)) for period in _PERIODS)
                of = f"{TITLES[response.name]} [{quantity.display_unit}]"
                rows.append(tuple(map(Cell, (f"{of}, {METHODS_IN_SHORT[fit.method]}", *said))))
    if rows:
        yield Table("", tuple(columns), tuple(rows))


def _level(name: str, level: Level | None) -> str:
    if level is None:
        return "-"
    quantity = QUANTITIES[QUANTITY[name]]
    low, high = ("?" if end is None else quantity.format(end) for end in (level.low, level.high))
    return f"{quantity.format(level.level)}\n{low}–{high}"
