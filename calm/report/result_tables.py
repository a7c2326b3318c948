"""The tables of a solved line, and of what it was solved from."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import hypot
from typing import TYPE_CHECKING

import numpy as np

from calm.checks.finding import State
from calm.quantities import QUANTITIES
from calm.report.limits import Mark
from calm.report.provenance import input_hash, source_text, versions
from calm.report.section import Cell, Column, Listing, Prose, Table

if TYPE_CHECKING:
    from calm.files import MooringFile
    from calm.physics.line import Water
    from calm.report.rows import Phrase, Sheet

UNSEEN = (
    "A static calculation does not see waves and the tensions they cause; snap loads on a line "
    "that falls slack; fatigue, by waves and by vortices; creep, corrosion and wear; the jerk at "
    "the end of the launch and the swing of the line before it; hauling and lifts on recovery.",
    "No margin in this report covers them. They decide the life of surface moorings in harsh "
    "weather, and no factor on a static tension replaces looking at them.",
)
"""What is printed in every report."""

_STATES = {Mark.NONE: None, Mark.NEAR: State.WARN, Mark.BEYOND: State.FAIL}
_MOST_LEVELS = 40


def quantity_column(name: str) -> Column:
    """The head of a column of a quantity in the unit that people read."""
    quantity = QUANTITIES[name]
    return Column(quantity.heading, quantity.display_unit, numeric=True)


def figure_cell(name: str, value: float | None) -> Cell:
    """A value of a quantity under its `quantity_column`."""
    return Cell(QUANTITIES[name].format(value))


def line_table(said: Sheet, title: str) -> Table:
    """The line from its first-listed end; a clamped instrument stands indented below its piece."""
    rows, index = [], -1
    for row in said.rows:
        index += not row.clamped
        name = Cell(f"\u2003{row.label}") if row.clamped else Cell(row.label)
        number = Cell("" if row.clamped else str(index))
        rows.append((number, name, *map(_marked, row.cells)))
    columns = (Column("no.", numeric=True), Column("piece"), *map(quantity_column, said.columns))
    return Table(title, columns, tuple(rows), said.note)


def said_below(said: Sheet) -> Iterator[Prose]:
    """The ends of the line in words, the warnings, and how good the solution is."""
    yield Prose(tuple(f"{phrase.text} {phrase.mark}".rstrip() for phrase in said.summary))
    if said.warnings:
        yield Prose(said.warnings, State.WARN)
    yield Prose((said.convergence,))


def environments_table(names: Sequence[str], waters: Sequence[Water]) -> Table:
    """Depth, density and the greatest current of each environment, and where it is."""
    rows = []
    for name, water in zip(names, waters, strict=True):
        speed = np.hypot(water.u, water.v)
        fastest = int(speed.argmax())
        densities = sorted({f"{density:.0f}" for density in water.density})
        rows.append(
            (
                Cell(name),
                Cell(QUANTITIES["depth"].format(water.depth) if np.isfinite(water.depth) else "-"),
                Cell(densities[0] + (f"–{densities[-1]}" if len(densities) > 1 else "")),
                Cell(QUANTITIES["speed"].format(float(speed[fastest]))),
                Cell(QUANTITIES["depth"].format(float(water.level[fastest]))),
                Cell(str(len(water.level))),
            )
        )
    columns = (
        Column("environment"),
        Column("water depth", "m", numeric=True),
        Column("density", "kg/m³", numeric=True),
        Column("greatest current", "m/s", numeric=True),
        Column("at depth", "m", numeric=True),
        Column("levels", numeric=True),
    )
    return Table("Environments", columns, tuple(rows))


def current_listing(name: str, water: Water) -> Listing:
    """The current as computed with, level by level; of many levels, some at equal steps."""
    count = len(water.level)
    chosen = np.unique(np.linspace(0, count - 1, min(count, _MOST_LEVELS)).round().astype(int))
    lines = [f"{'depth m':>10} {'speed m/s':>10} {'toward °':>10} {'upward m/s':>11}"]
    for level in chosen:
        u, v, w = water.u[level], water.v[level], water.w[level]
        toward = np.degrees(np.arctan2(u, v)) % 360.0
        lines.append(f"{water.level[level]:10.1f} {hypot(u, v):10.3f} {toward:10.1f} {w:11.3f}")
    if len(chosen) < count:
        lines.append(f"{len(chosen)} of {count} levels")
    return Listing(f"Current, {name}", "\n".join(lines))


def file_listing(file: MooringFile) -> Listing:
    """The mooring file as it stands."""
    text = source_text(file)
    return Listing(
        "Mooring file", "The file could not be read again." if text is None else text.rstrip()
    )


def origin(files: Sequence[MooringFile]) -> Prose:
    """The hash of the inputs of one mooring, and the versions that computed."""
    made_by = ", ".join(f"{name} {number}" for name, number in versions())
    return Prose((f"SHA-256 of the inputs: {input_hash(files)}", f"Computed with {made_by}"))


def _marked(phrase: Phrase) -> Cell:
    return Cell(f"{phrase.text} {phrase.mark}".rstrip(), state=_STATES[phrase.mark])
