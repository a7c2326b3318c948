"""A row of the table of the line, and how wide its columns are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from calm.checks.finding import State
from calm.files import Place

Column = Literal["component", "label", "count", "length"]
EDITABLE: tuple[Column, ...] = ("component", "label", "count", "length")
"""The columns that a person fills, from the left."""

FIGURES = ("depth", "tension", "tilt", "margin")
HEADINGS = {
    "component": "component",
    "label": "label",
    "count": "n",
    "length": "length",
    "depth": "depth m",
    "tension": "tension N",
    "tilt": "tilt °",
    "margin": "margin",
}
RIGHT_ALIGNED = frozenset({"count", "length", *FIGURES})

_WIDTHS = {"count": 3, "length": 9, "depth": 8, "tension": 9, "tilt": 6, "margin": 7}
_LEAST_TEXT, _WANTED_TEXT = 9, 12
_MOST_COMPONENT, _MOST_LABEL, _MOST_LENGTH = 30, 40, 13
LEAD = 4
"""Cells before the first column: cursor, mark or state, sign, a blank."""


@dataclass(frozen=True)
class TableRow:
    """What is shown of a piece, or of what is clamped on one.

    `texts` are by the name of the column; `wrong` tells that no such component is known.
    """

    spot: Place
    sign: str
    texts: dict[str, str]
    state: State | None = None
    wrong: bool = False


@dataclass(frozen=True)
class Layout:
    """The columns that fit a width: name, first cell, and width."""

    columns: tuple[tuple[str, int, int], ...]

    def place(self, name: str) -> tuple[int, int]:
        """First cell and width of a column; of the first one where it is not shown."""
        for column, start, width in self.columns:
            if column == name:
                return start, width
        return self.columns[0][1:]

    def at(self, x: int) -> str:
        """The column at a cell."""
        found = self.columns[0][0]
        for column, start, _ in self.columns:
            if x >= start:
                found = column
        return found


def layout_for(
    width: int, component: int = _MOST_COMPONENT, label: int = _MOST_LABEL, length: int = 0
) -> Layout:
    """The columns of a table as wide as this, those least needed left out where it is narrow.

    Parameters
    ----------
    component, label : cells of the longest text in these columns, which share what is left
    length : cells of the longest length
    """
    shown = [*EDITABLE, *FIGURES]
    fixed = _WIDTHS | {"length": min(max(length, _WIDTHS["length"]), _MOST_LENGTH)}
    for name in ("margin", "tilt", "count", "tension", "depth"):
        if _text_room(shown, width, fixed) >= 2 * _WANTED_TEXT:
            break
        shown.remove(name)
    room = max(_text_room(shown, width, fixed), 2 * _LEAST_TEXT)
    component = min(max(component, _LEAST_TEXT), _MOST_COMPONENT)
    component = min(component, room - min(max(label, _LEAST_TEXT), room // 2))
    widths = fixed | {"component": component, "label": min(room - component, _MOST_LABEL)}
    columns, start = [], LEAD
    for name in shown:
        columns.append((name, start, widths[name]))
        start += widths[name] + 1
    return Layout(tuple(columns))


def _text_room(shown: list[str], width: int, fixed: dict[str, int]) -> int:
    """Cells left for the component and the label."""
    return width - LEAD - len(shown) - sum(fixed.get(name, 0) for name in shown)
