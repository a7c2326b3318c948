"""The statistics of a batch for a terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from calm.batch.statistics.extremes import Fit, Level
from calm.quantities import QUANTITIES
from calm.report.batch.labels import (
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
from calm.report.terminal import WARNED, plain_table, warning

if TYPE_CHECKING:
    from calm.batch.statistics.distribution import Distribution
    from calm.batch.statistics.judgement import RuleShare
    from calm.batch.statistics.summary import Summary

_QUANTITIES = ("knockdown", "tilt", "tension")
_PERIODS = (10, 50, 100)
_ALL = "All percentiles, limits and profiles are in the JSON and on the page."


def summary_table(summary: Summary) -> RenderableType:
    """What a summary says, for a rich console; it fits 80 columns, long labels wrap.

    Components and clamps with the 99 % percentile and the maximum of each quantity, how often
    each rule fails, the worst profile by each response, and return levels.
    """
    lost, note = summary.count - summary.solved, left_out(summary)
    return Group(
        Text(summary.name, style="bold"),
        Text(extent(summary)),
        Text(standing(summary), style=WARNED if lost else ""),
        Text(),
        _parts(summary),
        Text(),
        _rules(summary),
        Text(),
        *([warning(note), Text()] if note else []),
        _worst(summary),
        Text(),
        *_levels(summary),
        *map(warning, refusals(summary)),
        Text(_ALL, style="dim"),
    )


def _parts(summary: Summary) -> Table:
    table = plain_table()
    table.add_column(overflow="fold")
    for name in _QUANTITIES:
        quantity = QUANTITIES[name]
        table.add_column(f"{quantity.heading}\n99 %", justify="right", no_wrap=True)
        table.add_column(f"{quantity.display_unit}\nmaximum", justify="right", no_wrap=True)
    for part in summary.parts:
        cells = (cell for name in _QUANTITIES for cell in _extremes(name, getattr(part, name)))
        table.add_row(Text(f"  {part.label}" if part.clamped else part.label), *cells)
    return table


def _extremes(name: str, one: Distribution | None) -> tuple[str, str]:
    if one is None:
        return "-", "-"
    quantity = QUANTITIES[name]
    return quantity.format(one.percentiles[2]), quantity.format(one.maximum)


def _rules(summary: Summary) -> Table:
    table = plain_table()
    table.add_column("rule")
    table.add_column("fails\n% of profiles", justify="right", no_wrap=True)
    table.add_column("at most\n%", justify="right", no_wrap=True)
    table.add_column("warns\n%", justify="right", no_wrap=True)
    table.add_column("most often broken by", overflow="fold")
    for rule in summary.rules:
        style = WARNED if rule.fails else ""
        shares = (percent(rule.fails_at_most), percent(rule.warns), Text(_broken(rule)))
        table.add_row(rule.title, Text(percent(rule.fails), style=style), *shares)
    return table


def _broken(rule: RuleShare) -> str:
    """The part that breaks a rule most often, and how many cannot be judged by it."""
    unknown = f"{rule.unknown} unknown" if rule.unknown else ""
    most = max(rule.exceedances, key=lambda one: one.share or 0.0, default=None)
    if most is None or not most.share:
        return unknown
    broken = f"{most.limit.component}, {percent(most.share)} %"
    return f"{broken}; {unknown}" if unknown else broken


def _worst(summary: Summary) -> Table:
    table = plain_table()
    table.add_column("worst profile by")
    table.add_column("time", no_wrap=True)
    for name in TITLES:
        quantity = QUANTITIES[QUANTITY[name]]
        heading = f"{name.replace('_', ' ')}\n{quantity.display_unit}"
        table.add_column(heading, justify="right", no_wrap=True)
    for name, profiles in summary.worst.items():
        for profile in profiles[:1]:
            figures = (QUANTITIES[QUANTITY[one]].format(getattr(profile, one)) for one in TITLES)
            table.add_row(name.replace("_", " "), when(profile.time), *figures)
    return table


def _levels(summary: Summary) -> Iterator[Table]:
    """Return levels, where there are any."""
    table = plain_table()
    table.add_column("return level, and 95 % interval")
    for period in _PERIODS:
        table.add_column(f"{period} years", justify="right", no_wrap=True)
    for response in summary.responses:
        quantity = QUANTITIES[QUANTITY[response.name]]
        for fit in response.return_levels:
            if isinstance(fit, Fit):
                levels = {level.period: level for level in fit.levels}
                said = (_level(response.name, levels.get(period)) for period in _PERIODS)
                of = f"{TITLES[response.name]} [{quantity.display_unit}]"
                table.add_row(Text(f"{of}, {METHODS_IN_SHORT[fit.method]}"), *said)
    if table.row_count:
        yield table


def _level(name: str, level: Level | None) -> str:
    if level is None:
        return "-"
    quantity = QUANTITIES[QUANTITY[name]]
    low, high = ("?" if end is None else quantity.format(end) for end in (level.low, level.high))
    return f"{quantity.format(level.level)}\n{low}–{high}"
