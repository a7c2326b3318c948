"""Results as CSV: a row for each component and each clamped instrument, in file order."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from calm.case.columns import Components, rows_down
from calm.quantities import QUANTITIES

if TYPE_CHECKING:
    from calm.case import Result, TowResult
    from calm.case.columns import ClampRow, ComponentRow

_WORDS = ("mooring", "part", "index", "use", "label")
_WITHIN = {"tension", "least_tension", "reynolds"}
"""What is greatest or least within a piece: a row has the figures of its ends."""

_NUMBERS = tuple(
    name for name in Components.__annotations__ if name in QUANTITIES and name not in _WITHIN
)
HEADER = (*_WORDS, *(QUANTITIES[name].header for name in _NUMBERS))
"""The first row: names, with the unit in brackets where there is one."""


_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n")


def as_text(text: str) -> str:
    """A text as a cell that no spreadsheet takes for a formula: with an apostrophe before it."""
    return f"'{text}" if text.startswith(_FORMULA) else text


def table_csv(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table as CSV text (UTF-8, comma, point, LF); what is unknown is left empty.

    A spreadsheet takes a text that begins with ``=``, ``+``, ``-`` or ``@`` for a formula. Such
    texts are written with an apostrophe before them; numbers are numbers, in full.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(map(_cell, row) for row in rows)
    return text.getvalue()


def _cell(value: object) -> str:
    if value is None or value != value:
        return ""
    if isinstance(value, str):
        return as_text(value)
    return repr(float(value)) if isinstance(value, float) else str(value)


def to_csv(results: Sequence[Result | TowResult]) -> str:
    """The components of one mooring or tow, or of several, as CSV text (UTF-8, comma, point, LF).

    `part` is ``component`` or ``clamp``; the rows of clamped instruments follow the piece they sit
    on, with equal figures for both ends and no length. A number that is unknown is left empty.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEADER)
    for result in results:
        writer.writerows(_rows(result))
    return text.getvalue()


def _rows(result: Result | TowResult) -> Iterator[list[object]]:
    for component, clamps in rows_down(result):
        numbers = (getattr(component, name) for name in _NUMBERS)
        yield [*_words(result, "component", component), *map(_number, numbers)]
        for clamp in clamps:
            numbers = (getattr(clamp, _at_a_point(name), None) for name in _NUMBERS)
            yield [*_words(result, "clamp", clamp), *map(_number, numbers)]


def _words(result: Result | TowResult, part: str, row: ComponentRow | ClampRow) -> list[object]:
    return [as_text(result.name), part, row.index, as_text(row.use), as_text(row.label)]


def _at_a_point(name: str) -> str:
    """Name of the one figure that a clamp has where a component has one for each end."""
    return name.removesuffix("_top").removesuffix("_bottom")


def _number(value: float | None) -> str:
    return "" if value is None or value != value else repr(float(value))
