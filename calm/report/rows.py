"""What the table of a result says, as plain text: a terminal and a notebook show the same."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from calm.case.columns import rows_down
from calm.quantities import QUANTITIES
from calm.report.limits import Mark, safety_mark, tilt_mark

if TYPE_CHECKING:
    from calm.case import Result, TowResult
    from calm.case.columns import ClampRow, ComponentRow


@dataclass(frozen=True)
class Phrase:
    """A piece of text, and whether what it says passes a limit."""

    text: str
    mark: Mark = Mark.NONE


@dataclass(frozen=True)
class Row:
    """A component, or an instrument clamped on the one above it (`clamped`)."""

    label: str
    clamped: bool
    instrument: bool
    cells: tuple[Phrase, ...]


@dataclass(frozen=True)
class Sheet:
    """Everything the table of a result says.

    Attributes
    ----------
    title : name and kind
    columns : names of the quantities in each row
    rows : one for each component and each clamped instrument, in file order
    summary : the two ends of the line in words
    warnings : what a person should know before trusting the figures
    note, convergence : how to read the rows; how the solution was reached and how good it is
    """

    title: str
    columns: tuple[str, ...]
    rows: tuple[Row, ...]
    summary: tuple[Phrase, ...]
    warnings: tuple[str, ...]
    note: str
    convergence: str


def rows(result: Result | TowResult, columns: tuple[str, ...]) -> Iterator[Row]:
    """The rows of the table, in file order, each clamped instrument below its component."""
    for record, clamps in rows_down(result):
        figures = _figures(result, record, record.depth_top, record.x_top, record.y_top)
        figures |= {"length": record.length, "safety_factor": record.safety_factor}
        marks = {
            "tilt": tilt_mark(record.part.component, record.tilt),
            "safety_factor": safety_mark(result, record),
        }
        instrument = record.role == "instrument"
        yield Row(record.label, False, instrument, _cells(columns, figures, marks))
        for clamp in clamps:
            figures = _figures(result, clamp, clamp.depth, clamp.x, clamp.y)
            marks = {"tilt": tilt_mark(clamp.part.component, clamp.tilt)}
            instrument = clamp.part.component.role == "instrument"
            yield Row(clamp.label, True, instrument, _cells(columns, figures, marks))


def convergence(result: Result | TowResult, end: str) -> str:
    """How the solution was reached and how good it is; `end` is where the line is held."""
    accuracy = result.accuracy
    return (
        f"{result.status.capitalize()} in {result.iterations} marches of {result.segments} "
        f"segments, good to {accuracy.depth:.2g} m and {accuracy.tension:.2g} N; {end} missed by "
        f"{abs(result.miss):.1g} m, forces closed to {result.closure:.1g}."
    )


def _figures(
    result: Result | TowResult, record: ComponentRow | ClampRow, depth: float, x: float, y: float
) -> dict[str, float]:
    """What a component and a clamped instrument both have, at their (upper) point."""
    bottom = result.file.environment.depth
    return {
        "depth": depth,
        "height": math.nan if bottom is None else bottom - depth,
        "knockdown": record.knockdown,
        "offset": math.hypot(x, y),
        "layback": math.hypot(x, y),
        "tilt": record.tilt,
        "tension": record.tension,
    }


def _cells(
    columns: tuple[str, ...], figures: dict[str, float], marks: dict[str, Mark]
) -> tuple[Phrase, ...]:
    return tuple(
        Phrase(QUANTITIES[name].format(figures.get(name)), marks.get(name, Mark.NONE))
        for name in columns
    )
