"""Rows of numbers out of a text that was copied from a spreadsheet, a CSV file or a page."""

from __future__ import annotations

import re
from collections.abc import Sequence

from calm.tui.checking import Check, number

_SEPARATORS = tuple(map(re.compile, (r"\t", ";", ",", r"\s+")))

Rows = tuple[tuple[str, ...], ...]


class NoRows(ValueError):
    """A text is not the rows of a table; says which row, and what is wrong with it."""


def pasted_rows(text: str, checks: Sequence[Check]) -> Rows:
    """The rows of a text, its values between tabs, semicolons, commas or blanks.

    A first row without a number is a heading, and left out; so are empty lines.

    Parameters
    ----------
    text : str
    checks : what judges the values, one for each column

    Raises
    ------
    NoRows
        A row has more or fewer values than there are columns, or one that is not good, or there
        is no row.
    """
    lines = [(row, line) for row, line in enumerate(text.splitlines(), 1) if line.strip()]
    if lines and _is_heading(lines[0][1]):
        del lines[0]
    if not lines:
        raise NoRows("there are no numbers in it")
    separator = max(_SEPARATORS, key=lambda each: _fitting(each, lines, len(checks)))
    return tuple(_row(row, _split(separator, line), checks) for row, line in lines)


def _is_heading(line: str) -> bool:
    return not any(
        number(value).is_good for separator in _SEPARATORS for value in _split(separator, line)
    )


def _row(row: int, values: Sequence[str], checks: Sequence[Check]) -> tuple[str, ...]:
    if len(values) != len(checks):
        many = f"{len(values)} value{'s' * (len(values) != 1)}"
        raise NoRows(f"row {row} has {many}, and the table {len(checks)} columns")
    readings = [check(value) for check, value in zip(checks, values, strict=True)]
    for value, reading in zip(values, readings, strict=True):
        if not reading.is_good:
            raise NoRows(f"row {row}: `{value}` {reading.note}")
    return tuple(reading.text for reading in readings)


def _fitting(separator: re.Pattern[str], lines: Sequence[tuple[int, str]], columns: int) -> int:
    """How many lines a separator takes into as many values as there are columns."""
    return sum(len(_split(separator, line)) == columns for _, line in lines)


def _split(separator: re.Pattern[str], line: str) -> tuple[str, ...]:
    return tuple(value.strip() for value in separator.split(line.strip(" ")))
