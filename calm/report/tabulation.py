"""Results of a tow at many speeds, as table, JSON, CSV and drawing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import floor, isfinite, log10
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.checks.finding import State
from calm.drawing.graph import Axes, Graph, LegendEntry, Scale, Stroke, Tick, covering, numbers
from calm.drawing.line_drawing import LINE_COLOUR, WATER_COLOUR
from calm.drawing.schematic.pen import shortened
from calm.errors import NoEquilibrium
from calm.physics.line import Floats
from calm.quantities import QUANTITIES, Quantity
from calm.records.delimited import table_csv
from calm.report import blocks
from calm.report.blocks import Cell, Field, ReportPart, number, quiet, table_of, warned
from calm.units import KNOT
from calm.version import __version__

if TYPE_CHECKING:
    from calm.case import Design, Result

FIGURES = ("depth", "layback", "tension", "angle", "body_tension", "frequency")
"""Values in a row: depth and layback of the body, tension and angle at the tow point, tension at
the body, and frequency of strumming.
"""

_HEADINGS = {"body_tension": "tension\nat body"}
_NOTE = (
    "Depth and layback are those of the body; tension and angle from the horizontal are those at "
    "the tow point."
)
_DIGITS = 4
_WARNED = "! marks warnings, which --json reports."
_KNOTS = replace(QUANTITIES["speed"], display="knot")


@dataclass(frozen=True)
class TabulationRow:
    """Result of a tow at one ship speed over the ground [m/s], or the reason for a failure."""

    speed: float
    outcome: Result | NoEquilibrium

    @property
    def result(self) -> Result | None:
        """Equilibrium at this speed, or None."""
        return None if isinstance(self.outcome, NoEquilibrium) else self.outcome

    @property
    def figures(self) -> dict[str, float | None]:
        """Values of the result, by their names in `FIGURES`; None if unknown."""
        result = self.result
        if result is None:
            return dict.fromkeys(FIGURES)
        return {
            "depth": result.body.depth,
            "layback": result.body.layback,
            "tension": result.tow_point.tension,
            "angle": result.tow_point.angle,
            "body_tension": result.body.tension,
            "frequency": result.strumming.frequency if result.strumming else None,
        }


@dataclass(frozen=True)
class Tabulation:
    """Results of a tow at several speeds: the name of the tow and a row for each speed."""

    name: str
    rows: tuple[TabulationRow, ...]

    @property
    def title(self) -> str:
        """Title of the table."""
        count = len(self.rows)
        return f"{self.name}: tow at {count} speed{'s' if count != 1 else ''}"

    @property
    def strumming(self) -> bool:
        """Whether any row has a strumming frequency."""
        return any(row.figures["frequency"] is not None for row in self.rows)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings that are common to all rows with an equilibrium."""
        warnings = [row.result.warnings for row in self.rows if row.result is not None]
        first = warnings[0] if warnings else ()
        return tuple(text for text in first if all(text in each for each in warnings))


def by_speed(
    tow: Design, speeds: Sequence[float], outcomes: Sequence[Result | NoEquilibrium]
) -> Tabulation:
    """Create a tabulation from ship speeds over the ground [m/s] and the outcome at each speed."""
    rows = map(TabulationRow, speeds, outcomes)
    return Tabulation(tow.file.name, tuple(rows))


def to_document(tabulation: Tabulation) -> dict[str, Any]:
    """Return the JSON object of a table, with one object per ship speed.

    Each object has `speed`, `status` and the keys of `FIGURES` (SI and degrees). The key
    `frequency` is absent unless the cable strums. With an equilibrium, the object also has
    `warnings`. Without an equilibrium, the object has `message` and `advice`.
    """
    return {
        "calm": __version__,
        "name": tabulation.name,
        "type": "tow",
        "speeds": [_row_document(tabulation, row) for row in tabulation.rows],
    }


def to_csv(tabulations: Sequence[Tabulation]) -> str:
    """Write the rows of one or several tows as CSV text.

    The text is UTF-8, comma-separated, with decimal points and LF.
    """
    figures = (QUANTITIES[name].header for name in FIGURES)
    rows = (
        [tabulation.name, row.speed, row.outcome.status, *row.figures.values()]
        for tabulation in tabulations
        for row in tabulation.rows
    )
    return table_csv(["tow", QUANTITIES["speed"].header, "status", *figures], rows)


def _row_document(tabulation: Tabulation, row: TabulationRow) -> dict[str, Any]:
    figures = row.figures
    if not tabulation.strumming:
        del figures["frequency"]
    document = {"speed": row.speed, "status": row.outcome.status, **figures}
    if isinstance(row.outcome, NoEquilibrium):
        return document | row.outcome.to_dict()
    return document | {"warnings": list(row.outcome.warnings)}


