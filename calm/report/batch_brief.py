"""The statistics of a batch in short."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
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
    profiles_table,
    refusals,
    rules_table,
    standing,
    stops_tables,
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
)

if TYPE_CHECKING:
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
    worst = [(name, one) for name, each in summary.worst.items() for one in each[:1]]
    blocks: tuple[Block, ...] = (
        Heading(summary.name),
        Prose((extent(summary), (ended,))),
        _parts(summary),
        replace(rules_table(summary), title="", note=""),
        *([Prose((note,), State.WARN)] if note else []),
        *stops_tables(summary),
        profiles_table("", worst),
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
