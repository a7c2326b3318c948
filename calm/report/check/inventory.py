"""The tables of what is needed for a mooring, and of what comes to the deck."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from calm.files.components import FLEXIBLE_KINDS
from calm.quantities import QUANTITIES
from calm.report.blocks import Cell, Column, Table
from calm.report.line import figure_cell, place_text, quantity_column

if TYPE_CHECKING:
    from calm.checks.inventory import InventoryItem


def deck_table(items: Sequence[InventoryItem]) -> Table:
    """Pieces in the order in which they come to the deck, with their weights and lifts."""
    rows = tuple(
        (
            Cell("" if item.clamped_on else str(item.index)),
            Cell(item.label, indented=item.clamped_on is not None),
            Cell(item.name or item.use),
            Cell("" if item.at is None else place_text(item.at)),
            figure_cell("cut_length", item.cut_length),
            figure_cell("mass", item.dry_mass),
            figure_cell("wet_weight", item.wet_weight),
            figure_cell("lift_mass", item.lift_mass),
        )
        for item in items
    )
    columns = (
        Column("no.", numeric=True),
        Column("piece"),
        Column("component"),
        Column("on its piece", "m", numeric=True),
        quantity_column("cut_length"),
        quantity_column("dry_mass"),
        quantity_column("wet_weight"),
        quantity_column("lift_mass"),
    )
    note = (
        "On its piece: where a clamp sits, from the top of it. Weight in water: + down. Mass of "
        "the lift: of the piece with what is clamped on it."
    )
    return Table("Pieces for the deck", columns, rows, note)


def inventory_table(items: Sequence[InventoryItem]) -> Table:
    """How many and how much of each component is needed, with room for the spares."""
    groups: dict[str, list[InventoryItem]] = {}
    for item in items:
        groups.setdefault(item.use, []).append(item)
    rows = [_stock(group[0].name or use, use, group) for use, group in groups.items()]
    rows.append(_stock("Total", "", list(items)))
    columns = (
        Column("component"),
        Column("id"),
        Column("pieces", numeric=True),
        Column("cut length", "m", numeric=True),
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
