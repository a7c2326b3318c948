"""Results as CSV: a row for each component and each clamped instrument, in file order."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from calm.case.result_tables import Components, rows_down
from calm.quantities import QUANTITIES
from calm.records.delimited import table_csv

if TYPE_CHECKING:
    from calm.case import Result, TowResult
    from calm.case.result_tables import ClampRow, ComponentRow

_WORDS = ("mooring", "part", "index", "use", "label")
_WITHIN = {"tension", "least_tension", "reynolds"}
"""What is greatest or least within a piece: a row has the figures of its ends."""

_NUMBERS = tuple(
    name for name in Components.__annotations__ if name in QUANTITIES and name not in _WITHIN
)
HEADER = (*_WORDS, *(QUANTITIES[name].header for name in _NUMBERS))
"""The first row: names, with the unit in brackets where there is one."""


def to_csv(results: Sequence[Result | TowResult]) -> str:
    """The components of one mooring or tow, or of several, as CSV text (UTF-8, comma, point, LF).

    `part` is ``component`` or ``clamp``; the rows of clamped instruments follow the piece they sit
    on, with equal figures for both ends and no length. A number that is unknown is left empty.
    """
    return table_csv(HEADER, (row for result in results for row in _rows(result)))


def _rows(result: Result | TowResult) -> Iterator[list[object]]:
    for component, clamps in rows_down(result):
        numbers = (getattr(component, name) for name in _NUMBERS)
        yield [*_words(result, "component", component), *numbers]
        for clamp in clamps:
            numbers = (getattr(clamp, _at_a_point(name), None) for name in _NUMBERS)
            yield [*_words(result, "clamp", clamp), *numbers]


def _words(result: Result | TowResult, part: str, row: ComponentRow | ClampRow) -> list[object]:
    return [result.name, part, row.index, row.use, row.label]


def _at_a_point(name: str) -> str:
    """Name of the one figure that a clamp has where a component has one for each end."""
    return name.removesuffix("_top").removesuffix("_bottom")
