"""The findings and the pieces of a design check as CSV."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from calm.checks.finding import Finding
from calm.checks.rules import RULES
from calm.quantities import QUANTITIES
from calm.records.csv_writer import table_csv

if TYPE_CHECKING:
    from calm.checks.assessment import Assessment

CHECKS_HEADER = (
    "mooring",
    "environment",
    "situation",
    "rule",
    "component",
    "state",
    "value",
    "limit",
    "margin",
    "unit",
    "message",
    "remedy",
    "source",
    "reason",
    "probability",
)
"""First row of `checks_csv`; value, limit and margin are in the unit of their row."""

INVENTORY_HEADER = (
    "mooring",
    "index",
    "label",
    "use",
    "name",
    "role",
    "kind",
    "clamped_on",
    QUANTITIES["cut_length"].header,
    *(QUANTITIES[name].header for name in ("dry_mass", "wet_weight", "lift_mass", "at")),
)
"""First row of `inventory_csv`; weights in water are positive downward."""


def checks_csv(assessments: Sequence[Assessment]) -> str:
    """A row for every finding, of one mooring after the other; what is unknown is left empty."""
    findings = (finding for each in assessments for finding in each.all_findings())
    return table_csv(CHECKS_HEADER, map(_finding, findings))


def inventory_csv(assessments: Sequence[Assessment]) -> str:
    """A row for every piece and clamp, from the top of each mooring to its anchor."""
    return table_csv(INVENTORY_HEADER, (row for each in assessments for row in _items(each)))


def _finding(finding: Finding) -> Sequence[object]:
    quantity = QUANTITIES.get(RULES[finding.rule].quantity)
    return (
        finding.mooring,
        finding.environment,
        finding.situation,
        finding.rule,
        finding.component,
        finding.state.value,
        finding.value,
        finding.limit,
        finding.margin,
        quantity.unit if quantity else None,
        finding.message,
        finding.remedy,
        finding.source,
        None if finding.accept is None else finding.accept.reason,
        finding.probability,
    )


def _items(assessment: Assessment) -> Iterator[Sequence[object]]:
    for item in assessment.inventory:
        yield (
            assessment.name,
            item.index,
            item.label,
            item.use,
            item.name,
            item.role,
            item.kind,
            item.clamped_on,
            item.cut_length,
            item.dry_mass,
            item.wet_weight,
            item.lift_mass,
            item.at,
        )
