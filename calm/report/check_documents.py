"""The design check as JSON, and its findings and pieces as CSV."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from calm.checks.finding import Finding, State, worst_state
from calm.checks.inventory import total_of
from calm.checks.rules import RULES
from calm.quantities import QUANTITIES
from calm.records.delimited import table_csv
from calm.report.check_facts import facts_of
from calm.report.provenance import UNJUDGED
from calm.report.result_files import members

if TYPE_CHECKING:
    from calm.checks.assessment import Assessment, Situation
    from calm.checks.backup import Loss
    from calm.checks.finding import Finding
    from calm.files.check_limits import LimitKey


def check_document(assessments: Sequence[Assessment]) -> dict[str, Any]:
    """The JSON object of a design check; what could not be solved is null.

    Returns
    -------
    dict
        `state`, the worst there is; how many findings are `estimated`; what is `accepted`, and why;
        `findings`, and as `tighter` those of other situations that leave less margin; of each
        mooring by its name the `key_figures` of page one, `launch`, `recovery`, `backup`,
        `inventory` and its `totals`, and its `document` where files give any; and `situations`,
        what was solved of each mooring in each environment.
    """
    from calm.version import __version__

    documents = {
        each.name: each.mooring.file.document.to_dict()
        for each in assessments
        if each.mooring.file.document is not None
    }
    return {
        "calm": __version__,
        **({"document": documents} if documents else {}),
        "state": worst_state(each.state for each in assessments),
        "estimated": sum(
            finding.state is State.ESTIMATED
            for each in assessments
            for finding in each.all_findings()
        ),
        "accepted": [
            _accepted(each.name, finding)
            for each in assessments
            for finding in each.accepted_findings()
        ],
        "limits": [
            {"mooring": each.name} | limit_document(key)
            for each in assessments
            for key in each.limits
        ],
        "key_figures": {each.name: facts_of(each).to_dict() for each in assessments},
        "not_judged": list(UNJUDGED),
        "findings": [
            _finding(each, finding) for each in assessments for finding in each.all_findings()
        ],
        "tighter": [
            _finding(each, finding) for each in assessments for finding in each.tighter_findings()
        ],
        "situations": {
            each.name: [
                {"environment": stand.environment, **_situation(situation)}
                for stand in each.stands
                for situation in stand.situations
            ]
            for each in assessments
        },
        "launch": {each.name: _launch(each) for each in assessments},
        "recovery": {each.name: _recovery(each) for each in assessments},
        "backup": {each.name: [asdict(one) for one in each.backup] for each in assessments},
        "losses": {each.name: [_loss(one) for one in each.losses] for each in assessments},
        "inventory": {each.name: [asdict(one) for one in each.inventory] for each in assessments},
        "totals": {each.name: asdict(total_of(each.inventory)) for each in assessments},
    }


def limit_document(key: LimitKey) -> dict[str, Any]:
    """The JSON object of a limit as used."""
    return members(key, "name", "value", "default", "source", "departs")


def _finding(assessment: Assessment, finding: Finding) -> dict[str, Any]:
    """Return a finding, with its probability if those were counted: null without a limit."""
    counted = {"probability": finding.probability} if assessment.draws else {}
    return finding.to_dict() | counted


def _accepted(mooring: str, finding: Finding) -> dict[str, Any]:
    return {
        "mooring": mooring,
        **members(finding, "rule", "component"),
        **members(finding.accept, "reason", "by", "date", "until"),
    }


def _loss(loss: Loss) -> dict[str, Any]:
    values = asdict(loss)
    del values["place"]
    return values


def _situation(situation: Situation) -> dict[str, Any]:
    said: dict[str, Any] = {"situation": situation.name}
    if situation.failure is not None:
        return said | situation.failure.to_dict()
    result = situation.result
    assert result is not None
    return {
        **said,
        **members(result, "status", "type"),
        "top_depth": result.top.depth,
        "knockdown": result.top.knockdown,
        "anchor_vertical": result.anchor.vertical,
        "anchor_horizontal": result.anchor.horizontal,
        "required_weight": result.anchor.required_weight,
        "accuracy": asdict(result.accuracy),
        "warnings": result.warnings,
    }


def _launch(assessment: Assessment) -> dict[str, Any] | None:
    launch = assessment.launch
    if launch is None:
        return None
    names = (
        "fall_speed", "fall_speed_band", "anchor_tension", "anchor_drag_known", "greatest_speed",
        "drift",
    )  # fmt: skip
    return members(launch, *names) | {"components": launch.components()}


def _recovery(assessment: Assessment) -> dict[str, Any] | None:
    recovery = assessment.recovery
    if recovery is None:
        return None
    names = ("released", "rise_speed", "time_to_surface", "net_buoyancy", "order")
    return members(recovery, *names) | {"components": recovery.components()}


_OF_FINDING = ("mooring", "environment", "situation", "rule", "component")
_TEXTS = ("message", "remedy", "source")
CHECKS_HEADER = (
    *_OF_FINDING, "state", "value", "limit", "margin", "unit", *_TEXTS, "reason", "probability",
)  # fmt: skip
"""First row of `checks_csv`; value, limit and margin are in the unit of their row."""

_OF_ITEM = (
    "index", "label", "use", "name", "role", "kind", "clamped_on", "cut_length", "dry_mass",
    "wet_weight", "lift_mass", "at",
)  # fmt: skip
INVENTORY_HEADER = (
    "mooring",
    *(QUANTITIES[name].header if name in QUANTITIES else name for name in _OF_ITEM),
)
"""First row of `inventory_csv`; weights in water are positive downward."""


def checks_csv(assessments: Sequence[Assessment]) -> str:
    """A row for every finding, of one mooring after the other; what is unknown is left empty."""
    findings = (finding for each in assessments for finding in each.all_findings())
    return table_csv(CHECKS_HEADER, map(_finding_row, findings))


def inventory_csv(assessments: Sequence[Assessment]) -> str:
    """A row for every piece and clamp, from the top of each mooring to its anchor."""
    rows = (
        [each.name, *members(item, *_OF_ITEM).values()]
        for each in assessments
        for item in each.inventory
    )
    return table_csv(INVENTORY_HEADER, rows)


def _finding_row(finding: Finding) -> Sequence[object]:
    quantity = QUANTITIES.get(RULES[finding.rule].quantity)
    return (
        *members(finding, *_OF_FINDING).values(),
        finding.state.value,
        *members(finding, "value", "limit", "margin").values(),
        quantity.unit if quantity else None,
        *members(finding, *_TEXTS).values(),
        None if finding.accept is None else finding.accept.reason,
        finding.probability,
    )
