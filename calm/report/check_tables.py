"""The tables of one mooring in a design check: findings, handling, parts, likelihood."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from math import hypot, inf, isnan
from typing import TYPE_CHECKING, Any

from calm.checks.finding import Finding, State
from calm.checks.rules import RULES
from calm.drawing.schematic.shown_parts import place_text
from calm.files.components import FLEXIBLE_KINDS
from calm.quantities import QUANTITIES, say
from calm.report.blocks import Cell, Column, Field, Pairs, Prose, Table, table_of
from calm.report.check_summary import (
    joined,
    margin_of,
    named_components,
    place_of,
    said_of,
    say_in_unit,
    state_cell,
    worst_by_part,
)
from calm.report.sheet import figure_cell, quantity_column, quantity_field

if TYPE_CHECKING:
    from calm.case import Result
    from calm.checks.assessment import Assessment, MooringInEnvironment
    from calm.checks.backup import Break
    from calm.checks.finding import Finding
    from calm.checks.inventory import InventoryItem
    from calm.files import Piece
    from calm.physics.line import Floats

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
        note="Depth, knockdown and offset: of the top. Tilt and tension: the greatest in the line.",
    )


def checks_table(findings: Iterable[Finding]) -> Iterator[Table | Prose]:
    """The worst finding of each rule on each component, and the sources of the rules."""
    kept = worst_by_part(findings)
    sources = list(dict.fromkeys(finding.source for finding in kept))
    yield table_of(
        "Worst finding of each rule on each component",
        joined(kept),
        (Column("state", share=0.0), lambda found: state_cell(found[0])),
        (Column("rule"), lambda found: _with_source(found, sources)),
        (Column("component", share=1.8), _placed),
        (Column("value", numeric=True), lambda found: say_in_unit(found[0], found[0].value)),
        (Column("limit", numeric=True), lambda found: say_in_unit(found[0], found[0].limit)),
        (Column("margin", numeric=True), lambda found: margin_of(found[0])),
        (Column("finding and remedy", share=2.5), lambda found: said_of(found[0])),
        note="Components of which a rule says the same share a row, which shows the worst of them; "
        "every finding is in checks.csv and report.json. [1] is the first source below the table.",
        sortable=True,
    )
    yield Prose(tuple(f"[{number}] {source}" for number, source in enumerate(sources, 1)))


def _with_source(found: Sequence[Finding], sources: Sequence[str]) -> Cell:
    return Cell(RULES[found[0].rule].title, f"[{sources.index(found[0].source) + 1}]")


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
        (Column("judged"), lambda one: "yes" if one.judged else "no"),
        note="Not judged: what breaks inside the lowest cluster of floats, or between it and the "
        "release, in any design leaves the release on the seabed.",
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
            pairs.append(("Drag of the anchor", "unknown; that of a cube of its volume is taken"))
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
        "Tensions on the way down and up",
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
        note="On its piece: where a clamp sits, from the top of it. Weight in water: + down. Mass "
        "of the lift: of the piece with what is clamped on it.",
    )


def inventory_table(items: Sequence[InventoryItem]) -> Table:
    """Return how many and how much of each component is needed, with room for the spares."""
    groups: dict[str, list[InventoryItem]] = {}
    for item in items:
        groups.setdefault(item.use, []).append(item)
    note = "Cut length: of wires, ropes and chains. Spares: by hand."
    if any(item.dry_mass is None for item in items):
        note += " ≥: a lower bound, since masses in air are missing: no lift may rely on it."

    def named(group: Sequence[InventoryItem]) -> str:
        return "Total" if group is items else group[0].name or group[0].use

    return table_of(
        "Inventory",
        groups.values(),
        (Column("component"), named),
        (Column("id"), lambda group: "" if group is items else group[0].use),
        (Column("pieces", numeric=True), lambda group: str(len(group))),
        (quantity_column("cut_length"), _cut_length),
        (quantity_column("dry_mass"), lambda group: _sum("dry_mass", group)),
        (quantity_column("wet_weight"), lambda group: _sum("wet_weight", group)),
        (Column("spares"), lambda group: ""),
        note=note,
        sums=[items],
        by_hand=True,
    )


def _cut_length(items: Sequence[InventoryItem]) -> Cell:
    lines = [item for item in items if item.kind in FLEXIBLE_KINDS]
    return _sum("cut_length", lines) if lines else Cell("-")


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
        "How likely a limit is broken",
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
    share = finding.probability or 0.0
    return Cell(_percent(share), strong=share >= 0.05)


def _percent(probability: float) -> str:
    percent = 100.0 * probability
    return f"{percent:.0f}" if percent >= 9.5 else f"{percent:.1f}" if percent >= 0.05 else "<0.1"


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
