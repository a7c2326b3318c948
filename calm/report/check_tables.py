"""The tables of one mooring in a design check."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import hypot
from typing import TYPE_CHECKING

from calm.checks.finding import State
from calm.checks.rules import RULES
from calm.quantities import QUANTITIES
from calm.report.check_summary import margin_of, place_of, say_in_unit, worst_by_part
from calm.report.result_tables import quantity_column
from calm.report.section import Cell, Column, Prose, Table

if TYPE_CHECKING:
    from calm.checks.assessment import Assessment, Stand
    from calm.checks.backup import Break
    from calm.checks.finding import Finding
    from calm.checks.inventory import Item

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


def results_table(stands: Sequence[Stand]) -> Table:
    """The mooring as given in each environment: its top, and the pull on its anchor."""
    columns = (Column("environment"), *map(quantity_column, _RESULTS))
    note = "Depth, knockdown and offset: of the top. Tilt and tension: the greatest in the line."
    return Table("Results by environment", columns, tuple(map(_standing, stands)), note)


def _standing(stand: Stand) -> tuple[Cell, ...]:
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
    return (Cell(stand.environment), *(_figure(name, figures[name]) for name in _RESULTS))


def checks_table(findings: Iterable[Finding]) -> Iterator[Table | Prose]:
    """The worst finding of each rule on each component, and the sources of the rules."""
    kept = worst_by_part(findings)
    sources = list(dict.fromkeys(finding.source for finding in kept))
    rows = tuple(
        (
            Cell(finding.state.value, state=finding.state),
            Cell(RULES[finding.rule].title),
            Cell(finding.component or "whole line"),
            Cell(say_in_unit(finding, finding.value)),
            Cell(say_in_unit(finding, finding.limit)),
            Cell(margin_of(finding)),
            Cell(place_of(finding)),
            _said(finding),
            Cell(str(sources.index(finding.source) + 1)),
        )
        for finding in kept
    )
    columns = (
        Column("state", share=0.0),
        Column("rule", share=1.3),
        Column("component"),
        Column("value", numeric=True),
        Column("limit", numeric=True),
        Column("margin", numeric=True),
        Column("environment, situation"),
        Column("finding and remedy", share=2.5),
        Column("source", numeric=True),
    )
    note = "Each component where it is worst; every finding is in checks.csv and report.json."
    yield Table("Worst finding of each rule on each component", columns, rows, note, sortable=True)
    yield Prose(tuple(f"{number}. {source}" for number, source in enumerate(sources, 1)))


def _said(finding: Finding) -> Cell:
    """What was found and what to do; the figures of a pass say it all, and so does a remedy that
    names the figure missing."""
    if finding.state is State.PASS:
        return Cell()
    if finding.state is State.UNKNOWN and finding.remedy:
        return Cell(finding.remedy)
    return Cell(finding.message, finding.remedy or "")


def breaks_table(backup: Sequence[Break]) -> Table:
    """What would float the release up again after each break."""
    rows = tuple(
        (
            Cell(str(each.break_after)),
            Cell(each.label),
            _figure("vertical", each.weight_lifted),
            _figure("vertical", each.margin),
            _figure("vertical", each.required),
        )
        for each in backup
    )
    columns = (
        Column("no.", numeric=True),
        Column("break below"),
        Column("weight lifted", "N", numeric=True),
        Column("buoyancy left over", "N", numeric=True),
        Column("required", "N", numeric=True),
    )
    return Table("Back-up buoyancy", columns, rows)


def handling_summary(assessment: Assessment) -> Table:
    """The launch and the recovery in a few figures."""
    rows = []
    speed = QUANTITIES["speed"]
    if assessment.launch is not None:
        launch = assessment.launch
        low, high = launch.fall_speed_band
        band = f"{speed.format(low)} to {speed.say(high)} over the range of axial drag"
        rows += [
            (
                Cell("Launch, anchor last: speed of the fall"),
                Cell(speed.say(launch.fall_speed), band),
            ),
            (Cell("Speed at touchdown"), Cell(speed.say(launch.touchdown_speed))),
            (Cell("Pull of the falling anchor"), _said_figure("tension", launch.anchor_tension)),
        ]
        if not launch.anchor_drag_known:
            rows.append((Cell("Drag of the anchor"), Cell("unknown; it is left out")))
    if assessment.recovery is not None:
        recovery = assessment.recovery
        time = recovery.time_to_surface
        rows += [
            (Cell("Recovery: net buoyancy above the release"),
             _said_figure("vertical", recovery.net_buoyancy)),
            (Cell("Speed of the rise"), Cell(speed.say(recovery.rise_speed))),
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
            arrival = _at(recovery.arrival, piece.index)
            row += [
                Cell("-" if arrival is None or arrival != arrival else f"{arrival / 60:.1f}"),
                _figure("depth", _at(recovery.hangs_at, piece.index)),
            ]
        rows.append(tuple(row))
    columns = [Column("no.", numeric=True), Column("piece")]
    if launch is not None:
        columns += [Column("launch, upper end", "N", True), Column("launch, lower end", "N", True)]
    if recovery is not None:
        columns += [
            Column("recovery, upper end", "N", True),
            Column("recovery, lower end", "N", True),
            Column("at the surface after", "min", True),
            Column("hangs at depth", "m", True),
        ]
    return Table("Tensions on the way down and up", tuple(columns), tuple(rows))


def deck_table(items: Sequence[Item]) -> Table:
    """Pieces in the order in which they come to the deck, with their weights and lifts."""
    rows = tuple(
        (
            Cell("" if item.clamped_on else str(item.index)),
            Cell(f"\u2003{item.label}" if item.clamped_on else item.label),
            Cell(item.name or item.use),
            _figure("cut_length", item.cut_length),
            _figure("mass", item.dry_mass),
            _figure("vertical", item.wet_weight),
            _figure("mass", item.lift_mass),
        )
        for item in items
    )
    columns = (
        Column("no.", numeric=True),
        Column("piece"),
        Column("component"),
        quantity_column("cut_length"),
        Column("mass in air", "kg", numeric=True),
        Column("weight in water", "N", numeric=True),
        Column("mass of the lift", "kg", numeric=True),
    )
    note = "Weight in water: + down. Mass of the lift: of the piece with what is clamped on it."
    return Table("Pieces for the deck", columns, rows, note)


def inventory_table(items: Sequence[Item]) -> Table:
    """How many and how much of each component is needed, with room for the spares."""
    groups: dict[str, list[Item]] = {}
    for item in items:
        groups.setdefault(item.use, []).append(item)
    rows = [_stock(group[0].name or use, use, group) for use, group in groups.items()]
    rows.append(_stock("Total", "", list(items)))
    columns = (
        Column("component"),
        Column("id"),
        Column("pieces", numeric=True),
        Column("cut length", "m", numeric=True),
        Column("mass in air", "kg", numeric=True),
        Column("weight in water", "N", numeric=True),
        Column("spares"),
    )
    note = "Cut length: of wires, ropes and chains. Spares: by hand."
    return Table("Inventory", columns, tuple(rows), note, totals=1)


def _stock(name: str, use: str, items: Sequence[Item]) -> tuple[Cell, ...]:
    lines = [item for item in items if item.kind in ("cable", "chain")]
    return (
        Cell(name),
        Cell(use),
        Cell(str(sum(item.count for item in items))),
        _sum("cut_length", [item.cut_length for item in lines]) if lines else Cell("-"),
        _sum("mass", [item.dry_mass for item in items]),
        _sum("vertical", [item.wet_weight for item in items]),
        Cell(),
    )


def _sum(name: str, values: Sequence[float | None]) -> Cell:
    """The sum of what is known, and how much is not."""
    known = [value for value in values if value is not None]
    missing = len(values) - len(known)
    if not known:
        return Cell("-")
    return Cell(QUANTITIES[name].format(sum(known)), f"{missing} unknown" if missing else "")


def _pair(top: Sequence[float], bottom: Sequence[float], index: int) -> list[Cell]:
    return [_figure("tension", _at(top, index)), _figure("tension", _at(bottom, index))]


def _at(values: Sequence[float], index: int) -> float | None:
    """The value of a piece; None of one beyond the last, which stays where it is."""
    return float(values[index]) if index < len(values) else None


def _figure(name: str, value: float | None) -> Cell:
    return Cell(QUANTITIES[name].format(value))


def _said_figure(name: str, value: float) -> Cell:
    return Cell(QUANTITIES[name].say(value))
