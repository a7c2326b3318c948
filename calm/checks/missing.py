"""Rule `missing`: missing values of components.

Each missing value is reported once for all affected rules and pieces.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from calm.checks.assessment import MISSING
from calm.checks.finding import Finding, MissingFigure, State, Verdict, grouped_by, rule
from calm.files import Clamp, Piece
from calm.files.rule_texts import RULES

MOST_NAMED = 3
"""Maximum number of additional pieces in a message; the finding contains the full list."""

_INSTEAD = {
    "working_load": ("breaking_load",),
    "breaking_load": ("working_load",),
    "stiffness": ("elongation",),
    "weight": ("density",),
}


def alternatives(quantity: str) -> tuple[str, ...]:
    """Return the component keys that can supply a missing value; any one of them suffices."""
    return quantity, *_INSTEAD.get(quantity, ())


@rule(MISSING)
def missing(lacking: Mapping[tuple[str, str], Sequence[Finding]]) -> Iterator[Verdict]:
    """Yield one verdict per component id and missing value, for all findings that lack the value.

    The message is copied from the finding with the largest value, such as the largest depth or
    load.
    """
    for found in lacking.values():
        figure = found[0].missing
        assert figure is not None
        worst = max(found, key=lambda one: abs(one.value or 0.0))
        others = [label for label in figure.pieces if label != worst.component]
        if len(others) > MOST_NAMED:
            others = [*others[:MOST_NAMED], f"{len(others) - MOST_NAMED} more"]
        also = f" Also affected: {_listed(others)}." if others else ""
        checks = [RULES[name].title.lower() for name in figure.needed_by]
        message = f"{worst.message} Needed for {_listed(checks)}.{also}"
        keys = " or ".join(f"`{one}`" for one in alternatives(figure.quantity))
        remedy = f"Set the {keys} of {figure.component_id}."
        yield Verdict(
            worst.component, None, None, None, State.UNKNOWN, message, remedy, worst.place,
            missing=figure,
        )  # fmt: skip


def is_lacking(finding: Finding) -> bool:
    """Return whether a finding is unknown because a value is missing.

    Accepted findings do not count.
    """
    return finding.state is State.UNKNOWN and finding.lacks is not None


def gathered(
    lacking: Iterable[Finding], parts: Mapping[str, Piece | Clamp]
) -> dict[tuple[str, str], list[Finding]]:
    """Group the findings that lack a value by component id and missing value.

    Each finding gets the `MissingFigure` of its group. `parts` maps labels to pieces and clamps.
    """

    def value(finding: Finding) -> tuple[str, str]:
        assert finding.lacks is not None
        return parts[finding.lacks.label].use, finding.lacks.quantity

    found = grouped_by(lacking, value)
    for (use, quantity), group in found.items():
        component = next(parts[one.lacks.label].component for one in group if one.lacks)
        figure = MissingFigure(
            use,
            component.kind,
            quantity,
            tuple(dict.fromkeys(one.rule for one in group)),
            tuple(dict.fromkeys(one.component for one in group if one.component)),
            tuple(dict.fromkeys(one.place for one in group if one.place)),
            component.estimates.get(quantity),
        )
        found[use, quantity] = [one.but(missing=figure) for one in group]
    return found


def with_missing(
    findings: Iterable[Finding],
    parts: Mapping[str, Piece | Clamp],
    mooring: str,
    environment: str,
) -> list[Finding]:
    """Replace the findings that lack a value with findings of the rule `missing`.

    `parts` maps labels to pieces and clamps. `mooring` and `environment` are the names in the new
    findings.
    """
    every = list(findings)
    lacking = gathered(filter(is_lacking, every), parts)
    missing_findings = [missing.find(one, mooring, environment) for one in missing.judge(lacking)]
    return [*missing_findings, *(one for one in every if not is_lacking(one))]


def _listed(names: Sequence[str]) -> str:
    first, last = names[:-1], names[-1]
    return f"{', '.join(first)} and {last}" if first else last
