"""Results of a design check as JSON and CSV files."""

from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from dataclasses import asdict
from typing import Any

from calm.checks.assess import RULES
from calm.checks.assessment import Assessment, Situation
from calm.checks.finding import (
    Conclusion,
    Finding,
    State,
    governing,
    governing_of_each_rule,
    grouped_by,
    worst_state,
)
from calm.checks.inventory import total_of
from calm.checks.recovery import Recovery
from calm.drop.launch import Launch
from calm.files.check_limits import LimitKey
from calm.quantities import QUANTITIES
from calm.records.delimited import table_csv
from calm.report import provenance
from calm.report.check_facts import key_figures
from calm.report.check_tables import GRAVE, counted_as
from calm.report.result_files import members
from calm.version import __version__

MUCH_USED = 0.5
"""Utilisation above which a passing finding is listed even if it does not govern its rule."""


def listed_findings(
    assessment: Assessment, *, every: bool = False
) -> Iterator[tuple[Finding, bool]]:
    """Yield the findings to list for a mooring, each with a flag that marks governing findings.

    The finding with the largest utilisation governs. The list contains:

    - the governing finding of each rule, flagged
    - the governing finding of each rule on each component, unless it passes with a utilisation
      below `MUCH_USED`
    - the failures, unknowns and warnings in each environment

    A cluster of equal floats counts as one component. `every` lists all findings.
    """
    found = [*assessment.every_finding()]
    leading = {id(one) for one in governing_of_each_rule(found)}
    leads = map(governing, grouped_by(found, _entry_key).values())
    kept = leading | {
        id(lead)
        for lead in leads
        if lead.state is not State.PASS or (lead.utilisation or 0.0) >= MUCH_USED
    }
    for one in found:
        if every or id(one) in kept:
            yield one, id(one) in leading


def _entry_key(finding: Finding) -> Hashable:
    if finding.state not in GRAVE:
        return finding.rule, finding.state, finding.place
    place = finding.case if finding.case == "0" else finding.environment
    return *counted_as(finding), place


def check_document(assessments: Sequence[Assessment], *, every: bool = False) -> dict[str, Any]:
    """Return the JSON object of a design check; results without a solution are null.

    The values of `key_figures`, and of `situations` and all later keys, are objects with one entry
    per mooring, by name. Less obvious keys are:

    - `estimated`: number of findings based on estimates
    - `findings`, `findings_in_all`: listed findings, and number of all findings
    - `key_figures`: values of page one
    - `launch`, `recovery`: deployment, and ascent after release
    - `backup`, `losses`: net buoyancy after a break of the line, and after the loss of a float

    `findings` are those of `listed_findings`, or all if `every` is true.
    """

    def by_name(value_of: Callable[[Assessment], Any]) -> dict[str, Any]:
        return {each.name: value_of(each) for each in assessments}

    def listed(value_of: Callable[[Assessment], Iterable[Any]]) -> list[Any]:
        return [one for each in assessments for one in value_of(each)]

    in_environments = [checked for each in assessments for checked in each.in_environments]
    given = by_name(lambda each: each.file.document)
    documents = {name: one.to_dict() for name, one in given.items() if one is not None}
    return {
        "calm": __version__,
        **({"document": documents} if documents else {}),
        "verdict": max((each.verdict for each in assessments), key=[*Conclusion].index),
        "state": worst_state(each.state for each in assessments),
        "estimated": sum(one.state is State.ESTIMATED for one in listed(Assessment.all_findings)),
        "accepted": listed(_accepted_documents),
        "limits": listed(
            lambda each: ({"mooring": each.name} | limit_document(key) for key in each.limits)
        ),
        "key_figures": by_name(key_figures),
        "not_judged": provenance.unjudged(one.leg.file.environment for one in in_environments),
        "findings": listed(lambda each: _finding_documents(each, every)),
        "findings_in_all": len(listed(Assessment.every_finding)),
        "situations": by_name(
            lambda each: [
                {"environment": checked.environment, **_situation_document(situation)}
                for checked in each.in_environments
                for situation in checked.situations
            ]
        ),
        "launch": by_name(lambda each: _handling_document(each.launch, _OF_LAUNCH)),
        "recovery": by_name(lambda each: _handling_document(each.recovery, _OF_RECOVERY)),
        "backup": by_name(lambda each: [*map(asdict, each.backup)]),
        "losses": by_name(lambda each: [members(one, *_OF_LOSS) for one in each.losses]),
        "inventory": by_name(lambda each: [*map(asdict, each.inventory)]),
        "totals": by_name(lambda each: asdict(total_of(each.inventory))),
    }


