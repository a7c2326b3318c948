"""The tables of one mooring in a design check: findings, handling, parts, likelihood.

In short they are the matrix, the worst of each rule, and what to mend.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from math import hypot, inf, isnan
from typing import Any

from calm.case import Result
from calm.checks.assess import RULES
from calm.checks.assessment import Assessment, MooringInEnvironment
from calm.checks.finding import Finding, State
from calm.checks.inventory import InventoryItem
from calm.checks.recovery import Break
from calm.drawing.schematic.shown_parts import place_text
from calm.files import Piece
from calm.files.components import FLEXIBLE_KINDS
from calm.physics.line import Floats
from calm.quantities import QUANTITIES, say
from calm.report.blocks import (
    Block,
    Cell,
    Column,
    Field,
    Heading,
    Line,
    Note,
    Pairs,
    Prose,
    ReportPart,
    Span,
    Table,
    table_of,
)
from calm.report.check_facts import CheckFacts, judged_section, key_pairs, settled_tables
from calm.report.check_summary import (
    grouped,
    joined,
    margin_of,
    matrix_tables,
    named,
    named_components,
    place_of,
    said_of,
    say_in_unit,
    state_cell,
    verdict_prose,
    worst_by_part,
    worst_table,
)
from calm.report.provenance import unseen
from calm.report.sheet import figure_cell, quantity_column, quantity_field

_RESULTS: dict[str, Callable[[Result], float | None]] = {
    "depth": lambda result: result.top.depth,
    "knockdown": lambda result: result.top.knockdown,
    "offset": lambda result: hypot(result.top.x, result.top.y),
    "tilt": lambda result: float(result.components.tilt.max()),
    "tension": lambda result: float(result.components.tension.max()),
    "vertical": lambda result: result.anchor.vertical,
    "horizontal": lambda result: result.anchor.horizontal,
    "required_weight": lambda result: result.anchor.required_weight,
}


def results_table(stands: Sequence[MooringInEnvironment]) -> Table:
    """The mooring as given in each environment: its top, and the pull on its anchor."""

    def figure(name: str) -> Field[MooringInEnvironment]:
        of = _RESULTS[name]
        return quantity_column(name), lambda stand: figure_cell(
            name, None if stand.result is None else of(stand.result)
        )

    def status(stand: MooringInEnvironment) -> Cell:
        failure, state = stand.situations[0].failure, None if stand.result else State.FAIL
        return Cell(stand.environment, failure.status if failure else "", state)

    return table_of(
        "Results by environment",
        stands,
        (Column("environment"), status),
        *map(figure, _RESULTS),
        note="Depth, knockdown and offset are of the top; tilt and tension are the greatest "
        "in the line.",
    )


def checks_table(findings: Iterable[Finding]) -> Iterator[Table | Prose]:
    """The worst finding of each rule on each component, and the sources of the rules."""
    kept = worst_by_part(findings)
    sources = list(dict.fromkeys(finding.source for finding in kept))
    yield table_of(
        "Worst finding of each rule on each component",
        joined(kept),
        (Column("state", share=0.0), lambda found: state_cell(found[0])),
        (
            Column("rule"),
            lambda found: Cell(
                RULES[found[0].rule].title, f"[{sources.index(found[0].source) + 1}]"
            ),
        ),
        (Column("component", share=1.8), _placed),
        (Column("value", numeric=True), lambda found: say_in_unit(found[0], found[0].value)),
        (Column("limit", numeric=True), lambda found: say_in_unit(found[0], found[0].limit)),
        (Column("margin", numeric=True), lambda found: margin_of(found[0])),
        (Column("finding and remedy", share=2.5), lambda found: said_of(found[0])),
        note="Components with the same finding share a row, which shows the worst of them; "
        "every finding is in checks.csv and report.json. [1] is the first source below "
        "the table.",
        sortable=True,
    )
    yield Prose(tuple(f"[{number}] {source}" for number, source in enumerate(sources, 1)))


def _placed(found: Sequence[Finding]) -> Cell:
    """The components, and where the first, the worst, has its figures."""
    place = place_of(found[0])
    where = f"{found[0].component}, {place}" if len(found) > 1 else place
    return Cell(named_components(found), where)


def breaks_table(backup: Sequence[Break]) -> Table:
    """Return what would float the release up again after each break."""
    return table_of(
        "Back-up buoyancy",
        backup,
        (Column("no.", numeric=True), lambda one: str(one.break_after)),
        (Column("break below"), lambda one: one.label),
        quantity_field("wet_weight", "weight_lifted", "weight lifted"),
        quantity_field("net_buoyancy", "margin", "buoyancy left over"),
        quantity_field("net_buoyancy", "required", "required"),
        quantity_field("net_buoyancy", "loose", "comes loose"),
        (Column("judged"), lambda one: "yes" if one.judged else "no"),
        note="Breaks inside the lowest cluster of floats, or between it and the release, "
        "leave the release on the seabed in any design and are not judged. Comes loose: "
        "the net buoyancy of the part that drifts off, before a release opens.",
    )


def handling_summary(assessment: Assessment) -> Pairs:
    """The launch and the recovery in a few figures."""
    pairs, launch, recovery = [], assessment.launch, assessment.recovery
    if launch is not None:
        low, high = (say("speed", speed) for speed in launch.fall_speed_band)
        speed = f"{say('speed', launch.fall_speed)}; {low} to {high} with twice and half the drag"
        pairs = [
            ("Launch, anchor last: speed at touchdown", f"{speed} of line and anchor"),
            ("Pull of the falling anchor", say("tension", launch.anchor_tension)),
        ]
        if not launch.anchor_drag_known:
            pairs.append(("Drag of the anchor", "unknown; taken as that of a cube of its volume"))
    if recovery is not None:
        time, still = recovery.time_to_surface, " in still water" * recovery.in_still_water
        pairs += [
            ("Recovery: net buoyancy above the release", say("vertical", recovery.net_buoyancy)),
            ("Speed of the rise", say("speed", recovery.rise_speed) + still),
            ("Time to the surface", "-" if time is None else f"{time / 60:.1f} min"),
        ]
    return Pairs(tuple(pairs))


def handling_table(assessment: Assessment) -> Table:
    """Tensions of each piece on its way down and up, and when and where it ends."""

    def figures(name: str, heading: str, values: Floats) -> Field[Piece]:
        column = quantity_column(name, heading)
        return column, lambda piece: figure_cell(name, float(values[piece.index]))

    fields: list[Field[Piece]] = []
    if (launch := assessment.launch) is not None:
        fields += [
            figures("tension", "launch, upper end", launch.tension_top),
            figures("tension", "launch, lower end", launch.tension_bottom),
        ]
    if (recovery := assessment.recovery) is not None:
        arrival = recovery.arrival / 60.0
        fields += [
            figures("tension", "recovery, upper end", recovery.tension_top),
            figures("tension", "recovery, lower end", recovery.tension_bottom),
            (
                Column("at the surface after", "min", True),
                lambda piece: "" if isnan(arrival[piece.index]) else f"{arrival[piece.index]:.1f}",
            ),
            figures("depth", "hangs at depth", recovery.hangs_at),
        ]
    return table_of(
        "Tensions in the launch and the rise",
        assessment.mooring.file.pieces[:-1],
        (Column("no.", numeric=True), lambda piece: str(piece.index)),
        (Column("piece"), lambda piece: piece.label),
        *fields,
    )


def deck_table(items: Sequence[InventoryItem]) -> Table:
    """Pieces in the order in which they come to the deck, with their weights and lifts."""
    return table_of(
        "Pieces for the deck",
        items,
        (Column("no.", numeric=True), lambda one: "" if one.clamped_on else str(one.index)),
        (Column("piece"), lambda one: Cell(one.label, indented=one.clamped_on is not None)),
        (Column("component"), lambda one: one.name or one.use),
        (
            Column("on its piece", "m", numeric=True),
            lambda one: "" if one.at is None else place_text(one.at),
        ),
        *map(quantity_field, ("cut_length", "dry_mass", "wet_weight", "lift_mass")),
        note="On its piece: distance of a clamp from the upper end. Weight in water is "
        "positive down. Mass of the lift: of the piece with its clamps.",
    )


def inventory_table(items: Sequence[InventoryItem]) -> Table:
    """Return how many and how much of each component is needed, with room for the spares."""
    note = "Cut lengths are of wires, ropes and chains. Spares are filled in by hand."
    if any(item.dry_mass is None for item in items):
        note += " ≥ marks a lower bound, because masses in air are missing: plan no lift on it."

    def named(group: Sequence[InventoryItem]) -> str:
        return "Total" if group is items else group[0].name or group[0].use

    return table_of(
        "Inventory",
        grouped(items, lambda item: item.use),
        (Column("component"), named),
        (Column("id"), lambda group: "" if group is items else group[0].use),
        (Column("pieces", numeric=True), lambda group: str(len(group))),
        (
            quantity_column("cut_length"),
            lambda group: _sum("cut_length", [e for e in group if e.kind in FLEXIBLE_KINDS]),
        ),
        (quantity_column("dry_mass"), lambda group: _sum("dry_mass", group)),
        (quantity_column("wet_weight"), lambda group: _sum("wet_weight", group)),
        (Column("spares"), lambda group: ""),
        note=note,
        sums=[items],
        by_hand=True,
    )


def _sum(name: str, items: Sequence[InventoryItem]) -> Cell:
    """The sum of what is known, and how much is not; of masses that is the least there can be."""
    values = [getattr(item, name) for item in items]
    known = [value for value in values if value is not None]
    missing = len(values) - len(known)
    if not known:
        return Cell("-")
    least = "≥ " if missing and name == "dry_mass" else ""
    text = f"{least}{QUANTITIES[name].format(sum(known))}"
    return Cell(text, f"{missing} unknown" if missing else "")


_NOTE = (
    "Each rule is shown for the component that breaks its limit most often; launch, recovery and "
    "breaks are counted in the first 64 samples. A sample without equilibrium breaks every limit."
)


def likelihood_tables(named: Iterable[tuple[str, Sequence[Finding]]]) -> Iterator[Table]:
    """The designs, by name, by their greatest probability; nothing where none was counted."""
    designs = [(name, _likeliest(findings)) for name, findings in named]
    if not any(found for _, found in designs):
        return
    rows: list[tuple[str, Finding | None]] = []
    for name, found in sorted(
        designs, key=lambda one: -(one[1][0].probability or 0.0) if one[1] else inf
    ):
        likely = [each for each in found if each.probability]
        names = (name, *("" for _ in likely[1:]))
        rows += zip(names, likely or (None,), strict=True)

    def known(show: Callable[[Finding], Cell | str]) -> Callable[[tuple[str, Finding | None]], Any]:
        return lambda row: "" if row[1] is None else show(row[1])

    yield table_of(
        "Probability of breaking a limit",
        rows,
        (Column("design"), lambda row: row[0]),
        (
            Column("rule", share=0.0),
            lambda row: "none in any sample" if row[1] is None else row[1].rule,
        ),
        (Column("component"), known(lambda one: one.component or "whole line")),
        (Column("limit", numeric=True), known(lambda one: say_in_unit(one, one.limit))),
        (Column("where"), known(place_of)),
        (Column("broken in", "%", numeric=True), known(_share)),
        note=_NOTE,
    )


def _share(finding: Finding) -> Cell:
    percent = 100.0 * (finding.probability or 0.0)
    text = f"{percent:.0f}" if percent >= 9.5 else f"{percent:.1f}" if percent >= 0.05 else "<0.1"
    return Cell(text, strong=percent >= 5.0)


def _likeliest(findings: Sequence[Finding]) -> list[Finding]:
    """Return the finding of each rule with the greatest probability, the greatest first."""
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


_SIGNS = {State.FAIL: "!", State.WARN: "~", State.UNKNOWN: "?"}
_TOLD = 12
"""Most failures, or warnings, shown of a mooring; a report has them all."""
_LACKING = 60
"""Most components named that lack a figure."""


def check_part(assessments: Sequence[Assessment]) -> ReportPart:
    """Everything that a design check says in short.

    Moorings by environments with the worst state in each; what decides, what is accepted and what
    departs of each; of each rule the finding with the worst margin; every failure and warning with
    its figures and remedy. No rule hangs on colour.
    """
    sections = [judged_section(each) for each in assessments]
    facts = [each.facts for each in sections if each.facts is not None]
    blocks = (
        *(replace(each, title="", note="") for each in matrix_tables(sections)),
        verdict_prose(finding for each in facts for finding in each.findings),
        *(block for each in facts for block in _decisive(each, several=len(facts) > 1)),
        replace(worst_table(sections), title=""),
        *likelihood_tables([(each.name, [*each.all_findings()]) for each in assessments]),
        *(block for each in facts for block in _told(each)),
    )
    return ReportPart(
        "", (*blocks, Note(unseen(each for one in facts for each in one.findings)[:1]))
    )


def _decisive(facts: CheckFacts, *, several: bool) -> Iterator[Block]:
    """What decides of a mooring, what is accepted, and what departs."""
    if several:
        yield Heading(facts.mooring)
    yield key_pairs(facts)
    yield from settled_tables(facts)


def _told(facts: CheckFacts) -> Iterator[Block]:
    """Return what a mooring fails or is warned of, the gravest first with its remedy; what is
    missing.
    """
    listed = joined(one for one in worst_by_part(facts.findings) if one.state in _SIGNS)
    if not listed:
        return
    lines: list[Line] = []
    for state, groups in groupby(listed, key=lambda found: found[0].state):
        found = list(groups)
        most = len(found) if state is State.UNKNOWN else _TOLD
        lines += map(_sentence, found[:most])
        if len(found) > most:
            lines.append(f"  and {len(found) - most} more that {state}; --json has them")
    yield Heading(facts.mooring)
    yield Prose(tuple(lines))


def _sentence(found: Sequence[Finding]) -> Line:
    """What is found alike of some components, told of the worst of them."""
    worst = found[0]
    sign, quiet = Span(f"{_SIGNS[worst.state]} ", worst.state), worst.state is not State.FAIL
    if worst.state is State.UNKNOWN and worst.component is not None and worst.limit is None:
        names = named((one.component or "" for one in found), _LACKING)
        return sign, Span(f"{worst.rule} of {names} is unknown. {worst.remedy}", quiet=True)
    others = "" if len(found) == 1 else f" The same holds for {named_components(found[1:])}."
    told = Span(f"{worst.rule}, {place_of(worst)}: {worst.message}{others}")
    return (sign, told, Span(f" {worst.remedy}", quiet=quiet)) if worst.remedy else (sign, told)
