"""Tables of the design check: findings, limits and inventory, and texts that group findings."""

import re
from collections import Counter
from collections.abc import Hashable, Iterable, Iterator, Sequence
from itertools import groupby
from operator import attrgetter

from calm.checks.assess import RULES
from calm.checks.criterion import limit_value_text
from calm.checks.finding import Finding, State, grouped_by, worst_of
from calm.checks.inventory import InventoryItem
from calm.files.check_limits import LimitKey
from calm.files.components import FLEXIBLE_KINDS
from calm.quantities import QUANTITIES
from calm.report import blocks
from calm.report.blocks import Cell, Field, Table, number, quantity, table_of, words


def worst_by_part(findings: Iterable[Finding]) -> list[Finding]:
    """Select the most severe finding of each rule on each component, most severe first."""
    groups = grouped_by(findings, lambda each: (each.rule, each.place, each.missing))
    return sorted(map(worst_of, groups.values()), key=attrgetter("rank"))


def joined(findings: Iterable[Finding]) -> list[list[Finding]]:
    """Group findings of one rule that differ only in component and values.

    Unknown findings form a group for each missing value. Failures of a rule on the anchor form one
    group.
    """

    def cause(one: Finding) -> Hashable:
        same = RULES[one.rule].of_anchor and one.state is State.FAIL
        return one.rule, one.state, one.missing or same or _message_without_values(one)

    return [*grouped_by(findings, cause).values()]


def _message_without_values(finding: Finding) -> str:
    text = f"{finding.message} {finding.remedy or ''}"
    if finding.component is not None:
        text = text.replace(finding.component, "")
    return re.sub(r"-?\d[\d.]*(?: k?N\b)?", "#", text)


def named(labels: Iterable[str], most: int = 3) -> str:
    """Join labels, with consecutive numbers as a range, such as ``glass 1 to 4, cable``.

    At most `most` names are listed, followed by the number of omitted labels. A range counts as a
    single name.
    """
    numbered: dict[str, list[int]] = {}
    for label in labels:
        match = re.fullmatch(r"(.+ )([1-9]\d{0,5})", label)
        stem, number = match.groups() if match else (label, "0")
        numbered.setdefault(stem, []).append(int(number))
    runs = [run for stem, numbers in numbered.items() for run in _runs(stem, numbers)]
    left = sum(count for _, count in runs[most:])
    return ", ".join(name for name, _ in runs[:most]) + (f" and {left} more" if left else "")


def _runs(stem: str, numbers: Iterable[int]) -> Iterator[tuple[str, int]]:
    """Yield the label and the length of each run of consecutive numbers.

    An example of a label is "glass 1 to 4".
    """
    each = sorted(set(numbers))
    for _, group in groupby(enumerate(each), lambda pair: pair[1] - pair[0]):
        run = [number for _, number in group]
        last = f"{' and ' if len(run) == 2 else ' to '}{run[-1]}" if len(run) > 1 else ""
        yield f"{stem}{run[0] or ''}{last}", len(run)


def named_components(findings: Iterable[Finding]) -> str:
    """Join the labels of the components that findings concern."""
    return named(one.component or "whole line" for one in findings)


def counted_states(findings: Iterable[Finding]) -> Counter[State]:
    """Count the results of rules on components by state, for one or several moorings.

    A rule counts once per component, with its most severe state. Equal pieces from one row of the
    file count once per rule if they fail or have a warning. A missing value counts once.
    """
    by_mooring = grouped_by(findings, attrgetter("mooring")).values()
    groups = (grouped_by(worst_by_part(each), counted_as).values() for each in by_mooring)
    return Counter(one[0].state for each in groups for one in each)


GRAVE = (State.FAIL, State.UNKNOWN, State.WARN)
"""States for which the engineer has to act."""


def counted_as(finding: Finding) -> tuple[Hashable, ...]:
    """Return the key by which `counted_states` groups findings.

    Equal pieces from one row of the file share a key for each rule. This applies only to findings
    with a state in `GRAVE`.
    """
    place = finding.place
    if finding.missing is not None or place is None or finding.state not in GRAVE:
        return (id(finding),)
    called = re.sub(r" \d+$", "", finding.component or "")
    return finding.rule, finding.state, place.row, called


def limits_table(limits: Iterable[LimitKey], title: str = "Limits as used") -> Table:
    """Tabulate limits with their defaults and sources, beginning with the changed limits."""
    departs = Cell("changed", state=State.WARN)
    return table_of(
        title,
        sorted(limits, key=lambda key: not key.departs),
        words("", lambda key: departs if key.departs else None, 0.0),
        words("limit", "name", 1.2),
        number("value", lambda key: limit_value_text(key, key.value)),
        number("default", lambda key: limit_value_text(key, key.default)),
        words("source of the default", "source", 2.0),
        note="The mooring file sets the limits that differ from their defaults; it gives no "
        "sources for them.",
    )


def component_text(name: str, units: int) -> str:
    """Format the name of a component, and the number of its units if there are several.

    For example, a pair of releases has two units.
    """
    return f"{name}, {units} units each" if units > 1 else name


def inventory_table(items: Sequence[InventoryItem]) -> Table:
    """Tabulate number and amount of each component, with an empty column for spares."""
    note = "Cut lengths apply to wire, rope and chain. Enter spares by hand."
    if any(item.dry_mass is None for item in items):
        note += (
            " ≥ marks a lower bound, because some masses are unknown: do not use it to plan lifts."
        )

    def summed(name: str) -> Field:
        return quantity(name, lambda group: None)[0], lambda group: _sum_cell(name, group)

    return table_of(
        "Inventory",
        grouped_by(items, lambda item: item.use).values(),
        words(
            "component",
            lambda group: (
                "Total"
                if group is items
                else component_text(group[0].name or group[0].use, group[0].items)
            ),
        ),
        words("id", lambda each: None if each is items else each[0].use),
        number("pieces", len),
        *map(summed, ("cut_length", "dry_mass", "wet_weight")),
        blocks.blank("spares"),
        note=note,
        sums=[items],
        by_hand=True,
    )


def _sum_cell(name: str, items: Sequence[InventoryItem]) -> Cell:
    if name == "cut_length":
        items = [each for each in items if each.kind in FLEXIBLE_KINDS]
    known = [value for item in items if (value := getattr(item, name)) is not None]
    missing = len(items) - len(known)
    if not known:
        return Cell("-")
    least = "≥ " if missing and name == "dry_mass" else ""
    text = f"{least}{QUANTITIES[name].format(sum(known))}"
    return Cell(text, f"{missing} unknown" if missing else "")
