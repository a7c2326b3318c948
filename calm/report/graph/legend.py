"""What the lines and signs of a graph mean."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from calm.report.graph.style import Stroke, draw_mark
from calm.report.schematic.pen import Pen

_SAMPLE, _GAP = 16.0, 5.0  # points: the line beside a text, and what is between them


class Entry(NamedTuple):
    """A text with its line, or its sign: form, width [pt] and colour."""

    text: str
    line: Stroke | None = None
    sign: tuple[str, float, str] | None = None


def write_legend(
    pen: Pen,
    entries: Sequence[Entry],
    left: float,
    top: float,
    *,
    width: float,
    row: float,
    columns: int,
    size: float,
) -> None:
    """Entries row by row in columns that share a width; a text that is too long is cut short."""
    across = width / columns
    for number, entry in enumerate(entries):
        x, y = left + number % columns * across, top + (number // columns + 0.5) * row
        if entry.line is not None:
            pen.line(x, y, x + _SAMPLE, y, **entry.line.attributes())
        if entry.sign is not None:
            draw_mark(pen, x + _SAMPLE / 2, y, *entry.sign)
        room = across - _SAMPLE - 2 * _GAP
        pen.write(x + _SAMPLE + _GAP, y, " ".join(entry.text.split()), room, size=size)
