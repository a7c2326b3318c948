"""A tow at many speeds: a table with a row for each, JSON, CSV and a picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import floor, log10
from operator import mul
from typing import TYPE_CHECKING, Any

from calm.checks.finding import State
from calm.drawing import plot
from calm.drawing.picture import empty_figure
from calm.errors import NoEquilibrium
from calm.quantities import QUANTITIES, Quantity
from calm.records.delimited import table_csv
from calm.report import blocks
from calm.report.blocks import Cell, Field, ReportPart, number, quiet, table_of, warned
from calm.units import KNOT
from calm.version import __version__

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from calm.case import Tow, TowResult

FIGURES = ("depth", "layback", "tension", "angle", "body_tension", "frequency")
"""What a row tells of a result: depth and layback of the body, tension and angle at the ship."""

_HEADINGS = {"body_tension": "tension\nat body"}
_NOTE = "Depth and layback: of the body. Tension and angle: at the tow point, from the horizontal."
_DIGITS = 4
_WARNED = "! marks warnings, which --json reports."
_KNOTS = replace(QUANTITIES["speed"], display="knot")


@dataclass(frozen=True)
class TabulationRow:
    """A speed of the ship over the ground [m/s], and the result or the failure at that speed."""

    speed: float
    outcome: TowResult | NoEquilibrium

    @property
    def result(self) -> TowResult | None:
        """The equilibrium, where there is one."""
        return None if isinstance(self.outcome, NoEquilibrium) else self.outcome

    @property
    def figures(self) -> dict[str, float | None]:
        """`FIGURES` by name, None where unknown."""
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
    """The name of a tow, and a row for each speed."""

    name: str
    rows: tuple[TabulationRow, ...]

    @property
    def title(self) -> str:
        """The title of the table."""
        count = len(self.rows)
        return f"{self.name}: tow at {count} speed{'s' if count != 1 else ''}"

    @property
    def strumming(self) -> bool:
        """Return whether any row has a frequency."""
        return any(row.figures["frequency"] is not None for row in self.rows)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return what holds for every row that has an equilibrium."""
        warnings = [row.result.warnings for row in self.rows if row.result is not None]
        first = warnings[0] if warnings else ()
        return tuple(text for text in first if all(text in each for each in warnings))


def by_speed(
    tow: Tow, speeds: Sequence[float], outcomes: Sequence[TowResult | NoEquilibrium]
) -> Tabulation:
    """Tabulate the outcomes at speeds over the ground [m/s]."""
    rows = map(TabulationRow, speeds, outcomes)
    return Tabulation(tow.file.name, tuple(rows))


def to_document(tabulation: Tabulation) -> dict[str, Any]:
    """The JSON object: `calm`, `name`, `type` and `speeds`, an object for each row.

    A row has `speed`, `status` and `FIGURES` (SI and degrees; `frequency` only where the
    cable strums), and its `warnings`, or, without an equilibrium, `message` and `advice`.
    """
    return {
        "calm": __version__,
        "name": tabulation.name,
        "type": "tow",
        "speeds": [_row_document(tabulation, row) for row in tabulation.rows],
    }


def to_csv(tabulations: Sequence[Tabulation]) -> str:
    """The rows of one tow or several as CSV text (UTF-8, comma, point, LF)."""
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
    """A line for each row; it fits 80 columns.

    A row without equilibrium shows its status, one with warnings of its own a mark; warnings that
    all rows share stand below.
    """
    speed = QUANTITIES["speed"]
    names = [name for name in FIGURES if name != "frequency" or tabulation.strumming]

    def figure(name: str) -> Field:
        shown, fine = QUANTITIES[name], _fine(name, tabulation)
        heading = _HEADINGS.get(name, shown.heading)
        return number(heading, lambda row: fine.format(row.figures[name]), shown.display_unit)

    def remark(row: TabulationRow) -> Cell:
        text = _remark(tabulation, row)
        return Cell(text, state=State.FAIL if text else None)

    table = table_of(
        "",
        tabulation.rows,
        number(f"speed\n{speed.display_unit}", lambda row: speed.format(row.speed)),
        number(_KNOTS.display, lambda row: _KNOTS.format(row.speed)),
        *map(figure, names),
        blocks.words("", remark, 0.0),
    )
    marked = any(_remark(tabulation, row) == "!" for row in tabulation.rows)
    note = quiet(f"{_NOTE} {_WARNED}" if marked else _NOTE)
    return ReportPart(tabulation.title, (table, *warned(tabulation.warnings), note))


def _fine(name: str, tabulation: Tabulation) -> Quantity:
    """The quantity with `_DIGITS` digits at least: rows differ little, and a tow may be small."""
    quantity = QUANTITIES[name]
    greatest = max((abs(row.figures[name] or 0.0) for row in tabulation.rows), default=0.0)
    if greatest == 0.0:
        return quantity
    decimals = _DIGITS - 1 - floor(log10(greatest * quantity.usual_scale))
    return replace(quantity, decimals=max(quantity.decimals, decimals))


def _remark(tabulation: Tabulation, row: TabulationRow) -> str:
    if isinstance(row.outcome, NoEquilibrium):
        return row.outcome.status
    return "!" if set(row.outcome.warnings) - set(tabulation.warnings) else ""


_SWEEP_HEIGHT = 4.5  # inches
_MOST_MARKED = 60  # points that can still be told apart


def draw_sweep(tabulation: Tabulation) -> Figure:
    """A figure of three panels against the speed, which belongs to no window.

    Depth of the body, its layback, and the tension at the tow point and at the body. A speed
    without equilibrium is a gap.
    """
    figure = empty_figure(plot.WIDTH, _SWEEP_HEIGHT, layout="constrained")
    depth, layback, tension = figure.subplots(1, 3)
    figure.suptitle(tabulation.name, parse_math=False)
    _draw_figure(depth, tabulation, "depth")
    depth.axhline(0.0, color=plot.WATER_COLOUR, linewidth=1)
    depth.invert_yaxis()
    _draw_figure(layback, tabulation, "layback")
    _draw_figure(tension, tabulation, "tension", label="at the tow point")
    _draw_figure(tension, tabulation, "body_tension", "--", label="at the body")
    tension.set_ylabel(QUANTITIES["tension"].label)
    tension.set_ylim(bottom=0.0)
    tension.legend(frameon=False)
    return figure


def _draw_figure(
    axes: Axes, tabulation: Tabulation, name: str, dashes: str = "-", label: str = ""
) -> None:
    from matplotlib.ticker import MaxNLocator

    speeds = [row.speed for row in tabulation.rows]
    figures = [row.figures[name] for row in tabulation.rows]
    values = [float("nan") if value is None else value for value in figures]
    marker = "." if dashes == "-" and len(speeds) <= _MOST_MARKED else ""
    axes.plot(speeds, values, linestyle=dashes, marker=marker, label=label, **plot.LINE_STYLE)
    margin = 0.04 * (speeds[-1] - speeds[0]) or speeds[0]
    axes.set_xlim(speeds[0] - margin, speeds[-1] + margin)
    axes.set(xlabel=QUANTITIES["speed"].label, ylabel=QUANTITIES[name].label)
    axes.grid(alpha=0.3)
    if not axes.child_axes:
        to_knots, from_knots = partial(mul, 1.0 / KNOT), partial(mul, KNOT)
        knots = axes.secondary_xaxis("top", functions=(to_knots, from_knots))
        knots.set_xlabel("speed [knot]")
        knots.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
