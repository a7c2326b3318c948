"""How likely it is that a limit is broken, design by design."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import inf

from calm.checks.finding import Finding
from calm.checks.rules import RULES
from calm.report.blocks import Cell, Column, Table
from calm.report.check.summary import place_of, say_in_unit

_NOTE = (
    "Of each rule the component that breaks its limit most often; launch, recovery and breaks are "
    "counted in the first 64 samples. A sample without equilibrium breaks every limit."
)


def likelihood_tables(named: Iterable[tuple[str, Sequence[Finding]]]) -> Iterator[Table]:
    """The designs by their greatest probability; nothing where none was counted.

    Parameters
    ----------
    named : name and findings of each design
    """
    designs = [(name, _likeliest(findings)) for name, findings in named]
    if not any(found for _, found in designs):
        return
    rows: list[tuple[Cell, ...]] = []
    for name, found in sorted(designs, key=lambda design: -_greatest(design[1])):
        likely = [each for each in found if each.probability]
        rows += [_row(name if not number else "", each) for number, each in enumerate(likely)]
        if not likely:
            rows.append((Cell(name), Cell("none in any sample"), *(Cell() for _ in range(4))))
    columns = (
        Column("design"),
        Column("rule", share=0.0),
        Column("component"),
        Column("limit", numeric=True),
        Column("where"),
        Column("broken in", "%", numeric=True),
    )
    yield Table("How likely a limit is broken", columns, tuple(rows), _NOTE)


def _row(name: str, finding: Finding) -> tuple[Cell, ...]:
    assert finding.probability is not None
    return (
        Cell(name),
        Cell(finding.rule),
        Cell(finding.component or "whole line"),
        Cell(say_in_unit(finding, finding.limit)),
        Cell(place_of(finding)),
        Cell(_percent(finding.probability), strong=finding.probability >= 0.05),
    )


def _percent(probability: float) -> str:
    percent = 100.0 * probability
    return f"{percent:.0f}" if percent >= 9.5 else f"{percent:.1f}" if percent >= 0.05 else "<0.1"


def _likeliest(findings: Sequence[Finding]) -> list[Finding]:
    """Of each rule the finding of the greatest probability, the greatest first."""
    found: dict[str, Finding] = {}
    for one in findings:
        if one.probability is not None:
            before = found.get(one.rule)
            if before is None or one.probability > (before.probability or 0.0):
                found[one.rule] = one
    order = list(RULES)
    return sorted(
        found.values(), key=lambda one: (-(one.probability or 0.0), order.index(one.rule))
    )


def _greatest(found: Sequence[Finding]) -> float:
    return (found[0].probability or 0.0) if found else -inf
