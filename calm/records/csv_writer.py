"""Tables as CSV text for machines and spreadsheets: UTF-8, comma, point, LF."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence

_FORMULA = ("=", "+", "-", "@", "\t", "\n")


def table_csv(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a table as CSV text; what is unknown, None or NaN, is left empty.

    Numbers have twelve significant digits at most, so that none shows the noise of its computing.
    A spreadsheet takes a text that begins with ``=``, ``+``, ``-`` or ``@`` for a formula: such
    texts are written with an apostrophe before them.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(map(_cell, header))
    writer.writerows(map(_cell, row) for row in rows)
    return text.getvalue()


def _cell(value: object) -> str:
    if value is None or value != value:
        return ""
    if isinstance(value, str):
        text = value.replace("\r\n", "\n").replace("\r", "\n")
        return f"'{text}" if text.startswith(_FORMULA) else text
    return f"{value + 0.0:.12g}" if isinstance(value, float) else str(value)
