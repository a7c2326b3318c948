"""Drawing area of terminal cells with braille dots, characters, and scales along the edges."""

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, isfinite

from rich.cells import cell_len, set_cell_size
from rich.text import Text

from calm.drawing.graph import number, round_numbers

Points = Iterable[tuple[float, float]]

DOTS_ACROSS, DOTS_DOWN = 2, 4
"""Number of dots per cell, horizontally and vertically."""

_BRAILLE = 0x2800
_BITS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
_MOST_STEPS = 4000


class Canvas:
    """Drawing area of `width` by `height` cells; everything outside is clipped.

    Dots, columns and rows are counted from the upper left corner.
    """

    def __init__(self, width: int, height: int) -> None:
        self.width, self.height = width, height
        self._bits = [[0] * width for _ in range(height)]
        self._styles = [[""] * width for _ in range(height)]
        self._signs: list[list[str | None]] = [[None] * width for _ in range(height)]

    def dot(self, x: float, y: float, style: str) -> None:
        """Draw a dot, and set the style of the cell that contains it."""
        column, row = int(x // DOTS_ACROSS), int(y // DOTS_DOWN)
        if 0 <= column < self.width and 0 <= row < self.height:
            self._bits[row][column] |= _BITS[int(y) % DOTS_DOWN][int(x) % DOTS_ACROSS]
            if self._signs[row][column] is None:
                self._styles[row][column] = style

    def line(self, points: Points, style: str, dash: int = 0, gap: int = 0) -> None:
        """Draw a polyline with dashes of `dash` dots, separated by `gap` dots."""
        drawn = 0
        last: tuple[int, int] | None = None
        for (x0, y0), (x1, y1) in pairwise(points):
            if not all(map(isfinite, (x0, y0, x1, y1))):
                continue
            steps = min(max(ceil(max(abs(x1 - x0), abs(y1 - y0))), 1), _MOST_STEPS)
            for step in range(steps + 1):
                share = step / steps
                here = int(x0 + share * (x1 - x0) + 0.5), int(y0 + share * (y1 - y0) + 0.5)
                if here == last:
                    continue
                last = here
                if not gap or drawn % (dash + gap) < dash:
                    self.dot(*here, style)
                drawn += 1

    def text(self, column: int, row: int, text: str, style: str = "") -> None:
        """Write a text over the dots; characters outside the canvas are clipped."""
        if not 0 <= row < self.height or column >= self.width:
            return
        if column < 0:
            text, column = text[-column:], 0
        room = self.width - column
        if cell_len(text) > room:
            text = set_cell_size(text, room)
        for sign in text:
            width = cell_len(sign)
            if width:
                self._signs[row][column] = sign
                self._styles[row][column] = style
            for extra in range(1, width):
                self._signs[row][column + extra] = ""
            column += width

    def sign(self, column: int, row: int) -> str | None:
        """Return the character that was written in a cell; None for a cell without a character."""
        return self._signs[row][column]

    def rows(self) -> list[Text]:
        """Return the drawing as rows of cells, each a text of the full width."""
        found = [Text(no_wrap=True, end="") for _ in range(self.height)]
        for text, *cells in zip(found, self._signs, self._bits, self._styles, strict=True):
            for sign, bits, style in zip(*cells, strict=True):
                dots = chr(_BRAILLE + bits) if bits else " "
                text.append(dots if sign is None else sign, style or None)
        return found


AXIS, SEABED = "white", "yellow"
"""Styles of scales and of the seabed."""
_HEADED = 9
"""Minimum height of a picture with a caption [rows]."""

COLUMNS_PER_TICK = 8
"""Number of columns per tick of a horizontal scale."""

_ROWS_PER_TICK = 3


@dataclass(frozen=True)
class CellScale:
    """Linear scale of a quantity over a row or column of dots.

    The first dot, at the left or at the top, is at `low`; the last dot is at `high`.
    """

    low: float
    high: float
    dots: int

    def dot(self, value: float) -> float:
        """Return the position of a value, in dots from the start of the range."""
        return (value - self.low) / (self.high - self.low) * (self.dots - 1)


@dataclass(frozen=True)
class PlotFrame:
    """Area of a canvas inside the scales: first column and row, size, and the two scales."""

    canvas: Canvas
    column: int
    row: int
    columns: int
    rows: int
    across: CellScale
    down: CellScale

    def point(self, x: float, y: float) -> tuple[float, float]:
        """Convert a pair of values to the position of a dot."""
        column = self.column * DOTS_ACROSS + self.across.dot(x)
        return column, self.row * DOTS_DOWN + self.down.dot(y)

    def cell(self, x: float, y: float) -> tuple[int, int]:
        """Convert a pair of values to the column and row of the nearest cell inside the frame."""
        dot_x, dot_y = self.point(x, y)
        column, row = int((dot_x + 0.5) // DOTS_ACROSS), int((dot_y + 0.5) // DOTS_DOWN)
        return (
            min(max(column, self.column), self.column + self.columns - 1),
            min(max(row, self.row), self.row + self.rows - 1),
        )

    def line(self, points: Points, style: str, dash: int = 0, gap: int = 0) -> None:
        """Draw a polyline through points in units of the two scales."""
        self.canvas.line((self.point(x, y) for x, y in points), style, dash, gap)

    def mark(self, x: float, y: float, sign: str, style: str) -> None:
        """Draw a mark in the cell of a point.

        If the cell has a different mark, a free cell next to it is used. If the cell already has
        the same mark, nothing is drawn.
        """
        column, row = self.cell(x, y)
        for shift in (0, 1, -1, 2):
            here = column + shift
            if not self.column <= here < self.column + self.columns:
                continue
            found = self.canvas.sign(here, row)
            if found is None:
                self.canvas.text(here, row, sign, style)
            if found in (None, sign):
                return

    def scale_down(self, values: Iterable[float], width: int, foot: str = "m") -> None:
        """Write numbers and ticks along the left edge, with the unit `foot` below them.

        `width` is the width of the numbers in cells.
        """
        axis = self.column - 1
        self.canvas.text(axis - width, self.row + self.rows, f"{foot:>{width}}", AXIS)
        for row in range(self.row, self.row + self.rows):
            self.canvas.text(axis, row, "│", AXIS)
        for value in values:
            _, row = self.cell(self.across.low, value)
            self.canvas.text(axis - width, row, f"{number(value):>{width}}┤", AXIS)

    def scale_across(self, values: Iterable[float], *units: str) -> None:
        """Write numbers along the last row of the canvas, and ticks on the row above.

        `units` are alternative names of the unit. The first name that fits after the numbers is
        written. If no name fits, the last of `units` is written in place of the last numbers.
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
    return labels[-1][0] + len(labels[-1][1]) if labels else 0


def levels(low: float, high: float, rows: int) -> list[float]:
    """Return round tick values for a vertical scale with a number of rows."""
    return round_numbers(low, high, max(rows // _ROWS_PER_TICK, 1))


def header_rows(height: int) -> int:
    """Return the number of caption rows above a picture; 0 for a picture of few rows."""
    return int(height >= _HEADED)


def scaled_frame(
    size: tuple[int, int],
    caption: str,
    across: tuple[float, float],
    down: tuple[float, float],
    *units: str,
    seabed: float | None = None,
    margin: int = 0,
    per_tick: int = COLUMNS_PER_TICK,
) -> PlotFrame:
    """Create a canvas with scales along the left and lower edges, and return its frame.

    Parameters
    ----------
    size : numbers of columns and rows of the canvas
    caption : text above the frame, omitted if the canvas has too few rows
    across, down : values at the left and right edge, and at the upper and lower edge
    units : alternative units of the horizontal scale (see `PlotFrame.scale_across`)
    seabed : depth of the seabed below the frame [m], if any
    margin : number of free columns on the right
    per_tick : number of columns per horizontal number
    """
    canvas, head = Canvas(*size), header_rows(size[1])
    if head:
        canvas.text(0, 0, caption, AXIS)
    values = levels(min(down), max(down), size[1] - head - 2)
    foot = "m" if seabed is None else number(seabed)
    gutter = max(map(len, [foot, *map(number, values)]))
    columns, rows = size[0] - gutter - 1 - margin, size[1] - head - 2
    scales = CellScale(*across, columns * DOTS_ACROSS), CellScale(*down, rows * DOTS_DOWN)
    frame = PlotFrame(canvas, gutter + 1, head, columns, rows, *scales)
    sign, style, first = ("─", AXIS, -1) if seabed is None else ("▒", SEABED, 0)
    canvas.text(frame.column + first, size[1] - 2, sign * (frame.columns - first), style)
    frame.scale_down(values, gutter, foot)
    frame.scale_across(round_numbers(*across, max(frame.columns // per_tick, 2)), *units)
    return frame