def tabulation_part(tabulation: Tabulation) -> ReportPart:
    """Build the table with one row per speed, within 80 columns.

    Rows without an equilibrium show the status of the solver. Warnings common to all rows follow
    the table. A row with another warning is marked ``!``.
    """
    speed = QUANTITIES["speed"]
    names = [name for name in FIGURES if name != "frequency" or tabulation.strumming]

    def figure(name: str) -> Field:
        shown, fine = QUANTITIES[name], _with_enough_decimals(name, tabulation)
        heading = _HEADINGS.get(name, shown.heading)
        return number(heading, lambda row: fine.format(row.figures[name]), shown.display_unit)

    def remark(row: TabulationRow) -> Cell:
        text = _remark_text(tabulation, row)
        return Cell(text, state=State.FAIL if text else None)

    table = table_of(
        "",
        tabulation.rows,
        number(f"speed\n{speed.display_unit}", lambda row: speed.format(row.speed)),
        number(_KNOTS.display, lambda row: _KNOTS.format(row.speed)),
        *map(figure, names),
        blocks.words("", remark, 0.0),
    )
    marked = any(_remark_text(tabulation, row) == "!" for row in tabulation.rows)
    note = quiet(f"{_NOTE} {_WARNED}" if marked else _NOTE)
    return ReportPart(tabulation.title, (table, *warned(tabulation.warnings), note))


def _with_enough_decimals(name: str, tabulation: Tabulation) -> Quantity:
    quantity = QUANTITIES[name]
    greatest = max((abs(row.figures[name] or 0.0) for row in tabulation.rows), default=0.0)
    if greatest == 0.0:
        return quantity
    # the usual decimals may hide small differences between rows, or the values of a small tow
    decimals = _DIGITS - 1 - floor(log10(greatest * quantity.usual_scale))
    return replace(quantity, decimals=max(quantity.decimals, decimals))


def _remark_text(tabulation: Tabulation, row: TabulationRow) -> str:
    if isinstance(row.outcome, NoEquilibrium):
        return row.outcome.status
    return "!" if set(row.outcome.warnings) - set(tabulation.warnings) else ""


_WIDTH, _HEIGHT, _SIZE = 600.0, 247.0, 8.0  # size and font size [pt]
_PANEL, _TOP, _LOW = 148.0, 66.0, 32.0  # width of a panel, and room above and below
_LEFTS = (44.0, 244.0, 444.0)
_MOST_MARKED = 60  # largest number of points that get marks
_CURVE, _AT_BODY = Stroke(LINE_COLOUR, 1.4), Stroke(LINE_COLOUR, 1.2, (4.0, 2.0))


def sweep_drawing(tabulation: Tabulation) -> str:
    """Draw body depth, layback and tensions against ship speed, as SVG.

    Tensions are at the tow point and at the body. Without an equilibrium, curves have gaps.
    """
    page = Graph(_WIDTH, _HEIGHT, tabulation.name, _SIZE)
    title = shortened(tabulation.name, _WIDTH - 12.0, 11.0, bold=True)
    page.pen.letters(_WIDTH / 2, 10.0, title, size=11.0, bold=True, anchor="middle")
    speeds = [row.speed for row in tabulation.rows]
    margin = 0.04 * (speeds[-1] - speeds[0]) or speeds[0]
    across = Scale(speeds[0] - margin, speeds[-1] + margin)
    columns = {
        name: np.array([row.figures[name] for row in tabulation.rows], dtype=np.float64)
        for name in FIGURES
    }
    deep = covering([0.0], columns["depth"])
    pull = covering([0.0], columns["tension"], columns["body_tension"])
    _draw_panel(page, 0, across, Scale(deep.high, deep.low), speeds, columns, "depth", WATER_COLOUR)
    _draw_panel(page, 1, across, covering(columns["layback"]), speeds, columns, "layback")
    axes = _draw_panel(page, 2, across, Scale(0.0, pull.high), speeds, columns, "tension")
    axes.line(speeds, columns["body_tension"], _AT_BODY)
    entries = [LegendEntry("tow point", line=_CURVE), LegendEntry("body", line=_AT_BODY)]
    page.legend(entries, (_LEFTS[2], 22.0), _PANEL / 2, 12.0, columns=2)
    return page.svg()


def _draw_panel(
    page: Graph,
    number: int,
    across: Scale,
    up: Scale,
    speeds: list[float],
    columns: Mapping[str, Floats],
    name: str,
    level: str = "",
) -> Axes:
    """Draw a panel with the curve of the column `name`.

    `level` is the colour of a line at zero. If `level` is empty, the line is not drawn.
    """
    place = _LEFTS[number], _TOP, _PANEL, _HEIGHT - _TOP - _LOW
    axes = page.axes(*place, across, up)
    if level:
        axes.level(0.0, Stroke(level, 1.0))
    axes.line(speeds, columns[name], _CURVE)
    if len(speeds) <= _MOST_MARKED:
        for speed, value in zip(speeds, columns[name], strict=True):
            if isfinite(value):
                axes.mark(speed, value, "o", 2.6, LINE_COLOUR)
    below, beside = QUANTITIES["speed"].label, QUANTITIES[name].label
    axes.frame(5, 6, below=below, beside=beside, grid=True)
    knots = numbers(across.low / KNOT, across.high / KNOT, 5)
    axes.scale_above([Tick(each.value * KNOT, each.text) for each in knots], "speed [knot]")
    return axes
