"""The title block at the foot of each page of the diagram."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from calm.report.deck.paper import FONT, LEADING, MARGIN, SMALL, Paper
from calm.report.schematic.parts import one_line
from calm.report.schematic.pen import INK, SOFT, Pen
from calm.report.schematic.widths import wrapped
from calm.report.title_block import title_pairs

if TYPE_CHECKING:
    from calm.deck import Deck

_FIELDS = (
    "mooring", "document", "revision", "date", "project", "ship", "cruise", "position",
    "water depth", "environment", "author", "checked", "approved", "sheet",
)  # fmt: skip
_COLUMNS = {Paper.A4: 4, Paper.LETTER: 4, Paper.A3: 7}
_PAD = 4.0


@dataclass(frozen=True)
class TitleBlock:
    """Fields in rows of as many columns, each with its text in lines; what is not known is blank.

    Attributes
    ----------
    rows : of name and lines of text
    columns : how many stand side by side
    height : of all [pt]
    sheet : such as 2 of 5
    """

    rows: tuple[tuple[tuple[str, tuple[str, ...]], ...], ...]
    columns: int
    height: float
    sheet: str = ""

    def of_page(self, number: int, count: int) -> TitleBlock:
        """The block of one of several pages."""
        return replace(self, sheet=f"{number} of {count}")

    def draw(self, page: Pen, left: float, top: float, width: float) -> None:
        """In a frame, its upper left corner at a point."""
        step = width / self.columns
        y = top
        for row in self.rows:
            height = _height(row)
            for number, (name, lines) in enumerate(one for one in row if one[0]):
                x = left + number * step
                page.draw(
                    "rect", x=x, y=y, width=step, height=height, fill="none", stroke=INK,
                    stroke_width=0.6,
                )  # fmt: skip
                page.letters(x + _PAD, y + 6.0, name, size=SMALL, colour=SOFT)
                shown = (self.sheet,) if name == "sheet" else lines
                for line, text in enumerate(shown):
                    page.letters(x + _PAD, y + 6.0 + LEADING * (line + 1), text, size=FONT)
            y += height


def title_block_of(deck: Deck, paper: Paper) -> TitleBlock:
    """The title block of a mooring, without the number of its page."""
    known = dict(title_pairs(deck.file)) | {"environment": deck.environment}
    columns = _COLUMNS[paper]
    room = (paper.size[0] - 2 * MARGIN) / columns - 2 * _PAD
    fields = [(name, tuple(wrapped(one_line(known.get(name, "")), room, FONT))) for name in _FIELDS]
    fields += [("", ())] * (-len(fields) % columns)
    rows = tuple(tuple(fields[start : start + columns]) for start in range(0, len(fields), columns))
    return TitleBlock(rows, columns, sum(map(_height, rows)))


def _height(row: tuple[tuple[str, tuple[str, ...]], ...]) -> float:
    return 8.0 + LEADING * max(1, *(len(lines) for _, lines in row)) + 3.0
