"""A picture in the cells of a terminal: dots of braille, and signs over them.

A cell has two by four dots, which makes a dot as wide as high. Styles are those of rich, with the
eight colours of every terminal only; a picture says the same without them.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from math import ceil, isfinite

from rich.cells import cell_len, set_cell_size
from rich.text import Text

ACROSS, DOWN = 2, 4
"""Dots of a cell."""

_BRAILLE = 0x2800
_BITS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
_MOST_STEPS = 4000


class Canvas:
    """Cells to draw on, `width` by `height`; what lies outside is left out.

    Dots are counted from the upper left, as are columns and rows.
    """

    def __init__(self, width: int, height: int) -> None:
        self.width, self.height = width, height
        self._bits = [[0] * width for _ in range(height)]
        self._styles = [[""] * width for _ in range(height)]
        self._signs: list[list[str | None]] = [[None] * width for _ in range(height)]

    def dot(self, x: float, y: float, style: str) -> None:
        """One dot; its cell takes the style."""
        column, row = int(x // ACROSS), int(y // DOWN)
        if 0 <= column < self.width and 0 <= row < self.height:
            self._bits[row][column] |= _BITS[int(y) % DOWN][int(x) % ACROSS]
            if self._signs[row][column] is None:
                self._styles[row][column] = style

    def line(
        self, points: Iterable[tuple[float, float]], style: str, *, dash: int = 0, gap: int = 0
    ) -> None:
        """Straight lines from point to point, `dash` dots drawn and `gap` left out in turn."""
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
        """Signs over the dots, cut at the edges."""
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
        """The sign in a cell of the canvas, if any."""
        return self._signs[row][column]

    def rows(self) -> list[Text]:
        """The picture, a text for each row of cells, all of the full width."""
        return [self._row(row) for row in range(self.height)]

    def _row(self, row: int) -> Text:
        text = Text(no_wrap=True, end="")
        for column in range(self.width):
            sign, bits = self._signs[row][column], self._bits[row][column]
            if sign is None:
                sign = chr(_BRAILLE + bits) if bits else " "
            text.append(sign, self._styles[row][column] or None)
        return text
