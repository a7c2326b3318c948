"""The tables of one mooring in a design check: findings, handling, parts, likelihood."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import hypot, inf, isnan
from typing import TYPE_CHECKING

from calm.checks.finding import Finding, State
from calm.checks.rules import RULES
from calm.drawing.schematic.shown_parts import place_text
from calm.files.components import FLEXIBLE_KINDS
from calm.quantities import QUANTITIES, say
from calm.report.blocks import Cell, Column, Prose, Table, table_of
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
from calm.report.sheet import figure_cell, quantity_column

if TYPE_CHECKING:
    from calm.checks.assessment import Assessment, MooringInEnvironment
    from calm.checks.backup import Break
    from calm.checks.finding import Finding
    from calm.checks.inventory import InventoryItem
    from calm.physics.line import Floats

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


def results_table(stands: Sequence[MooringInEnvironment]) -> Table:
    """The mooring as given in each environment: its top, and the pull on its anchor."""
    columns = (Column("environment"), *map(quantity_column, _RESULTS))
    note = "Depth, knockdown and offset: of the top. Tilt and tension: the greatest in the line."
    return Table("Results by environment", columns, tuple(map(_standing, stands)), note)


def _standing(stand: MooringInEnvironment) -> tuple[Cell, ...]:
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
        (
            quantity_column("wet_weight", "weight lifted"),
            lambda one: figure_cell("wet_weight", one.weight_lifted),
        ),
        (
            quantity_column("net_buoyancy", "buoyancy left over"),
            lambda one: figure_cell("net_buoyancy", one.margin),
        ),
        (
            quantity_column("net_buoyancy", "required"),
            lambda one: figure_cell("net_buoyancy", one.required),
        ),
        (Column("judged"), lambda one: "yes" if one.judged else "no"),
        note="Not judged: what breaks inside the lowest cluster of floats, or between it and the "
        "release, in any design leaves the release on the seabed.",
    )


def handling_summary(assessment: Assessment) -> Table:
    """The launch and the recovery in a few figures."""
    rows = []
    speed = QUANTITIES["speed"]
    if assessment.launch is not None:
        launch = assessment.launch
        low, high = launch.fall_speed_band
        band = (
            f"{speed.format(low)} to {speed.say(high)} with double and half the drag along the "
            "line and of the anchor"
        )
        rows += [
            (
                Cell("Launch, anchor last: speed at touchdown"),
                Cell(speed.say(launch.fall_speed), band),
            ),
            (Cell("Pull of the falling anchor"), Cell(say("tension", launch.anchor_tension))),
        ]
        if not launch.anchor_drag_known:
            rows.append((Cell("Drag of the anchor"), Cell("unknown; that of a cube of its volume")))
    if assessment.recovery is not None:
        recovery = assessment.recovery
        time = recovery.time_to_surface
        rows += [
            (Cell("Recovery: net buoyancy above the release"),
             Cell(say("vertical", recovery.net_buoyancy))),
            (Cell("Speed of the rise", "in still water" if recovery.in_still_water else ""),
             Cell(speed.say(recovery.rise_speed))),
            (Cell("Time to the surface"), Cell("-" if time is None else f"{time / 60:.1f} min")),
        ]  # fmt: skip
    columns = (Column(""), Column("", numeric=True))
    return Table("Launch and recovery in short", columns, tuple(rows))


def handling_table(assessment: Assessment) -> Table:
    """Tensions of each piece on its way down and up, and when and where it ends."""
    launch, recovery = assessment.launch, assessment.recovery
    rows = []
    for piece in assessment.mooring.file.pieces[:-1]:
        row = [Cell(str(piece.index)), Cell(piece.label)]
        if launch is not None:
            row += _pair(launch.tension_top, launch.tension_bottom, piece.index)
        if recovery is not None:
            row += _pair(recovery.tension_top, recovery.tension_bottom, piece.index)
            arrival = float(recovery.arrival[piece.index])
            row += [
                Cell("-" if isnan(arrival) else f"{arrival / 60:.1f}"),
                figure_cell("depth", float(recovery.hangs_at[piece.index])),
            ]
        rows.append(tuple(row))
    columns = [Column("no.", numeric=True), Column("piece")]
    if launch is not None:
        columns += [
            quantity_column("tension", "launch, upper end"),
            quantity_column("tension", "launch, lower end"),
        ]
    if recovery is not None:
        columns += [
            quantity_column("tension", "recovery, upper end"),
            quantity_column("tension", "recovery, lower end"),
            Column("at the surface after", "min", True),
            quantity_column("depth", "hangs at depth"),
        ]
    return Table("Tensions on the way down and up", tuple(columns), tuple(rows))


def _pair(top: Floats, bottom: Floats, index: int) -> list[Cell]:
    return [figure_cell("tension", float(top[index])), figure_cell("tension", float(bottom[index]))]


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
        (quantity_column("cut_length"), lambda one: figure_cell("cut_length", one.cut_length)),
        (quantity_column("dry_mass"), lambda one: figure_cell("mass", one.dry_mass)),
        (quantity_column("wet_weight"), lambda one: figure_cell("wet_weight", one.wet_weight)),
        (quantity_column("lift_mass"), lambda one: figure_cell("lift_mass", one.lift_mass)),
        note="On its piece: where a clamp sits, from the top of it. Weight in water: + down. Mass "
        "of the lift: of the piece with what is clamped on it.",
    )


def inventory_table(items: Sequence[InventoryItem]) -> Table:
    """Return how many and how much of each component is needed, with room for the spares."""
    groups: dict[str, list[InventoryItem]] = {}
    for item in items:
        groups.setdefault(item.use, []).append(item)
    rows = [_stock(group[0].name or use, use, group) for use, group in groups.items()]
    rows.append(_stock("Total", "", list(items)))
    columns = (
        Column("component"),
        Column("id"),
        Column("pieces", numeric=True),
        quantity_column("cut_length"),
        quantity_column("dry_mass"),
        quantity_column("wet_weight"),
        Column("spares"),
    )
    note = "Cut length: of wires, ropes and chains. Spares: by hand."
    if any(item.dry_mass is None for item in items):
        note += " ≥: a lower bound, since masses in air are missing: no lift may rely on it."
    return Table("Inventory", columns, tuple(rows), note, totals=1)


def _stock(name: str, use: str, items: Sequence[InventoryItem]) -> tuple[Cell, ...]:
    lines = [item for item in items if item.kind in FLEXIBLE_KINDS]
    return (
        Cell(name),
        Cell(use),
        Cell(str(len(items))),
        _sum("cut_length", [item.cut_length for item in lines]) if lines else Cell("-"),
        _sum("dry_mass", [item.dry_mass for item in items]),
        _sum("wet_weight", [item.wet_weight for item in items]),
        Cell(),
    )


def _sum(name: str, values: Sequence[float | None]) -> Cell:
    """The sum of what is known, and how much is not; of masses that is the least there can be."""
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


def _greatest(found: Sequence[Finding]) -> float:
    return (found[0].probability or 0.0) if found else -inf
