"""A current in a text that was copied from a spreadsheet, a CSV file or a page."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

_SEPARATORS = tuple(map(re.compile, (r"\t", ";", ",", r"\s+")))
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?(\s.*|[A-Za-z°%].*)?")


@dataclass(frozen=True)
class CopiedTable:
    """The cells of a text, as written.

    Attributes
    ----------
    headings : of the columns; None where the first line is one of numbers
    rows : cells without the blanks around them, as many in each as there are columns
    """

    headings: tuple[str, ...] | None
    rows: tuple[tuple[str, ...], ...]


class NoTableError(ValueError):
    """A text is no table; the message says which line is wrong, and how."""


def copied_table(text: str) -> CopiedTable:
    """The table of a text, its cells between tabs, semicolons, commas or blanks.

    A first line without a number is its headings; empty lines and comments after ``#`` are left
    out. `calm.files.tables.read_current` reads what it holds.

    Raises
    ------
    NoTableError
        There are no rows, or rows of different length.
    """
    lines = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not lines:
        raise NoTableError("there are no numbers in it")
    separator = max(_SEPARATORS, key=lambda each: _alike(each, [line for _, line in lines]))
    cells = [(number, _split(separator, line)) for number, line in lines]
    first = cells[0][1]
    headings = None if any(map(_is_number, first)) else first
    rows = cells[headings is not None :]
    if not rows:
        raise NoTableError("there are no numbers in it")
    for number, row in rows:
        if len(row) != len(first):
            raise NoTableError(
                f"line {number} has {len(row)} value{'s' * (len(row) != 1)}, the first {len(first)}"
            )
    return CopiedTable(headings, tuple(row for _, row in rows))


def _is_number(cell: str) -> bool:
    return _NUMBER.fullmatch(cell) is not None


def _alike(separator: re.Pattern[str], lines: Sequence[str]) -> int:
    """How many lines a separator parts into as many cells as the last line, if into several."""
    counts = [len(_split(separator, line)) for line in lines]
    return counts.count(counts[-1]) if counts[-1] > 1 else 0


def _split(separator: re.Pattern[str], line: str) -> tuple[str, ...]:
    return tuple(cell.strip() for cell in separator.split(line.strip(" ")))
