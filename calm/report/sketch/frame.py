"""Axes around a picture: where a quantity is among the cells, and the numbers beside it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from calm.report.graph.ticks import number, round_numbers
from calm.report.sketch.canvas import ACROSS, DOWN, Canvas

AXIS = "white"
"""The style of scales."""

COLUMNS_PER_TICK = 8
"""Of a scale along the last row."""

_ROWS_PER_TICK = 3


@dataclass(frozen=True)
class Scale:
    """A range of a quantity, from `low` (left or top) to `high`, over a number of dots."""

    low: float
    high: float
    dots: int

    def dot(self, value: float) -> float:
        """Where a value is, counted in dots from the start of the range."""
        return (value - self.low) / (self.high - self.low) * (self.dots - 1)


@dataclass(frozen=True)
class Frame:
    """The part of a canvas between its scales: first column and row, how many of each, and what
    they measure."""

    canvas: Canvas
    column: int
    row: int
    columns: int
    rows: int
    across: Scale
    down: Scale

    @classmethod
    def within(
        cls,
        canvas: Canvas,
        head: int,
        gutter: int,
        across: tuple[float, float],
        down: tuple[float, float],
        beside: int = 0,
    ) -> Frame:
        """What of a canvas the scales leave, below and to the left, and what else stands around it.

        Parameters
        ----------
        head : rows above
        gutter : columns of the numbers to the left
        across, down : what is at the left and the right edge, at the upper and the lower one
        beside : columns to the right
        """
        columns, rows = canvas.width - gutter - 1 - beside, canvas.height - head - 2
        return cls(
            canvas,
            column=gutter + 1,
            row=head,
            columns=columns,
            rows=rows,
            across=Scale(*across, columns * ACROSS),
            down=Scale(*down, rows * DOWN),
        )

    def point(self, x: float, y: float) -> tuple[float, float]:
        """The dot of the canvas where two values are."""
        return self.column * ACROSS + self.across.dot(x), self.row * DOWN + self.down.dot(y)

    def cell(self, x: float, y: float) -> tuple[int, int]:
        """The column and the row, the nearest inside the frame."""
        dot_x, dot_y = self.point(x, y)
        column, row = int((dot_x + 0.5) // ACROSS), int((dot_y + 0.5) // DOWN)
        return (
            min(max(column, self.column), self.column + self.columns - 1),
            min(max(row, self.row), self.row + self.rows - 1),
        )

    def line(
        self, points: Iterable[tuple[float, float]], style: str, *, dash: int = 0, gap: int = 0
    ) -> None:
        """A line through points of the two quantities."""
        self.canvas.line((self.point(x, y) for x, y in points), style, dash=dash, gap=gap)

    def mark(self, x: float, y: float, sign: str, style: str) -> None:
        """A sign at a point; beside it where another is there, once where the same is."""
        column, row = self.cell(x, y)
        for beside in (0, 1, -1, 2):
            here = column + beside
            if not self.column <= here < self.column + self.columns:
                continue
            found = self.canvas.sign(here, row)
            if found is None:
                self.canvas.text(here, row, sign, style)
            if found in (None, sign):
                return

    def scale_down(self, values: Iterable[float], width: int, foot: str = "m") -> None:
        """Numbers and marks along the left edge; the numbers are so many cells wide.

        `foot` stands below them.
        """
        axis = self.column - 1
        self.canvas.text(axis - width, self.row + self.rows, f"{foot:>{width}}", AXIS)
        for row in range(self.row, self.row + self.rows):
            self.canvas.text(axis, row, "│", AXIS)
        for value in values:
            _, row = self.cell(self.across.low, value)
            self.canvas.text(axis - width, row, f"{number(value):>{width}}┤", AXIS)

    def scale_across(self, values: Iterable[float], *units: str) -> None:
        """Numbers along the last row of the canvas, and their marks on the row above.

        After them the first unit for which there is room; for the last one it is made, as long as
        two numbers are left.
        """
        row, edge = self.canvas.height - 1, self.canvas.width
        labels: list[tuple[int, str]] = []
        for value in values:
            text, (column, _) = number(value), self.cell(value, self.down.low)
            start = max(column - len(text) // 2, 0)
            self.canvas.text(column, row - 1, "┴", AXIS)
            if start + len(text) <= edge and (not labels or start > _end(labels)):
                labels.append((start, text))
        unit = next((each for each in units if _end(labels) + 1 + len(each) <= edge), None)
        if unit is None:
            unit = units[-1]
            while len(labels) > 2 and _end(labels) + 1 + len(unit) > edge:
                labels.pop()
            if _end(labels) + 1 + len(unit) > edge:
                unit = ""
        for start, text in [*labels, (_end(labels) + 1, unit)]:
            self.canvas.text(start, row, text, AXIS)


def _end(labels: list[tuple[int, str]]) -> int:
    """The column after the last label."""
    return labels[-1][0] + len(labels[-1][1]) if labels else 0


def levels(low: float, high: float, rows: int) -> list[float]:
    """Ticks for a scale of a number of rows."""
    return round_numbers(low, high, max(rows // _ROWS_PER_TICK, 1))
