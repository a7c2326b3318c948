"""The tables of one mooring in a design check."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import hypot
from typing import TYPE_CHECKING

from calm.checks.finding import State
from calm.checks.rules import RULES
from calm.report.blocks import Cell, Column, Prose, Table
from calm.report.check.summary import margin_of, place_of, say_in_unit, worst_by_part
from calm.report.line import figure_cell, quantity_column

if TYPE_CHECKING:
    from calm.checks.assessment import Stand
    from calm.checks.finding import Finding

_RESULTS = (
    "depth",
    "knockdown",
    "offset",
    "tilt",
    "tension",
    "vertical",
    "horizontal",
    "required_weight",
)


def results_table(stands: Sequence[Stand]) -> Table:
    """The mooring as given in each environment: its top, and the pull on its anchor."""
    columns = (Column("environment"), *map(quantity_column, _RESULTS))
    note = "Depth, knockdown and offset: of the top. Tilt and tension: the greatest in the line."
    return Table("Results by environment", columns, tuple(map(_standing, stands)), note)


def _standing(stand: Stand) -> tuple[Cell, ...]:
    result = stand.result
    if result is None:
        failure = stand.situations[0].failure
        status = failure.status if failure else ""
        return (Cell(stand.environment, status, State.FAIL), *(Cell("-") for _ in _RESULTS))
    top, anchor = result.top, result.anchor
    figures = {
        "depth": top.depth,
        "knockdown": top.knockdown,
        "offset": hypot(top.x, top.y),
        "tilt": float(result.components.tilt.max()),
        "tension": float(result.components.tension.max()),
        "vertical": anchor.vertical,
        "horizontal": anchor.horizontal,
        "required_weight": anchor.required_weight,
    }
    return (Cell(stand.environment), *(figure_cell(name, figures[name]) for name in _RESULTS))


def checks_table(findings: Iterable[Finding]) -> Iterator[Table | Prose]:
    """The worst finding of each rule on each component, and the sources of the rules."""
    kept = worst_by_part(findings)
    sources = list(dict.fromkeys(finding.source for finding in kept))
    rows = tuple(
        (
            Cell(finding.state.value, state=finding.state),
            Cell(RULES[finding.rule].title),
            Cell(finding.component or "whole line"),
            Cell(say_in_unit(finding, finding.value)),
            Cell(say_in_unit(finding, finding.limit)),
            Cell(margin_of(finding)),
            Cell(place_of(finding)),
            _said(finding),
            Cell(str(sources.index(finding.source) + 1)),
        )
        for finding in kept
    )
    columns = (
        Column("state", share=0.0),
        Column("rule", share=1.3),
        Column("component"),
        Column("value", numeric=True),
        Column("limit", numeric=True),
        Column("margin", numeric=True),
        Column("environment, situation"),
        Column("finding and remedy", share=2.5),
        Column("source", numeric=True),
    )
    note = "Each component where it is worst; every finding is in checks.csv and report.json."
    yield Table("Worst finding of each rule on each component", columns, rows, note, sortable=True)
    yield Prose(tuple(f"{number}. {source}" for number, source in enumerate(sources, 1)))


def _said(finding: Finding) -> Cell:
    """What was found and what to do; the figures of a pass say it all, and so does a remedy that
    names the figure missing."""
    if finding.state is State.PASS:
        return Cell()
    if finding.state is State.UNKNOWN and finding.remedy:
        return Cell(finding.remedy)
    return Cell(finding.message, finding.remedy or "")
