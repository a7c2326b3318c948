"""The tables of one mooring in a design check: findings, handling, parts, likelihood.

In short they are the matrix, the worst of each rule, and what to mend.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
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
from calm.files.components import FLEXIBLE_KINDS
from calm.physics.line import Floats
from calm.quantities import QUANTITIES, say
from calm.report import blocks, check_facts, check_summary
from calm.report.blocks import Cell, Field, Prose, Span, Table, number, quantity, table_of, words
from calm.report.check_facts import CheckFacts
from calm.report.check_summary import grouped, joined, place_of
from calm.report.provenance import unseen

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

    def figure(stand: MooringInEnvironment, name: str) -> float | None:
        return None if stand.result is None else _RESULTS[name](stand.result)

    def status(stand: MooringInEnvironment) -> Cell:
        failure, state = stand.situations[0].failure, None if stand.result else State.FAIL
        return Cell(stand.environment, failure.status if failure else "", state)

    return table_of(
        "Results by environment",
        stands,
        words("environment", status),
        *(quantity(name, partial(figure, name=name)) for name in _RESULTS),
        note="Depth, knockdown and offset are of the top; tilt and tension are the greatest "
        "in the line.",
    )


def checks_table(findings: Iterable[Finding]) -> Iterator[Table | Prose]:
    """The worst finding of each rule on each component, and the sources of the rules."""
    kept = check_summary.worst_by_part(findings)
    sources = list(dict.fromkeys(finding.source for finding in kept))

    def rule(found: Sequence[Finding]) -> Cell:
        return Cell(RULES[found[0].rule].title, f"[{sources.index(found[0].source) + 1}]")

    def component(found: Sequence[Finding]) -> Cell:
        """The components, and where the first, the worst, has its figures."""
        place = place_of(found[0])
        where = f"{found[0].component}, {place}" if len(found) > 1 else place
        return Cell(check_summary.named_components(found), where)

    state, *figures = check_summary.FIGURES
    yield table_of(
        "Worst finding of each rule on each component",
        joined(kept),
        *blocks.of_first(state),
        words("rule", rule),
        words("component", component, 1.8),
        *blocks.of_first(*figures),
        *blocks.of_first(words("finding and remedy", check_summary.said_of, 2.5)),
        note="Components with the same finding share a row, which shows the worst of them; "
        "every finding is in checks.csv and report.json. [1] is the first source below "
        "the table.",
        sortable=True,
    )
    yield Prose(tuple(f"[{number}] {source}" for number, source in enumerate(sources, 1)))


def breaks_table(backup: Sequence[Break]) -> Table:
    """Return what would float the release up again after each break."""
    return table_of(
        "Back-up buoyancy",
        backup,
        number("no.", "break_after"),
        words("break below", "label"),
        quantity("wet_weight", "weight_lifted", "weight lifted"),
        quantity("net_buoyancy", "margin", "buoyancy left over"),
        quantity("net_buoyancy", "required", "required"),
        quantity("net_buoyancy", "loose", "comes loose"),
        words("judged", lambda one: "yes" if one.judged else "no"),
        note="Breaks inside the lowest cluster of floats, or between it and the release, "
        "leave the release on the seabed in any design and are not judged. Comes loose: "
        "the net buoyancy of the part that drifts off, before a release opens.",
    )


def handling_summary(assessment: Assessment) -> blocks.Pairs:
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
    return blocks.Pairs(tuple(pairs))


def handling_table(assessment: Assessment) -> Table:
    """Tensions of each piece on its way down and up, and when and where it ends."""

    def figures(name: str, heading: str, values: Floats) -> Field:
        return quantity(name, lambda piece: float(values[piece.index]), heading)

    fields: list[Field] = []
    if (launch := assessment.launch) is not None:
        fields += [
            figures("tension", "launch, upper end", launch.tension_top),
            figures("tension", "launch, lower end", launch.tension_bottom),
        ]
    if (recovery := assessment.recovery) is not None:

        def minutes(piece: Any) -> str:
            arrival = recovery.arrival[piece.index] / 60.0
            return "" if isnan(arrival) else f"{arrival:.1f}"

        fields += [
            figures("tension", "recovery, upper end", recovery.tension_top),
            figures("tension", "recovery, lower end", recovery.tension_bottom),
            number("at the surface after", minutes, "min"),
            figures("depth", "hangs at depth", recovery.hangs_at),
        ]
    pieces = assessment.mooring.file.pieces[:-1]
    heads = number("no.", "index"), words("piece", "label")
    return table_of("Tensions in the launch and the rise", pieces, *heads, *fields)


def deck_table(items: Sequence[InventoryItem]) -> Table:
    """Pieces in the order in which they come to the deck, with their weights and lifts."""
    return table_of(
        "Pieces for the deck",
        items,
        number("no.", lambda one: None if one.clamped_on else one.index),
        words("piece", lambda one: Cell(one.label, indented=one.clamped_on is not None)),
        words("component", lambda one: one.name or one.use),
        number("on its piece", lambda one: None if one.at is None else place_text(one.at), "m"),
        *map(quantity, ("cut_length", "dry_mass", "wet_weight", "lift_mass")),
        note="On its piece: distance of a clamp from the upper end. Weight in water is "
        "positive down. Mass of the lift: of the piece with its clamps.",
    )


def inventory_table(items: Sequence[InventoryItem]) -> Table:
    """Return how many and how much of each component is needed, with room for the spares."""
    note = "Cut lengths are of wires, ropes and chains. Spares are filled in by hand."
    if any(item.dry_mass is None for item in items):
        note += " ≥ marks a lower bound, because masses in air are missing: plan no lift on it."

    def summed(name: str) -> Field:
        return quantity(name, lambda group: None)[0], lambda group: _sum(name, group)

    return table_of(
        "Inventory",
        grouped(items, lambda item: item.use),
        words(
            "component", lambda group: "Total" if group is items else group[0].name or group[0].use
        ),
        words("id", lambda each: None if each is items else each[0].use),
        number("pieces", len),
        *map(summed, ("cut_length", "dry_mass", "wet_weight")),
        blocks.blank("spares"),
        note=note,
        sums=[items],
        by_hand=True,
    )


def _sum(name: str, items: Sequence[InventoryItem]) -> Cell:
    """The sum of what is known, and how much is not; of masses that is the least there can be."""
    if name == "cut_length":
        items = [each for each in items if each.kind in FLEXIBLE_KINDS]
    known = [value for item in items if (value := getattr(item, name)) is not None]
    missing = len(items) - len(known)
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
    designs = [(_likeliest(findings), name) for name, findings in named]
    designs.sort(key=lambda one: -(one[0][0].probability or 0.0) if one[0] else inf)
    if not any(found for found, _ in designs):
        return
    rows: list[tuple[Finding | None, str]] = []
    for found, name in designs:
        likely = [each for each in found if each.probability]
        rows += zip(likely or (None,), (name, *("" for _ in likely[1:])), strict=True)

    def share(finding: Finding) -> Cell:
        percent = 100.0 * (finding.probability or 0.0)
        digits = 0 if percent >= 9.5 else 1
        text = f"{percent:.{digits}f}" if percent >= 0.05 else "<0.1"
        return Cell(text, strong=percent >= 5.0)

    fields = [
        words("component", lambda one: one.component or "whole line"),
        check_summary.FIGURES[2],
        words("where", place_of),
        number("broken in", share, "%"),
    ]
    yield table_of(
        "Probability of breaking a limit",
        rows,
        words("design", lambda row: row[1]),
        words("rule", lambda row: row[0].rule if row[0] else "none in any sample", 0.0),
        *((column, lambda row, show=show: row[0] and show(row[0])) for column, show in fields),
        note=_NOTE,
    )


def _likeliest(findings: Sequence[Finding]) -> list[Finding]:
    """Return the finding of each rule with the greatest probability, the greatest first."""
    order = list(RULES)
    counted = (one for one in findings if one.probability is not None)
    found = (
        max(group, key=lambda one: one.probability or 0.0)
        for group in grouped(counted, lambda one: one.rule)
    )
    return sorted(found, key=lambda one: (-(one.probability or 0.0), order.index(one.rule)))


_TO_MEND = (State.FAIL, State.WARN, State.UNKNOWN)
_TOLD = 12
"""Most failures, or warnings, shown of a mooring; a report has them all."""
_LACKING = 60
"""Most components named that lack a figure."""


def check_part(assessments: Sequence[Assessment]) -> blocks.ReportPart:
    """Everything that a design check says in short.

    Moorings by environments with the worst state in each; what decides, what is accepted and what
    departs of each; of each rule the finding with the worst margin; every failure and warning with
    its figures and remedy. No rule hangs on colour.
    """
    facts = [check_facts.facts_of(each) for each in assessments]
    findings = [one for each in facts for one in each.findings]
    shown = (
        *(replace(each, title="", note="") for each in check_facts.matrix_tables(facts)),
        check_summary.verdict_prose(findings),
        *(block for each in facts for block in _decisive(each, several=len(facts) > 1)),
        replace(check_facts.worst_table(facts), title=""),
        *likelihood_tables([(each.name, [*each.all_findings()]) for each in assessments]),
        *(block for each in facts for block in _told(each)),
        blocks.Note(unseen(findings)[:1]),
    )
    return blocks.ReportPart("", shown)


def _decisive(facts: CheckFacts, *, several: bool) -> Iterator[blocks.Block]:
    """What decides of a mooring, what is accepted, and what departs."""
    if several:
        yield blocks.Heading(facts.mooring)
    yield check_facts.key_pairs(facts)
    yield from check_facts.settled_tables(facts)


def _told(facts: CheckFacts) -> Iterator[blocks.Block]:
    """Return what a mooring fails or is warned of, the gravest first with its remedy; what is
    missing.
    """
    listed = joined(
        one for one in check_summary.worst_by_part(facts.findings) if one.state in _TO_MEND
    )
    if not listed:
        return
    lines: list[blocks.Line] = []
    for state, groups in groupby(listed, key=lambda found: found[0].state):
        found = list(groups)
        most = len(found) if state is State.UNKNOWN else _TOLD
        lines += map(_sentence, found[:most])
        if len(found) > most:
            lines.append(f"  and {len(found) - most} more that {state}; --json has them")
    yield blocks.Heading(facts.mooring)
    yield Prose(tuple(lines))


def _sentence(found: Sequence[Finding]) -> blocks.Line:
    """What is found alike of some components, told of the worst of them."""
    worst = found[0]
    sign, quiet = Span(f"{worst.state.sign} ", worst.state), worst.state is not State.FAIL
    if worst.state is State.UNKNOWN and worst.component is not None and worst.limit is None:
        names = check_summary.named((one.component or "" for one in found), _LACKING)
        return sign, Span(f"{worst.rule} of {names} is unknown. {worst.remedy}", quiet=True)
    others = (
        ""
        if len(found) == 1
        else f" The same holds for {check_summary.named_components(found[1:])}."
    )
    told = Span(f"{worst.rule}, {place_of(worst)}: {worst.message}{others}")
    return (sign, told, Span(f" {worst.remedy}", quiet=quiet)) if worst.remedy else (sign, told)