def limit_document(key: LimitKey) -> dict[str, Any]:
    """Return the JSON object that describes a limit, with the value used in the design check."""
    return members(key, "name", "value", "default", "source", "departs")


def _finding_documents(assessment: Assessment, every: bool) -> Iterator[dict[str, Any]]:
    for one, leads in listed_findings(assessment, every=every):
        counted = members(one, "probability") if assessment.draws else {}
        yield one.to_dict() | {"governing": leads} | counted


def _accepted_documents(assessment: Assessment) -> Iterator[dict[str, Any]]:
    for one in assessment.accepted_findings():
        by = members(one.accept, "reason", "by", "date", "until", "load")
        yield {"mooring": assessment.name, **members(one, "rule", "component"), **by}


def _situation_document(situation: Situation) -> dict[str, Any]:
    document: dict[str, Any] = {"situation": situation.name}
    if situation.failure is not None:
        return document | situation.failure.to_dict()
    result = situation.result
    assert result is not None
    return {
        **document,
        **members(result, "status", "type"),
        "top_depth": result.top.depth,
        "knockdown": result.top.knockdown,
        "anchor_vertical": result.anchor_load.vertical,
        "anchor_horizontal": result.anchor_load.horizontal,
        "required_weight": result.anchor_load.required_weight,
        "accuracy": asdict(result.accuracy),
        "warnings": result.warnings,
    }


_OF_LAUNCH = (
    "fall_speed", "fall_speed_band", "anchor_tension", "anchor_drag_known", "greatest_speed",
    "drift",
)  # fmt: skip
_OF_LOSS = ("index", "label", "margin", "weight_lifted", "required")
_OF_RECOVERY = ("released", "rise_speed", "time_to_surface", "net_buoyancy", "order")


def _handling_document(
    handling: Launch | Recovery | None, names: Sequence[str]
) -> dict[str, Any] | None:
    return (
        None
        if handling is None
        else members(handling, *names) | {"components": handling.components()}
    )


_OF_FINDING = ("mooring", "environment", "situation", "case", "rule", "component")
_FIGURES = ("value", "sense", "limit", "margin", "utilisation")
_TEXTS = ("message", "remedy", "source")
CHECKS_HEADER = (
    *_OF_FINDING, "state", "governing", *_FIGURES, "unit", *_TEXTS, "reason", "probability",
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


def checks_csv(assessments: Sequence[Assessment], *, every: bool = False) -> str:
    """Write the listed findings of all moorings as CSV; unknown values are empty.

    Parameters
    ----------
    every : whether to list every finding, as in `check_document`
    """
    rows = (
        _finding_row(*listed)
        for each in assessments
        for listed in listed_findings(each, every=every)
    )
    return table_csv(CHECKS_HEADER, rows)


def inventory_csv(assessments: Sequence[Assessment]) -> str:
    """Write the inventory of moorings as CSV, with one row per piece and clamp.

    Each mooring is listed from its top to its anchor.
    """
    rows = (
        [each.name, *members(item, *_OF_ITEM).values()]
        for each in assessments
        for item in each.inventory
    )
    return table_csv(INVENTORY_HEADER, rows)


def _finding_row(finding: Finding, leads: bool) -> Sequence[object]:
    quantity = QUANTITIES.get(RULES[finding.rule].quantity)
    return (
        *members(finding, *_OF_FINDING).values(),
        finding.state.value,
        "yes" if leads else "no",
        *members(finding, *_FIGURES).values(),
        quantity.unit if quantity else None,
        *members(finding, *_TEXTS).values(),
        None if finding.accept is None else finding.accept.reason,
        finding.probability,
    )
